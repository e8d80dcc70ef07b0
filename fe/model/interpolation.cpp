#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "base/rotation.hpp"
#include "fe/model/mean_ties.hpp"
#include "fe/model/rigid.hpp"

namespace bough::fe {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// One connected component: its dof, its row of the rigid map about the reference, its weight.
struct Sample {
  const Node* node;
  int ldof;
  Eigen::Matrix<double, 1, 6> row;
  double weight;
  bool is_rotation;
};

/// Equations E u = 0 over the l-dofs `ldofs`, solved for `dependent` (as many as E has rows) by the `inverse` of their
/// columns; false when they cannot be.
bool solve_for(const MatrixXd& E, const std::vector<int>& ldofs, const std::vector<int>& dependent,
               const std::string& card, const SourceLocation& at, std::vector<ConstraintEquation>& equations,
               MatrixXd& inverse) {
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
  inverse = lu.inverse();
  const MatrixXd solved = lu.solve(E), size = inverse.cwiseAbs() * E.cwiseAbs();
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

/// The grids of a mean with their places from its centre, as far as the rotation of best fit is known to second order.
struct MeanGrids {
  struct Grid {
    const Node* node = nullptr;
    double translation = 0, rotation = 0;  ///< weights
    int num_translations = 0, num_rotations = 0;
    bool is_alike = true;  ///< one weight for all translations, one for all rotations
  };
  std::vector<Grid> grids;
  Vector3d centre = Vector3d::Zero();
  bool is_whole = true;  ///< every grid gives all of its translations alike, and all rotations or none
};

MeanGrids collect_grids(const std::vector<Sample>& samples) {
  MeanGrids mean;
  std::map<const Node*, std::size_t> at;
  double total = 0;
  for (const auto& s : samples) {
    const auto [found, is_new] = at.try_emplace(s.node, mean.grids.size());
    if (is_new) mean.grids.push_back({s.node});
    auto& grid = mean.grids[found->second];
    double& weight = s.is_rotation ? grid.rotation : grid.translation;
    int& num = s.is_rotation ? grid.num_rotations : grid.num_translations;
    grid.is_alike = grid.is_alike && std::abs(3 * weight - num * s.weight) <= 1e-12 * std::abs(num * s.weight);
    weight += s.weight / 3;
    ++num;
    if (s.is_rotation) continue;
    mean.centre += s.weight * s.node->x;
    total += s.weight;
  }
  if (total > 0) mean.centre /= total;
  for (const auto& grid : mean.grids)
    mean.is_whole = mean.is_whole && grid.is_alike && grid.num_translations == 3 && grid.num_rotations % 3 == 0 &&
                    grid.num_rotations < 6;
  return mean;
}

/// Components that an RBE3 joins, and the mean length of its arms (1 if it is zero).
struct RigidSamples {
  const Node* reference = nullptr;
  std::vector<Sample> samples;
  double arm = 1;
  bool has_all_grids = false;  ///< false: a grid is missing
};

RigidSamples collect_samples(const records::Rbe3& record, const NodeTable& nodes, const SourceLocation& at,
                             Diagnostics& diagnostics) {
  const std::string card = "RBE3 " + std::to_string(record.id);
  RigidSamples joined;
  joined.reference = find_rigid_grid(record.ref_grid, card, nodes, at, diagnostics);
  joined.has_all_grids = joined.reference != nullptr;
  double arm_sum = 0;
  int num_grids = 0;
  for (const auto& group : record.groups)
    for (int id : group.grids) {
      const Node* node = find_rigid_grid(id, card, nodes, at, diagnostics);
      joined.has_all_grids = joined.has_all_grids && node;
      if (!joined.has_all_grids) continue;
      const Matrix6d map = calc_rigid_map(*node, joined.reference->x);
      arm_sum += (node->x - joined.reference->x).norm();
      ++num_grids;
      for (int c = 0; c < 6; ++c)
        if (group.c >> c & 1u) joined.samples.push_back({node, node->first_gdof + c, map.row(c), group.weight, c > 2});
    }
  if (arm_sum > 0) joined.arm = arm_sum / num_grids;
  for (auto& s : joined.samples)
    if (s.is_rotation) s.weight *= joined.arm * joined.arm;
  return joined;
}

/// The reference goes with the mean: x = x̄ + R s, R the rotation of best fit, Σ w (R s_i)×(x_i - x̄) = 0. To second
/// order θ₂ = A⁻¹ [Σ w (½ (θ×(θ×s_i))×s_i + (θ×s_i)×u_i) + ½ θ×Σ w_r θ_i], A = Σ w (|s_i|² 1 - s_i s_iᵀ) + Σ w_r 1;
/// moments about the centre work on it. With grids that give some of their components only, θ₂ is taken as zero.
Link make_mean_link(const Node& reference, unsigned components, const Matrix6d& inverse,
                    const std::vector<Sample>& samples, const MatrixXd& solved_by, int first_equation) {
  const MeanGrids mean = collect_grids(samples);
  // The motion of the reference, [v; θ] = inverse Σ w rowᵀ u, and v of the centre.
  std::array<DofSum, 3> v, theta;
  for (const auto& s : samples) {
    const Eigen::Matrix<double, 6, 1> by = s.weight * inverse * s.row.transpose();
    const Vector3d axis = s.node->R_basic_cd.col((s.ldof - s.node->first_gdof) % 3);
    const Vector3d to_centre = by.head<3>() + by.tail<3>().cross(mean.centre - reference.x);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        const int gdof = s.node->first_gdof + (s.is_rotation ? 3 : 0) + b;
        v[static_cast<std::size_t>(a)][gdof] += to_centre[a] * axis[b];
        theta[static_cast<std::size_t>(a)][gdof] += by[3 + a] * axis[b];
      }
  }
  LinkBuilder builder(v, theta);
  const Vector3d s = reference.x - mean.centre;
  Matrix3d A = Matrix3d::Zero(), spread = A;
  int first_gradient = 0, first_turn = -1;
  if (mean.is_whole) {
    std::array<DofSum, 9> gradient;  // G_ab = Σ w u_a s_b
    std::array<DofSum, 3> turn;      // Σ w_r θ_i
    bool has_turn = false;
    for (const auto& grid : mean.grids) {
      const Vector3d arm = grid.node->x - mean.centre;
      spread += grid.translation * arm * arm.transpose();
      A += grid.translation * (arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose()) +
           grid.rotation * Matrix3d::Identity();
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b)
          gradient[static_cast<std::size_t>(3 * a + b)][grid.node->first_gdof + a] += grid.translation * arm[b];
        if (grid.rotation > 0) turn[static_cast<std::size_t>(a)][grid.node->first_gdof + 3 + a] += grid.rotation;
      }
      has_turn = has_turn || grid.rotation > 0;
    }
    first_gradient = builder.num_rows();
    for (auto& row : gradient) builder.add_row(std::move(row));
    if (has_turn) first_turn = builder.num_rows();
    for (auto& row : turn)
      if (has_turn) builder.add_row(std::move(row));
  }
  const Eigen::CompleteOrthogonalDecomposition<Matrix3d> solver(A);
  const auto add_mean_rotation = [&](const Vector3d& moment, double factor) {
    const Vector3d y = factor * solver.solve(moment);
    const Matrix3d own = -spread * skew(y), own_sum = own + own.transpose();
    for (int j = 0; j < 3; ++j)
      for (int i = j; i < 3; ++i) builder.add_weight(i, j, 0.5 * own_sum(i, j));
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        builder.add_weight(a, first_gradient + 3 * a + b, -y[b]);
        builder.add_weight(a, first_gradient + 3 * b + b, y[a]);
        if (first_turn >= 0) builder.add_weight(a, first_turn + b, 0.5 * skew(y)(a, b));
      }
  };
  std::vector<int> rows;
  for (int c = 0; c < 6; ++c)
    if (components >> c & 1u) rows.push_back(c);
  for (Eigen::Index k = 0; k < solved_by.rows(); ++k) {
    builder.start_equation();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      // A force on dependent k is inverse(k, i) on row i.
      const double factor = solved_by(k, static_cast<Eigen::Index>(i));
      const bool is_rotation = rows[i] > 2;
      const Vector3d axis = reference.R_basic_cd.col(rows[i] % 3);
      if (factor == 0) continue;
      builder.add_component({&reference, s, axis, is_rotation, (components >> (is_rotation ? 3 : 0) & 7u) == 7u},
                            factor);
      if (mean.is_whole) add_mean_rotation(is_rotation ? axis : Vector3d(s.cross(axis)), factor);
    }
  }
  return builder.finish(first_equation);
}

}  // namespace

