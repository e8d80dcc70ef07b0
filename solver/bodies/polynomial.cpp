#include "solver/bodies/polynomial.hpp"

#include <algorithm>

#include "base/diagnostic.hpp"
#include "solver/bodies/kernels.hpp"

namespace bough::solver {

MonomialList::MonomialList(int n, const std::vector<int>& large, int degree) : n_(n), large_(large) {
  for (int j = 0; j < n; ++j) {
    parent_.push_back(-1);
    last_.push_back(j);
    factors_.push_back({j});
  }
  first_.push_back(n);
  for (int k = 2; k <= degree; ++k) {
    const int begin = first_[static_cast<std::size_t>(k) - 2], end = first_.back();
    for (int i = begin; i < end; ++i) {
      if (std::find(large.begin(), large.end(), factors_[static_cast<std::size_t>(i)][0]) == large.end()) continue;
      for (const int j : large) {
        if (j < last_[static_cast<std::size_t>(i)]) continue;
        parent_.push_back(i);
        last_.push_back(j);
        auto factors = factors_[static_cast<std::size_t>(i)];
        factors.push_back(j);
        factors_.push_back(std::move(factors));
      }
    }
    first_.push_back(static_cast<int>(parent_.size()));
  }
  BOUGH_DEMAND(size() <= kMaxSize);
}

int MonomialList::find(const std::vector<int>& factors) const {
  const auto begin = factors_.begin() + first_[factors.size() - 1], end = factors_.begin() + first_[factors.size()];
  const auto found = std::find(begin, end, factors);
  BOUGH_DEMAND(found != end);
  return static_cast<int>(found - factors_.begin());
}

void MonomialList::calc(const ConstVectorRef& eta, int degree, double* z) const {
  for (int j = 0; j < n_; ++j) z[j] = eta[j];
  for (int i = n_; i < size(degree); ++i) {
    const auto at = static_cast<std::size_t>(i);
    z[i] = z[parent_[at]] * eta[last_[at]];
  }
}

void MonomialList::calc_rates(const ConstVectorRef& eta, const ConstVectorRef& eta_dot, int degree, const double* z,
                              double* z_dot) const {
  for (int j = 0; j < n_; ++j) z_dot[j] = eta_dot[j];
  for (int i = n_; i < size(degree); ++i) {
    const auto at = static_cast<std::size_t>(i);
    z_dot[i] = z_dot[parent_[at]] * eta[last_[at]] + z[parent_[at]] * eta_dot[last_[at]];
  }
}

Polynomials::Polynomials(const MonomialList& list, int m, int max_degree, Eigen::Index stride)
    : m_(m), n_(list.num_modes()), degree_(max_degree), stride_(stride > 0 ? stride : pad(m)) {
  G_ = MatrixXd::Zero(pad(stride_ * n_), list.size(max_degree - 1));
}

void Polynomials::add(const MonomialList& list, int degree, const std::vector<int>& variables, const MatrixXd& c) {
  const auto num = static_cast<int>(variables.size());
  const Eigen::MatrixXi exponents = records::list_exponents(num, degree);
  BOUGH_DEMAND(degree >= 2 && degree <= degree_ && c.rows() == exponents.rows() && c.cols() == m_);
  for (Eigen::Index i = 0; i < exponents.rows(); ++i) {
    for (int v = 0; v < num; ++v) {
      if (exponents(i, v) == 0) continue;
      std::vector<int> factors;
      for (int w = 0; w < num; ++w)
        factors.insert(factors.end(), static_cast<std::size_t>(exponents(i, w) - (w == v ? 1 : 0)),
                       variables[static_cast<std::size_t>(w)]);
      std::sort(factors.begin(), factors.end());
      G_.block(stride_ * variables[static_cast<std::size_t>(v)], list.find(factors), m_, 1) +=
          exponents(i, v) * c.row(i).transpose();
    }
  }
}

namespace {

/// J += G(:, first..last) z.
void add_columns(const MatrixXd& G, int first, int last, const double* z, double* J) {
  add_product(G.data() + G.rows() * first, G.rows(), last - first, z + first, 1, J);
}

}  // namespace

/// p_k = J_k η / k of each degree (Euler).
void Polynomials::calc(const MonomialList& list, const ConstVectorRef& eta, const double* z, double* J,
                       double* value) const {
  Eigen::Map<MatrixXd> J_map(J, stride_, n_);
  Eigen::Map<VectorXd>(J, G_.rows()).setZero();
  Eigen::Map<VectorXd> p(value, m_);
  p.setZero();
  for (int k = 2; k <= degree_; ++k) {
    add_columns(G_, list.size(k - 2), list.size(k - 1), z, J);
    // Σ_k J_k η / k by sums to each degree.
    const double weight = k < degree_ ? 1.0 / k - 1.0 / (k + 1) : 1.0 / k;
    for (int j = 0; j < n_; ++j) p += weight * eta[j] * J_map.col(j).head(m_);
  }
}

void Polynomials::calc_bias(const MonomialList& list, const ConstVectorRef& eta_dot, const double* z_dot, double* J_dot,
                            double* bias) const {
  Eigen::Map<MatrixXd> J_map(J_dot, stride_, n_);
  Eigen::Map<VectorXd>(J_dot, G_.rows()).setZero();
  add_columns(G_, 0, list.size(degree_ - 1), z_dot, J_dot);
  Eigen::Map<VectorXd> b(bias, m_);
  b.setZero();
  for (int j = 0; j < n_; ++j) b += eta_dot[j] * J_map.col(j).head(m_);
}

}  // namespace bough::solver
