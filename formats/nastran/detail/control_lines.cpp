#include "formats/nastran/detail/control_lines.hpp"

#include <algorithm>
#include <utility>

#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {

bool is_command(std::string_view word, std::string_view command, std::size_t shortest) {
  return word.size() >= shortest && word.size() <= command.size() && word == command.substr(0, word.size());
}

Command split_command(std::string_view text) {
  Command command;
  text = trim(text);
  const auto word = find_first_word(text);
  command.word = make_upper(word);
  auto rest = trim(text.substr(word.size()));
  if (!rest.empty() && rest.front() == '(') {
    const auto close = rest.find(')');
    command.options = make_upper(rest.substr(1, close == std::string_view::npos ? close : close - 1));
    rest = close == std::string_view::npos ? std::string_view{} : trim(rest.substr(close + 1));
  }
  if (!rest.empty() && rest.front() == '=') rest = trim(rest.substr(1));
  command.value = rest;
  return command;
}

Sections find_sections(const Source& source) {
  constexpr auto none = Sections::none;
  std::size_t cend = none, begin = none;
  for (std::size_t i = 0; i < source.lines.size() && begin == none; ++i) {
    const auto text = trim(source.lines[i].text);
    if (text.empty() || (text.front() != 'C' && text.front() != 'c' && text.front() != 'B' && text.front() != 'b'))
      continue;
    const auto word = find_first_word(text);
    if (is_word(word, "CEND") && word.size() == text.size() && cend == none) cend = i;
    if (!is_word(word, "BEGIN")) continue;
    const auto section = find_first_word(text.substr(word.size()));
    // A bare BEGIN before CEND belongs to a DMAP sequence.
    const auto is_cend = [](const Line& line) { return is_word(trim(line.text), "CEND"); };
    const bool is_dmap =
        section.empty() && cend == none &&
        std::any_of(source.lines.begin() + static_cast<std::ptrdiff_t>(i), source.lines.end(), is_cend);
    if ((section.empty() && !is_dmap) || is_word(section, "BULK")) begin = i;
  }
  return {cend, begin};
}

void read_executive(const Source& source, std::size_t last, records::Deck& deck, Diagnostics& diagnostics) {
  bool has_dmap = false;
  for (std::size_t i = 0; i < last; ++i) {
    const auto command = split_command(source.lines[i].text);
    const bool is_dmap = command.word == "COMPILE" || command.word == "ALTER" || command.word == "MALTER";
    if ((is_dmap && !std::exchange(has_dmap, true)) || command.word == "RESTART")
      diagnostics.warning(
          "deck.unused-executive", deck.locate(source.lines[i].at),
          is_dmap ? command.word + " changes the solution sequence: DMAP is not executed, and the answer may differ"
                  : "RESTART continues an earlier run: its model and its results are not read",
          is_dmap ? "compare with the results of Nastran, or remove the DMAP statements"
                  : "give the whole model in this deck");
    // "SOL 3,0" of the COSMIC programs names the solution and a subset of it.
    if (command.word == "SOL") deck.sol = make_upper(command.value.substr(0, command.value.find_first_of(" ,")));
  }
}

}  // namespace bough::nastran::detail
