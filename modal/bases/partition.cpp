#include "modal/bases/partition.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "fe/linear/factor.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "fe/matrices/wide_part.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::bases {

namespace {

using Row = std::map<int, double>;  ///< by f-dof

/// The displacement of a node along an axis of its displacement system, or of a scalar point, as a row over the f-set.
Row make_row(const fe::Model& model, int node_index, int component) {
  const int fdof = model.find_fdof(node_index, component);
  if (fdof >= 0) return {{fdof, 1.0}};
  const auto& node = model.node(node_index);
  const int c = component - 1;
  Row row;
  if (node.num_dofs == 1) {
    for (SparseRows::InnerIterator it(model.T(), node.first_gdof); it; ++it)
      row[static_cast<int>(it.col())] += it.value();
    return row;
  }
  for (int k = 0; k < 3; ++k) {
    const double weight = node.R_basic_cd(k, c % 3);
    if (weight == 0) continue;
    for (SparseRows::InnerIterator it(model.T(), node.first_gdof + 3 * (c / 3) + k); it; ++it)
      row[static_cast<int>(it.col())] += weight * it.value();
  }
  return row;
}

double find_largest(const Row& row) {
  double largest = 0;
  for (const auto& entry : row) largest = std::max(largest, std::abs(entry.second));
  return largest;
}

/// Rows reduced one after the other by those before: pivots[i] is where row i is eliminated from.
struct Elimination {
  std::vector<Row> rows, reduced;
  std::vector<int> pivots;

  /// False when the row follows from the others.
  bool add(const Row& row) {
    Row rest = row;
    const double scale = find_largest(row);
    for (std::size_t i = 0; i < reduced.size(); ++i) {
      const auto found = rest.find(pivots[i]);
      if (found == rest.end()) continue;
      const double factor = found->second / reduced[i].at(pivots[i]);
      for (const auto& [column, value] : reduced[i]) rest[column] -= factor * value;
      rest.erase(pivots[i]);
    }
    const double largest = find_largest(rest);
    if (largest <= detail::kDependentEquation * scale) return false;
    int pivot = -1;
    for (const auto& [column, value] : rest)
      if (pivot < 0 && std::abs(value) >= (1 - detail::kEqualPivot) * largest) pivot = column;
    rows.push_back(row);
    reduced.push_back(std::move(rest));
    pivots.push_back(pivot);
    return true;
  }
};

}  // namespace

Partition make_partition(const fe::Model& model, const std::vector<int>& nodes, Diagnostics& diagnostics) {
  Partition part;
  Elimination elimination;
  // Direct dofs first: they need no pivot of another node.
  struct Candidate {
    int node, component;
    Row row;
  };
  std::vector<Candidate> direct, dependent;
  std::vector<std::pair<int, int>> order;
  for (const int id : nodes) {
    const int index = model.find_node(id);
    BOUGH_DEMAND(index >= 0);
    for (int c = 1; c <= model.node(index).num_dofs; ++c) {
      if (std::find(order.begin(), order.end(), std::pair{id, c}) != order.end()) continue;
      Row row = make_row(model, index, c);
      if (find_largest(row) == 0) continue;
      order.emplace_back(id, c);
      (model.find_fdof(index, c) >= 0 ? direct : dependent).push_back({id, c, std::move(row)});
    }
  }
  std::map<std::pair<int, int>, int> place;  // in the elimination
  for (auto* list : {&direct, &dependent}) {
    for (const auto& candidate : *list) {
      if (elimination.add(candidate.row)) {
        place[{candidate.node, candidate.component}] = static_cast<int>(elimination.rows.size()) - 1;
        continue;
      }
      diagnostics.warning("modal.dependent-interface", {},
                          "interface node " + std::to_string(candidate.node) + " component " +
                              std::to_string(candidate.component) + " follows from the other interface dofs",
                          "leave the node out of the interface, or the nodes that it is attached to");
    }
  }
  std::vector<int> rows;
  for (const auto& dof : order) {
    const auto found = place.find(dof);
    if (found == place.end()) continue;
    part.boundary.push_back(dof);
    rows.push_back(found->second);
  }

  const int nf = model.num_fdofs(), nb = part.num_boundary();
  std::vector<char> is_pivot(static_cast<std::size_t>(nf), 0);
  std::vector<int> pivots(static_cast<std::size_t>(nb));
  for (int b = 0; b < nb; ++b) is_pivot[pivots[b] = elimination.pivots[rows[b]]] = 1;
  std::vector<int> column(static_cast<std::size_t>(nf), -1);
  for (int f = 0; f < nf; ++f) {
    if (is_pivot[f]) continue;
    column[f] = static_cast<int>(part.interior.size());
    part.interior.push_back(f);
  }
  // u_b = B_p q_p + B_i q_i, so q_p = B_p^-1 (u_b - B_i q_i).
  MatrixXd B_p(nb, nb);
  std::map<int, int> others;  // interior f-dofs in T_b
  for (int b = 0; b < nb; ++b)
    for (const auto& entry : elimination.rows[rows[b]])
      if (!is_pivot[entry.first]) others.emplace(entry.first, static_cast<int>(others.size()));
  MatrixXd B_i = MatrixXd::Zero(nb, static_cast<Eigen::Index>(others.size()));
  for (int b = 0; b < nb; ++b) {
    const Row& row = elimination.rows[rows[b]];
    for (int p = 0; p < nb; ++p) {
      const auto found = row.find(pivots[p]);
      B_p(b, p) = found == row.end() ? 0 : found->second;
    }
    for (const auto& [f, value] : row)
      if (!is_pivot[f]) B_i(b, others.at(f)) = value;
  }
  const Eigen::PartialPivLU<MatrixXd> lu(B_p);
  const MatrixXd inverse = nb > 0 ? MatrixXd(lu.inverse()) : MatrixXd(0, 0);
  part.S_b = MatrixXd::Zero(nf, nb);
  for (int p = 0; p < nb; ++p) part.S_b.row(pivots[p]) = inverse.row(p);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < part.interior.size(); ++i) entries.emplace_back(part.interior[i], static_cast<int>(i), 1);
  if (!others.empty()) {
    const MatrixXd G = -lu.solve(B_i);
    for (int p = 0; p < nb; ++p)
      for (const auto& [f, j] : others)
        if (G(p, j) != 0) entries.emplace_back(pivots[p], column[f], G(p, j));
  }
  part.S_i.resize(nf, static_cast<Eigen::Index>(part.interior.size()));
  part.S_i.setFromTriplets(entries.begin(), entries.end());
  return part;
}

