#include "fe/model/superelements.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <optional>

#include "base/number_text.hpp"
#include "fe/elements/solve_in_range.hpp"
#include "fe/elements/superelement.hpp"
#include "fe/model/coordinates.hpp"

namespace bough::fe {
namespace {

using Eigen::Index;

constexpr int kQuad = 33, kTria = 74;  // CQUAD4, CTRIA3

/// Returns true for the eight linear stresses of a plate: distance, xx, yy, xy of the bottom, then of the top.
bool is_plate(const records::RecoveryItem& item) {
  return (item.type == kQuad || item.type == kTria) && item.num_rows == 8;
}

/// Rows of an item that depend on the motion: not the distances of plates.
std::vector<Index> list_rows(const std::string& table, const records::RecoveryItem& item) {
  std::vector<Index> rows;
  for (int k = 0; k < item.num_rows; ++k)
    if (!(table.starts_with("MES") && is_plate(item) && k % 4 == 0)) rows.push_back(item.first_row + k);
  return rows;
}

/// Components of a row of Nastran's linear results: named where the order of the item codes is known.
std::vector<std::string> name_components(const std::string& table, const records::RecoveryItem& item) {
  const auto is = [&](const char* letters) { return table.starts_with(letters); };
  if (is("MUG") || is("MQG")) {
    if (item.num_rows == 1) return {"t1"};
    if (item.num_rows == 6) return {"t1", "t2", "t3", "r1", "r2", "r3"};
  }
  constexpr int kBar = 34, kRod = 1, kConrod = 10, kTube = 3;
  if (is("MEF") && item.type == kBar && item.num_rows == 8)
    return {"moment1_a", "moment2_a", "moment1_b", "moment2_b", "shear1", "shear2", "axial", "torque"};
  if (is("MEF") && (item.type == kRod || item.type == kConrod || item.type == kTube) && item.num_rows == 2)
    return {"axial", "torque"};
  constexpr int kBush = 102, kCelas1 = 11, kCelas4 = 14;
  if (is("MEF") && is_plate(item))
    return {"membrane_xx", "membrane_yy", "membrane_xy", "moment_xx", "moment_yy", "moment_xy", "shear_xz", "shear_yz"};
  if (is("MEF") && item.type == kBush && item.num_rows == 6)
    return {"force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"};
  if (is("MEF") && item.type >= kCelas1 && item.type <= kCelas4 && item.num_rows == 1) return {"force"};
  if (is("MES") && is_plate(item)) return {"xx@bottom", "yy@bottom", "xy@bottom", "xx@top", "yy@top", "xy@top"};
  if (is("MES") && item.type == kBar && item.num_rows == 9)
    return {"stress1_a", "stress2_a", "stress3_a", "stress4_a", "stress_axial",
            "stress1_b", "stress2_b", "stress3_b", "stress4_b"};
  std::vector<std::string> names;
  for (int k = 1; k <= item.num_rows; ++k) names.push_back("c" + std::to_string(k));
  return names;
}

/// Returns true for the record of a section with elements: LOAD of the case control selects its loads.
bool is_part(const records::Deck& deck, const records::Superelement& record) {
  const auto& bulk = deck.super.sebulk;
  return record.file.empty() && record.section->super.extrn.empty() &&
         std::none_of(bulk.begin(), bulk.end(),
                      [&](const auto& one) { return one.id == record.id && one.type != "PRIMARY"; });
}

class SuperelementMaker {
 public:
  SuperelementMaker(const records::Deck& deck, const records::Superelement& record, const NodeTable& nodes,
                    const Vector3d& origin, Diagnostics& diagnostics)
      : deck_(deck),
        record_(record),
        nodes_(nodes),
        diagnostics_(diagnostics),
        systems_(*record.section, origin, diagnostics) {}

