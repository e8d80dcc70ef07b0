// Checks that normal modes can follow the displacements that constraints prescribe.
#include <algorithm>
#include <cmath>

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
double calc_missed(const Body& body, const MatrixXd& G) {
  const int n = body.num_modes();
  const MatrixXd M = body.make_inertia().M_modal.topLeftCorner(n, n).selfadjointView<Eigen::Lower>();
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
  const auto report = [&](const std::string& who, const SourceLocation& at, int b, int node_index, const MatrixXd& G) {
    const records::FlexBody* own = find_flex(b);
    const int node = tree[b].body.nodes()[static_cast<size_t>(node_index)].id;
    if (own == nullptr || G.isZero(0) || has_static_shape(*own, node, tree[b].num_modes())) return;
    const double missed = calc_missed(tree[b].body, G);
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

  const auto data = system.make_data();
  VectorXd q = VectorXd::Zero(system.num_q()), u = VectorXd::Zero(system.num_u());
  system.calc_initial_state(q, u);
  calc_kinematics(system, *data, system.start, q, u);
  for (int b = 0; b < tree.size(); ++b) {
    const TreeBody& tb = tree[b];
    if (tb.parent >= 0 || !tb.on_child.moves) continue;
    const auto nu = tb.num_hinge_u();
    if (nu == 6) continue;
    MatrixXd W = MatrixXd::Identity(6, 6);
    if (nu > 0) W = Eigen::FullPivLU<MatrixXd>(data->tree[b].hinge.H.leftCols(nu).transpose()).kernel();
    const MarkerMotion& m = data->tree.markers[static_cast<size_t>(tb.child_marker)];
    const Matrix3d R_HpB = tb.on_parent.R_KM.transpose() * data->tree[b].state.R_WB;
    MatrixXd J = m.J;
    J.topRows(3) = R_HpB * m.J.topRows(3);
    J.bottomRows(3) = R_HpB * m.J.bottomRows(3);
    report("hinge " + quote(tb.hinge_name), tb.hinge_at, b, tb.on_child.node, W.transpose() * J);
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
               G.block(row, tree[end.body].eta_dot_offset(), count, tree[end.body].num_modes()));
      }
      row += count;
    }
  }
}

}  // namespace bough::solver
