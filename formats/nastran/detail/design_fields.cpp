#include "formats/nastran/detail/design_fields.hpp"

#include <map>
#include <string_view>

#include "formats/nastran/detail/sections.hpp"
#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

using Names = std::map<std::string_view, int>;

/// Names of fields by card, counted from the first data field of the entry.
const std::map<std::string_view, Names>& get_names() {
  static const std::map<std::string_view, Names> names{
      {"PSHELL", {{"T", 2}, {"TS/T", 6}, {"NSM", 7}, {"Z1", 8}, {"Z2", 9}}},
      {"PBAR",
       {{"A", 2},
        {"I1", 3},
        {"I2", 4},
        {"J", 5},
        {"NSM", 6},
        {"C1", 8},
        {"C2", 9},
        {"D1", 10},
        {"D2", 11},
        {"E1", 12},
        {"E2", 13},
        {"F1", 14},
        {"F2", 15},
        {"K1", 16},
        {"K2", 17},
        {"I12", 18}}},
      {"PBEAM",
       {{"A", 2},
        {"I1", 3},
        {"I2", 4},
        {"I12", 5},
        {"J", 6},
        {"NSM", 7},
        {"A(A)", 2},
        {"I1(A)", 3},
        {"I2(A)", 4},
        {"I12(A)", 5},
        {"J(A)", 6},
        {"NSM(A)", 7}}},
      {"PROD", {{"A", 2}, {"J", 3}, {"C", 4}, {"NSM", 5}}},
      {"PTUBE", {{"OD", 2}, {"T", 3}, {"NSM", 4}, {"OD2", 5}}},
      {"PELAS", {{"K", 1}, {"K1", 1}, {"GE", 2}, {"GE1", 2}, {"S", 3}, {"S1", 3}}},
      {"PMASS", {{"M", 1}, {"M1", 1}}},
      {"PDAMP", {{"B", 1}, {"B1", 1}}},
      {"PVISC", {{"CE", 1}, {"CE1", 1}, {"CR", 2}, {"CR1", 2}}},
      {"PSHEAR", {{"T", 2}, {"NSM", 3}, {"F1", 4}, {"F2", 5}}},
      {"PGAP", {{"U0", 1}, {"F0", 2}, {"KA", 3}, {"KB", 4}, {"KT", 5}, {"MU1", 6}}},
      {"PCOMP", {{"Z0", 1}, {"NSM", 2}, {"GE", 6}}},
      {"CONM2",
       {{"M", 3},
        {"X1", 4},
        {"X2", 5},
        {"X3", 6},
        {"I11", 8},
        {"I21", 9},
        {"I22", 10},
        {"I31", 11},
        {"I32", 12},
        {"I33", 13}}},
      {"CONROD", {{"A", 4}, {"J", 5}, {"C", 6}, {"NSM", 7}}},
      {"CELAS2", {{"K", 1}, {"GE", 6}, {"S", 7}}},
      {"CMASS2", {{"M", 1}}},
      {"CMASS4", {{"M", 1}}},
      {"CBAR",
       {{"X1", 4}, {"X2", 5}, {"X3", 6}, {"W1A", 10}, {"W2A", 11}, {"W3A", 12}, {"W1B", 13}, {"W2B", 14}, {"W3B", 15}}},
      {"CBEAM",
       {{"X1", 4}, {"X2", 5}, {"X3", 6}, {"W1A", 10}, {"W2A", 11}, {"W3A", 12}, {"W1B", 13}, {"W2B", 14}, {"W3B", 15}}},
      {"CBUSH", {{"X1", 4}, {"X2", 5}, {"X3", 6}, {"S", 8}, {"S1", 10}, {"S2", 11}, {"S3", 12}}},
      {"CQUAD4", {{"THETA", 6}, {"ZOFFS", 7}, {"T1", 10}, {"T2", 11}, {"T3", 12}, {"T4", 13}}},
      {"CTRIA3", {{"THETA", 5}, {"ZOFFS", 6}, {"T1", 10}, {"T2", 11}, {"T3", 12}}},
      {"MAT1", {{"E", 1}, {"G", 2}, {"NU", 3}, {"RHO", 4}, {"A", 5}, {"TREF", 6}, {"GE", 7}}},
      {"MAT2",
       {{"G11", 1},
        {"G12", 2},
        {"G13", 3},
        {"G22", 4},
        {"G23", 5},
        {"G33", 6},
        {"RHO", 7},
        {"A1", 8},
        {"A2", 9},
        {"A3", 10},
        {"TREF", 11},
        {"GE", 12}}},
      {"MAT8",
       {{"E1", 1},
        {"E2", 2},
        {"NU12", 3},
        {"G12", 4},
        {"G1Z", 5},
        {"G2Z", 6},
        {"RHO", 7},
        {"A1", 8},
        {"A2", 9},
        {"TREF", 10},
        {"GE", 16}}},
  };
  return names;
}

