#include "analysis/matrices/matrices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/subcase_failures.hpp"
#include "fe/loads/dead_loads.hpp"
#include "fe/loads/second_order.hpp"
#include "fe/loads/wide_links.hpp"
#include "fe/matrices/system.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/static_case.hpp"

namespace bough::analysis {

namespace {

/// A load set and the subcase whose constraints hold the structure under it.
struct LoadCase {
  int load = 0, temperature = 0, subcase = 0;

  std::string get_name() const { return load > 0 ? fmt::format("LOAD_{}", load) : fmt::format("TEMP_{}", temperature); }
};

/// --load, or every LOAD of the case control (of one subcase with --subcase), each set once.
std::vector<LoadCase> choose_load_cases(const records::Deck& deck, const MatricesRequest& request) {
  std::vector<LoadCase> cases;
  if (request.no_kg) return cases;
  const auto add = [&](const LoadCase& one) {
    const auto same = [&](const LoadCase& c) { return c.get_name() == one.get_name(); };
    if ((one.load > 0 || one.temperature > 0) && std::none_of(cases.begin(), cases.end(), same)) cases.push_back(one);
  };
  for (int load : request.loads) {
    LoadCase one{load, 0, request.model.subcase};
    for (const auto& s : deck.subcases)
      if (one.subcase == 0 && s.load == load) one = {load, s.temperature, s.id};
    add(one);
  }
  if (!request.loads.empty()) return cases;
  for (const auto& s : deck.subcases)
    if (request.model.subcase == 0 || s.id == request.model.subcase) add({s.load, s.temperature, s.id});
  return cases;
}

/// K_G of one load case after the other; model and factor stay while the subcase does.
class GeometricStiffness {
 public:
  /// `model`: of the subcase that --subcase names, else the first.
  GeometricStiffness(const records::Deck& deck, const MatricesRequest& request, const fe::Model& model)
      : deck_(deck), request_(request), model_(&model) {}

  linear::SymmetricMatrix calc(const LoadCase& load_case, Diagnostics& diagnostics) {
    if (load_case.subcase != 0 && load_case.subcase != model_->subcase().id) change_to(load_case.subcase, diagnostics);
    records::Subcase subcase;
    subcase.load = load_case.load;
    subcase.temperature = load_case.temperature;
    auto load = fe::calc_static_load(*model_, deck_, subcase, diagnostics);
    fe::report_wide_links(deck_, diagnostics);
    fe::report_dead_loads(deck_, load_case.load, diagnostics);
    diagnostics.throw_if_errors();
    if (!solver_) {
      const auto relief = fe::read_inertia_relief(deck_, diagnostics);
      auto held = fe::choose_suport(*model_, deck_, relief, diagnostics);
      diagnostics.throw_if_errors();
      solver_.emplace(*model_, fe::get_stiffness(*model_), held);
      suport_ =
          fe::calc_suport(*model_, *solver_, std::move(held), relief, fe::locate_relief(*model_, deck_), diagnostics);
    }
    fe::add_relief(*model_, suport_, load);
    return fe::assemble_geometric_stiffness(*model_, fe::DofSet::Global, load,
                                            fe::solve_static_case(*model_, *solver_, load, suport_).displacement,
                                            &load.initial);
  }

 private:
  void change_to(int subcase, Diagnostics& diagnostics) {
    auto model_options = make_model_options(request_.model);
    model_options.subcase = subcase;
    model_options.uses_enforced = true;
    with_prior_messages(diagnostics,
                        [&] { model_options.prestress = calc_prestress(deck_, model_options, diagnostics); });
    solver_.reset();
    Diagnostics own;  // diagnostics of this model; those that the other model has too are dropped
    model_ = &own_.emplace(fe::build_model(deck_, model_options, own));
    add_new(own, diagnostics);
  }

  const records::Deck& deck_;
  const MatricesRequest& request_;
  const fe::Model* model_;
  std::optional<fe::Model> own_;
  std::optional<fe::StaticSolver> solver_;
  fe::Suport suport_;
};

}  // namespace

records::MatricesResult assemble_matrices(const MatricesRequest& request, Events& events) {
  linear::initialize_petsc();
  do_once([&] { demand_deck(request.deck); });
  Diagnostics diagnostics;
  const auto deck = read_deck_or_throw(request.deck, make_model_options(request.model), diagnostics);
  auto model_options = make_model_options(request.model);
  model_options.uses_enforced = true;
  model_options.prestress = calc_prestress(deck, model_options, diagnostics);
  const auto model = fe::build_model(deck, model_options, diagnostics);
  diagnostics.throw_if_errors();
  records::MatricesResult result;
  result.source = calc_sources(deck.files);
  result.dof_map = model.calc_dof_map();
  result.mesh = model.calc_mesh();
  result.K = fe::gather_sparse(fe::assemble_stiffness(model, fe::DofSet::Global));
  result.M = fe::gather_sparse(fe::assemble_mass(model, fe::DofSet::Global, model.mass_kind()));
  if (fe::has_damping(model)) result.B = fe::gather_sparse(fe::assemble_damping(model, fe::DofSet::Global));
  GeometricStiffness geometric(deck, request, model);
  for (const auto& load_case : choose_load_cases(deck, request))
    result.K_G.emplace_back(load_case.get_name(), fe::gather_sparse(geometric.calc(load_case, diagnostics)));
  add_messages(diagnostics, events);
  return result;
}

}  // namespace bough::analysis
