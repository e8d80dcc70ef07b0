#include "formats/nastran/detail/card.hpp"

#include <algorithm>

#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

/// The one at `index` of names between blanks.
std::string take_name(std::string_view names, int index) {
  for (; index > 0; --index) names = trim(names.substr(std::min(names.find(' '), names.size())));
  return std::string(names.substr(0, names.find(' ')));
}

}  // namespace

bool Card::is_blank(int first, int last) const {
  for (int i = first; i < last; ++i)
    if (!is_blank(i)) return false;
  return true;
}
bool Card::is_integer(int i) const { return parse_int(get(i)).has_value(); }
bool Card::is_word(int i, std::string_view word) const { return detail::is_word(get(i), word); }
std::string Card::get_upper(int i) {
  use(i);
  return make_upper(get(i));
}
int Card::find_leftover(int first) const {
  for (int i = first; i < size_; ++i) {
    const bool is_used = i < 64 ? (used_ >> i & 1u) != 0 : i < used_end_;
    if (!is_used && !is_blank(i)) return i;
  }
  return -1;
}

std::string Card::name_field(int i) {
  return "field " + std::to_string(i % 8 + 2) + (i < 8 ? "" : " of line " + std::to_string(i / 8 + 1));
}

SourceLocation Card::locate(int i) const {
  const auto* line = &text_.lines.front();
  for (const auto& other : text_.lines)
    if (other.first_field <= i) line = &other;
  // Below zero: for the mark under the line at a terminal, not for the text of the message.
  int column = 0;
  if (const auto field = get(i); !field.empty() && line->text.data() <= field.data() &&
                                 field.data() + field.size() <= line->text.data() + line->text.size())
    column = -static_cast<int>(field.data() - line->text.data()) - 1;
  return {files_[static_cast<std::size_t>(line->at.file)], line->at.line, column};
}

void Card::fail(std::string_view id, int i, std::string what, std::string advice) {
  ok_ = false;
  diagnostics_.error(id, locate(i), text_.name + ": " + what, std::move(advice));
}
void Card::warn(std::string_view id, int i, std::string what, std::string advice) {
  diagnostics_.warning(id, locate(i), text_.name + ": " + what, std::move(advice));
}
void Card::fail_field(std::string_view id, int i, const std::string& what, const char* expected) {
  const auto who = what + " (" + name_field(i) + ")";
  if (is_blank(i))
    fail("deck.missing-field", i, who + " is blank, expected " + expected);
  else
    fail(id, i, who + " is '" + std::string(get(i)) + "', expected " + expected);
}
void Card::demand(bool condition, int i, const char* what, const char* expected) {
  if (!condition) fail_field("deck.field-range", i, what, expected);
}

