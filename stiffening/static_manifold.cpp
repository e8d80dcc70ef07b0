#include "stiffening/static_manifold.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "fe/corotational/chord_series.hpp"
#include "fe/corotational/corotational_element.hpp"
#include "fe/corotational/mean_series.hpp"
#include "fe/corotational/series.hpp"
#include "fe/elements/carried.hpp"
#include "fe/linear/blas.hpp"
#include "fe/linear/products.hpp"
#include "fe/loads/inertial_loads.hpp"
#include "fe/model/element_loop.hpp"
#include "fe/model/model_size.hpp"
#include "stiffening/large_modes.hpp"

namespace bough::stiffening {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using fe::kSeriesTop;
using fe::SeriesVector;

/// Negligible inertia about an axis, relative to the largest.
constexpr double kNoInertia = 1e-8;
/// Reciprocal of the relative difference below which two compliances are alike.
constexpr double kComplianceSteps = 1e4;
constexpr int kMinElementsOfThread = 50;

std::vector<int> list_gdofs(const fe::Node& node) {
  std::vector<int> gdofs(static_cast<std::size_t>(node.num_dofs));
  std::iota(gdofs.begin(), gdofs.end(), node.first_gdof);
  return gdofs;
}

/// Rows of a grid's translations and rotations among the dofs of an element; -1: none.
struct NodeRows {
  int node = 0;
  Index translations = -1, rotations = -1;
};

std::vector<NodeRows> find_rows(const fe::Element& element, const std::vector<fe::Node>& nodes) {
  const auto& gdofs = element.gdofs();
  std::vector<NodeRows> rows;
  for (const int k : element.nodes()) {
    if (std::any_of(rows.begin(), rows.end(), [&](const NodeRows& r) { return r.node == k; })) continue;
    const fe::Node& node = nodes[static_cast<std::size_t>(k)];
    const auto find = [&](int gdof) -> Index {
      const auto at = std::find(gdofs.begin(), gdofs.end(), gdof);
      return at == gdofs.end() ? -1 : at - gdofs.begin();
    };
    if (node.num_dofs == 6) rows.push_back({k, find(node.first_gdof), find(node.first_gdof + 3)});
  }
  return rows;
}

/// One order of (R - 1) arm - θ × arm at each point. theta: 3 x top points.
Eigen::Matrix3Xd calc_turned_arm(const MatrixXd& theta, int top, const Vector3d& arm, int order) {
  Eigen::Matrix3Xd moved(3, theta.cols() / top);
  const auto at = static_cast<std::size_t>(order);
  for (Index p = 0; p < moved.cols(); ++p) {
    const SeriesVector angle = fe::get_vector(theta.middleCols(top * p, top), 0);
    moved.col(p) = fe::calc_arm_motion(angle, arm)[at] - angle[at].cross(arm);
  }
  return moved;
}

/// Tᵀ(R arm × force) - arm × force: 3 x top points.
Eigen::Matrix3Xd calc_turned_moment(const MatrixXd& theta, int top, const Vector3d& arm, const MatrixXd& force) {
  Eigen::Matrix3Xd moment(3, theta.cols());
  for (Index c = 0; c < theta.cols(); c += top) {
    const SeriesVector f = fe::get_vector(force.middleCols(c, top), 0);
    const SeriesVector angle = fe::get_vector(theta.middleCols(c, top), 0);
    SeriesVector turned = fe::calc_arm_moment(angle, arm, f);
    for (std::size_t k = 0; k < turned.size(); ++k) turned[k] -= arm.cross(f[k]);
    fe::put_vector(turned, 0, moment.middleCols(c, top));
  }
  return moment;
}

}  // namespace

bool has_stiffness(const fe::Element& element) {
  MatrixXd K = MatrixXd::Zero(element.num_dofs(), element.num_dofs());
  element.add_stiffness(1, K);
  return !K.isZero(0);
}

MatrixXd calc_monomials(const Eigen::MatrixXi& exponents, const MatrixXd& amplitudes) {
  MatrixXd values = MatrixXd::Ones(amplitudes.rows(), exponents.rows());
  for (Index p = 0; p < values.rows(); ++p)
    for (Index i = 0; i < values.cols(); ++i)
      for (Index j = 0; j < exponents.cols(); ++j)
        for (int e = 0; e < exponents(i, j); ++e) values(p, i) *= amplitudes(p, j);
  return values;
}

