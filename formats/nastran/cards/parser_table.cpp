#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/write_order.hpp"

namespace bough::nastran::detail {

void write_by(ParserTable& table, CardWriter write, std::initializer_list<const char*> cards) {
  set_writer(table, write, cards);
}

void write_by(ParserTable& table, std::initializer_list<std::pair<const char*, CardWriter>> cards) {
  for (const auto& [card, write] : cards) write_by(table, write, {card});
}

void add_plain_cards(ParserTable& table, std::initializer_list<std::pair<const char*, CardParser>> cards) {
  for (const auto& [name, parser] : cards) table[name] = {parser, ""};
}

void write_as(ParserTable& table, const char* card, std::initializer_list<const char*> others) {
  for (const char* other : others) table.at(other).written_as = card;
}

/// Cards are written in this order.
const ParserTable& get_card_parsers() {
  static const ParserTable table = [] {
    ParserTable t;
    add_solution_parsers(t);
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
    add_load_set_parsers(t);
    add_temperature_parsers(t);
    add_old_constraint_parsers(t);
    add_old_shell_parsers(t);
    add_old_solid_parsers(t);
    add_special_element_parsers(t);
    add_nonstructural_parsers(t);
    add_special_constraint_parsers(t);
    add_acceleration_parsers(t);
    add_superelement_parsers(t);
    add_material_table_parsers(t);
    add_connector_parsers(t);
    return t;
  }();
  return table;
}

}  // namespace bough::nastran::detail
