#include "fe/statics/element_recovery.hpp"

#include <array>
#include <optional>
#include <utility>

#include "fe/elements/beam.hpp"
#include "fe/elements/solid.hpp"
#include "fe/linear/blas.hpp"
#include "fe/loads/load_sets.hpp"
#include "fe/model/element_loop.hpp"
#include "fe/sections/stress.hpp"

namespace bough::fe {
namespace {

using Eigen::Index;

/// Fewer are done before a thread has started.
constexpr int kMinElementsOfThread = 250;

/// Rows of a table of every case, a few at a time: a row after the other would touch a line of memory per number.
class TableRows {
 public:
  TableRows(Index num_columns, std::vector<MatrixXd*> tables)
      : num_columns_(num_columns), tables_(std::move(tables)), rows_(kRows, num_columns * num_cases()) {}

  /// values: columns of the table x cases. Rows come in ascending order.
  void set(Index row, const Eigen::Ref<const MatrixXd>& values) {
    if (count_ == kRows || (count_ > 0 && row != first_ + count_)) flush();
    if (count_ == 0) first_ = row;
    for (Index c = 0; c < num_cases(); ++c)
      for (Index k = 0; k < num_columns_; ++k) rows_(count_, c * num_columns_ + k) = values(k, c);
    ++count_;
  }
  void flush() {
    for (Index c = 0; c < num_cases(); ++c)
      tables_[static_cast<std::size_t>(c)]->middleRows(first_, count_) =
          rows_.block(0, c * num_columns_, count_, num_columns_);
    count_ = 0;
  }

 private:
  static constexpr Index kRows = 16;
  Index num_cases() const { return static_cast<Index>(tables_.size()); }

  Index num_columns_;
  std::vector<MatrixXd*> tables_;
  MatrixXd rows_;
  Index first_ = 0, count_ = 0;
};

/// One element and all cases.
struct Current {
  const Element& element;
  int index;
  std::size_t half;                           ///< of the elements: each has its rows
  MatrixXd U;                                 ///< N x cases
  std::vector<const ThermalState*> heated{};  ///< a case each; nullptr: cold
  MatrixXd forces{};                          ///< internal forces, with those of loads and temperatures
};

/// Writes what a pair of tables of each group, by half of the elements, still holds.
template <class Tables>
void flush(Tables& tables) {
  for (auto& of_half : tables)
    for (auto& table : of_half) table.flush();
}

/// Stresses or strains of all groups.
class PointTables {
 public:
  using Blocks = std::vector<records::ElementStresses> ElementResults::*;

  PointTables(const Model& model, const RecoveryLayout::Table& layout, bool of_strain, Blocks blocks,
              std::vector<ElementResults>& results)
      : of_strain_(of_strain), blocks_(blocks), results_(results), layout_(layout), groups_(layout.groups) {
    for (auto& result : results) (result.*blocks).resize(groups_.size());
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const auto& group = groups_[g];
      const Element& first = *model.elements()[static_cast<std::size_t>(group.elements.front())];
      const auto rows = static_cast<Index>(group.elements.size()), columns = static_cast<Index>(group.names.size());
      const Index corners = of_strain && first.as_solid() ? 6 * first.as_solid()->num_corners() : 0;
      std::vector<MatrixXd*> tables, corner_tables;
      for (auto& result : results) {
        auto& block = (result.*blocks)[g];
        block.card = group.card;
        block.components = group.names;
        block.id = group.id;
        block.property = group.property;
        block.stress.setZero(rows, columns);
        block.corner.setZero(rows, corners);
        tables.push_back(&block.stress);
        corner_tables.push_back(&block.corner);
      }
      for (auto& of_half : tables_) of_half.emplace_back(columns, tables);
      for (auto& of_half : corners_) of_half.emplace_back(corners, corner_tables);
    }
  }

  void add(const Current& at) {
    const auto [group, row] = layout_.places[static_cast<std::size_t>(at.index)];
    if (group < 0) return;
    const auto g = static_cast<std::size_t>(group);
    const StressRecovery& recovery = *at.element.stress_recovery();
    MatrixXd values = of_strain_ ? recovery.calc_strains(at.forces) : recovery.calc_stresses(at.forces);
    for (std::size_t c = 0; c < at.heated.size(); ++c)
      if (at.heated[c]) add_part(of_strain_ ? at.heated[c]->strain : at.heated[c]->stress, c, values);
    const PointResults derive(of_strain_ ? recovery.strain_points() : recovery.stress_points(), of_strain_);
    MatrixXd rows(static_cast<Index>(groups_[g].names.size()), values.cols());
    for (Index c = 0; c < values.cols(); ++c) derive.calc(values.col(c), rows.col(c));
    tables_[at.half][g].set(row, rows);
    if (!of_strain_ || (results_.front().*blocks_)[g].corner.cols() == 0) return;
    MatrixXd corner = at.element.as_solid()->calc_corner_strains(at.forces);
    for (std::size_t c = 0; c < at.heated.size(); ++c)
      if (at.heated[c]) add_part(at.heated[c]->corner_strain, c, corner);
    corners_[at.half][g].set(row, corner);
  }