MatrixXd spread(const MatrixXd& points, const std::vector<int>& large, Index n) {
  MatrixXd all = MatrixXd::Zero(points.rows(), n);
  all(Eigen::all, large) = points;
  return all;
}

Lattice::Lattice(int n, int degree) : exponents_(records::list_exponents(n, degree)) {
  points_ = exponents_.cast<double>() / degree;
  factor_.compute(calc_monomials(exponents_, points_));
}

void unscale(const Eigen::MatrixXi& exponents, const VectorXd& scale, MatrixXd& c) {
  for (Eigen::Index i = 0; i < exponents.rows(); ++i)
    for (Eigen::Index j = 0; j < exponents.cols(); ++j)
      for (int e = 0; e < exponents(i, j); ++e) c.col(i) /= scale[j];
}

VectorXd fit_energy(const Lattice& lattice, const MatrixXd& forces, int degree) {
  const MatrixXd work = forces.cwiseProduct(lattice.points().transpose());
  return lattice.fit(work.colwise().sum() / degree).transpose();
}

StaticManifold::StaticManifold(const BodyRequest& request, const fe::Model& model, const ModalBasis& basis,
                               const StaticSupport& support, const linear::SymmetricMatrix& M)
    : model_(model),
      support_(support),
      arms_(model),
      means_(request.deck, model, arms_),
      eigenvalue_(basis.eigenvalue) {
  for (const fe::RigidArm& arm : arms_.list())
    if (arm.translates && !arm.arm.isZero(0)) followers_.push_back(arm.node);
  for (const fe::MeanTie& tie : means_.list()) followers_.push_back(tie.node);
  std::sort(followers_.begin(), followers_.end());
  const Index n = basis.Phi.cols();
  scale_.resize(n);
  for (Index j = 0; j < n; ++j) scale_[j] = 1 / std::sqrt(basis.stiffness(j, j));  // a shape of unit strain energy
  Phi_ = basis.Phi * scale_.asDiagonal();
  K_ = scale_.asDiagonal() * basis.stiffness * scale_.asDiagonal();
  mass_ = scale_.asDiagonal() * basis.mass * scale_.asDiagonal();
  K_factor_.compute(K_);
  set_rigid_motions(request, M);
  if (has_frame_) set_loads(request, basis, M);
}

void StaticManifold::turn(const MatrixXd& D) {
  BOUGH_DEMAND(fields_.empty() && turned_.size() == 0);
  turned_ = D.transpose() * K_ * scale_.cwiseInverse().asDiagonal();
  Phi_ *= D;
  if (psi_.size() > 0) {
    psi_ *= D;
    W_ *= D;
  }
  K_ = D.transpose() * K_ * D;
  K_factor_.compute(K_);
  // The amplitude of a combination has the unit of a mode's: it is of unit modal mass.
  eigenvalue_ = (D.transpose() * mass_ * D).diagonal().cwiseInverse();
  scale_ = eigenvalue_.cwiseSqrt().cwiseInverse();
}

void StaticManifold::set_rigid_motions(const BodyRequest& request, const linear::SymmetricMatrix& M) {
  if (!request.is_free()) return;
  Phi_R_ = model_.calc_rigid_modes();
  C_ = request.moves_to_frame()
           ? MatrixXd(modal::bases::calc_reference_conditions(model_, make_frame_spec(request.spec)).transpose())
           : linear::multiply(M, Phi_R_);
  const MatrixXd CR = C_.transpose() * Phi_R_;
  const VectorXd unit = CR.rowwise().norm().cwiseMax(1e-300).cwiseInverse();
  const Eigen::FullPivLU<MatrixXd> factor(unit.asDiagonal() * CR);
  has_frame_ = factor.rcond() > kNoInertia;
  if (!has_frame_) return;
  CR_inverse_ = factor.inverse() * unit.asDiagonal();
}

