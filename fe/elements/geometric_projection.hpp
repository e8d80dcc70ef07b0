#pragma once
/// \file Sums Φᵀ K_G Φ of many elements for several loads at once, by products of fields that no load changes.
#include <vector>

#include <Eigen/Dense>

namespace bough::fe {

/// Σ_e Σ_k P_k w_kc for m loads c. P_k: symmetric, n x n, of the element and the n columns of Φ, as its upper triangle
/// column after column; w_kc: what load c gives it. Thousands of P_k make one product of the BLAS.
class GeometricProjection {
 public:
  using MatrixXd = Eigen::MatrixXd;
  using VectorXd = Eigen::VectorXd;

  GeometricProjection(Eigen::Index num_columns, Eigen::Index num_loads);

  /// Number m of loads.
  Eigen::Index num_loads() const { return weights_.cols(); }

  /// Room for the terms of one element, all zero. Good until the next call.
  struct Terms {
    Eigen::Ref<MatrixXd> products;  ///< n(n+1)/2 x terms
    Eigen::Ref<MatrixXd> weights;   ///< terms x m
  };
  /// Reserves terms of one element; sums up the terms before them if they do not fit.
  Terms add_terms(Eigen::Index num_terms);

  /// Terms that are not yet summed: after drop_terms(), those of the last add_terms().
  Terms last_terms() { return {products_.leftCols(used_), weights_.topRows(used_)}; }
  /// Leaves them out of the sum.
  void drop_terms() { used_ = 0; }

  /// Φᵀ K_G Φ for every load: m matrices n x n.
  std::vector<MatrixXd> finish();

 private:
  void flush();

  Eigen::Index n_, used_ = 0;
  MatrixXd products_, weights_, sums_;
};

using Field = Eigen::Ref<const Eigen::VectorXd>;  ///< one value per column of Φ
using Product = Eigen::Ref<Eigen::VectorXd>;      ///< upper triangle

/// product += scale a aᵀ.
void add_square(const Field& a, double scale, Product product);
/// product += scale (a bᵀ + b aᵀ).
void add_cross(const Field& a, const Field& b, double scale, Product product);
/// product += Φᵀ K Φ, K N x N symmetric up to roundoff.
void add_projection(const Eigen::Ref<const Eigen::MatrixXd>& K, const Eigen::Ref<const Eigen::MatrixXd>& Phi,
                    Product product);

}  // namespace bough::fe
