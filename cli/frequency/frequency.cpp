/// The verbs `frequency` and `transient`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/model_choice.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/solution.hpp"
#include "analysis/common/subcase_failures.hpp"
#include "analysis/listing/listing.hpp"
#include "analysis/listing/response_listing.hpp"
#include "cli/common/console.hpp"
#include "cli/common/deck_tables.hpp"
#include "cli/common/options.hpp"
#include "cli/common/text_file.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/frequency/frequency.hpp"
#include "cli/frequency/random_tables.hpp"
#include "cli/frequency/response_tables.hpp"
#include "cli/modes/modes_options.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/preload.hpp"
#include "formats/export/response_text.hpp"
#include "formats/hdf5/response_file.hpp"
#include "formats/nastran/dynamic_reader.hpp"
#include "modal/response/deck_response.hpp"
#include "modal/response/random/random_response.hpp"

namespace bough::cli {
namespace {

struct DeckResponseOptions : ModesOptions {
  bool is_over_time = false, is_direct = false, is_modal = false, no_residuals = false, full = false;
  std::vector<int> grids;
  std::string csv, punch;
};

/// The deck's EIGRL with the command line; where neither says how many modes, those up to twice the highest frequency.
modal::EigenOptions choose_eigen(const DeckResponseOptions& options, const records::DynamicDeck& deck,
                                 const records::DynamicSubcase& subcase, Diagnostics& diagnostics) {
  auto eigen = analysis::choose_eigen_options(options.eigen, deck, subcase.method, diagnostics);
  const bool is_said = options.eigen.number > 0 || options.eigen.max_hz || !deck.eigen_methods.empty();
  const double highest = modal::response::find_highest(deck, subcase.dynamics.frequency);
  if (!is_said && !options.is_over_time && highest > 0) {
    eigen.num_modes = 0;
    eigen.max_hz = 2 * highest;
  }
  return eigen;
}

void demand_grids(const DeckResponseOptions& options, const records::DynamicDeck& deck) {
  for (const int id : options.grids) {
    const bool is_grid = std::any_of(deck.grids.begin(), deck.grids.end(), [id](const auto& g) { return g.id == id; });
    const auto& points = deck.scalar_points;
    if (!is_grid && std::find(points.begin(), points.end(), id) == points.end())
      throw InputError("fe.missing-grid", deck.locate({}),
                       fmt::format("--grid names {}, which the deck does not define", id), "name a GRID or SPOINT");
  }
}

/// SOL 108 and 109 solve without modes, unless the command line requests a number of modes.
bool choose_direct(const DeckResponseOptions& options, const records::DynamicDeck& deck, Diagnostics& diagnostics) {
  static const std::array direct{"108", "109", "26", "27", "SEDFREQ", "SEDTRAN", "DFREQ", "DTRAN", "DIRECT"};
  const bool is_asked = std::find(direct.begin(), direct.end(), deck.sol) != direct.end();
  const bool wants_modes = options.is_modal || options.eigen.number > 0 || options.eigen.max_hz || options.no_residuals;
  if (options.is_direct || (is_asked && !wants_modes)) return true;
  if (is_asked)
    diagnostics.note("cli.by-modes", deck.locate({}),
                     "SOL " + deck.sol + " solves directly; this is the solution by modes",
                     "take modes well beyond the highest frequency of the excitation (--modes, --max-hz), or --direct");
  return false;
}

void note_random(const records::DynamicDeck& deck, const std::vector<records::DynamicSubcase>& subcases,
                 Diagnostics& diagnostics) {
  const auto found =
      std::find_if(subcases.begin(), subcases.end(), [](const auto& subcase) { return subcase.dynamics.random != 0; });
  if (found != subcases.end())
    diagnostics.note("modal.random-transient", deck.locate(found->find_command("RANDOM")),
                     "RANDOM has no effect on a transient response", "use 'bough frequency' for the random response");
}

int run_deck_response(const DeckResponseOptions& options) {
  Console console(options.quiet, options.verbosity);
  console.set_subject(options.deck);
  analysis::do_once([&] {
    analysis::demand_deck(options.deck);
    check_outputs(options, {options.output, options.csv, options.punch, options.listing.f06, options.listing.op2},
                  {options.deck});
  });
  console.set_rank(fe::initialize_petsc().rank);
  Diagnostics diagnostics;
  const auto model_options = analysis::make_model_options(options.model);
  const auto deck = analysis::read_loads_deck_or_throw(options.deck, model_options, true, diagnostics);
  std::vector<records::DynamicSubcase> subcases;
  std::unique_ptr<modal::response::RandomAnalysis> random;
  analysis::with_prior_messages(diagnostics, [&] {
    demand_grids(options, deck);
    subcases = modal::response::choose_response_subcases(deck, options.model.subcase, options.is_over_time);
    if (options.is_over_time) note_random(deck, subcases, diagnostics);
    Diagnostics own;
    random = std::make_unique<modal::response::RandomAnalysis>(
        deck, options.is_over_time ? std::vector<records::DynamicSubcase>{} : subcases, own);
    own.throw_if_errors();
  });
  analysis::note_solution(deck, diagnostics);
  if (subcases.empty()) {  // build_model() reports it
    subcases.emplace_back();
    subcases.back().id = options.model.subcase;
  }
  modal::response::ResponseOptions response_options;
  response_options.is_over_time = options.is_over_time;
  response_options.is_direct = choose_direct(options, deck, diagnostics);
  if (options.no_residuals) response_options.residual_vectors = false;
  response_options.grids = options.grids;
  response_options.with_listing = !options.listing.empty();
  response_options.with_random = !random->is_empty();
  response_options.choose_eigen = [&](const records::DynamicSubcase& subcase, Diagnostics& own) {
    return choose_eigen(options, deck, subcase, own);
  };
  response_options.choose_prestress = [&](const fe::ModelOptions& of, const records::DynamicSubcase& subcase,
                                          Diagnostics& own) {
    return fe::calc_subcase_prestress(deck, of, subcase, own);
  };
  modal::response::DeckResponseSolver solver(deck, model_options, response_options);
  records::DeckResponse response;
  response.is_over_time = options.is_over_time;
  analysis::SubcaseFailures failures(subcases.size(), deck.subcases.size());
  for (const auto& subcase : subcases) {
    Diagnostics own;
    try {
      console.show_progress(fmt::format("subcase {}", subcase.id));
      response.subcases.push_back(solver.solve(subcase, own));
    } catch (const Failure& failure) {
      failures.add(subcase.id, failure);
    }
    console.end_progress();
    analysis::add_new(own, diagnostics);
  }
  if (response.subcases.empty()) failures.throw_all(diagnostics);
  analysis::with_prior_messages(
      diagnostics, [&] { response.random = random->calc(response.subcases, solver.sources(), diagnostics); });
  response.source = analysis::calc_sources(deck.files);
  records::Listing listing;
  if (!options.listing.empty()) {
    Diagnostics heard;  // by the solver
    auto of_first = model_options;
    for (const auto& subcase : subcases)
      if (std::max(subcase.id, 1) == response.subcases.front().id) of_first.subcase = subcase.id;
    listing = analysis::make_response_listing(response, deck, fe::build_model(deck, of_first, heard), diagnostics);
  }
  console.print(diagnostics);
  console.print(failures.get_items(diagnostics));
  analysis::do_once([&] {
    if (!options.output.empty()) hdf5::write_response(response, options.output);
    if (!options.csv.empty()) write_text_file(options.csv, exports::make_response_csv(response));
    if (!options.punch.empty()) write_text_file(options.punch, exports::make_punch_text(response));
    if (!options.listing.empty()) write_listings(options.listing, listing);
  });
  if (options.json) {
    nlohmann::json json{{"subcases", nlohmann::json::array()}};
    for (const auto& subcase : response.subcases)
      json["subcases"].push_back(to_json(subcase, options.is_over_time, options.full));
    for (const auto& result : response.random) json["random"].push_back(to_json(result, options.full));
    if (!failures.is_empty()) json["failed"] = to_json(failures);
    console.print_data(json.dump(2) + "\n");
  } else {
    for (const auto& subcase : response.subcases)
      console.print((&subcase == &response.subcases.front() ? "" : "\n") +
                    format_response(subcase, options.is_over_time, options.full ? 1u << 30 : 20));
    for (const auto& result : response.random)
      console.print("\n" + format_random(result, options.full ? 1u << 30 : 20));
    for (const auto& path : {options.output, options.csv, options.punch, options.listing.f06, options.listing.op2})
      if (!path.empty()) console.print("written: " + path + "\n");
  }
  analysis::do_once([] { flush_data(); });
  return failures.get_exit_code();
}

void add_response_verb(CLI::App& app, Action& action, bool is_over_time, const char* name, const char* what,
                       const std::string& footer) {
  auto o = std::make_shared<DeckResponseOptions>();
  o->is_over_time = is_over_time;
  auto* verb = add_verb(app, name, what);
  verb->add_option("deck", o->deck, "Nastran deck")->required();
  verb->add_option("--grid", o->grids, "Displacement, velocity and acceleration of this grid too; may be repeated")
      ->delimiter(',')
      ->allow_extra_args(false);
  auto* direct = verb->add_flag("--direct", o->is_direct, "Without modes, whatever SOL of the deck");
  const auto add_modal = [&](CLI::Option* option) { option->excludes(direct); };
  add_modal(verb->add_flag("--modal", o->is_modal, "By modes, whatever SOL of the deck"));
  add_modal(verb->add_option("-n,--number,--modes", o->eigen.number, "Number of modes (default: the deck's EIGRL)")
                ->check(make_positive()));
  add_modal(verb->add_option("--max-hz", o->eigen.max_hz, "Modes up to this frequency"));
  add_modal(
      verb->add_flag("--no-residuals", o->no_residuals, "Modes alone, without residual vectors of what drives them"));
  verb->add_flag("--full", o->full, "Every curve in the table, their samples in --json");
  verb->add_option("--csv", o->csv, "Write the curves to this file of comma-separated values");
  verb->add_option("--punch", o->punch, "Write the curves to this Nastran punch file");
  add_listing_options(*verb, o->listing);
  add_model_options(*verb, o->model);
  add_common_options(*verb, *o, kOutput | kJson, "Write the curves to this HDF5 file");
  verb->footer(footer);
  verb->callback(
      [&action, o] { action = [o] { return analysis::with_file(o->deck, [&] { return run_deck_response(*o); }); }; });
}

}  // namespace

void add_frequency(CLI::App& app, Action& action) {
  add_response_verb(app, action, false, "frequency",
                    "Frequency response of a deck, by modes with residual vectors (SOL 111) or directly (SOL 108)",
                    "Example:\n  bough frequency bracket.bdf -o bracket.h5 --csv bracket.csv\n"
                    "  bough frequency bracket.bdf --grid 12 --max-hz 500 --punch bracket.pch");
}

void add_transient(CLI::App& app, Action& action) {
  add_response_verb(app, action, true, "transient",
                    "Transient response of a deck, by modes with residual vectors (SOL 112) or directly (SOL 109)",
                    "Example:\n  bough transient bracket.bdf -o bracket.h5 --csv bracket.csv\n"
                    "  bough transient bracket.bdf --grid 12 --json --full");
}

}  // namespace bough::cli