void StaticManifold::set_loads(const BodyRequest& request, const ModalBasis& basis, const linear::SymmetricMatrix& M) {
  psi_ = Phi_;
  if (request.is_free()) {  // of a body whose frame does not hold it
    const MatrixXd M_R = linear::multiply(M, Phi_R_);
    psi_ -= Phi_R_ * (Phi_R_.transpose() * M_R).ldlt().solve(linear::calc_inner_products(M_R, Phi_));
  }
  const MatrixXd M_psi = linear::multiply(M, psi_);
  const MatrixXd mass = linear::calc_inner_products(psi_, M_psi);
  const MatrixXd eigenvalues = mass.ldlt().solve(K_);
  psi_ = psi_ * eigenvalues;
  W_ = M_psi * eigenvalues;
  for (Index j = 0; j < psi_.cols(); ++j) {  // loads of residual vectors act on the grids that carry arms
    if (basis.kind[static_cast<std::size_t>(j)] == records::ModeKind::Normal) continue;
    psi_.col(j).setZero();
    W_.col(j).setZero();
  }
}

MatrixXd StaticManifold::solve(const MatrixXd& R) const {
  MatrixXd F = -R;
  if (C_.size() > 0)  // the frame's condition takes what has a resultant
    F += C_ * (CR_inverse_.transpose() * linear::calc_inner_products(Phi_R_, R));
  MatrixXd u = support_.solve(F);
  u -= Phi_ * K_factor_.solve(linear::calc_inner_products(Phi_, F));
  if (C_.size() > 0) u -= Phi_R_ * (CR_inverse_ * linear::calc_inner_products(C_, u));
  return u;
}

StaticManifold::Curves StaticManifold::make_curves(const MatrixXd& points, int top) const {
  Curves curves{top, points.transpose(), {}, {}};
  const int N = static_cast<int>(large_.size()), n = static_cast<int>(points.cols());
  for (int degree = 2; degree < 2 + static_cast<int>(fields_.size()) && degree <= top; ++degree) {
    const MatrixXd values = degree == 2
                                ? calc_monomials(records::list_exponents(n, 2), points)
                                : calc_monomials(records::list_exponents(N, degree), points(Eigen::all, large_));
    auto& used = curves.used.emplace_back();
    for (int i = 0; i < static_cast<int>(values.cols()); ++i)
      if (!values.col(i).isZero(0)) used.push_back(i);
    curves.monomials.emplace_back(values(Eigen::all, used).transpose());
  }
  return curves;
}

MatrixXd StaticManifold::calc_curve(const Curves& curves, const std::vector<int>& gdofs) const {
  const Index m = curves.size(), N = static_cast<Index>(gdofs.size());
  MatrixXd u = MatrixXd::Zero(N, curves.top * m), u_k(N, m);
  const auto set_order = [&](int k, const MatrixXd& shapes, const MatrixXd& values) {
    linear::multiply_dense(false, shapes, values, 0, u_k);
    for (Index p = 0; p < m; ++p) u.col(curves.top * p + k - 1) = u_k.col(p);
  };
  set_order(1, Phi_(gdofs, Eigen::all), curves.amplitudes);
  for (std::size_t k = 0; k < curves.monomials.size(); ++k)
    set_order(static_cast<int>(k) + 2, fields_[k](gdofs, curves.used[k]), curves.monomials[k]);
  return u;
}

StaticManifold::Follower StaticManifold::find_follower(int node) const {
  Follower follower{arms_.find(node), means_.find(node)};
  if (const auto* arm = follower.arm)
    std::tie(follower.translates, follower.rotates) = std::tie(arm->translates, arm->rotates);
  if (const auto* tie = follower.mean)
    std::tie(follower.translates, follower.rotates) = std::tie(tie->translates, tie->rotates);
  return follower;
}

MatrixXd StaticManifold::calc_node_curve(const Curves& curves, int node) const {
  const Follower follower = find_follower(node);
  MatrixXd u(6, curves.top * curves.size());
  if (!follower.translates || !follower.rotates)
    u = calc_curve(curves, list_gdofs(model_.nodes()[static_cast<std::size_t>(node)]));
  if (!follower.arm && !follower.mean) return u;
  MatrixXd moved(6, u.cols());
  if (follower.arm) {
    const MatrixXd parent = calc_node_curve(curves, follower.arm->parent);
    moved.bottomRows<3>() = parent.bottomRows<3>();
    for (Index c = 0; c < u.cols(); c += curves.top) {
      const auto of_parent = parent.middleCols(c, curves.top);
      fe::put_vector(fe::calc_arm_motion(fe::get_vector(of_parent, 3), follower.arm->arm), 0,
                     moved.middleCols(c, curves.top));
    }
    moved.topRows<3>() += parent.topRows<3>();
  } else {
    moved = calc_mean_curve(curves, *follower.mean);
  }
  if (follower.translates) u.topRows<3>() = moved.topRows<3>();
  if (follower.rotates) u.bottomRows<3>() = moved.bottomRows<3>();
  return u;
}

