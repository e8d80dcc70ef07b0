#include <algorithm>

#include "formats/nastran/detail/field_dimensions.hpp"
#include "formats/nastran/detail/text.hpp"
#include "formats/nastran/detail/unit_converter.hpp"

namespace bough::nastran::detail {

void UnitConverter::convert_mat8() {
  for (const int field : {1, 2, 4, 5, 6}) scale(field, "P");
  scale(7, "R");
  const bool are_strains = parse_real(get(18)).value_or(0) == 1;
  if (!are_strains) {
    scale(11, 15, "P");
    scale(17, "1/P2");
  }
}

void UnitConverter::convert_pbeam() {
  const auto scale_station = [&](int first) {
    scale(first, "A");
    scale(first + 1, first + 4, "I");
    scale(first + 5, "N");
  };
  const auto is_station = [&](int first) {
    return is_word(get(first), "YES") || is_word(get(first), "YESA") || is_word(get(first), "NO");
  };
  scale_station(2);
  int line = 8;
  if (!is_station(line)) {
    scale(line, line + 7, "L");
    line += 8;
  }
  while (line < size() && is_station(line)) {
    scale_station(line + 2);
    const bool has_points = is_word(get(line), "YES");
    line += 8;
    if (!has_points || is_station(line)) continue;
    scale(line, line + 7, "L");
    line += 8;
  }
  // K1 K2 S1 S2 NSI(A) NSI(B) CW(A) CW(B), then the offsets of the mass and of the neutral axis.
  scale(line + 4, line + 5, "ML");
  scale(line + 6, line + 7, "L6");
  scale(line + 8, line + 15, "L");
}

void UnitConverter::convert_section() {
  auto type = make_upper(get(3));
  const int dims = get_num_section_dims(type);
  if (dims == 0) return fail(3, "the section is not known");
  scale(8, 8 + dims - 1, "L");
  scale(8 + dims, "N");
  if (card_->name == "PBARL") return;
  for (int station = 9 + dims; station < size(); station += dims + 3) {
    scale(station + 2, station + 1 + dims, "L");
    scale(station + 2 + dims, "N");
  }
}

/// K1 K2 M1 M2 N1 N2 SECTION, then lines of Y Z C MID.
void UnitConverter::convert_pbcomp() {
  scale(2, "A");
  scale(3, 6, "I");
  scale(7, "N");
  scale(10, 13, "L");
  for (int line = 16; line < size(); line += 8) scale(line, line + 1, "L");
}

/// A card with its section, or with that of a pipe (FSI, RM, T, P).
void UnitConverter::convert_pbend() {
  const bool is_pipe = !get(2).empty() && parse_int(get(2));
  if (is_pipe) {
    scale(3, 4, "L");
    scale(5, "P");
    scale(6, "L");
    scale(8, 9, "?");
    scale(10, "N");
    scale(11, 12, "L");
    return;
  }
  scale(2, "A");
  scale(3, 5, "I");
  scale(6, "L");
  scale(8, 15, "L");
  scale(18, "N");
  scale(19, 21, "L");
}

void UnitConverter::convert_plies() {
  scale(1, "L");
  scale(2, "S");
  scale(3, "P");
  const auto& name = card_->name;
  const int first = name == "PCOMP"    ? 1
                    : name == "PCOMPG" ? 2
                                       : 0,
            step = name == "PCOMP"    ? 4
                   : name == "PCOMPG" ? 8
                                      : 2;
  for (int ply = 8; ply < size(); ply += step) scale(ply + first, "L");
}

/// NSM: pairs of id and value; NSM1: one value. NSML and NSML1: the whole mass.
void UnitConverter::convert_nonstructural() {
  static const std::set<std::string> areas{"PSHELL", "PCOMP", "PCOMPG", "PSHEAR", "PRAC2D"};
  static const std::set<std::string> lines{"PBAR",  "PBARL", "PBEAM",  "PBEAML", "PBCOMP",
                                           "PBEND", "PROD",  "CONROD", "PTUBE"};
  const auto& name = card_->name;
  const auto type = make_upper(get(1));
  const bool is_whole = name.starts_with("NSML");
  const std::string word = is_whole ? "M" : areas.count(type) > 0 ? "S" : lines.count(type) > 0 ? "N" : "?";
  if (name.ends_with('1')) return scale(2, word);
  for (int i = 3; i < size(); i += 2) scale(i, word);
}

void UnitConverter::convert_scalar_property() {
  const auto& name = card_->name;
  const int entry = name == "PELAS" ? 4 : 2;
  for (int first = 0; first < std::min(size(), 8); first += entry) {
    if (get(first).empty()) continue;
    if (name == "PELAS") {
      scale(first + 1, choose(find_property_motion("CELAS1", get(first)), "K", "Q", "F"));
      scale(first + 3, "?");
    } else if (name == "PMASS") {
      scale(first + 1, choose(find_property_motion("CMASS1", get(first)), "M", "J", "ML"));
    } else {
      scale(first + 1, choose(find_property_motion("CDAMP1", get(first)), "B", "BR", "BL"));
    }
  }
}

void UnitConverter::convert_pbush() {
  for (int line = 0; line < size(); line += 8) {
    const auto flag = make_upper(get(line + 1));
    if (flag == "K" || flag == "B") {
      scale(line + 2, line + 4, flag == "K" ? "K" : "B");
      scale(line + 5, line + 7, flag == "K" ? "Q" : "BR");
    } else if (flag == "M") {
      scale(line + 2, "M");
    } else if (flag != "GE" && !flag.empty()) {
      for (int i = line + 2; i < line + 8; ++i) scale(i, "?");
    }
  }
}

/// Sum of a u = 0 with u in the new unit of length: the factors of rotations grow by it.
void UnitConverter::convert_mpc() {
  for (int line = 0; line < size(); line += 8)
    for (const int first : {line + 1, line + 4}) {
      if (get(first).empty()) continue;
      scale(first + 2, choose(find_components(first + 1), ".", "L", "?"));
    }
}

void UnitConverter::convert_pload1() {
  const auto type = make_upper(get(2)), kind = make_upper(get(3));
  const bool is_moment = type.starts_with("M");
  const bool is_point = get(6).empty() || get(6) == get(4);
  const std::string word = is_moment ? (is_point ? "Q" : "F") : (is_point ? "F" : "K");
  scale(5, word);
  scale(7, word);
  if (kind.starts_with("LE")) {
    scale(4, "L");
    scale(6, "L");
  }
}

void UnitConverter::convert_param() {
  static const std::map<std::string, std::string> words{
      {"W3", "Hz"},    {"W4", "Hz"},   {"ALPHA1", "Hz"}, {"ALPHA2", "T"}, {"LFREQ", "Hz"},   {"HFREQ", "Hz"},
      {"WTMASS", "."}, {"G", "."},     {"GFL", "."},     {"K6ROT", "."},  {"MAXRATIO", "."}, {"EPZERO", "."},
      {"EPPRT", "."},  {"SNORM", "."}, {"CB1", "."},     {"CB2", "."},    {"CK1", "."},      {"CK2", "."},
      {"CM1", "."},    {"CM2", "."},   {"CP1", "."},     {"CP2", "."},    {"CK3", "."},      {"BAILOUT", "."},
      {"TINY", "."},   {"SIGMA", "?"}};
  const auto found = words.find(make_upper(get(0)));
  if (found != words.end()) return scale(1, found->second);
  if (!parse_int(get(1)) && parse_real(get(1))) fail(1, "nothing tells its dimension");
}

/// NAME GJ CJ blank, then G C A B for each row; the header has no dimension.
void UnitConverter::convert_dmig() {
  if (get(1) == "0") return;
  const auto name = make_upper(get(0));
  const auto found = matrix_kinds_.find(name);
  const auto kind = found == matrix_kinds_.end() ? "?" : found->second;
  for (int i = 4; i < size(); i += 4) {
    if (get(i).empty()) continue;
    const auto motion = kind == "P" ? find_motion(get(i + 1), "", false) : find_motion(get(i + 1), get(2), true);
    const std::string word = kind == "K"   ? choose(motion, "K", "Q", "F")
                             : kind == "M" ? choose(motion, "M", "J", "ML")
                             : kind == "B" ? choose(motion, "B", "BR", "BL")
                             : kind == "P" ? choose(motion, "F", "Q", "?")
                                           : "?";
    scale(i + 2, word);
    if (polar_matrices_.count(name) == 0) scale(i + 3, word);
  }
}

/// UI and UD by pairs of grid and component; K or Z by columns from the diagonal on; S by rows.
void UnitConverter::convert_genel() {
  std::vector<std::string> ui, ud;
  const auto read_pairs = [&](int first, std::vector<std::string>& components) {
    int i = first;
    for (; i < size() && make_upper(get(i)) != "UD" && make_upper(get(i)) != "K" && make_upper(get(i)) != "Z"; ++i)
      if (!get(i).empty()) components.push_back(get(++i));
    return i;
  };
  int i = read_pairs(2, ui);
  if (make_upper(get(i)) == "UD") i = read_pairs(i + 1, ud);
  const bool is_stiffness = make_upper(get(i)) == "K";
  ++i;
  for (std::size_t column = 0; column < ui.size(); ++column)
    for (std::size_t row = column; row < ui.size() && i < size(); ++row, ++i) {
      const auto motion = find_motion(ui[row], ui[column], true);
      scale(i, is_stiffness ? choose(motion, "K", "Q", "F") : choose(motion, "1/K", "1/Q", "1/F"));
    }
  while (i < size() && make_upper(get(i)) != "S") ++i;
  ++i;
  for (const auto& row : ui)
    for (std::size_t column = 0; column < ud.size() && i < size(); ++column, ++i) {
      const auto motion = find_motion(row, ud[column], true);
      const bool is_rotation = find_motion(row, "", false) == Motion::Rotation;
      scale(i, choose(motion, ".", ".", is_rotation ? "1/L" : "L"));
    }
}

}  // namespace bough::nastran::detail
