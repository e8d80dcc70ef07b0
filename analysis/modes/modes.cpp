#include "analysis/modes/modes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/solution.hpp"
#include "analysis/listing/listing.hpp"
#include "analysis/modes/complex_modes.hpp"
#include "analysis/modes/sensitivities.hpp"
#include "fe/linear/petsc.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/matrices/mass_directions.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/preload.hpp"
#include "fe/statics/static_case.hpp"
#include "modal/modes_result.hpp"
#include "modal/response/residual_modes.hpp"
#include "modal/subcases.hpp"

namespace bough::analysis {

using Eigen::Vector3d;

namespace {

/// A subcase whose constraints hold, and with load factors its load.
struct Task {
  int subcase = 0;
  std::optional<modal::BucklingCases> buckling;
};

std::vector<Task> choose_tasks(const ModesRequest& request, const records::Deck& deck) {
  std::vector<Task> chosen;
  if (request.eigen.buckling) {
    for (const auto& cases : modal::list_buckling_cases(deck, request.model.subcase)) {
      const bool is_held = cases.buckling.spc != 0 || cases.buckling.mpc != 0;
      chosen.push_back({is_held ? cases.buckling.id : cases.statics.id, cases});
    }
    return chosen;
  }
  if (request.model.subcase != 0) return {{request.model.subcase, {}}};
  for (const int id : modal::list_mode_subcases(deck)) chosen.push_back({id, {}});
  return chosen;
}

/// The modes of `model`; with `selection` also the residual vectors of its loads, `num_residual` of them.
modal::EigenPairs solve_normal(const ModesRequest& request, const records::DynamicDeck& deck,
                               const records::DynamicSelection* selection, fe::Model& model, SubcaseModes& solved,
                               int& num_residual, Events& events, Diagnostics& diagnostics) {
  auto eigen = choose_eigen_options(request.eigen, deck, model.subcase().method, diagnostics);
  eigen.progress = [&](int converged, int requested) {
    events.show_progress(fmt::format("modes: {} of {} converged", converged, requested));
  };
  const auto note_number = [&](const modal::EigenPairs& pairs) {
    note_method_number(request.eigen, deck, model.subcase().method, static_cast<int>(pairs.lambda.size()), diagnostics);
  };
  if (!selection) {
    auto pairs = modal::calc_normal_modes(model, eigen, diagnostics);
    note_number(pairs);
    return pairs;
  }
  const fe::System system(model);
  auto pairs = modal::calc_normal_modes(system, eigen, diagnostics);
  note_number(pairs);
  const auto loads = modal::response::collect_residual_loads(
      model, deck, records::DynamicSubcase(model.subcase(), *selection), diagnostics);
  diagnostics.throw_if_errors();
  const auto before = pairs.lambda.size();
  solved.unused_loads = modal::response::append_residual_vectors(system, loads, pairs);
  solved.residual_loads = loads.name;
  num_residual = static_cast<int>(pairs.lambda.size() - before);
  return pairs;
}

SubcaseModes solve_task(const ModesRequest& request, const records::DynamicDeck& deck,
                        const records::CaseRequests& requests, const Task& task, fe::ModelOptions model_options,
                        ListingMaker* listing, Events& events, Diagnostics& diagnostics) {
  model_options.prestress =
      task.buckling
          ? fe::calc_subcase_prestress(deck, model_options, modal::get_preloaded(deck, *task.buckling), diagnostics)
          : calc_prestress(deck, model_options, diagnostics);
  auto model = fe::build_model(deck, model_options, diagnostics);
  diagnostics.throw_if_errors();
  if (fe::has_damping(model))
    diagnostics.note("fe.damping-unused", deck.locate({}),
                     "the dampers of the deck do not act on its modes, as in SOL 103",
                     "bough reduce adds them to the modal damping");
  const int method = task.buckling ? task.buckling->buckling.method : model.subcase().method;
  const auto norm = choose_norm(deck, method, model);
  SubcaseModes solved;
  int num_residual = 0;
  const auto* selection = find_selection(requests, model.subcase().id);
  const bool has_residuals = !task.buckling && selection && modal::response::asks_residual_vectors(deck, *selection);
  auto pairs = task.buckling
                   ? modal::solve_buckling(deck, *task.buckling, model_options, model,
                                           choose_eigen_options(request.eigen, deck, method, diagnostics), diagnostics)
                   : solve_normal(request, deck, has_residuals ? selection : nullptr, model, solved, num_residual,
                                  events, diagnostics);
  events.show_progress("");
  if (request.sensitivities) {
    const auto n = pairs.lambda.size() - num_residual;
    solved.sensitivities =
        calc_sensitivities(request.deck, model_options, model, pairs.lambda.head(n), pairs.Phi.leftCols(n));
  }
  const auto mass = fe::calc_mass_properties(model, model.mass_kind(), Vector3d::Zero());
  const bool is_buckling = request.eigen.buckling;
  if (!is_buckling) fe::report_mass(model, deck, mass, diagnostics);
  modal::normalize(model, norm, pairs.Phi, diagnostics);
  if (norm.kind != "MASS") pairs.modal_mass.resize(0);
  if (!task.buckling) pairs = modal::sort_negative(std::move(pairs));
  if (listing) {
    listing->add_weight(model);
    if (task.buckling)
      listing->add_buckling(model, pairs, task.buckling->buckling.id, diagnostics);
    else
      listing->add_modes(model, pairs, num_residual, diagnostics);
  }
  modal::ModesExtras extras{request.energies ? &deck : nullptr, request.about_grid};
  if (extras.about_grid == 0 && !is_buckling && selection)
    extras.about_grid = selection->effective_mass_grid.value_or(0);
  extras.mass = &mass;
  extras.has_shapes = request.has_shapes;
  solved.result = modal::make_modes_result(model, pairs, is_buckling, extras);
  solved.norm = norm.kind;
  if (task.buckling) solved.load = modal::describe_load(task.buckling->statics);
  solved.solvers = pairs.solvers;
  std::fill_n(solved.result.kind.end() - num_residual, num_residual, records::ModeKind::Residual);
  return solved;
}

/// The cards of loads over frequency and time, too, where residual vectors are requested.
records::DynamicDeck read_modes_deck(const ModesRequest& request, const records::CaseRequests& requests,
                                     const fe::ModelOptions& model_options, Diagnostics& diagnostics) {
  Diagnostics own;
  records::DynamicDeck deck;
  static_cast<records::Deck&>(deck) = read_deck_or_throw(request.deck, model_options, own);
  const bool has_residuals = std::any_of(
      requests.selections.begin(), requests.selections.end(),
      [&](const auto& selection) { return modal::response::asks_residual_vectors(deck, selection.second); });
  if (has_residuals && !request.eigen.buckling)
    return read_loads_deck_or_throw(request.deck, model_options, false, diagnostics);
  for (const auto& item : own.items()) diagnostics.add(item);
  return deck;
}

}  // namespace

ModesAnswer solve_modes(const ModesRequest& request, ModesReceiver& receiver, Events& events) {
  linear::initialize_petsc();
  Diagnostics diagnostics;
  auto model_options = make_model_options(request.model);
  model_options.uses_enforced = request.eigen.buckling;
  Diagnostics of_combinations;  // of static results, which are not made here
  do_once([&] { demand_deck(request.deck); });
  const auto requests = read_requests_once(request.deck, of_combinations);
  const auto deck = read_modes_deck(request, requests, model_options, diagnostics);
  const auto sources = calc_sources(deck.files);
  std::vector<Task> tasks;
  with_prior_messages(diagnostics, [&] { tasks = choose_tasks(request, deck); });
  if (modal::is_buckling_solution(deck) && !request.eigen.buckling)
    diagnostics.note("cli.buckling-deck", deck.locate({}), "the deck requests buckling (SOL " + deck.sol + ")",
                     "these are its normal modes; --buckling gives the load factors");
  if (!request.eigen.buckling && asks_complex_modes(deck, model_options.ignore_cards))
    return solve_complex_modes(request, receiver, events);
  note_solution(deck, diagnostics);
  receiver.begin(tasks.size(), false);
  ModesAnswer answer{SubcaseFailures(tasks.size(), deck.subcases.size()), {}, {}};
  std::optional<ListingMaker> listing;
  if (request.has_listing) listing.emplace(deck, requests, diagnostics);
  if (!listing && !request.energies) note_requests(deck, requests, {{"ESE", "--f06 FILE, or --ese,"}}, diagnostics);
  if (!listing)
    note_requests(deck, requests, {{"GPSTRESS", "--f06 FILE, or --op2 FILE,"}, {"STRFIELD", "--op2 FILE"}},
                  diagnostics);
  diagnostics.throw_if_errors();
  bool has_modes = false;
  for (const auto& task : tasks) {
    Diagnostics own;
    SubcaseModes solved;
    try {
      model_options.subcase = task.subcase;
      solved = solve_task(request, deck, requests, task, model_options, listing ? &*listing : nullptr, events, own);
    } catch (const Failure& failure) {
      events.show_progress("");
      answer.failures.add(task.buckling ? task.buckling->buckling.id : task.subcase, failure);
      add_warnings(own, diagnostics);
      continue;
    }
    solved.result.source = sources;
    if (task.buckling && tasks.size() > 1) solved.result.subcase = task.buckling->buckling.id;
    receiver.take(solved, own);
    add_new(own, diagnostics);
    has_modes = true;
  }
  if (!has_modes) answer.failures.throw_all(diagnostics);
  if (listing) answer.listing = listing->get();
  add_messages(diagnostics, events);
  return answer;
}

}  // namespace bough::analysis
