#include "fe/statics/inertia_relief.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

#include "base/number_text.hpp"
#include "fe/linear/null_space.hpp"
#include "fe/loads/inertial_loads.hpp"
#include "fe/model/sets.hpp"

namespace bough::fe {

SourceLocation locate_relief(const Model& model, const records::Deck& deck) {
  if (!deck.suport.empty()) return deck.locate(deck.suport[0].at);
  if (const auto set = deck.suport1.find(model.subcase().suport1); set != deck.suport1.end() && !set->second.empty())
    return deck.locate(set->second[0].at);
  const auto* param = deck.find_param("INREL");
  return param ? deck.locate(param->at) : SourceLocation{};
}

InertiaRelief read_inertia_relief(const records::Deck& deck, Diagnostics& diagnostics) {
  // SOL 2 of the first Nastrans is static with inertia relief.
  const bool is_old = deck.sol == "2" && (!deck.suport.empty() || !deck.suport1.empty());
  const double value = get_real_param(deck, "INREL", is_old ? -1 : 0, diagnostics);
  return value == -1 ? InertiaRelief::Supported : value == -2 ? InertiaRelief::Free : InertiaRelief::None;
}

std::vector<int> choose_suport(const Model& model, const records::Deck& deck, InertiaRelief relief,
                               Diagnostics& diagnostics) {
  if (relief == InertiaRelief::Free) {
    if (!deck.suport.empty() || model.subcase().suport1 != 0)
      diagnostics.warning("fe.suport-unused",
                          deck.locate(deck.suport.empty() ? records::CardLocation{} : deck.suport[0].at),
                          "PARAM,INREL,-2 needs no SUPORT and does not use it", "PARAM,INREL,-1 uses it");
    return choose_determinate_support(model, 0);
  }
  auto fdofs = find_suport(model, deck, diagnostics);
  if (relief == InertiaRelief::Supported && fdofs.empty()) {
    const auto* param = deck.find_param("INREL");  // SOL 2 goes without
    const bool has_cards = !deck.suport.empty() || model.subcase().suport1 != 0;
    diagnostics.error(
        "fe.missing-suport", deck.locate(param ? param->at : records::CardLocation{}),
        std::string(param ? "PARAM,INREL,-1" : "inertia relief of SOL 2") + " needs the reference dofs of SUPORT, " +
            (has_cards ? "and all that the deck names are without stiffness" : "the deck has none"),
        has_cards ? "name dofs with stiffness, or write PARAM,INREL,-2" : "add SUPORT, or write PARAM,INREL,-2");
  }
  return fdofs;
}

Suport calc_suport(const Model& model, const StaticSolver& solver, std::vector<int> fdofs, InertiaRelief relief,
                   const SourceLocation& where, Diagnostics& diagnostics) {
  Suport suport;
  suport.relief = relief;
  suport.fdofs = std::move(fdofs);
  const int num = static_cast<int>(suport.fdofs.size());
  if (num == 0) return suport;
  // u_r = 1, then K_ll u_l = -K_lr.
  MatrixXd q = MatrixXd::Zero(model.num_fdofs(), num);
  for (int j = 0; j < num; ++j) q(suport.fdofs[static_cast<std::size_t>(j)], j) = 1;
  const MatrixXd unit = model.T() * q;
  const MatrixXd K_unit = calc_stiffness_times(model, unit);
  suport.motions = unit + solver.solve(-K_unit);
  const MatrixXd K_motions = calc_stiffness_times(model, suport.motions);
  const MatrixXd X = MatrixXd(model.T().transpose() * K_motions)(suport.fdofs, Eigen::all);
  const MatrixXd K_rr = MatrixXd(model.T().transpose() * K_unit)(suport.fdofs, Eigen::all);
  suport.epsilon = K_rr.norm() > 0 ? X.norm() / K_rr.norm() : 0;
  suport.strain_energy = 0.5 * (suport.motions.transpose() * K_motions).diagonal();

  // xᵀDx of the motions, by the elements.
  VectorXd D = VectorXd::Zero(model.num_gdofs());
  MatrixXd K_e;
  for (const auto& element : model.elements()) {
    const int n = element->num_dofs();
    K_e.setZero(n, n);
    element->add_stiffness(1, K_e);
    for (int i = 0; i < n; ++i) D[element->gdofs()[static_cast<std::size_t>(i)]] += K_e(i, i);
  }
  for (int j = 0; j < num; ++j) {
    const double diagonal = 0.5 * suport.motions.col(j).cwiseAbs2().dot(D);
    if (suport.strain_energy[j] <= linear::kMechanismEnergy * diagonal) continue;
    const auto [grid, component] = model.describe_fdof(suport.fdofs[static_cast<std::size_t>(j)]);
    const std::string what = "the motion of SUPORT " + name_suport(grid, component) + " strains the model: energy " +
                             show_number(suport.strain_energy[j], 3) + " for a unit, epsilon " +
                             show_number(suport.epsilon, 3);
    const std::string advice =
        "SUPORT must hold a free body in a statically determinate way; look for SPC, grounded "
        "springs or too many dofs";
    if (relief == InertiaRelief::Free)
      throw InputError("fe.suport-strained", where,
                       "PARAM,INREL,-2 is for a free body, this one is held: a rigid-body motion, at " +
                           name_suport(grid, component) + ", strains it with energy " +
                           show_number(suport.strain_energy[j], 3) + " for a unit",
                       model.subcase().spc != 0 ? "take out SPC = " + std::to_string(model.subcase().spc) +
                                                      " and grounded springs, or leave out INREL"
                                                : "look for grounded springs, or leave out INREL");
    if (relief != InertiaRelief::None) throw InputError("fe.suport-strained", where, what, advice);
    diagnostics.warning("fe.suport-strained", {}, what, advice);
    break;
  }
  if (relief == InertiaRelief::None) return suport;
  suport.M_motions = calc_mass_times(model, model.mass_kind(), suport.motions);
  const MatrixXd mass = suport.motions.transpose() * suport.M_motions;
  // Judged with a unit diagonal: translations and rotations side by side.
  const VectorXd size = mass.diagonal().unaryExpr([](double m) { return m > 0 ? 1 / std::sqrt(m) : 1.0; });
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver_of_mass(size.asDiagonal() * mass * size.asDiagonal());
  const VectorXd& values = solver_of_mass.eigenvalues();
  const MatrixXd vectors = size.asDiagonal() * solver_of_mass.eigenvectors();
  const auto num_massless = (values.array() <= 1e-12 * std::max(values.maxCoeff(), 0.0)).count();
  suport.massless = vectors.leftCols(num_massless);
  const auto kept = vectors.rightCols(num - num_massless);
  suport.mass_inverse = kept * values.tail(num - num_massless).cwiseInverse().asDiagonal() * kept.transpose();
  if (num_massless == 0) return suport;
  Eigen::Index j = 0;
  solver_of_mass.eigenvectors().col(0).cwiseAbs().maxCoeff(&j);
  const auto [grid, component] = model.describe_fdof(suport.fdofs[static_cast<std::size_t>(j)]);
  diagnostics.note("fe.inertia-massless", where,
                   "a rigid-body motion of the model has no mass, that of " + name_suport(grid, component),
                   "it stays at rest, as long as the load does not drive it");
  suport.refusal = InputError("fe.inertia-massless", where,
                              "the load drives a rigid-body motion of the model that has no mass, that of " +
                                  name_suport(grid, component) + ": nothing balances it",
                              "give the model mass and inertia in all directions, e.g. by density or CONM2")
                       .items();
  return suport;
}

VectorXd calc_acceleration(const Suport& suport, const VectorXd& F_g) {
  const VectorXd f = suport.motions.transpose() * F_g;
  for (Eigen::Index k = 0; k < suport.massless.cols(); ++k) {
    const VectorXd& x = suport.massless.col(k);
    const double work = x.dot(f), size = (suport.motions * x).cwiseAbs().dot(F_g.cwiseAbs());
    if (std::abs(work) > 1e-9 * size) throw InputError(suport.refusal);
  }
  return suport.mass_inverse * f;
}

void add_relief(const Model& model, const Suport& suport, AppliedLoad& load) {
  if (suport.relief == InertiaRelief::None || suport.fdofs.empty()) return;
  const VectorXd field = suport.motions * calc_acceleration(suport, load.F);
  const MatrixXd rigid = model.calc_rigid_modes(Vector3d::Zero());
  const VectorXd a = rigid.colPivHouseholderQr().solve(field);
  if ((rigid * a - field).norm() > 1e-6 * field.norm()) return;
  const Vector12d A_I = calc_load_factors(a.head<3>(), a.tail<3>(), Vector3d::Zero());
  load.F += calc_inertial_loads(model, model.mass_kind(), A_I);
  load.A_I += A_I;
}

void remove_rigid_part(const Suport& suport, VectorXd& u_g) {
  const VectorXd rigid = suport.mass_inverse * (suport.M_motions.transpose() * u_g);
  u_g -= suport.motions * rigid;
}

}  // namespace bough::fe
