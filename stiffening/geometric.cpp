#include "bough/fe/blas.hpp"
#include "bough/stiffening/reduce.hpp"

namespace bough::stiffening {

namespace {

/// Sums Φ_eᵀ K_G,c Φ_e of element after element, many elements a product: W_c = [Φ_1ᵀ K_1c, Φ_2ᵀ K_2c, ...], then W_c
/// Φ.
class LoadSums {
 public:
  LoadSums(Eigen::Index n, Eigen::Index m) : n_(n), m_(m), W_(n, kDofs * m), Phi_(kDofs, n), sum_(n, n * m) {
    sum_.setZero();
  }
  /// K_all: [K_G,1 ... K_G,m] of one element, N x N m; Phi_e N x n.
  void add(const MatrixXd& K_all, const MatrixXd& Phi_e) {
    const Eigen::Index N = Phi_e.rows();
    if (used_ + N > kDofs) flush();
    if (product_.cols() != N * m_) product_.resize(n_, N * m_);
    fe::multiply_dense(true, Phi_e, K_all, 0, product_);
    for (Eigen::Index c = 0; c < m_; ++c) W_.middleCols(kDofs * c + used_, N) = product_.middleCols(N * c, N);
    Phi_.middleRows(used_, N) = Phi_e;
    used_ += N;
  }
  /// n x n m: the sums of all loads side by side.
  const MatrixXd& finish() {
    flush();
    return sum_;
  }

 private:
  static constexpr Eigen::Index kDofs = 768;  // 32 four-node shells: W of 18 loads and 20 modes is 2 MB

  void flush() {
    if (used_ == 0) return;
    for (Eigen::Index c = 0; c < m_; ++c)
      fe::multiply_dense(false, W_.middleCols(kDofs * c, used_), Phi_.topRows(used_), 1, sum_.middleCols(n_ * c, n_));
    used_ = 0;
  }

  Eigen::Index n_, m_, used_ = 0;
  MatrixXd W_, Phi_, product_, sum_;
};

}  // namespace

std::vector<MatrixXd> calc_generalized_geometric_stiffness(const fe::Model& model, const MatrixXd& U,
                                                           const MatrixXd& Phi) {
  BOUGH_DEMAND(U.rows() == model.num_gdofs() && Phi.rows() == model.num_gdofs());
  const Eigen::Index n = Phi.cols(), m = U.cols();
  MatrixXd sum = MatrixXd::Zero(n * n, m);
  LoadSums by_load(n, m);
  MatrixXd U_e, Phi_e, force, K_G, K_all, projected;
  const auto [first, last] = fe::calc_element_range(model);
  for (int e = first; e < last; ++e) {
    const auto& element = *model.elements()[e];
    const int s = element.num_internal_forces(), N = element.num_dofs();
    if (s == 0 || n == 0 || m == 0) continue;
    U_e = U(element.gdofs(), Eigen::all);
    Phi_e = Phi(element.gdofs(), Eigen::all);
    force.resize(s, m);
    for (Eigen::Index c = 0; c < m; ++c) element.calc_internal_forces(U_e.col(c), force.col(c));

    if (s >= m) {
      K_all.setZero(N, N * m);
      for (Eigen::Index c = 0; c < m; ++c) element.add_geometric_stiffness(force.col(c), 1, K_all.middleCols(N * c, N));
      by_load.add(K_all, Phi_e);
      continue;
    }
    // K_G is linear in the internal forces: project the s unit ones, fewer than the loads.
    projected.resize(n * n, s);
    for (int i = 0; i < s; ++i) {
      K_G.setZero(N, N);
      element.add_geometric_stiffness(VectorXd::Unit(s, i), 1, K_G);
      projected.col(i) = (Phi_e.transpose() * K_G * Phi_e).reshaped();
    }
    sum.noalias() += projected * force;
  }
  if (n > 0 && m > 0) sum += by_load.finish().reshaped(n * n, m);
  fe::sum_over_ranks(sum);

  std::vector<MatrixXd> result;
  for (Eigen::Index c = 0; c < m; ++c) {
    const MatrixXd total = sum.col(c).reshaped(n, n);
    result.push_back(0.5 * (total + total.transpose()));
  }
  return result;
}

}  // namespace bough::stiffening
