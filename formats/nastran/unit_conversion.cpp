#include "formats/nastran/unit_conversion.hpp"

#include <cmath>
#include <cstdio>

#include "formats/nastran/detail/field_dimensions.hpp"
#include "formats/nastran/detail/text.hpp"
#include "formats/nastran/detail/unit_converter.hpp"

namespace bough::nastran {
namespace detail {
namespace {

/// TYPE of a load over frequency or time: 0 force, 1 motion, 2 velocity, 3 acceleration.
int find_excitation(const std::string& type) {
  const auto word = make_upper(type);
  const char first = word.empty() ? 'L' : word[0];
  return first == 'D' || first == '1' ? 1 : first == 'V' || first == '2' ? 2 : first == 'A' || first == '3' ? 3 : 0;
}

}  // namespace

UnitConverter::UnitConverter(const DeckEditor& deck, const UnitFactors& factors, Diagnostics& diagnostics)
    : factors_(factors),
      diagnostics_(diagnostics),
      cards_(deck.list_cards()),
      matrix_kinds_(deck.list_matrix_kinds()) {}

std::vector<FieldEdit> UnitConverter::convert() {
  for (const auto& card : cards_) note_card(card);
  for (const auto& card : cards_) {
    if (card.is_replicated) {
      diagnostics_.error("deck.unit-replication", card.at, card.name + " is written or copied by replication",
                         "write the deck out with bough export --to bdf first");
      continue;
    }
    card_ = &card;
    convert_card();
  }
  return edits_;
}

const std::string& UnitConverter::get(int field) const {
  static const std::string blank;
  const auto i = static_cast<std::size_t>(field);
  return i < card_->fields.size() ? card_->fields[i] : blank;
}
int UnitConverter::get_int(int field) const { return parse_int(get(field)).value_or(0); }

void UnitConverter::fail(int field, const std::string& why) {
  diagnostics_.error("deck.unit-field", card_->at,
                     card_->name + " has " + get(field) + " in data field " + std::to_string(field + 1) + ": " + why,
                     "convert this card by hand");
}

void UnitConverter::scale(int field, const std::string& word) {
  if (word == "." || get(field).empty()) return;
  const auto value = parse_real(get(field));
  if (value && *value == 0) return;
  if (word == "?") {
    fail(field, "nothing tells its dimension");
    return;
  }
  if (!value) return;  // a word, or what the reader of the deck reports
  const auto d = get_dimension(word);
  const double factor =
      std::pow(factors_.mass, d.mass) * std::pow(factors_.length, d.length) * std::pow(factors_.time, d.time);
  if (*value == 0 || std::abs(factor - 1) < 1e-14) return;
  // Fifteen digits: powers of ten give no noise in the last one.
  char text[40];
  std::snprintf(text, sizeof text, "%.15g", *value * factor);
  edits_.push_back({{card_->card, field}, format_field(*parse_real(text))});
}
void UnitConverter::scale(int first, int last, const std::string& word) {
  for (int field = first; field <= last; ++field) scale(field, word);
}

UnitConverter::Axes UnitConverter::get_axes(int cid) const {
  const auto found = axes_.find(cid);
  return found == axes_.end() ? Axes::Rectangular : found->second;
}
void UnitConverter::scale_point(int field, Axes axes) {
  scale(field, "L");
  if (axes == Axes::Rectangular) scale(field + 1, "L");
  if (axes != Axes::Spherical) scale(field + 2, "L");
}
void UnitConverter::scale_lengths(int field, int cid) {
  if (get_axes(cid) != Axes::Rectangular) {
    for (int i = field; i < field + 3; ++i)
      if (!get(i).empty()) return fail(i, "its coordinate system has angles");
  }
  scale(field, field + 2, "L");
}

UnitConverter::Motion UnitConverter::find_motion(const std::string& c1, const std::string& c2, bool has_second) {
  bool translates = false, rotates = false;
  for (const auto* text : {&c1, &c2}) {
    if (text == &c2 && !has_second) continue;
    const int c = parse_int(*text).value_or(0);
    if (c < 1 || c > 6) return Motion::Unknown;
    (c <= 3 ? translates : rotates) = true;
  }
  return translates && rotates ? Motion::Mixed : translates ? Motion::Translation : Motion::Rotation;
}
std::string UnitConverter::choose(Motion motion, const char* translation, const char* rotation, const char* mixed) {
  if (motion == Motion::Translation) return translation;
  if (motion == Motion::Rotation) return rotation;
  return motion == Motion::Mixed ? mixed : "?";
}
UnitConverter::Motion UnitConverter::find_property_motion(const std::string& element, const std::string& pid) const {
  const auto found = motions_.find(element + " " + pid);
  if (found == motions_.end() || found->second.size() != 1) return Motion::Unknown;
  return *found->second.begin();
}

void UnitConverter::note_card(const DeckCard& card) {
  card_ = &card;
  const auto& name = card.name;
  if (name == "CORD1C" || name == "CORD1S") {
    for (const int first : {0, 4})
      if (get_int(first) > 0) axes_[get_int(first)] = name == "CORD1C" ? Axes::Cylindrical : Axes::Spherical;
  }
  if (name == "CORD2C") axes_[get_int(0)] = Axes::Cylindrical;
  if (name == "CORD2S") axes_[get_int(0)] = Axes::Spherical;
  if (name == "GRDSET") default_system_ = get_int(1);
  if (name == "GRID") grids_.insert(get(0));
  if (name == "RLOAD1" || name == "RLOAD2") {
    table_axes_[get(4)].insert("Hz");
    table_axes_[get(5)].insert("Hz");
    enforced_[get(1)].insert(find_excitation(get(6)));
  }
  if (name == "TLOAD1") table_axes_[get(4)].insert("T");
  if (name == "TLOAD1" || name == "TLOAD2") enforced_[get(1)].insert(find_excitation(get(3)));
  if (name == "CELAS1" || name == "CMASS1" || name == "CDAMP1") {
    const auto pid = get(1).empty() ? get(0) : get(1);
    motions_[name + " " + pid].insert(find_motion(get(3), get(5), get_int(4) > 0));
  }
  if (name == "CELAS3" || name == "CMASS3" || name == "CDAMP3")
    for (const int first : {0, 4})
      if (!get(first).empty())
        motions_[name.substr(0, 5) + "1 " + (get(first + 1).empty() ? get(first) : get(first + 1))].insert(
            Motion::Unknown);
  if (name == "DMIG" && get(1) == "0" && get_int(5) > 0) polar_matrices_.insert(make_upper(get(0)));
}

void UnitConverter::convert_card() {
  const auto& name = card_->name;
  if (name == "GRID") return scale_point(2, get_axes(get(1).empty() ? default_system_ : get_int(1)));
  if (name == "CORD2R" || name == "CORD2C" || name == "CORD2S") {
    for (const int field : {2, 5, 8}) scale_point(field, get_axes(get_int(1)));
    return;
  }
  if (name == "MAT8") return convert_mat8();
  if (name == "PBEAM") return convert_pbeam();
  if (name == "PBCOMP") return convert_pbcomp();
  if (name == "PBEND") return convert_pbend();
  if (name == "PBARL" || name == "PBEAML") return convert_section();
  if (name == "PCOMP" || name == "PCOMPG" || name == "PCOMP2") return convert_plies();
  if (name == "PELAS" || name == "PMASS" || name == "PDAMP") return convert_scalar_property();
  if (name == "CELAS2" || name == "CMASS2" || name == "CDAMP2") {
    const auto motion = find_motion(get(3), get(5), get_int(4) > 0);
    scale(1, name == "CELAS2"   ? choose(motion, "K", "Q", "F")
             : name == "CMASS2" ? choose(motion, "M", "J", "ML")
                                : choose(motion, "B", "BR", "BL"));
    if (name == "CELAS2") scale(7, "?");
    return;
  }
  if (name == "PBUSH") return convert_pbush();
  if (name == "CBUSH") {
    if (get_int(9) >= 0) scale_lengths(10, get_int(9));
    return;
  }
  if (name == "CONM2") {
    scale(3, "M");
    if (get_int(2) == -1)
      scale(4, 6, "L");
    else
      scale_lengths(4, get_int(2));
    scale(8, 13, "J");
    return;
  }
  if (name == "SPC" || name == "SPCD") return convert_spcd();
  if (name == "MPC") return convert_mpc();
  if (name == "NSM" || name == "NSM1" || name == "NSML" || name == "NSML1") return convert_nonstructural();
  if (name == "PARAM") return convert_param();
  if (name == "DMIG") return convert_dmig();
  if (name == "GENEL") return convert_genel();
  if (name == "SEBULK")
    return diagnostics_.error("deck.unit-card", card_->at, "SEBULK takes matrices from a file, which keeps its units",
                              "convert the deck of the component and write its files again");
  if (!convert_static_load() && !convert_dynamic() && !convert_by_table()) refuse_unknown();
}

bool UnitConverter::convert_static_load() {
  const auto& name = card_->name;
  if (name == "PLOAD1") {
    convert_pload1();
  } else if (name == "ACCEL") {
    for (int i = 8; i < size(); i += 2) {
      scale(i, "L");
      scale(i + 1, "G");
    }
  } else if (name == "SLOAD") {
    for (const int i : {1, 3, 5})
      if (!get(i).empty()) scale(i + 1, grids_.count(get(i)) > 0 ? "F" : "?");
  } else {
    return false;
  }
  return true;
}

bool UnitConverter::convert_by_table() {
  const auto& name = card_->name;
  const auto* words = find_field_words(name);
  if (words == nullptr) return false;
  for (int i = 0; i < static_cast<int>(words->size()); ++i) {
    // TFLAG 1: thicknesses are shares of the property's.
    const bool is_relative = (name == "CQUAD4" || name == "CQUADR") && i >= 10 && get(9) == "1";
    const bool is_relative_triangle = (name == "CTRIA3" || name == "CTRIAR") && i >= 10 && get(9) == "1";
    const bool is_relative_high =
        (name == "CQUAD8" && i >= 10 && i <= 13 && get(16) == "1") || (name == "CTRIA6" && i >= 10 && get(13) == "1");
    if (!is_relative && !is_relative_triangle && !is_relative_high) scale(i, (*words)[static_cast<std::size_t>(i)]);
  }
  // Fields after those of a spring of PBUSH1D are its nonlinear parts.
  for (int i = 8; i < size() && name == "PBUSH1D"; ++i) scale(i, "?");
  return true;
}

/// Reals have a point or an exponent; ids and words have no dimension.
void UnitConverter::refuse_unknown() {
  for (int i = 0; i < size(); ++i) {
    if (get(i).empty() || parse_int(get(i)) || !parse_real(get(i))) continue;
    diagnostics_.error("deck.unit-card", card_->at,
                       "the dimensions of the fields of " + card_->name + " are not known here",
                       "convert this card by hand, or take it out");
    return;
  }
}

UnitConverter::Motion UnitConverter::find_components(int field) const {
  bool translates = false, rotates = false;
  for (const char c : get(field)) {
    if (c < '1' || c > '6') return Motion::Unknown;
    (c <= '3' ? translates : rotates) = true;
  }
  if (!translates && !rotates) return Motion::Unknown;
  return translates && rotates ? Motion::Mixed : translates ? Motion::Translation : Motion::Rotation;
}

}  // namespace detail

std::vector<FieldEdit> convert_units(const DeckEditor& deck, const UnitFactors& factors, Diagnostics& diagnostics) {
  return detail::UnitConverter(deck, factors, diagnostics).convert();
}

}  // namespace bough::nastran
