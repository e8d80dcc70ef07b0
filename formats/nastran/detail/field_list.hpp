#pragma once
/// \file The fields of a card, listed once: read from a card, written to one, or named for the manual.
#include <list>
#include <string>
#include <string_view>
#include <vector>

#include "formats/nastran/detail/card.hpp"
#include "formats/nastran/detail/card_text.hpp"

namespace bough::nastran::detail {

/// Visits the fields of a card in order, each with its name and the member of the record that contains it.
///
/// A list of fields is a function void list(FieldList&, Record&). Errors of a field that is read are those of Card.
class FieldList {
 public:
  /// Reads the fields of a card into the members.
  explicit FieldList(Card& card) : card_(&card) {}
  /// Writes the members to a card.
  explicit FieldList(CardFields& fields) : fields_(&fields) {}
  /// Appends the names of the fields; "-" for blank ones.
  explicit FieldList(std::vector<std::string>& names) : names_(&names) {}

  FieldList& id(const char* name, int& value);                        ///< required, > 0
  FieldList& id(const char* name, int& value, int fallback);          ///< > 0; blank: fallback
  FieldList& reference(const char* name, int& value);                 ///< >= 0; blank: 0
  FieldList& integer(const char* name, int& value, int fallback);     ///< blank: fallback
  FieldList& real(const char* name, double& value);                   ///< required
  FieldList& real(const char* name, double& value, double fallback);  ///< blank: fallback
  FieldList& component(const char* name, int& value);                 ///< 0 to 6; blank: 0
  /// Reads a set where the field is an integer, else a number.
  FieldList& set_or_real(const char* name, int& set, double& value, double fallback = 0);
  /// Reads one of two words: `value` is true for the second; blank: the first.
  FieldList& flag(const char* name, bool& value, const char* off, const char* on);
  /// Reads a word of `choices`; blank: fallback.
  FieldList& word(const char* name, std::string& value, const char* fallback, const std::vector<std::string>& choices);
  FieldList& blank(int count = 1);  ///< fields that the card does not have

  /// A field that is read by read(card, index) and written by write(fields).
  template <class Read, class Write>
  FieldList& field(const char* name, const Read& read, const Write& write) {
    if (card_ != nullptr) read(*card_, next_);
    if (fields_ != nullptr) write(*fields_);
    return pass(name);
  }

 private:
  FieldList& pass(const char* name);

  Card* card_ = nullptr;
  CardFields* fields_ = nullptr;
  std::vector<std::string>* names_ = nullptr;
  int next_ = 0;  ///< index of the next field
};

/// Reads the fields of a record.
template <class Record>
void read_fields(Card& card, void (*list)(FieldList&, Record&), Record& record) {
  FieldList fields(card);
  list(fields, record);
  record.at = card.get_location();
}

/// Returns the card `name` with the fields of a record.
template <class Record>
CardFields make_fields(const std::string& name, void (*list)(FieldList&, Record&), const Record& record) {
  CardFields card(name);
  FieldList fields(card);
  auto copy = record;
  list(fields, copy);
  return card;
}

/// Names of the fields as in CardFacts::names, which lives as long as the program.
template <class Record>
const char* name_fields(void (*list)(FieldList&, Record&)) {
  static std::list<std::string> texts;
  std::vector<std::string> names;
  FieldList fields(names);
  Record record;
  list(fields, record);
  auto& text = texts.emplace_back();
  for (const auto& name : names) text += (text.empty() ? "" : " ") + name;
  return text.c_str();
}

}  // namespace bough::nastran::detail
