#include "analysis/listing/recovery_rows.hpp"

#include <algorithm>
#include <map>

#include "analysis/listing/stress_columns.hpp"
#include "fe/statics/element_recovery.hpp"

namespace bough::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// One column after the other as listed tables of Nastran, gathered as rows by element.
class TableRows {
 public:
  explicit TableRows(std::string name) { table_.name = std::move(name); }
  void add(Index column, Index num_columns, const records::ListedElements& block) {
    for (std::size_t k = 0; k < block.id.size(); ++k) {
      if (!block.point.empty() && block.point[k] != 0) continue;  // a ply or a corner
      const auto [place, is_new] = first_.try_emplace({block.type, block.id[k]}, rows_);
      if (is_new) {
        table_.items.push_back({block.type, block.id[k], static_cast<int>(block.real.cols()), static_cast<int>(rows_)});
        rows_ += block.real.cols();
      }
      if (table_.rows.rows() < rows_)
        table_.rows.conservativeResizeLike(MatrixXd::Zero(std::max(rows_, 2 * table_.rows.rows()), num_columns));
      for (Index r = 0; r < block.real.cols(); ++r)
        table_.rows(place->second + r, column) = block.real(static_cast<Index>(k), r);
    }
  }
  records::RecoveryTable take() {
    table_.rows.conservativeResize(rows_, table_.rows.cols());
    return std::move(table_);
  }

 private:
  records::RecoveryTable table_;
  std::map<std::pair<int, int>, Index> first_;
  Index rows_ = 0;
};

}  // namespace

std::vector<records::RecoveryTable> make_recovery_rows(const fe::Model& model, const records::Deck& deck,
                                                       const MatrixXd& U, const std::vector<int>& loads,
                                                       const std::function<bool(int)>& wants_force,
                                                       const std::function<bool(int)>& wants_stress) {
  const auto n = U.cols();
  std::vector<Eigen::VectorXd> columns;
  for (Index c = 0; c < n; ++c) columns.emplace_back(U.col(c));
  std::vector<fe::RecoveryCase> cases;
  for (const auto& column : columns) cases.push_back({&column, 0, nullptr, nullptr});
  for (std::size_t c = 0; c < loads.size(); ++c) cases[c].load = loads[c];
  const auto results = fe::recover_elements(model, deck, cases, fe::RecoveredFields{});
  const auto elements = index_elements(model);
  const auto limits = list_stress_limits(deck);
  TableRows force_rows("MEF1"), stress_rows("MES1");
  for (Index c = 0; c < n; ++c) {
    const auto& result = results[static_cast<std::size_t>(c)];
    for (const auto& block : result.forces)
      if (const auto listed = make_listed_forces(model, elements, block, {}, wants_force))
        force_rows.add(c, n, *listed);
    for (const auto& block : result.stresses)
      if (auto listed = make_listed_stresses(model, elements, deck, block, result.forces, limits, wants_stress)) {
        if (listed->id.empty()) continue;
        keep_linear_columns(*listed);
        stress_rows.add(c, n, *listed);
      }
  }
  std::vector<records::RecoveryTable> tables;
  for (auto* rows : {&force_rows, &stress_rows})
    if (auto table = rows->take(); !table.items.empty()) tables.push_back(std::move(table));
  return tables;
}

}  // namespace bough::analysis
