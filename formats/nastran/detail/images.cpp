#include "formats/nastran/detail/images.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <set>
#include <unordered_map>

#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

constexpr std::size_t fixed_width = 72;  ///< name and data; the tag follows

std::string_view slice(std::string_view text, std::size_t from, std::size_t length) {
  return from < text.size() ? trim(text.substr(from, length)) : std::string_view{};
}

bool is_mark(std::string_view field) { return !field.empty() && (field.front() == '+' || field.front() == '*'); }
bool is_continuation(std::string_view first_field) { return first_field.empty() || is_mark(first_field); }
std::string_view strip_mark(std::string_view tag) { return is_mark(tag) ? trim(tag.substr(1)) : tag; }
/// Without all its marks: "++000001" continues "+000001" in decks that repeat the tag after a separate mark.
std::string_view strip_marks(std::string_view tag) {
  while (is_mark(tag)) tag = trim(tag.substr(1));
  return tag;
}
bool is_same(std::string_view a, std::string_view b) { return a.size() == b.size() && is_word(a, make_upper(b)); }

/// Nastran compares columns 2-8 with 74-80 without regard to case, so the first letter of a parent's tag counts only if
/// it is not a mark.
bool matches(std::string_view parent_tag, std::string_view tag) {
  if (is_same(strip_marks(parent_tag), strip_marks(tag))) return true;
  return !parent_tag.empty() && !is_mark(parent_tag) && is_same(trim(parent_tag.substr(1)), tag);
}

std::string_view get_tag(std::string_view text, SplitLine& scratch) {
  if (!is_free_field(text)) return slice(text, fixed_width, 8);
  split_line(text, scratch);
  return scratch.tag;
}

class Grouper {
 public:
  Grouper(const Source& source, Diagnostics& diagnostics) : source_(source), diagnostics_(diagnostics) {}

  CardImages group(std::size_t first_line) {
    result_.cards.reserve((source_.lines.size() - std::min(first_line, source_.lines.size())));
    result_.images.reserve(result_.cards.capacity());
    for (std::size_t i = first_line; i < source_.lines.size(); ++i) add(static_cast<int>(i));
    if (!fragments_.empty()) join_fragments();
    return std::move(result_);
  }

 private:
  struct Fragment {
    int image;
    int fallback;  ///< image before it when that one has no tag, or -1
  };

  std::string_view text(int line) const { return source_.lines[static_cast<std::size_t>(line)].text; }
  CardImage& image(int i) { return result_.images[static_cast<std::size_t>(i)]; }
  std::string_view tail_tag(int i) { return get_tag(text(image(i).first_line + image(i).num_lines - 1), scratch_); }

  void add(int line) {
    const auto first = get_first_field(text(line));
    if (!is_continuation(first)) {
      result_.cards.push_back(static_cast<int>(result_.images.size()));
      result_.images.push_back({line, 1, -1});
      return;
    }
    const auto tag = strip_mark(first);
    if (result_.images.empty()) {
      fragments_.push_back({0, -1});
      result_.images.push_back({line, 1, -1});
      return;
    }
    const int before = static_cast<int>(result_.images.size()) - 1;
    if (strip_marks(tag).empty() || matches(tail_tag(before), tag)) {
      if (strip_marks(tag).empty() && !is_free_field(text(line)) && is_after_empty(line)) warn_of_empty(line);
      ++image(before).num_lines;
      return;
    }
    fragments_.push_back({before + 1, strip_mark(tail_tag(before)).empty() ? before : -1});
    result_.images.push_back({line, 1, -1});
  }

  bool is_after_empty(int line) const {
    const auto& all = source_.after_empty;
    return std::binary_search(all.begin(), all.end(), static_cast<std::size_t>(line));
  }

  /// A script that writes eight blank fields of eight columns writes an empty line, which readers of decks skip.
  void warn_of_empty(int line) {
    const auto& at = source_.lines[static_cast<std::size_t>(line)].at;
    diagnostics_.warning("deck.empty-line", {source_.files[static_cast<std::size_t>(at.file)], at.line, 0},
                         "a continuation follows an empty line, which counts as none: these fields follow those "
                         "of the line before it",
                         "write '+' in the empty line if it stands for eight blank fields, or remove it");
  }

