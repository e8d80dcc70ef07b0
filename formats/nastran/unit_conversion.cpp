#include "formats/nastran/unit_conversion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "formats/nastran/detail/card_facts.hpp"
#include "formats/nastran/detail/unit_converter.hpp"

namespace bough::nastran {
namespace detail {

UnitConverter::UnitConverter(const DeckEditor& deck, const UnitFactors& factors, Diagnostics& diagnostics)
    : factors_(factors), diagnostics_(diagnostics), cards_(deck.list_cards()) {
  notes_.matrix_kinds = deck.list_matrix_kinds();
}

std::vector<FieldEdit> UnitConverter::convert() {
  for (const auto& card : cards_) {
    card_ = &card;
    const auto* facts = find_card_facts(card.name);
    if (facts != nullptr && facts->note != nullptr) facts->note(*this, notes_);
  }
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

void UnitConverter::convert_card() {
  const auto* facts = find_card_facts(card_->name);
  if (facts == nullptr)
    refuse_unknown();
  else if (facts->convert != nullptr)
    facts->convert(*this);
  else
    scale_words();
}

bool UnitConverter::keeps_time() const { return std::abs(factors_.time - 1) < 1e-14; }

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
void UnitConverter::fail_card(const std::string& why, const std::string& advice) {
  diagnostics_.error("deck.unit-card", card_->at, why, advice);
}

double UnitConverter::calc_factor(const std::string& word) const {
  if (word == ".") return 1;
  const auto* d = find_dimension(word);
  BOUGH_DEMAND(d != nullptr);
  return std::pow(factors_.mass, d->mass) * std::pow(factors_.length, d->length) * std::pow(factors_.time, d->time);
}

void UnitConverter::scale(int field, const std::string& word) {
  if (word == "." || get(field).empty()) return;
  const auto value = parse_real(get(field));
  if (value && *value == 0) return;
  if (word == "?" || word == "??") {
    fail(field, word == "?" ? "nothing tells its dimension"
                            : "the cards that name the table give its values different dimensions");
    return;
  }
  if (!value) return;  // a word, or what the reader of the deck reports
  const double factor = calc_factor(word);
  if (std::abs(factor - 1) < 1e-14) return;
  // Fifteen digits: powers of ten give no noise in the last one.
  char text[40];
  std::snprintf(text, sizeof text, "%.15g", *value * factor);
  edits_.push_back({{card_->card, field}, format_field(*parse_real(text))});
}
void UnitConverter::scale(int first, int last, const std::string& word) {
  for (int field = first; field <= last; ++field) scale(field, word);
}
void UnitConverter::scale_words(int end) {
  const auto& words = get_dimension_words(card_->name);
  for (int i = 0; i < std::min(end, static_cast<int>(words.size())); ++i) scale(i, words[static_cast<std::size_t>(i)]);
}

Axes UnitConverter::get_axes(int cid) const {
  const auto found = notes_.axes.find(cid);
  return found == notes_.axes.end() ? Axes::Rectangular : found->second;
}
void UnitConverter::scale_point(int field, Axes axes) {
  scale(field, "L");
  if (axes == Axes::Rectangular) scale(field + 1, "L");
  if (axes != Axes::Spherical) scale(field + 2, "L");
}
void UnitConverter::scale_lengths(int field, int cid) {
  if (get_axes(cid) != Axes::Rectangular) {
    for (int i = field; i < field + 3; ++i)
      if (!get(i).empty() && parse_real(get(i)) != 0.0) return fail(i, "its coordinate system has angles");
  }
  scale(field, field + 2, "L");
}

void UnitConverter::scale_by(Motion motion, int field, const char* translation, const char* rotation,
                             const char* mixed) {
  if (parse_real(get(field)).value_or(get(field).empty() ? 0 : 1) == 0) return;  // blank is zero
  if (motion == Motion::Mixed && std::string_view(mixed) == "?" && factors_.length != 1)
    return fail(field, "it acts between a translation and a rotation, whose forces take different factors");
  if (motion == Motion::Mixed && std::string_view(mixed) == "?") mixed = translation;
  scale(field, motion == Motion::Translation ? translation
               : motion == Motion::Rotation  ? rotation
               : motion == Motion::Mixed     ? mixed
                                             : "?");
}
Motion UnitConverter::find_motion(const std::string& c1, const std::string& c2, bool has_second) {
  bool translates = false, rotates = false;
  for (const auto* text : {&c1, &c2}) {
    if (text == &c2 && !has_second) continue;
    const int c = parse_int(*text).value_or(0);
    if (c < 1 || c > 6) return Motion::Unknown;
    (c <= 3 ? translates : rotates) = true;
  }
  return translates && rotates ? Motion::Mixed : translates ? Motion::Translation : Motion::Rotation;
}
Motion UnitConverter::find_scalar_motion() const { return find_motion(get(3), get(5), get_int(4) > 0); }
Motion UnitConverter::find_property_motion(const std::string& element, const std::string& pid) const {
  const auto found = notes_.motions.find(element + " " + pid);
  if (found == notes_.motions.end() || found->second.size() != 1) return Motion::Unknown;
  return *found->second.begin();
}
Motion UnitConverter::find_components(int field) const {
  bool translates = false, rotates = false;
  for (const char c : get(field)) {
    if (c < '1' || c > '6') return Motion::Unknown;
    (c <= '3' ? translates : rotates) = true;
  }
  if (!translates && !rotates) return Motion::Unknown;
  return translates && rotates ? Motion::Mixed : translates ? Motion::Translation : Motion::Rotation;
}

void note_scalar_element(const UnitConverter& u, UnitNotes& notes) {
  const auto& pid = u.get(1).empty() ? u.get(0) : u.get(1);
  notes.motions[u.get_name().substr(0, 5) + " " + pid].insert(u.find_scalar_motion());
}
void note_scalar_points(const UnitConverter& u, UnitNotes& notes) {
  for (const int first : {0, 4}) {
    if (u.get(first).empty()) continue;
    const auto& pid = u.get(first + 1).empty() ? u.get(first) : u.get(first + 1);
    notes.motions[u.get_name().substr(0, 5) + " " + pid].insert(Motion::Unknown);
  }
}

/// Reals have a point or an exponent; ids and words have no dimension.
void UnitConverter::refuse_unknown() {
  for (int i = 0; i < size(); ++i) {
    if (get(i).empty() || parse_int(get(i)) || !parse_real(get(i))) continue;
    return fail_card("the dimensions of the fields of " + card_->name + " are not known here",
                     "convert this card by hand, or take it out");
  }
}

}  // namespace detail

std::vector<FieldEdit> convert_units(const DeckEditor& deck, const UnitFactors& factors, Diagnostics& diagnostics) {
  return detail::UnitConverter(deck, factors, diagnostics).convert();
}

}  // namespace bough::nastran
