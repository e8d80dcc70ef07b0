#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {

const ParserTable& get_card_parsers() {
  static const ParserTable table = [] {
    ParserTable t;
    add_grid_parsers(t);
    add_material_parsers(t);
    add_line_property_parsers(t);
    add_point_property_parsers(t);
    add_line_element_parsers(t);
    add_point_element_parsers(t);
    add_damper_parsers(t);
    add_shell_parsers(t);
    add_continuum_parsers(t);
    add_constraint_parsers(t);
    add_dof_set_parsers(t);
    add_direct_matrix_parsers(t);
    add_load_parsers(t);
    add_pressure_parsers(t);
    add_temperature_parsers(t);
    add_old_constraint_parsers(t);
    add_old_shell_parsers(t);
    add_old_solid_parsers(t);
    add_special_element_parsers(t);
    add_special_constraint_parsers(t);
    add_nonstructural_parsers(t);
    add_superelement_parsers(t);
    add_solution_parsers(t);
    return t;
  }();
  return table;
}

}  // namespace bough::nastran::detail
