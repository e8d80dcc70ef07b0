#include "formats/nastran/writer.hpp"

#include <algorithm>

#include "formats/nastran/detail/card_sink.hpp"
#include "formats/nastran/detail/control_writer.hpp"
#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/detail/reading.hpp"
#include "formats/nastran/detail/write_order.hpp"
#include "formats/nastran/whole_deck.hpp"

namespace bough::nastran {
namespace {

using records::Deck;

bool has_rotor_loads(const WholeDeck& deck) {
  const auto& sweeps = deck.dynamics.rotors.sweeps;
  return std::any_of(sweeps.begin(), sweeps.end(), [](const auto& sweep) {
    return std::any_of(sweep.rotors.begin(), sweep.rotors.end(), [](const auto& rotor) { return rotor.has_stress; });
  });
}

/// No part of the deck may be lost silently.
void report_lost(const Deck& deck, const WholeDeck* dynamics, Diagnostics& diagnostics) {
  const SourceLocation where{deck.files.empty() ? std::string{} : deck.files.front()};
  std::string left_out;
  for (const auto& card : deck.unused) left_out += (left_out.empty() ? "" : ", ") + card.name;
  for (const auto& text : deck.left_out) left_out += (left_out.empty() ? "" : ", ") + text;
  if (dynamics != nullptr && has_rotor_loads(*dynamics))
    left_out += std::string(left_out.empty() ? "" : ", ") + "the set of RFORCE on ROTORD, which is written as 1";
  if (!left_out.empty())
    diagnostics.warning("deck.left-out", where, "cards that are not in the new deck: " + left_out,
                        "copy them from the old one if they are needed");
  for (const auto& [name, count] : deck.card_counts) {
    const bool is_unused = std::any_of(deck.unused.begin(), deck.unused.end(),
                                       [&, &n = name](const auto& card) { return card.name == n; });
    const bool is_written = detail::is_written_by(detail::get_card_parsers(), name) ||
                            (dynamics != nullptr && (detail::is_written_by(detail::get_dynamic_parsers(), name) ||
                                                     detail::is_written_by(detail::get_complex_parsers(), name) ||
                                                     detail::is_written_by(detail::get_rotor_parsers(), name)));
    if (is_unused || is_written) continue;
    diagnostics.error("deck.not-written", where,
                      name + " cannot be written (" + std::to_string(count) + " in the deck)",
                      "--ignore " + name + " writes the deck without it");
  }
}

std::string write_all(const Deck& deck, const WholeDeck* dynamics, const WriteOptions& options,
                      Diagnostics& diagnostics) {
  report_lost(deck, dynamics, diagnostics);
  detail::CardSink sink;
  sink.format = options.fields;
  detail::write_control(deck, dynamics, sink.out);
  detail::write_cards(detail::get_card_parsers(), deck, sink);
  if (dynamics != nullptr)
    for (const auto* table :
         {&detail::get_dynamic_parsers(), &detail::get_complex_parsers(), &detail::get_rotor_parsers()})
      detail::write_cards(*table, dynamics->dynamics, sink);
  for (const auto& section : deck.super.sections) {
    report_lost(*section.deck, nullptr, diagnostics);
    sink.out += "BEGIN SUPER=" + std::to_string(section.id) + "\n";
    detail::write_cards(detail::get_card_parsers(), *section.deck, sink);
  }
  sink.out += "ENDDATA\n";
  return std::move(sink.out);
}

}  // namespace

std::string write_deck(const Deck& deck, const WriteOptions& options, Diagnostics& diagnostics) {
  return write_all(deck, nullptr, options, diagnostics);
}
std::string write_deck(const WholeDeck& deck, const WriteOptions& options, Diagnostics& diagnostics) {
  return write_all(deck, &deck, options, diagnostics);
}

}  // namespace bough::nastran
