#include "fe/statics/superelement_check.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/number_text.hpp"
#include "base/rotation.hpp"
#include "fe/elements/superelement.hpp"
#include "fe/matrices/mass_directions.hpp"
#include "fe/model/coordinates.hpp"

namespace bough::fe {
namespace {

using Eigen::Index;

constexpr double kGrounded = 1e-9;  // share of strain energy: condensation leaves 1e-13
/// Strain energy of a rigid-body motion over the kinetic energy at the highest held frequency: below is round-off, all
/// that a statically determinate boundary has.
constexpr double kRoundoff = 1e-12;
constexpr double kCoupled = 1e-8;    // of sqrt(K_bb K_qq)
constexpr double kNegative = -1e-9;  // of a mass with a diagonal of ones

/// Rows of exterior dofs, split: those of grids with their rigid-body motions about `centre`, those of scalar points.
struct Boundary {
  std::vector<Index> grid_rows, point_rows;
  std::vector<int> components;  ///< of grid_rows, 0..5
  MatrixXd Phi_r;               ///< grid_rows x 6, about `centre`
  Vector3d centre = Vector3d::Zero();
  int num_grids = 0;
};

Boundary make_boundary(const records::Deck& deck, const records::Superelement& s, Diagnostics& diagnostics) {
  Boundary boundary;
  const CoordinateSystems systems(*s.section, Vector3d::Zero(), diagnostics);
  struct Grid {
    Vector3d x;
    Matrix3d R;
  };
  std::vector<std::pair<const records::ExteriorPoint*, Grid>> grids;
  for (const auto& point : s.points) {
    const auto own = std::find_if(s.section->grids.begin(), s.section->grids.end(),
                                  [&](const auto& grid) { return grid.id == point.id; });
    Grid grid{Vector3d::Zero(), Matrix3d::Identity()};
    if (point.c != 0 && own != s.section->grids.end()) {
      grid.x = systems.get_grid_position(static_cast<int>(own - s.section->grids.begin()));
      grid.R = systems.calc_axes(own->cd, grid.x, deck.locate(own->at), diagnostics);
      boundary.centre += grid.x;
      ++boundary.num_grids;
    }
    grids.emplace_back(&point, grid);
  }
  if (boundary.num_grids > 0) boundary.centre /= boundary.num_grids;
  std::vector<Eigen::Matrix<double, 1, 6>> rows;
  Index row = 0;
  for (const auto& [point, grid] : grids) {
    if (point->c == 0) {
      boundary.point_rows.push_back(row++);
      continue;
    }
    Eigen::Matrix<double, 6, 6> rigid = Eigen::Matrix<double, 6, 6>::Identity();
    rigid.topRightCorner<3, 3>() = -skew(Vector3d(grid.x - boundary.centre));
    for (int c = 0; c < 6; ++c) {
      if (!(point->c >> c & 1u)) continue;
      rows.emplace_back(grid.R.col(c % 3).transpose() * rigid.middleRows<3>(3 * (c / 3)));
      boundary.components.push_back(c);
      boundary.grid_rows.push_back(row++);
    }
  }
  boundary.Phi_r.resize(static_cast<Index>(rows.size()), 6);
  for (std::size_t i = 0; i < rows.size(); ++i) boundary.Phi_r.row(static_cast<Index>(i)) = rows[i];
  return boundary;
}

/// About the basic origin, from the mass about `centre`.
records::MassProperties make_mass(const MatrixXd& about_centre, const Vector3d& centre) {
  Eigen::Matrix<double, 6, 6> shift = Eigen::Matrix<double, 6, 6>::Identity();
  shift.topRightCorner<3, 3>() = -skew(centre);  // the centre moves by ω × c
  records::MassProperties mass;
  mass.rigid_mass = shift.transpose() * about_centre * shift;
  mass.mass = mass.rigid_mass.topLeftCorner<3, 3>().trace() / 3;
  mass.inertia = mass.rigid_mass.bottomRightCorner<3, 3>();
  const Matrix3d S = mass.rigid_mass.bottomLeftCorner<3, 3>();
  if (mass.mass > 0) mass.cg = Vector3d(S(2, 1) - S(1, 2), S(0, 2) - S(2, 0), S(1, 0) - S(0, 1)) / (2 * mass.mass);
  return mass;
}

double find_negative(const MatrixXd& M) {
  const VectorXd d = M.diagonal().cwiseMax(0).cwiseSqrt();
  if (M.size() == 0 || !(d.maxCoeff() > 0)) return 0;
  const VectorXd scale = d.unaryExpr([&](double x) { return x > 0 ? 1 / x : 1 / d.maxCoeff(); });
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scale.asDiagonal() * M * scale.asDiagonal(),
                                                       Eigen::EigenvaluesOnly);
  return std::min(0.0, solver.eigenvalues().minCoeff());
}

}  // namespace

