#include <algorithm>
#include <map>
#include <numeric>

#include <Eigen/QR>

#include "fe/matrices/wide_part.hpp"
#include "fe/model/element_transform.hpp"
#include "fe/model/rigid.hpp"

namespace bough::fe {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

SparseRows make_rows(Eigen::Index rows, Eigen::Index columns, const Triplets& entries) {
  SparseRows A(rows, columns);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

/// An orthonormal basis of the rows `wide` of T, and their coefficients in it. A link that is attached to the reference
/// of an RBE3 has as many wide rows as dofs, but no new direction.
struct RowBasis {
  std::vector<VectorXd> rows;
  Triplets coefficients;  ///< row of T, basis row
};

/// Nothing if there are more than `max_columns` directions.
std::optional<RowBasis> find_row_basis(const SparseRows& T, const std::vector<int>& wide, std::size_t max_columns) {
  RowBasis basis;
  VectorXd rest = VectorXd::Zero(T.cols());
  for (const int row : wide) {
    rest.setZero();
    for (SparseRows::InnerIterator it(T, row); it; ++it) rest(it.col()) = it.value();
    const double size = rest.norm();
    std::vector<double> c(basis.rows.size(), 0);
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t k = 0; k < c.size(); ++k) {
        const double part = basis.rows[k].dot(rest);
        if (std::abs(part) < 1e-16 * size) continue;
        c[k] += part;
        rest -= part * basis.rows[k];
      }
    for (std::size_t k = 0; k < c.size(); ++k)
      if (c[k] != 0) basis.coefficients.emplace_back(row, static_cast<int>(k), c[k]);
    const double left = rest.norm();
    if (left <= 1e-14 * size) continue;
    if (basis.rows.size() == max_columns) return std::nullopt;
    basis.coefficients.emplace_back(row, static_cast<int>(basis.rows.size()), left);
    basis.rows.push_back(rest / left);
  }
  return basis;
}

/// A number for each f-dof, the same for dofs that elements join.
std::vector<int> find_parts(const Model& model, const SparseRows& T) {
  std::vector<int> parent(static_cast<std::size_t>(T.cols()));
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int f) {
    while (parent[static_cast<std::size_t>(f)] != f)
      f = parent[static_cast<std::size_t>(f)] = parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(f)])];
    return f;
  };
  std::vector<int> columns;
  for (const auto& element : model.elements()) {
    if (element->nodes().size() < 2) continue;
    calc_element_columns(T, element->gdofs(), columns);
    for (const int f : columns) parent[static_cast<std::size_t>(find(f))] = find(columns[0]);
  }
  for (int f = 0; f < T.cols(); ++f) parent[static_cast<std::size_t>(f)] = find(f);
  return parent;
}

/// Displacements of the f-dofs in the rigid-body motions, six columns, rotations times the size of the model.
struct Motions {
  MatrixXd rows;  ///< num_fdofs x 6
  VectorXd unit;  ///< 1 for displacements, the size for rotations
};

Motions calc_motions(const Model& model) {
  Vector3d centre = Vector3d::Zero();
  for (const Node& node : model.nodes()) centre += node.x / static_cast<double>(model.nodes().size());
  double size = 0;
  for (const Node& node : model.nodes()) size = std::max(size, (node.x - centre).norm());
  if (size == 0) size = 1;
  Motions motions{MatrixXd::Zero(model.num_fdofs(), 6), VectorXd::Ones(model.num_fdofs())};
  for (int k = 0; k < static_cast<int>(model.nodes().size()); ++k) {
    const Node& node = model.node(k);
    if (node.num_dofs != 6) continue;
    const auto map = calc_rigid_map(node, centre);
    for (int c = 0; c < 6; ++c) {
      const int f = model.find_fdof(k, c + 1);
      if (f < 0) continue;
      motions.rows.row(f) = map.row(c);
      motions.rows.row(f).tail<3>() /= size;
      if (c > 2) motions.unit(f) = size;
    }
  }
  return motions;
}

/// Up to six of `columns` that tell every rigid-body motion the others do, best conditioned.
std::vector<int> choose_columns(const std::vector<int>& columns, const Motions& motions) {
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
  qr.setThreshold(1e-8);
  qr.compute((motions.unit(columns).asDiagonal() * motions.rows(columns, Eigen::all)).transpose());
  std::vector<int> chosen;
  for (Eigen::Index i = 0; i < qr.rank(); ++i)
    chosen.push_back(columns[static_cast<std::size_t>(qr.colsPermutation().indices()(i))]);
  return chosen;
}

