#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "bough/fe/model/rigid.hpp"

namespace bough::fe {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// One connected component: its dof, its row of the rigid map about the reference, its weight.
struct Sample {
  int ldof;
  Eigen::Matrix<double, 1, 6> row;
  double weight;
  bool is_rotation;
};

/// Equations E u = 0 over the l-dofs `ldofs`, solved for `dependent` (as many as E has rows); false when they cannot
/// be.
bool solve_for(const MatrixXd& E, const std::vector<int>& ldofs, const std::vector<int>& dependent,
               const std::string& card, const SourceLocation& at, std::vector<ConstraintEquation>& equations) {
  std::vector<int> columns;
  for (int ldof : dependent) {
    const auto it = std::find(ldofs.begin(), ldofs.end(), ldof);
    if (it == ldofs.end()) return false;
    columns.push_back(static_cast<int>(it - ldofs.begin()));
  }
  const MatrixXd P = E(Eigen::all, columns);
  if (P.rows() != P.cols()) return false;
  Eigen::FullPivLU<MatrixXd> lu(P);
  lu.setThreshold(1e-10);
  if (!lu.isInvertible()) return false;
  const MatrixXd solved = lu.solve(E), size = lu.inverse().cwiseAbs() * E.cwiseAbs();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    ConstraintEquation equation;
    equation.dependent = dependent[i];
    equation.card = card;
    equation.at = at;
    for (int j = 0; j < solved.cols(); ++j) {
      if (std::find(columns.begin(), columns.end(), j) != columns.end()) continue;
      const double c = -solved(static_cast<int>(i), j);
      if (std::abs(c) > 1e-14 * size(static_cast<int>(i), j)) equation.terms.emplace_back(ldofs[j], c);
    }
    equations.push_back(std::move(equation));
  }
  return true;
}

}  // namespace

void add_rbe3(const records::Rbe3& record, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations) {
  const std::string card = "RBE3 " + std::to_string(record.id);
  const Node* reference = find_rigid_grid(record.ref_grid, card, nodes, at, diagnostics);
  bool is_good = reference != nullptr;
  std::vector<Sample> samples;
  double arm_sum = 0;
  int num_grids = 0;
  for (const auto& group : record.groups)
    for (int id : group.grids) {
      const Node* node = find_rigid_grid(id, card, nodes, at, diagnostics);
      is_good = is_good && node;
      if (!is_good) continue;
      const Matrix6d map = calc_rigid_map(*node, reference->x);
      arm_sum += (node->x - reference->x).norm();
      ++num_grids;
      for (int c = 0; c < 6; ++c)
        if (group.c >> c & 1u) samples.push_back({node->first_gdof + c, map.row(c), group.weight, c > 2});
    }
  if (!is_good) return;
  const double arm = arm_sum > 0 ? arm_sum / num_grids : 1;
  Matrix6d A = Matrix6d::Zero();
  for (auto& s : samples) {
    if (s.is_rotation) s.weight *= arm * arm;
    A += s.weight * s.row.transpose() * s.row;
  }
  // Judged with rotations in units of arm.
  Eigen::Matrix<double, 6, 1> unit;
  unit << 1, 1, 1, 1 / arm, 1 / arm, 1 / arm;
  Matrix6d R = Matrix6d::Zero();
  R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = reference->R_basic_cd.transpose();
  // Grids on a line say nothing of a rotation about it; what does not depend on that is as well defined as ever.
  const Eigen::SelfAdjointEigenSolver<Matrix6d> parts(unit.asDiagonal() * A * unit.asDiagonal());
  Matrix6d inverse = Matrix6d::Zero();
  bool is_determined = true;
  for (int k = 0; k < 6; ++k) {
    const Eigen::Matrix<double, 6, 1> mode = unit.asDiagonal() * parts.eigenvectors().col(k);
    if (parts.eigenvalues()[k] > 1e-10 * parts.eigenvalues()[5]) {
      inverse += mode * mode.transpose() / parts.eigenvalues()[k];
      continue;
    }
    const Eigen::Matrix<double, 6, 1> moved = R * mode;
    for (int c = 0; c < 6; ++c)
      if (record.ref_c >> c & 1u) is_determined = is_determined && std::abs(moved[c]) < 1e-8 * unit[c];
  }
  if (!is_determined) {
    diagnostics.error("fe.rbe3-mechanism", at,
                      card +
                          " joins components that leave REFC free to move, expected three grids out of line or "
                          "rotations too",
                      "add grids or the components 456 to the connected ones");
    return;
  }
  std::vector<int> ldofs, dependent;
  for (int c = 0; c < 6; ++c)
    if (record.ref_c >> c & 1u) ldofs.push_back(reference->first_gdof + c);
  const int num = static_cast<int>(ldofs.size());
  dependent = ldofs;
  for (const auto& s : samples)
    if (std::find(ldofs.begin(), ldofs.end(), s.ldof) == ldofs.end()) ldofs.push_back(s.ldof);
  MatrixXd E = MatrixXd::Zero(num, static_cast<int>(ldofs.size()));
  for (int row = 0; row < num; ++row) {
    E(row, row) = 1;
    const Eigen::Matrix<double, 1, 6> to = R.row(dependent[row] - reference->first_gdof) * inverse;
    for (const auto& s : samples) {
      const auto column = std::find(ldofs.begin(), ldofs.end(), s.ldof) - ldofs.begin();
      E(row, static_cast<int>(column)) -= s.weight * to.dot(s.row);
    }
  }
  if (!record.um.empty()) {
    dependent.clear();
    for (const auto& um : record.um) {
      const Node* node = find_rigid_grid(um.g, card, nodes, at, diagnostics);
      if (!node) return;
      for (int c = 0; c < 6; ++c)
        if (um.c >> c & 1u) dependent.push_back(node->first_gdof + c);
    }
  }
  if (!solve_for(E, ldofs, dependent, card, at, equations))
    diagnostics.error("fe.rigid-independent", at,
                      card + " cannot be solved for its " + std::to_string(dependent.size()) +
                          " dependent components, expected " + std::to_string(num) +
                          " of the components it joins that hold a rigid body",
                      "correct UM or leave it out");
}

void add_rrod(const records::Rrod& record, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations) {
  const std::string card = "RROD " + std::to_string(record.id);
  const Node* ga = find_rigid_grid(record.ga, card, nodes, at, diagnostics);
  const Node* gb = find_rigid_grid(record.gb, card, nodes, at, diagnostics);
  if (!ga || !gb) return;
  const Vector3d along = (gb->x - ga->x).normalized();
  const Vector3d a = -(ga->R_basic_cd.transpose() * along), b = gb->R_basic_cd.transpose() * along;
  MatrixXd E(1, 6);
  E << a.transpose(), b.transpose();
  std::vector<int> ldofs;
  for (const Node* node : {ga, gb})
    for (int c = 0; c < 3; ++c) ldofs.push_back(node->first_gdof + c);
  const int column = record.cma > 0 ? record.cma - 1 : record.cmb + 2;
  if (!(std::abs(E(0, column)) > 1e-6) ||
      !solve_for(E, ldofs, {ldofs[static_cast<std::size_t>(column)]}, card, at, equations))
    diagnostics.error("fe.rigid-independent", at,
                      card + " has a dependent component across the rod, expected one along it",
                      "choose another component or end");
}

}  // namespace bough::fe
