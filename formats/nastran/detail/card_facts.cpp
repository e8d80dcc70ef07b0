#include "formats/nastran/detail/card_facts.hpp"

#include <map>
#include <sstream>

#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/detail/reading.hpp"

namespace bough::nastran::detail {

const CardFacts* find_card_facts(std::string_view name) {
  const auto find = [&](const auto& table) -> const CardFacts* {
    const auto row = table.find(name);
    return row == table.end() ? nullptr : &row->second;
  };
  for (const CardFacts* facts :
       {find(get_card_parsers()), find(get_dynamic_parsers()), find(get_complex_parsers()), find(get_rotor_parsers())})
    if (facts != nullptr) return facts;
  return nullptr;
}

namespace {

struct Words {
  std::vector<std::string> dimensions, names;
};

std::vector<std::string> split(const char* text) {
  std::istringstream in(text == nullptr ? "" : text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

const Words& get_words(std::string_view card) {
  static const auto words = [] {
    std::map<std::string_view, Words> made;
    const auto add = [&](const auto& table) {
      for (const auto& [name, row] : table) made[name] = {split(row.dimensions), split(row.names)};
    };
    add(get_card_parsers());
    add(get_dynamic_parsers());
    add(get_complex_parsers());
    add(get_rotor_parsers());
    return made;
  }();
  static const Words none;
  const auto found = words.find(card);
  return found == words.end() ? none : found->second;
}

}  // namespace

const std::vector<std::string>& get_dimension_words(std::string_view card) { return get_words(card).dimensions; }
const std::vector<std::string>& get_field_names(std::string_view card) { return get_words(card).names; }

int get_entry_size(std::string_view card) {
  const auto* facts = find_card_facts(card);
  return facts == nullptr ? 0 : facts->entry_size;
}

const Dimension* find_dimension(std::string_view word) {
  static const std::map<std::string_view, Dimension> dimensions{
      {"L", {0, 1, 0}},   {"A", {0, 2, 0}},     {"I", {0, 4, 0}},     {"L6", {0, 6, 0}},    {"1/L", {0, -1, 0}},
      {"L3", {0, 3, 0}},  {"1/K", {-1, 0, 2}},  {"1/F", {-1, -1, 2}}, {"1/Q", {-1, -2, 2}}, {"P", {1, -1, -2}},
      {"R", {1, -3, 0}},  {"M", {1, 0, 0}},     {"ML", {1, 1, 0}},    {"J", {1, 2, 0}},     {"N", {1, -1, 0}},
      {"S", {1, -2, 0}},  {"F", {1, 1, -2}},    {"Q", {1, 2, -2}},    {"K", {1, 0, -2}},    {"B", {1, 0, -1}},
      {"BL", {1, 1, -1}}, {"BR", {1, 2, -1}},   {"G", {0, 1, -2}},    {"Hz", {0, 0, -1}},   {"Hz2", {0, 0, -2}},
      {"T", {0, 0, 1}},   {"1/P2", {-2, 2, 4}}, {"V", {0, 1, -1}}};
  const auto found = dimensions.find(word);
  return found == dimensions.end() ? nullptr : &found->second;
}

}  // namespace bough::nastran::detail