  using Tails = std::unordered_map<std::string, std::set<int>>;

  /// The nearest parent before the fragment that nothing continues yet, else the first one after it; or -1. Those that
  /// are continued already are of no use to any other, and leave.
  int find_parent(Tails& tails, const std::string& tag, int fragment) {
    const auto found = tails.find(tag);
    if (found == tails.end()) return -1;
    auto& ends = found->second;
    auto after = ends.lower_bound(fragment);
    while (after != ends.begin()) {
      const auto before = std::prev(after);
      if (image(*before).next < 0) return *before;
      after = ends.erase(before);
    }
    if (after != ends.end() && *after == fragment) ++after;
    while (after != ends.end() && image(*after).next >= 0) after = ends.erase(after);
    return after == ends.end() ? -1 : *after;
  }

  /// Joins continuations: first by tags over the whole deck, equal tags before those that differ by marks only; then
  /// continuations that follow an untagged card.
  void join_fragments() {
    Tails tails, bare_tails;
    for (int i = 0; i < static_cast<int>(result_.images.size()); ++i) {
      const auto tag = tail_tag(i);
      if (tag.empty()) continue;
      tails[make_upper(strip_mark(tag))].insert(i);
      if (!is_mark(tag) && tag.size() > 1) tails[make_upper(trim(tag.substr(1)))].insert(i);
      bare_tails[make_upper(strip_marks(tag))].insert(i);
    }
    for (const auto& fragment : fragments_) {
      const auto tag = strip_mark(get_first_field(text(image(fragment.image).first_line)));
      int parent = find_parent(tails, make_upper(tag), fragment.image);
      if (parent < 0) parent = find_parent(bare_tails, make_upper(strip_marks(tag)), fragment.image);
      if (parent < 0 && fragment.fallback >= 0 && image(fragment.fallback).next < 0) parent = fragment.fallback;
      if (parent >= 0) image(parent).next = fragment.image;
    }
    std::vector<char> reached(result_.images.size(), 0);
    for (int card : result_.cards)
      for (; card >= 0 && !reached[static_cast<std::size_t>(card)]; card = image(card).next)
        reached[static_cast<std::size_t>(card)] = 1;
    for (const auto& fragment : fragments_) {
      if (reached[static_cast<std::size_t>(fragment.image)]) continue;
      const auto& line = source_.lines[static_cast<std::size_t>(image(fragment.image).first_line)];
      diagnostics_.error("deck.orphan-continuation",
                         {source_.files[static_cast<std::size_t>(line.at.file)], line.at.line, 0},
                         "continuation '" + std::string(get_first_field(line.text)) + "' continues no card",
                         "repeat its mark in field 10 of the line that it continues");
    }
  }

  const Source& source_;
  Diagnostics& diagnostics_;
  CardImages result_;
  std::vector<Fragment> fragments_;
  SplitLine scratch_;
};

/// KEYWORD=value of a continuation of EIGRL, which may have commas between its pairs; "=" alone is replication.
bool is_keyword(std::string_view field) { return field.find('=') != std::string_view::npos && field.front() != '='; }

bool is_number_like(std::string_view field) {
  return parse_real(field).has_value() && field.find_first_of("0123456789") != std::string_view::npos;
}

bool is_separator(char c) { return c == ' ' || c == '\t'; }

/// Eight blank columns or more before the data: field 1 is blank.
bool has_blank_name(std::string_view text) { return text.find_first_not_of(" \t") >= 8; }

/// Commas and blanks separate; a comma with blanks around it is one separator, two commas have a blank field between.
void split_tokens(std::string_view text, std::vector<std::string_view>& tokens) {
  tokens.clear();
  if (has_blank_name(text)) tokens.emplace_back();
  std::size_t end = 0;
  for (std::size_t from = 0; end != std::string_view::npos; from = end + 1) {
    end = text.find(',', from);
    auto piece = trim(text.substr(from, end == std::string_view::npos ? end : end - from));
    if (from == 0 && is_keyword(piece) && get_first_field(text).empty()) tokens.emplace_back();
    // A blank field 1 with its own comma, ",1.,2." or "        ,1.,2.", is there already.
    if (piece.empty() && from == 0 && !tokens.empty()) continue;
    do {
      const auto last = std::find_if(piece.begin(), piece.end(), is_separator);
      tokens.push_back(piece.substr(0, static_cast<std::size_t>(last - piece.begin())));
      piece = trim(piece.substr(tokens.back().size()));
    } while (!piece.empty());
  }
}

