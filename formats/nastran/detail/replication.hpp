#pragma once
/// \file Replication: cards written as differences from the card before.
#include <deque>
#include <optional>
#include <string>

#include "formats/nastran/detail/card.hpp"

namespace bough::nastran::detail {

/// "=" copies a field, "==" copies all that are left, "*n" or "*(n)" adds n to it; a line "=n" or "=(n)" repeats the
/// last card n times with the same increments. Quick Reference Guide, "Replication".
class Replicator {
 public:
  /// True if a card is written relative to the one before.
  static bool is_relative(const CardText& card);
  /// Number of repeats when the card is a repeat line.
  static std::optional<int> find_repeats(const CardText& card);

  /// Fills the relative fields of `card` from the card remembered, and its name. Returns what is wrong, or empty.
  std::string resolve(CardText& card);
  /// The next copy of the remembered card by its increments.
  std::string make_copy(CardText& card);
  /// Keeps a card as the one that the next replication copies.
  void remember(const CardText& card) {
    previous_ = card;
    has_previous_ = true;
  }
  /// A card without relative fields: no increments.
  void clear_increments() { increments_.clear(); }

 private:
  std::string add_increment(std::string_view field, std::string_view increment, std::string_view& sum);

  CardText previous_;
  bool has_previous_ = false;
  std::vector<std::string_view> increments_;  ///< by field, empty = none
  std::deque<std::string> storage_;           ///< texts of the sums; never moved
};

}  // namespace bough::nastran::detail