/// Rows of few entries that move with the rigid-body motions of each part as those of G do. Rows that start in the same
/// column, as those of one RBE3 mostly do, share the dofs.
SparseRows find_near_rows(const Model& model, const SparseRows& T, const SparseRows& G) {
  const auto part_of = find_parts(model, T);
  const Motions motions = calc_motions(model);
  std::map<std::pair<int, int>, std::vector<int>> columns_of;  // by first column of the row, part
  const auto first_of = [&](int row) { return static_cast<int>(SparseRows::InnerIterator(G, row).col()) / 6; };
  for (int row = 0; row < G.rows(); ++row)
    for (SparseRows::InnerIterator it(G, row); it; ++it)
      columns_of[{first_of(row), part_of[static_cast<std::size_t>(it.col())]}].push_back(static_cast<int>(it.col()));
  Triplets near;
  for (auto& [key, columns] : columns_of) {
    std::sort(columns.begin(), columns.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    const auto chosen = choose_columns(columns, motions);
    if (chosen.empty()) continue;
    const Eigen::ColPivHouseholderQR<MatrixXd> solver(motions.rows(chosen, Eigen::all).transpose());
    for (int row = 0; row < G.rows(); ++row) {
      if (first_of(row) != key.first) continue;
      VectorXd moved = VectorXd::Zero(6);
      for (SparseRows::InnerIterator it(G, row); it; ++it)
        if (part_of[static_cast<std::size_t>(it.col())] == key.second)
          moved += it.value() * motions.rows.row(it.col()).transpose();
      const VectorXd weight = solver.solve(moved);
      for (std::size_t i = 0; i < chosen.size(); ++i)
        near.emplace_back(row, chosen[i], weight(static_cast<Eigen::Index>(i)));
    }
  }
  return make_rows(G.rows(), G.cols(), near);
}

}  // namespace

int get_max_dense_terms() {
  PetscInt terms = kMaxDenseTerms;
  linear::initialize_petsc();
  linear::check_petsc(PetscOptionsGetInt(nullptr, nullptr, "-bough_max_dense_terms", &terms, nullptr));
  return static_cast<int>(terms);
}

std::optional<SplitTransform> split_transform(const Model& model, bool keeps_supports) {
  constexpr std::size_t max_columns = 240;   // columns of dense storage
  if (model.omitted()) return std::nullopt;  // every row is dense
  const SparseRows& T = model.T();
  for (int limit = get_max_dense_terms(); limit < T.cols(); limit *= 2) {
    std::vector<int> wide;
    for (int row = 0; row < T.rows(); ++row)
      if (T.outerIndexPtr()[row + 1] - T.outerIndexPtr()[row] > limit) wide.push_back(row);
    if (wide.empty()) return std::nullopt;
    const auto basis = find_row_basis(T, wide, max_columns);
    if (!basis) continue;  // the narrowest as any other
    SplitTransform split;
    std::vector<char> is_wide(static_cast<std::size_t>(T.rows()), 0);
    for (const int row : wide) is_wide[static_cast<std::size_t>(row)] = 1;
    split.T = T;
    split.T.prune([&](Eigen::Index row, Eigen::Index, double) { return !is_wide[static_cast<std::size_t>(row)]; });
    const auto r = static_cast<Eigen::Index>(basis->rows.size());
    Triplets entries;
    for (Eigen::Index k = 0; k < r; ++k)
      for (int f = 0; f < T.cols(); ++f)
        if (const double g = basis->rows[static_cast<std::size_t>(k)](f); g != 0)
          entries.emplace_back(static_cast<int>(k), f, g);
    split.P = make_rows(T.rows(), r, basis->coefficients);
    split.G = make_rows(r, T.cols(), entries);
    if (keeps_supports) {
      const SparseRows near = find_near_rows(model, split.T, split.G), moved = split.P * near;
      split.T = (split.T + moved).eval();
      split.G = (split.G - near).eval();
    }
    return split;
  }
  return std::nullopt;
}

}  // namespace bough::fe
