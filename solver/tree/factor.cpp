// Articulated inertia, tip to base: Featherstone, "Rigid Body Dynamics Algorithms" (2008), table 7.1; modal coordinates
// as extra mobilizer coordinates: Jain & Rodriguez, JGCD 15(6) 1992. With ℋ = [H -Jc; 0 1] over [u_h; η̇], H the free
// columns:
//   W = 𝒫ℋ, D = ℋᵀW, G = D⁻¹ W_topᵀ, 𝒫⁺ = 𝒫_66 - W_top G;   parent: 𝒫 += Xᵀ𝒫⁺X.
// With D = LLᵀ a flexible body stops halfway: G = L⁻¹W_topᵀ, 𝒫⁺ = 𝒫_66 - GᵀG; [D; W_top] becomes [L; Gᵀ] in place.
#include <cmath>
#include <sstream>

#include "solver/bodies/kernels.hpp"
#include "solver/tree/gimbal_lock.hpp"
#include "solver/tree/hinge_sizes.hpp"

namespace bough::solver {

namespace {

constexpr double kLocked = 1e-5;  // its square, next to kMinPivotShare, is for want of a direction, not of mass

// Bound of (Hᵀ 𝒫 H)_ii before anything of it cancels.
double calc_size(const BodyData& d, const ConstVectorRef& column) {
  const double root = std::sqrt(d.mass_carried) * column.head<3>().norm() +
                      std::sqrt(std::max(0.0, d.second_moment)) * column.tail<3>().norm();
  return root * root;
}

[[noreturn]] void fail_indefinite(const TreeBody& tb, const BodyData& d, int pivot, double t) {
  std::ostringstream what;
  if (const std::string lock = describe_gimbal_lock(tb, d, kLocked); pivot < d.num_free && !lock.empty()) {
    what << lock << ", at t = " << t;
    throw ComputationError("solver.gimbal-lock", tb.hinge_at, what.str(), kGimbalAdvice);
  }
  what << "the articulated mass matrix of body '" << tb.name << "' is not positive definite at t = " << t << ": ";
  if (pivot < d.num_free) {
    what << "almost no mass moves along coordinate " << d.free[pivot] + 1 << " of its hinge '" << tb.hinge_name << "'";
  } else {
    what << "almost no mass moves with its modal coordinate " << pivot - d.num_free + 1;
  }
  throw ComputationError("solver.indefinite-mass", tb.hinge_at, what.str(),
                         pivot < d.num_free
                             ? "give the body, or one that it carries, mass and inertia along that coordinate"
                             : "its mass integrals do not belong to one mass matrix, or its modes do what its hinge "
                               "does: write the file again with reduce, or keep fewer modes");
}

// `added`: of the hinge's coordinates, free or not.
template <int NH>
void factor_rigid(const TreeBody& tb, BodyData& d, const double* added, double t, Matrix6d& passed) {
  if constexpr (NH == 0) {
    passed = d.P6;
  } else {
    const auto H = d.H.leftCols<NH>();
    const Eigen::Matrix<double, 6, NH> W = d.P6 * H;
    Eigen::Matrix<double, NH, NH> D = H.transpose() * W;
    for (int i = 0; i < NH; ++i) {  // Cholesky, so that a bad pivot has a name
      double pivot = D(i, i) + added[d.free[i]];
      for (int k = 0; k < i; ++k) pivot -= D(i, k) * D(i, k);
      if (!(pivot > kMinPivotShare * calc_size(d, d.H.col(i)))) fail_indefinite(tb, d, i, t);
      D(i, i) = std::sqrt(pivot);
      for (int j = i + 1; j < NH; ++j) {
        double below = D(j, i);
        for (int k = 0; k < i; ++k) below -= D(j, k) * D(i, k);
        D(j, i) = below / D(i, i);
      }
    }
    Eigen::Matrix<double, NH, 6> G = W.transpose();
    if constexpr (NH == 1) {
      d.D6(0, 0) = 1 / (D(0, 0) * D(0, 0));
      G *= d.D6(0, 0);
    } else {
      D.template triangularView<Eigen::Lower>().solveInPlace(G);
      D.template triangularView<Eigen::Lower>().transpose().solveInPlace(G);
      d.D6.topLeftCorner<NH, NH>() = D;
    }
    d.G6.topRows<NH>() = G;
    passed.noalias() = d.P6 - W * G;
  }
}

void factor_rigid(const TreeBody& tb, BodyData& d, const double* added, double t, Matrix6d& passed) {
  BOUGH_DEMAND(d.num_free <= 6);
  with_size(d.num_free, [&](auto size) { factor_rigid<size>(tb, d, added, t, passed); });
}

// [D; W_top]; of D the lower triangle counts.
void set_D(const TreeBody& tb, const TreeData& data, BodyData& d) {
  const Eigen::Index n = tb.num_modes(), nh = d.num_free;
  auto W = d.D.middleRows<6>(nh + n);
  auto modal = d.D.block(nh, nh, n, n);
  const Matrix6Xd& P_top = get_P_top(tb, d);
  const MatrixXd& P_modal = tb.carries_on_modes ? d.P_modal : d.inertia.M_modal;
  for (Eigen::Index j = 0; j < n; ++j) {
    const double *from = P_modal.col(j).data(), *top = P_top.col(j).data();
    double* to = d.D.col(nh + j).data() + nh;
    for (Eigen::Index k = j; k < n; ++k) to[k] = from[k];
    for (int k = 0; k < 6; ++k) to[n + k] = top[k];
  }
  for (Eigen::Index i = 0; i < nh; ++i) {
    W.col(i).noalias() = d.P6 * d.H.col(i);
    d.D.col(i).segment(nh, n) = P_top.transpose().lazyProduct(d.H.col(i));
    for (Eigen::Index k = i; k < nh; ++k) d.D(k, i) = d.H.col(k).dot(W.col(i));
  }
  if (tb.on_child.moves) {
    modal.noalias() -= P_top.transpose() * d.Jc;
    W.rightCols(n).noalias() -= d.P6 * d.Jc;
    modal.noalias() -= d.Jc.transpose() * W.rightCols(n);
    for (Eigen::Index i = 0; i < nh; ++i) d.D.col(i).segment(nh, n).noalias() -= d.Jc.transpose() * W.col(i);
  }
  for (Eigen::Index i = 0; i < nh; ++i) d.D(i, i) += data.added[tb.u_offset + d.free[i]];
  if (data.added_K != 0) modal += data.added_K * tb.body.K() + data.added_D * tb.body.D();
}

// The first pivot of the flexible body's D that is too small, or -1; after it D holds no factor any more.
int find_bad_pivot(const TreeBody& tb, const TreeData& data, BodyData& d) {
  set_D(tb, data, d);
  const auto size = d.D.cols();
  for (Eigen::Index i = 0; i < size; ++i) {
    const double own = i < d.num_free ? calc_size(d, d.H.col(i)) : d.modal_size[i - d.num_free];
    const double pivot = d.D(i, i) - d.D.row(i).head(i).squaredNorm();
    if (!(pivot > kMinPivotShare * own)) return static_cast<int>(i);
    d.D(i, i) = std::sqrt(pivot);
    for (Eigen::Index j = i + 1; j < size; ++j)
      d.D(j, i) = (d.D(j, i) - d.D.row(j).head(i).dot(d.D.row(i).head(i))) / d.D(i, i);
  }
  return -1;
}

void factor_flexible(const TreeBody& tb, const TreeData& data, BodyData& d, Matrix6d& passed) {
  const Eigen::Index n = tb.num_modes(), nh = d.num_free;
  if (tb.on_child.moves) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double root = std::sqrt(d.modal_size[j]) + std::sqrt(calc_size(d, d.Jc.col(j)));
      d.modal_size[j] = root * root;
    }
  }
  set_D(tb, data, d);
  factor_trapezoid(d.D.data(), d.D.rows(), nh + n);
  bool good = true;
  for (Eigen::Index i = 0; i < nh && good; ++i)
    good = d.D(i, i) * d.D(i, i) > kMinPivotShare * calc_size(d, d.H.col(i));
  for (Eigen::Index j = 0; j < n && good; ++j)
    good = d.D(nh + j, nh + j) * d.D(nh + j, nh + j) > kMinPivotShare * d.modal_size[j];
  if (!good) fail_indefinite(tb, d, std::max(0, find_bad_pivot(tb, data, d)), data.t);
  passed = d.P6;
  const double* column = d.D.data() + nh + n;
  for (Eigen::Index j = 0; j < nh + n; ++j, column += d.D.rows()) {
    for (int c = 0; c < 6; ++c) {
      for (int r = 0; r < 6; ++r) passed(r, c) -= column[r] * column[c];
    }
  }
}

