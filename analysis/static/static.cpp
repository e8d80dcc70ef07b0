#include "analysis/static/static.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "analysis/common/choices.hpp"
#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/solution.hpp"
#include "analysis/common/superelements.hpp"
#include "analysis/listing/listing.hpp"
#include "analysis/static/case_extremes.hpp"
#include "analysis/static/combinations.hpp"
#include "fe/linear/petsc.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/case_solver.hpp"
#include "formats/nastran/dynamic_reader.hpp"

namespace bough::analysis {

namespace {

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
                      StaticReceiver& receiver, SubcaseFailures& failures, ListingMaker* listing,
                      Diagnostics& diagnostics) {
  for (const auto& combination : requests.combinations) {
    try {
      auto sum = combine(model, deck, combination, receiver.get_kept());
      if (listing) listing->add_static(model, sum, diagnostics);
      sum.margins = calc_margins(deck, sum);
      receiver.add({std::move(sum)});
    } catch (const Failure& failure) {
      failures.add(combination.control.id, failure);
    }
  }
}

/// Reads the deck as read_deck_or_throw does; without --subcase this command makes the combinations.
records::Deck read_static_deck(const StaticRequest& request, Diagnostics& diagnostics) {
  const auto model_options = make_model_options(request.model);
  if (request.model.subcase != 0) return read_deck_or_throw(request.deck, model_options, diagnostics);
  const nastran::ReadOptions read{model_options.ignore_cards};
  auto deck = is_one_of_many() ? nastran::read_packed_combined_deck(
                                     share([&] { return nastran::pack_deck(request.deck); }), read, diagnostics)
                               : nastran::read_combined_deck(request.deck, read, diagnostics);
  join_superelements(deck, diagnostics);
  if (diagnostics.num_errors() > 0) fe::build_model(deck, model_options, diagnostics);
  diagnostics.throw_if_errors();
  return deck;
}

/// Warns of options of nonlinear solutions that are given with a linear one.
void warn_of_nonlinear_options(const StaticRequest& request, const records::Deck& deck, Diagnostics& diagnostics) {
  std::string names;
  if (request.has_arc_length) names = "--arc-length";
  if (request.has_increments || request.num_increments != StaticRequest::kDefaultIncrements)
    names += names.empty() ? "--increments" : " and --increments";
  if (names.empty()) return;
  diagnostics.warning("cli.nonlinear-option", deck.locate({0, 0}),
                      "the solution is linear, found " + names + ", without effect",
                      "give --nonlinear, or leave the option out");
}

}  // namespace

StaticAnswer solve_static(const StaticRequest& request, StaticReceiver& receiver, Events& events) {
  demand_range("--increments", request.num_increments, 1, 100000);
  linear::initialize_petsc();
  do_once([&] { demand_deck(request.deck); });
  Diagnostics diagnostics;
  const auto deck = read_static_deck(request, diagnostics);
  std::vector<records::Subcase> subcases;
  bool is_nonlinear = false;
  with_prior_messages(diagnostics, [&] {
    subcases = fe::choose_static_subcases(deck, request.model.subcase);
    is_nonlinear = choose_static_solution(deck, request.is_linear, request.is_nonlinear, diagnostics);
    if (!is_nonlinear) warn_of_nonlinear_options(request, deck, diagnostics);
    if (is_nonlinear && is_one_of_many())
      throw InputError("cli.nonlinear-ranks", {}, "nonlinear statics run on one process, found several ranks",
                       "leave mpirun out");
    if (is_nonlinear && !request.grid_forces.empty())
      throw InputError("cli.nonlinear-output", {}, "--grid-forces lists forces of linear elements",
                       "leave it out, or give --linear");
    check_forces_grids(read_grids(request.grid_forces), deck);
  });
  if (subcases.empty()) {  // build_model() reports it
    subcases.emplace_back();
    subcases.back().id = request.model.subcase;
  }
  fe::CaseSolver solver(deck, make_model_options(request.model));
  if (is_nonlinear) {
    fe::NonlinearOptions options;
    options.num_increments = request.num_increments;
    options.has_arc_length = request.has_arc_length;
    solver.ask_nonlinear(options, is_nonlinear_sequence(deck));
  }
  StaticAnswer answer{SubcaseFailures(subcases.size(), deck.subcases.size()), {}, {}};
  std::optional<ListingMaker> listing;
  const auto requests = read_requests_once(request.deck, diagnostics);
  if (request.has_strains || asks_for(requests, "STRAIN")) solver.ask_strains();
  if (request.has_listing) listing.emplace(deck, requests, diagnostics);
  const bool lists_forces = listing && asks_for(requests, "GPFORCE") && !is_nonlinear;
  if (lists_forces || !request.grid_forces.empty())
    solver.ask_grid_forces(lists_forces ? std::vector<int>{} : read_grids(request.grid_forces));
  if (is_nonlinear && asks_for(requests, "GPFORCE"))
    diagnostics.warning("cli.nonlinear-output", deck.locate({}), "GPFORCE lists forces of linear elements alone",
                        "leave it out, or give --linear");
  if (!listing)
    note_requests(
        deck, requests,
        {{"ESE", "--f06 FILE, or -o FILE.h5,"}, {"GPSTRESS", "--f06 FILE, or --op2 FILE,"}, {"STRFIELD", "--op2 FILE"}},
        diagnostics);
  if (is_nonlinear && !requests.combinations.empty())
    diagnostics.error("cli.nonlinear-combination", deck.locate({}),
                      "SUBCOM, SYMCOM or REPCASE adds subcases, which nonlinear solutions do not allow",
                      "take it away, or give --linear");
  if (!listing && request.grid_forces.empty() && !is_nonlinear)
    note_requests(deck, requests, {{"GPFORCE", "--f06 FILE, or --grid-forces all,"}}, diagnostics);
  diagnostics.throw_if_errors();
  receiver.begin(request.model.subcase == 0 && !requests.combinations.empty());
  bool is_empty = true;
  const auto take = [&](fe::CaseSolver::Solved& one) {
    if (one.failure) std::rethrow_exception(one.failure);
    if (listing) {
      listing->add_weight(solver.model());
      listing->add_static(solver.model(), *one.result, one.diagnostics);
    }
    if (lists_forces) keep_grid_forces(request.grid_forces, *one.result);
  };
  for (std::size_t next = 0; next < subcases.size() && !receiver.has_failed();) {
    std::vector<records::StaticSubcase> solved;
    for (auto& one : solver.solve_next(std::span(subcases).subspan(next))) {
      const int id = subcases[next++].id;
      try {
        take(one);
        solved.push_back(std::move(*one.result));
      } catch (const Failure& failure) {
        answer.failures.add(id, failure);
      }
      add_new(one.diagnostics, diagnostics);
    }
    if (solved.empty()) continue;
    if (is_empty) receiver.set_model(solver.model());
    is_empty = false;
    for (auto& subcase : solved) subcase.margins = calc_margins(deck, subcase);
    receiver.add(std::move(solved));
  }
  if (is_empty) answer.failures.throw_all(diagnostics);
  if (request.model.subcase == 0)
    add_combinations(deck, requests, solver.model(), receiver, answer.failures, listing ? &*listing : nullptr,
                     diagnostics);
  if (listing) answer.listing = listing->get();
  answer.source = calc_sources(deck.files);
  add_messages(diagnostics, events);
  return answer;
}

}  // namespace bough::analysis