int Card::read_int(int i, const char* what) {
  use(i);
  const auto value = parse_int(get(i));
  if (!value) fail_field("deck.bad-integer", i, what, "an integer");
  return value.value_or(0);
}
int Card::read_int(int i, const char* what, int fallback) { return is_blank(i) ? fallback : read_int(i, what); }
int Card::read_id(int i, const char* what) {
  use(i);
  const auto value = parse_int(get(i));
  if (!value)
    fail_field("deck.bad-integer", i, what, "a positive integer");
  else
    demand(*value > 0, i, what, "a positive integer");
  return value.value_or(0);
}
int Card::read_id(int i, const char* what, int fallback) { return is_blank(i) ? fallback : read_id(i, what); }
int Card::read_reference(int i, const char* what, int fallback) {
  use(i);
  if (is_blank(i)) return fallback;
  const auto value = parse_int(get(i));
  if (!value)
    fail_field("deck.bad-integer", i, what, "an integer");
  else
    demand(*value >= 0, i, what, "zero or a positive integer");
  return value.value_or(fallback);
}
/// The old programs skip blanks in a field; where that is no accident of columns it is one number.
std::string Card::join_blanks(int i, const std::string& what) {
  std::string joined(get(i));
  std::erase(joined, ' ');
  warn("deck.blank-inside", i, what + " is '" + std::string(get(i)) + "', read as '" + joined + "'",
       "check the columns");
  return joined;
}
double Card::read_real(int i, const std::string& what) {
  use(i);
  auto value = parse_real(get(i));
  if (const auto blank = get(i).find(' '); !value && blank != std::string_view::npos) {
    const auto exponent = trim(get(i).substr(blank));
    if (parse_real(get(i).substr(0, blank)) && std::string_view("+-eEdD").find(exponent[0]) != std::string_view::npos &&
        exponent.find(' ') == std::string_view::npos)
      value = parse_real(join_blanks(i, what));
  }
  if (!value) fail_field("deck.bad-real", i, what, "a real number");
  return value.value_or(0.0);
}
double Card::read_real(int i, const std::string& what, double fallback) {
  return is_blank(i) ? fallback : read_real(i, what);
}
std::optional<double> Card::read_optional_real(int i, const char* what) {
  if (is_blank(i)) return std::nullopt;
  return read_real(i, what);
}
Eigen::Vector3d Card::read_vector(int i, const char* names) {
  return {read_real(i, take_name(names, 0), 0.0), read_real(i + 1, take_name(names, 1), 0.0),
          read_real(i + 2, take_name(names, 2), 0.0)};
}
Eigen::Vector2d Card::read_point(int i, const char* names) {
  return {read_real(i, take_name(names, 0), 0.0), read_real(i + 1, take_name(names, 1), 0.0)};
}
unsigned Card::read_components(int i, const char* what) {
  use(i);
  const bool has_blank = get(i).find(' ') != std::string_view::npos;
  const auto value = has_blank ? parse_components(join_blanks(i, what)) : parse_components(get(i));
  if (!value) fail_field("deck.bad-components", i, what, "component numbers 1 to 6 such as 123, or 0");
  return value.value_or(0u);
}
unsigned Card::read_components(int i, const char* what, unsigned fallback) {
  return is_blank(i) ? fallback : read_components(i, what);
}
int Card::read_component(int i, const char* what) {
  use(i);
  if (is_blank(i)) return 0;
  const auto value = parse_int(get(i));
  if (!value || *value < 0 || *value > 6) {
    fail_field("deck.bad-components", i, what, "one component 1 to 6, or 0");
    return 0;
  }
  return *value;
}
std::string Card::read_word(int i, const char* what, std::string_view fallback,
                            const std::vector<std::string>& choices) {
  if (is_blank(i)) return std::string(fallback);
  const auto word = get_upper(i);
  if (std::find(choices.begin(), choices.end(), word) != choices.end()) return word;
  std::string list;
  for (const auto& choice : choices) list += (list.empty() ? "" : ", ") + choice;
  const auto nearest = find_nearest(word, choices);
  fail("deck.bad-word", i, std::string(what) + " is '" + std::string(get(i)) + "', expected one of " + list,
       nearest.empty() ? std::string{} : "did you mean " + nearest);
  return std::string(fallback);
}

bool IdRange::contains(int id) const {
  if (id < first || id > last || (id - first) % step != 0) return false;
  return std::find(except.begin(), except.end(), id) == except.end();
}

std::vector<IdRange> read_id_list(Card& card, int first, int last, const char* what) {
  std::vector<IdRange> list;
  card.use(first, last);
  const auto fail = [&](int i, const char* why) {
    card.fail("deck.bad-list", i, std::string(what) + " list: " + why + " at '" + std::string(card.get(i)) + "'",
              "write ids, or FIRST THRU LAST, optionally BY STEP and EXCEPT ids");
  };
  bool in_except = false;
  for (int i = first; i < last; ++i) {
    if (card.is_blank(i)) continue;
    if (card.is_word(i, "THRU")) {
      if (list.empty() || list.back().is_thru) return fail(i, "THRU has no first id"), list;
      while (i + 1 < last && card.is_blank(i + 1)) ++i;
      const auto end = parse_int(card.get(++i));
      if (!end) return fail(i, "THRU has no last id"), list;
      if (*end < list.back().first) return fail(i, "the last id is below the first"), list;
      list.back().last = *end;
      list.back().is_thru = true;
    } else if (card.is_word(i, "BY")) {
      const auto step = parse_int(card.get(++i));
      if (list.empty() || !list.back().is_thru || in_except) return fail(i, "BY does not follow THRU"), list;
      if (!step || *step < 1) return fail(i, "BY needs a positive step"), list;
      list.back().step = *step;
    } else if (card.is_word(i, "EXCEPT")) {
      if (list.empty() || !list.back().is_thru) return fail(i, "EXCEPT does not follow THRU"), list;
      in_except = true;
    } else {
      const int id = card.read_id(i, what);
      // The exceptions end with the first id beyond the range.
      if (in_except && id <= list.back().last) {
        list.back().except.push_back(id);
      } else {
        in_except = false;
        list.push_back({id, id, 1, false, {}});
      }
    }
  }
  return list;
}

std::vector<int> read_ids(Card& card, int first, int last, const char* what) {
  std::vector<int> ids;
  for (const auto& range : read_id_list(card, first, last, what)) {
    if ((static_cast<long>(range.last) - range.first) / range.step > 1'000'000) {
      card.fail("deck.bad-list", first, std::string(what) + " list: more than a million ids in one THRU range");
      continue;
    }
    for (long id = range.first; id <= range.last; id += range.step)
      if (range.contains(static_cast<int>(id))) ids.push_back(static_cast<int>(id));
  }
  return ids;
}

}  // namespace bough::nastran::detail
