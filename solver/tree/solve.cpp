// Forces to accelerations over the factored tree (see factor.cpp). Tip to base
//   β += 𝒫b,   e = τ - ℋᵀβ,   β⁺ = β_6 + W_top D⁻¹e;   parent: β += Xᵀβ⁺
// and base to tip u̇ = D⁻¹e - G X [A'_P; η̈_P]. A flexible body stops halfway at z = L⁻¹e.
#include "solver/bodies/kernels.hpp"
#include "solver/tree/data.hpp"
#include "solver/tree/hinge_sizes.hpp"

namespace bough::solver {

namespace {

template <int NH>
void solve_rigid(const BodyData& d, const double* tau, const Vector6d& beta, double* z, Vector6d& passed) {
  if constexpr (NH > 0) {
    Eigen::Matrix<double, NH, 1> e;
    for (int i = 0; i < NH; ++i) e[i] = tau[d.free[i]] - d.H.col(i).dot(beta);
    passed.noalias() = beta + d.G6.topRows<NH>().transpose() * e;
    if constexpr (NH == 1) {
      z[0] = d.D6(0, 0) * e[0];
    } else {
      const auto L = d.D6.topLeftCorner<NH, NH>();
      L.template triangularView<Eigen::Lower>().solveInPlace(e);
      L.template triangularView<Eigen::Lower>().transpose().solveInPlace(e);
      Eigen::Map<Eigen::Matrix<double, NH, 1>>{z} = e;
    }
  } else {
    passed = beta;
  }
}

void solve_rigid(const BodyData& d, const double* tau, const Vector6d& beta, double* z, Vector6d& passed) {
  with_size(d.num_free, [&](auto size) { solve_rigid<size>(d, tau, beta, z, passed); });
}

void solve_flexible(const TreeBody& tb, const BodyData& d, const double* tau, const ConstVectorRef& beta,
                    Eigen::Ref<VectorXd> z, Vector6d& passed) {
  const int n = tb.num_modes();
  z.tail(n) = -beta.tail(n);
  for (int i = 0; i < d.num_free; ++i) z[i] = tau[d.free[i]] - d.H.col(i).dot(beta.head<6>());
  if (tb.on_child.moves) z.tail(n).noalias() += d.Jc.transpose() * beta.head<6>();
  solve_lower(d.D.data(), d.D.rows(), z.size(), z.data());
  passed = beta.head<6>();
  passed.noalias() += d.D.middleRows<6>(z.size()) * z;
}

}  // namespace

void solve_to_base(const Tree& tree, int b, const TreeData& data, Sweep& s) {
  const TreeBody& tb = tree[b];
  const BodyData& d = data[b];
  Vector6d passed;
  if (tb.is_flexible()) {
    auto beta = s.beta.segment(tb.v_offset, 6 + tb.num_modes());
    beta.head<6>().noalias() += d.P6 * s.b.col(b);
    beta.tail(tb.num_modes()) += get_P_top(tb, d).transpose().lazyProduct(s.b.col(b));
    solve_flexible(tb, d, s.tau.data() + tb.u_offset, beta, s.z.segment(tb.u_offset, d.num_free + tb.num_modes()),
                   passed);
  } else {
    Vector6d beta = s.beta.segment<6>(tb.v_offset);
    beta.noalias() += d.P6 * s.b.col(b);
    s.beta.segment<6>(tb.v_offset) = beta;
    solve_rigid(d, s.tau.data() + tb.u_offset, beta, s.z.data() + tb.u_offset, passed);
  }
  if (tb.parent < 0) return;
  const TreeBody& parent = tree[tb.parent];
  if (tb.on_parent.moves) {
    s.beta.segment(parent.v_offset, 6 + parent.num_modes()).noalias() += d.X.transpose() * passed;
    return;
  }
  const Vector3d f = d.R_PB * passed.head<3>();
  s.beta.segment<3>(parent.v_offset) += f;
  s.beta.segment<3>(parent.v_offset + 3) += d.R_PB * passed.tail<3>() + d.r_PoBo.cross(f);
}

void solve_to_tip(const Tree& tree, int b, const TreeData& data, Sweep& s) {
  const TreeBody& tb = tree[b];
  const BodyData& d = data[b];
  const int n = tb.num_modes(), nh = d.num_free;
  const Vector6d A_P = tb.parent < 0 ? s.ground : Vector6d(s.A.col(tb.parent));
  Vector6d A;
  if (tb.on_parent.moves) {
    A = carry_by_modes(tree, tb, d, A_P, s.u_dot);
  } else {
    const Matrix3d R_BP = d.R_PB.transpose();
    const Vector3d alpha = A_P.tail<3>();
    A.head<3>().noalias() = R_BP * (A_P.head<3>() + alpha.cross(d.r_PoBo));
    A.tail<3>().noalias() = R_BP * alpha;
  }
  double* u_dot = s.u_dot.data() + tb.u_offset;
  if (n == 0) {
    double free[6];
    for (int i = 0; i < nh; ++i) free[i] = s.z[tb.u_offset + i] - d.G6.row(i).dot(A);
    A += s.b.col(b);
    for (int i = 0; i < nh; ++i) {
      A += d.H.col(i) * free[i];
      u_dot[d.free[i]] = free[i];
    }
  } else {
    auto z = s.z.segment(tb.u_offset, nh + n);
    z.noalias() -= d.D.middleRows<6>(z.size()).transpose() * A;
    solve_lower_transposed(d.D.data(), d.D.rows(), z.size(), z.data());
    A += s.b.col(b);
    for (int i = 0; i < nh; ++i) {
      A += d.H.col(i) * z[i];
      u_dot[d.free[i]] = z[i];
    }
    if (tb.on_child.moves) A.noalias() -= d.Jc * z.tail(n);
    s.u_dot.segment(tb.eta_dot_offset(), n) = z.tail(n);
  }
  s.A.col(b) = A;
}

namespace {

void start_solve(TreeData& data) {
  data.demand(Stage::Velocity);
  Sweep& s = data.motion;
  s.beta = data.h - data.applied;
  s.tau = data.hinge_force;
  s.ground << -data.gravity, Vector3d::Zero();
}

void finish_solve(const Tree& tree, TreeData& data, Eigen::Ref<VectorXd> u_dot) {
  Sweep& s = data.motion;
  for (int b = 0; b < tree.size(); ++b) {
    solve_to_tip(tree, b, data, s);
    BodyState& state = data[b].state;
    state.a_B = s.A.col(b).head<3>();
    state.a_B.noalias() += state.R_WB.transpose() * data.gravity;
    state.alpha_B = s.A.col(b).tail<3>();
  }
  data.done |= static_cast<unsigned>(Stage::Acceleration);
  for (int b = 0; b < tree.size(); ++b) {
    const TreeBody& tb = tree[b];
    if (data[b].num_free == tb.num_hinge_u()) continue;
    const HingeReaction r = calc_hinge_reaction(tree, data, b);
    for (int i = 0; i < tb.num_hinge_u(); ++i) {
      const int row = tb.u_offset + i;
      if (data.mode[static_cast<size_t>(row)] == HingeMode::Free) continue;
      const auto H = data[b].hinge.H.col(i);
      data.transmitted[row] = H.head<3>().dot(r.force) + H.tail<3>().dot(r.moment);
      if (tb.rotor.size() > 0) data.transmitted[row] += tb.rotor[i] * data.given_udot[row];
      s.u_dot[row] = data.given_udot[row];
    }
  }
  u_dot = s.u_dot;
}

}  // namespace

void solve(const Tree& tree, TreeData& data, Eigen::Ref<VectorXd> u_dot) {
  BOUGH_DEMAND(u_dot.size() == tree.num_u);
  data.demand(Stage::Factor);
  start_solve(data);
  for (int b = tree.size() - 1; b >= 0; --b) solve_to_base(tree, b, data, data.motion);
  finish_solve(tree, data, u_dot);
}

void factor_and_solve(const Tree& tree, TreeData& data, Eigen::Ref<VectorXd> u_dot) {
  if (data.has(Stage::Factor)) return solve(tree, data, u_dot);
  BOUGH_DEMAND(u_dot.size() == tree.num_u);
  data.demand(Stage::Position);
  start_solve(data);
  for (int b = tree.size() - 1; b >= 0; --b) {
    factor_body(tree, b, data);
    solve_to_base(tree, b, data, data.motion);
  }
  data.done |= static_cast<unsigned>(Stage::Factor);
  finish_solve(tree, data, u_dot);
}

namespace {

Vector6d calc_sweep_wrench(const Tree& tree, const TreeData& data, const Sweep& s, int b) {
  const TreeBody& tb = tree[b];
  const BodyData& d = data[b];
  const Vector6d A = s.A.col(b) - s.b.col(b);  // β holds 𝒫b already
  Vector6d wrench = s.beta.segment<6>(tb.v_offset);
  if (!tb.is_flexible()) return wrench + d.P6 * A;
  const int n = tb.num_modes();
  wrench.noalias() += d.P6 * A;
  wrench.noalias() += get_P_top(tb, d) * s.u_dot.segment(tb.eta_dot_offset(), n);
  return wrench;
}

// From Bo, in B, to the origin of Hc, in Hp.
HingeReaction move_to_hinge(const Tree& tree, const TreeData& data, int b, const Vector6d& wrench) {
  const TreeBody& tb = tree[b];
  const MarkerMotion& p = data.markers[static_cast<size_t>(tb.parent_marker)];
  const MarkerMotion& c = data.markers[static_cast<size_t>(tb.child_marker)];
  const Matrix3d R_HpB = p.R.transpose() * data[b].R_PB;
  const Vector3d f = wrench.head<3>(), t = wrench.tail<3>();
  return {R_HpB * f, R_HpB * (t - c.r.cross(f))};
}

}  // namespace

Vector6d calc_hinge_wrench(const Tree& tree, const TreeData& data, int b) {
  data.demand(Stage::Acceleration);
  return calc_sweep_wrench(tree, data, data.motion, b);
}

HingeReaction calc_hinge_reaction(const Tree& tree, const TreeData& data, int b) {
  return move_to_hinge(tree, data, b, calc_hinge_wrench(tree, data, b));
}

double calc_jump_impulse(const Tree& tree, const TreeData& data, int b, int i) {
  data.demand(Stage::Factor);
  const HingeReaction r = move_to_hinge(tree, data, b, calc_sweep_wrench(tree, data, data.response, b));
  const auto H = data[b].hinge.H.col(i);
  const double rotor = tree[b].rotor.size() > 0 ? tree[b].rotor[i] * data.response.u_dot[tree[b].u_offset + i] : 0;
  return H.head<3>().dot(r.force) + H.tail<3>().dot(r.moment) + rotor;
}

}  // namespace bough::solver