SuperelementCheck check_superelement(const records::Deck& deck, const records::Superelement& s,
                                     Diagnostics& diagnostics) {
  SuperelementCheck check;
  check.id = s.id;
  check.file = s.file;
  Diagnostics of_model;  // the model reports what is wrong with coordinates
  const auto boundary = make_boundary(deck, s, of_model);
  check.num_grids = boundary.num_grids;
  check.num_points = static_cast<int>(boundary.point_rows.size());
  const auto& b = boundary.grid_rows;
  const auto& q = boundary.point_rows;
  const MatrixXd K_bb = s.K(b, b), K_qq = s.K(q, q), K_bq = s.K(b, q);
  const MatrixXd force = K_bb * boundary.Phi_r;
  for (int r = 0; r < 6; ++r) {
    const double allowed = K_bb.diagonal().dot(boundary.Phi_r.col(r).cwiseAbs2());
    check.rigid_energy[r] = allowed > 0 ? std::abs(boundary.Phi_r.col(r).dot(force.col(r))) / allowed : 0;
  }
  for (Index i = 0; i < force.rows(); ++i) {
    auto& largest = boundary.components[static_cast<std::size_t>(i)] < 3 ? check.rigid_force : check.rigid_moment;
    largest = std::max(largest, force.row(i).cwiseAbs().maxCoeff());
  }
  for (Index i = 0; i < K_bq.rows(); ++i)
    for (Index j = 0; j < K_bq.cols(); ++j)
      if (K_bq(i, j) != 0)
        check.coupling =
            std::max(check.coupling, std::abs(K_bq(i, j)) / std::sqrt(std::abs(K_bb(i, i) * K_qq(j, j)) + 1e-300));
  if (s.M.size() > 0) {
    check.mass = make_mass(boundary.Phi_r.transpose() * s.M(b, b) * boundary.Phi_r, boundary.centre);
    check.mass_defect = find_negative(s.M);
    const MatrixXd M_qq = s.M(q, q);
    if (!q.empty() && Eigen::LLT<MatrixXd>(M_qq).info() == Eigen::Success) {
      const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> held(K_qq, M_qq, Eigen::EigenvaluesOnly);
      check.held_hz = held.eigenvalues().cwiseMax(0).cwiseSqrt() / (2 * std::numbers::pi);
      const MatrixXd M_bb = s.M(b, b);
      for (int r = 0; r < 6; ++r) {
        const auto motion = boundary.Phi_r.col(r);
        const double kinetic = held.eigenvalues().cwiseMax(0).maxCoeff() * M_bb.diagonal().dot(motion.cwiseAbs2());
        if (std::abs(motion.dot(force.col(r))) < kRoundoff * kinetic) check.rigid_energy[r] = 0;
      }
    }
  }

  const std::string who = "superelement " + std::to_string(s.id);
  const auto at = deck.locate(s.at);
  if (check.rigid_energy.maxCoeff() > kGrounded)
    diagnostics.warning(
        "fe.superelement-grounded", at,
        who + " resists rigid-body motion of its boundary: " + show_number(check.rigid_energy.maxCoeff(), 3) +
            " of the strain energy that its stiffness allows, expected below 1e-9",
        "look for supports or springs to ground in the component, and for boundary grids of other "
        "places or displacement axes");
  if (check.coupling > kCoupled)
    diagnostics.note("fe.superelement-coupled", at,
                     who + " couples its boundary and its generalized coordinates in K: " +
                         show_number(check.coupling, 3) + " of the diagonal",
                     "Craig-Bampton components have K_bq = 0; modes with a free boundary do not");
  if (check.mass_defect < kNegative)
    diagnostics.warning("fe.superelement-mass", at,
                        who + " has a mass matrix that is not positive: lowest eigenvalue " +
                            show_number(check.mass_defect, 3) + " of its scaled diagonal",
                        "take the mass of the run that wrote the stiffness");
  else if (s.M.size() > 0 && calc_mass_difference(check.mass.rigid_mass) > kMassDifference)
    diagnostics.warning(
        "fe.superelement-mass", at, who + " has a mass that differs by direction",
        "compare its mass with the component's: rigid-body motions of the boundary do not move all of it");
  return check;
}

void report_unstiffened(const Model& model, const records::Deck& deck, Diagnostics& diagnostics) {
  for (const auto& element : model.elements()) {
    const auto* superelement = dynamic_cast<const Superelement*>(element.get());
    if (!superelement || element->stress_state()) continue;
    const auto record = std::find_if(deck.superelements.begin(), deck.superelements.end(),
                                     [&](const auto& one) { return one.id == element->id(); });
    diagnostics.warning(
        "fe.superelement-stiffening", record == deck.superelements.end() ? deck.locate({}) : deck.locate(record->at),
        "superelement " + std::to_string(element->id()) +
            " has no geometric stiffness: its stress changes neither buckling loads nor frequencies",
        "give its elements in a section (BEGIN SUPER) with at most 150 boundary dofs, or in the main bulk data");
  }
}

}  // namespace bough::fe