  void finish() {
    flush(tables_);
    flush(corners_);
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (auto& result : results_) {
        auto& block = (result.*blocks_)[g];
        linear::sum_over_ranks(block.stress);
        if (block.corner.cols() > 0) linear::sum_over_ranks(block.corner);
      }
  }

 private:
  static void add_part(const VectorXd& more, std::size_t c, MatrixXd& values) {
    if (more.size() > 0) values.col(static_cast<Index>(c)) += more;
  }

  bool of_strain_;
  Blocks blocks_;
  std::vector<ElementResults>& results_;
  const RecoveryLayout::Table& layout_;
  const std::vector<RecoveryGroup>& groups_;
  std::array<std::vector<TableRows>, 2> tables_, corners_;
};

/// Loads along beams, or values of loads inside superelements, by element: a case each.
using EndLoads = std::vector<std::unordered_map<int, VectorXd>>;

/// Forces and strain energies of all groups.
class ForceTables {
 public:
  ForceTables(const Model& model, const RecoveryLayout::Table& layout, const MatrixXd* known_energy,
              std::vector<ElementResults>& results)
      : model_(model), known_energy_(known_energy), results_(results), layout_(layout), groups_(layout.groups) {
    for (auto& result : results) result.forces.resize(groups_.size());
    energies_.assign(groups_.size(), std::vector<MatrixXd>(results.size()));
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const auto& group = groups_[g];
      const auto rows = static_cast<Index>(group.elements.size()), columns = static_cast<Index>(group.names.size());
      std::vector<MatrixXd*> tables, energy_tables;
      for (std::size_t c = 0; c < results.size(); ++c) {
        auto& block = results[c].forces[g];
        block.card = group.card;
        block.components = group.names;
        block.id = group.id;
        block.property = group.property;
        block.force.setZero(rows, columns);
        energies_[g][c].setZero(rows, 1);
        tables.push_back(&block.force);
        energy_tables.push_back(&energies_[g][c]);
      }
      for (auto& of_half : tables_) of_half.emplace_back(columns, tables);
      for (auto& of_half : energy_tables_) of_half.emplace_back(1, energy_tables);
    }
  }

  /// \param interior  parts of the values by load of the case, by element index.
  void add(const Current& at, const EndLoads& interior) {
    const auto [group, row] = layout_.places[static_cast<std::size_t>(at.index)];
    if (group < 0) return;
    const auto g = static_cast<std::size_t>(group);
    const auto count = static_cast<Index>(groups_[g].names.size());
    if (at.element.stress_state()) {
      tables_[at.half][g].set(row, at.forces.topRows(count));  // the printed ones come first
    } else {
      MatrixXd forces(count, at.U.cols());
      for (Index c = 0; c < at.U.cols(); ++c)
        forces.col(c) = at.element.printed_forces()->calc_printed_forces(at.U.col(c));
      for (std::size_t c = 0; c < at.heated.size(); ++c)
        if (at.heated[c]) forces.col(static_cast<Index>(c)) += at.heated[c]->force.head(count);
      for (std::size_t c = 0; c < interior.size(); ++c)
        if (const auto part = interior[c].find(at.index); part != interior[c].end())
          forces.col(static_cast<Index>(c)) += part->second;
      tables_[at.half][g].set(row, forces);
    }
    MatrixXd energy = known_energy_ ? MatrixXd(known_energy_->row(at.index)) : calc_energy(at);
    for (std::size_t c = 0; c < at.heated.size(); ++c)
      if (const auto* part = at.heated[c]) {
        const auto column = static_cast<Index>(c);
        energy(0, column) += part->energy - at.U.col(column).dot(part->load);
      }
    energy_tables_[at.half][g].set(row, energy);
  }

  void finish() {
    flush(tables_);
    flush(energy_tables_);
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (std::size_t c = 0; c < results_.size(); ++c) {
        auto& block = results_[c].forces[g];
        linear::sum_over_ranks(block.force);
        linear::sum_over_ranks(energies_[g][c]);
        block.strain_energy = energies_[g][c].col(0);
      }
  }

 private:
  MatrixXd calc_energy(const Current& at) {
    auto& [K, K_U] = scratch_[at.half];
    K.setZero(at.U.rows(), at.U.rows());
    model_.add_stiffness(at.element, K);
    K_U.resize(at.U.rows(), at.U.cols());
    linear::multiply_dense(false, K, at.U, 0, K_U);
    return 0.5 * at.U.cwiseProduct(K_U).colwise().sum();
  }

