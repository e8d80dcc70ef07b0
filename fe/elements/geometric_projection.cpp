#include "fe/elements/geometric_projection.hpp"

#include <algorithm>

#include "fe/linear/blas.hpp"

namespace bough::fe {

namespace {
/// With 20 modes 512 of them fill 0.9 MB; with a thousand fewer fill 64 MB.
Eigen::Index choose_capacity(Eigen::Index num_products) {
  return std::clamp<Eigen::Index>(8'000'000 / std::max<Eigen::Index>(1, num_products), 16, 512);
}

}  // namespace

GeometricProjection::GeometricProjection(Eigen::Index num_columns, Eigen::Index num_loads)
    : n_(num_columns),
      products_(n_ * (n_ + 1) / 2, choose_capacity(n_ * (n_ + 1) / 2)),
      weights_(products_.cols(), num_loads),
      sums_(MatrixXd::Zero(products_.rows(), num_loads)) {}

GeometricProjection::Terms GeometricProjection::add_terms(Eigen::Index num_terms) {
  if (used_ + num_terms > products_.cols()) flush();
  if (num_terms > products_.cols()) {
    products_.resize(Eigen::NoChange, num_terms);
    weights_.resize(num_terms, Eigen::NoChange);
  }
  Terms terms{products_.middleCols(used_, num_terms), weights_.middleRows(used_, num_terms)};
  terms.products.setZero();
  terms.weights.setZero();
  used_ += num_terms;
  return terms;
}

void GeometricProjection::flush() {
  linear::multiply_dense(false, products_.leftCols(used_), weights_.topRows(used_), 1, sums_);
  used_ = 0;
}

std::vector<Eigen::MatrixXd> GeometricProjection::finish() {
  flush();
  std::vector<MatrixXd> result;
  for (Eigen::Index c = 0; c < num_loads(); ++c) {
    MatrixXd& K_G = result.emplace_back(n_, n_);
    for (Eigen::Index j = 0, k = 0; j < n_; ++j)
      for (Eigen::Index i = 0; i <= j; ++i, ++k) K_G(i, j) = K_G(j, i) = sums_(k, c);
  }
  return result;
}

void add_square(const Field& a, double scale, Product product) {
  double* out = product.data();
  for (Eigen::Index j = 0; j < a.size(); out += ++j) {
    const double b = scale * a[j];
    for (Eigen::Index i = 0; i <= j; ++i) out[i] += a[i] * b;
  }
}

void add_cross(const Field& a, const Field& b, double scale, Product product) {
  double* out = product.data();
  for (Eigen::Index j = 0; j < a.size(); out += ++j) {
    const double a_j = scale * a[j], b_j = scale * b[j];
    for (Eigen::Index i = 0; i <= j; ++i) out[i] += a[i] * b_j + b[i] * a_j;
  }
}

void add_projection(const Eigen::Ref<const Eigen::MatrixXd>& K, const Eigen::Ref<const Eigen::MatrixXd>& Phi,
                    Product product) {
  Eigen::MatrixXd K_Phi(K.rows(), Phi.cols()), full(Phi.cols(), Phi.cols());
  linear::multiply_dense(false, K, Phi, 0, K_Phi);
  linear::multiply_dense(true, Phi, K_Phi, 0, full);
  for (Eigen::Index j = 0, k = 0; j < full.cols(); k += ++j)
    product.segment(k, j + 1) += 0.5 * (full.col(j).head(j + 1) + full.row(j).head(j + 1).transpose());
}

}  // namespace bough::fe
