#include "fe/linear/supernodal_factor.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "fe/linear/dissection.hpp"
#include "fe/linear/memory_need.hpp"
#include "fe/linear/part_factor.hpp"

namespace bough::linear {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class SupernodalSolver final : public FactorSolver {
 public:
  MatrixXd solve(const Eigen::Ref<const MatrixXd>& B) const override;
  const char* name() const override { return "LLᵀ CHOLMOD"; }
  double num_entries() const override {
    double sum = 0;
    for (const auto& one : part) sum += one->num_entries();
    return sum;
  }

  std::vector<std::unique_ptr<PartFactor>> part;
  std::vector<PetscInt> between;
  MatrixXd L;  ///< of the Schur complement of the separator rows
};

MatrixXd SupernodalSolver::solve(const Eigen::Ref<const MatrixXd>& B) const {
  const std::size_t num = part.size();
  MatrixXd X(B.rows(), B.cols());
  for (Eigen::Index first = 0; first < B.cols(); first += kWideRhs) {
    const auto m = std::min(kWideRhs, B.cols() - first);
    const auto B_block = B.middleCols(first, m);
    auto X_block = X.middleCols(first, m);
    std::vector<MatrixXd> carried(num);
    do_all(num, [&](std::size_t p) { part[p]->forward(B_block, carried[p]); });
    MatrixXd X_s = B_block(between, Eigen::all);
    for (const MatrixXd& share : carried) X_s -= share.topRows(m).transpose();
    solve_dense(L, X_s);
    X_block(between, Eigen::all) = X_s;
    MatrixXd x_s = MatrixXd::Zero(carried[0].rows(), X_s.rows());
    x_s.topRows(m) = X_s.transpose();
    do_all(num, [&](std::size_t p) { part[p]->backward(x_s, X_block); });
  }
  return X;
}

}  // namespace

SupernodalFactor make_supernodal_factor(const SymmetricMatrix& A, PetscInt min_rows) {
  SupernodalFactor result;
  if (initialize_petsc().size > 1) return result;
  auto cut = find_parts(A, min_rows);
  if (!cut) return result;
  auto parts = std::make_unique<SupernodalSolver>();
  parts->between = std::move(cut->between);
  std::vector<std::vector<PetscInt>> own;
  for (auto* rows : {&cut->first, &cut->second})
    if (!rows->empty()) own.push_back(std::move(*rows));
  const std::size_t num = own.size();
  for (std::size_t p = 0; p < num; ++p) parts->part.push_back(std::make_unique<PartFactor>());

  std::vector<char> is_done(num, 0);
  VectorXd delta;
  visit_rows(A.sparse(), [&](const MatrixRows& rows, PetscInt size) {
    delta = calc_separator_shift(rows, parts->between, size);
    do_all(num, [&](std::size_t p) {
      is_done[p] =
          parts->part[p]->analyse(rows, size, std::move(own[p]), parts->between, delta, static_cast<int>(num)) ? 1 : 0;
    });
  });
  const auto are_all = [&] { return std::all_of(is_done.begin(), is_done.end(), [](char one) { return one != 0; }); };
  if (!are_all()) return result;
  double num_entries = 0;
  for (const auto& part : parts->part) num_entries += part->num_entries();
  // While it is extracted, each subdomain has two more copies of its separator block.
  if (num > 1) num_entries += 2.0 * static_cast<double>(num) * std::pow(static_cast<double>(parts->between.size()), 2);
  release_freed_memory();
  require_memory(static_cast<double>(A.num_rows()), num_entries, calc_free_memory());

  std::vector<MatrixXd> schur(num);
  do_all(num, [&](std::size_t p) {
    is_done[p] = parts->part[p]->factor() ? 1 : 0;
    if (is_done[p] != 0) schur[p] = parts->part[p]->take_schur();
  });
  result.is_definite = are_all();
  if (!result.is_definite) return result;
  if (num > 1) {
    parts->L = schur[0] + schur[1];
    parts->L.diagonal() -= 2 * delta;
    result.is_definite = factor_dense(parts->L);
    if (!result.is_definite) return result;
  }
  result.num_parts = static_cast<int>(num);
  result.solver = std::move(parts);
  return result;
}

}  // namespace bough::linear
