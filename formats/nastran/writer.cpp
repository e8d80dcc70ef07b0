#include "formats/nastran/writer.hpp"

#include <algorithm>
#include <map>

#include "formats/nastran/detail/card_sink.hpp"
#include "formats/nastran/detail/reading.hpp"

namespace bough::nastran {
namespace {

using records::Deck;

/// "1.5*K1, 1.*K2": a line for each, so that none grows beyond 72 columns.
std::string join_matrices(const std::vector<std::pair<double, std::string>>& matrices) {
  std::string text;
  for (const auto& [factor, name] : matrices)
    text += (text.empty() ? "" : ",\n  ") + (factor == 1 ? "1." : detail::format_exact_real(factor)) + "*" + name;
  return text;
}

void write_selection(const records::Subcase& subcase, std::string& out) {
  const auto add = [&](const char* word, const std::string& value) {
    if (!value.empty()) out += std::string(word) + " = " + value + "\n";
  };
  add("TITLE", subcase.title);
  add("SUBTITLE", subcase.subtitle);
  add("LABEL", subcase.label);
  const std::pair<const char*, int> sets[] = {{"SPC", subcase.spc},
                                              {"MPC", subcase.mpc},
                                              {"LOAD", subcase.load},
                                              {"TEMPERATURE(LOAD)", subcase.temperature},
                                              {"TEMPERATURE(INITIAL)", subcase.initial_temperature},
                                              {"TEMPERATURE(MATERIAL)", subcase.material_temperature},
                                              {"METHOD", subcase.method},
                                              {"STATSUB", subcase.statsub},
                                              {"STATSUB(PRELOAD)", subcase.preload},
                                              {"SUPORT1", subcase.suport1},
                                              {"NSM", subcase.nsm}};
  for (const auto& [word, set] : sets)
    if (set != 0) add(word, std::to_string(set));
  add("K2GG", join_matrices(subcase.k2gg));
  add("M2GG", join_matrices(subcase.m2gg));
  add("B2GG", join_matrices(subcase.b2gg));
}

void write_control(const Deck& deck, std::string& out) {
  for (const auto& [cell, value] : deck.system_cells) out += "NASTRAN " + cell + "=" + value + "\n";
  if (!deck.sol.empty()) out += "SOL " + deck.sol + "\n";
  out += "CEND\n";
  for (const auto& subcase : deck.subcases) {
    if (subcase.id != 0) out += "SUBCASE " + std::to_string(subcase.id) + "\n";
    write_selection(subcase, out);
  }
  out += "BEGIN BULK\n";
}

/// No part of the deck may be lost silently.
void report_lost(const Deck& deck, Diagnostics& diagnostics) {
  const SourceLocation where{deck.files.empty() ? std::string{} : deck.files.front()};
  std::string left_out;
  for (const auto& card : deck.unused) left_out += (left_out.empty() ? "" : ", ") + card.name;
  for (const auto& text : deck.left_out) left_out += (left_out.empty() ? "" : ", ") + text;
  if (!left_out.empty())
    diagnostics.warning("deck.left-out", where, "cards that are not in the new deck: " + left_out,
                        "copy them from the old one if they are needed");
  for (const auto& section : deck.super.sections)
    diagnostics.error("deck.not-written", deck.locate(section.at),
                      "the section BEGIN SUPER = " + std::to_string(section.id) + " cannot be written",
                      "put its cards into the main bulk data, or keep the deck as it is");
  for (const auto& [name, count] : deck.card_counts) {
    const bool is_unused = std::any_of(deck.unused.begin(), deck.unused.end(),
                                       [&, &n = name](const auto& card) { return card.name == n; });
    const auto row = detail::get_card_parsers().find(name);
    const bool is_written =
        row != detail::get_card_parsers().end() && (row->second.write != nullptr || row->second.written_as != nullptr);
    if (is_unused || is_written) continue;
    diagnostics.error("deck.not-written", where,
                      name + " cannot be written (" + std::to_string(count) + " in the deck)",
                      "--ignore " + name + " writes the deck without it");
  }
}

}  // namespace

std::string write_deck(const Deck& deck, const WriteOptions& options, Diagnostics& diagnostics) {
  report_lost(deck, diagnostics);
  detail::CardSink sink;
  sink.format = options.fields;
  write_control(deck, sink.out);
  std::map<int, detail::CardWriter> writers;
  for (const auto& [name, row] : detail::get_card_parsers())
    if (row.write != nullptr) writers[row.write_order] = row.write;
  for (const auto& [order, write] : writers) write(deck, sink);
  sink.out += "ENDDATA\n";
  return std::move(sink.out);
}

}  // namespace bough::nastran
