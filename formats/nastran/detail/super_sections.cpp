#include "formats/nastran/detail/super_sections.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "formats/nastran/detail/builder.hpp"
#include "formats/nastran/detail/executive.hpp"
#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

/// Number of "BEGIN SUPER = n"; 0: the line begins no section of a superelement.
int find_section(std::string_view line) {
  auto text = trim(line);
  if (text.size() < 5 || !is_word(find_first_word(text), "BEGIN")) return 0;
  text = trim(text.substr(5));
  if (is_word(find_first_word(text), "BULK")) text = trim(text.substr(4));
  if (!is_word(find_first_word(text), "SUPER")) return 0;
  text = trim(text.substr(5));
  if (!text.empty() && text.front() == '=') text = trim(text.substr(1));
  return parse_int(text).value_or(0);
}

Source cut(const Source& source, std::size_t first, std::size_t last) {
  Source part;
  part.files = source.files;
  part.texts = source.texts;
  part.lines.assign(source.lines.begin() + static_cast<std::ptrdiff_t>(first),
                    source.lines.begin() + static_cast<std::ptrdiff_t>(last));
  for (const auto at : source.after_empty)
    if (at >= first && at < last) part.after_empty.push_back(at - first);
  return part;
}

/// 'file', "file" or file up to a comma or blank; `rest` is what follows.
std::string take_name(std::string_view text, std::string_view& rest) {
  text = trim(text);
  std::size_t begin = 0, end = text.find_first_of(", ");
  if (!text.empty() && (text.front() == '\'' || text.front() == '"')) {
    begin = 1;
    end = text.find(text.front(), 1);
  }
  const auto name = text.substr(begin, end == std::string_view::npos ? end : end - begin);
  rest = end == std::string_view::npos ? std::string_view{} : text.substr(end + begin);
  return std::string(trim(name));
}

std::optional<int> find_unit(std::string_view text) {
  const auto upper = make_upper(text);
  const auto at = upper.find("UNIT");
  if (at == std::string::npos) return {};
  auto value = trim(std::string_view(upper).substr(at + 4));
  if (value.empty() || value.front() != '=') return {};
  value = trim(value.substr(1));
  return parse_int(value.substr(0, value.find_first_of(", ")));
}

}  // namespace

BulkSections split_bulk(const Source& source) {
  BulkSections bulk;
  std::vector<std::pair<std::size_t, int>> starts;
  for (std::size_t i = 0; i < source.lines.size(); ++i) {
    const auto text = source.lines[i].text;
    const char c = text[std::min(text.find_first_not_of(" \t"), text.size() - 1)];
    if (c != 'B' && c != 'b') continue;
    if (const int id = find_section(text); id > 0) starts.emplace_back(i, id);
  }
  if (starts.empty()) return bulk;
  bulk.main = cut(source, 0, starts.front().first);
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const auto last = k + 1 < starts.size() ? starts[k + 1].first : source.lines.size();
    bulk.sections.push_back(
        {starts[k].second, source.lines[starts[k].first].at, cut(source, starts[k].first + 1, last)});
  }
  return bulk;
}

void read_sections(const BulkSections& bulk, const ComponentCases& cases, const ReadOptions& options,
                   records::Deck& deck, Diagnostics& diagnostics) {
  for (const auto& section : bulk.sections) {
    auto read = std::make_shared<records::Deck>();
    read->files = deck.files;
    const auto found = cases.find(section.id);
    // Temperatures of materials are selected by the subcases of the section, or by all.
    read->subcases = found != cases.end() ? found->second : deck.subcases;
    Diagnostics own;
    read_bulk(section.source, 0, options, *read, own);
    // Sets of a component name its boundary and its generalized coordinates.
    for (const auto& item : own.items())
      if (item.id != "deck.unused-card" || std::string_view("BCQ").find(item.what.front()) == std::string_view::npos ||
          item.what.substr(1, 3) != "SET")
        diagnostics.add(item);
    if (found == cases.end()) read->subcases.assign(1, {});
    deck.super.sections.push_back({section.id, std::move(read), section.at});
  }
}

void read_assigned_files(const Source& source, records::Deck& deck) {
  visit_statements(source, "ASSIGN", [&](const std::string& text, const auto& at) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || !is_word(trim(std::string_view(text).substr(0, equals)), "INPUTT4")) return;
    std::string_view rest;
    const auto name = take_name(std::string_view(text).substr(equals + 1), rest);
    if (const auto unit = find_unit(rest)) deck.super.input4[*unit] = {name, at};
  });
}

}  // namespace bough::nastran::detail
