/// The table of cards: every card that is read has dimensions, a place in a deck that is written, and a row in the
/// manual, docs/formats/cards.md, which is made of it (BOUGH_WRITE_PAGES=1 writes the page).
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/detail/known_cards.hpp"
#include "formats/nastran/detail/reading.hpp"
#include "tests/support/paths.hpp"

namespace bough::nastran::detail {
namespace {

/// Name -> facts of all cards, sorted.
std::map<std::string, const CardFacts*> list_cards() {
  std::map<std::string, const CardFacts*> cards;
  const auto add = [&](const auto& table) {
    for (const auto& [name, row] : table) cards[std::string(name)] = &row;
  };
  add(get_card_parsers());
  add(get_dynamic_parsers());
  add(get_complex_parsers());
  add(get_rotor_parsers());
  return cards;
}

std::string format_dimension(const Dimension& d) {
  static const std::map<char, const char*> raised{{'-', "⁻"}, {'1', ""},  {'2', "²"},
                                                  {'3', "³"}, {'4', "⁴"}, {'6', "⁶"}};
  std::string text;
  for (const auto& [letter, power] : {std::pair('M', d.mass), std::pair('L', d.length), std::pair('T', d.time)}) {
    if (power == 0) continue;
    text += (text.empty() ? "" : " ") + std::string(1, letter);
    const auto digits = std::to_string(power);
    for (const char c : digits) text += c == '1' && power == -1 ? "¹" : raised.at(c);
  }
  return text;
}

std::string format_word(const std::string& word) {
  return word == "." ? "" : word == "?" ? " [?]" : " [" + format_dimension(*find_dimension(word)) + "]";
}

/// "EID PID A [L²]", or "data field 3 [L²]" for a card whose fields have no names.
std::string list_fields(const std::string& card) {
  const auto& names = get_field_names(card);
  const auto& words = get_dimension_words(card);
  std::string text;
  for (std::size_t i = 0; i < std::max(names.size(), words.size()); ++i) {
    const auto dimension = i < words.size() ? format_word(words[i]) : "";
    if (i < names.size())
      text += (text.empty() ? "" : ", ") + ("`" + names[i] + "`") + dimension;
    else if (!dimension.empty())
      text += (text.empty() ? "" : ", ") + ("field " + std::to_string(i + 1)) + dimension;
  }
  return text;
}

/// Name of the card that is written for a card; empty: none.
std::string find_written(const std::string& name) {
  std::string written;
  const auto look = [&](const auto& table) {
    const auto row = table.find(name);
    if (row == table.end()) return;
    if (row->second.write != nullptr) written = name;
    if (row->second.written_as != nullptr) written = row->second.written_as;
  };
  look(get_card_parsers());
  look(get_dynamic_parsers());
  look(get_complex_parsers());
  look(get_rotor_parsers());
  return written;
}

std::string make_page() {
  std::ostringstream out;
  out << "# Fields of every card\n\n"
         "For the engineer who names a field in a [campaign](campaign-toml.md) or converts a deck to other units: the "
         "names\nand dimensions (M mass, L length, T time) of the data fields of each card that is read, and the card "
         "that\n`export --to bdf` writes for it. [Nastran decks](nastran.md) says what a card does. Made from the "
         "table "
         "of cards by the\ntest `nastran.CardTable` (`BOUGH_WRITE_PAGES=1`).\n\n"
         "A field without a name is counted from the first after the name of the card. \"by others\": dimensions "
         "depend "
         "on other\nfields or cards, such as the component of a spring. [?]: nothing tells the dimension, a number "
         "there "
         "is an error of\n`convert --units`.\n\n"
         "| card | fields | dimensions | written as |\n| --- | --- | --- | --- |\n";
  for (const auto& [name, facts] : list_cards()) {
    const auto written = find_written(name);
    const bool has_any = std::any_of(get_dimension_words(name).begin(), get_dimension_words(name).end(),
                                     [](const auto& word) { return word != "."; });
    out << "| " << name << " | " << list_fields(name) << (facts->entry_size > 0 ? "; several on a line" : "") << " | "
        << (facts->convert != nullptr ? "by others"
            : has_any                 ? "in brackets"
                                      : "none")
        << " | " << written << " |\n";
  }
  return out.str();
}

TEST(CardTable, EveryCardHasDimensions) {
  for (const auto& [name, facts] : list_cards()) {
    EXPECT_TRUE(facts->dimensions != nullptr || facts->convert != nullptr)
        << name << ": give its row dimensions, \"\" for none";
    for (const auto& word : get_dimension_words(name))
      EXPECT_TRUE(word == "." || word == "?" || find_dimension(word) != nullptr) << name << " " << word;
  }
}

TEST(CardTable, EveryCardIsKnownAndWritten) {
  for (const auto& [name, facts] : list_cards()) {
    EXPECT_TRUE(find_effect(name).has_value()) << name << ": add it to known_cards.cpp";
    const auto written = find_written(name);
    ASSERT_FALSE(written.empty()) << name << ": write_by or write_as";
    EXPECT_EQ(find_written(written), written) << name;
  }
}

TEST(CardTable, ManualHasARowForEveryCard) {
  const std::string path = std::string(BOUGH_SOURCE_DIR) + "/docs/formats/cards.md";
  if (std::getenv("BOUGH_WRITE_PAGES") != nullptr) std::ofstream(path) << make_page();
  std::ifstream in(path);
  std::ostringstream found;
  found << in.rdbuf();
  EXPECT_TRUE(found.str() == make_page())
      << path << " is stale; BOUGH_WRITE_PAGES=1 ctest -R nastran.CardTable writes it";
}

}  // namespace
}  // namespace bough::nastran::detail
