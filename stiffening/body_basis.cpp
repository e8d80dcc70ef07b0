// The shapes of a body: modes that are solved for, or given.
#include <algorithm>
#include <cstdio>
#include <numbers>

#include "fe/linear/products.hpp"
#include "stiffening/given_model.hpp"
#include "stiffening/stages.hpp"

namespace bough::stiffening {

using modal::bases::BasisKind;
using modal::bases::FrameKind;
using records::BodyBasis;
using records::BodyFrame;
using records::BodySpec;

namespace {

modal::bases::BasisOptions make_basis_options(const BodyRequest& request, const StaticSupport& support,
                                              const MatrixXd& residual_loads) {
  const BodySpec& spec = request.spec;
  modal::bases::BasisOptions options;
  if (spec.basis == BodyBasis::CraigBampton) options.kind = BasisKind::CraigBampton;
  if (spec.basis == BodyBasis::CraigChang) options.kind = BasisKind::CraigChang;
  options.num_modes = spec.num_modes;
  if (spec.basis == BodyBasis::Normal && spec.residual.empty())
    for (const int s : spec.select) options.num_modes = std::max(options.num_modes, s);
  options.max_hz = spec.max_frequency_hz;
  options.interface_nodes = spec.interface_nodes;
  options.is_free = request.is_free();
  options.orthogonalize = spec.orthogonalize;
  options.residual_loads = residual_loads;
  options.factor = support.factor;
  options.solver = request.options.solver;
  return options;
}

/// The columns that select names, or all of them.
std::vector<int> choose_columns(const BodyRequest& request, Eigen::Index available, const std::string& source) {
  std::vector<int> columns;
  for (const int s : request.spec.select) {
    if (s <= available)
      columns.push_back(s - 1);
    else
      request.error_at("modes/select", "reduce.bad-select",
                       "mode " + std::to_string(s) + " in select, " + source + " gives " + std::to_string(available) +
                           " elastic modes in the range");
  }
  request.diagnostics.throw_if_errors();
  for (int j = 0; j < available && request.spec.select.empty(); ++j) columns.push_back(j);
  return columns;
}

void check_rigid(const BodyRequest& request, const fe::Model& model, const modal::bases::Basis& basis) {
  const int num_rigid = request.is_free() ? 6 : 0, num_found = basis.num_rigid + basis.num_massless;
  const std::string preload = model.prestress() ? model.prestress()->name : "";
  if (num_found < num_rigid)
    request.error_at("frame", "reduce.grounded",
                     "a free body must have 6 rigid-body motions, this model has " + std::to_string(num_found) +
                         (preload.empty() ? "" : " under its preload, " + preload),
                     preload.empty()
                         ? "remove springs and bushes to ground, and CELASi between grids that lie apart (they hold "
                           "rotations); write matrices of K2GG with more digits; or use frame = \"fixed\""
                         : "a free body may be preloaded by temperatures; loads do not turn with it: use frame = "
                           "\"fixed\"");
  if (num_found > num_rigid)
    add_mechanism_error(request, model, std::to_string(num_found - num_rigid) + " motion(s) have no strain");
  request.diagnostics.throw_if_errors();
}

void report_residuals(const BodyRequest& request, const modal::bases::Basis& basis,
                      const std::vector<std::string>& names) {
  const auto join = [](std::string& list, const std::string& word) { list += (list.empty() ? "" : ", ") + word; };
  std::string unused, massless;
  for (const int i : basis.unused_loads) join(unused, names[static_cast<std::size_t>(i)]);
  if (!unused.empty())
    request.note("reduce.residual-unused",
                 "no residual vector for " + unused + ": the modes and the loads before hold its deflection",
                 "nothing to do");
  for (const auto& [i, part] : basis.massless_loads) {
    char percent[32];
    std::snprintf(percent, sizeof percent, " (%.3g %%)", 100 * part);
    join(massless, names[static_cast<std::size_t>(i)] + percent);
  }
  if (!massless.empty())
    request.warning("reduce.residual-massless",
                    "what moves no mass has no residual vector; lost of the flexibility under " + massless,
                    "what acts there meets a stiffer body; give the model inertia there, or take fewer modes, if it "
                    "should not");
}

ModalBasis make_modal_basis(const fe::Model& model, modal::bases::Basis basis, MatrixXd damping) {
  add_dampers(model, basis.Phi, damping);
  return {std::move(basis.Phi), std::move(basis.lambda), std::move(basis.M),     std::move(basis.K),
          std::move(damping),   std::move(basis.kind),   std::move(basis.check), {}};
}

}  // namespace

modal::bases::FrameSpec make_frame_spec(const BodySpec& spec) {
  modal::bases::FrameSpec frame;
  if (spec.frame == BodyFrame::Node) frame.kind = FrameKind::Node;
  if (spec.frame == BodyFrame::ThreeNodes) frame.kind = FrameKind::ThreeNodes;
  if (spec.frame == BodyFrame::MassCentre) frame.kind = FrameKind::MassCentre;
  frame.nodes = spec.frame_nodes;
  return frame;
}

ModalBasis calc_body_basis(const BodyRequest& request, const BodyModel& body_model, const StaticSupport& support,
                           const modal::response::ResidualLoads& residual) {
  const fe::Model& model = *body_model.model;
  const BodySpec& spec = request.spec;
  const auto options = make_basis_options(request, support, residual.F);
  const BodyModel augmented = augment(request, body_model);
  auto basis = modal::bases::calc_basis(augmented.system ? *augmented.system : *body_model.system, options,
                                        support.solve, request.diagnostics);
  check_rigid(request, model, basis);
  report_residuals(request, basis, residual.name);

  // Raw coordinates lose those of the frame's node before the selection, so that select counts the remaining ones.
  if (basis.is_raw && request.moves_to_frame()) modal::bases::move_to_frame(model, make_frame_spec(spec), basis);
  auto columns = choose_columns(request, basis.lambda.size(), "the model");
  if (spec.select.empty() && options.kind == BasisKind::Normal && residual.F.cols() == 0 && spec.num_modes > 0 &&
      static_cast<int>(columns.size()) > spec.num_modes)
    columns.resize(static_cast<std::size_t>(spec.num_modes));
  if (columns.empty())
    request.warning_at("modes", "reduce.rigid", "no elastic mode is in the range: the body is rigid",
                       "raise max_frequency or the number of modes");
  basis = modal::bases::select_columns(basis, columns);
  if (augmented.model) remove_augmentation(request, model, basis);
  auto damping = calc_body_damping(request, model, basis);
  if (!basis.is_raw && request.moves_to_frame()) modal::bases::move_to_frame(model, make_frame_spec(spec), basis);
  std::vector<std::string> massless;
  for (const auto& [i, part] : basis.massless_loads) massless.push_back(residual.name[static_cast<std::size_t>(i)]);
  auto result = make_modal_basis(model, std::move(basis), std::move(damping));
  result.massless_loads = std::move(massless);
  return result;
}

ModalBasis make_given_basis(const BodyRequest& request, const fe::System& system) {
  const fe::Model& model = system.model;
  const BodySpec& spec = request.spec;
  modal::bases::Basis basis;
  basis.Phi = calc_given_modes(*request.given, system, request.diagnostics);
  const auto available = static_cast<int>(basis.Phi.cols());
  auto columns = choose_columns(request, available, "the file");
  if (spec.select.empty() && spec.num_modes > 0 && spec.num_modes < available)
    columns.resize(static_cast<std::size_t>(spec.num_modes));
  basis.Phi = basis.Phi(Eigen::all, columns).eval();
  if (request.moves_to_frame()) {
    const auto C = modal::bases::calc_reference_conditions(model, make_frame_spec(spec));
    basis.Phi = modal::bases::shift_to_frame(model, C, basis.Phi);
  }
  const auto project = [&](const MatrixXd& A_Phi) { return linear::symmetrize(basis.Phi.transpose() * A_Phi); };
  basis.M = project(fe::calc_mass_times(model, model.mass_kind(), basis.Phi));
  basis.K = project(fe::calc_stiffness_times(model, basis.Phi));
  for (Eigen::Index j = 0; j < basis.M.cols(); ++j)
    if (!(basis.M(j, j) > 0))
      request.error("reduce.no-modal-mass",
                    "mode " + std::to_string(j + 1) + " of those kept has no mass (phi' M phi is not positive)",
                    "check the mass matrix, the mode shapes and their dofs");
  request.diagnostics.throw_if_errors();
  basis.lambda = basis.K.diagonal().cwiseQuotient(basis.M.diagonal());
  basis.kind.assign(static_cast<std::size_t>(basis.M.cols()), records::ModeKind::Normal);
  auto damping = calc_body_damping(request, model, basis);
  return make_modal_basis(model, std::move(basis), std::move(damping));
}

void set_modes(const ModalBasis& basis, records::FlexBody& body) {
  body.eigenvalue = basis.eigenvalue;
  body.frequency_hz = basis.eigenvalue.cwiseMax(0).cwiseSqrt() / (2 * std::numbers::pi);
  body.kind = basis.kind;
  body.modal_mass = basis.mass;
  body.modal_stiffness = basis.stiffness;
  body.modal_damping = basis.damping;
}

}  // namespace bough::stiffening
