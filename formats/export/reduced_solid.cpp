#include "formats/export/reduced_solid.hpp"

#include "base/rotation.hpp"

namespace bough::exports {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;

/// Columns: rigid-body modes (translation, rotation about Bo), then the modes. 6 rows per frame.
MatrixXd calc_frame_motion(const records::FlexBody& body, const std::vector<int>& nodes, const MatrixXd& P) {
  const Index m = static_cast<Index>(nodes.size()), n = body.num_modes();
  MatrixXd motion = MatrixXd::Zero(6 * m, 6 + n);
  for (Index i = 0; i < m; ++i) {
    motion.block(6 * i, 0, 6, 6).setIdentity();
    motion.block(6 * i, 3, 3, 3) = -skew(P.row(i).transpose());
    const int k = body.find_node(nodes[static_cast<std::size_t>(i)]);
    if (nodes[static_cast<std::size_t>(i)] != 0) motion.block(6 * i, 6, 6, n) = body.phi[static_cast<std::size_t>(k)];
  }
  return motion;
}

}  // namespace

std::optional<ReducedSolid> calc_reduced_solid(const records::FlexBody& body, std::string& why) {
  const Index n = body.num_modes();
  std::vector<Index> constraint, other;
  for (Index j = 0; j < n; ++j)
    (body.kind[static_cast<std::size_t>(j)] == records::ModeKind::Constraint ? constraint : other).push_back(j);
  const Index num_constraint = static_cast<Index>(constraint.size());
  if (constraint.empty()) {
    why = "the body has no constraint modes";
    return {};
  }
  ReducedSolid solid;
  solid.node = body.interface_nodes;
  const Index num_interface = 6 * static_cast<Index>(solid.node.size());
  if (num_interface == num_constraint) solid.node.insert(solid.node.begin(), 0);
  const Index num_frame_dofs = 6 * static_cast<Index>(solid.node.size());
  if (num_frame_dofs != num_constraint + 6) {
    why = std::to_string(num_constraint) + " constraint modes and " + std::to_string(num_interface / 6) +
          " interface nodes, expected six modes for each node that does not carry the body frame";
    return {};
  }
  const auto& integrals = body.integrals();
  if (integrals.empty()) {
    why = "the body has no mass integrals";
    return {};
  }
  solid.P = MatrixXd::Zero(num_frame_dofs / 6, 3);
  for (Index i = 0; i < solid.P.rows(); ++i)
    if (const int id = solid.node[static_cast<std::size_t>(i)]; id != 0)
      solid.P.row(i) = body.node_xyz.row(body.find_node(id));

  // u = A a + B b, a rigid-body and constraint modes, b the other modes: a = A^-1 (u - B b).
  const MatrixXd motion = calc_frame_motion(body, solid.node, solid.P);
  MatrixXd A(num_frame_dofs, num_frame_dofs), B(num_frame_dofs, static_cast<Index>(other.size()));
  A.leftCols(6) = motion.leftCols(6);
  for (Index j = 0; j < num_constraint; ++j) A.col(6 + j) = motion.col(6 + constraint[static_cast<std::size_t>(j)]);
  for (Index j = 0; j < B.cols(); ++j) B.col(j) = motion.col(6 + other[static_cast<std::size_t>(j)]);
  const Eigen::FullPivLU<MatrixXd> lu(A);
  if (!lu.isInvertible()) {
    why = "the constraint modes do not move the interface frames one to one";
    return {};
  }
  MatrixXd a(num_frame_dofs, num_frame_dofs + B.cols());
  a.leftCols(num_frame_dofs) = lu.inverse();
  if (B.cols() > 0) a.rightCols(B.cols()) = -lu.solve(B);
  MatrixXd T = MatrixXd::Zero(6 + n, a.cols());
  T.topRows(6) = a.topRows(6);
  for (Index j = 0; j < num_constraint; ++j) T.row(6 + constraint[static_cast<std::size_t>(j)]) = a.row(6 + j);
  for (Index j = 0; j < B.cols(); ++j) T(6 + other[static_cast<std::size_t>(j)], num_frame_dofs + j) = 1;

  MatrixXd M(6 + n, 6 + n);
  const Eigen::Matrix3d first_moment = body.mass * skew(body.cg);
  M.topLeftCorner(3, 3) = body.mass * Eigen::Matrix3d::Identity();
  M.block(0, 3, 3, 3) = -first_moment;
  M.block(3, 0, 3, 3) = first_moment;
  M.block(3, 3, 3, 3) = body.inertia;
  M.block(0, 6, 3, n) = integrals.gamma0;
  M.block(3, 6, 3, n) = integrals.gamma1;
  M.bottomLeftCorner(n, 6) = M.topRightCorner(6, n).transpose();
  M.bottomRightCorner(n, n) = body.modal_mass;
  solid.M = T.transpose() * M * T;
  solid.K = T.bottomRows(n).transpose() * body.modal_stiffness * T.bottomRows(n);
  solid.C = T.bottomRows(n).transpose() * body.modal_damping * T.bottomRows(n);
  return solid;
}

}  // namespace bough::exports
