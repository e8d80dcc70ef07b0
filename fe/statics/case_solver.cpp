#include "fe/statics/case_solver.hpp"

#include <algorithm>

#include "fe/loads/enforced.hpp"
#include "fe/loads/load_sets.hpp"
#include "fe/matrices/system.hpp"
#include "fe/model/element_loop.hpp"
#include "fe/model/load_selection.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/element_results.hpp"
#include "fe/statics/preload.hpp"

namespace bough::fe {
namespace {

constexpr std::size_t kMaxHeated = 16;

/// Size of the next group of `left` subcases: as few groups as possible, each a little smaller than the one before it,
/// since the work after the last group overlaps with no other.
std::size_t choose_group(std::size_t left) {
  const std::size_t num = (left + CaseSolver::kMaxTogether - 1) / CaseSolver::kMaxTogether,
                    even = (left + num - 1) / num;
  return num == 1 ? left : std::min(even + even / 10, CaseSolver::kMaxTogether);
}

/// Selections that two subcases share if they share the model and its factor.
std::array<int, 6> list_held(const records::Subcase& subcase) {
  return {subcase.spc,
          subcase.mpc,
          subcase.suport1,
          subcase.preload,
          subcase.initial_temperature,
          subcase.material_temperature};
}

/// Takes over the results of solve_static_cases; the head stays.
void take(records::StaticSubcase&& from, records::StaticSubcase& to) {
  from.id = to.id;
  from.label = std::move(to.label);
  from.load_set = to.load_set;
  from.temperature_set = to.temperature_set;
  from.spc_set = to.spc_set;
  from.mpc_set = to.mpc_set;
  to = std::move(from);
}

}  // namespace

std::vector<records::Subcase> choose_static_subcases(const records::Deck& deck, int requested) {
  const auto enforces = [&](int set) {
    return set != 0 && std::any_of(deck.spc.begin(), deck.spc.end(), [](const auto& spc) { return spc.d != 0; });
  };
  const auto is_loaded = [&](const records::Subcase& s) {
    return s.load != 0 || s.temperature != 0 || s.deform != 0 || enforces(s.spc);
  };
  std::vector<records::Subcase> chosen;
  for (const auto& subcase : deck.subcases)
    if (requested != 0 ? subcase.id == requested : is_loaded(subcase)) chosen.push_back(subcase);
  const bool has_load = std::any_of(chosen.begin(), chosen.end(), is_loaded);
  if (has_load || (requested != 0 && chosen.empty())) return chosen;
  throw InputError("cli.no-static-load", {deck.files.empty() ? std::string{} : deck.files[0]},
                   "a static solution needs a subcase with LOAD or TEMPERATURE(LOAD), found none",
                   "write LOAD = n in the case control");
}

CaseSolver::CaseSolver(const records::Deck& deck, ModelOptions options) : deck_(deck), options_(std::move(options)) {
  options_.uses_enforced = true;
}

std::vector<CaseSolver::Solved> CaseSolver::solve_next(std::span<const records::Subcase> left) {
  BOUGH_DEMAND(!left.empty());
  std::vector<Solved> solved(1);
  try {
    prepare(left.front(), solved.front().diagnostics);
  } catch (const Failure&) {
    solved.front().failure = std::current_exception();
    return solved;
  }
  // Heated elements keep a kilobyte each and subcase.
  std::size_t count = 0, num_heated = 0;
  const std::size_t max_cases = choose_group(left.size());
  for (; count < (nonlinear_ ? 1 : max_cases) && is_prepared_for(left[count]); ++count)
    if (left[count].temperature != 0 && ++num_heated > kMaxHeated) break;
  solved.resize(count);
  std::vector<StaticLoad> loads(count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto& subcase = left[k];
    Diagnostics own;
    try {
      loads[k] = calc_static_load(*model_, deck_, subcase, own);
      own.throw_if_errors();
    } catch (const Failure&) {
      solved[k].failure = std::current_exception();
      continue;
    }
    for (const auto& item : own.items()) solved[k].diagnostics.add(item);
    auto& result = solved[k].result.emplace();
    result.id = subcase.id;
    result.label = subcase.label.empty() ? subcase.subtitle : subcase.label;
    result.load_set = subcase.load;
    result.temperature_set = subcase.temperature;
    result.spc_set = subcase.spc;
    result.mpc_set = subcase.mpc;
  }
  if (nonlinear_ && solved.front().result) solve_nonlinear(loads.front(), solved.front());
  const MatrixXd energy = nonlinear_ ? MatrixXd() : solve_displacements(loads, solved);
  add_element_results(loads, energy, solved);
  return solved;
}

MatrixXd CaseSolver::solve_displacements(std::span<const StaticLoad> loads, std::span<Solved> solved) const {
  std::vector<const StaticLoad*> requested;
  for (std::size_t k = 0; k < loads.size(); ++k)
    if (solved[k].result) requested.push_back(&loads[k]);
  if (requested.empty()) return {};
  if (requested.size() > 1) {
    Diagnostics own;
    try {
      MatrixXd energy;
      auto together = solve_static_cases(*model_, *solver_, requested, suport_, &own, &energy);
      if (own.items().empty()) {
        auto next = together.begin();
        for (auto& one : solved)
          if (one.result) take(std::move(*next++), *one.result);
        return energy;
      }
    } catch (const Failure&) {  // one after the other tells whose it is
    }
  }
  for (std::size_t k = 0; k < loads.size(); ++k) {
    if (!solved[k].result) continue;
    Diagnostics own;
    try {
      take(solve_static_case(*model_, *solver_, loads[k], suport_, &own), *solved[k].result);
      for (const auto& item : own.items()) solved[k].diagnostics.add(item);
    } catch (const Failure&) {
      solved[k].failure = std::current_exception();
      solved[k].result.reset();
    }
  }
  return {};
}

void CaseSolver::solve_nonlinear(const StaticLoad& load, Solved& solved) {
  auto& [found, failure, diagnostics] = solved;
  auto& result = *found;
  try {
    if (!suport_.fdofs.empty())
      throw InputError("fe.nonlinear-model", deck_.locate({}), "SUPORT and inertia relief hold a linear model",
                       "hold the structure by SPC, or give --linear");
    if (!path_ || !continues_) path_ = std::make_unique<NonlinearStatics>(*model_, deck_);
    path_->go_to_load_set(load, result.load_set, *nonlinear_, diagnostics);
    take(path_->make_result(), result);
  } catch (const Failure&) {
    failure = std::current_exception();
    found.reset();
  }
}

void CaseSolver::add_element_results(std::span<const StaticLoad> loads, const MatrixXd& energy,
                                     std::span<Solved> solved) {
  if (!layout_) layout_.emplace(*model_, deck_, RecoveredFields{true, true, has_strains_});
  std::vector<RecoveryCase> cases;
  std::vector<std::size_t> of;
  for (std::size_t k = 0; k < solved.size(); ++k) {
    if (!solved[k].result) continue;
    auto& result = *solved[k].result;
    cases.push_back({&result.displacement, result.load_set, &loads[k].initial, &solved[k].diagnostics,
                     nonlinear_ ? &path_->deformed() : nullptr});
    of.push_back(k);
  }
  MatrixXd own_energy;
  if (nonlinear_ && !of.empty()) {
    own_energy = path_->energies();
    visit_elements(*model_, get_all_elements(*model_), [&](int e, const Element&) {
      if (!get_own_elements(*model_).contains(e)) own_energy(e, 0) = 0;
    });
  }
  const MatrixXd& known = nonlinear_ ? own_energy : energy;
  auto fields = recover_elements(*model_, deck_, cases, *layout_, known.size() > 0 ? &known : nullptr);
  for (std::size_t c = 0; c < of.size(); ++c) {
    auto& result = *solved[of[c]].result;
    result.elements = std::move(fields[c].forces);
    result.stresses = std::move(fields[c].stresses);
    result.strains = std::move(fields[c].strains);
    if (grids_) result.grid_forces = calc_grid_forces(*model_, result, loads[of[c]].initial, *grids_);
  }
}

bool CaseSolver::is_prepared_for(const records::Subcase& subcase) const {
  return held_ == list_held(subcase) && (!model_ || is_held_for(*model_, deck_, subcase.load));
}

void CaseSolver::prepare(const records::Subcase& subcase, Diagnostics& diagnostics) {
  if (is_prepared_for(subcase)) {
    if (failure_) std::rethrow_exception(failure_);
    return;
  }
  held_ = list_held(subcase);
  failure_ = nullptr;
  solver_.reset();
  layout_.reset();
  path_.reset();
  try {
    Diagnostics own;
    options_.subcase = subcase.id;
    options_.prestress = nullptr;
    options_.prestress = calc_subcase_prestress(deck_, options_, subcase, own);
    auto model = build_model(deck_, options_, own);
    const auto relief = read_inertia_relief(deck_, own);
    auto fdofs = choose_suport(model, deck_, relief, own);
    own.throw_if_errors();
    auto solver = model.num_fdofs() == 0 ? std::make_unique<StaticSolver>(model)
                                         : std::make_unique<StaticSolver>(model, get_stiffness(model), fdofs);
    suport_ = calc_suport(model, *solver, std::move(fdofs), relief, locate_relief(model, deck_), own);
    model_.emplace(std::move(model));
    solver_ = std::move(solver);
    for (const auto& item : own.items()) diagnostics.add(item);
  } catch (const Failure&) {
    failure_ = std::current_exception();
    throw;
  }
}

}  // namespace bough::fe
