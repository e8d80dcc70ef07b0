#include "formats/hdf5/layouts.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace bough::hdf5 {

namespace {

/// Matches `path` against a pattern; a placeholder takes one character or more up to the next '/', '@' or literal.
bool matches_pattern(std::string_view pattern, std::string_view path, std::string& word) {
  if (pattern.empty()) return path.empty();
  if (pattern.front() != '{')
    return !path.empty() && path.front() == pattern.front() && matches_pattern(pattern.substr(1), path.substr(1), word);
  const auto rest = pattern.substr(pattern.find('}') + 1);
  const auto end = std::min(path.find_first_of("/@"), path.size());
  for (std::size_t size = end; size > 0; --size)
    if (std::string later; matches_pattern(rest, path.substr(size), later)) {
      word = later.empty() ? std::string(path.substr(0, size)) : later;
      return true;
    }
  return false;
}

bool is_name(const std::string& word) {
  return !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isalpha(c) != 0; });
}

bool is_number(const std::string& word) {
  return !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::string get_group(const std::string& path) { return path.substr(0, path.find_last_of("/@")); }

/// "12 x 3" as numbers; "scalar" has none.
std::vector<long> parse_shape(const std::string& text) {
  std::vector<long> shape;
  for (std::size_t at = 0; at < text.size();) {
    if (std::isdigit(static_cast<unsigned char>(text[at])) == 0) return shape;
    shape.push_back(std::strtol(text.c_str() + at, nullptr, 10));
    const auto next = text.find(" x ", at);
    at = next == std::string::npos ? text.size() : next + 3;
  }
  return shape;
}

std::string get_type_name(ArrayKind kind) {
  switch (kind) {
    case ArrayKind::Real:
      return "float64";
    case ArrayKind::Single:
      return "float32";
    case ArrayKind::Integer:
      return "int32";
    case ArrayKind::Text:
      return "string";
  }
  return {};
}

/// "n x 3", with the sizes that are known as numbers.
std::string describe_row_shape(const LayoutRow& row, const std::vector<long>& shape) {
  std::string text;
  const auto sizes = split_shape(row.shape);
  for (std::size_t i = 0; i < sizes.size(); ++i)
    text += (i == 0 ? "" : " x ") + (shape[i] < 0 ? sizes[i] : std::to_string(shape[i]));
  return text;
}

}  // namespace

std::vector<std::string> split_shape(std::string_view shape) {
  std::vector<std::string> sizes;
  int depth = 0;  // commas in parentheses are arguments
  std::size_t begin = 0;
  for (std::size_t at = 0; at < shape.size(); ++at) {
    depth += shape[at] == '(' ? 1 : shape[at] == ')' ? -1 : 0;
    if (shape[at] != ',' || depth > 0) continue;
    sizes.emplace_back(shape.substr(begin, at - begin));
    begin = at + 2;
  }
  if (!shape.empty()) sizes.emplace_back(shape.substr(begin));
  return sizes;
}

const Layout* find_layout(std::string_view format) {
  for (const auto& layout : get_layouts())
    if (layout.format == format) return &layout;
  return nullptr;
}

std::string LayoutMatch::fill_in(std::string_view text, const LayoutTexts& texts) const {
  std::string filled;
  while (!text.empty()) {
    const auto begin = std::min(text.find('{'), text.size());
    filled += text.substr(0, begin);
    const auto end = text.find('}', begin);
    if (end == std::string_view::npos) {
      filled += text.substr(begin);
      break;
    }
    const auto named = texts.find(std::string(text.substr(begin + 1, end - begin - 1)));
    filled += named == texts.end() ? word : named->second;
    text = text.substr(end + 1);
  }
  return filled;
}

std::optional<LayoutMatch> find_row(const Layout& layout, std::string_view path) {
  for (const auto& row : layout.rows)
    if (row.path == path) return LayoutMatch{&row, {}};
  for (const auto& row : layout.rows)
    if (std::string word; matches_pattern(row.path, path, word)) return LayoutMatch{&row, word};
  return {};
}

LayoutCounts::LayoutCounts(const Layout& layout) : layout_(layout) {}

std::string LayoutCounts::name_count(const std::string& word, const std::string& group) const {
  // A count belongs to the file if an array without a placeholder has it, else to a group.
  for (const auto& row : layout_.rows) {
    if (row.path.find('{') != std::string_view::npos) continue;
    const auto sizes = split_shape(row.shape);
    if (std::find(sizes.begin(), sizes.end(), word) != sizes.end()) return word;
  }
  for (std::string above = group;; above = get_group(above)) {
    if (counts_.count(above + "/" + word) > 0) return above + "/" + word;
    if (above.empty()) return group + "/" + word;
  }
}

std::vector<long> LayoutCounts::get_shape(const LayoutRow& row, const std::string& path) const {
  std::vector<long> shape;
  for (const auto& size : split_shape(row.shape)) {
    const auto known = is_name(size) ? counts_.find(name_count(size, get_group(path))) : counts_.end();
    shape.push_back(is_number(size)          ? std::strtol(size.c_str(), nullptr, 10)
                    : known == counts_.end() ? -1
                                             : known->second);
  }
  return shape;
}

void LayoutCounts::add(const LayoutRow& row, const std::string& path, const std::vector<long>& shape) {
  const auto sizes = split_shape(row.shape);
  if (sizes.size() != shape.size()) return;
  for (std::size_t i = 0; i < sizes.size(); ++i)
    if (is_name(sizes[i])) counts_.emplace(name_count(sizes[i], get_group(path)), shape[i]);
}

std::vector<std::string> find_layout_faults(const FileInfo& info) {
  std::vector<std::string> faults;
  const auto format = info.attributes.find("format");
  const Layout* layout = format == info.attributes.end() ? nullptr : find_layout(format->second);
  if (layout == nullptr) return faults;
  const auto find = [&](std::string_view path) {
    return std::find_if(info.objects.begin(), info.objects.end(), [&](const auto& o) { return o.path == path; });
  };
  LayoutCounts counts(*layout);
  const auto check = [&](const LayoutRow& row, const ObjectInfo& object) {
    const auto found = parse_shape(object.shape), expected = counts.get_shape(row, object.path);
    bool fits = found.size() == expected.size();
    for (std::size_t i = 0; fits && i < found.size(); ++i) fits = expected[i] < 0 || found[i] == expected[i];
    if (!fits)
      faults.push_back(object.path + " has the shape " + object.shape + ", expected " +
                       describe_row_shape(row, expected));
    else if (object.type != get_type_name(row.kind))
      faults.push_back(object.path + " is of type " + object.type + ", expected " + get_type_name(row.kind));
    counts.add(row, object.path, found);
  };
  // In the order of the rows, whose first array of a count defines it; then those of groups.
  for (const auto& row : layout->rows) {
    if (row.path.find('{') != std::string_view::npos || row.path.find('@') != std::string_view::npos) continue;
    const auto object = find(row.path);
    if (object != info.objects.end())
      check(row, *object);
    else if (row.when.empty())
      faults.push_back(std::string(row.path) + " is missing, expected " +
                       describe_row_shape(row, counts.get_shape(row, std::string(row.path))));
  }
  for (const auto& object : info.objects) {
    if (object.shape.empty()) continue;
    const auto match = find_row(*layout, object.path);
    if (match && match->row->path.find('{') != std::string_view::npos) check(*match->row, object);
  }
  return faults;
}

}  // namespace bough::hdf5
