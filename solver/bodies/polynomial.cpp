#include "solver/bodies/polynomial.hpp"

#include <algorithm>

#include "base/diagnostic.hpp"
#include "solver/bodies/kernels.hpp"

namespace bough::solver {
namespace {

using Factors = std::vector<int>;

/// All sorted lists of `degree` factors among N, in lexical order.
std::vector<Factors> list_factors(int N, int degree) {
  std::vector<Factors> all = {{}};
  for (int k = 0; k < degree; ++k) {
    std::vector<Factors> longer;
    for (const Factors& one : all) {
      for (int f = one.empty() ? 0 : one.back(); f < N; ++f) {
        longer.push_back(one);
        longer.back().push_back(f);
      }
    }
    all = std::move(longer);
  }
  return all;
}

int find_entry(const std::vector<Factors>& all, Factors factors) {
  std::sort(factors.begin(), factors.end());
  const auto found = std::lower_bound(all.begin(), all.end(), factors);
  BOUGH_DEMAND(found != all.end() && *found == factors);
  return static_cast<int>(found - all.begin());
}

/// Visits the monomials of one degree in the order of records::list_exponents: sorted factors, and the product of the
/// factorials of the exponents. variables: the number of each variable.
template <class Visit>
void visit_monomials(const std::vector<int>& variables, int degree, const Visit& visit) {
  const Eigen::MatrixXi exponents = records::list_exponents(static_cast<int>(variables.size()), degree);
  for (Eigen::Index i = 0; i < exponents.rows(); ++i) {
    Factors factors;
    double factorial = 1;
    for (Eigen::Index v = 0; v < exponents.cols(); ++v) {
      for (int e = 1; e <= exponents(i, v); ++e) {
        factors.push_back(variables[static_cast<std::size_t>(v)]);
        factorial *= e;
      }
    }
    visit(i, factors, factorial);
  }
}

std::vector<int> list_all(std::size_t N) {
  std::vector<int> all(N);
  for (std::size_t i = 0; i < N; ++i) all[i] = static_cast<int>(i);
  return all;
}

}  // namespace

void LargeAmplitudes::get(const ConstVectorRef& all, double* values) const {
  if (directions.size() == 0) {
    for (std::size_t f = 0; f < modes.size(); ++f) values[f] = all[modes[f]];
    return;
  }
  for (Eigen::Index f = 0; f < directions.rows(); ++f) {
    double sum = 0;
    for (Eigen::Index j = 0; j < directions.cols(); ++j) sum += directions(f, j) * all[j];
    values[f] = sum;
  }
}

Polynomials::Polynomials(int n, LargeAmplitudes large, int m)
    : m_(m), n_(n), stride_(pad(m)), large_(std::move(large)) {
  BOUGH_DEMAND(large_.size() <= records::kMaxLargeModes && stride_ <= kMaxStride);
  G2_ = MatrixXd::Zero(stride_ * n_, n_);
}

void Polynomials::add(int degree, const std::vector<int>& variables, const MatrixXd& c) {
  BOUGH_DEMAND(degree >= 2 && degree <= kMaxDegree && c.cols() == m_);
  if (degree == 2) {
    visit_monomials(variables, 2, [&](Eigen::Index i, const Factors& f, double factorial) {
      G2_.block(stride_ * f[0], f[1], m_, 1) += factorial * c.row(i).transpose();
      if (f[0] != f[1]) G2_.block(stride_ * f[1], f[0], m_, 1) += factorial * c.row(i).transpose();
    });
    return;
  }
  BOUGH_DEMAND(variables == large_.modes);
  const auto N = static_cast<int>(large_.size());
  if (to_[0].empty()) {
    for (int r = 0; r < 3; ++r) {
      const auto longer = list_factors(N, r + 2);
      for (Factors factors : list_factors(N, r + 1)) {
        factors.push_back(0);
        for (factors.back() = 0; factors.back() < N; ++factors.back())
          to_[static_cast<std::size_t>(r)].push_back(static_cast<int>(stride_) * find_entry(longer, factors));
      }
    }
    D3_ = MatrixXd::Zero(stride_, records::count_monomials(N, 3));
    D4_ = MatrixXd::Zero(stride_, records::count_monomials(N, 4));
    scratch_rows_ = records::count_monomials(N, 3) + 3 * records::count_monomials(N, 2) + 2 * N;
  }
  MatrixXd& D = degree == 3 ? D3_ : D4_;
  const auto entries = list_factors(N, degree);
  visit_monomials(list_all(large_.modes.size()), degree, [&](Eigen::Index i, const Factors& factors, double factorial) {
    D.col(find_entry(entries, factors)).head(m_) += factorial * c.row(i).transpose();
  });
}

void Polynomials::calc(const ConstVectorRef& eta, double* J, double* value, double* scratch) const {
  Eigen::Map<VectorXd>(J, G2_.rows()).setZero();
  add_product(G2_.data(), G2_.rows(), n_, eta.data(), 1, J);
  double p[kMaxStride] = {};  // padded
  double half[records::kMaxThirdOrderModes];
  for (int j = 0; j < n_; ++j) half[j] = 0.5 * eta[j];
  add_product(J, stride_, n_, half, 1, p);
  if (scratch_rows_ > 0) {
    const Eigen::Index N = large_.size(), num_pairs = N * (N + 1) / 2;
    double x[records::kMaxLargeModes];
    large_.get(eta, x);
    // Second derivatives: D3 η of degree 3, half of D4 η η of degree 4.
    double *H = scratch, *A = H + stride_ * num_pairs, *B = A + stride_ * num_pairs, *J3 = B + stride_ * num_pairs,
           *J4 = J3 + stride_ * N, *C = J4 + stride_ * N;
    contract(D3_.data(), stride_, to_[1].data(), num_pairs, x, N, A);
    contract(D4_.data(), stride_, to_[2].data(), D3_.cols(), x, N, C);
    contract(C, stride_, to_[1].data(), num_pairs, x, N, B);
    contract(A, stride_, to_[0].data(), N, x, N, J3);
    contract(B, stride_, to_[0].data(), N, x, N, J4);
    Eigen::Map<VectorXd>(H, stride_ * num_pairs).setZero();
    add_scaled(1, A, 0.5, B, stride_ * num_pairs, H);
    for (Eigen::Index f = 0; f < N; ++f) {
      const double *a = J3 + stride_ * f, *b = J4 + stride_ * f;
      if (large_.directions.size() == 0) {
        add_scaled(0.5, a, 1.0 / 6, b, stride_, J + stride_ * large_.modes[static_cast<std::size_t>(f)]);
      } else {
        for (int j = 0; j < n_; ++j) {
          const double share = large_.directions(f, j);
          add_scaled(0.5 * share, a, share / 6, b, stride_, J + stride_ * j);
        }
      }
      add_scaled(x[f] / 6, a, x[f] / 24, b, stride_, p);
    }
  }
  std::copy_n(p, m_, value);
}

void Polynomials::calc_bias(const ConstVectorRef& eta_dot, const double* scratch, double* bias) const {
  Eigen::Map<VectorXd>(bias, stride_).setZero();
  double weight[records::kMaxThirdOrderModes];
  for (int k = 0; k < n_; ++k) {  // entries j ≤ k
    for (int j = 0; j < k; ++j) weight[j] = 2 * eta_dot[j] * eta_dot[k];
    weight[k] = eta_dot[k] * eta_dot[k];
    add_product(G2_.data() + G2_.rows() * k, stride_, k + 1, weight, 1, bias);
  }
  if (scratch_rows_ == 0) return;
  double pairs[records::kMaxLargeModes * (records::kMaxLargeModes + 1) / 2], rate[records::kMaxLargeModes];
  large_.get(eta_dot, rate);
  Eigen::Index num_pairs = 0;
  for (Eigen::Index f = 0; f < large_.size(); ++f) {
    for (Eigen::Index g = f; g < large_.size(); ++g) pairs[num_pairs++] = (f == g ? 1 : 2) * rate[f] * rate[g];
  }
  add_product(scratch, stride_, num_pairs, pairs, 1, bias);
}

Potential::Potential(int n, LargeAmplitudes large, int max_degree) : n_(n), large_(std::move(large)) {
  const auto N = static_cast<int>(large_.size());
  BOUGH_DEMAND(N <= records::kMaxLargeModes && max_degree <= 6);
  int next = 0;
  for (int k = 1; k < max_degree; ++k) {
    const auto all = list_factors(N, k);
    Degree degree;
    degree.size = static_cast<int>(all.size());
    degree.padded = static_cast<int>(pad(degree.size));
    degree.first = k == 1 ? 0 : next;  // those of degree 1 are the amplitudes
    if (k > 1) next += degree.padded;
    for (int f = 0; f < N; ++f)
      degree.start.push_back(static_cast<int>(
          std::find_if(all.begin(), all.end(), [&](const Factors& one) { return one[0] >= f; }) - all.begin()));
    degree.G = MatrixXd::Zero(k > 1 ? degree.padded : 0, N);
    degrees_.push_back(std::move(degree));
  }
  BOUGH_DEMAND(next <= kMaxMonomials);
}

void Potential::add(int degree, const std::vector<int>& variables, const VectorXd& c) {
  BOUGH_DEMAND(degree >= 2 && degree <= static_cast<int>(degrees_.size()) + 1);
  if (degree == 2) {
    if (G2_.size() == 0) G2_ = MatrixXd::Zero(n_, n_);
    visit_monomials(variables, 2, [&](Eigen::Index i, const Factors& f, double factorial) {
      G2_(f[0], f[1]) += factorial * c[i];
      if (f[0] != f[1]) G2_(f[1], f[0]) += factorial * c[i];
    });
    return;
  }
  BOUGH_DEMAND(variables == large_.modes);
  const auto entries = list_factors(static_cast<int>(large_.size()), degree - 1);
  MatrixXd& G = degrees_[static_cast<std::size_t>(degree) - 2].G;
  visit_monomials(list_all(large_.modes.size()), degree, [&](Eigen::Index i, const Factors& factors, double) {
    for (std::size_t at = 0; at < factors.size(); ++at) {
      Factors rest = factors;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(at));
      G(find_entry(entries, rest), factors[at]) += c[i];  // once for each equal factor
    }
  });
}

