#include "modal/bases/frame.hpp"

#include "base/diagnostic.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::bases {

namespace {

[[noreturn]] void throw_bad_frame(const std::string& what, const std::string& advice) {
  throw InputError("modal.bad-frame", {}, what, advice);
}

const fe::Node& get_node(const fe::Model& model, int id) {
  const int index = model.find_node(id);
  if (index < 0 || model.node(index).num_dofs != 6)
    throw_bad_frame("node " + std::to_string(id) + " of the body frame is not a grid of the deck", "name a GRID");
  return model.node(index);
}

/// Rejects a node without rotations: the rotation of a grid of solids is undefined.
void check_rotations(const fe::Model& model, const fe::Node& node) {
  for (int c = 3; c < 6; ++c) {
    if (model.T().row(node.first_gdof + c).norm() > 0) continue;
    throw_bad_frame("node " + std::to_string(node.id) + " cannot carry the body frame: its rotation " +
                        std::to_string(c + 1) + " is held or belongs to no element",
                    "tie it by RBE2 or RBE3 to a grid that turns, or take three nodes");
  }
}

/// Rows 0..2: translation of a; 3..5: the rotation that three nodes show.
MatrixXd calc_three_node_rows(const fe::Model& model, const std::vector<int>& ids) {
  const auto& a = get_node(model, ids[0]);
  const auto& b = get_node(model, ids[1]);
  const auto& c = get_node(model, ids[2]);
  const Vector3d along = b.x - a.x, normal = along.cross(c.x - a.x);
  if (!(normal.norm() > detail::kCollinear * along.norm() * (c.x - a.x).norm()) || along.norm() == 0)
    throw_bad_frame("the three nodes of the body frame lie on one line", "take nodes that span a triangle");
  MatrixXd C = MatrixXd::Zero(6, model.num_gdofs());
  C.block<3, 3>(0, a.first_gdof).setIdentity();
  const auto add = [&](int row, const fe::Node& node, const Vector3d& direction) {
    C.block<1, 3>(row, node.first_gdof) += direction.transpose();
    C.block<1, 3>(row, a.first_gdof) -= direction.transpose();
  };
  const Vector3d n = normal.normalized();
  add(3, b, n.cross(along).normalized());
  add(4, b, n);
  add(5, c, n);
  return C;
}

}  // namespace

const char* find_expected_nodes(const FrameSpec& frame) {
  const auto count = frame.nodes.size();
  switch (frame.kind) {
    case FrameKind::MeanAxes:
      return count == 0 ? nullptr : "none";
    case FrameKind::Node:
      return count == 1 ? nullptr : "one";
    case FrameKind::ThreeNodes:
      return count == 3 ? nullptr : "three";
    case FrameKind::MassCentre:
      break;
  }
  return count == 0 || count == 1 || count == 3 ? nullptr : "none, one or three";
}

MatrixXd calc_reference_conditions(const fe::Model& model, const FrameSpec& frame) {
  const auto count = frame.nodes.size();
  if (const char* expected = find_expected_nodes(frame))
    throw_bad_frame(std::to_string(count) + " nodes given for the body frame, expected " + expected,
                    "give frame_nodes as the frame takes them");
  MatrixXd C = MatrixXd::Zero(6, model.num_gdofs());
  const auto calc_mean = [&] {
    const auto properties = fe::calc_mass_properties(model, model.mass_kind(), Vector3d::Zero());
    const MatrixXd R = model.calc_rigid_modes(properties.cg);
    return MatrixXd(fe::calc_mass_times(model, model.mass_kind(), R).transpose());
  };
  switch (frame.kind) {
    case FrameKind::MeanAxes:
      return calc_mean();
    case FrameKind::Node: {
      const auto& node = get_node(model, frame.nodes[0]);
      check_rotations(model, node);
      C.block<6, 6>(0, node.first_gdof).setIdentity();
      return C;
    }
    case FrameKind::ThreeNodes:
      return calc_three_node_rows(model, frame.nodes);
    case FrameKind::MassCentre:
      break;
  }
  C = calc_mean();
  if (count == 1) {
    const auto& node = get_node(model, frame.nodes[0]);
    check_rotations(model, node);
    C.bottomRows<3>().setZero();
    C.block<3, 3>(3, node.first_gdof + 3).setIdentity();
  } else if (count == 3) {
    C.bottomRows<3>() = calc_three_node_rows(model, frame.nodes).bottomRows<3>();
  }
  return C;
}

MatrixXd shift_to_frame(const fe::Model& model, const MatrixXd& C, const MatrixXd& Phi) {
  const MatrixXd R = model.calc_rigid_modes();
  // Pivoted and least-norm: a straight line of bars without inertia about itself leaves one motion undetermined.
  const VectorXd scale = C.rowwise().norm().unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
  const MatrixXd CR = scale.asDiagonal() * (C * R);
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver;
  solver.setThreshold(detail::kUndeterminedMotion);
  solver.compute(CR);
  MatrixXd shifted = Phi;
  for (int pass = 0; pass < 2; ++pass) shifted -= R * solver.solve(scale.asDiagonal() * (C * shifted));
  return shifted;
}

}  // namespace bough::modal::bases
