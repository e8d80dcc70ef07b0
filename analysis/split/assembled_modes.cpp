#include "analysis/split/assembled_modes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/diagnostic.hpp"
#include "base/rotation.hpp"

namespace bough::analysis::splitting {

namespace {

using Eigen::Index;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using records::FlexBody;

constexpr double kMassless = 1e-14;      ///< of the largest diagonal term or eigenvalue of K + σM: round-off
constexpr double kDependentRow = 1e-10;  ///< of the largest pivot: a constraint that others contain
constexpr double kStaticShift = 1e-6;    ///< of the lowest eigenvalue: inertia that holds a free structure

/// M of [velocity of Bo, angular velocity, η̇] at rest, (6 + n) x (6 + n).
MatrixXd calc_body_mass(const FlexBody& body) {
  const Index n = body.num_modes();
  MatrixXd M = MatrixXd::Zero(6 + n, 6 + n);
  M.topLeftCorner<3, 3>() = body.mass * Matrix3d::Identity();
  M.block<3, 3>(3, 0) = skew(body.mass * body.cg);
  M.block<3, 3>(0, 3) = M.block<3, 3>(3, 0).transpose();
  M.block<3, 3>(3, 3) = body.inertia;
  if (n == 0) return M;
  M.block(0, 6, 3, n) = body.integrals().gamma0;
  M.block(3, 6, 3, n) = body.integrals().gamma1;
  M.block(6, 0, n, 6) = M.block(0, 6, 6, n).transpose();
  M.bottomRightCorner(n, n) = body.modal_mass;
  return M;
}

/// Motion of the point p [6 x 6] of a rigid body: translation and rotation per unit of those of Bo.
Matrix6d calc_rigid_motion(const Vector3d& p) {
  Matrix6d B = Matrix6d::Identity();
  B.topRightCorner<3, 3>() = -skew(p);
  return B;
}

/// Position of the node, and its mode shapes [6 x n]; node 0 is Bo.
struct NodeShape {
  Vector3d p = Vector3d::Zero();
  MatrixXd phi;
};

NodeShape find_shape(const FlexBody& body, int node) {
  if (node == 0) return {Vector3d::Zero(), MatrixXd::Zero(6, body.num_modes())};
  const int index = body.find_node(node);
  BOUGH_DEMAND(index >= 0);
  return {body.node_xyz.row(index).transpose(), body.phi[static_cast<std::size_t>(index)]};
}

Matrix6d calc_axes(const Structure& structure, int node) {
  Matrix6d axes = Matrix6d::Identity();
  if (const auto found = structure.axes.find(node); found != structure.axes.end()) {
    axes.topLeftCorner<3, 3>() = found->second;
    axes.bottomRightCorner<3, 3>() = found->second;
  }
  return axes;
}

/// Columns of the axes whose components are held, or free.
MatrixXd choose_axes(const Matrix6d& axes, unsigned held, bool takes_held) {
  std::vector<Index> columns;
  for (Index c = 0; c < 6; ++c)
    if (((held >> c) & 1U) == static_cast<unsigned>(takes_held)) columns.push_back(c);
  return axes(Eigen::all, columns);
}

Index count_free(const PartLink& link) { return 6 - std::popcount(link.held); }

/// Coordinates of the assembly: those of the hinges to the ground, then η of body after body.
class Coordinates {
 public:
  Coordinates(const std::vector<const FlexBody*>& bodies, const Structure& structure, const Assembly& assembly)
      : bodies_(bodies), structure_(structure) {
    Index size = 0;
    for (const auto& link : assembly.links)
      if (link.parent < 0 && !link.closes_loop) size += count_free(link);
    for (const auto* body : bodies) {
      first_.push_back(size);
      size += body->num_modes();
    }
    T_.resize(bodies.size());
    Index next = 0;
    for (const auto& link : assembly.links) {
      if (link.closes_loop) continue;
      if (link.parent >= 0) {
        add_body(link.child, link.node, calc_motion(link.parent, link.node));
        continue;
      }
      MatrixXd node_motion = MatrixXd::Zero(6, size);
      node_motion.middleCols(next, count_free(link)) = choose_axes(calc_axes(structure, link.node), link.held, false);
      next += count_free(link);
      add_body(link.child, link.node, node_motion);
    }
    for (const auto& link : assembly.links)
      if (link.closes_loop) add_constraint(link);
  }

