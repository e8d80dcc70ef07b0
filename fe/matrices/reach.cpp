#include "fe/matrices/reach.hpp"

#include <algorithm>
#include <numeric>

#include "fe/linear/blas.hpp"
#include "fe/linear/threads.hpp"

namespace bough::fe {

Reach find_reach(const Model& model) {
  Reach reach;
  if (!model.share()) {
    reach.gdofs.resize(static_cast<size_t>(model.num_gdofs()));
    std::iota(reach.gdofs.begin(), reach.gdofs.end(), 0);
    return reach;
  }
  reach.place.assign(static_cast<size_t>(model.num_gdofs()), -1);
  for (const int e : model.share()->owned)
    for (const int g : model.elements()[static_cast<size_t>(e)]->gdofs()) reach.place[static_cast<size_t>(g)] = 0;
  for (size_t k = 0; k < model.nodes().size(); ++k)
    if (model.share()->is_at_home(static_cast<int>(k)))
      std::fill_n(reach.place.begin() + model.nodes()[k].first_gdof, model.nodes()[k].num_dofs, 0);
  for (size_t g = 0; g < reach.place.size(); ++g) {
    if (reach.place[g] < 0) continue;
    reach.place[g] = static_cast<int>(reach.gdofs.size());
    reach.gdofs.push_back(static_cast<int>(g));
  }
  return reach;
}

MatrixXd expand(const Model& model, const OwnRows& rows, const Reach& reach, const Eigen::Ref<const MatrixXd>& X) {
  if (!rows.is_cut) {
    MatrixXd U(model.num_gdofs(), X.cols());
    do_columns(X.rows(), X.cols(), [&](int from, int to) {
      U.middleCols(from, to - from).noalias() = model.T() * X.middleCols(from, to - from);
    });
    return U;
  }
  constexpr Eigen::Index kAtOnce = 4;
  MatrixXd field = MatrixXd::Zero(static_cast<Eigen::Index>(reach.gdofs.size()), X.cols());
  for (Eigen::Index c = 0; c < X.cols(); c += kAtOnce) {
    const Eigen::Index num = std::min(kAtOnce, X.cols() - c);
    const MatrixXd whole = rows.replicate(X.middleCols(c, num));
    for (size_t i = 0; i < reach.gdofs.size(); ++i)
      for (SparseRows::InnerIterator it(model.T(), reach.gdofs[i]); it; ++it)
        for (Eigen::Index k = 0; k < num; ++k)
          field(static_cast<Eigen::Index>(i), c + k) += it.value() * whole(it.col(), k);
  }
  return field;
}

namespace {

/// work(first, number, M X of these columns): enough that the matrices of elements count for little beside them.
template <class Work>
void visit_mass_times(const Model& model, MassKind kind, const Reach& reach, const MatrixXd& X, Work work) {
  for (Eigen::Index c = 0; c < X.cols(); c += kColumnsAtOnce) {
    const Eigen::Index num = std::min(kColumnsAtOnce, X.cols() - c);
    work(c, num, calc_own_mass_times(model, kind, reach, X.middleCols(c, num)));
  }
}

}  // namespace

MatrixXd calc_mass_gram(const Model& model, MassKind kind, const Reach& reach, const MatrixXd& X) {
  MatrixXd G(X.cols(), X.cols());
  visit_mass_times(model, kind, reach, X, [&](Eigen::Index c, Eigen::Index num, const MatrixXd& M_X) {
    multiply_dense(true, X.leftCols(c + num), M_X, 0, G.block(0, c, c + num, num));
  });
  G.triangularView<Eigen::StrictlyLower>() = G.transpose();
  sum_alike(G);
  return G;
}

VectorXd calc_modal_mass(const Model& model, MassKind kind, const Reach& reach, const MatrixXd& X) {
  VectorXd mass(X.cols());
  visit_mass_times(model, kind, reach, X, [&](Eigen::Index c, Eigen::Index num, const MatrixXd& M_X) {
    mass.segment(c, num) = X.middleCols(c, num).cwiseProduct(M_X).colwise().sum();
  });
  sum_alike(mass);
  return mass;
}

MatrixXd take_rigid_modes(const Model& model, const Reach& reach, const Vector3d& point) {
  const MatrixXd Phi_R = model.calc_rigid_modes(point);
  return reach.place.empty() ? Phi_R : MatrixXd(Phi_R(reach.gdofs, Eigen::all));
}

}  // namespace bough::fe
