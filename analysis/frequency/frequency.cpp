#include "analysis/frequency/frequency.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/solution.hpp"
#include "analysis/listing/listing.hpp"
#include "analysis/listing/response_listing.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/preload.hpp"
#include "modal/response/deck_response.hpp"
#include "modal/response/random/random_response.hpp"

namespace bough::analysis {
namespace {

/// Options of the modes by the request and the deck's EIGRL; without a number, the modes up to twice the highest
/// frequency.
modal::EigenOptions choose_eigen(const DeckResponseRequest& request, const records::DynamicDeck& deck,
                                 const records::DynamicSubcase& subcase, Diagnostics& diagnostics) {
  auto eigen = choose_eigen_options(request.eigen, deck, subcase.method, diagnostics);
  const bool is_given = request.eigen.number > 0 || request.eigen.max_hz || !deck.eigen_methods.empty();
  const double highest = modal::response::find_highest(deck, subcase.dynamics.frequency);
  if (!is_given && !request.is_transient && highest > 0) {
    eigen.num_modes = 0;
    eigen.max_hz = 2 * highest;
  }
  return eigen;
}

void demand_grids(const DeckResponseRequest& request, const records::DynamicDeck& deck) {
  for (const int id : request.grids) {
    const bool is_grid = std::any_of(deck.grids.begin(), deck.grids.end(), [id](const auto& g) { return g.id == id; });
    const auto& points = deck.scalar_points;
    if (!is_grid && std::find(points.begin(), points.end(), id) == points.end())
      throw InputError("fe.missing-grid", deck.locate({}),
                       fmt::format("--grid names {}, which the deck does not define", id), "name a GRID or SPOINT");
  }
}

/// SOL 108 and 109 solve without modes, unless the request has a number of modes.
bool choose_direct(const DeckResponseRequest& request, const records::DynamicDeck& deck, Diagnostics& diagnostics) {
  const auto* solution = find_response_solution(deck.sol);
  const bool is_direct_sol = solution && solution->is_direct;
  const bool needs_modes = request.is_modal || request.eigen.number > 0 || request.eigen.max_hz || request.no_residuals;
  if (request.is_direct || (is_direct_sol && !needs_modes)) return true;
  if (is_direct_sol)
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

/// Notes requests of results that responses do not have.
void note_unlisted_requests(const records::DynamicDeck& deck, Diagnostics& diagnostics) {
  records::CaseRequests requests;
  requests.selections = deck.selections;
  for (const char* command : {"STRAIN", "GPSTRESS", "STRFIELD"})
    if (asks_for(requests, command))
      diagnostics.note("cli.request-by-option", deck.locate({}),
                       std::string("the deck requests ") + command + ", which responses do not have",
                       "write STRESS = ALL; bough static and modes list it");
}

}  // namespace

DeckResponseAnswer solve_deck_response(const DeckResponseRequest& request, Events& events) {
  linear::initialize_petsc();
  do_once([&] { demand_deck(request.deck); });
  Diagnostics diagnostics;
  const auto model_options = make_model_options(request.model);
  const auto deck = read_loads_deck_or_throw(request.deck, model_options, true, diagnostics);
  std::vector<records::DynamicSubcase> subcases;
  std::unique_ptr<modal::response::RandomAnalysis> random;
  with_prior_messages(diagnostics, [&] {
    demand_grids(request, deck);
    subcases = modal::response::choose_response_subcases(deck, request.model.subcase, request.is_transient);
    if (request.is_transient) note_random(deck, subcases, diagnostics);
    Diagnostics of_solution;
    if (request.is_transient && !request.is_linear) check_nonlinear_transient(deck, subcases.size(), of_solution);
    of_solution.throw_if_errors();
    Diagnostics own;
    random = std::make_unique<modal::response::RandomAnalysis>(
        deck, request.is_transient ? std::vector<records::DynamicSubcase>{} : subcases, own);
    own.throw_if_errors();
  });
  note_solution(deck, diagnostics);
  note_unlisted_requests(deck, diagnostics);
  if (subcases.empty()) {  // build_model() reports it
    subcases.emplace_back();
    subcases.back().id = request.model.subcase;
  }
  modal::response::ResponseOptions response_options;
  response_options.is_over_time = request.is_transient;
  response_options.is_direct = choose_direct(request, deck, diagnostics);
  if (request.no_residuals) response_options.residual_vectors = false;
  response_options.grids = request.grids;
  response_options.with_listing = request.has_listing;
  response_options.with_random = !random->is_empty();
  response_options.choose_eigen = [&](const records::DynamicSubcase& subcase, Diagnostics& own) {
    return choose_eigen(request, deck, subcase, own);
  };
  response_options.choose_prestress = [&](const fe::ModelOptions& of, const records::DynamicSubcase& subcase,
                                          Diagnostics& own) {
    return fe::calc_subcase_prestress(deck, of, subcase, own);
  };
  modal::response::DeckResponseSolver solver(deck, model_options, response_options);
  DeckResponseAnswer answer{{}, SubcaseFailures(subcases.size(), deck.subcases.size()), {}};
  auto& response = answer.response;
  response.is_over_time = request.is_transient;
  for (const auto& subcase : subcases) {
    Diagnostics own;
    try {
      events.show_progress(fmt::format("subcase {}", subcase.id));
      response.subcases.push_back(solver.solve(subcase, own));
    } catch (const Failure& failure) {
      answer.failures.add(subcase.id, failure);
    }
    events.show_progress("");
    add_new(own, diagnostics);
  }
  if (response.subcases.empty()) answer.failures.throw_all(diagnostics);
  with_prior_messages(diagnostics, [&] {
    if (request.notching.empty()) {
      response.random = random->calc(response.subcases, solver.sources(), diagnostics);
      return;
    }
    answer.notches = make_notches(response.subcases);
    notch_magnitudes(request.notching, response.subcases, answer.notches);
    // The integral over the band by modes is that of the full input: notched ones have their output frequencies.
    if (request.notching.has_densities()) {
      Diagnostics of_full;
      notch_densities(request.notching, random->calc(response.subcases, {}, of_full), response.subcases,
                      answer.notches);
    }
    response.random = random->calc(response.subcases, {}, diagnostics);
  });
  response.source = calc_sources(deck.files);
  if (request.has_listing) {
    Diagnostics of_model;  // reported by the solver
    auto of_first = model_options;
    for (const auto& subcase : subcases)
      if (std::max(subcase.id, 1) == response.subcases.front().id) of_first.subcase = subcase.id;
    answer.listing = make_response_listing(response, deck, fe::build_model(deck, of_first, of_model), diagnostics);
  }
  add_messages(diagnostics, events);
  return answer;
}

}  // namespace bough::analysis
