#include "formats/nastran/detail/field_dimensions.hpp"

#include <map>
#include <sstream>

#include "base/diagnostic.hpp"
#include "formats/nastran/detail/reading.hpp"

namespace bough::nastran::detail {

namespace {

// Cards whose fields depend on others (GRID, CELAS, PBEAM, ...) are in unit_conversion.cpp.
// Layouts: Quick Reference Guide.
constexpr const char* quad = ". . . . . . . L . . L L L L";
constexpr const char* triangle = ". . . . . . L . . . L L L";
constexpr const char* plate = ". . L S . . L S";
constexpr const char* solid = "";
constexpr const char* nothing = "";
constexpr const char* table[][2] = {
    {"CORD1R", nothing},
    {"CORD1C", nothing},
    {"CORD1S", nothing},
    {"MAT1", ". P P . R . . . P P P ."},
    {"PCOMP1", ". L S P . . L ."},
    {"CQUAD4", quad},
    {"CQUADR", quad},
    {"CTRIA3", triangle},
    {"CTRIAR", triangle},
    {"CPYRAM", solid},
    {"CPYRA", solid},
    // Nothing tells whether a scalar point is a translation or a rotation.
    {"DLOAD", nothing},
    {"DPHASE", nothing},
    {"DELAY", ". . . T . . T"},
    {"FREQ1", ". Hz Hz ."},
    {"FREQ2", ". Hz Hz ."},
    {"FREQ3", ". Hz Hz . . ."},
    {"FREQ4", ". Hz Hz . ."},
    {"FREQ5", ". Hz Hz"},
    // NASTRAN-95, User's Manual, section 2.4.
    {"PQUAD1", ". . L . L3 . L S L L"},
    {"PTRIA1", ". . L . L3 . L S L L"},
    {"PQUAD2", plate},
    {"PTRIA2", plate},
    {"PQDMEM", plate},
    {"PQDMEM1", plate},
    {"PQDMEM2", plate},
    {"PTRMEM", plate},
    {"PQDPLT", ". . L3 . L S L L"},
    {"PTRPLT", ". . L3 . L S L L"},
    {"PTRBSC", ". . L3 . L S L L"},
    {"CQUAD1", nothing},
    {"CTRIA1", nothing},
    {"CQUAD2", nothing},
    {"CTRIA2", nothing},
    {"CQDMEM", nothing},
    {"CQDMEM1", nothing},
    {"CQDMEM2", nothing},
    {"CTRMEM", nothing},
    {"CQDPLT", nothing},
    {"CTRPLT", nothing},
    {"CTRBSC", nothing},
    {"CTRIM6", nothing},
    {"CTRPLT1", nothing},
    {"CTRSHL", nothing},
    {"CHEXA1", nothing},
    {"CHEXA2", nothing},
    {"CWEDGE", nothing},
    {"CRIGD3", nothing},
    {"CRBE1", nothing},
};

const std::map<std::string_view, Dimension> dimensions{
    {"L", {0, 1, 0}},   {"A", {0, 2, 0}},     {"I", {0, 4, 0}},     {"L6", {0, 6, 0}},    {"1/L", {0, -1, 0}},
    {"L3", {0, 3, 0}},  {"1/K", {-1, 0, 2}},  {"1/F", {-1, -1, 2}}, {"1/Q", {-1, -2, 2}}, {"P", {1, -1, -2}},
    {"R", {1, -3, 0}},  {"M", {1, 0, 0}},     {"ML", {1, 1, 0}},    {"J", {1, 2, 0}},     {"N", {1, -1, 0}},
    {"S", {1, -2, 0}},  {"F", {1, 1, -2}},    {"Q", {1, 2, -2}},    {"K", {1, 0, -2}},    {"B", {1, 0, -1}},
    {"BL", {1, 1, -1}}, {"BR", {1, 2, -1}},   {"G", {0, 1, -2}},    {"Hz", {0, 0, -1}},   {"Hz2", {0, 0, -2}},
    {"T", {0, 0, 1}},   {"1/P2", {-2, 2, 4}}, {"V", {0, 1, -1}}};

}  // namespace

const std::vector<std::string>* find_field_words(std::string_view card) {
  static const auto words = [] {
    std::map<std::string, std::vector<std::string>, std::less<>> made;
    const auto add = [&](std::string_view card_name, const char* text) {
      auto& list = made[std::string(card_name)];
      std::istringstream in(text);
      for (std::string word; in >> word;) list.push_back(word);
    };
    for (const auto& row : table) add(row[0], row[1]);
    for (const auto& [card_name, row] : get_card_parsers())
      if (row.dimensions != nullptr) add(card_name, row.dimensions);
    return made;
  }();
  const auto found = words.find(card);
  return found == words.end() ? nullptr : &found->second;
}

Dimension get_dimension(std::string_view word) {
  const auto found = dimensions.find(word);
  BOUGH_DEMAND(found != dimensions.end());
  return found->second;
}

int get_num_section_dims(std::string_view type) {
  static const std::map<std::string_view, int> sizes{
      {"ROD", 1},   {"TUBE", 2}, {"TUBE2", 2}, {"I", 6},    {"CHAN", 4},  {"T", 4},    {"BOX", 4},   {"BAR", 2},
      {"CROSS", 4}, {"H", 4},    {"T1", 4},    {"I1", 4},   {"CHAN1", 4}, {"Z", 4},    {"CHAN2", 4}, {"T2", 4},
      {"BOX1", 6},  {"HEXA", 3}, {"HAT", 4},   {"HAT1", 5}, {"L", 4},     {"DBOX", 10}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

}  // namespace bough::nastran::detail
