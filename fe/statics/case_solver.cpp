#include "fe/statics/case_solver.hpp"

#include <algorithm>

#include "fe/matrices/system.hpp"
#include "fe/statics/element_results.hpp"
#include "fe/statics/preload.hpp"

namespace bough::fe {

std::vector<records::Subcase> choose_static_subcases(const records::Deck& deck, int asked) {
  const auto enforces = [&](int set) {
    return set != 0 && std::any_of(deck.spc.begin(), deck.spc.end(), [](const auto& spc) { return spc.d != 0; });
  };
  const auto is_loaded = [&](const records::Subcase& s) {
    return s.load != 0 || s.temperature != 0 || s.deform != 0 || enforces(s.spc);
  };
  std::vector<records::Subcase> chosen;
  for (const auto& subcase : deck.subcases)
    if (asked != 0 ? subcase.id == asked : is_loaded(subcase)) chosen.push_back(subcase);
  const bool has_load = std::any_of(chosen.begin(), chosen.end(), is_loaded);
  if (has_load || (asked != 0 && chosen.empty())) return chosen;
  throw InputError("cli.no-static-load", {deck.files.empty() ? std::string{} : deck.files[0]},
                   "a static solution needs a subcase with LOAD or TEMPERATURE(LOAD), found none",
                   "write LOAD = n in the case control");
}

CaseSolver::CaseSolver(const records::Deck& deck, ModelOptions options) : deck_(deck), options_(std::move(options)) {
  options_.uses_enforced = true;
}

records::StaticSubcase CaseSolver::solve(const records::Subcase& subcase, Diagnostics& diagnostics) {
  prepare(subcase, diagnostics);
  Diagnostics own;
  const auto load = calc_static_load(*model_, deck_, subcase, own);
  own.throw_if_errors();
  auto solved = solve_static_case(*model_, *solver_, load, suport_, &own);
  solved.id = subcase.id;
  solved.label = subcase.label.empty() ? subcase.subtitle : subcase.label;
  solved.load_set = subcase.load;
  solved.temperature_set = subcase.temperature;
  solved.spc_set = subcase.spc;
  solved.mpc_set = subcase.mpc;
  solved.elements = calc_element_forces(*model_, solved.displacement, deck_, subcase.load, own, load.initial);
  solved.stresses = calc_element_stresses(*model_, solved.displacement, deck_, subcase.load, load.initial);
  if (has_strains_)
    solved.strains = calc_element_strains(*model_, solved.displacement, deck_, subcase.load, load.initial);
  if (grids_) solved.grid_forces = calc_grid_forces(*model_, solved, load.initial, *grids_);
  for (const auto& item : own.items()) diagnostics.add(item);
  return solved;
}

void CaseSolver::prepare(const records::Subcase& subcase, Diagnostics& diagnostics) {
  const std::array<int, 5> held{subcase.spc, subcase.mpc, subcase.suport1, subcase.preload,
                                subcase.initial_temperature};
  if (held_ == held && (!model_ || model_->is_held_for(deck_, subcase.load))) {
    if (failure_) std::rethrow_exception(failure_);
    return;
  }
  held_ = held;
  failure_ = nullptr;
  solver_.reset();
  try {
    Diagnostics own;
    options_.subcase = subcase.id;
    options_.prestress = nullptr;
    options_.prestress = calc_subcase_prestress(deck_, options_, subcase, own);
    auto model = Model::build(deck_, options_, own);
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
