#include "fe/matrices/wide_part.hpp"

#include <algorithm>

namespace bough::fe {
namespace {

using SparseColumns = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// V = sparseᵀ A P and P ᵀA P, summed matrix by matrix.
class Products {
 public:
  Products(const SparseRows& T, const SparseRows& P) : T_(T), P_(P), K_(MatrixXd::Zero(P.cols(), P.cols())) {
    is_moved_.resize(static_cast<std::size_t>(P.rows()));
    for (int g = 0; g < P.rows(); ++g) is_moved_[static_cast<std::size_t>(g)] = SparseRows::InnerIterator(P, g) ? 1 : 0;
  }
  bool touches(const std::vector<int>& gdofs) const {
    return std::any_of(gdofs.begin(), gdofs.end(), [&](int g) { return is_moved_[static_cast<std::size_t>(g)] != 0; });
  }
  void add(const std::vector<int>& gdofs, const MatrixXd& A) {
    MatrixXd P_e = MatrixXd::Zero(A.rows(), P_.cols());
    for (int i = 0; i < A.rows(); ++i)
      for (SparseRows::InnerIterator it(P_, gdofs[static_cast<std::size_t>(i)]); it; ++it)
        P_e(i, it.col()) = it.value();
    const MatrixXd AP = A * P_e;
    K_ += P_e.transpose() * AP;
    for (int i = 0; i < A.rows(); ++i)
      for (SparseRows::InnerIterator it(T_, gdofs[static_cast<std::size_t>(i)]); it; ++it)
        for (int w = 0; w < AP.cols(); ++w)
          if (AP(i, w) != 0) V_.emplace_back(static_cast<int>(it.col()), w, it.value() * AP(i, w));
  }
  linear::LowRankPart finish(const SparseColumns& D) const {
    SparseColumns V(T_.cols(), P_.cols());
    V.setFromTriplets(V_.begin(), V_.end());
    return linear::make_product_part(D, V, K_);
  }

 private:
  const SparseRows &T_, &P_;
  std::vector<char> is_moved_;
  MatrixXd K_;
  Triplets V_;
};

}  // namespace

linear::LowRankPart calc_wide_part(const Model& model, const SplitTransform& split, const AddElementMatrix& add,
                                   const std::vector<QuadraticForm>& forms) {
  Products products(split.T, split.P);
  MatrixXd A;
  for (const auto& element : model.elements()) {
    if (!products.touches(element->gdofs())) continue;
    A.setZero(element->num_dofs(), element->num_dofs());
    add(*element, A);
    if (!A.isZero(0)) products.add(element->gdofs(), A);
  }
  for (const auto& form : forms)
    if (products.touches(form.gdofs)) products.add(form.gdofs, calc_form(form, 0));
  return products.finish(split.G.transpose());
}

linear::LowRankPart take_wide_forms(const Model& model, std::vector<QuadraticForm>& forms) {
  constexpr Eigen::Index max_columns = 500;  // columns of dense storage
  const auto count = [&](std::size_t limit) {
    Eigen::Index rows = 0;
    for (const auto& form : forms)
      if (form.gdofs.size() > limit) rows += form.L.rows();
    return rows;
  };
  auto limit = static_cast<std::size_t>(get_max_dense_terms());
  while (count(limit) > max_columns) limit *= 2;
  linear::LowRankPart part;
  for (const auto& form : forms) {
    if (form.gdofs.size() <= limit) continue;
    Triplets entries;
    for (int r = 0; r < form.L.rows(); ++r)
      for (std::size_t i = 0; i < form.gdofs.size(); ++i)
        if (const double l = form.L(r, static_cast<Eigen::Index>(i)); l != 0)
          for (SparseRows::InnerIterator it(model.T(), form.gdofs[i]); it; ++it)
            entries.emplace_back(static_cast<int>(it.col()), r, l * it.value());
    SparseColumns X(model.num_fdofs(), form.L.rows());
    X.setFromTriplets(entries.begin(), entries.end());
    MatrixXd W(form.L.rows(), form.L.rows());
    const auto r = static_cast<int>(W.rows());
    for (int j = 0; j < r; ++j)
      for (int i = j; i < r; ++i) W(i, j) = W(j, i) = form.weights(find_weight(r, i, j), 0);
    part = join(part, 1, linear::make_form_part(X, W), 1);
  }
  std::erase_if(forms, [&](const QuadraticForm& form) { return form.gdofs.size() > limit; });
  return part;
}

}  // namespace bough::fe
