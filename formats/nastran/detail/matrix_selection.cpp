#include "formats/nastran/detail/matrix_selection.hpp"

#include <algorithm>
#include <cctype>
#include <optional>

#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

bool is_set(const MatrixList& matrices) {
  return matrices.size() == 1 && std::isdigit(static_cast<unsigned char>(matrices.front().second.front()));
}

/// False when no SET of names has the id.
bool expand_set(const NamedSets& sets, MatrixList& matrices) {
  if (!is_set(matrices)) return true;
  const auto set = sets.find(matrices.front().second);
  if (set == sets.end()) return false;
  matrices = set->second;
  return true;
}

}  // namespace

bool read_matrix_names(std::string_view text, MatrixList& matrices) {
  while (!text.empty()) {
    const auto term = text.substr(0, text.find_first_of(", "));
    text = trim(text.substr(term.size()));
    if (!text.empty() && text.front() == ',') text = trim(text.substr(1));
    const auto star = term.find('*');
    const auto name = make_upper(star == std::string_view::npos ? term : term.substr(star + 1));
    const auto factor = star == std::string_view::npos ? std::optional(1.0) : parse_real(term.substr(0, star));
    if (!factor || name.empty() || name.size() > 8 || find_first_word(name).size() != name.size() ||
        !std::isalpha(static_cast<unsigned char>(name.front())))
      return false;
    matrices.emplace_back(*factor, name);
  }
  return !matrices.empty();
}

namespace {

void report_no_set(const records::Deck& deck, const records::CardLocation& at, const std::string& commands,
                   const std::string& id, Diagnostics& diagnostics) {
  diagnostics.error("deck.case-control-value", deck.locate(at),
                    commands + " selects " + id + ", which no SET of names defines",
                    "write SET " + id + " = NAME, NAME");
}
void report_later(const records::Deck& deck, const records::CardLocation& at, const std::string& commands,
                  Diagnostics& diagnostics) {
  diagnostics.warning("deck.case-control-later", deck.locate(at), commands + " of a later subcase is not used",
                      "those above the first subcase or in it hold for all");
}

}  // namespace

void choose_matrices(records::Deck& deck, const NamedSets& sets, const records::CardLocation& at,
                     Diagnostics& diagnostics) {
  auto& first = deck.subcases.front();
  bool differs = false;
  for (const auto member : {&records::Subcase::k2gg, &records::Subcase::m2gg, &records::Subcase::b2gg}) {
    auto& chosen = first.*member;
    if (!expand_set(sets, chosen)) {
      report_no_set(deck, at, "K2GG, M2GG or B2GG", chosen.front().second, diagnostics);
      chosen.clear();
    }
    for (auto& subcase : deck.subcases) {
      auto own = subcase.*member;
      differs = differs || !expand_set(sets, own) || (!own.empty() && own != chosen);
      subcase.*member = chosen;
    }
  }
  if (differs) report_later(deck, at, "K2GG, M2GG or B2GG", diagnostics);
}

LoadColumns choose_load_columns(const records::Deck& deck, const std::map<int, MatrixList>& selected,
                                const NamedSets& sets, const records::CardLocation& at, Diagnostics& diagnostics) {
  LoadColumns columns;
  std::map<std::string, int> num_used;
  for (const auto& subcase : deck.subcases) {
    const auto found = selected.find(subcase.id);
    if (found == selected.end() || found->second.empty()) continue;
    auto chosen = found->second;
    if (!expand_set(sets, chosen)) {
      report_no_set(deck, at, "P2G", chosen.front().second, diagnostics);
      continue;
    }
    std::map<std::string, int> next;
    for (const auto& [scale, name] : chosen) next.try_emplace(name, 0);
    for (auto& [name, column] : next) column = ++num_used[name];
    for (const auto& [scale, name] : chosen) columns[subcase.id].push_back({scale, name, next[name]});
  }
  return columns;
}

void add_direct_input(records::DynamicDeck& deck, const NamedSets& sets, const records::CardLocation& at,
                      Diagnostics& diagnostics, bool joins_model) {
  bool differs = false;
  for (const auto& input : direct_inputs) {
    auto chosen = deck.selections[deck.subcases.front().id].*input.list;
    if (!expand_set(sets, chosen)) {
      report_no_set(deck, at, input.name, chosen.front().second, diagnostics);
      chosen.clear();
    }
    for (auto& subcase : deck.subcases) {
      auto& own = deck.selections[subcase.id].*input.list;
      differs = differs || !expand_set(sets, own) || (!own.empty() && own != chosen);
      own = chosen;
      if (!joins_model) continue;
      auto& all = subcase.*input.model;
      all.insert(all.end(), chosen.begin(), chosen.end());
    }
  }
  if (differs) report_later(deck, at, "K2PP, M2PP or B2PP", diagnostics);
}

}  // namespace bough::nastran::detail
