// Articulated-body recursion: Featherstone, "Rigid Body Dynamics Algorithms" (2008), table 7.1; modal coordinates as
// extra mobilizer coordinates: Jain & Rodriguez, JGCD 15(6) 1992. With ℋ = [H -Jc; 0 1] over [u_h; η̇]:
//   W = 𝒫ℋ, D = ℋᵀW, G = D⁻¹ W_topᵀ, 𝒫⁺ = 𝒫_66 - W_top G, z = D⁻¹(τ - ℋᵀ(β + 𝒫b)), β⁺ = (β + 𝒫b)_6 + W_top z,
//   parent: 𝒫 += Xᵀ𝒫⁺X, β += Xᵀβ⁺;   then u̇ = z - G X [A'_P; η̈_P].
// With D = LLᵀ a flexible body stops halfway, G = L⁻¹W_topᵀ and z likewise: 𝒫⁺ = 𝒫_66 - GᵀG, u̇ = L⁻ᵀ(z - G X [..]).
#include "solver/tree/tree.hpp"

namespace bough::solver {

namespace {

struct Reduced {  // what a body passes on to its parent, at Bo, in B
  Matrix6d P;
  Vector6d beta;
};

[[noreturn]] void fail_indefinite(const TreeBody& tb) {
  throw ComputationError(
      "solver.indefinite-mass", {}, "the articulated mass matrix of body '" + tb.name + "' is not positive definite",
      tb.body.num_modes() > 0
          ? "its mass integrals do not belong to one mass matrix, or its hinge moves no mass: write the file anew with "
            "reduce"
          : "give the body, or one that it carries, mass and inertia along its hinge freedoms");
}

template <int NH>
void eliminate_rigid(const TreeBody& tb, BodyData& d, Reduced& out) {
  out.beta.noalias() = d.beta + d.P6 * d.b;
  if constexpr (NH == 0) {
    out.P = d.P6;
  } else {
    const auto H = d.H.leftCols<NH>();
    const Eigen::Matrix<double, 6, NH> U = d.P6 * H;
    const Eigen::Matrix<double, NH, NH> D = H.transpose() * U;
    const Eigen::Matrix<double, NH, 1> e = d.hinge_force.head<NH>() - H.transpose() * out.beta;
    Eigen::Matrix<double, NH, 6> G;
    Eigen::Matrix<double, NH, 1> z;
    if constexpr (NH == 1) {
      if (!(D(0, 0) > 0)) fail_indefinite(tb);
      const double inverse = 1 / D(0, 0);
      G = inverse * U.transpose();
      z = inverse * e;
    } else {
      const Eigen::LLT<Eigen::Matrix<double, NH, NH>> llt(D);
      if (llt.info() != Eigen::Success) fail_indefinite(tb);
      G = llt.solve(U.transpose());
      z = llt.solve(e);
    }
    d.G6.topRows<NH>() = G;
    d.z.head<NH>() = z;
    out.P.noalias() = d.P6 - U * G;
    out.beta.noalias() += U * z;
  }
}

void eliminate_rigid(const TreeBody& tb, BodyData& d, Reduced& out) {
  switch (tb.num_hinge_u) {
    case 0:
      return eliminate_rigid<0>(tb, d, out);
    case 1:
      return eliminate_rigid<1>(tb, d, out);
    case 2:
      return eliminate_rigid<2>(tb, d, out);
    case 3:
      return eliminate_rigid<3>(tb, d, out);
    case 6:
      return eliminate_rigid<6>(tb, d, out);
    default:
      BOUGH_DEMAND(false);
  }
}

void eliminate_flexible(const TreeBody& tb, BodyData& d, Reduced& out) {
  const int n = tb.body.num_modes(), nh = tb.num_hinge_u;
  const auto H = d.H.leftCols(nh);
  d.beta.noalias() += d.P.leftCols<6>() * d.b;  // β + 𝒫b
  d.W.rightCols(n) = d.P.rightCols(n);
  for (int i = 0; i < nh; ++i) d.W.col(i).noalias() = d.P.leftCols<6>() * H.col(i);
  auto z = d.Gz.col(6);
  z.tail(n) = -d.beta.tail(n);
  for (int i = 0; i < nh; ++i) z[i] = d.hinge_force[i] - H.col(i).dot(d.beta.head<6>());
  if (tb.on_child.moves) {
    d.W.rightCols(n).noalias() -= d.P.leftCols<6>() * d.Jc;
    z.tail(n).noalias() += d.Jc.transpose() * d.beta.head<6>();
  }
  d.D.bottomRows(n) = d.W.bottomRows(n);
  for (int i = 0; i < nh; ++i) d.D.row(i).noalias() = H.col(i).transpose() * d.W.topRows<6>();
  if (tb.on_child.moves) d.D.bottomRows(n).noalias() -= d.Jc.transpose() * d.W.topRows<6>();
  const Eigen::LLT<Eigen::Ref<MatrixXd>> D_factor(d.D);  // in place
  if (D_factor.info() != Eigen::Success) fail_indefinite(tb);
  d.Gz.leftCols<6>() = d.W.topRows<6>().transpose();
  d.D.triangularView<Eigen::Lower>().solveInPlace(d.Gz);
  const auto G = d.Gz.leftCols<6>();
  out.P = d.P.topLeftCorner<6, 6>();
  out.P.noalias() -= G.transpose() * G;
  out.beta = d.beta.head<6>();
  out.beta.noalias() += G.transpose() * z;
}

// [S(r)ᵀR P Rᵀ S(r)] and the wrench moved likewise, R = R_PB.
void move_to_parent(const BodyData& d, const Reduced& from, Reduced& to) {
  const Matrix3d& R = d.R_PB;
  const Matrix3d R_BP = R.transpose(), r = skew(d.r_PoBo);
  const Matrix3d M = R * from.P.topLeftCorner<3, 3>() * R_BP;
  const Matrix3d C = R * from.P.topRightCorner<3, 3>() * R_BP;
  const Matrix3d I = R * from.P.bottomRightCorner<3, 3>() * R_BP;
  const Matrix3d N = C - M * r;
  to.P.topLeftCorner<3, 3>() = M;
  to.P.topRightCorner<3, 3>() = N;
  to.P.bottomLeftCorner<3, 3>() = N.transpose();
  to.P.bottomRightCorner<3, 3>() = I + r * N - C.transpose() * r;
  const Vector3d f = R * from.beta.head<3>();
  to.beta.head<3>() = f;
  to.beta.tail<3>() = R * from.beta.tail<3>() + d.r_PoBo.cross(f);
}

void add_to_parent(const TreeBody& tb, const TreeBody& parent, BodyData& d, const Reduced& reduced, BodyData& P) {
  if (tb.on_parent.moves) {
    d.PX.noalias() = reduced.P * d.X;
    P.P.noalias() += d.X.transpose() * d.PX;
    P.beta.noalias() += d.X.transpose() * reduced.beta;
    return;
  }
  Reduced moved;
  move_to_parent(d, reduced, moved);
  if (parent.body.num_modes() == 0) {
    P.P6 += moved.P;
    P.beta.head<6>() += moved.beta;
  } else {
    P.P.topLeftCorner<6, 6>() += moved.P;
    P.beta.head<6>() += moved.beta;
  }
}

void calc_body_acceleration(const Tree& tree, int b, TreeData& data, Eigen::Ref<VectorXd>& u_dot) {
  const TreeBody& tb = tree.bodies[static_cast<size_t>(b)];
  BodyData& d = data.bodies[static_cast<size_t>(b)];
  const BodyData& P = data.parent_of(tb);
  const int n = tb.body.num_modes(), nh = tb.num_hinge_u;
  Vector6d A;
  if (tb.on_parent.moves) {
    const TreeBody& parent = tree.bodies[static_cast<size_t>(tb.parent)];
    const int m = parent.body.num_modes();
    Vector6d A_P;
    A_P << P.a_less_g, P.state.alpha_B;
    A.noalias() = d.X.leftCols<6>() * A_P;
    A.noalias() += d.X.rightCols(m) * u_dot.segment(parent.eta_dot_offset(), m);
  } else {
    A.head<3>() = d.R_PB.transpose() * (P.a_less_g + P.state.alpha_B.cross(d.r_PoBo));
    A.tail<3>() = d.R_PB.transpose() * P.state.alpha_B;
  }
  auto u_dot_b = u_dot.segment(tb.u_offset, nh + n);
  if (n == 0) {
    u_dot_b = d.z;
    for (int i = 0; i < nh; ++i) u_dot_b[i] -= d.G6.row(i).dot(A);
  } else {
    u_dot_b = d.Gz.col(6);
    u_dot_b.noalias() -= d.Gz.leftCols<6>() * A;
    d.D.transpose().triangularView<Eigen::Upper>().solveInPlace(u_dot_b);
  }
  d.eta_ddot = u_dot_b.tail(n);
  A += d.b;
  for (int i = 0; i < nh; ++i) A += d.H.col(i) * u_dot_b[i];
  if (tb.on_child.moves) A.noalias() -= d.Jc * u_dot_b.tail(n);
  d.a_less_g = A.head<3>();
  d.state.alpha_B = A.tail<3>();
  d.state.a_B = d.a_less_g + d.state.R_WB.transpose() * data.gravity;
  if (tb.is_prescribed()) {  // the wrench at Bo that makes the body move so, on H
    Vector6d wrench;
    if (n == 0) {
      wrench = d.beta.head<6>() + d.P6 * A;
    } else {
      // d.beta already holds β + 𝒫b
      wrench = d.beta.head<6>();
      wrench.noalias() += d.P.topLeftCorner<6, 6>() * (A - d.b);
      wrench.noalias() += d.P.topRightCorner(6, n) * u_dot_b.tail(n);
    }
    for (int i = 0; i < tb.hinge->num_u(); ++i) d.hinge_force[i] = d.H.col(i).dot(wrench);
  }
}

}  // namespace

void calc_tree_accelerations(const Tree& tree, TreeData& data, Eigen::Ref<VectorXd> u_dot) {
  BOUGH_DEMAND(u_dot.size() == tree.num_u);
  const int num = static_cast<int>(tree.bodies.size());
  for (int b = 0; b < num; ++b) {
    const TreeBody& tb = tree.bodies[static_cast<size_t>(b)];
    BodyData& d = data.bodies[static_cast<size_t>(b)];
    if (tb.body.num_modes() == 0) {
      d.P6 = tb.body.M6();
    } else {
      d.P = d.inertia.M;
    }
    d.beta = d.inertia.h - d.applied;
  }
  Reduced reduced;
  for (int b = num - 1; b >= 0; --b) {
    const TreeBody& tb = tree.bodies[static_cast<size_t>(b)];
    BodyData& d = data.bodies[static_cast<size_t>(b)];
    if (tb.body.num_modes() == 0) {
      eliminate_rigid(tb, d, reduced);
    } else {
      eliminate_flexible(tb, d, reduced);
    }
    if (tb.parent >= 0) {
      add_to_parent(tb, tree.bodies[static_cast<size_t>(tb.parent)], d, reduced,
                    data.bodies[static_cast<size_t>(tb.parent)]);
    }
  }
  data.ground.a_less_g = -data.gravity;
  for (int b = 0; b < num; ++b) calc_body_acceleration(tree, b, data, u_dot);
}

}  // namespace bough::solver
