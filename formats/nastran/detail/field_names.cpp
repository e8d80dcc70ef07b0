#include "formats/nastran/detail/field_names.hpp"

#include <map>
#include <sstream>

#include "formats/nastran/detail/reading.hpp"

namespace bough::nastran::detail {
namespace {

using Names = std::map<std::string, std::vector<std::string>, std::less<>>;

constexpr const char* coord1 = "CID G1 G2 G3";
constexpr const char* coord2 = "CID RID A1 A2 A3 B1 B2 B3 C1 C2 C3";
constexpr const char* quad = "EID PID G1 G2 G3 G4 THETA ZOFFS - TFLAG T1 T2 T3 T4";
constexpr const char* triangle = "EID PID G1 G2 G3 THETA ZOFFS - - TFLAG T1 T2 T3";

constexpr const char* cards[][2] = {
    {"CORD1R", coord1},
    {"CORD1C", coord1},
    {"CORD1S", coord1},
    {"CORD2R", coord2},
    {"CORD2C", coord2},
    {"CORD2S", coord2},
    {"MAT1", "MID E G NU RHO A TREF GE ST SC SS MCSID"},
    {"PCOMP",
     "PID Z0 NSM SB FT TREF GE LAM MID1 T1 THETA1 SOUT1 MID2 T2 THETA2 SOUT2 MID3 T3 THETA3 SOUT3 MID4 T4 THETA4 SOUT4 "
     "MID5 T5 THETA5 SOUT5 MID6 T6 THETA6 SOUT6 MID7 T7 THETA7 SOUT7 MID8 T8 THETA8 SOUT8"},
    {"CQUAD4", quad},
    {"CQUADR", quad},
    {"CTRIA3", triangle},
    {"CTRIAR", triangle},
};

Names make_names() {
  Names names;
  const auto add = [&](std::string_view card, const char* text) {
    auto& list = names[std::string(card)];
    std::istringstream words(text);
    for (std::string word; words >> word;) list.push_back(word);
  };
  for (const auto& card : cards) add(card[0], card[1]);
  for (const auto& [card, row] : get_card_parsers())
    if (row.names != nullptr) add(card, row.names);
  return names;
}

}  // namespace

const std::vector<std::string>& get_field_names(std::string_view card) {
  static const Names names = make_names();
  static const std::vector<std::string> none;
  const auto found = names.find(card);
  return found == names.end() ? none : found->second;
}

int get_entry_size(std::string_view card) {
  if (card.starts_with("CORD1")) return 4;
  const auto found = get_card_parsers().find(card);
  return found == get_card_parsers().end() ? 0 : found->second.entry_size;
}

}  // namespace bough::nastran::detail
