#pragma once
/// \file The groups of cards; a new card is one row in the table of its group, next to its functions: parser, writer,
/// and the conversion of units where dimensions depend on other fields.
#include "formats/nastran/detail/card_sink.hpp"
#include "formats/nastran/detail/reading.hpp"
#include "formats/nastran/detail/unit_converter.hpp"

namespace bough::nastran::detail {

/// Adds cards whose fields have no dimensions to convert.
void add_plain_cards(ParserTable& table, std::initializer_list<std::pair<const char*, CardParser>> cards);

/// Reads SID G1 C1 D1 G2 C2 D2: one or two displacements (SPC, SPCD).
template <class Motion>
void parse_motions(Card& card, std::vector<Motion>& motions) {
  const int sid = card.read_id(0, "SID");
  read_entries(card, 3, {1, 4}, [&](int i) {
    Motion motion;
    motion.sid = sid;
    motion.g = card.read_id(i, "G");
    motion.c = card.read_components(i + 1, "C", 0);
    motion.d = card.read_real(i + 2, "D", 0.0);
    motion.at = card.get_location();
    if (card.is_ok()) motions.push_back(motion);
  });
}
/// Reads up to four pairs PID value (PMASS, PDAMP) and calls add(id, value, first field).
template <class Add>
void read_values(Card& card, const char* what, const Add& add) {
  read_entries(card, 2, {0, 2, 4, 6}, [&](int first) {
    const int id = card.read_id(first, "PID");
    add(id, card.read_real(first + 1, what, 0.0), first);
  });
}
/// Reads the dependent grids of an RBE2, fields first .. last-1, and adds it. Adds deck.missing-field, deck.bad-list.
void add_rbe2(Card& card, Reading& r, records::Rbe2&& e, int first, int last, const char* what, const char* first_name);
/// Reads the terms (scale, set) of a LOAD or DLOAD from the third field on. `sum`: a set that must not be among them.
/// Adds deck.missing-field, deck.field-range.
std::vector<std::pair<double, int>> read_load_terms(Card& card, int sum = 0);

void add_grid_parsers(ParserTable& table);                ///< GRID, GRDSET, CORD1x, CORD2x, SPOINT
void add_material_parsers(ParserTable& table);            ///< MAT1, MAT2, MAT8, MAT9, MAT11
void add_line_property_parsers(ParserTable& table);       ///< PBAR, PBARL, PBEAM, PBEAML, PROD, PTUBE
void add_point_property_parsers(ParserTable& table);      ///< PELAS, PBUSH, PMASS
void add_line_element_parsers(ParserTable& table);        ///< CBAR, CBEAM, BAROR, BEAMOR, CROD, CONROD, CTUBE, PLOTEL
void add_point_element_parsers(ParserTable& table);       ///< CELASx, CBUSH, CMASSx, CONMx
void add_damper_parsers(ParserTable& table);              ///< CDAMPx, PDAMP, CVISC, PVISC, CBUSH1D, PBUSH1D
void add_shell_parsers(ParserTable& table);               ///< CQUADx, CTRIAx, CSHEAR, PSHEAR
void add_continuum_parsers(ParserTable& table);           ///< PSHELL, PCOMP, PSOLID, solids
void add_constraint_parsers(ParserTable& table);          ///< RBE1, RBE2, RBE3, RBAR, RROD, SPC, SPC1, MPC, xADD
void add_dof_set_parsers(ParserTable& table);             ///< SUPORT, SUPORT1, ASETi, OMITi, BSETi, CSETi, QSETi
void add_direct_matrix_parsers(ParserTable& table);       ///< DMIG
void add_load_parsers(ParserTable& table);                ///< FORCE, MOMENT, GRAV
void add_pressure_parsers(ParserTable& table);            ///< FORCE1/2, MOMENT1/2, PLOAD, 1, 2, 4, RFORCE, SPCD, SLOAD
void add_load_set_parsers(ParserTable& table);            ///< LOAD
void add_old_constraint_parsers(ParserTable& table);      ///< CRIGD1, CRIGD2, CRIGD3, CRIGDR
void add_old_shell_parsers(ParserTable& table);           ///< CQUAD1, CTRIA1, CQDMEM, CTRPLT ... and their properties
void add_old_solid_parsers(ParserTable& table);           ///< CHEXA1, CHEXA2, CWEDGE, CIHEX1 to CIHEX3, PIHEX, CELBOW
void add_temperature_parsers(ParserTable& table);         ///< TEMP, TEMPD, TEMPRB, TEMPP1
void add_material_table_parsers(ParserTable& table);      ///< MATT1, MATT2, MATT8, MATT9, TABLEM1 to TABLEM4
void add_connector_parsers(ParserTable& table);           ///< CFAST, PFAST, CWELD, PWELD
void add_special_element_parsers(ParserTable& table);     ///< PBCOMP, GENEL, CGAP, PGAP, CBEND, PBEND
void add_special_constraint_parsers(ParserTable& table);  ///< RBAR1, RJOINT, RTRPLT, RTRPLT1, RSPLINE
void add_nonstructural_parsers(ParserTable& table);       ///< NSM, NSM1, NSML, NSML1, NSMADD
void add_acceleration_parsers(ParserTable& table);        ///< ACCEL, ACCEL1
void add_superelement_parsers(ParserTable& table);        ///< SEBULK, SECONCT, SELOAD, EXTRN, DTI
void add_solution_parsers(ParserTable& table);            ///< EIGRL, EIGR, PARAM

/// After the last card: lists of SPC1, ASET1, OMIT1, QSET1 with THRU mean the grids and scalar points that exist. Adds
/// deck.bad-list.
void expand_ranges(Reading& reading);
/// After the last card: the elements of NASTRAN-95 get their PSHELL and PSOLID. Adds deck.old-element,
/// deck.old-property.
void finish_old_elements(Reading& reading);
/// Removes fluid grids and solids, and the cards about their dofs, after the last card. Adds deck.fluid.
void finish_fluid(Reading& reading);
/// After the last card: polar terms become real and imaginary parts. Adds deck.missing-header, deck.duplicate-term.
void finish_direct_matrices(Reading& reading);

}  // namespace bough::nastran::detail