MatrixXd StaticManifold::calc_mean_curve(const Curves& curves, const fe::MeanTie& tie) const {
  const auto& mean = means_.get_mean(tie);
  std::vector<MatrixXd> u, at(mean.members.size());
  for (const auto& member : mean.members) u.push_back(calc_node_curve(curves, member.node));
  MatrixXd moved(6, curves.top * curves.size());
  for (Index c = 0; c < moved.cols(); c += curves.top) {
    for (std::size_t i = 0; i < u.size(); ++i) at[i] = u[i].middleCols(c, curves.top);
    moved.middleCols(c, curves.top) = fe::MeanSeries(mean, at).calc_motion(tie.arm).leftCols(curves.top);
  }
  return moved;
}

MatrixXd StaticManifold::calc_follower_motion(const Curves& curves, int node, int order) const {
  BOUGH_DEMAND(order == static_cast<int>(fields_.size()) + 2);
  const MatrixXd u = calc_node_curve(curves, node);
  MatrixXd moved(6, curves.size());
  for (Index p = 0; p < moved.cols(); ++p) moved.col(p) = u.col(curves.top * p + order - 1);
  return moved;
}

void StaticManifold::carry_forces(const Curves& curves, int node, MatrixXd f, const AddForces& add) const {
  const Follower follower = find_follower(node);
  const auto take = [&](bool translations, bool rotations) {  // what goes on to other grids
    MatrixXd taken = MatrixXd::Zero(6, f.cols());
    if (translations) taken.topRows<3>().swap(f.topRows<3>());
    if (rotations) taken.bottomRows<3>().swap(f.bottomRows<3>());
    return taken;
  };
  const int top = curves.top;
  const MatrixXd taken = take(follower.translates, follower.rotates);
  if (follower.arm) {
    const MatrixXd parent = calc_node_curve(curves, follower.arm->parent);
    MatrixXd moved = taken;
    for (Index c = 0; c < f.cols() && follower.translates; c += top) {
      const SeriesVector moment = fe::calc_arm_moment(fe::get_vector(parent.middleCols(c, top), 3), follower.arm->arm,
                                                      fe::get_vector(taken.middleCols(c, top), 0));
      for (int k = 1; k <= top; ++k) moved.block<3, 1>(3, c + k - 1) += moment[static_cast<std::size_t>(k)];
    }
    carry_forces(curves, follower.arm->parent, std::move(moved), add);
  }
  if (follower.mean) {
    const auto& mean = means_.get_mean(*follower.mean);
    std::vector<MatrixXd> u, at(mean.members.size()), on_members(mean.members.size(), MatrixXd::Zero(6, f.cols()));
    for (const auto& member : mean.members) u.push_back(calc_node_curve(curves, member.node));
    for (Index c = 0; c < f.cols(); c += top) {
      for (std::size_t i = 0; i < u.size(); ++i) at[i] = u[i].middleCols(c, top);
      const auto forces = fe::MeanSeries(mean, at).calc_forces(follower.mean->arm, taken.middleCols(c, top));
      for (std::size_t i = 0; i < forces.size(); ++i) on_members[i].middleCols(c, top) = forces[i].leftCols(top);
    }
    for (std::size_t i = 0; i < on_members.size(); ++i)
      carry_forces(curves, mean.members[i].node, std::move(on_members[i]), add);
  }
  if (!(follower.translates && follower.rotates)) add(list_gdofs(model_.nodes()[static_cast<std::size_t>(node)]), f);
}

MatrixXd StaticManifold::calc_element_curve(const Curves& curves, const fe::Element& element) const {
  MatrixXd u = calc_curve(curves, element.gdofs());
  if (arms_.list().empty() && means_.list().empty()) return u;
  for (const NodeRows& rows : find_rows(element, model_.nodes())) {
    const Follower follower = find_follower(rows.node);
    if (!follower.arm && !follower.mean) continue;
    const MatrixXd moved = calc_node_curve(curves, rows.node);
    if (rows.translations >= 0) u.middleRows<3>(rows.translations) = moved.topRows<3>();
    if (rows.rotations >= 0) u.middleRows<3>(rows.rotations) = moved.bottomRows<3>();
  }
  return u;
}

