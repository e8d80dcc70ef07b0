// Checks of a flexible body at η = 0: inertia left at its hinge by the modes, integrals of one mass distribution.
#include <cmath>
#include <cstdio>

#include "solver/builder/build.hpp"

namespace bough::solver {

namespace {

constexpr double kSpanned = 1e-3;       // of the rigid inertia
constexpr double kInconsistent = 1e-3;  // of the modal mass

// The hinge's free columns at Bo, in B, at the initial coordinates; the child's end does not move.
MatrixXd calc_hinge_columns(const TreeBody& tb) {
  HingeMotion motion;
  const VectorXd rate = VectorXd::Zero(6);
  tb.hinge->calc_motion(tb.initial_q.data(), rate.data(), motion);
  const Matrix3d R = tb.on_child.R_KM * motion.R_HpHc.transpose();  // R_BHp
  const Vector3d r = tb.body.nodes()[static_cast<size_t>(tb.on_child.node)].p + tb.on_child.p_KM;
  MatrixXd H(6, tb.count(HingeMode::Free));
  for (int i = 0, free = 0; i < tb.num_hinge_u(); ++i) {
    if (tb.mode[static_cast<size_t>(i)] != HingeMode::Free) continue;
    const Vector3d angular = R * motion.H.col(i).tail<3>();
    H.col(free++) << R * motion.H.col(i).head<3>() + r.cross(angular), angular;
  }
  return H;
}

void check_hinge(const TreeBody& tb, const records::BodyRecord& record, Diagnostics& diagnostics) {
  if (tb.count(HingeMode::Free) == 0 || tb.on_child.moves) return;
  const int n = tb.body.num_modes();
  BodyInertia x = tb.body.make_inertia();
  tb.body.calc_inertia(Vector3d::Zero(), VectorXd::Zero(n), VectorXd::Zero(n), x);
  const MatrixXd H = calc_hinge_columns(tb), coupling = H.transpose() * x.M_top;
  const MatrixXd rigid = H.transpose() * x.M6 * H;
  const Eigen::LLT<MatrixXd> modes(x.M_modal.topLeftCorner(n, n));
  if (modes.info() != Eigen::Success || Eigen::LLT<MatrixXd>(rigid).info() != Eigen::Success) return;
  const MatrixXd left = rigid - coupling * modes.solve(coupling.transpose());
  const double min_share = Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(left, rigid).eigenvalues()[0];
  if (min_share > kSpanned) return;
  char percent[32];
  std::snprintf(percent, sizeof percent, "%.2g", 100 * std::max(0.0, min_share));
  diagnostics.note("system.spanned-hinge", record.at,
                   "the modes of body " + quote(tb.name) + ", clamped at its free hinge " + quote(tb.hinge_name) +
                       ", leave " + percent + " % of the inertia about it: the run takes short steps",
                   "reduce the body with frame = \"mean\" and the hinge's node in 'interface', or keep fewer modes");
}

// The Gram matrix of e_a × φ_j and φ_j, minus its projection on the affine functions, has no negative eigenvalue if one
// mass distribution gives all integrals.
bool is_gram(const records::FlexBody& flex, const AffineField& field, int n) {
  const auto& integrals = flex.integrals();
  const Eigen::Index size = 4 * static_cast<Eigen::Index>(n);
  MatrixXd own = MatrixXd::Zero(size, size), affine(12, size);
  VectorXd scale(size);
  for (int j = 0; j < n; ++j) {
    const auto sj = static_cast<size_t>(j);
    const Eigen::Map<const AffineField::Amplitudes> L(field.L.col(j).data());
    affine.col(3 * n + j) = field.L.col(j);
    scale[3 * n + j] = 1 / std::sqrt(flex.modal_mass(j, j));
    for (int a = 0; a < 3; ++a) {
      const AffineField::Amplitudes turned = skew(Vector3d(Vector3d::Unit(a))) * L;
      affine.col(3 * j + a) = Eigen::Map<const Eigen::Matrix<double, 12, 1>>(turned.data());
      scale[3 * j + a] = scale[3 * n + j];
    }
    for (int k = 0; k < n; ++k) {
      own.block<3, 3>(3 * j, 3 * k) = integrals.gamma4[static_cast<size_t>(k)][sj];
      own.block<3, 1>(3 * j, 3 * n + k) = integrals.gamma2[sj].col(k);
      own.block<1, 3>(3 * n + k, 3 * j) = integrals.gamma2[sj].col(k).transpose();
      own(3 * n + j, 3 * n + k) = flex.modal_mass(j, k);
    }
  }
  MatrixXd rest = own - affine.transpose() * affine;
  rest = scale.asDiagonal() * (0.5 * (rest + rest.transpose())) * scale.asDiagonal();
  rest.diagonal().array() += kInconsistent;
  return Eigen::LLT<MatrixXd>(rest).info() == Eigen::Success;
}

}  // namespace

void check_flexible_body(const TreeBody& tb, const records::FlexBody& flex, const records::BodyRecord& record,
                         Diagnostics& diagnostics) {
  if (tb.hinge) check_hinge(tb, record, diagnostics);
  if (!(tb.body.mass() > 0) || is_gram(flex, tb.body.field(), tb.body.num_modes())) return;
  diagnostics.note("system.inconsistent-integrals", record.at,
                   "the '" + flex.integrals_method + "' mass integrals in '" + record.file + "' (body " +
                       quote(tb.name) +
                       ") are not those of one mass distribution: its kinetic energy could become "
                       "negative at large deflections",
                   "if the run stops with solver.indefinite-mass, take another set of integrals");
}

}  // namespace bough::solver
