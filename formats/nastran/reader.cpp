#include "formats/nastran/dynamic_reader.hpp"

#include <algorithm>

#include "formats/nastran/detail/builder.hpp"
#include "formats/nastran/detail/control.hpp"
#include "formats/nastran/detail/executive.hpp"
#include "formats/nastran/detail/known_params.hpp"
#include "formats/nastran/detail/lines.hpp"
#include "formats/nastran/detail/packing.hpp"
#include "formats/nastran/detail/super_sections.hpp"
#include "formats/nastran/reader.hpp"
#include "formats/nastran/whole_deck.hpp"

namespace bough::nastran {
namespace {

/// Without tables the set changes no model: subcases that differ in it share theirs.
void forget_material_temperatures(records::Deck& deck) {
  const auto has_tables = [](const records::Deck& one) { return !one.temperatures.materials.empty(); };
  const auto& sections = deck.super.sections;
  if (has_tables(deck) ||
      std::any_of(sections.begin(), sections.end(), [&](const auto& section) { return has_tables(*section.deck); }))
    return;
  for (auto& subcase : deck.subcases) subcase.material_temperature = 0;
}

void fill_deck(const detail::Source& source, const ReadOptions& options, records::Deck& deck,
               const detail::ControlOptions& control, Diagnostics& diagnostics) {
  auto* const dynamics = control.dynamics;
  deck.files = source.files;
  detail::read_system_cells(source, deck);
  auto requested = control;
  requested.ignore_cards = options.ignore_cards;
  requested.is_response = options.is_response;
  requested.is_complex = options.is_complex;
  detail::LoadColumns columns;
  requested.load_columns = &columns;
  detail::ComponentCases component_cases;
  requested.component_cases = &component_cases;
  const auto bulk = detail::split_bulk(source);
  for (const auto& section : bulk.sections) requested.superelements.insert(section.id);
  const auto first_line = detail::read_control(source, deck, diagnostics, requested);
  detail::read_bulk(bulk.has_sections() ? bulk.main : source, first_line, options, deck, diagnostics, dynamics);
  detail::read_assigned_files(source, deck);
  detail::read_sections(bulk, component_cases, options, deck, diagnostics);
  forget_material_temperatures(deck);
  detail::add_load_columns(columns, deck, diagnostics);
  detail::report_params(deck, options.ignore_cards, diagnostics, dynamics != nullptr && !control.is_whole);
}

records::Deck make_deck(const detail::Source& source, const ReadOptions& options, Diagnostics& diagnostics,
                        bool notes_combinations = true) {
  records::Deck deck;
  fill_deck(source, options, deck, {.notes_combinations = notes_combinations}, diagnostics);
  return deck;
}
records::DynamicDeck make_dynamic_deck(const detail::Source& source, const ReadOptions& options,
                                       Diagnostics& diagnostics) {
  records::DynamicDeck deck;
  fill_deck(source, options, deck, {.dynamics = &deck}, diagnostics);
  return deck;
}

WholeDeck make_whole_deck(const detail::Source& source, ReadOptions options, Diagnostics& diagnostics) {
  WholeDeck deck;
  options.is_response = false;
  options.is_complex = true;
  fill_deck(source, options, deck,
            {.dynamics = &deck,
             .combinations = &deck.combinations,
             .combination_diagnostics = &diagnostics,
             .post = &deck.post,
             .post_diagnostics = &diagnostics,
             .request_options = &deck.request_options,
             .is_whole = true},
            diagnostics);
  return deck;
}

records::CaseRequests make_requests(const detail::Source& source, Diagnostics& diagnostics) {
  records::DynamicDeck deck;
  records::CaseRequests requests;
  Diagnostics ignored_diagnostics;  // reported when the deck is read
  deck.files = source.files;
  detail::ControlOptions control{.dynamics = &deck,
                                 .combinations = &requests.combinations,
                                 .combination_diagnostics = &diagnostics,
                                 .post = &requests,
                                 .post_diagnostics = &diagnostics};
  for (const auto& section : detail::split_bulk(source).sections) control.superelements.insert(section.id);
  detail::read_control(source, deck, ignored_diagnostics, control);
  requests.selections = std::move(deck.selections);
  return requests;
}

}  // namespace

records::Deck read_deck(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics) {
  return make_deck(detail::read_source(path, diagnostics), options, diagnostics);
}

records::Deck read_deck_text(std::string_view text, const std::string& name, const ReadOptions& options,
                             Diagnostics& diagnostics) {
  return make_deck(detail::read_source_text(text, name, diagnostics), options, diagnostics);
}

std::string pack_deck(const std::string& path) {
  Diagnostics diagnostics;
  const auto source = detail::read_source(path, diagnostics);
  return detail::pack(source, diagnostics);
}

records::Deck read_packed_deck(std::string bytes, const ReadOptions& options, Diagnostics& diagnostics) {
  return make_deck(detail::unpack(std::move(bytes), diagnostics), options, diagnostics);
}

records::DynamicDeck read_dynamic_deck(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics) {
  return make_dynamic_deck(detail::read_source(path, diagnostics), options, diagnostics);
}
records::DynamicDeck read_dynamic_deck_text(std::string_view text, const std::string& name, const ReadOptions& options,
                                            Diagnostics& diagnostics) {
  return make_dynamic_deck(detail::read_source_text(text, name, diagnostics), options, diagnostics);
}
records::DynamicDeck read_packed_dynamic_deck(std::string bytes, const ReadOptions& options, Diagnostics& diagnostics) {
  return make_dynamic_deck(detail::unpack(std::move(bytes), diagnostics), options, diagnostics);
}

WholeDeck read_whole_deck(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics) {
  return make_whole_deck(detail::read_source(path, diagnostics), options, diagnostics);
}
WholeDeck read_whole_deck_text(std::string_view text, const std::string& name, const ReadOptions& options,
                               Diagnostics& diagnostics) {
  return make_whole_deck(detail::read_source_text(text, name, diagnostics), options, diagnostics);
}

records::Deck read_combined_deck(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics) {
  return make_deck(detail::read_source(path, diagnostics), options, diagnostics, false);
}
records::Deck read_packed_combined_deck(std::string bytes, const ReadOptions& options, Diagnostics& diagnostics) {
  return make_deck(detail::unpack(std::move(bytes), diagnostics), options, diagnostics, false);
}

records::CaseRequests read_requests(const std::string& path, Diagnostics& diagnostics) {
  Diagnostics ignored_diagnostics;
  return make_requests(detail::read_source(path, ignored_diagnostics), diagnostics);
}
records::CaseRequests read_packed_requests(std::string bytes, Diagnostics& diagnostics) {
  Diagnostics ignored_diagnostics;
  return make_requests(detail::unpack(std::move(bytes), ignored_diagnostics), diagnostics);
}

}  // namespace bough::nastran
