#include "formats/nastran/detail/field_dimensions.hpp"

#include <map>
#include <sstream>

#include "base/diagnostic.hpp"

namespace bough::nastran::detail {

namespace {

// Cards whose fields depend on others (GRID, CELAS, PBEAM, ...) are in unit_conversion.cpp.
// Layouts: Quick Reference Guide.
constexpr const char* offsets = ". . . . . . . . . . L L L L L L";
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
    {"MAT2", ". P P P P P P R . . . . . P P P ."},
    {"MAT9", ". P P P P P P P P P P P P P P P P P P P P P R . . . . . . . ."},
    {"PBAR", ". . A I I I N . L L L L L L L L . . I"},
    {"PROD", ". . A I L N"},
    {"PTUBE", ". . L L N L"},
    {"CONROD", ". . . . A I L N"},
    {"PVISC", ". B BR . . B BR ."},
    {"PSHELL", ". . L . . . . S L L ."},
    {"PSHEAR", ". . L S . . L S"},  // F1 F2, or another one on the card
    {"MAT11", ". P P P . . . P P P R . . . . ."},
    {"PCOMP1", ". L S P . . L ."},
    {"PBUSH1D", ". K B M . . . ."},
    {"PGAP", ". L F K K K . . L . ."},
    {"PSOLID", nothing},
    {"CBAR", offsets},
    {"CBEAM", offsets},
    {"CROD", nothing},
    {"CTUBE", nothing},
    {"CBEND", nothing},
    {"CGAP", nothing},
    {"CVISC", nothing},
    {"CSHEAR", nothing},
    {"CQUAD4", quad},
    {"CQUADR", quad},
    {"CTRIA3", triangle},
    {"CTRIAR", triangle},
    {"CQUAD8", ". . . . . . . . . . L L L L . L ."},
    {"CTRIA6", ". . . . . . . . . L L L L ."},
    {"CTETRA", solid},
    {"CPENTA", solid},
    {"CHEXA", solid},
    {"CPYRAM", solid},
    {"CPYRA", solid},
    {"CELAS1", nothing},
    {"CMASS1", nothing},
    {"CDAMP1", nothing},
    {"RBE1", nothing},
    {"RBE2", nothing},
    {"RBE3", nothing},
    {"RBAR", nothing},
    {"RROD", nothing},
    {"RBAR1", nothing},
    {"RJOINT", nothing},
    {"RTRPLT", nothing},
    {"RTRPLT1", nothing},
    {"RSPLINE", nothing},  // D/L is a ratio
    {"CELAS3", nothing},
    {"CMASS3", nothing},
    {"CDAMP3", nothing},
    // Nothing tells whether a scalar point is a translation or a rotation.
    {"CELAS4", ". ? . . . ? . ."},
    {"CMASS4", ". ? . . . ? . ."},
    {"CDAMP4", ". ? . . . ? . ."},
    {"NSMADD", nothing},
    {"BAROR", nothing},
    {"BEAMOR", nothing},
    {"PLOTEL", nothing},
    {"SPC1", nothing},
    {"SPCADD", nothing},
    {"MPCADD", nothing},
    {"SUPORT", nothing},
    {"SUPORT1", nothing},
    {"ASET", nothing},
    {"ASET1", nothing},
    {"OMIT", nothing},
    {"OMIT1", nothing},
    {"QSET", nothing},
    {"QSET1", nothing},
    {"BSET", nothing},
    {"BSET1", nothing},
    {"CSET", nothing},
    {"CSET1", nothing},
    {"SPOINT", nothing},
    {"EIGRL", ". Hz Hz"},
    {"EIGR", ". . Hz Hz"},
    {"FORCE", ". . . F"},
    {"FORCE1", ". . F"},
    {"FORCE2", ". . F"},
    {"MOMENT", ". . . Q"},
    {"MOMENT1", ". . Q"},
    {"MOMENT2", ". . Q"},
    {"GRAV", ". . G"},
    {"RFORCE", ". . . Hz . . . . Hz2"},
    {"PLOAD", ". P"},
    {"PLOAD2", ". P"},
    {"PLOAD4", ". . P P P P"},
    {"LOAD", nothing},
    {"TEMP", nothing},
    {"TEMPD", nothing},
    {"TEMPP1", ". . . 1/L"},
    {"TEMPRB", ". . . . 1/L 1/L 1/L 1/L"},
    {"ACCEL1", ". . G . . ."},
    {"PLOAD3", ". P"},
    {"DLOAD", nothing},
    {"DPHASE", nothing},
    {"DELAY", ". . . T . . T"},
    {"FREQ1", ". Hz Hz ."},
    {"FREQ2", ". Hz Hz ."},
    {"FREQ3", ". Hz Hz . . ."},
    {"FREQ4", ". Hz Hz . ."},
    {"FREQ5", ". Hz Hz"},
    // NASTRAN-95, User's Manual, section 2.4.
    {"MAT6", ". P P P P P P P P P P P P P P P P P P P P P R . . . . . . . ."},
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
    {"PTRIM6", ". . L L L S"},
    {"PTRPLT1", ". . L3 L3 L3 . L L L S L L L L L L"},
    {"PTRSHL", ". . L L L . L3 L3 L3 . L L L S L L L L L L"},
    {"PIS2D8", ". . L"},
    {"PIHEX", nothing},
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
    {"CIS2D8", nothing},
    {"CHEXA1", nothing},
    {"CHEXA2", nothing},
    {"CWEDGE", nothing},
    {"CIHEX1", nothing},
    {"CIHEX2", nothing},
    {"CIHEX3", nothing},
    {"CRIGD1", nothing},
    {"CRIGD2", nothing},
    {"CRIGD3", nothing},
    {"CRIGDR", nothing},
    {"CRBAR", nothing},
    {"CRBE1", nothing},
    {"CRBE2", nothing},
    {"CRBE3", nothing},
    {"CRROD", nothing},
    {"CRTRPLT", nothing},
    {"CRSPLINE", nothing},
    {"CONM1", ". . . M M M M M M ML ML ML J ML ML ML J J ML ML ML J J J"},
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
    for (const auto& row : table) {
      auto& list = made[row[0]];
      std::istringstream in(row[1]);
      for (std::string word; in >> word;) list.push_back(word);
    }
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
