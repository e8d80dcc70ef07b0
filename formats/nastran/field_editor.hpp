#pragma once
/// \file Changes single fields of a deck's text and leaves every other byte as it is.
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::nastran {

/// Names one field of one card.
struct FieldAddress {
  std::string card;    ///< name, any case
  std::string id;      ///< its first data field; empty: the only card of this name
  int occurrence = 0;  ///< which of several cards with this name and id, from 1; 0: there is to be one
  std::string field;   ///< name such as "E", for the common cards
  int number = 0;      ///< or its number as the manuals count: 1 the name, 2-9, 12-19, 22-29, ...
};

/// Where a field stands: a card of the deck, and a data field counted from 0 with eight a line.
struct FieldPlace {
  int card = 0;
  int field = 0;
};

struct FieldEdit {
  FieldPlace place;
  std::string text;  ///< as the deck is to hold it
};

/// A file of an edited deck.
struct EditedFile {
  std::string name;
  std::string text;
};

/// A card of the deck, unchanged.
struct DeckCard {
  int card = 0;      ///< of FieldPlace
  std::string name;  ///< upper case
  std::vector<std::string> fields;
  SourceLocation at;
  bool is_replicated = false;  ///< written or copied by replication
};

/// "2.5+10": the shortest text that reads back as this number.
std::string format_field(double value);

class DeckEditor {
 public:
  /// Reads the deck and its INCLUDE files; adds the deck.* errors of that.
  DeckEditor(const std::string& path, Diagnostics& diagnostics);
  ~DeckEditor();
  DeckEditor(DeckEditor&&) noexcept;

  /// The deck and what it includes.
  const std::vector<std::string>& get_files() const;
  /// Use of each DMIG in the case control, by name: "K" stiffness, "M" mass, "B" damping, "P" load, "?" several.
  std::map<std::string, std::string> list_matrix_kinds() const;
  /// All cards of the bulk data.
  std::vector<DeckCard> list_cards() const;
  /// Adds, at `asked_at`, batch.unknown-card, batch.ambiguous-card, batch.unknown-field, batch.replicated-card.
  std::optional<FieldPlace> find(const FieldAddress& address, const SourceLocation& asked_at,
                                 Diagnostics& diagnostics) const;
  /// Text of the field; empty if it is blank.
  std::string get_text(const FieldPlace& place) const;

  /// The deck under `name`, with it the included files that hold a changed field; INCLUDE of others names them by their
  /// absolute path. A text too long for its columns makes its line a free-field one. Throws InputError
  /// "batch.field-width" where that cannot be.
  std::vector<EditedFile> write(const std::string& name, const std::vector<FieldEdit>& edits) const;

 private:
  struct Contents;
  std::unique_ptr<Contents> contents_;
};

}  // namespace bough::nastran
