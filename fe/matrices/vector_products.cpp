#include "fe/matrices/vector_products.hpp"

#include <algorithm>

#include "fe/linear/blas.hpp"
#include "fe/linear/threads.hpp"

namespace bough::fe {

MatrixXd expand(const Model& model, const Eigen::Ref<const MatrixXd>& X) {
  MatrixXd U(model.num_gdofs(), X.cols());
  linear::do_columns(X.rows(), X.cols(), [&](int from, int to) {
    U.middleCols(from, to - from).noalias() = model.T() * X.middleCols(from, to - from);
  });
  return U;
}

MatrixXd calc_mass_gram(const Model& model, MassKind kind, const MatrixXd& X) {
  MatrixXd G(X.cols(), X.cols());
  for (Eigen::Index c = 0; c < X.cols(); c += kColumnsAtOnce) {
    const Eigen::Index num = std::min(kColumnsAtOnce, X.cols() - c);
    linear::multiply_dense(true, X.leftCols(c + num), calc_mass_times(model, kind, X.middleCols(c, num)), 0,
                           G.block(0, c, c + num, num));
  }
  G.triangularView<Eigen::StrictlyLower>() = G.transpose();
  return G;
}

VectorXd calc_modal_mass(const Model& model, MassKind kind, const MatrixXd& X) {
  VectorXd mass(X.cols());
  for (Eigen::Index c = 0; c < X.cols(); c += kColumnsAtOnce) {
    const Eigen::Index num = std::min(kColumnsAtOnce, X.cols() - c);
    mass.segment(c, num) =
        X.middleCols(c, num).cwiseProduct(calc_mass_times(model, kind, X.middleCols(c, num))).colwise().sum();
  }
  return mass;
}

}  // namespace bough::fe
