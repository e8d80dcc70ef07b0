#include "stiffening/projected_rows.hpp"

#include <algorithm>

#include "base/diagnostic.hpp"
#include "fe/linear/blas.hpp"

namespace bough::stiffening {

namespace {

constexpr std::size_t kMaxOpenSize = 32'000'000;  // numbers of open groups: 256 MB
constexpr Index kMaxBlockSize = 8'000'000;        // numbers of the rows of one product

std::size_t find(const std::vector<int>& sorted, int value) {
  return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin());
}

void sort_unique(std::vector<int>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

ProjectedRows::ProjectedRows(const MatrixXd& Phi, Index num_loads, std::vector<const std::vector<int>*> elements,
                             std::vector<int> group_of)
    : Phi_(Phi),
      n_(Phi.cols()),
      m_(num_loads),
      elements_(std::move(elements)),
      group_of_(std::move(group_of)),
      sums_(MatrixXd::Zero(m_ * n_, n_)) {
  const Index num_rows = std::clamp<Index>(kMaxBlockSize / std::max<Index>(1, m_ * n_), 48, 384);
  L_Phi_.resize(m_ * n_, num_rows);
  Phi_rows_.resize(num_rows, n_);
  const auto num_groups = group_of_.empty() ? 0 : static_cast<std::size_t>(group_of_.back()) + 1;
  elements_of_.resize(num_groups);
  groups_.resize(num_groups);
  for (std::size_t e = 0; e < elements_.size(); ++e)
    for (const int dof : *elements_[e]) {
      auto& of_group = elements_of_[static_cast<std::size_t>(group_of_[static_cast<std::size_t>(dof)])];
      if (of_group.empty() || of_group.back() != static_cast<int>(e)) of_group.push_back(static_cast<int>(e));
    }
  for (const auto& list : elements_of_) left_.push_back(static_cast<int>(list.size()));
}

ProjectedRows::Group& ProjectedRows::open(int group) {
  Group& opened = groups_[static_cast<std::size_t>(group)];
  if (!opened.L.empty()) return opened;
  if (opened.rows.empty()) {
    for (const int e : elements_of_[static_cast<std::size_t>(group)])
      for (const int dof : *elements_[static_cast<std::size_t>(e)]) {
        const int of_dof = group_of_[static_cast<std::size_t>(dof)];
        if (of_dof <= group) opened.columns.push_back(dof);
        if (of_dof == group) opened.rows.push_back(dof);
      }
    sort_unique(opened.rows);
    sort_unique(opened.columns);
  }
  opened.L.assign(opened.rows.size() * opened.columns.size() * static_cast<std::size_t>(m_), 0.0);
  open_.push_back(group);
  open_size_ += opened.L.size();
  return opened;
}

void ProjectedRows::add(std::size_t e, const std::vector<int>& entries, const MatrixXd& values) {
  const auto& dofs = *elements_[e];
  BOUGH_DEMAND(values.rows() == static_cast<Index>(entries.size()) && values.cols() == m_);
  // The position of each entry in the L of its group, and the distance to the next load.
  struct Place {
    double* at;
    std::size_t stride;
    double factor;
  };
  std::vector<Place> places;
  places.reserve(entries.size());
  std::size_t j = 0, first = 0;  // of column j
  for (const int entry : entries) {
    while (static_cast<std::size_t>(entry) > first + j) first += ++j;
    const std::size_t i = static_cast<std::size_t>(entry) - first;
    const int row = std::max(dofs[i], dofs[j]), column = std::min(dofs[i], dofs[j]);
    Group& group = open(group_of_[static_cast<std::size_t>(row)]);
    const auto num_columns = group.columns.size();
    const auto at = find(group.rows, row) * num_columns + find(group.columns, column);
    places.push_back({group.L.data() + at, num_columns * group.rows.size(), i == j ? 0.5 : 1});
  }
  for (Index c = 0; c < m_; ++c) {
    const double* value = values.col(c).data();
    for (auto& place : places) {
      *place.at += place.factor * *value++;
      place.at += place.stride;
    }
  }
  std::vector<int> own;
  for (const int dof : dofs) own.push_back(group_of_[static_cast<std::size_t>(dof)]);
  sort_unique(own);
  for (const int g : own)
    if (--left_[static_cast<std::size_t>(g)] == 0) close(groups_[static_cast<std::size_t>(g)]);
  if (open_size_ < kMaxOpenSize) return;
  // Incomplete rows are multiplied in two parts: now, and later with their other elements.
  for (const int g : open_) close(groups_[static_cast<std::size_t>(g)]);
  open_.clear();
}

void ProjectedRows::close(Group& group) {
  if (group.L.empty()) return;
  const auto num_rows = static_cast<Index>(group.rows.size()), num_columns = static_cast<Index>(group.columns.size());
  const Eigen::Map<const MatrixXd> L(group.L.data(), num_columns * num_rows, m_);
  const MatrixXd Phi_columns = Phi_(group.columns, Eigen::all);
  MatrixXd packed(num_columns, m_), Phi_packed(num_columns, n_);
  std::vector<int> kept;
  for (Index r = 0; r < num_rows; ++r) {
    const auto row = L.middleRows(r * num_columns, num_columns);
    kept.clear();
    for (int k = 0; k < num_columns; ++k)
      if (!row.row(k).isZero(0)) kept.push_back(k);
    if (kept.empty()) continue;
    const auto num_kept = static_cast<Index>(kept.size());
    packed.topRows(num_kept) = row(kept, Eigen::all);
    Phi_packed.topRows(num_kept) = Phi_columns(kept, Eigen::all);
    if (used_ == L_Phi_.cols()) flush();
    Eigen::Map<MatrixXd> L_Phi(L_Phi_.col(used_).data(), m_, n_);
    linear::multiply_dense(true, packed.topRows(num_kept), Phi_packed.topRows(num_kept), 0, L_Phi);
    rows_.push_back(group.rows[static_cast<std::size_t>(r)]);
    ++used_;
  }
  open_size_ -= group.L.size();
  group.L = std::vector<double>();  // {} would keep its memory
  if (left_[static_cast<std::size_t>(&group - groups_.data())] == 0) group = {};
}

void ProjectedRows::flush() {
  if (used_ == 0) return;
  Phi_rows_.topRows(used_) = Phi_(rows_, Eigen::all);
  linear::multiply_dense(false, L_Phi_.leftCols(used_), Phi_rows_.topRows(used_), 1, sums_);
  used_ = 0;
  rows_.clear();
}

std::vector<MatrixXd> ProjectedRows::finish() {
  for (auto& group : groups_) close(group);
  open_.clear();
  flush();
  std::vector<MatrixXd> result;
  for (Index c = 0; c < m_; ++c) {
    MatrixXd& K = result.emplace_back(n_, n_);
    for (Index j = 0; j < n_; ++j)
      for (Index i = 0; i <= j; ++i) K(i, j) = K(j, i) = sums_(c + m_ * j, i) + sums_(c + m_ * i, j);
  }
  return result;
}

}  // namespace bough::stiffening
