// Checks that normal modes can follow the displacements that constraints prescribe.
#include <algorithm>
#include <cmath>
#include <optional>

#include "solver/builder/build.hpp"

namespace bough::solver {

namespace {

constexpr double kMissed = 0.1;
constexpr double kRigid = 1e-6;  // of the flexibility of rows scaled to one: no mode gives way

/// Flexibility G K⁻¹ Gᵀ of rows G of a body, by its free motions whose frequency is among the lowest `share` of all.
MatrixXd calc_flexibility(const MatrixXd& motions, const VectorXd& stiffness, const MatrixXd& G, Eigen::Index count) {
  const MatrixXd moved = G * motions.leftCols(count);
  return moved * stiffness.head(count).cwiseInverse().asDiagonal() * moved.transpose();
}

/// The largest share, over directions of the rows, of the flexibility that the upper half of the modes gives. The
/// series of normal modes falls off as a power of their number, 1/N for moments on beams and 1/N³ for forces: what the
/// upper half gives is what is left out (1/N) or more.
double calc_missed(const Body& body, const MatrixXd& M, const MatrixXd& G) {
  const int n = body.num_modes();
  if (n == 0) return 0;
  if (Eigen::LLT<MatrixXd>(M).info() != Eigen::Success) return 0;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> own(0.5 * (body.K() + body.K().transpose()), M);
  if (own.info() != Eigen::Success || !(own.eigenvalues()[0] > 0)) return 0;
  MatrixXd all = calc_flexibility(own.eigenvectors(), own.eigenvalues(), G, n);
  MatrixXd lower = calc_flexibility(own.eigenvectors(), own.eigenvalues(), G, n / 2);
  const VectorXd scale = all.diagonal().unaryExpr([](double x) { return x > 0 ? 1 / std::sqrt(x) : 0; });
  all = scale.asDiagonal() * all * scale.asDiagonal();
  lower = scale.asDiagonal() * lower * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> range(all);
  MatrixXd white(all.rows(), 0);
  for (Eigen::Index i = 0; i < all.rows(); ++i) {
    if (!(range.eigenvalues()[i] > kRigid)) continue;
    white.conservativeResize(Eigen::NoChange, white.cols() + 1);
    white.rightCols<1>() = range.eigenvectors().col(i) / std::sqrt(range.eigenvalues()[i]);
  }
  if (white.cols() == 0) return 0;
  const MatrixXd kept = white.transpose() * lower * white;
  return 1 - Eigen::SelfAdjointEigenSolver<MatrixXd>(kept, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

MatrixXd get_modal_mass(const Body& body) {
  const int n = body.num_modes();
  return body.make_inertia().M_modal.topLeftCorner(n, n).selfadjointView<Eigen::Lower>();
}

bool is_diagonal(const MatrixXd& M) {
  constexpr double kEqual = 1e-5;  // files of five digits
  const VectorXd scale = M.diagonal().cwiseMax(0).cwiseSqrt();
  return ((M - MatrixXd(M.diagonal().asDiagonal())).array().abs() <= kEqual * (scale * scale.transpose()).array())
      .all();
}

/// Motion of a body frame that nodes carry, relative to the mean axes, and the modal mass about these.
struct CarriedFrame {
  MatrixXd J;       ///< 6 x n: of Bo, in B
  MatrixXd M_mean;  ///< n x n
};

/// Free-free modes in a frame that nodes carry: they are orthogonal about the mean axes, not in their own frame.
/// Empty for other modes.
std::optional<CarriedFrame> find_carried_frame(const Body& body) {
  const int n = body.num_modes();
  BodyInertia inertia = body.make_inertia();
  body.calc_mass(VectorXd::Zero(n), inertia);
  const Matrix6Xd M_top = inertia.M_top.leftCols(n);
  // A line of bars has no inertia about itself: the solution of least norm, rows and columns scaled to 1.
  const Vector6d size = inertia.M6.diagonal().cwiseSqrt(), scale = (size.array() > 0).select(size.cwiseInverse(), 1.0);
  Eigen::CompleteOrthogonalDecomposition<Matrix6d> solver;
  solver.setThreshold(1e-10);
  solver.compute(scale.asDiagonal() * inertia.M6 * scale.asDiagonal());
  const MatrixXd J = -(scale.asDiagonal() * solver.solve(scale.asDiagonal() * M_top));
  const MatrixXd M = get_modal_mass(body), M_mean = M + M_top.transpose() * J;
  if (is_diagonal(M) || !is_diagonal(M_mean)) return std::nullopt;
  return CarriedFrame{J, M_mean};
}

/// Its static shapes answer exactly what acts at its interface nodes.
bool has_static_shape(const records::FlexBody& flex, int node, int n) {
  const auto& known = flex.interface_nodes;
  return std::find(known.begin(), known.end(), node) != known.end() &&
         std::any_of(flex.kind.begin(), flex.kind.begin() + std::min<std::ptrdiff_t>(n, std::ssize(flex.kind)),
                     [](auto kind) { return kind != records::ModeKind::Normal; });
}

}  // namespace

void check_shapes(const records::SystemSpec& spec, const System& system, const FlexMap& flex,
                  Diagnostics& diagnostics) {
  const Tree& tree = system.tree;
  const auto find_flex = [&](int b) -> const records::FlexBody* {
    for (const auto& r : spec.bodies)
      if (const auto found = flex.find(r.file); r.name == tree[b].name && found != flex.end()) return &found->second;
    return nullptr;
  };
  const auto report = [&](const std::string& who, const SourceLocation& at, int b, int node_index, const MatrixXd& M,
                          const MatrixXd& G) {
    const records::FlexBody* own = find_flex(b);
    const int node = tree[b].body.nodes()[static_cast<size_t>(node_index)].id;
    if (own == nullptr || G.isZero(0) || has_static_shape(*own, node, tree[b].num_modes())) return;
    const double missed = calc_missed(tree[b].body, M, G);
    if (!(missed > kMissed)) return;
    const std::string id = std::to_string(node);
    diagnostics.warning("system.stiff-shapes", at,
                        who + " holds node " + id + " of body " + quote(tree[b].name) +
                            " in a direction in which its normal modes converge slowly: the upper half of them gives " +
                            std::to_string(static_cast<int>(std::lround(100 * missed))) +
                            " % of their flexibility there, about as much is missing, and the body is too stiff by it",
                        "reduce the body with interface = [" + id +
                            "] and basis = \"craig-bampton\" (constraint modes), or residual = [\"interface\"]");
  };

  // The origin of a frame that a node carries is that node.
  const auto find_held_node = [](const TreeBody& tb) {
    const auto& nodes = tb.body.nodes();
    if (tb.on_child.node > 0 || tb.on_child.moves) return tb.on_child.node;
    const auto is_carrier = [](const Node& node) { return node.id != 0 && !node.moves; };
    const auto found = std::find_if(nodes.begin(), nodes.end(), is_carrier);
    return found == nodes.end() ? 0 : static_cast<int>(found - nodes.begin());
  };
  const auto data = system.make_data();
  VectorXd q = VectorXd::Zero(system.num_q()), u = VectorXd::Zero(system.num_u());
  system.calc_initial_state(q, u);
  calc_kinematics(system, *data, system.start, q, u);
  for (int b = 0; b < tree.size(); ++b) {
    const TreeBody& tb = tree[b];
    const auto nu = tb.num_hinge_u();
    if (tb.parent >= 0 || nu == 6 || tb.num_modes() == 0) continue;
    const auto carried = find_carried_frame(tb.body);
    if (!tb.on_child.moves && !carried) continue;
    MatrixXd J = MatrixXd::Zero(6, tb.num_modes()), M = carried ? carried->M_mean : get_modal_mass(tb.body);
    if (tb.on_child.moves) J = data->tree.markers[static_cast<size_t>(tb.child_marker)].J;
    if (carried) {
      const Vector3d p = tb.body.nodes()[static_cast<size_t>(std::max(tb.on_child.node, 0))].p;
      J += carried->J;
      J.topRows(3) -= skew(p) * carried->J.bottomRows(3);
    }
    MatrixXd W = MatrixXd::Identity(6, 6);
    if (nu > 0) W = Eigen::FullPivLU<MatrixXd>(data->tree[b].hinge.H.leftCols(nu).transpose()).kernel();
    const Matrix3d R_HpB = tb.on_parent.R_KM.transpose() * data->tree[b].state.R_WB;
    J.topRows(3) = (R_HpB * J.topRows(3)).eval();
    J.bottomRows(3) = (R_HpB * J.bottomRows(3)).eval();
    report("hinge " + quote(tb.hinge_name), tb.hinge_at, b, find_held_node(tb), M, W.transpose() * J);
  }
  const auto is_slow = [&](int marker) {
    const Marker& end = tree.markers[static_cast<size_t>(marker)];
    if (end.body < 0 || !end.moves) return false;
    const records::FlexBody* own = find_flex(end.body);
    const int node = tree[end.body].body.nodes()[static_cast<size_t>(end.node)].id;
    return own != nullptr && !has_static_shape(*own, node, tree[end.body].num_modes());
  };
  const auto& all = system.loops.constraints;
  if (std::none_of(all.begin(), all.end(), [&](const Constraint& c) {
        return c.closure && (is_slow(c.parent_marker) || is_slow(c.child_marker));
      }))
    return;
  calc_closure_positions(system.loops, tree, data->tree, data->loops);
  const MatrixXd G = calc_dense_rows(system.loops, tree, data->tree, data->loops);
  int row = 0;
  for (const auto& block : data->loops.blocks) {
    for (const int c : block.constraints) {
      const Constraint& constraint = system.loops[c];
      const int count = constraint.num_rows();
      for (const int marker : {constraint.parent_marker, constraint.child_marker}) {
        const Marker& end = tree.markers[static_cast<size_t>(marker)];
        if (!constraint.closure || !is_slow(marker)) continue;
        report("constraint " + quote(constraint.name), constraint.at, end.body, end.node,
               get_modal_mass(tree[end.body].body),
               G.block(row, tree[end.body].eta_dot_offset(), count, tree[end.body].num_modes()));
      }
      row += count;
    }
  }
}

}  // namespace bough::solver
