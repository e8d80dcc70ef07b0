/// The commands `frequency` and `transient`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/frequency/frequency.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/deck_tables.hpp"
#include "cli/common/model_options.hpp"
#include "cli/common/options.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/frequency/notch_tables.hpp"
#include "cli/frequency/random_tables.hpp"
#include "cli/frequency/response_tables.hpp"
#include "cli/verbs.hpp"
#include "fe/linear/petsc.hpp"
#include "formats/export/response_text.hpp"
#include "formats/hdf5/response_file.hpp"

namespace bough::cli {
namespace {

struct DeckResponseOptions : CommonOptions {
  analysis::DeckResponseRequest request;
  bool full = false;
  std::string csv, punch, notch_csv;
  std::vector<std::string> limits, densities, bands;
  analysis::ListingFiles listing;
};

int run_deck_response(const DeckResponseOptions& options) {
  Console console(options.quiet, options.verbosity);
  auto request = options.request;
  for (const auto& text : options.bands) request.notching.bands.push_back(analysis::read_notch_band(text));
  for (const auto& text : options.limits) request.notching.limits.push_back(analysis::read_notch_limit(text, false));
  for (const auto& text : options.densities) request.notching.limits.push_back(analysis::read_notch_limit(text, true));
  const std::vector<std::string> outputs{options.output,    options.csv,         options.punch,
                                         options.notch_csv, options.listing.f06, options.listing.op2};
  open_deck(console, options, request.deck, outputs);
  request.has_listing = !options.listing.empty();
  ConsoleEvents events(console);
  const auto answer = analysis::solve_deck_response(request, events);
  const auto& response = answer.response;
  console.print(events.get_messages());
  console.print(answer.failures.get_items(events.get_messages()));
  analysis::do_once([&] {
    if (!options.output.empty()) hdf5::write_response(response, options.output);
    if (!options.csv.empty()) analysis::write_text_file(options.csv, exports::make_response_csv(response));
    if (!options.punch.empty()) analysis::write_text_file(options.punch, exports::make_punch_text(response));
    if (!options.notch_csv.empty()) analysis::write_text_file(options.notch_csv, make_notch_csv(answer.notches));
    if (answer.listing) analysis::write_listings(options.listing, *answer.listing);
  });
  if (options.json) {
    nlohmann::json json{{"subcases", nlohmann::json::array()}};
    for (const auto& subcase : response.subcases)
      json["subcases"].push_back(to_json(subcase, request.is_transient, options.full));
    for (const auto& result : response.random) json["random"].push_back(to_json(result, options.full));
    for (const auto& notch : answer.notches) json["notches"].push_back(to_json(notch));
    if (!answer.failures.is_empty()) json["failed"] = to_json(answer.failures);
    console.print_data(json.dump(2) + "\n");
  } else {
    for (const auto& subcase : response.subcases)
      console.print((&subcase == &response.subcases.front() ? "" : "\n") +
                    format_response(subcase, request.is_transient, options.full ? 1u << 30 : 20));
    for (const auto& result : response.random)
      console.print("\n" + format_random(result, options.full ? 1u << 30 : 20));
    for (const auto& notch : answer.notches) console.print("\n" + format_notch(notch));
    print_written_files(options, console, outputs);
  }
  analysis::do_once([] { flush_data(); });
  return answer.failures.get_exit_code();
}

void add_response_verb(CLI::App& app, Action& action, bool is_over_time, const char* name) {
  auto [verb, o] = add_verb(app, action, run_deck_response, name, &analysis::DeckResponseRequest::deck);
  o->request.is_transient = is_over_time;
  verb->add_option("deck", o->request.deck, "Nastran deck")->required();
  verb->add_option("--grid", o->request.grids,
                   "Displacement, velocity and acceleration of this grid too; may be repeated")
      ->delimiter(',')
      ->allow_extra_args(false);
  auto* direct = verb->add_flag("--direct", o->request.is_direct, "Without modes, whatever SOL of the deck");
  const auto add_modal = [&](CLI::Option* option) { option->excludes(direct); };
  add_modal(verb->add_flag("--modal", o->request.is_modal, "By modes, whatever SOL of the deck"));
  add_modal(
      verb->add_option("-n,--number,--modes", o->request.eigen.number, "Number of modes (default: the deck's EIGRL)")
          ->check(make_positive()));
  add_modal(verb->add_option("--max-hz", o->request.eigen.max_hz, "Modes up to this frequency")->check(make_finite()));
  add_modal(verb->add_flag("--no-residuals", o->request.no_residuals,
                           "Modes alone, without residual vectors of what drives them"));
  verb->add_flag("--full", o->full, "Every curve in the table, their samples in --json");
  verb->add_option("--csv", o->csv, "Write the curves to this file of comma-separated values");
  verb->add_option("--punch", o->punch, "Write the curves to this Nastran punch file");
  if (is_over_time)
    verb->add_flag("--linear", o->request.is_linear,
                   "Solve decks of nonlinear transient response (SOL 129, 99, 159) linearly, whatever cards of "
                   "nonlinear materials, contact and large displacements they have, each subcase from rest");
  if (!is_over_time) {
    verb->add_option("--limit", o->limits,
                     "Notch the input: NAME=VALUE or NAME=VALUE@MIN:MAX (Hz), the largest magnitude of an output, as "
                     "acceleration:12:3=80; may be repeated")
        ->allow_extra_args(false);
    verb->add_option("--psd-limit", o->densities,
                     "Notch the input of the random response: NAME=VALUE[@MIN:MAX], the largest spectral density of an "
                     "output; may be repeated")
        ->allow_extra_args(false);
    verb->add_option("--notch", o->bands,
                     "Notch the input by hand: MIN:MAX=FACTOR (Hz), factor of its amplitude; may be repeated")
        ->allow_extra_args(false);
    verb->add_option("--notch-csv", o->notch_csv, "Write the factor of the input over frequency to this file");
  }
  add_listing_options(*verb, o->listing);
  add_model_options(*verb, o->request.model);
  add_common_options(*verb, *o, kOutput | kJson, "Write the curves to this HDF5 file");
}

}  // namespace

void add_frequency(CLI::App& app, Action& action) { add_response_verb(app, action, false, "frequency"); }

void add_transient(CLI::App& app, Action& action) { add_response_verb(app, action, true, "transient"); }

}  // namespace bough::cli
