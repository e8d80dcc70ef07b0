#include <algorithm>
#include <cmath>
#include <numbers>

#include "fe/linear/products.hpp"
#include "formats/records/params.hpp"
#include "modal/bases/damping.hpp"
#include "stiffening/stages.hpp"

namespace bough::stiffening {

using modal::bases::DampingTable;

namespace {

modal::bases::DampingSpec make_damping_spec(const records::BodySpec& spec) {
  modal::bases::DampingSpec damping;
  damping.ratio = spec.damping_ratio;
  damping.ratios = spec.damping_ratios;
  damping.table = spec.damping_table.points;
  if (spec.damping_table.kind == "structural") damping.table_kind = DampingTable::Structural;
  if (spec.damping_table.kind == "quality") damping.table_kind = DampingTable::Quality;
  damping.alpha = spec.rayleigh_alpha;
  damping.beta = spec.rayleigh_beta;
  damping.structural = spec.structural_damping;
  damping.residual_ratio = spec.residual_damping;
  return damping;
}

}  // namespace

MatrixXd calc_body_damping(const BodyRequest& request, const fe::Model& model, const modal::bases::Basis& basis) {
  const auto spec = make_damping_spec(request.spec);
  const auto n = static_cast<std::size_t>(basis.lambda.size());
  const auto fail = [&](const std::string& message, const std::string& advice) {
    request.error_at("damping", "reduce.bad-damping", message, advice);
    request.diagnostics.throw_if_errors();
  };
  if (!spec.ratios.empty() && spec.ratios.size() != n)
    fail(std::to_string(spec.ratios.size()) + " damping ratios for " + std::to_string(n) + " modes",
         "give one per kept mode, or one for all");
  for (std::size_t j = 0; j < n && !spec.table.empty(); ++j) {
    const double hz = std::sqrt(std::max(basis.lambda(static_cast<Eigen::Index>(j)), 0.0)) / (2 * std::numbers::pi);
    if (const double zeta = modal::bases::calc_table_ratio(spec, hz); !(zeta >= 0) || std::isinf(zeta))
      fail("the damping table gives the ratio " + std::to_string(zeta) + " at " + std::to_string(hz) +
               " Hz, where its end lines lead",
           "add a point to the table beyond the modes");
  }
  if (request.spec.has_material_damping && request.given)
    fail("material = true, but the stiffness comes from given matrices", "use ratios, a table or structural");
  std::vector<bool> is_residual;
  for (const auto kind : basis.kind)
    is_residual.push_back(kind == records::ModeKind::Residual || kind == records::ModeKind::Attachment);
  // Φᵀ Σ (g + GE) K_e Φ: g is PARAM,G, GE of the material or property of each element (MAT1, MAT2, MAT8, MAT9, PCOMP,
  // PELAS, CELAS2, PBUSH); MID1 of a PSHELL counts for the whole section (Quick Reference Guide, PSHELL).
  MatrixXd K_g;
  if (request.spec.has_material_damping) {
    const double g = records::get_real_param(request.deck, "G", 0, request.diagnostics);
    K_g = linear::symmetrize(basis.Phi.transpose() * fe::calc_structural_damping_times(model, g, basis.Phi));
  }
  return modal::bases::calc_damping(basis.M, basis.K, spec, K_g, is_residual);
}

void add_dampers(const fe::Model& model, const MatrixXd& Phi, MatrixXd& damping) {
  if (fe::has_damping(model)) damping += linear::symmetrize(Phi.transpose() * fe::calc_damping_times(model, Phi));
}

}  // namespace bough::stiffening
