#include "fe/statics/superelement_check.hpp"
#include "stiffening/given_model.hpp"
#include "stiffening/stages.hpp"

namespace bough::stiffening {

namespace {

/// The order of work.
ReducedBody reduce_body(const BodyRequest& request) {
  linear::initialize_petsc();
  check_spec(request);
  request.report("model");
  const BodyModel body_model = build_body_model(request);
  const fe::Model& model = *body_model.model;
  check_third_order(request, model);
  records::FlexBody body = make_rigid_body(request, model);

  // The factor before the modes: its check of a mechanism names the dofs.
  request.report("static factorization");
  const StaticSupport support = make_static_support(request, *body_model.system);
  const auto patterns = make_load_patterns(request, model);
  // M on the g-set is large: only residual vectors of the inertial loads keep it in memory while modes are solved for.
  InertialLoads inertial;
  if (needs_inertial_residuals(request.spec)) inertial = calc_body_inertial_loads(model);
  const auto residual = make_residual_loads(request, model, patterns, inertial.F_I);

  request.report("modes");
  const bool has_given_modes = request.given && has_modes(*request.given);
  const ModalBasis basis = has_given_modes ? make_given_basis(request, *body_model.system)
                                           : calc_body_basis(request, body_model, support, residual);
  BasisCheck check = check_basis(model, basis.Phi, basis.mass, basis.stiffness);
  check.modes = basis.check;
  report_basis(check, request.where(), request.diagnostics);
  if (request.given) report_missing_rows(request, basis.Phi);
  set_modes(basis, body);
  set_nodes(request, model, basis.Phi, body);

  request.report("mass integrals");
  if (!inertial.M) inertial = calc_body_inertial_loads(model);
  set_integrals(request, model, basis.Phi, inertial, body);
  set_loads(request, model, basis.Phi, patterns, body);
  const RecoveredElements recovered = start_recovery(request, model, body);
  set_third_order(request, model, basis, patterns, support, inertial, recovered, body);
  set_next_order(request, model, basis, support, inertial, body);
  inertial.M = {};

  request.report("static solutions");
  const SolvedLoads solved = solve_loads(request, patterns, inertial.F_I, support);
  if (!recovered.empty()) {
    request.report("element recovery");
    set_recovery(request, model, basis.Phi, patterns, solved, recovered, body);
  }
  request.report("geometric stiffness");
  if (request.given)
    set_given_stiffness(request, basis.Phi, body);
  else
    set_geometric_stiffness(model, basis.Phi, patterns, solved, body);
  fe::report_unstiffened(model, request.deck, request.diagnostics);
  set_lost_loads(basis, body);
  set_preload(request, model, basis.Phi, body);
  set_strain_energy(request, model, basis.Phi, body);
  return {std::move(body), check};
}

}  // namespace

ReducedBody reduce(const records::Deck& deck, const records::BodySpec& spec, const ReduceOptions& options,
                   Diagnostics& diagnostics) {
  const BodyRequest request{deck, spec, options, nullptr, diagnostics};
  if (!spec.preload || !spec.preload->is_nonlinear) return reduce_body(request);
  check_spec(request);
  if (linear::initialize_petsc().size > 1) {
    diagnostics.error("reduce.bad-preload", spec.preload->at,
                      "nonlinear = true is given, but nonlinear statics run on one process, found several ranks",
                      "leave mpirun out");
    diagnostics.throw_if_errors();
  }
  request.report("preload under large displacements");
  const fe::DeformedPreload preload = calc_nonlinear_preload(request);
  return reduce_body({preload.deck, spec, options, nullptr, diagnostics, preload.prestress});
}

ReducedBody reduce_matrices(const records::Deck& deck, const records::BodySpec& spec, const GivenMatrices& matrices,
                            const ReduceOptions& options, Diagnostics& diagnostics) {
  const records::Deck points = remove_elements(deck, matrices);
  const GivenModel given = make_given_model(points, spec, matrices, diagnostics);
  const records::BodySpec completed = add_given_loads(spec, matrices);
  return reduce_body({points, completed, options, &given, diagnostics});
}

}  // namespace bough::stiffening