Potential& Potential::operator*=(double factor) {
  G2_ *= factor;
  for (Degree& degree : degrees_) degree.G *= factor;
  return *this;
}

double Potential::calc(const ConstVectorRef& eta, double* gradient) const {
  Eigen::Map<VectorXd> g(gradient, n_);
  g.setZero();
  if (G2_.size() > 0) g = G2_.lazyProduct(eta);
  double value = 0.5 * g.dot(eta);
  const Eigen::Index N = large_.size();
  double x[records::kMaxLargeModes], z[kMaxMonomials], part[records::kMaxLargeModes];
  large_.get(eta, x);
  const double* shorter = x;
  for (std::size_t k = 1; k < degrees_.size(); ++k) {
    const Degree &degree = degrees_[k], &before = degrees_[k - 1];
    double* at = z + degree.first;
    for (Eigen::Index f = 0; f < N; ++f) {  // η_f times the monomials without factors before it
      for (int i = before.start[static_cast<std::size_t>(f)]; i < before.size; ++i) *at++ = x[f] * shorter[i];
    }
    while (at < z + degree.first + degree.padded) *at++ = 0;
    shorter = z + degree.first;
    multiply_transposed(degree.G.data(), degree.padded, N, shorter, part);
    double along = 0;
    for (Eigen::Index f = 0; f < N; ++f) {
      if (large_.directions.size() == 0) {
        gradient[large_.modes[static_cast<std::size_t>(f)]] += part[f];
      } else {
        for (int j = 0; j < n_; ++j) gradient[j] += part[f] * large_.directions(f, j);
      }
      along += part[f] * x[f];
    }
    value += along / static_cast<double>(k + 2);
  }
  return value;
}

}  // namespace bough::solver
