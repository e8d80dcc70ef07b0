#pragma once
/// \file Decks written in the tests themselves.
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "formats/nastran/reader.hpp"

namespace bough::nastran {

/// A deck read from text with what was said about it.
struct Read {
  Diagnostics diagnostics;
  records::Deck deck;

  std::string get_messages() const {
    std::string text;
    for (const auto& d : diagnostics.items()) text += format(d) + "\n";
    return text;
  }
  /// The first diagnostic with this id, or nullptr.
  const Diagnostic* find(std::string_view id) const {
    for (const auto& d : diagnostics.items())
      if (d.id == id) return &d;
    return nullptr;
  }
  int count(std::string_view id) const {
    int n = 0;
    for (const auto& d : diagnostics.items()) n += d.id == id ? 1 : 0;
    return n;
  }
};

inline Read read(std::string_view text, const ReadOptions& options = {}) {
  Read r;
  r.deck = read_deck_text(text, "deck.bdf", options, r.diagnostics);
  return r;
}

/// Fields of a card, to compare several by one EXPECT_EQ: values(p.id, p.k), values(2, 5.0).
template <class... Fields>
auto values(const Fields&... fields) {
  return std::tuple<std::decay_t<const Fields&>...>(fields...);
}

/// Reads a deck that must be without fault.
inline records::Deck read_clean(std::string_view text) {
  const auto r = read(text);
  EXPECT_EQ(r.diagnostics.items().size(), 0u) << r.get_messages();
  return r.deck;
}

/// `count` messages with this id, the first with these words in its text or its advice.
inline void expect_messages(const Read& r, std::string_view id, int count, std::string_view words) {
  ASSERT_EQ(r.count(id), count) << r.get_messages();
  EXPECT_NE(format(*r.find(id)).find(words), std::string::npos) << r.get_messages();
}

/// Reads one list of such a deck. \return `size` records; those that the deck lacks are empty, and the test fails.
template <class Record>
std::vector<Record> read_list(std::vector<Record> records::Deck::*list, std::size_t size, std::string_view text) {
  auto found = read_clean(text).*list;
  EXPECT_EQ(found.size(), size);
  found.resize(size);
  return found;
}

}  // namespace bough::nastran