MatrixXd StaticManifold::calc_multipliers(const Curves& curves) const {
  const Index m = curves.size();
  MatrixXd lambda = MatrixXd::Zero(Phi_.cols(), curves.top * m);
  for (Index p = 0; p < m; ++p) lambda.col(curves.top * p) = curves.amplitudes.col(p);
  for (std::size_t k = 0; k < std::min(multipliers_.size(), curves.monomials.size()); ++k) {
    const MatrixXd lambda_k = multipliers_[k](Eigen::all, curves.used[k]) * curves.monomials[k];
    for (Index p = 0; p < m; ++p) lambda.col(curves.top * p + static_cast<Index>(k) + 1) = lambda_k.col(p);
  }
  return lambda;
}

MatrixXd StaticManifold::calc_arm_gauge(const Curves& curves, int order) const {
  MatrixXd work = MatrixXd::Zero(Phi_.cols(), curves.size());
  for (const int node : followers_)
    work += W_.middleRows<6>(model_.nodes()[static_cast<std::size_t>(node)].first_gdof).transpose() *
            calc_follower_motion(curves, node, order);
  return work + calc_carried_work(curves, order, psi_, MatrixXd::Zero(9, psi_.cols())).on_fields;
}

MatrixXd StaticManifold::calc_gradient(const MatrixXd& points, int degree) const {
  const Curves curves = make_curves(points, degree);
  return (calc_forces(curves, degree, Rows::Modes) - calc_arm_gauge(curves, degree))(large_, Eigen::all);
}

std::vector<int> StaticManifold::rank_by_compliance() const {
  const Index n = Phi_.cols();
  const double size = fe::calc_model_size(model_);
  VectorXd largest = VectorXd::Zero(n);
  for (const auto& node : model_.nodes()) {
    if (node.num_dofs != 6) continue;
    const MatrixXd turned = kTurnedShare * size * Phi_.middleRows<3>(node.first_gdof + 3);
    largest = largest.cwiseMax(
        (Phi_.middleRows<3>(node.first_gdof).colwise().squaredNorm() + turned.colwise().squaredNorm()).transpose());
  }
  // Steps, not differences, which are no order; modes of equal bending stiffnesses differ by round-off.
  const VectorXd steps = (kComplianceSteps * largest.cwiseMax(1e-300).array().log()).round();
  std::vector<int> order(static_cast<std::size_t>(n)), rank(order.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::make_tuple(-steps[a], eigenvalue_[a], a) < std::make_tuple(-steps[b], eigenvalue_[b], b);
  });
  for (std::size_t k = 0; k < order.size(); ++k) rank[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
  return rank;
}

MatrixXd StaticManifold::begin(const Lattice& lattice) {
  BOUGH_DEMAND(fields_.empty());
  MatrixXd gradient;
  fields_.push_back(solve_field(2, lattice, gradient));
  return gradient;
}

void StaticManifold::select_large(const std::vector<int>& large, const MatrixXd& gradient) {
  BOUGH_DEMAND(fields_.size() == 1);
  const int n = static_cast<int>(Phi_.cols());
  large_ = large;
  for (int j = 0; j < n; ++j)
    if (!std::binary_search(large.begin(), large.end(), j)) small_.push_back(j);
  multipliers_.push_back(K_factor_.solve(gradient));
  if (small_.empty()) return;
  K_small_.compute(K_(small_, small_));
  // One small mode of three takes what cancels V₃: ζ_t K_t c = -V₃, c = -K_t⁻¹ ∂V₃/∂ζ_t / (its power in V₃).
  MatrixXd part = -K_small_.solve(gradient(small_, Eigen::all));
  const std::vector<int> rank = rank_by_compliance();
  const Eigen::MatrixXi exponents = records::list_exponents(n, 2);
  for (Index i = 0; i < part.cols(); ++i)
    for (std::size_t k = 0; k < small_.size(); ++k) {
      const int t = small_[k];
      const bool is_follower = std::all_of(small_.begin(), small_.end(), [&](int s) {
        return exponents(i, s) == 0 || rank[static_cast<std::size_t>(s)] <= rank[static_cast<std::size_t>(t)];
      });
      part(static_cast<Index>(k), i) *= is_follower ? 1.0 / (1 + exponents(i, t)) : 0;
    }
  fields_[0] += Phi_(Eigen::all, small_) * part;
  multipliers_[0](small_, Eigen::all).setZero();
}

