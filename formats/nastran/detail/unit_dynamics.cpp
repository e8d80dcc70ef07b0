/// Loads over frequency and time, and enforced motions. Tables are pure numbers over hertz or time: the units of a load
/// are those of its DAREA, static loads or SPCD.
#include <cmath>

#include "formats/nastran/detail/text.hpp"
#include "formats/nastran/detail/unit_converter.hpp"

namespace bough::nastran::detail {

bool UnitConverter::convert_dynamic() {
  const auto& name = card_->name;
  if (name == "DAREA") {
    for (const int first : {1, 4})
      if (!get(first).empty()) scale(first + 2, choose(find_components(first + 1), "F", "Q", "?"));
  } else if (name == "TIC") {
    const auto motion = find_components(2);
    scale(3, choose(motion, "L", ".", "?"));
    scale(4, choose(motion, "V", "Hz", "?"));
  } else if (name == "RLOAD1" || name == "RLOAD2" || name == "TLOAD1" || name == "TLOAD2") {
    if (!parse_int(get(2))) scale(2, "T");  // a time; an integer is a set of DELAY
    if (name == "TLOAD1") scale(5, 6, "?");
    if (name == "TLOAD2") convert_tload2();
  } else if (name == "FREQ") {
    scale(1, size() - 1, "Hz");
  } else if (name == "TSTEP") {
    for (int line = 0; line < size(); line += 8) scale(line + 2, "T");
  } else if (name == "EIGC") {
    // Shifts, or ends and width of regions; LAN and CLAN have block sizes there.
    const bool has_ends = get(1) == "INV" || get(1) == "DET";
    for (int line = 8; line < size(); line += 8) scale(line, line + (has_ends ? 4 : 1), "Hz");
  } else if (name == "RANDPS") {
    if (parse_int(get(5)).value_or(0) == 0) scale(3, 4, "T");  // per hertz, as G of a table
  } else if (name == "RANDT1") {
    scale(2, 3, "T");
  } else if (name == "TABRND1") {
    for (int i = 8; i < size(); i += 2) {
      scale(i, "Hz");
      scale(i + 1, "T");
    }
  } else if (name == "TABRNDG") {
    scale(2, "T");
    scale(3, "?");
  } else if (name == "TABDMP1") {
    for (int i = 8; i < size(); i += 2) scale(i, "Hz");
  } else if (name.starts_with("TABLED") && name.size() == 7) {
    convert_table();
  } else {
    return false;
  }
  return true;
}

/// Where an SPCD is the excitation of a load of TYPE VELO or ACCE it is a velocity or acceleration.
void UnitConverter::convert_spcd() {
  const auto found = enforced_.find(get(0));
  const bool is_excited = card_->name == "SPCD" && found != enforced_.end();
  const int order = is_excited && *found->second.begin() > 0 ? *found->second.begin() - 1 : 0;
  static constexpr const char *length[] = {"L", "V", "G"}, *angle[] = {".", "Hz", "Hz2"};
  for (const int first : {1, 4}) {
    if (parse_real(get(first + 2)).value_or(0) == 0) continue;
    const bool is_unsure = is_excited && found->second.size() > 1 && std::abs(factors_.time - 1) > 1e-14;
    scale(first + 2, is_unsure ? "?" : choose(find_components(first + 1), length[order], angle[order], "?"));
  }
}

/// t^B exp(C t) cos(2 pi F t + P) between T1 and T2: with B the load has a unit of time in it.
void UnitConverter::convert_tload2() {
  scale(4, 5, "T");
  scale(6, "Hz");
  scale(8, "Hz");
  if (parse_real(get(9)).value_or(0) != 0 && std::abs(factors_.time - 1) > 1e-14) scale(9, "?");
  scale(10, 11, "?");
}

void UnitConverter::convert_table() {
  const auto found = table_axes_.find(get(0));
  const bool is_sure = found != table_axes_.end() && found->second.size() == 1;
  const std::string axis = is_sure ? *found->second.begin() : std::abs(factors_.time - 1) < 1e-14 ? "." : "?";
  const char kind = card_->name.back();
  if (kind == '2') scale(1, axis);
  if (kind == '3') scale(1, 2, axis);
  if (kind == '4') scale(1, 4, axis);
  if (kind == '3' || kind == '4') return;  // of (x - X1) / X2
  for (int i = 8; i < size(); i += 2) scale(i, axis);
}

}  // namespace bough::nastran::detail