  void add(double wtmass, ElementList& list) {
    if (!connect()) return;
    const MatrixXd P = record_.P.size() == 0 ? MatrixXd() : MatrixXd(C_.transpose() * record_.P);
    Superelement::Matrices matrices{
        turn(record_.K),      turn(record_.M) / wtmass, turn(record_.B), turn(record_.K4), {}, {}, {}, P,
        record_.load_columns, is_part(deck_, record_)};
    if (!record_.K_G.empty()) {
      matrices.force = record_.K * C_;
      // Geometric stiffness of a unit of force in place of motion: rigid-body motion has no force.
      const MatrixXd motion = solve_in_range(record_.K, MatrixXd::Identity(record_.K.rows(), record_.K.cols()));
      for (Index j = 0; j < motion.cols(); ++j) {
        MatrixXd K_G = MatrixXd::Zero(motion.rows(), motion.rows());
        for (Index i = 0; i < motion.rows(); ++i) K_G += motion(i, j) * record_.K_G[static_cast<std::size_t>(i)];
        matrices.K_G.push_back(turn(K_G));
      }
      for (auto i = static_cast<std::size_t>(motion.cols()); i < record_.K_G.size(); ++i)
        matrices.K_G_of_loads.push_back(turn(record_.K_G[i]));
    }
    list.add(std::make_unique<Superelement>(record_.id, nodes_joined_, gdofs_, std::move(matrices)));
    for (const auto& table : record_.recovery) {
      if (table.name.ends_with("O")) continue;
      const auto* of_loads = find_table(table.name + "O");
      for (const auto& item : table.items) {
        constexpr int kScalarPoint = 2;
        const bool is_motion = table.name.starts_with("MUG") || table.name.starts_with("MQG");
        const std::string card =
            table.name + "_" + std::to_string(record_.id) + (is_motion && item.type == kScalarPoint ? "_scalar" : "");
        const auto rows = list_rows(table.name, item);
        InteriorValues interior;
        if (of_loads)
          interior = {record_.id, is_part(deck_, record_), record_.load_columns, of_loads->rows(rows, Eigen::all)};
        list.add(std::make_unique<RecoveredItem>(item.id, card, nodes_joined_, gdofs_,
                                                 name_components(table.name, item),
                                                 MatrixXd(table.rows(rows, Eigen::all) * C_), std::move(interior)));
      }
    }
  }

 private:
  const records::RecoveryTable* find_table(const std::string& name) const {
    const auto& all = record_.recovery;
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& table) { return table.name == name; });
    return found == all.end() ? nullptr : &*found;
  }

  void error(std::string what, std::string advice) {
    diagnostics_.error("fe.superelement-boundary", deck_.locate(record_.at),
                       "superelement " + std::to_string(record_.id) + ": " + std::move(what), std::move(advice));
  }

  MatrixXd turn(const MatrixXd& own) const {
    return own.size() == 0 ? MatrixXd() : MatrixXd(C_.transpose() * own * C_);
  }

  const records::Grid* find_own(int id) const {
    const auto& grids = record_.section->grids;
    const auto found = std::find_if(grids.begin(), grids.end(), [id](const auto& grid) { return grid.id == id; });
    return found == grids.end() ? nullptr : &*found;
  }

  /// Node that an exterior point joins, or -1 after an error.
  int find_node(const records::ExteriorPoint& point, const records::Grid* own, const Vector3d& x) {
    const std::string who = (own ? "exterior grid " : "exterior scalar point ") + std::to_string(point.id);
    const auto card = record_.joined.find(point.id);
    int index = -1;
    if (card != record_.joined.end()) {
      index = nodes_.find_node(card->second);
      if (index < 0)
        return error(who + " is joined to " + std::to_string(card->second) + ", which the main bulk data does not have",
                     "include the .asm file of the superelement, or correct SECONCT"),
               -1;
    } else if (record_.joins_places && own) {
      index = find_place(x);
    } else if (record_.joins_places) {
      index = nodes_.find_node(point.id);
    }
    if (index < 0)
      return error(who + " joins no point of the main bulk data",
                   own ? "give SECONCT, or a grid at its place" : "give SECONCT, or an SPOINT of its id"),
             -1;
    const Node& node = nodes_.node(index);
    if ((node.num_dofs == 6) != (own != nullptr))
      return error(who + " is joined to " + (node.num_dofs == 6 ? "grid " : "scalar point ") + std::to_string(node.id),
                   "join grids to grids, scalar points to scalar points"),
             -1;
    const double away = own ? (node.x - x).norm() : 0;
    if (own && record_.checks_places && away > calc_tolerance(x))
      return error(
                 who + " is " + show_number(away, 3) + " away from grid " + std::to_string(node.id) + " that it joins",
                 "the matrices are of another boundary, or the component was moved: SELOC is not supported"),
             -1;
    return index;
  }