MatrixXd StaticManifold::advance(int degree, const Lattice& lattice) {
  BOUGH_DEMAND(static_cast<int>(fields_.size()) == degree - 2 && !large_.empty());
  MatrixXd gradient;
  MatrixXd u = solve_field(degree, lattice, gradient);
  if (!small_.empty()) {  // no load holds them
    u -= Phi_(Eigen::all, small_) * K_small_.solve(gradient(small_, Eigen::all));
    gradient(small_, Eigen::all).setZero();
  }
  multipliers_.push_back(K_factor_.solve(gradient));
  fields_.push_back(std::move(u));
  return gradient(large_, Eigen::all);
}

MatrixXd StaticManifold::solve_field(int degree, const Lattice& lattice, MatrixXd& gradient) const {
  const Curves curves = make_curves(degree, lattice);
  const MatrixXd R = lattice.fit(calc_forces(curves, degree, Rows::Dofs)),
                 gauge = lattice.fit(calc_arm_gauge(curves, degree));
  gradient = linear::calc_inner_products(Phi_, R) - gauge;
  MatrixXd u = solve(R) - Phi_ * K_factor_.solve(gauge);
  for (const int node : followers_)
    u.middleRows<6>(model_.nodes()[static_cast<std::size_t>(node)].first_gdof) +=
        lattice.fit(calc_follower_motion(curves, node, degree));
  return u;
}

MatrixXd StaticManifold::calc_forces(const Curves& curves, int order, Rows rows_of_result) const {
  const Index m = curves.size();
  const bool on_modes = rows_of_result == Rows::Modes;
  MatrixXd result = MatrixXd::Zero(on_modes ? Phi_.cols() : model_.num_gdofs(), m);
  const auto add = [&](const std::vector<int>& gdofs, const MatrixXd& f, MatrixXd& sum) {
    MatrixXd f_k(f.rows(), m);
    for (Index p = 0; p < m; ++p) f_k.col(p) = f.col(curves.top * p + order - 1);
    if (on_modes)
      linear::multiply_dense(true, Phi_(gdofs, Eigen::all), f_k, 1, sum);
    else
      sum(gdofs, Eigen::all) += f_k;
  };
  const auto add_element = [&](const fe::Element& element, MatrixXd f, MatrixXd& sum) {
    if (arms_.list().empty() && means_.list().empty()) return add(element.gdofs(), f, sum);
    for (const NodeRows& rows : find_rows(element, model_.nodes())) {
      const Follower follower = find_follower(rows.node);
      MatrixXd moved = MatrixXd::Zero(6, f.cols());
      if (follower.translates && rows.translations >= 0) moved.topRows<3>().swap(f.middleRows<3>(rows.translations));
      if (follower.rotates && rows.rotations >= 0) moved.bottomRows<3>().swap(f.middleRows<3>(rows.rotations));
      if (follower.translates || follower.rotates)
        carry_forces(curves, rows.node, std::move(moved),
                     [&](const std::vector<int>& gdofs, const MatrixXd& forces) { add(gdofs, forces, sum); });
    }
    add(element.gdofs(), f, sum);
  };
  MatrixXd second;  // of the second thread
  fe::visit_elements_by_halves(model_, fe::get_own_elements(model_), kMinElementsOfThread,
                               [&](std::size_t half, int, const fe::Element& element) {
                                 if (element.num_dofs() == 0 || !has_stiffness(element)) return;
                                 if (half == 1 && second.size() == 0) second.setZero(result.rows(), result.cols());
                                 const fe::CorotationalElement corotational(element, model_.nodes());
                                 add_element(element,
                                             corotational.calc_forces(calc_element_curve(curves, element), curves.top),
                                             half == 0 ? result : second);
                               });
  if (second.size() > 0) result += second;
  // Loads on turned arms have moments that they lack at the undeformed state.
  const MatrixXd lambda = calc_multipliers(curves);
  visit_carried(curves, [&](const fe::Element& element, const Carried& carried) {
    const MatrixXd along = carried.motion * (psi_(element.gdofs(), Eigen::all) * lambda);
    MatrixXd f = MatrixXd::Zero(element.num_dofs(), along.cols());
    if (!carried.mass.fields.empty()) return add_element(element, -calc_chord_forces(carried, along), result);
    for (const auto& turn : carried.mass.turns)
      for (const auto& part : turn.parts) {
        Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, along.cols());
        for (Index r = 0; r < carried.mass.mu.rows(); ++r)
          force += carried.mass.mu(r, part.point) * along.middleRows<3>(3 * r);
        f -= turn.Theta.transpose() *
             calc_turned_moment(turn.Theta * carried.u, carried.top, part.arm, part.B.transpose() * force);
      }
    add_element(element, f, result);
  });
  if (linear::initialize_petsc().rank == 0)
    for (const int node : followers_) {
      const int first = model_.nodes()[static_cast<std::size_t>(node)].first_gdof;
      MatrixXd load = -W_.middleRows<6>(first) * lambda;
      for (Index p = 0; p < m; ++p) load.col(curves.top * p + order - 1).setZero();  // it acts linearly on this order
      carry_forces(curves, node, std::move(load),
                   [&](const std::vector<int>& gdofs, const MatrixXd& f) { add(gdofs, f, result); });
    }
  linear::sum_over_ranks(result);
  return result;
}

