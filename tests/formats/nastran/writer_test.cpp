/// \file Written decks: numbers in their columns, and read -> write -> read gives equal records.
#include "formats/nastran/writer.hpp"

#include <cmath>
#include <random>
#include <set>
#include <string_view>

#include "formats/nastran/detail/card_text.hpp"
#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/text.hpp"
#include "tests/formats/nastran/card_samples.hpp"
#include "tests/formats/nastran/compare_decks.hpp"
#include "tests/formats/nastran/deck_text.hpp"
#include "tests/formats/nastran/every_card.hpp"

namespace bough::nastran {
namespace {

TEST(WrittenReals, KnownOnes) {
  EXPECT_EQ(detail::format_real(0, 8), "0.");
  EXPECT_EQ(detail::format_real(-0.0, 8), "0.");
  EXPECT_EQ(detail::format_real(1, 8), "1.");
  EXPECT_EQ(detail::format_real(-12.5, 8), "-12.5");
  EXPECT_EQ(detail::format_real(0.00125, 8), ".00125");
  EXPECT_EQ(detail::format_real(7e10, 8), "7.+10");
  EXPECT_EQ(detail::format_real(-1.234567e-12, 8), "-1.23-12");
  EXPECT_EQ(detail::format_real(1.0 / 3, 16), ".333333333333333");
  EXPECT_EQ(detail::format_real(99999999.9, 8), "1.+8");
}

/// The promise of the large field: ten digits of any number; of the free field: all.
TEST(WrittenReals, RandomOnesKeepTheirDigits) {
  std::mt19937_64 random(20250101);
  std::uniform_real_distribution<double> mantissa(-10, 10), exponent(-300, 300), near_one(-6, 6);
  for (int i = 0; i < 20000; ++i) {
    const double value = mantissa(random) * std::pow(10.0, i % 2 == 0 ? exponent(random) : near_one(random));
    for (const int width : {8, 16}) {
      const auto text = detail::format_real(value, width);
      ASSERT_LE(text.size(), static_cast<std::size_t>(width)) << text;
      ASSERT_NE(text.find('.'), std::string::npos) << text;
      const auto back = detail::parse_real(text);
      ASSERT_TRUE(back) << text;
      ASSERT_LE(std::abs(*back - value), (width == 16 ? 5e-10 : 0.06) * std::abs(value)) << text;
    }
    const auto back = detail::parse_real(detail::format_exact_real(value));
    ASSERT_TRUE(back);
    ASSERT_EQ(*back, value);
  }
}

TEST(WrittenCards, Columns) {
  std::string out;
  detail::CardFields("GRID").add(7).add_blank().add(1.5).add(0.0).add(-2.0).write(FieldFormat::Large, out);
  EXPECT_EQ(out, "GRID           7             1.5      0.     -2.\n");
  out.clear();
  detail::CardFields("GRID").add(7).add_blank().add(1.0 / 3).add(0.0).add(-2.0).write(FieldFormat::Large, out);
  EXPECT_EQ(out,
            "GRID*                  7                .333333333333333              0.\n"
            "*                    -2.\n");
  out.clear();
  detail::CardFields("GRID").add(7).add_blank().add(1.0 / 3).add(0.0).add(-2.0).write(FieldFormat::Small, out);
  EXPECT_EQ(out, "GRID           7        .3333333      0.     -2.\n");
  out.clear();
  detail::CardFields("RBE2").add(1).add(2).add_components(0b100101).add(3).add(4).add(5).add(6).add(7).add(8).write(
      FieldFormat::Free, out);
  EXPECT_EQ(out, "RBE2,1,2,136,3,4,5,6,7,+\n+,8\n");
  // A word too long for any column.
  out.clear();
  detail::CardFields("PARAM").add_word("NAME").add_word("A_VALUE_OF_MANY_LETTERS").write(FieldFormat::Small, out);
  EXPECT_EQ(out, "PARAM,NAME,A_VALUE_OF_MANY_LETTERS\n");
}

records::Deck write_and_read(const records::Deck& deck, FieldFormat format, std::string& text) {
  Diagnostics diagnostics;
  text = write_deck(deck, {format}, diagnostics);
  EXPECT_EQ(diagnostics.num_errors(), 0);
  const auto again = read(text);
  EXPECT_EQ(again.diagnostics.num_errors(), 0) << again.get_messages() << text;
  return again.deck;
}

void expect_round_trip(const records::Deck& deck) {
  std::string text;
  {
    SCOPED_TRACE("free field");
    expect_equal_decks(deck, write_and_read(deck, FieldFormat::Free, text), 0);
  }
  SCOPED_TRACE("large field");
  const auto again = write_and_read(deck, FieldFormat::Large, text);
  expect_equal_decks(deck, again, 1e-10);
  // Rounded once, a number stays as it is (and may now fit 8 columns); lines end within their columns.
  std::string second, third;
  write_and_read(write_and_read(again, FieldFormat::Large, second), FieldFormat::Large, third);
  EXPECT_TRUE(second == third) << second << third;
  for (std::size_t from = text.find("BEGIN BULK"); from < text.size();) {
    const auto end = text.find('\n', from);
    EXPECT_LE(end - from, 72u) << text.substr(from, end - from);
    from = end + 1;
  }
}

TEST(WrittenDecks, EveryCardThatIsRead) {
  std::string text = every_card;
  text.insert(text.rfind("ENDDATA"), get_card_samples());
  const auto r = read(text);
  ASSERT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  // A parser without a card here is not tested: add the card to every_card.hpp, or a CardSample in its test.
  // Superelements have sections: dynamic_writer_test.cpp.
  const std::set<std::string_view> of_superelements{"SEBULK", "SECONCT", "SEBNDRY", "SELOAD", "EXTRN", "DTI"};
  for (const auto& [name, parser] : detail::get_card_parsers()) {
    if (of_superelements.contains(name)) continue;
    EXPECT_EQ(r.deck.card_counts.count(std::string(name)), 1u) << name << " is read but not in every_card.hpp";
  }
  expect_round_trip(r.deck);
}

TEST(WrittenDecks, SmallFieldKeepsWhatFits) {
  const auto deck = read_clean("GRID,1,,0.12345678912345,0.,0.\n");
  std::string text;
  const auto again = write_and_read(deck, FieldFormat::Small, text);
  EXPECT_EQ(again.grids.at(0).x[0], 0.1234568);
}

TEST(WrittenDecks, ThruOfMissingGridsStaysHarmless) {
  const auto deck = read_clean("GRID,1,,0.,0.,0.\nGRID,2,,0.,0.,0.\nGRID,9,,0.,0.,0.\nSPC1,1,123,1,THRU,20\n");
  std::string text;
  write_and_read(deck, FieldFormat::Large, text);
  EXPECT_NE(text.find("SPC1           1     123       1    THRU       9"), std::string::npos) << text;
}

TEST(WrittenDecks, NothingIsLostSilently) {
  auto r = read("GRID,1,,0.,0.,0.\nDEFORM,1,5,.1\n");
  Diagnostics diagnostics;
  write_deck(r.deck, {}, diagnostics);
  EXPECT_TRUE(diagnostics.has("deck.left-out"));
  EXPECT_EQ(diagnostics.num_errors(), 0);
  // A card of the reader that the writer does not know.
  r.deck.card_counts["CFUTURE"] = 3;
  write_deck(r.deck, {}, diagnostics);
  EXPECT_TRUE(diagnostics.has("deck.not-written"));
  EXPECT_EQ(diagnostics.num_errors(), 1);
}

TEST(WrittenDecks, OwnAndSharedModels) {
  const auto paths = list_decks();
  ASSERT_GE(paths.size(), 4u);
  for (const auto& path : paths) {
    SCOPED_TRACE(path);
    Read r;
    r.deck = read_deck(path, {}, r.diagnostics);
    if (!r.deck.super.sebulk.empty()) continue;  // refused: its matrices are in other files
    // Cards that are in no record cannot be compared.
    ReadOptions options;
    for (const auto& card : r.deck.unused) options.ignore_cards.push_back(card.name);
    r.diagnostics = {};
    r.deck = read_deck(path, options, r.diagnostics);
    if (r.diagnostics.num_errors() > 0) continue;
    expect_round_trip(r.deck);
  }
}

}  // namespace
}  // namespace bough::nastran