bool has_data(const std::vector<std::string_view>& tokens, std::size_t from) {
  return std::any_of(tokens.begin() + static_cast<std::ptrdiff_t>(std::min(from, tokens.size())), tokens.end(),
                     [](std::string_view t) { return !t.empty(); });
}

/// Data beyond field 9 continues in the first field of a continuation, as if it were on a separate line.
void split_free(std::string_view text, SplitLine& line) {
  auto& tokens = line.tokens;
  split_tokens(text, tokens);
  line.name = tokens.front();
  line.is_large = !line.name.empty() && (line.name.front() == '*' || line.name.back() == '*');
  if (line.is_large && line.name.front() != '*') line.name = trim(line.name.substr(0, line.name.size() - 1));
  std::size_t per_line = line.is_large ? 4 : 8;
  bool goes_on = false;  // field 10 is data already: so is a last number there
  for (std::size_t i = 1, place = 0; i < tokens.size(); ++i, ++place) {
    const auto token = tokens[i];
    if (place == per_line) {
      const bool is_end = token.empty() || is_mark(token);
      if (is_end && i + 1 < tokens.size() && is_mark(tokens[i + 1])) {
        // "+,+" goes on with the next ten fields on the same line.
        per_line = 8;
        line.data.resize((line.data.size() + 7) / 8 * 8);
        place = static_cast<std::size_t>(-1);
        ++i;
        continue;
      }
      const bool is_last = !has_data(tokens, i + 1);
      if (is_mark(token) || (is_last && !(goes_on && is_number_like(token)))) {
        line.tag = token;
        // A bare number in field 10 is data that Nastran would not read.
        line.has_number_tag = !is_mark(token) && is_number_like(token);
        for (++i; i < tokens.size(); ++i) line.num_excess += tokens[i].empty() ? 0 : 1;
        break;
      }
      place = 0;
      goes_on = true;
    }
    line.data.push_back(token);
  }
  const std::size_t unit = line.is_large ? 4 : 8;
  line.data.resize((line.data.size() + unit - 1) / unit * unit);
  if (line.data.empty()) line.data.resize(unit);
}

}  // namespace

bool is_free_field(std::string_view text) {
  return std::memchr(text.data(), ',', std::min(text.size(), fixed_width)) != nullptr;
}

std::string_view get_first_field(std::string_view text) {
  if (!is_free_field(text)) return slice(text, 0, 8);
  if (has_blank_name(text)) return {};
  const auto first = trim(text.substr(0, text.find(',')));
  const auto word =
      first.substr(0, static_cast<std::size_t>(std::find_if(first.begin(), first.end(), is_separator) - first.begin()));
  return is_keyword(first) && !is_word(word, "DEQATN") ? std::string_view{} : word;
}

bool is_continued_by(std::string_view tag, std::string_view next_line) {
  const auto first = get_first_field(next_line);
  return is_mark(first) && matches(tag, strip_mark(first));
}

void split_line(std::string_view text, SplitLine& line) {
  line.data.clear();
  line.tag = {};
  line.is_large = line.has_number_tag = false;
  line.num_excess = 0;
  if (is_free_field(text)) {
    split_free(text, line);
    return;
  }
  line.name = slice(text, 0, 8);
  if (!line.name.empty() && (line.name.back() == '*' || line.name.front() == '*')) {
    line.is_large = true;
    if (line.name.front() != '*') line.name = trim(line.name.substr(0, line.name.size() - 1));
  }
  const std::size_t width = line.is_large ? 16 : 8;
  for (std::size_t from = 8; from < fixed_width; from += width) line.data.push_back(slice(text, from, width));
  line.tag = slice(text, fixed_width, 8);
}

CardImages make_card_images(const Source& source, std::size_t first_line, Diagnostics& diagnostics) {
  return Grouper(source, diagnostics).group(first_line);
}

}  // namespace bough::nastran::detail
