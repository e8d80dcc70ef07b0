#include "fe/model/element_transform.hpp"

#include <algorithm>

namespace bough::fe {

void calc_element_columns(const SparseRows& T, const std::vector<int>& gdofs, std::vector<int>& columns) {
  columns.clear();
  for (int g : gdofs)
    for (SparseRows::InnerIterator it(T, g); it; ++it) columns.push_back(static_cast<int>(it.col()));
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
}

void ElementTransform::set(const SparseRows& T, const std::vector<int>& gdofs) {
  calc_element_columns(T, gdofs, columns_);
  read(T, gdofs);
}

void ElementTransform::set(const SparseRows& T, const std::vector<int>& gdofs, std::span<const int> columns) {
  columns_.assign(columns.begin(), columns.end());
  read(T, gdofs);
}

void ElementTransform::read(const SparseRows& T, const std::vector<int>& gdofs) {
  const auto find = [this](int column) {
    return static_cast<int>(std::lower_bound(columns_.begin(), columns_.end(), column) - columns_.begin());
  };
  const int num = static_cast<int>(gdofs.size());
  is_selection_ = true;
  selected_.assign(num, -1);
  for (int i = 0; i < num && is_selection_; ++i) {
    int count = 0;
    for (SparseRows::InnerIterator it(T, gdofs[i]); it; ++it) {
      is_selection_ = is_selection_ && ++count == 1 && it.value() == 1;
      selected_[i] = find(static_cast<int>(it.col()));
    }
  }
  if (is_selection_) return;
  T_e_.setZero(num, static_cast<int>(columns_.size()));
  for (int i = 0; i < num; ++i)
    for (SparseRows::InnerIterator it(T, gdofs[i]); it; ++it) T_e_(i, find(static_cast<int>(it.col()))) = it.value();
}

const MatrixXd& ElementTransform::project(const Eigen::Ref<const MatrixXd>& K_e) {
  if (!is_selection_) {
    K_T_.noalias() = K_e * T_e_;
    K_f_.noalias() = T_e_.transpose() * K_T_;
    return K_f_;
  }
  const int size = static_cast<int>(columns_.size()), num = static_cast<int>(selected_.size());
  K_f_.setZero(size, size);
  for (int j = 0; j < num; ++j) {
    if (selected_[j] < 0) continue;
    for (int i = 0; i < num; ++i)
      if (selected_[i] >= 0) K_f_(selected_[i], selected_[j]) += K_e(i, j);
  }
  return K_f_;
}

void ElementTransform::hold(const Eigen::Ref<const MatrixXd>& K_e) {
  if (is_selection_)
    project(K_e);
  else
    K_T_.noalias() = K_e * T_e_;
}

const VectorXd& ElementTransform::project_diagonal(const Eigen::Ref<const VectorXd>& d) {
  d_f_.setZero(static_cast<int>(columns_.size()));
  if (!is_selection_) {
    d_f_.noalias() = T_e_.cwiseAbs2().transpose() * d;
    return d_f_;
  }
  for (size_t i = 0; i < selected_.size(); ++i)
    if (selected_[i] >= 0) d_f_(selected_[i]) += d(static_cast<int>(i));
  return d_f_;
}

}  // namespace bough::fe
