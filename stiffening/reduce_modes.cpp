#include "stiffening/reduction.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "formats/records/params.hpp"

namespace bough::stiffening {

using modal::bases::StaticSolve;
using records::BodyFrame;

/// The columns that select names, or all of them.
std::vector<int> Reduction::choose_columns(int available, const std::string& whose) {
  std::vector<int> columns;
  for (const int s : spec_.select) {
    if (s <= available)
      columns.push_back(s - 1);
    else
      diagnostics_.error("reduce.bad-select", where(),
                         "mode " + std::to_string(s) + " in select, " + whose + std::to_string(available) +
                             " elastic modes in the range");
  }
  diagnostics_.throw_if_errors();
  for (int j = 0; j < available && spec_.select.empty(); ++j) columns.push_back(j);
  return columns;
}

void Reduction::check_rigid(const fe::Model& model, const modal::bases::Basis& basis) {
  const int num_rigid = is_free() ? 6 : 0, found_rigid = basis.num_rigid + basis.num_massless;
  if (is_free() && found_rigid < 6)
    diagnostics_.error(
        "reduce.grounded", where(),
        "a free body must have 6 rigid motions, this model has " + std::to_string(found_rigid) +
            (body_.preload.empty() ? "" : " under its preload, " + body_.preload),
        body_.preload.empty()
            ? "remove springs and bushes to ground, and CELASi between grids that lie apart (they hold rotations), "
              "or use frame = \"fixed\""
            : "a free body may be preloaded by temperatures; loads do not turn with it: use frame = "
              "\"fixed\"");
  if (found_rigid > num_rigid)
    add_mechanism_error(model, std::to_string(found_rigid - num_rigid) + " motion(s) have no strain");
  diagnostics_.throw_if_errors();
}

void Reduction::set_modes(const fe::System& system, const StaticSolve& solve) {
  const fe::Model& model = system.model;
  auto options = make_basis_options(spec_);
  options.factor = factor_;
  options.solver = options_.solver;
  std::vector<std::string> names;
  options.residual_loads = collect_residual_loads(model, spec_, loads_, names);
  if (options_.residual_loads) {
    const MatrixXd own = options.residual_loads, more = options_.residual_loads(model, names);
    options.residual_loads.resize(own.rows(), own.cols() + more.cols());
    options.residual_loads << own, more;
  }
  const auto augmented = augment(model);
  auto basis = modal::bases::calc_basis(augmented ? augmented->system : system, options, solve, diagnostics_);
  check_rigid(model, basis);
  modes_check_ = basis.check;
  std::string unused;
  for (const int i : basis.unused_loads) unused += (unused.empty() ? "" : ", ") + names[static_cast<std::size_t>(i)];
  if (!unused.empty())
    diagnostics_.note("reduce.residual-unused", where(),
                      "no residual vector for " + unused + ": the modes and the loads before hold its deflection",
                      "nothing to do");
  std::string massless;
  for (const auto& [i, part] : basis.massless_loads) {
    char percent[32];
    std::snprintf(percent, sizeof percent, " (%.3g %%)", 100 * part);
    massless += (massless.empty() ? "" : ", ") + names[static_cast<std::size_t>(i)] + percent;
  }
  if (!massless.empty())
    diagnostics_.warning(
        "reduce.residual-massless", where(),
        "what moves no mass has no residual vector; lost of the flexibility under " + massless,
        "what acts there meets a stiffer body; give the model inertia there, or take fewer modes, if it "
        "should not");

  const bool is_moved = is_free() && spec_.frame != BodyFrame::Free;
  // Raw coordinates lose those of the frame's node first, so that select counts what is left.
  if (basis.is_raw && is_moved) modal::bases::move_to_frame(model, make_frame_spec(spec_), basis);
  auto columns = choose_columns(static_cast<int>(basis.lambda.size()), "the model gives ");
  if (spec_.select.empty() && options.kind == modal::bases::BasisKind::Normal && options.residual_loads.cols() == 0 &&
      spec_.num_modes > 0 && static_cast<int>(columns.size()) > spec_.num_modes)
    columns.resize(static_cast<std::size_t>(spec_.num_modes));
  if (columns.empty())
    diagnostics_.warning("reduce.rigid", where(), "no elastic mode is in the range: the body is rigid",
                         "raise max_frequency or the number of modes");
  basis = modal::bases::select_columns(basis, columns);
  if (augmented) take_off_augmentation(model, basis);
  set_damping(model, basis);
  if (!basis.is_raw && is_moved) modal::bases::move_to_frame(model, make_frame_spec(spec_), basis);
  Phi_ = basis.Phi;
  body_.eigenvalue = basis.lambda;
  body_.frequency_hz = basis.lambda.cwiseMax(0).cwiseSqrt() / (2 * std::numbers::pi);
  body_.kind = basis.kind;
  body_.modal_mass = basis.M;
  body_.modal_stiffness = basis.K;
  add_dampers(model);
}

/// Any basis: what is not diagonal in ΦᵀMΦ and ΦᵀKΦ stays.
void Reduction::set_given_modes(const fe::System& system) {
  const fe::Model& model = system.model;
  Phi_ = options_.modes(system);
  const auto available = static_cast<int>(Phi_.cols());
  auto columns = choose_columns(available, "the file gives ");
  if (spec_.select.empty() && spec_.num_modes > 0 && spec_.num_modes < available)
    columns.resize(static_cast<std::size_t>(spec_.num_modes));
  Phi_ = Phi_(Eigen::all, columns).eval();
  if (is_free() && spec_.frame != BodyFrame::Free) {
    const auto C = modal::bases::calc_reference_conditions(model, make_frame_spec(spec_));
    Phi_ = modal::bases::shift_to_frame(model, C, Phi_);
  }
  const auto n = Phi_.cols();
  const auto project = [this](const MatrixXd& A_Phi) -> MatrixXd {
    const MatrixXd A = Phi_.transpose() * A_Phi;
    return 0.5 * (A + A.transpose());
  };
  body_.modal_mass = project(fe::calc_mass_times(model, model.mass_kind(), Phi_));
  body_.modal_stiffness = project(fe::calc_stiffness_times(model, Phi_));
  for (Eigen::Index j = 0; j < n; ++j)
    if (!(body_.modal_mass(j, j) > 0))
      diagnostics_.error("reduce.no-modal-mass", where(),
                         "mode " + std::to_string(j + 1) + " of those kept has no mass (phi' M phi is not positive)",
                         "check the mass matrix, the mode shapes and their dofs");
  diagnostics_.throw_if_errors();
  body_.eigenvalue = body_.modal_stiffness.diagonal().cwiseQuotient(body_.modal_mass.diagonal());
  body_.frequency_hz = body_.eigenvalue.cwiseMax(0).cwiseSqrt() / (2 * std::numbers::pi);
  body_.kind.assign(static_cast<std::size_t>(n), records::ModeKind::Normal);
  modal::bases::Basis basis;
  basis.Phi = Phi_;
  basis.lambda = body_.eigenvalue;
  basis.M = body_.modal_mass;
  basis.K = body_.modal_stiffness;
  basis.kind = body_.kind;
  set_damping(model, basis);
  add_dampers(model);
}

/// By ratio, table, Rayleigh's factors and the materials, in the frame where the basis is orthogonal to rigid motions:
/// those do not dissipate.
void Reduction::set_damping(const fe::Model& model, const modal::bases::Basis& basis) {
  const auto spec = make_damping_spec(spec_);
  const auto n = static_cast<std::size_t>(basis.lambda.size());
  const auto bad = [&](const std::string& what, const std::string& advice) {
    diagnostics_.error("reduce.bad-damping", where(), what, advice);
    diagnostics_.throw_if_errors();
  };
  if (!spec.ratios.empty() && spec.ratios.size() != n)
    bad(std::to_string(spec.ratios.size()) + " damping ratios for " + std::to_string(n) + " modes",
        "give one per kept mode, or one for all");
  std::vector<bool> is_residual;
  for (const auto kind : basis.kind)
    is_residual.push_back(kind == records::ModeKind::Residual || kind == records::ModeKind::Attachment);
  for (std::size_t j = 0; j < n && !spec.table.empty(); ++j) {
    const double hz = std::sqrt(std::max(basis.lambda(static_cast<Eigen::Index>(j)), 0.0)) / (2 * std::numbers::pi);
    if (const double zeta = modal::bases::calc_table_ratio(spec, hz); !(zeta >= 0) || std::isinf(zeta))
      bad("the damping table gives the ratio " + std::to_string(zeta) + " at " + std::to_string(hz) +
              " Hz, where its end lines lead",
          "add a point to the table beyond the modes");
  }
  MatrixXd K_g;
  if (spec_.has_material_damping && options_.elements)
    bad("material = true, but the stiffness comes from given matrices", "use ratios, a table or structural");
  if (spec_.has_material_damping)
    K_g = calc_material_damping(model, records::get_real_param(deck_, "G", 0, diagnostics_), basis.Phi);
  body_.modal_damping = modal::bases::calc_damping(basis.M, basis.K, spec, K_g, is_residual);
}

/// ΦᵀBΦ of the dampers of the deck, which couples modes.
void Reduction::add_dampers(const fe::Model& model) {
  if (!fe::has_damping(model)) return;
  const MatrixXd B = Phi_.transpose() * fe::calc_damping_times(model, Phi_);
  body_.modal_damping += 0.5 * (B + B.transpose());
}

}  // namespace bough::stiffening
