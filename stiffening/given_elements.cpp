#include "stiffening/given_elements.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace bough::stiffening {

namespace {

/// A line, face or volume that is drawn and carries nothing.
class DrawnElement final : public fe::Element {
 public:
  explicit DrawnElement(const fe::Element& of) : Element(of.id(), of.card(), of.nodes(), {}), shape_(of.shape()) {}
  fe::ElementShape shape() const override { return shape_; }

 private:
  fe::ElementShape shape_;
};

std::string name_dof(int node, int code) { return std::to_string(node) + " component " + std::to_string(code); }

/// For each g-dof the position of its point in the table.
std::vector<int> list_owners(const PointTable& points) {
  std::vector<int> owner;
  for (std::size_t k = 0; k < points.index.size(); ++k)
    owner.insert(owner.end(), static_cast<std::size_t>(points.nodes.node(points.index[k]).num_dofs),
                 static_cast<int>(k));
  return owner;
}

}  // namespace

PointTable::PointTable(const records::Deck& deck, const fe::NodeTable& table) : nodes(table) {
  std::set<int> ids(deck.scalar_points.begin(), deck.scalar_points.end());
  for (const auto& grid : deck.grids) ids.insert(grid.id);
  for (const int id : ids)
    if (const int i = nodes.find_node(id); i >= 0) index.push_back(i);
  std::sort(index.begin(), index.end(),
            [this](int a, int b) { return nodes.node(a).first_gdof < nodes.node(b).first_gdof; });
  for (const int i : index) num_gdofs += nodes.node(i).num_dofs;
}

Eigen::MatrixXi PointTable::calc_default_dofs() const {
  std::vector<int> by_id = index;
  std::sort(by_id.begin(), by_id.end(), [this](int a, int b) { return nodes.node(a).id < nodes.node(b).id; });
  Eigen::MatrixXi map(num_gdofs, 2);
  int row = 0;
  for (const int i : by_id) {
    const auto& node = nodes.node(i);
    for (int c = 0; c < node.num_dofs; ++c) map.row(row++) << node.id, (node.num_dofs == 1 ? 0 : c + 1);
  }
  return map;
}

Eigen::MatrixXi PointTable::calc_dof_map() const {
  Eigen::MatrixXi map(num_gdofs, 2);
  for (const int i : index) {
    const auto& node = nodes.node(i);
    for (int c = 0; c < node.num_dofs; ++c) map.row(node.first_gdof + c) << node.id, (node.num_dofs == 1 ? 0 : c + 1);
  }
  return map;
}

modal::NodalDofs PointTable::calc_nodal_dofs() const {
  modal::NodalDofs dofs;
  dofs.num_dofs = num_gdofs;
  const auto is_grid = [this](int i) { return nodes.node(i).num_dofs == 6; };
  const auto p = std::count_if(index.begin(), index.end(), is_grid);
  dofs.xyz.resize(p, 3);
  dofs.row.resize(p, 6);
  Eigen::Index k = 0;
  for (const int i : index) {
    if (!is_grid(i)) continue;
    dofs.xyz.row(k) = nodes.node(i).x;
    for (int c = 0; c < 6; ++c) dofs.row(k, c) = nodes.node(i).first_gdof + c;
    ++k;
  }
  return dofs;
}

