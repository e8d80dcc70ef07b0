#include "formats/nastran/detail/field_text.hpp"

#include <algorithm>

#include "formats/nastran/detail/images.hpp"
#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

std::string set_free(std::string_view line, const SplitLine& split, std::size_t index, const std::string& text) {
  std::string result(line);
  const auto field = index < split.data.size() ? split.data[index] : std::string_view{};
  if (field.data() != nullptr && field.data() >= line.data() && field.data() <= line.data() + line.size()) {
    result.replace(static_cast<std::size_t>(field.data() - line.data()), field.size(), text);
    return result;
  }
  // The line ends before this field.
  const std::size_t num_commas = split.tokens.size() - 1;  // or blanks, which separate too
  if (!split.tag.empty() || num_commas > index) return {};
  return result + std::string(index + 1 - num_commas, ',') + text;
}

/// The fixed line between commas.
std::string make_free(std::string_view line, const SplitLine& split, std::size_t index, const std::string& text) {
  // In field 10 of a free line a number would be taken for data, and the line has to show a comma in column 72.
  if (!split.tag.empty() && split.tag.front() != '+' && split.tag.front() != '*' && parse_real(split.tag)) return {};
  std::string result(get_first_field(line));
  std::size_t size = index + 1;
  for (std::size_t i = index + 1; i < split.data.size(); ++i)
    if (!split.data[i].empty()) size = i + 1;
  if (!split.tag.empty()) size = split.data.size();
  for (std::size_t i = 0; i < size; ++i) (result += ',') += i == index ? text : std::string(split.data[i]);
  if (!split.tag.empty()) (result += ',') += split.tag;
  return result;
}

}  // namespace

std::string set_line_field(std::string_view line, int index, const std::string& text) {
  SplitLine split;
  split_line(line, split);
  const auto i = static_cast<std::size_t>(index);
  if (is_free_field(line)) return set_free(line, split, i, text);
  const std::size_t width = split.is_large ? 16 : 8, from = 8 + i * width;
  if (text.size() > width) return make_free(line, split, i, text);
  std::string result(line);
  if (result.size() < from) result.resize(from, ' ');
  const auto old = std::string_view(result).substr(from, width);
  const bool is_right = old.size() == width && old.front() == ' ' && old.back() != ' ';
  const std::string blanks(width - text.size(), ' ');
  const bool is_last = result.size() <= from + width;
  result.replace(from, width, is_right ? blanks + text : is_last ? text : text + blanks);
  return result;
}

std::string make_continuation_mark(std::string_view line, bool is_large) {
  SplitLine split;
  split_line(line, split);
  const std::string mark = is_large ? "*" : "+";
  if (split.tag.empty()) return mark;
  const bool is_marked = split.tag.front() == '+' || split.tag.front() == '*';
  return mark + std::string(trim(split.tag.substr(is_marked ? 1 : 0)));
}

}  // namespace bough::nastran::detail
