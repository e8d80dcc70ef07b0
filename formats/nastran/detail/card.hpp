#pragma once
/// \file One card with typed access to its fields. Field i = 0 is the first data field (field 2 of the line, in the
/// counting of the manuals); every line of a card has eight of them whatever its format.
#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/records/deck.hpp"

namespace bough::nastran::detail {

/// The bare text of a card.
struct CardText {
  std::string name;                      ///< upper case
  std::vector<std::string_view> fields;  ///< trimmed; a multiple of eight
  struct LineStart {
    int first_field = 0;
    records::CardLocation at;
    std::string_view text;
  };
  std::vector<LineStart> lines;

  /// Empties the card for the next one and keeps its memory.
  void clear() {
    name.clear();
    fields.clear();
    lines.clear();
  }
};

/// Typed reading. A field that cannot be read adds an error (deck.bad-integer, deck.bad-real, deck.bad-components,
/// deck.bad-word, deck.missing-field, deck.field-range) and gives the default, so that one card reports all its errors;
/// is_ok() tells whether the card had any.
class Card {
 public:
  Card(const CardText& text, const std::vector<std::string>& files, Diagnostics& diagnostics)
      : text_(text), files_(files), diagnostics_(diagnostics), size_(static_cast<int>(text.fields.size())) {
    while (size_ > 0 && text.fields[static_cast<std::size_t>(size_ - 1)].empty()) --size_;
  }

  /// Name in upper case.
  const std::string& get_name() const { return text_.name; }
  /// The bare text with the line of each field.
  const CardText& get_text() const { return text_; }
  /// File and line of the first line of the card.
  records::CardLocation get_location() const { return text_.lines.front().at; }
  /// Returns false if a field had an error.
  bool is_ok() const { return ok_; }
  /// Index after the last field that is not blank.
  int get_size() const { return size_; }
  /// Text of a field, trimmed; empty beyond the last one.
  std::string_view get(int i) const {
    return i >= 0 && i < size_ ? text_.fields[static_cast<std::size_t>(i)] : std::string_view{};
  }
  /// Returns true if the field is blank or absent.
  bool is_blank(int i) const { return get(i).empty(); }
  bool is_blank(int first, int last) const;  ///< fields first .. last-1
  /// Returns true if the text of the field is an integer.
  bool is_integer(int i) const;
  /// Returns true if the field is this word, in any case.
  bool is_word(int i, std::string_view upper_case_word) const;

  /// Fields that the card may have and that need no word when they are not looked at; reading a field does the same.
  void use(int i) {
    if (i >= 0 && i < 64) used_ |= std::uint64_t{1} << i;
    used_end_ = std::max(used_end_, i + 1);
  }
  /// Marks the fields first to last - 1 as used.
  void use(int first, int last) {
    for (int i = first; i < std::min(last, size_); ++i) use(i);
  }
  /// Marks fields as used whose data no record keeps.
  void use_unkept(int first, int last) {
    use(first, last);
    has_unkept_ = has_unkept_ || !is_blank(first, last);
  }
  /// Returns true if a field of use_unkept has data.
  bool has_unkept() const { return has_unkept_; }
  /// First field from `first` on with data that was neither read nor used, or -1. Beyond 64 fields it is what follows
  /// the last one.
  int find_leftover(int first) const;
  /// "field 4", "field 2 of line 3": as the manuals count, the name being field 1.
  static std::string name_field(int i);
  /// Location of field i: its line, without its column, which is for the mark at a terminal alone.
  SourceLocation locate(int i) const;

  int read_int(int i, const char* what);  ///< required
  /// An integer, `fallback` if the field is blank.
  int read_int(int i, const char* what, int fallback);
  int read_id(int i, const char* what);                           ///< required, > 0
  int read_id(int i, const char* what, int fallback);             ///< > 0 or blank
  int read_reference(int i, const char* what, int fallback = 0);  ///< >= 0 or blank: coordinate systems, open ends
  double read_real(int i, const std::string& what);               ///< required
  /// A real number, `fallback` if the field is blank.
  double read_real(int i, const std::string& what, double fallback);
  /// A real number; nothing if the field is blank.
  std::optional<double> read_optional_real(int i, const char* what);
  Eigen::Vector3d read_vector(int i, const char* names);  ///< fields i..i+2, blank = 0; names "N1 N2 N3"
  Eigen::Vector2d read_point(int i, const char* names);   ///< fields i, i+1, blank = 0; names "C1 C2"
  unsigned read_components(int i, const char* what);      ///< required
  /// Bit mask of components 1 to 6, `fallback` if the field is blank.
  unsigned read_components(int i, const char* what, unsigned fallback);
  int read_component(int i, const char* what);  ///< one component 0..6, blank = 0

  /// An id in a list of fields: its name and member; required, or `*blank` if the field is blank.
  struct IdField {
    const char* what;
    int& value;
    const int* blank = nullptr;
  };
  /// A real number in a list of fields: its name and member; required, or `blank` if the field is blank.
  struct RealField {
    const char* what;
    double& value;
    std::optional<double> blank = {};
  };
  /// Reads the fields first, first + 1, ... into their members.
  void read_ids(int first, std::initializer_list<IdField> fields) {
    for (const auto& f : fields) f.value = f.blank ? read_id(first++, f.what, *f.blank) : read_id(first++, f.what);
  }
  /// Reads the fields first, first + 1, ... into their members.
  void read_reals(int first, std::initializer_list<RealField> fields) {
    for (const auto& f : fields) f.value = f.blank ? read_real(first++, f.what, *f.blank) : read_real(first++, f.what);
  }
  /// A word of `choices` (upper case), `fallback` when blank.
  std::string read_word(int i, const char* what, std::string_view fallback, const std::vector<std::string>& choices);
  /// Text of the field in upper case; marks it as read.
  std::string get_upper(int i);

  /// An error of this card at field i (its line), or at the card's first line.
  void fail(std::string_view id, int i, std::string what, std::string advice = {});
  /// A warning of this card at field i.
  void warn(std::string_view id, int i, std::string what, std::string advice = {});
  /// deck.field-range unless `condition`.
  void demand(bool condition, int i, const char* what, const char* expected);

 private:
  /// "10.4  +6" and "12 456" without their blanks, with the warning deck.blank-inside.
  std::string join_blanks(int i, const std::string& what);
  void fail_field(std::string_view id, int i, const std::string& what, const char* expected);

  const CardText& text_;
  const std::vector<std::string>& files_;
  Diagnostics& diagnostics_;
  int size_;
  int used_end_ = 0;
  std::uint64_t used_ = 0;  ///< bit i: field i
  bool ok_ = true, has_unkept_ = false;
};

/// Calls read(first) for the entries of `width` fields that a card has room for: of the first, and of each further one
/// that is not blank.
template <class Read>
void read_entries(const Card& card, int width, std::initializer_list<int> starts, const Read& read) {
  for (const int first : starts)
    if (first == *starts.begin() || !card.is_blank(first, first + width)) read(first);
}

/// A list of ids with THRU, BY, EXCEPT.
struct IdRange {
  int first = 0, last = 0, step = 1;  ///< a single id: first = last
  bool is_thru = false;
  std::vector<int> except;
  /// Returns true if the list has the id.
  bool contains(int id) const;
};
/// Reads fields first .. last-1, skipping blanks. Adds deck.bad-list.
std::vector<IdRange> read_id_list(Card& card, int first, int last, const char* what);
/// Every id of the list in order. Adds deck.bad-list for a range beyond a million ids.
std::vector<int> read_ids(Card& card, int first, int last, const char* what);

}  // namespace bough::nastran::detail
