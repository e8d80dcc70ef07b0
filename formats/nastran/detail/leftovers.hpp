#pragma once
/// \file Data in fields that a card does not have.
#include <map>
#include <string>
#include <utility>

#include "formats/nastran/detail/card.hpp"

namespace bough::nastran::detail {

/// Fields that no parser read, by card name and field: one warning for each, with a count.
class Leftovers {
 public:
  /// Looks at a card that its parser has read without error. A zero says nothing and counts as blank.
  void add(const Card& card);
  /// Adds deck.unused-field.
  void report(Diagnostics& diagnostics) const;

 private:
  struct Entry {
    int count = 0;
    SourceLocation where;
    std::string text;
  };
  std::map<std::pair<std::string, int>, Entry> entries_;
};

}  // namespace bough::nastran::detail