  Index size() const { return T_.front().cols(); }
  const MatrixXd& constraints() const { return constraints_; }
  /// [6 + n x size]: velocity of Bo, angular velocity and η̇ of a part per unit of the coordinates' rates.
  const MatrixXd& get_motion(int part) const { return T_[static_cast<std::size_t>(part)]; }

  MatrixXd calc_mass() const {
    MatrixXd M = MatrixXd::Zero(size(), size());
    for (std::size_t i = 0; i < bodies_.size(); ++i) M += T_[i].transpose() * calc_body_mass(*bodies_[i]) * T_[i];
    return M;
  }
  MatrixXd calc_stiffness() const {
    MatrixXd K = MatrixXd::Zero(size(), size());
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Index n = bodies_[i]->num_modes();
      K.block(first_[i], first_[i], n, n) = bodies_[i]->modal_stiffness;
    }
    return K;
  }

 private:
  const FlexBody& get_body(int part) const { return *bodies_[static_cast<std::size_t>(part)]; }

  /// Motion of a node [6 x size] per unit of the coordinates.
  MatrixXd calc_motion(int part, int node) const {
    const auto& body = get_body(part);
    const auto shape = find_shape(body, node);
    MatrixXd G(6, 6 + body.num_modes());
    G.leftCols<6>() = calc_rigid_motion(shape.p);
    G.rightCols(body.num_modes()) = shape.phi;
    return G * T_[static_cast<std::size_t>(part)];
  }
  /// The coordinates of the body whose node has the motion.
  void add_body(int part, int node, const MatrixXd& node_motion) {
    const auto& body = get_body(part);
    const Index n = body.num_modes(), first = first_[static_cast<std::size_t>(part)];
    const auto shape = find_shape(body, node);
    MatrixXd T = MatrixXd::Zero(6 + n, node_motion.cols());
    T.block(6, first, n, n).setIdentity();
    MatrixXd rigid = node_motion;
    rigid.middleCols(first, n) -= shape.phi;
    T.topRows<6>() = calc_rigid_motion(-shape.p) * rigid;
    T_[static_cast<std::size_t>(part)] = std::move(T);
  }
  void add_constraint(const PartLink& link) {
    MatrixXd rows = calc_motion(link.child, link.node);
    if (link.parent >= 0) rows -= calc_motion(link.parent, link.node);
    rows = (choose_axes(calc_axes(structure_, link.node), link.held, true).transpose() * rows).eval();
    const Index before = constraints_.rows();
    constraints_.conservativeResize(before + rows.rows(), size());
    constraints_.bottomRows(rows.rows()) = rows;
  }

