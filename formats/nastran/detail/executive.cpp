#include "formats/nastran/detail/executive.hpp"

#include <algorithm>

#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

/// NAME=value or NAME(value), between commas or blanks.
void read_cells(std::string text, records::Deck& deck) {
  // "A = 1" is "A=1".
  for (auto at = text.find('='); at != std::string::npos; at = text.find('=', at + 1)) {
    while (at > 0 && text[at - 1] == ' ') text.erase(--at, 1);
    while (at + 1 < text.size() && text[at + 1] == ' ') text.erase(at + 1, 1);
  }
  std::replace(text.begin(), text.end(), ',', ' ');
  for (auto rest = trim(text); !rest.empty();) {
    const auto cell = rest.substr(0, rest.find(' '));
    rest = trim(rest.substr(cell.size()));
    const auto equals = cell.find('=');
    if (equals != std::string_view::npos && equals > 0)
      deck.system_cells[make_upper(cell.substr(0, equals))] = make_upper(cell.substr(equals + 1));
  }
}

}  // namespace

void visit_statements(const Source& source, std::string_view word,
                      const std::function<void(const std::string& text, const records::CardLocation& at)>& use) {
  for (std::size_t i = 0; i < source.lines.size(); ++i) {
    const auto text = trim(source.lines[i].text);
    const auto first = find_first_word(text);
    if (is_word(first, "CEND") || is_word(first, "BEGIN")) return;
    if (!is_word(first, word)) continue;
    const auto at = source.lines[i].at;
    std::string statement(trim(text.substr(first.size())));
    while (!statement.empty() && statement.back() == ',' && i + 1 < source.lines.size())
      statement += trim(source.lines[++i].text);
    use(statement, at);
  }
}

void read_system_cells(const Source& source, records::Deck& deck) {
  visit_statements(source, "NASTRAN", [&](std::string text, const auto&) {
    std::replace(text.begin(), text.end(), '\t', ' ');
    read_cells(std::move(text), deck);
  });
}

}  // namespace bough::nastran::detail