SparseRows calc_placement(const PointTable& points, const GivenMatrix& matrix, Diagnostics& diagnostics) {
  const auto num_rows = matrix.values.rows();
  const Eigen::MatrixXi dofs = matrix.row_dofs.rows() > 0 ? matrix.row_dofs : points.calc_default_dofs();
  SparseRows P(points.num_gdofs, num_rows);
  if (dofs.rows() != num_rows) {
    diagnostics.error(
        "reduce.matrix-size", matrix.at,
        matrix.label + " has " + std::to_string(num_rows) + " rows, " +
            (matrix.row_dofs.rows() > 0 ? "its list of dofs has "
                                        : std::to_string(points.index.size()) + " grids and scalar points have ") +
            std::to_string(dofs.rows()),
        "give a table of dofs with a line for each row of the matrix");
    return P;
  }
  std::vector<Eigen::Triplet<double>> entries;
  std::set<std::pair<int, int>> seen;
  for (int i = 0; i < num_rows; ++i) {
    const int id = dofs(i, 0), code = dofs(i, 1), k = points.nodes.find_node(id);
    const auto fail = [&](const std::string& what, const std::string& advice) {
      diagnostics.error("reduce.matrix-dof", matrix.at,
                        "row " + std::to_string(i + 1) + " of " + matrix.label + " " + what, advice);
    };
    if (k < 0) {
      fail("belongs to point " + std::to_string(id) + ", which is no grid",
           "correct the list of dofs, or add the grid");
      return P;
    }
    const auto& node = points.nodes.node(k);
    const bool is_scalar = node.num_dofs == 1;
    if (is_scalar ? code < 0 || code > 1 : code < 1 || code > 6) {
      fail("belongs to component " + std::to_string(code) + " of point " + std::to_string(id) + ", expected " +
               (is_scalar ? "0" : "1 to 6"),
           "correct the list of dofs");
      return P;
    }
    if (!seen.emplace(id, is_scalar ? 0 : code).second) {
      fail("belongs to " + name_dof(id, code) + ", as a row before", "correct the list of dofs");
      return P;
    }
    if (is_scalar || matrix.is_basic) {
      entries.emplace_back(node.first_gdof + std::max(code - 1, 0), i, 1.0);
      continue;
    }
    const int first = node.first_gdof + (code > 3 ? 3 : 0);
    for (int a = 0; a < 3; ++a)
      if (const double r = node.R_basic_cd(a, (code - 1) % 3); r != 0) entries.emplace_back(first + a, i, r);
  }
  P.setFromTriplets(entries.begin(), entries.end());
  return P;
}

void add_direct_elements(const PointTable& points, const SparseRows& A, fe::DirectKind kind, fe::ElementList& list) {
  const auto owner = list_owners(points);
  for (std::size_t a = 0; a < points.index.size(); ++a) {
    const auto& node = points.nodes.node(points.index[a]);
    std::map<int, MatrixXd> blocks;  // by the other point, not before a
    for (int i = 0; i < node.num_dofs; ++i)
      for (SparseRows::InnerIterator it(A, node.first_gdof + i); it; ++it) {
        const int b = owner[static_cast<std::size_t>(it.col())];
        if (b < static_cast<int>(a) || it.value() == 0) continue;
        const auto& other = points.nodes.node(points.index[static_cast<std::size_t>(b)]);
        MatrixXd& block = blocks[b];
        if (block.size() == 0) block.setZero(node.num_dofs, other.num_dofs);
        block(i, it.col() - other.first_gdof) = it.value();
      }
    for (auto& [b, block] : blocks) {
      std::vector<int> nodes{points.index[a]};
      if (b != static_cast<int>(a)) nodes.push_back(points.index[static_cast<std::size_t>(b)]);
      std::vector<int> gdofs;
      for (const int k : nodes)
        for (int c = 0; c < points.nodes.node(k).num_dofs; ++c) gdofs.push_back(points.nodes.node(k).first_gdof + c);
      list.elements.push_back(
          std::make_unique<fe::DirectElement>(kind, std::move(nodes), std::move(gdofs), std::move(block)));
    }
  }
}

void add_drawn_elements(const records::Deck& deck, const fe::NodeTable& nodes, fe::ElementList& list) {
  Diagnostics not_of_interest;
  for (const auto& element : fe::make_elements(deck, nodes, not_of_interest).elements)
    if (!element->shape().type.empty()) list.elements.push_back(std::make_unique<DrawnElement>(*element));
}

bool couples_points(const PointTable& points, const SparseRows& A) {
  const auto owner = list_owners(points);
  for (int i = 0; i < A.outerSize(); ++i)
    for (SparseRows::InnerIterator it(A, i); it; ++it)
      if (it.value() != 0 && owner[static_cast<std::size_t>(it.col())] != owner[static_cast<std::size_t>(i)])
        return true;
  return false;
}

}  // namespace bough::stiffening