/// The number after `stem`, "DIM2" or "DIM2(A)", or 0.
int get_number(std::string_view name, std::string_view stem, char& end) {
  if (name.substr(0, stem.size()) != stem) return 0;
  name.remove_prefix(stem.size());
  end = 'A';
  if (name.size() > 3 && name[name.size() - 3] == '(' && name.back() == ')') {
    end = name[name.size() - 2];
    name.remove_suffix(3);
  }
  return parse_int(name).value_or(0);
}

std::string_view get(const CardText& text, int i) {
  const auto k = static_cast<std::size_t>(i);
  return i >= 0 && k < text.fields.size() ? text.fields[k] : std::string_view{};
}

/// DIMn of PBARL, DIMn(A) and DIMn(B) of PBEAML: end B is the only station after end A.
int find_dimension(const CardText& text, const std::string& name) {
  char end = 'A';
  const int n = get_number(name, "DIM", end);
  const int count = get_num_dimensions(make_upper(get(text, 3)));
  if (n < 1 || n > count) return -1;
  if (end == 'A') return 7 + n;
  const int station = 9 + count;
  const auto x = parse_real(get(text, station + 1));
  const bool is_end = end == 'B' && text.name == "PBEAML" && (!x || *x == 1) && !get(text, station + 1 + n).empty();
  return is_end ? station + 1 + n : -1;
}

/// A(B) to NSM(B) of PBEAM: at the station X/XB = 1. A station has SO, X/XB, six values and, of SO = YES, a line of
/// stress points.
int find_beam_end(const CardText& text, const std::string& name) {
  static const Names offsets{{"A(B)", 2}, {"I1(B)", 3}, {"I2(B)", 4}, {"I12(B)", 5}, {"J(B)", 6}, {"NSM(B)", 7}};
  const auto offset = offsets.find(name);
  if (offset == offsets.end()) return -1;
  const auto is_station = [&](int at) {
    return is_word(get(text, at), "YES") || is_word(get(text, at), "NO") || is_word(get(text, at), "YESA");
  };
  for (int at = is_station(8) ? 8 : 16; is_station(at); at += is_word(get(text, at), "YES") ? 16 : 8)
    if (parse_real(get(text, at + 1)).value_or(1) == 1) return at + offset->second;
  return -1;
}

/// K1 to K6, B1 to B6, GE1 to GE6, M of PBUSH: after the flag of their line.
int find_bush_value(const CardText& text, const std::string& name) {
  for (const std::string_view flag : {"K", "B", "GE", "M"}) {
    char end = 'A';
    const int n = name == flag ? 1 : get_number(name, flag, end);
    if (n < 1 || n > 6) continue;
    for (int line = 0; line < static_cast<int>(text.fields.size()); line += 8)
      if (is_word(get(text, line + 1), flag)) return line + 1 + n;
  }
  return -1;
}

}  // namespace

int find_entry(const CardText& text, int id) {
  const int stride = text.name == "PELAS" || text.name == "PVISC"   ? 4
                     : text.name == "PMASS" || text.name == "PDAMP" ? 2
                                                                    : 8;
  for (int first = 0; first < 8; first += stride)
    if (parse_int(get(text, first)) == id) return first;
  return -1;
}

int find_design_field(const CardText& text, const std::string& name, int first) {
  if (const auto field = parse_int(name)) {
    // Ten fields to a line, of which the first and the last are no data.
    const int line = (*field - 1) / 10, column = (*field - 1) % 10;
    return *field > 1 && column > 0 && column < 9 ? 8 * line + column - 1 : -1;
  }
  const auto card = get_names().find(text.name);
  if (card != get_names().end())
    if (const auto field = card->second.find(name); field != card->second.end()) return first + field->second;
  if (text.name == "PBARL" || text.name == "PBEAML") return find_dimension(text, name);
  if (text.name == "PBEAM") return find_beam_end(text, name);
  if (text.name == "PBUSH") return find_bush_value(text, name);
  char end = 'A';
  if (text.name == "PCOMP") {
    if (const int n = get_number(name, "THETA", end); n > 0) return 8 + 4 * (n - 1) + 2;
    if (const int n = get_number(name, "T", end); n > 0) return 8 + 4 * (n - 1) + 1;
  }
  return -1;
}

}  // namespace bough::nastran::detail
