#include "bough/formats/nastran/detail/images.hpp"

#include <algorithm>
#include <cstring>
#include <unordered_map>

#include "bough/formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

constexpr std::size_t fixed_width = 72;  ///< name and data; the tag follows

std::string_view slice(std::string_view text, std::size_t from, std::size_t length) {
  return from < text.size() ? trim(text.substr(from, length)) : std::string_view{};
}

bool is_mark(std::string_view field) { return !field.empty() && (field.front() == '+' || field.front() == '*'); }
bool is_continuation(std::string_view first_field) { return first_field.empty() || is_mark(first_field); }
std::string_view strip_mark(std::string_view tag) { return is_mark(tag) ? trim(tag.substr(1)) : tag; }

/// Nastran compares columns 2-8 with 74-80, so the first letter of a parent's tag counts only if it is not a mark.
bool matches(std::string_view parent_tag, std::string_view tag) {
  if (strip_mark(parent_tag) == tag) return true;
  return !parent_tag.empty() && !is_mark(parent_tag) && trim(parent_tag.substr(1)) == tag;
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
    if (tag.empty() || matches(tail_tag(before), tag)) {
      ++image(before).num_lines;
      return;
    }
    fragments_.push_back({before + 1, strip_mark(tail_tag(before)).empty() ? before : -1});
    result_.images.push_back({line, 1, -1});
  }

  /// Tags first, over the whole deck; then what only follows an untagged card.
  void join_fragments() {
    std::unordered_map<std::string_view, std::vector<int>> tails;
    for (int i = 0; i < static_cast<int>(result_.images.size()); ++i) {
      const auto tag = tail_tag(i);
      if (tag.empty()) continue;
      tails[strip_mark(tag)].push_back(i);
      if (!is_mark(tag) && tag.size() > 1) tails[trim(tag.substr(1))].push_back(i);
    }
    for (const auto& fragment : fragments_) {
      const auto tag = strip_mark(get_first_field(text(image(fragment.image).first_line)));
      if (const auto found = tails.find(tag); found != tails.end()) {
        // The nearest parent before the fragment that nothing continues yet, else the first one after it.
        int parent = -1;
        for (const int i : found->second)
          if (i != fragment.image && image(i).next < 0 && (i < fragment.image || parent < 0)) parent = i;
        if (parent >= 0) {
          image(parent).next = fragment.image;
          continue;
        }
      }
      if (fragment.fallback >= 0 && image(fragment.fallback).next < 0) image(fragment.fallback).next = fragment.image;
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

void split_free(std::string_view text, SplitLine& line) {
  std::size_t index = 0, per_line = 8;
  std::size_t end = 0;
  for (std::size_t from = 0; end != std::string_view::npos; from = end + 1, ++index) {
    end = text.find(',', from);
    auto field = trim(text.substr(from, end == std::string_view::npos ? end : end - from));
    if (index == 0) {
      if (is_keyword(field)) field = {};
      const bool star = !field.empty() && (field.front() == '*' || field.back() == '*');
      line.is_large = star;
      per_line = star ? 4 : 8;
      if (star && field.front() != '*') field = trim(field.substr(0, field.size() - 1));
      line.name = field;
    } else if (index <= per_line) {
      line.data.push_back(field);
    } else if (index == per_line + 1) {
      line.tag = field;
      // A bare number in field 10 is data that Nastran would not read.
      if (!is_mark(field) && is_number_like(field)) ++line.num_excess;
    } else if (index == per_line + 2 && (line.tag.empty() || is_mark(line.tag)) && is_mark(field)) {
      // "+,+" goes on with the next ten fields on the same line.
      line.tag = {};
      line.data.resize(line.data.size() / per_line * per_line);
      index = 0;
      per_line = 8;
    } else if (!field.empty()) {
      ++line.num_excess;
    }
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
  const auto first = trim(text.substr(0, text.find(',')));
  return is_keyword(first) ? std::string_view{} : first;
}

void split_line(std::string_view text, SplitLine& line) {
  line.data.clear();
  line.tag = {};
  line.is_large = false;
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