StaticManifold::Curves StaticManifold::make_curves(int degree, const Lattice& lattice) const {
  return make_curves(degree == 2 ? lattice.points() : spread(lattice.points(), large_, Phi_.cols()), degree);
}

MatrixXd StaticManifold::calc_recovery(int degree, const Lattice& lattice, const fe::Element& element) const {
  Curves curves = make_curves(degree, lattice);
  curves.top = kSeriesTop;
  const auto local = fe::CorotationalElement(element, model_.nodes()).calc_local(calc_element_curve(curves, element));
  const auto take = [&](const MatrixXd& series) {
    MatrixXd values(series.rows(), lattice.size());
    for (Index p = 0; p < values.cols(); ++p) values.col(p) = series.col(kSeriesTop * p + degree - 1);
    return values;
  };
  return lattice.fit(calc_recovery_rows(element, take(local.d), take(local.internal)));
}

MatrixXd StaticManifold::calc_arm_work(int degree, const Lattice& lattice,
                                       const std::vector<std::vector<fe::ArmLoad>>& loads) const {
  const Curves curves = make_curves(degree, lattice);
  MatrixXd work = MatrixXd::Zero(static_cast<Index>(loads.size()), lattice.size());
  for (std::size_t e = 0; e < loads.size(); ++e)
    for (const auto& load : loads[e]) {
      const int g = load.first_rotation;
      work.row(static_cast<Index>(e)) +=
          load.force.transpose() * calc_turned_arm(calc_curve(curves, {g, g + 1, g + 2}), curves.top, load.arm, degree);
    }
  return lattice.fit(work);
}

MatrixXd StaticManifold::calc_chord_forces(const Carried& carried, const MatrixXd& along) {
  const auto& moved = carried.mass.fields.front().moved;
  const Index num = carried.mass.mu.rows();
  MatrixXd result(carried.u.rows(), carried.u.cols());
  const int top = carried.top;
  for (Index c = 0; c < carried.u.cols(); c += top) {
    std::vector<SeriesVector> forces;
    MatrixXd linear = MatrixXd::Zero(carried.u.rows(), top);
    for (const auto& point : moved) {
      MatrixXd force = MatrixXd::Zero(3, top);
      for (Index r = 0; r < num; ++r) force += carried.mass.mu(r, point.point) * along.block(3 * r, c, 3, top);
      linear += carried.motion.middleRows<3>(3 * point.point).transpose() * force;
      forces.push_back(fe::get_vector(force, 0));
    }
    const fe::ChordSeries chord(carried.mass, carried.u.middleCols(c, top));
    result.middleCols(c, top) = chord.calc_forces(forces).leftCols(top) - linear;
  }
  return result;
}

