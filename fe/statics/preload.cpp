#include "fe/statics/preload.hpp"

#include <algorithm>

#include "fe/elements/solve_in_range.hpp"
#include "fe/elements/stress_state.hpp"
#include "fe/loads/dead_loads.hpp"
#include "fe/loads/inertial_loads.hpp"
#include "fe/loads/second_order.hpp"
#include "fe/matrices/system.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/deformed_deck.hpp"
#include "fe/statics/static_case.hpp"
#include "fe/statics/superelement_check.hpp"
#include "formats/records/load_name.hpp"

namespace bough::fe {
namespace {

const records::Subcase* find_subcase(const records::Deck& deck, int id) {
  const auto found =
      std::find_if(deck.subcases.begin(), deck.subcases.end(), [id](const auto& s) { return s.id == id; });
  return found == deck.subcases.end() ? nullptr : &*found;
}

/// The subcases that load the structure one after the other before `id` is done, `id` last.
std::vector<const records::Subcase*> list_chain(const records::Deck& deck, int id, SourceLocation at,
                                                Diagnostics& diagnostics) {
  std::vector<const records::Subcase*> chain;
  const auto fail = [&](const std::string& what, const std::string& advice) {
    diagnostics.error("fe.preload-subcase", at, what, advice);
    return std::vector<const records::Subcase*>{};
  };
  while (id != 0) {
    const auto* subcase = find_subcase(deck, id);
    const std::string name = "subcase " + std::to_string(id);
    if (!subcase)
      return fail("the preload is that of " + name + ", which the deck does not have", "correct the subcase id");
    if (std::find(chain.begin(), chain.end(), subcase) != chain.end())
      return fail(name + " is its own preload", "let STATSUB name a static subcase that has no STATSUB");
    const bool enforces =
        subcase->spc != 0 && std::any_of(deck.spc.begin(), deck.spc.end(), [](const auto& s) { return s.d != 0; });
    if (subcase->load == 0 && subcase->temperature == 0 && !enforces)
      return fail("the preload is that of " + name + ", which has no load",
                  "name a subcase with LOAD or TEMPERATURE(LOAD)");
    chain.push_back(subcase);
    if (subcase->preload != 0) at = deck.locate(subcase->preload_at);
    id = subcase->preload;
  }
  std::reverse(chain.begin(), chain.end());
  return chain;
}

std::string describe(const records::Subcase& subcase) {
  std::string sets;
  if (subcase.load != 0) sets += records::name_load(subcase);
  if (subcase.temperature != 0)
    sets += (sets.empty() ? "" : ", ") + std::string("TEMPERATURE ") + std::to_string(subcase.temperature);
  return "subcase " + std::to_string(subcase.id) + (sets.empty() ? "" : " (" + sets + ")");
}

/// Copies warnings, each once: the model that is built next reports them again. Notes are left to that model.
void keep_warnings(const Diagnostics& from, Diagnostics& to) {
  for (const auto& item : from.items()) {
    const auto is_same = [&](const Diagnostic& other) { return format(other) == format(item); };
    if (item.severity != Severity::Note && std::none_of(to.items().begin(), to.items().end(), is_same)) to.add(item);
  }
}

/// Internal forces of an element of the deformed model that are in balance with its forces on the grids. Those of its
/// deformations seen from its frame are not: they work on rotation vectors there, the grids turn about fixed axes, and
/// the difference, first order in the size of the element, adds up.
VectorXd find_internal_forces(const Element& element, const Model& deformed, const DeformedElements& state,
                              std::size_t e, const InitialForces& initial) {
  const StressState* stress = element.stress_state();
  if (!stress || state.forces[e].size() == 0) return {};
  VectorXd force = VectorXd::Zero(stress->num_internal_forces()), u = state.displacements[e];
  const ThermalState* heat = initial.find(element);
  if (follows_nodes(element, deformed.nodes())) {
    MatrixXd K = MatrixXd::Zero(element.num_dofs(), element.num_dofs());
    element.add_stiffness(1, K);
    u = solve_in_range(K, heat ? VectorXd(state.forces[e] + heat->load) : state.forces[e]);
  }
  stress->calc_internal_forces(u, force);
  if (heat) force += heat->force;
  return force;
}

}  // namespace

std::shared_ptr<const Prestress> calc_prestress(const records::Deck& deck, const ModelOptions& options,
                                                const ElementFactory& elements, const Preload& preload,
                                                Diagnostics& diagnostics) {
  Diagnostics own;
  auto held = options;
  held.uses_enforced = true;
  const auto model = build_model(deck, held, elements, own);
  records::Subcase subcase;
  subcase.load = preload.load;
  subcase.temperature = preload.temperature;
  auto load = calc_static_load(model, deck, subcase, own);
  report_dead_loads(deck, subcase.load, own);
  report_unstiffened(model, deck, own);
  own.throw_if_errors();
  if (!preload.spin.isZero(0)) {
    const Vector12d A_I = calc_load_factors(Vector3d::Zero(), Vector3d::Zero(), preload.spin);
    load.F += calc_inertial_loads(model, model.mass_kind(), A_I);
    load.A_I += A_I;
  }
  // A body without its SPC is reduced free: its SUPORT is another matter.
  const auto relief = options.ignore_spc ? InertiaRelief::None : read_inertia_relief(deck, own);
  auto held_fdofs = options.ignore_spc ? choose_determinate_support(model, 0) : choose_suport(model, deck, relief, own);
  own.throw_if_errors();
  const StaticSolver solver =
      model.num_fdofs() == 0 ? StaticSolver(model) : StaticSolver(model, get_stiffness(model), held_fdofs);
  Suport suport;
  if (!options.ignore_spc)
    suport = calc_suport(model, solver, std::move(held_fdofs), relief, locate_relief(model, deck), own);
  add_relief(model, suport, load);
  const VectorXd u = solve_static_case(model, solver, load, suport, &own).displacement;

  auto result = options.prestress ? std::make_shared<Prestress>(*options.prestress) : std::make_shared<Prestress>();
  result->name += (result->name.empty() ? "" : " and ") + preload.name;
  result->at = preload.at;
  result->A_I += load.A_I;
  result->force.resize(model.elements().size());
  for (std::size_t e = 0; e < result->force.size(); ++e) {
    const Element& element = *model.elements()[e];
    const StressState* state = element.stress_state();
    if (!state) continue;
    VectorXd force = VectorXd::Zero(state->num_internal_forces());
    state->calc_internal_forces(u(element.gdofs()), force);
    if (const auto* heated = load.initial.find(element)) force += heated->force;
    result->force[e] = result->force[e].size() == 0 ? force : VectorXd(result->force[e] + force);
  }
  for (auto& form : calc_second_order(model, make_loads(load), u)) result->forms.push_back(std::move(form));
  keep_warnings(own, diagnostics);
  return result;
}

std::shared_ptr<const Prestress> calc_subcase_prestress(const records::Deck& deck, ModelOptions options,
                                                        const ElementFactory& elements, int id,
                                                        const SourceLocation& at, Diagnostics& diagnostics) {
  options.prestress = nullptr;
  const auto chain = list_chain(deck, id, at, diagnostics);
  diagnostics.throw_if_errors();
  for (const auto* subcase : chain) {
    options.subcase = subcase->id;
    const Preload preload{subcase->load, subcase->temperature, Vector3d::Zero(), describe(*subcase), at};
    options.prestress = calc_prestress(deck, options, elements, preload, diagnostics);
  }
  if (options.prestress)
    diagnostics.note("fe.preload", at, "the stiffness contains the geometric stiffness of " + options.prestress->name,
                     "displacements and forces count from the loaded state");
  return options.prestress;
}

std::shared_ptr<const Prestress> calc_subcase_prestress(const records::Deck& deck, const ModelOptions& options,
                                                        const records::Subcase& subcase, Diagnostics& diagnostics) {
  if (subcase.preload == 0) return nullptr;
  return calc_subcase_prestress(deck, options, make_elements, subcase.preload, deck.locate(subcase.preload_at),
                                diagnostics);
}

DeformedPreload calc_nonlinear_preload(const records::Deck& deck, ModelOptions options, const Preload& preload,
                                       Diagnostics& diagnostics) {
  BOUGH_DEMAND(preload.spin.isZero(0));
  Diagnostics own;
  options.uses_enforced = true;
  options.origin.reset();
  options.prestress = nullptr;
  const Model model = build_model(deck, options, own);
  records::Subcase subcase;
  subcase.load = preload.load;
  subcase.temperature = preload.temperature;
  const StaticLoad load = calc_static_load(model, deck, subcase, own);
  report_dead_loads(deck, subcase.load, own);
  own.throw_if_errors();
  NonlinearStatics path(model, deck);
  NonlinearOptions path_options;
  path_options.at = preload.at;
  path_options.advice =
      "the structure buckles or snaps through there: lower the load of the preload, or leave nonlinear = true out if "
      "its displacements are small";
  try {
    path.go_to_load_set(load, preload.load, path_options, own);
  } catch (const ComputationError&) {
    // A mechanism that no load stiffens is named by grid and component.
    if (path.num_steps() == 0 && model.num_fdofs() > 0) StaticSolver(model, get_stiffness(model), {});
    throw;
  }
  const auto found = path.make_result();
  DeformedPreload result{make_deformed_deck(deck, model, path.state(), own), nullptr};
  for (const Node& node : model.nodes())
    if (node.num_dofs == 6)
      result.max_displacement = std::max(result.max_displacement, path.state().u.segment<3>(node.first_gdof).norm());
  own.throw_if_errors();

  // Loads at the deformed places; the forces in links are those that the solution left on dependent grids.
  Diagnostics again;
  const Model deformed = build_model(result.deck, options, again);
  BOUGH_DEMAND(deformed.elements().size() == model.elements().size() && deformed.num_gdofs() == model.num_gdofs());
  const StaticLoad moved = calc_static_load(deformed, result.deck, subcase, again);
  again.throw_if_errors();
  auto prestress = std::make_shared<Prestress>();
  prestress->name = preload.name + " under large displacements";
  prestress->at = preload.at;
  prestress->A_I = load.A_I;
  prestress->force.resize(model.elements().size());
  for (std::size_t e = 0; e < prestress->force.size(); ++e)
    prestress->force[e] = find_internal_forces(*deformed.elements()[e], deformed, path.deformed(), e, moved.initial);
  prestress->forms = calc_second_order_of_forces(deformed, make_loads(moved), -found.mpc_force);
  result.prestress = std::move(prestress);
  keep_warnings(own, diagnostics);
  keep_warnings(again, diagnostics);
  return result;
}

DeformedPreload calc_nonlinear_preload(const records::Deck& deck, ModelOptions options, int id,
                                       const SourceLocation& at, Diagnostics& diagnostics) {
  const auto chain = list_chain(deck, id, at, diagnostics);
  diagnostics.throw_if_errors();
  const auto& subcase = *chain.back();
  if (chain.size() > 1)
    throw InputError("fe.nonlinear-preload", at,
                     "subcase " + std::to_string(id) + " has another preload, which is linear",
                     "put both loads into one subcase");
  options.subcase = id;
  return calc_nonlinear_preload(
      deck, options, Preload{subcase.load, subcase.temperature, Vector3d::Zero(), describe(subcase), at}, diagnostics);
}

void check_preloads(const records::Deck& deck, Diagnostics& diagnostics) {
  for (const auto& subcase : deck.subcases)
    if (subcase.preload != 0) list_chain(deck, subcase.preload, deck.locate(subcase.preload_at), diagnostics);
}

}  // namespace bough::fe
