#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/model_choice.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/solution.hpp"
#include "analysis/common/subcase_failures.hpp"
#include "analysis/listing/listing.hpp"
#include "analysis/static/combinations.hpp"
#include "cli/common/console.hpp"
#include "cli/common/deck_tables.hpp"
#include "cli/common/model_options.hpp"
#include "cli/common/options.hpp"
#include "cli/common/text_file.hpp"
#include "cli/common/vtu_file.hpp"
#include "cli/static/static_output.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/case_solver.hpp"
#include "formats/nastran/dynamic_reader.hpp"

namespace bough::cli {

namespace {

struct StaticOptions : CommonOptions {
  std::string deck, vtu;
  analysis::ModelChoice model;
  std::vector<std::string> grid_forces;
  bool full = false, in_cd = false, is_linear = false, has_extremes = false, has_strains = false;
  ListingOptions listing;
};

/// Ids, or "all": none.
std::vector<int> read_grids(const std::vector<std::string>& words) {
  std::vector<int> grids;
  for (const auto& word : words) {
    if (word == "all" || word == "ALL") return {};
    const bool is_id = !word.empty() && word.size() < 9 && word.find_first_not_of("0123456789") == std::string::npos;
    if (!is_id)
      throw InputError("cli.bad-grids", {}, "cannot read --grid-forces \"" + word + "\"", "write all, or ids: 1,41");
    grids.push_back(std::stoi(word));
  }
  return grids;
}

/// --grid-forces names grids of the deck.
void check_forces_grids(const std::vector<int>& ids, const records::Deck& deck) {
  for (const int id : ids) {
    const bool is_grid = std::any_of(deck.grids.begin(), deck.grids.end(), [id](const auto& g) { return g.id == id; });
    const auto& points = deck.scalar_points;
    if (!is_grid && std::find(points.begin(), points.end(), id) == points.end())
      throw InputError("fe.missing-grid", deck.locate({}),
                       fmt::format("--grid-forces names {}, which the deck does not define", id),
                       "name a GRID or SPOINT");
  }
}

/// Keeps the grid forces requested by --grid-forces; the print file had those of all grids.
void keep_grid_forces(const std::vector<std::string>& words, records::StaticSubcase& subcase) {
  const auto ids = read_grids(words);
  std::erase_if(subcase.grid_forces, [&](const records::GridForce& f) {
    return words.empty() || (!ids.empty() && std::find(ids.begin(), ids.end(), f.node) == ids.end());
  });
}

/// SUBCOM, SYMCOM and REPCASE after the subcases.
void add_combinations(const records::Deck& deck, const records::CaseRequests& requests, const fe::Model& model,
                      StaticOutput& output, analysis::SubcaseFailures& failures, analysis::ListingMaker* listing,
                      Diagnostics& diagnostics) {
  for (const auto& combination : requests.combinations) {
    try {
      auto sum = analysis::combine(model, deck, combination, output.get_result().subcases);
      if (listing) listing->add_static(model, sum, diagnostics);
      output.add({std::move(sum)});
    } catch (const Failure& failure) {
      failures.add(combination.control.id, failure);
    }
  }
}

/// Output options of each subcase, from the command line and the deck.
StaticOutputOptions make_output_options(const StaticOptions& options, const records::CaseRequests& requests,
                                        bool is_root) {
  StaticOutputOptions output_options;
  if (is_root) output_options.path = options.output;
  output_options.has_text = !options.quiet && !options.json;
  output_options.has_json = options.json;
  output_options.is_full = options.full;
  output_options.in_cd = options.in_cd;
  output_options.has_extremes = options.has_extremes;
  output_options.keeps = !options.vtu.empty() || (options.model.subcase == 0 && !requests.combinations.empty());
  return output_options;
}

/// Reads the deck as read_deck_or_throw does; without --subcase this command makes the combinations.
records::Deck read_static_deck(const StaticOptions& options, Diagnostics& diagnostics) {
  const auto model_options = analysis::make_model_options(options.model);
  if (options.model.subcase != 0) return analysis::read_deck_or_throw(options.deck, model_options, diagnostics);
  const nastran::ReadOptions read{model_options.ignore_cards};
  auto deck = analysis::is_one_of_many()
                  ? nastran::read_packed_combined_deck(
                        analysis::share([&] { return nastran::pack_deck(options.deck); }), read, diagnostics)
                  : nastran::read_combined_deck(options.deck, read, diagnostics);
  if (diagnostics.num_errors() > 0) fe::build_model(deck, model_options, diagnostics);
  diagnostics.throw_if_errors();
  return deck;
}

int run_static(const StaticOptions& options) {
  Console console(options.quiet, options.verbosity);
  console.set_subject(options.deck);
  analysis::do_once([&] {
    analysis::demand_deck(options.deck);
    check_outputs(options, {options.output, options.vtu, options.listing.f06, options.listing.op2}, {options.deck});
  });
  console.set_rank(fe::initialize_petsc().rank);

  Diagnostics diagnostics;
  const auto deck = read_static_deck(options, diagnostics);
  std::vector<records::Subcase> subcases;
  analysis::with_prior_messages(diagnostics, [&] {
    subcases = fe::choose_static_subcases(deck, options.model.subcase);
    analysis::demand_static_solution(deck, options.is_linear, diagnostics);
    check_forces_grids(read_grids(options.grid_forces), deck);
  });
  if (subcases.empty()) {  // build_model() reports it
    subcases.emplace_back();
    subcases.back().id = options.model.subcase;
  }
  fe::CaseSolver solver(deck, analysis::make_model_options(options.model));
  analysis::SubcaseFailures failures(subcases.size(), deck.subcases.size());
  std::optional<analysis::ListingMaker> listing;
  const auto requests = analysis::read_requests_once(options.deck, diagnostics);
  if (options.has_strains || analysis::asks_for(requests, "STRAIN")) solver.ask_strains();
  if (!options.listing.empty()) listing.emplace(deck, requests, diagnostics);
  const bool lists_forces = listing && analysis::asks_for(requests, "GPFORCE");
  if (lists_forces || !options.grid_forces.empty())
    solver.ask_grid_forces(lists_forces ? std::vector<int>{} : read_grids(options.grid_forces));
  if (!listing) analysis::note_requests(deck, requests, {{"ESE", "--f06 FILE, or -o FILE.h5,"}}, diagnostics);
  if (!listing && options.grid_forces.empty())
    analysis::note_requests(deck, requests, {{"GPFORCE", "--f06 FILE, or --grid-forces all,"}}, diagnostics);
  diagnostics.throw_if_errors();
  StaticOutput output(deck, make_output_options(options, requests, console.is_root()));
  const auto take = [&](fe::CaseSolver::Solved& one) {
    if (one.failure) std::rethrow_exception(one.failure);
    if (listing) {
      listing->add_weight(solver.model());
      listing->add_static(solver.model(), *one.result, one.said);
    }
    if (lists_forces) keep_grid_forces(options.grid_forces, *one.result);
  };
  for (std::size_t next = 0; next < subcases.size() && !output.has_failed();) {
    std::vector<records::StaticSubcase> solved;
    for (auto& one : solver.solve_next(std::span(subcases).subspan(next))) {
      const int id = subcases[next++].id;
      try {
        take(one);
        solved.push_back(std::move(*one.result));
      } catch (const Failure& failure) {
        failures.add(id, failure);
      }
      analysis::add_new(one.said, diagnostics);
    }
    if (solved.empty()) continue;
    if (output.is_empty()) output.set_model(solver.model());
    output.add(std::move(solved));
  }
  if (output.is_empty()) failures.throw_all(diagnostics);
  if (options.model.subcase == 0)
    add_combinations(deck, requests, solver.model(), output, failures, listing ? &*listing : nullptr, diagnostics);
  std::string picture;
  if (!options.vtu.empty() && console.is_root())
    picture = make_vtu_text(exports::make_picture(output.get_result()), exports::VtuEncoding::Base64, options.deck,
                            diagnostics);
  console.print(diagnostics);
  console.print(failures.get_items(diagnostics));

  output.finish();
  if (options.json) {
    nlohmann::json json{{"subcases", output.get_subcases()}};
    if (options.has_extremes) json["extremes"] = output.get_extremes();
    if (!failures.is_empty()) json["failed"] = to_json(failures);
    console.print_data(json.dump(2) + "\n");
  } else {
    console.print(output.get_text());
  }
  if (!picture.empty()) write_text_file(options.vtu, picture);
  if (listing) analysis::do_once([&] { write_listings(options.listing, listing->get()); });
  for (const auto& path : {options.output, options.vtu, options.listing.f06, options.listing.op2})
    if (!path.empty() && !options.json) console.print("written: " + path + "\n");
  // A rank that ends with an error ends the others: the first one must be through.
  analysis::do_once([] { flush_data(); });
  return failures.get_exit_code();
}

}  // namespace

void add_static(CLI::App& app, Action& action) {
  auto o = std::make_shared<StaticOptions>();
  auto* verb = add_verb(app, "static", "Static solution (SOL 101) of every subcase with a load");
  verb->add_option("deck", o->deck, "Nastran deck")->required();
  verb->add_flag("--full", o->full, "Every grid and element instead of the largest values");
  verb->add_flag("--extremes,--maxmin", o->has_extremes,
                 "The least and the largest of each component over the subcases");
  verb->add_flag("--strains", o->has_strains, "Strains of elements beside their stresses, as STRAIN of the deck");
  verb->add_flag("--cd", o->in_cd, "Print vectors in the displacement (CD) axes of each grid, not in basic");
  verb->add_flag("--linear", o->is_linear, "Solve the cards linearly though SOL is nonlinear (106, 129, 400, ...)");
  verb->add_option("--vtu", o->vtu, "Write the displacements of every subcase to this file for ParaView");
  verb->add_option("--grid-forces", o->grid_forces, "List every force on these grids, or on all: elements, loads, SPC")
      ->delimiter(',');
  add_listing_options(*verb, o->listing);
  add_model_options(*verb, o->model);
  add_common_options(*verb, *o, kOutput | kJson, "Write displacements, reactions and forces to this HDF5 file");
  verb->footer("Example:\n  bough static frame.bdf -o frame-static.h5\n  bough static frame.bdf --subcase 2 --full");
  verb->callback(
      [&action, o] { action = [o] { return analysis::with_file(o->deck, [&] { return run_static(*o); }); }; });
}

}  // namespace bough::cli