// S(r)ᵀR P Rᵀ S(r), R = R_PB, of a symmetric P.
void add_moved(const BodyData& d, const Matrix6d& from, Matrix6d& to) {
  const Matrix3d& R = d.R_PB;
  const Matrix3d R_BP = R.transpose(), r = skew(d.r_PoBo);
  const Matrix3d M = R * from.topLeftCorner<3, 3>() * R_BP;
  const Matrix3d C = R * from.topRightCorner<3, 3>() * R_BP;
  const Matrix3d I = R * from.bottomRightCorner<3, 3>() * R_BP;
  const Matrix3d N = C - M * r;
  to.topLeftCorner<3, 3>() += M;
  to.topRightCorner<3, 3>() += N;
  to.bottomLeftCorner<3, 3>() += N.transpose();
  to.bottomRightCorner<3, 3>() += I + r * N - C.transpose() * r;
}

void add_size(const BodyData& d, BodyData& P) {
  const double root = std::sqrt(std::max(0.0, d.second_moment)) + std::sqrt(d.mass_carried) * d.r_PoBo.norm();
  P.second_moment += root * root;
  P.mass_carried += d.mass_carried;
}

}  // namespace

void factor_body(const Tree& tree, int b, TreeData& data) {
  const TreeBody& tb = tree[b];
  BodyData& d = data[b];
  Matrix6d passed;
  if (tb.is_flexible()) {
    factor_flexible(tb, data, d, passed);
  } else {
    factor_rigid(tb, d, data.added.data() + tb.u_offset, data.t, passed);
  }
  if (tb.parent < 0) return;
  BodyData& P = data[tb.parent];
  if (tb.on_parent.moves) {
    d.PX.noalias() = passed * d.X;
    const auto X_modal = d.X.rightCols(P.P_top.cols()), PX_modal = d.PX.rightCols(P.P_top.cols());
    P.P6.noalias() += d.X.leftCols<6>().transpose() * d.PX.leftCols<6>();
    P.P_top.noalias() += d.X.leftCols<6>().transpose() * PX_modal;
    P.P_modal.noalias() += X_modal.transpose() * PX_modal;
    for (int j = 0; j < P.modal_size.size(); ++j) P.modal_size[j] += calc_size(d, d.X.col(6 + j));
  } else {
    add_moved(d, passed, P.P6);
  }
  add_size(d, P);
}

void calc_factor(const Tree& tree, TreeData& data) {
  data.demand(Stage::Position);
  if (data.has(Stage::Factor)) return;
  for (int b = tree.size() - 1; b >= 0; --b) factor_body(tree, b, data);
  data.done |= static_cast<unsigned>(Stage::Factor);
}

}  // namespace bough::solver