  const Model& model_;
  const MatrixXd* known_energy_;
  std::vector<ElementResults>& results_;
  const RecoveryLayout::Table& layout_;
  const std::vector<RecoveryGroup>& groups_;
  std::array<std::vector<TableRows>, 2> tables_, energy_tables_;
  std::vector<std::vector<MatrixXd>> energies_;           ///< rows x 1, by group and case
  std::array<std::pair<MatrixXd, MatrixXd>, 2> scratch_;  ///< K, K U
};

void find_forces(const std::vector<RecoveryCase>& cases, const EndLoads& end_loads, Current& at) {
  const StressState* state = at.element.stress_state();
  at.forces.setZero(state ? state->num_internal_forces() : 0, at.U.cols());
  if (!state) return;
  state->calc_internal_forces_of(at.U, at.forces);
  for (std::size_t c = 0; c < cases.size(); ++c) {
    auto force = at.forces.col(static_cast<Index>(c));
    if (cases[c].deformed)
      if (const auto& own = cases[c].deformed->internal_forces[static_cast<std::size_t>(at.index)]; own.size() > 0)
        force = own;
    if (!at.heated.empty() && at.heated[c]) force += at.heated[c]->force;
    if (const auto own = end_loads[c].find(at.index); own != end_loads[c].end())
      at.element.as_beam()->add_load_forces(own->second, force);
  }
}

}  // namespace

std::vector<ElementResults> recover_elements(const Model& model, const records::Deck& deck,
                                             const std::vector<RecoveryCase>& cases, const RecoveredFields& fields) {
  return recover_elements(model, deck, cases, RecoveryLayout(model, deck, fields));
}

std::vector<ElementResults> recover_elements(const Model& model, const records::Deck& deck,
                                             const std::vector<RecoveryCase>& cases, const RecoveryLayout& layout,
                                             const MatrixXd* known_energy) {
  BOUGH_DEMAND(!known_energy || (known_energy->rows() == static_cast<Index>(model.elements().size()) &&
                                 known_energy->cols() == static_cast<Index>(cases.size())));
  std::vector<ElementResults> results(cases.size());
  if (cases.empty()) return results;
  EndLoads end_loads(cases.size()), interior(cases.size());
  bool is_heated = false;
  for (std::size_t c = 0; c < cases.size(); ++c) {
    BOUGH_DEMAND(cases[c].u_g->size() == model.num_gdofs());
    is_heated = is_heated || (cases[c].initial && !cases[c].initial->of.empty());
    Diagnostics ignored;
    if (cases[c].load > 0) interior[c] = calc_interior_values(model, deck, cases[c].load);
    if (cases[c].load > 0)
      end_loads[c] =
          calc_beam_end_loads(model, deck, cases[c].load, cases[c].diagnostics ? *cases[c].diagnostics : ignored);
  }
  std::optional<ForceTables> forces;
  std::optional<PointTables> stresses, strains;
  if (layout.forces.is_asked) forces.emplace(model, layout.forces, known_energy, results);
  if (layout.stresses.is_asked) stresses.emplace(model, layout.stresses, false, &ElementResults::stresses, results);
  if (layout.strains.is_asked) strains.emplace(model, layout.strains, true, &ElementResults::strains, results);

  const auto recover = [&](std::size_t half, int e, const Element& element) {
    if (!layout.forces.holds(e) && !layout.stresses.holds(e) && !layout.strains.holds(e)) return;
    const auto& gdofs = element.gdofs();
    Current at{element, e, half, MatrixXd(element.num_dofs(), static_cast<Index>(cases.size()))};
    for (std::size_t c = 0; c < cases.size(); ++c) {
      if (cases[c].deformed) {
        at.U.col(static_cast<Index>(c)) = cases[c].deformed->displacements[static_cast<std::size_t>(e)];
        continue;
      }
      for (std::size_t i = 0; i < gdofs.size(); ++i)
        at.U(static_cast<Index>(i), static_cast<Index>(c)) = (*cases[c].u_g)[gdofs[i]];
    }
    if (is_heated)
      for (const auto& one : cases) at.heated.push_back(one.initial ? one.initial->find(element) : nullptr);
    find_forces(cases, end_loads, at);
    if (forces) forces->add(at, interior);
    if (stresses) stresses->add(at);
    if (strains) strains->add(at);
  };
  visit_elements_by_halves(model, get_own_elements(model), kMinElementsOfThread, recover);
  if (forces) forces->finish();
  if (stresses) stresses->finish();
  if (strains) strains->finish();
  return results;
}

}  // namespace bough::fe
