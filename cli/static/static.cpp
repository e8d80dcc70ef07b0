#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>

#include "cli/common/console.hpp"
#include "cli/common/model_options.hpp"
#include "cli/common/options.hpp"
#include "cli/common/ranks.hpp"
#include "cli/common/solution.hpp"
#include "cli/common/subcase_failures.hpp"
#include "cli/common/text_file.hpp"
#include "cli/common/vtu_file.hpp"
#include "cli/listing/listing.hpp"
#include "cli/static/case_extremes.hpp"
#include "cli/static/combinations.hpp"
#include "cli/static/static_tables.hpp"
#include "fe/statics/case_solver.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/nastran/dynamic_reader.hpp"

namespace bough::cli {

using Eigen::VectorXd;

namespace {

struct StaticOptions : CommonOptions {
  std::string deck, vtu;
  DeckModelOptions model;
  std::vector<std::string> grid_forces;
  bool full = false, in_cd = false, is_linear = false, has_extremes = false, has_strains = false;
  ListingOptions listing;
};

/// Vectors in the displacement axes of their grids, as other programs print them.
records::StaticResult turn_to_cd(const fe::Model& model, records::StaticResult result) {
  for (auto& s : result.subcases)
    for (VectorXd* v : {&s.displacement, &s.load, &s.reaction, &s.mpc_force, &s.inertia})
      for (const auto& node : model.nodes())
        for (int i = 0; i < node.num_dofs / 3 && v->size() > 0; ++i) {
          auto part = v->segment<3>(node.first_gdof + 3 * i);
          part = (node.R_basic_cd.transpose() * part).eval();
        }
  return result;
}

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

/// Of the forces on all grids, which the listing had, those that --grid-forces asks for.
void keep_grid_forces(const std::vector<std::string>& words, records::StaticResult& result) {
  const auto ids = read_grids(words);
  for (auto& subcase : result.subcases)
    std::erase_if(subcase.grid_forces, [&](const records::GridForce& f) {
      return words.empty() || (!ids.empty() && std::find(ids.begin(), ids.end(), f.node) == ids.end());
    });
}

/// SUBCOM, SYMCOM and REPCASE behind the subcases.
void add_combinations(const records::Deck& deck, const records::CaseRequests& requests, const fe::Model& model,
                      records::StaticResult& result, SubcaseFailures& failures, ListingMaker* listing,
                      Diagnostics& diagnostics) {
  for (const auto& combination : requests.combinations) {
    try {
      result.subcases.push_back(combine(model, deck, combination, result.subcases));
      if (listing) listing->add_static(model, result.subcases.back(), diagnostics);
    } catch (const Failure& failure) {
      failures.add(combination.control.id, failure);
    }
  }
}

/// As read_deck_or_throw; without --subcase this verb makes the combinations.
records::Deck read_static_deck(const StaticOptions& options, Diagnostics& diagnostics) {
  const auto model_options = make_model_options(options.model);
  if (options.model.subcase != 0) return read_deck_or_throw(options.deck, model_options, diagnostics);
  const nastran::ReadOptions read{model_options.ignore_cards};
  auto deck = is_one_of_many() ? nastran::read_packed_combined_deck(
                                     share([&] { return nastran::pack_deck(options.deck); }), read, diagnostics)
                               : nastran::read_combined_deck(options.deck, read, diagnostics);
  if (diagnostics.num_errors() > 0) fe::Model::build(deck, model_options, diagnostics);
  diagnostics.throw_if_errors();
  return deck;
}

int run_static(const StaticOptions& options) {
  Console console(options.quiet, options.verbosity);
  console.set_subject(options.deck);
  do_once([&] {
    demand_deck(options.deck);
    check_outputs(options, {options.output, options.vtu, options.listing.f06, options.listing.op2}, {options.deck});
  });
  console.set_rank(fe::initialize_petsc().rank);

  Diagnostics diagnostics;
  const auto deck = read_static_deck(options, diagnostics);
  std::vector<records::Subcase> subcases;
  say_first(diagnostics, [&] {
    subcases = fe::choose_static_subcases(deck, options.model.subcase);
    demand_static_solution(deck, options.is_linear, diagnostics);
    check_forces_grids(read_grids(options.grid_forces), deck);
  });
  if (subcases.empty()) {  // Model::build reports it
    subcases.emplace_back();
    subcases.back().id = options.model.subcase;
  }
  records::StaticResult result;
  fe::CaseSolver solver(deck, make_model_options(options.model));
  SubcaseFailures failures(subcases.size(), deck.subcases.size());
  std::optional<ListingMaker> listing;
  const auto requests = read_requests_once(options.deck, diagnostics);
  if (options.has_strains || asks_for(requests, "STRAIN")) solver.ask_strains();
  if (!options.listing.empty()) listing.emplace(deck, requests, diagnostics);
  const bool lists_forces = listing && asks_for(requests, "GPFORCE");
  if (lists_forces || !options.grid_forces.empty())
    solver.ask_grid_forces(lists_forces ? std::vector<int>{} : read_grids(options.grid_forces));
  if (!listing) note_requests(deck, requests, {{"ESE", "--f06 FILE, or -o FILE.h5,"}}, diagnostics);
  if (!listing && options.grid_forces.empty())
    note_requests(deck, requests, {{"GPFORCE", "--f06 FILE, or --grid-forces all,"}}, diagnostics);
  diagnostics.throw_if_errors();
  for (std::size_t next = 0; next < subcases.size();)
    for (auto& one : solver.solve_next(std::span(subcases).subspan(next))) {
      const int id = subcases[next++].id;
      try {
        if (one.failure) std::rethrow_exception(one.failure);
        result.subcases.push_back(std::move(*one.result));
        if (listing) {
          listing->add_weight(solver.model());
          listing->add_static(solver.model(), result.subcases.back(), one.said);
        }
      } catch (const Failure& failure) {
        failures.add(id, failure);
      }
      add_new(one.said, diagnostics);
    }
  if (result.subcases.empty()) failures.throw_all(diagnostics);
  if (options.model.subcase == 0)
    add_combinations(deck, requests, solver.model(), result, failures, listing ? &*listing : nullptr, diagnostics);
  if (lists_forces) keep_grid_forces(options.grid_forces, result);
  result.dof_map = solver.model().calc_dof_map();
  result.mesh = solver.model().calc_mesh();
  result.source = calc_sources(deck.files);
  for (auto& subcase : result.subcases) subcase.margins = calc_margins(deck, subcase);
  if (options.has_extremes) result.extremes = find_case_extremes(result);
  std::string picture;
  if (!options.vtu.empty() && console.is_root())
    picture = make_vtu_text(exports::make_picture(result), exports::VtuEncoding::Base64, options.deck, diagnostics);
  console.print(diagnostics);
  console.print(failures.get_items(diagnostics));

  if (!options.output.empty() && console.is_root()) hdf5::write_static(result, options.output);
  if (options.in_cd) result = turn_to_cd(solver.model(), std::move(result));
  if (options.in_cd && options.has_extremes) result.extremes = find_case_extremes(result);
  if (options.json) {
    nlohmann::json json{{"subcases", nlohmann::json::array()}};
    for (const auto& subcase : result.subcases) json["subcases"].push_back(to_json(result, subcase, options.full));
    if (options.has_extremes) json["extremes"] = to_json(result.extremes);
    if (!failures.is_empty()) json["failed"] = failures.to_json();
    console.print_data(json.dump(2) + "\n");
  } else {
    for (const auto& subcase : result.subcases) console.print(format_static(result, subcase, options.full));
    console.print(format_case_extremes(result.extremes));
  }
  if (!picture.empty()) write_text_file(options.vtu, picture);
  if (listing) do_once([&] { write_listings(options.listing, listing->get()); });
  for (const auto& path : {options.output, options.vtu, options.listing.f06, options.listing.op2})
    if (!path.empty() && !options.json) console.print("written: " + path + "\n");
  // A rank that ends with an error ends the others: the first one must be through.
  do_once([] { flush_data(); });
  return failures.get_exit_code();
}

}  // namespace

void add_static(CLI::App& app, Action& action) {
  auto o = std::make_shared<StaticOptions>();
  auto* verb = app.add_subcommand("static", "Static solution (SOL 101) of every subcase with a load");
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
  verb->callback([&action, o] { action = [o] { return blame(o->deck, [&] { return run_static(*o); }); }; });
}

}  // namespace bough::cli