  const std::vector<const FlexBody*>& bodies_;
  const Structure& structure_;
  std::vector<Index> first_;  ///< column of the first η of each body
  std::vector<MatrixXd> T_;   ///< [part] (6 + n) x size
  MatrixXd constraints_;      ///< rows that are zero
};

/// Orthonormal basis of the vectors that the rows do not see.
MatrixXd calc_null_space(MatrixXd rows, Index size) {
  if (rows.rows() == 0) return MatrixXd::Identity(size, size);
  const double largest = rows.cwiseAbs().maxCoeff();
  for (Index i = 0; i < rows.rows(); ++i)
    if (const double norm = rows.row(i).norm(); norm > kDependentRow * largest) rows.row(i) /= norm;
  Eigen::ColPivHouseholderQR<MatrixXd> qr(rows.transpose());
  qr.setThreshold(kDependentRow);
  const MatrixXd Q = qr.householderQ();
  return Q.rightCols(size - qr.rank());
}

/// Pencil of the assembly without its constraints, and W = S N V Λ^{-1/2}: WᵀAW = 1 of A = K + shift M in the subspace
/// that the constraints leave, without directions that have neither stiffness nor mass.
struct Whitened {
  MatrixXd W;  ///< size x r
  MatrixXd M;  ///< WᵀMW
};

Whitened whiten(const Coordinates& coordinates, double shift) {
  MatrixXd M = coordinates.calc_mass(), A = coordinates.calc_stiffness() + shift * M;
  const double empty = kMassless * A.diagonal().maxCoeff();
  const VectorXd scale = A.diagonal().unaryExpr([&](double a) { return a > empty ? 1 / std::sqrt(a) : 1.0; });
  M = scale.asDiagonal() * M * scale.asDiagonal();
  A = scale.asDiagonal() * A * scale.asDiagonal();
  const MatrixXd N = calc_null_space(coordinates.constraints() * scale.asDiagonal(), coordinates.size());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(MatrixXd(N.transpose() * A * N));
  // Directions without stiffness and mass: the twist of a free line of bars.
  const VectorXd& values = solver.eigenvalues();
  const double smallest = kMassless * values.maxCoeff();
  const Index size = values.size() - (values.array() <= smallest).count();
  const MatrixXd W =
      N * (solver.eigenvectors().rightCols(size) * values.tail(size).cwiseSqrt().cwiseInverse().asDiagonal());
  return {scale.asDiagonal() * W, W.transpose() * M * W};
}

/// Motion of a node [6 x 6 + n] per unit of the motion of its body.
MatrixXd calc_node_rows(const FlexBody& body, int index) {
  MatrixXd G(6, 6 + body.num_modes());
  G.leftCols<6>() = calc_rigid_motion(body.node_xyz.row(index).transpose());
  G.rightCols(body.num_modes()) = body.phi[static_cast<std::size_t>(index)];
  return G;
}

}  // namespace

Eigen::VectorXd calc_assembled_eigenvalues(const std::vector<const FlexBody*>& bodies, const Structure& structure,
                                           const Assembly& assembly, double shift) {
  const auto whitened = whiten(Coordinates(bodies, structure, assembly), shift);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(whitened.M, Eigen::EigenvaluesOnly);
  Eigen::VectorXd lambda = solver.eigenvalues().reverse();
  for (double& value : lambda) value = value > 0 ? 1 / value - shift : INFINITY;
  return lambda;
}

MatrixXd calc_assembled_deflections(const std::vector<const FlexBody*>& bodies, const Structure& structure,
                                    const Assembly& assembly, double shift, const fe::Model& model,
                                    const Partition& partition, const MatrixXd& F) {
  const Coordinates coordinates(bodies, structure, assembly);
  const auto visit = [&](const auto& work) {  // grids with their bodies
    for (const auto& node : model.nodes()) {
      const int part = partition.find_owner(node.id);
      const auto& body = *bodies[static_cast<std::size_t>(part)];
      if (const int index = body.find_node(node.id); node.num_dofs == 6 && index >= 0)
        work(node.first_gdof, part, calc_node_rows(body, index));
    }
  };
  std::vector<MatrixXd> loads;
  for (const auto* body : bodies) loads.push_back(MatrixXd::Zero(6 + body->num_modes(), F.cols()));
  visit([&](int first, int part, const MatrixXd& G) {
    loads[static_cast<std::size_t>(part)] += G.transpose() * F.middleRows<6>(first);
  });
  MatrixXd f = MatrixXd::Zero(coordinates.size(), F.cols());
  for (int part = 0; part < static_cast<int>(bodies.size()); ++part)
    f += coordinates.get_motion(part).transpose() * loads[static_cast<std::size_t>(part)];
  const MatrixXd W = whiten(coordinates, kStaticShift * shift).W;
  const MatrixXd y = W * (W.transpose() * f);
  std::vector<MatrixXd> motions;
  for (int part = 0; part < static_cast<int>(bodies.size()); ++part)
    motions.push_back(coordinates.get_motion(part) * y);
  MatrixXd u = MatrixXd::Zero(model.num_gdofs(), F.cols());
  visit([&](int first, int part, const MatrixXd& G) {
    u.middleRows<6>(first) = G * motions[static_cast<std::size_t>(part)];
  });
  return u;
}

}  // namespace bough::analysis::splitting
