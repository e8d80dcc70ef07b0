#include "solver/bodies/third_order.hpp"

#include <algorithm>

#include "base/diagnostic.hpp"
#include "solver/bodies/kernels.hpp"

namespace bough::solver {

using records::ThirdOrder;

namespace {

/// Modes whose monomials a table of displacements of this degree has.
std::vector<int> list_variables(const ThirdOrder& third, int degree, int n) {
  if (degree > 2) return third.large;
  std::vector<int> all;
  for (int j = 0; j < n; ++j) all.push_back(j);
  return all;
}

void add_tables(int n, const ThirdOrder& third, const ThirdOrder::Tables& tables, Polynomials& polynomials) {
  for (int k = ThirdOrder::kMinField; k <= ThirdOrder::kMaxField; ++k)
    polynomials.add(k, list_variables(third, k, n), tables[static_cast<size_t>(k - ThirdOrder::kMinField)]);
}

/// The record of the linear body of n + m modes, without stiffness.
records::FlexBody make_linear_record(const records::FlexBody& flex) {
  const ThirdOrder& third = flex.third_order;
  const Eigen::Index n = flex.num_modes(), N = n + third.num_fields();
  records::FlexBody linear;
  linear.mass = flex.mass;
  linear.cg = flex.cg;
  linear.inertia = flex.inertia;
  linear.is_free_free = flex.is_free_free;
  linear.eigenvalue = linear.frequency_hz = VectorXd::Zero(N);
  linear.integrals_method = "exact";
  linear.exact = third.integrals;
  linear.modal_mass = MatrixXd::Identity(N, N);
  linear.modal_mass.topLeftCorner(n, n) = flex.modal_mass;
  if (third.coupling.size() > 0) {
    linear.modal_mass.topRightCorner(n, N - n) = third.coupling;
    linear.modal_mass.bottomLeftCorner(N - n, n) = third.coupling.transpose();
  }
  linear.modal_stiffness = MatrixXd::Zero(N, N);
  return linear;
}

}  // namespace

ThirdOrderBody::ThirdOrderBody(const records::FlexBody& flex)
    : n_(flex.num_modes()),
      m_(flex.third_order.num_fields()),
      large_(flex.third_order),
      amplitudes_(n_, large_, m_),
      energy_(n_, large_, ThirdOrder::kMaxEnergy),
      linear_(Body::make_flexible(make_linear_record(flex), -1, false, {})) {
  const ThirdOrder& third = flex.third_order;
  add_tables(n_, third, third.amplitudes, amplitudes_);
  for (int k = ThirdOrder::kMinEnergy; k <= ThirdOrder::kMaxEnergy; ++k)
    energy_.add(k, third.large, third.energy[static_cast<size_t>(k - ThirdOrder::kMinEnergy)]);
  if (large_.directions.size() > 0) {
    const MatrixXd& L = large_.directions;
    of_directions_ = (L * flex.modal_stiffness.ldlt().solve(L.transpose())).diagonal().cwiseInverse();
    return;
  }
  for (int j = 0; j < n_; ++j) {
    if (!std::binary_search(third.large.begin(), third.large.end(), j)) small_.push_back(j);
  }
  if (third.energy_small.isZero(0)) small_.clear();
  if (small_.empty()) return;
  on_small_ = Polynomials(n_, large_, static_cast<int>(small_.size()));
  on_small_.add(2, third.large, third.energy_small);
}

ThirdOrderData ThirdOrderBody::make_data() const {
  ThirdOrderData data;
  data.linear = linear_.make_inertia();
  data.tensors = VectorXd::Zero(amplitudes_.scratch_size());
  data.xi = data.xi_dot = VectorXd::Zero(n_ + m_);
  const Eigen::Index stride = amplitudes_.stride();
  data.J = MatrixXd::Zero(stride, n_);
  data.M_pp = MatrixXd::Zero(stride, stride);
  data.U = MatrixXd::Zero(stride, n_);
  data.product = MatrixXd::Zero(n_, n_);
  data.p_ddot = data.force = VectorXd::Zero(stride);
  data.gradient = VectorXd::Zero(n_);
  const auto num_small = static_cast<Eigen::Index>(small_.size());
  data.J_small = VectorXd::Zero(pad(num_small) * n_);
  data.on_small = VectorXd::Zero(num_small);
  return data;
}

bool ThirdOrderBody::is_exact(const records::FlexBody& flex, int node_id) {
  return std::find(flex.interface_nodes.begin(), flex.interface_nodes.end(), node_id) != flex.interface_nodes.end();
}

Polynomials ThirdOrderBody::make_node_motion(const records::FlexBody& flex, std::size_t k) const {
  const ThirdOrder& third = flex.third_order;
  Polynomials motion(n_, large_, 6);
  const auto found = std::find(flex.interface_nodes.begin(), flex.interface_nodes.end(), flex.node_id[k]);
  if (found != flex.interface_nodes.end()) {
    add_tables(n_, third, third.node[static_cast<size_t>(found - flex.interface_nodes.begin())], motion);
    return motion;
  }
  ThirdOrder::Tables tables;
  for (size_t i = 0; i < tables.size(); ++i) tables[i] = third.amplitudes[i] * third.fields[k].transpose();
  add_tables(n_, third, tables, motion);
  return motion;
}

Potential ThirdOrderBody::make_load(const records::FlexBody& flex, int locator) const {
  const ThirdOrder& third = flex.third_order;
  Potential load(n_, large_, ThirdOrder::kMaxField);
  for (int k = ThirdOrder::kMinField; k <= ThirdOrder::kMaxField; ++k)
    load.add(k, list_variables(third, k, n_), third.load[static_cast<size_t>(k - ThirdOrder::kMinField)].col(locator));
  return load;
}

void ThirdOrderBody::calc_mass(const ConstVectorRef& eta, ThirdOrderData& d, BodyInertia& x) const {
  d.xi.head(n_) = eta;
  amplitudes_.calc(eta, d.J.data(), d.xi.data() + n_, d.tensors.data());
  linear_.calc_mass(d.xi, d.linear);
  const BodyInertia& l = d.linear;
  x.M6 = l.M6;
  x.S = l.S;
  const Eigen::Index stride = amplitudes_.stride();
  const MatrixXd& P = d.J;
  x.M_top = l.M_top.leftCols(n_);
  for (int j = 0; j < n_; ++j) {
    for (int q = 0; q < m_; ++q) x.M_top.col(j) += P(q, j) * l.M_top.col(n_ + q);
  }
  // M_ηη + UᵀP + PᵀU, U = M_pη + ½ M_pp P.
  for (int q = 0; q < m_; ++q) {
    for (int i = q; i < m_; ++i) d.M_pp(i, q) = d.M_pp(q, i) = 0.5 * l.M_modal(n_ + i, n_ + q);
    for (int j = 0; j < n_; ++j) d.U(q, j) = l.M_modal(n_ + q, j);
  }
  add_product(d.M_pp.data(), stride, stride, d.J.data(), n_, d.U.data());
  for (int j = 0; j < n_; ++j)
    multiply_transposed(d.U.data(), stride, n_, d.J.data() + j * stride, d.product.data() + j * n_);
  for (int j = 0; j < n_; ++j) {
    for (int i = j; i < n_; ++i) x.M_modal(i, j) = l.M_modal(i, j) + d.product(i, j) + d.product(j, i);
  }
}

void ThirdOrderBody::calc_bias(const Vector3d& w, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                               ThirdOrderData& d, BodyInertia& x) const {
  const MatrixXd& P = d.J;
  amplitudes_.calc_bias(eta_dot, d.tensors.data(), d.p_ddot.data());
  d.xi_dot.head(n_) = eta_dot;
  for (int q = 0; q < m_; ++q) {
    double rate = 0;
    for (int j = 0; j < n_; ++j) rate += P(q, j) * eta_dot[j];
    d.xi_dot[n_ + q] = rate;
  }
  linear_.calc_bias(w, d.xi, d.xi_dot, d.linear);
  const BodyInertia& l = d.linear;
  x.h.head<6>() = l.h.head<6>();
  for (int q = 0; q < m_; ++q) {
    x.h.head<6>() += d.p_ddot[q] * l.M_top.col(n_ + q);
    d.force[q] = l.h[6 + n_ + q];
    for (int i = 0; i < m_; ++i) d.force[q] += 2 * d.M_pp(i, q) * d.p_ddot[i];
  }
  energy_.calc(eta, d.gradient.data());
  for (int j = 0; j < n_; ++j) {
    double force = l.h[6 + j] + d.gradient[j];
    for (int q = 0; q < m_; ++q) force += l.M_modal(n_ + q, j) * d.p_ddot[q] + P(q, j) * d.force[q];
    x.h[6 + j] = force;
  }
  if (small_.empty()) return;
  on_small_.calc(eta, d.J_small.data(), d.on_small.data(), nullptr);
  for (size_t s = 0; s < small_.size(); ++s) {
    const auto at = static_cast<Eigen::Index>(s);
    x.h[6 + small_[s]] += d.on_small[at];
    for (int j = 0; j < n_; ++j) x.h[6 + j] += d.J_small[at + on_small_.stride() * j] * eta[small_[s]];
  }
}

LinearField ThirdOrderBody::make_linear_field(const Matrix3d& T, const ThirdOrderData& d) const {
  return linear_.make_linear_field(T, d.linear);
}

double ThirdOrderBody::calc_modal_force(const LinearField& field, const ThirdOrderData& d, int j) const {
  double force = linear_.calc_modal_force(field, d.linear, j);
  for (int q = 0; q < m_; ++q) force += d.J(q, j) * linear_.calc_modal_force(field, d.linear, n_ + q);
  return force;
}

double ThirdOrderBody::calc_twice_small_energy(const MatrixXd& K, const ConstVectorRef& eta) const {
  double twice = 0;
  if (large_.directions.size() > 0) {
    double y[records::kMaxLargeModes];
    large_.get(eta, y);
    for (int j = 0; j < n_; ++j) twice += K.col(j).dot(eta) * eta[j];
    for (Eigen::Index f = 0; f < large_.size(); ++f) twice -= of_directions_[f] * y[f] * y[f];
    return std::max(twice, 0.0);
  }
  const auto is_small = [&](int j) { return !std::binary_search(large_.modes.begin(), large_.modes.end(), j); };
  for (int j = 0; j < n_; ++j)
    for (int k = 0; k < n_; ++k)
      if (is_small(j) && is_small(k)) twice += eta[j] * K(j, k) * eta[k];
  return twice;
}

void ThirdOrderBody::calc_large_shapes(const MatrixXd& K, Eigen::Ref<MatrixXd> shapes) const {
  if (large_.directions.size() == 0) {
    shapes.setZero();
    for (Eigen::Index f = 0; f < large_.size(); ++f) shapes(large_.modes[static_cast<size_t>(f)], f) = 1;
    return;
  }
  // y = L η with L = DᵀK over the stiffness of each direction.
  constexpr int kMax = records::kMaxThirdOrderModes;
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMax, kMax> modal = K.topLeftCorner(n_, n_);
  shapes = large_.directions.transpose() * of_directions_.asDiagonal();
  modal.ldlt().solveInPlace(shapes);
}

double ThirdOrderBody::calc_energy(const ConstVectorRef& eta) const {
  constexpr int kMax = records::kMaxThirdOrderModes;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMax * kMax, 1> J(n_);  // on the stack
  double energy = energy_.calc(eta, J.data());
  if (small_.empty()) return energy;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMax, 1> value(static_cast<Eigen::Index>(small_.size()));
  J.resize(on_small_.stride() * n_);
  on_small_.calc(eta, J.data(), value.data(), nullptr);
  for (size_t s = 0; s < small_.size(); ++s) energy += eta[small_[s]] * value[static_cast<Eigen::Index>(s)];
  return energy;
}

}  // namespace bough::solver