void add_rbe3(const records::Rbe3& record, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations, std::vector<Link>& links) {
  const std::string card = "RBE3 " + std::to_string(record.id);
  const RigidSamples joined = collect_samples(record, nodes, at, diagnostics);
  if (!joined.has_all_grids) return;
  const Node* reference = joined.reference;
  const auto& samples = joined.samples;
  const double arm = joined.arm;
  Matrix6d A = Matrix6d::Zero();
  for (const auto& s : samples) A += s.weight * s.row.transpose() * s.row;
  // Judged with rotations in units of arm.
  Eigen::Matrix<double, 6, 1> unit;
  unit << 1, 1, 1, 1 / arm, 1 / arm, 1 / arm;
  Matrix6d R = Matrix6d::Zero();
  R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = reference->R_basic_cd.transpose();
  // Grids on a line do not determine a rotation about it; what does not depend on that is as well defined as ever.
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
  std::unordered_map<int, int> column_of;
  for (const int ldof : ldofs) column_of.emplace(ldof, static_cast<int>(column_of.size()));
  for (const auto& s : samples)
    if (column_of.emplace(s.ldof, static_cast<int>(column_of.size())).second) ldofs.push_back(s.ldof);
  MatrixXd E = MatrixXd::Zero(num, static_cast<int>(ldofs.size()));
  for (int row = 0; row < num; ++row) {
    E(row, row) = 1;
    const Eigen::Matrix<double, 1, 6> to = R.row(dependent[row] - reference->first_gdof) * inverse;
    for (const auto& s : samples) E(row, column_of.at(s.ldof)) -= s.weight * to.dot(s.row);
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
  const auto first = static_cast<int>(equations.size());
  MatrixXd solved_by;
  if (solve_for(E, ldofs, dependent, card, at, equations, solved_by))
    links.push_back(make_mean_link(*reference, record.ref_c, inverse, samples, solved_by, first));
  else
    diagnostics.error("fe.rigid-independent", at,
                      card + " cannot be solved for its " + std::to_string(dependent.size()) +
                          " dependent components, expected " + std::to_string(num) +
                          " of the components it joins that hold a rigid body",
                      "correct UM or leave it out");
}

std::vector<WeightedMean> list_weighted_means(const records::Deck& deck, const Model& model) {
  std::vector<WeightedMean> means;
  Diagnostics of_cards;  // reported when the model was built
  for (const auto& record : deck.rbe3) {
    const bool rotates = record.ref_c == 0x3F;
    if (!record.um.empty() || (!rotates && record.ref_c != 0x7)) continue;
    const RigidSamples joined = collect_samples(record, model, deck.locate(record.at), of_cards);
    if (!joined.has_all_grids) continue;
    const MeanGrids mean = collect_grids(joined.samples);
    if (!mean.is_whole) continue;
    auto& added = means.emplace_back();
    added.reference = model.find_node(record.ref_grid);
    added.rotates = rotates;
    added.centre = mean.centre;
    for (const auto& grid : mean.grids)
      added.members.push_back(
          {model.find_node(grid.node->id), grid.node->x - mean.centre, grid.translation, grid.rotation});
  }
  return means;
}

void add_rrod(const records::Rrod& record, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations, std::vector<Link>& links) {
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
  const auto first = static_cast<int>(equations.size());
  MatrixXd solved_by;
  if (!(std::abs(E(0, column)) > 1e-6) ||
      !solve_for(E, ldofs, {ldofs[static_cast<std::size_t>(column)]}, card, at, equations, solved_by)) {
    diagnostics.error("fe.rigid-independent", at,
                      card + " has a dependent component across the rod, expected one along it",
                      "choose another component or end");
    return;
  }
  // A tension N works on ½ |u_b - u_a|²/L across the rod.
  Link link;
  link.first_equation = first;
  link.L = MatrixXd::Zero(3, 6);
  link.L << -Matrix3d::Identity(), Matrix3d::Identity();
  for (const Node* node : {ga, gb})
    for (int c = 0; c < 3; ++c) link.gdofs.push_back(node->first_gdof + c);
  link.W.push_back(solved_by(0, 0) / (gb->x - ga->x).norm() * (Matrix3d::Identity() - along * along.transpose()));
  links.push_back(std::move(link));
}

}  // namespace bough::fe