linear::PetscMat make_petsc(const SparseRows& S, const linear::SymmetricMatrix& A) {
  using linear::check_petsc;
  PetscInt first = 0, last = 0;
  check_petsc(MatGetOwnershipRange(A.sparse(), &first, &last));
  std::vector<PetscInt> starts{0}, columns;
  std::vector<PetscScalar> values;
  for (PetscInt i = first; i < last; ++i) {
    for (SparseRows::InnerIterator it(S, i); it; ++it) {
      columns.push_back(static_cast<PetscInt>(it.col()));
      values.push_back(it.value());
    }
    starts.push_back(static_cast<PetscInt>(columns.size()));
  }
  linear::PetscMat result;
  check_petsc(MatCreate(PETSC_COMM_WORLD, result.out()));
  check_petsc(MatSetSizes(result.get(), last - first, PETSC_DECIDE, PETSC_DETERMINE, static_cast<PetscInt>(S.cols())));
  check_petsc(MatSetType(result.get(), MATAIJ));
  // One of the two calls acts: that of the matrix type of one process, or of several.
  check_petsc(MatSeqAIJSetPreallocationCSR(result.get(), starts.data(), columns.data(), values.data()));
  check_petsc(MatMPIAIJSetPreallocationCSR(result.get(), starts.data(), columns.data(), values.data()));
  return result;
}

namespace {

using SparseColumns = Eigen::SparseMatrix<double>;

/// Rows of S with more than max_terms entries, which would couple all their columns.
std::vector<int> find_wide_rows(const SparseRows& S, int max_terms) {
  std::vector<int> rows;
  for (int i = 0; i < S.rows(); ++i)
    if (S.row(i).nonZeros() > max_terms) rows.push_back(i);
  return rows;
}

}  // namespace

linear::SymmetricMatrix calc_triple_product(const linear::SymmetricMatrix& A, const SparseRows& S) {
  const std::vector<int> wide = find_wide_rows(S, fe::get_max_dense_terms());
  const auto r = static_cast<Eigen::Index>(wide.size());
  linear::LowRankPart part;
  SparseRows S_0 = S;
  if (r > 0) {
    // S = S_0 + P H, P the unit vectors of the wide rows.
    std::vector<char> is_wide(static_cast<std::size_t>(S.rows()), 0);
    SparseRows H(r, S.cols());
    MatrixXd P = MatrixXd::Zero(S.rows(), r);
    for (Eigen::Index w = 0; w < r; ++w) {
      const int row = wide[static_cast<std::size_t>(w)];
      is_wide[static_cast<std::size_t>(row)] = 1;
      H.row(w) = S.row(row);
      P(row, w) = 1;
    }
    S_0.prune([&](Eigen::Index row, Eigen::Index, double) { return !is_wide[static_cast<std::size_t>(row)]; });
    const MatrixXd AP = linear::multiply(A.sparse_part(), P);
    const MatrixXd V = S_0.transpose() * AP;
    part =
        linear::make_product_part(SparseColumns(H.transpose()), SparseColumns(V.sparseView(0, 0)), P.transpose() * AP);
  }
  if (const auto* of_A = A.low_rank()) {
    linear::LowRankPart projected = *of_A;
    projected.U = SparseColumns(SparseColumns(S.transpose()) * of_A->U);
    part = linear::join(part, 1, projected, 1);
  }
  const linear::PetscMat P = make_petsc(S_0, A);
  linear::PetscMat result;
  linear::check_petsc(MatPtAP(A.sparse(), P.get(), MAT_INITIAL_MATRIX, PETSC_DEFAULT, result.out()));
  return linear::SymmetricMatrix(std::move(result), std::move(part));
}

}  // namespace bough::modal::bases
