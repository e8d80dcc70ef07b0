#include "formats/nastran/writer.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "formats/nastran/detail/card_sink.hpp"
#include "formats/nastran/detail/reading.hpp"

namespace bough::nastran {
namespace {

using records::Deck;

/// Cards that the writer keeps; GRDSET, BAROR and BEAMOR are written as fields of the cards that use their defaults.
constexpr std::array written_cards{
    "ACCEL", "ACCEL1", "CBEND", "PCOMPS", "PBEND", "CGAP", "GENEL", "NSM", "NSM1", "NSML", "NSML1", "NSMADD", "PBCOMP",
    "PGAP", "RBAR1", "RJOINT", "RSPLINE", "RTRPLT", "RTRPLT1", "ASET", "ASET1", "BAROR", "BEAMOR", "CBAR", "CBEAM",
    "CBUSH", "CBUSH1D", "CDAMP1", "CDAMP2", "CDAMP3", "CDAMP4", "CELAS1", "CELAS2", "CELAS3", "CELAS4", "CHEXA",
    "CMASS1", "CMASS2", "CMASS3", "CMASS4", "CONM1", "CONM2", "CONROD", "CORD1C", "CORD1R", "CORD1S", "CORD2C",
    "CORD2R", "CORD2S", "CPENTA", "CQUAD4", "CQUAD8", "CQUADR", "CRIGD1", "CRIGD2", "CRIGDR", "CROD", "CSHEAR",
    "CTETRA", "CTRIA3", "CTRIA6", "CTRIAR", "CTUBE", "CVISC", "DMIG", "EIGB", "EIGR", "EIGRL", "FORCE", "FORCE1",
    "FORCE2", "GRAV", "GRDSET", "GRID", "LOAD", "MAT1", "MAT11", "MAT2", "MAT8", "MAT9", "MOMENT", "MOMENT1", "MOMENT2",
    "MPC", "MPCADD", "OMIT", "OMIT1", "PARAM", "PBAR", "PBARL", "PBEAM", "PBEAML", "PBUSH", "PBUSH1D", "PCOMP",
    "PCOMPG", "PDAMP", "PELAS", "PLOAD", "PLOAD1", "PLOAD2", "PLOAD4", "PLOTEL", "PMASS", "PROD", "PSHEAR", "PSHELL",
    "PSOLID", "PTUBE", "PVISC", "RBAR", "RBE1", "RBE2", "RBE3", "RFORCE", "RROD", "SLOAD", "SPC", "SPC1", "SPCADD",
    "SPCD", "SPOINT", "SUPORT", "SUPORT1", "TEMP", "TEMPD", "TEMPP1", "TEMPRB",
    // Cards of NASTRAN-95 are written as the cards they were converted to.
    "CELBOW", "CHEXA1", "CHEXA2", "CIHEX1", "CIHEX2", "CIHEX3", "CIS2D8", "CQDMEM", "CQDMEM1", "CQDMEM2", "CQDPLT",
    "CQUAD1", "CQUAD2", "CRBAR", "CRBE1", "CRBE2", "CRBE3", "CRIGD3", "CRROD", "CRSPLINE", "CRTRPLT", "CTRBSC",
    "CTRIA1", "CTRIA2", "CTRIM6", "CTRMEM", "CTRPLT", "CTRPLT1", "CTRSHL", "CWEDGE", "MAT6", "PCOMP1", "PCOMP2",
    "PELBOW", "PIHEX", "PIS2D8", "PLOAD3", "PQDMEM", "PQDMEM1", "PQDMEM2", "PQDPLT", "PQUAD1", "PQUAD2", "PTRBSC",
    "PTRIA1", "PTRIA2", "PTRIM6", "PTRMEM", "PTRPLT", "PTRPLT1", "PTRSHL", "QSET", "QSET1", "BSET", "BSET1", "CSET",
    "CSET1"};

/// "1.5*K1, 1.*K2": a line for each, so that none grows beyond 72 columns.
std::string join_matrices(const std::vector<std::pair<double, std::string>>& matrices) {
  std::string text;
  for (const auto& [factor, name] : matrices)
    text += (text.empty() ? "" : ",\n  ") + (factor == 1 ? "1." : detail::format_exact_real(factor)) + "*" + name;
  return text;
}

void write_selection(const records::Subcase& subcase, std::string& out) {
  const auto add = [&](const char* word, const std::string& value) {
    if (!value.empty()) out += std::string(word) + " = " + value + "\n";
  };
  const auto add_set = [&](const char* word, int set) {
    if (set != 0) add(word, std::to_string(set));
  };
  add("TITLE", subcase.title);
  add("SUBTITLE", subcase.subtitle);
  add("LABEL", subcase.label);
  add_set("SPC", subcase.spc);
  add_set("MPC", subcase.mpc);
  add_set("LOAD", subcase.load);
  add_set("TEMPERATURE(LOAD)", subcase.temperature);
  add_set("TEMPERATURE(INITIAL)", subcase.initial_temperature);
  add_set("METHOD", subcase.method);
  add_set("STATSUB", subcase.statsub);
  add_set("STATSUB(PRELOAD)", subcase.preload);
  add_set("SUPORT1", subcase.suport1);
  add_set("NSM", subcase.nsm);
  add("K2GG", join_matrices(subcase.k2gg));
  add("M2GG", join_matrices(subcase.m2gg));
  add("B2GG", join_matrices(subcase.b2gg));
}

void write_control(const Deck& deck, std::string& out) {
  for (const auto& [cell, value] : deck.system_cells) out += "NASTRAN " + cell + "=" + value + "\n";
  if (!deck.sol.empty()) out += "SOL " + deck.sol + "\n";
  out += "CEND\n";
  for (const auto& subcase : deck.subcases) {
    if (subcase.id != 0) out += "SUBCASE " + std::to_string(subcase.id) + "\n";
    write_selection(subcase, out);
  }
  out += "BEGIN BULK\n";
}

/// No part of the deck may be lost silently.
void report_lost(const Deck& deck, Diagnostics& diagnostics) {
  const SourceLocation where{deck.files.empty() ? std::string{} : deck.files.front()};
  std::string left_out;
  for (const auto& card : deck.unused) left_out += (left_out.empty() ? "" : ", ") + card.name;
  for (const auto& text : deck.left_out) left_out += (left_out.empty() ? "" : ", ") + text;
  if (!left_out.empty())
    diagnostics.warning("deck.left-out", where, "cards that are not in the new deck: " + left_out,
                        "copy them from the old one if they are needed");
  for (const auto& [name, count] : deck.card_counts) {
    const bool is_unused = std::any_of(deck.unused.begin(), deck.unused.end(),
                                       [&, &n = name](const auto& card) { return card.name == n; });
    const auto row = detail::get_card_parsers().find(name);
    if (is_unused || (row != detail::get_card_parsers().end() && row->second.write != nullptr) ||
        std::find(written_cards.begin(), written_cards.end(), std::string_view(name)) != written_cards.end())
      continue;
    diagnostics.error("deck.not-written", where,
                      name + " cannot be written (" + std::to_string(count) + " in the deck)",
                      "--ignore " + name + " writes the deck without it");
  }
}

}  // namespace

std::string write_deck(const Deck& deck, const WriteOptions& options, Diagnostics& diagnostics) {
  report_lost(deck, diagnostics);
  detail::CardSink sink;
  sink.format = options.fields;
  write_control(deck, sink.out);
  detail::write_solution(deck, sink);
  detail::write_points(deck, sink);
  detail::write_materials(deck, sink);
  detail::write_properties(deck, sink);
  detail::write_line_elements(deck, sink);
  detail::write_point_elements(deck, sink);
  detail::write_dampers(deck, sink);
  detail::write_shells(deck, sink);
  detail::write_continua(deck, sink);
  detail::write_constraints(deck, sink);
  detail::write_dof_sets(deck, sink);
  detail::write_direct_matrices(deck, sink);
  detail::write_loads(deck, sink);
  detail::write_temperatures(deck, sink);
  detail::write_special(deck, sink);
  const auto& rows = detail::get_card_parsers();
  for (const auto& [name, row] : std::map(rows.begin(), rows.end()))
    if (row.write != nullptr) row.write(deck, sink);
  sink.out += "ENDDATA\n";
  return std::move(sink.out);
}

}  // namespace bough::nastran