  int find_place(const Vector3d& x) const {
    for (const auto& grid : deck_.grids) {
      const int index = nodes_.find_node(grid.id);
      if (index >= 0 && (nodes_.node(index).x - x).norm() <= calc_tolerance(x)) return index;
    }
    return -1;
  }

  /// Distance below which points coincide: TOL of SEBULK, or the round-off of six punched digits.
  double calc_tolerance(const Vector3d& x) const { return std::max(record_.tolerance, 1e-6 * x.norm()); }

  /// Nodes, rows of the g-set and the map C from the joined nodes' dofs (basic) to the exterior dofs.
  bool connect() {
    std::vector<std::pair<int, MatrixXd>> parts;  // by point: node, rows of its exterior dofs
    std::map<int, Index> first;                   // by node: its first column
    bool is_ok = true;
    for (const auto& point : record_.points) {
      const auto* own = find_own(point.id);
      Vector3d x = Vector3d::Zero();
      MatrixXd rows = MatrixXd::Ones(1, 1);
      if (point.c != 0 && !own) {
        error("exterior grid " + std::to_string(point.id) + " has no GRID in its section",
              "include the whole .pch file");
        is_ok = false;
        continue;
      }
      if (own) {
        x = systems_.get_grid_position(static_cast<int>(own - record_.section->grids.data()));
        const Matrix3d R = systems_.calc_axes(own->cd, x, deck_.locate(own->at), diagnostics_).transpose();
        rows.setZero(std::popcount(point.c), 6);
        for (Index r = 0, c = 0; c < 6; ++c)
          if (point.c >> c & 1u) rows.row(r++).segment<3>(3 * (c / 3)) = R.row(c % 3);
      }
      const int index = find_node(point, own, x);
      is_ok = is_ok && index >= 0;
      if (index < 0) continue;
      if (first.emplace(index, 0).second) nodes_joined_.push_back(index);
      parts.emplace_back(index, std::move(rows));
    }
    if (!is_ok) return false;
    for (const int index : nodes_joined_) {
      const Node& node = nodes_.node(index);
      first[index] = static_cast<Index>(gdofs_.size());
      for (int i = 0; i < node.num_dofs; ++i) gdofs_.push_back(node.first_gdof + i);
    }
    C_.setZero(record_.num_dofs(), static_cast<Index>(gdofs_.size()));
    Index row = 0;
    for (const auto& [index, rows] : parts) {
      C_.block(row, first[index], rows.rows(), rows.cols()) = rows;
      row += rows.rows();
    }
    return true;
  }

  const records::Deck& deck_;
  const records::Superelement& record_;
  const NodeTable& nodes_;
  Diagnostics& diagnostics_;
  CoordinateSystems systems_;
  std::vector<int> nodes_joined_, gdofs_;
  MatrixXd C_;
};

}  // namespace

ElementList make_superelements(const records::Deck& deck, const NodeTable& nodes, const Vector3d& origin, double wtmass,
                               Diagnostics& diagnostics) {
  ElementList list;
  for (const auto& record : deck.superelements)
    SuperelementMaker(deck, record, nodes, origin, diagnostics).add(wtmass, list);
  return list;
}

}  // namespace bough::fe