MatrixXd StaticManifold::calc_chord_motion(const Carried& carried, int order) {
  const auto& points = carried.mass.fields.front().moved;
  MatrixXd moved = MatrixXd::Zero(carried.motion.rows(), carried.u.cols() / carried.top);
  for (Index c = 0; c < moved.cols(); ++c) {
    const auto u = carried.u.middleCols(carried.top * c, carried.top);
    const fe::ChordSeries chord(carried.mass, u);
    for (std::size_t p = 0; p < points.size(); ++p) {
      const Index row = 3 * points[p].point;
      moved.block<3, 1>(row, c) =
          chord.calc_motion(p)[static_cast<std::size_t>(order)] - carried.motion.middleRows<3>(row) * u.col(order - 1);
    }
  }
  return moved;
}

template <class Visit>
void StaticManifold::visit_carried(const Curves& curves, const Visit& visit) const {
  fe::visit_elements(model_, fe::get_own_elements(model_), [&](int, const fe::Element& element) {
    if (!element.offset_mass(model_.mass_kind())) return;
    Carried carried{fe::CarriedMass(element.num_dofs()), curves.top, {}, {}};
    if (!fe::calc_carried(model_, element, model_.mass_kind(), carried.mass)) return;
    // Places between two ends alone move linearly, off as h²: so are their elements' bows.
    const auto has_arms = [&](const fe::CarriedField& field) {
      return std::any_of(field.moved.begin(), field.moved.end(), [&](const fe::ChordPoint& p) {
        return !carried.mass.points[static_cast<std::size_t>(p.point)].is_place;
      });
    };
    if (!carried.mass.fields.empty() && !has_arms(carried.mass.fields.front())) return;
    carried.u = calc_element_curve(curves, element);
    const auto num = static_cast<Index>(carried.mass.points.size());
    carried.motion.resize(3 * num, element.num_dofs());
    for (Index s = 0; s < num; ++s)
      carried.motion.middleRows<3>(3 * s) = carried.mass.points[static_cast<std::size_t>(s)].H;
    visit(element, carried);
  });
}

StaticManifold::CarriedWork StaticManifold::calc_carried_work(int degree, const Lattice& lattice, const MatrixXd& psi,
                                                              const MatrixXd& strain) const {
  const auto work = calc_carried_work(make_curves(degree, lattice), degree, psi, strain);
  return {lattice.fit(work.on_fields), lattice.fit(work.on_inertial)};
}

StaticManifold::CarriedWork StaticManifold::calc_carried_work(const Curves& curves, int order, const MatrixXd& psi,
                                                              const MatrixXd& strain) const {
  const Index m = curves.size();
  CarriedWork work{MatrixXd::Zero(psi.cols(), m), MatrixXd::Zero(records::kNumInertialLoads, m)};
  const fe::AccelerationFields units(MatrixXd::Identity(records::kNumInertialLoads, records::kNumInertialLoads));
  visit_carried(curves, [&](const fe::Element& element, const Carried& carried) {
    const auto num = static_cast<Index>(carried.mass.points.size());
    MatrixXd moved = MatrixXd::Zero(3 * num, m);
    if (!carried.mass.fields.empty()) moved = calc_chord_motion(carried, order);
    for (const auto& turn : carried.mass.fields.empty() ? carried.mass.turns : std::vector<fe::CarriedTurn>())
      for (const auto& part : turn.parts)
        moved.middleRows<3>(3 * static_cast<Index>(part.point)) +=
            part.B * calc_turned_arm(turn.Theta * carried.u, carried.top, part.arm, order);
    MatrixXd along = carried.motion * psi(element.gdofs(), Eigen::all);
    for (Index s = 0; s < num; ++s) {
      const auto& point = carried.mass.points[static_cast<std::size_t>(s)];
      for (int b = 0; b < 3 && !point.is_place; ++b)
        along.middleRows<3>(3 * s) += point.x[b] * strain.middleRows<3>(3 * b);
    }
    const MatrixXd loads = units.calc_point_loads(carried.mass);
    for (Index s = 0; s < num; ++s) {
      for (Index r = 0; r < num; ++r)
        if (carried.mass.mu(r, s) != 0)
          work.on_fields += carried.mass.mu(r, s) * along.middleRows<3>(3 * r).transpose() * moved.middleRows<3>(3 * s);
      for (int a = 0; a < 3; ++a) work.on_inertial += loads.row(a * num + s).transpose() * moved.row(3 * s + a);
    }
  });
  linear::sum_over_ranks(work.on_fields);
  linear::sum_over_ranks(work.on_inertial);
  return work;
}

}  // namespace bough::stiffening
