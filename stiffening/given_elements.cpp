#include "stiffening/given_elements.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "fe/model/coordinates.hpp"

namespace bough::stiffening {

namespace {

/// An element without stiffness and mass: a line, face or volume of the picture.
class DrawnElement final : public fe::Element {
 public:
  explicit DrawnElement(const fe::Element& of) : Element(of.id(), of.card(), of.nodes(), {}), shape_(of.shape()) {}
  fe::ElementShape shape() const override { return shape_; }

 private:
  fe::ElementShape shape_;
};

std::string name_dof(int node, int code) { return std::to_string(node) + " component " + std::to_string(code); }

/// The index of the point of each g-dof.
std::vector<int> list_owners(const PointTable& points) {
  std::vector<int> owner;
  for (std::size_t k = 0; k < points.nodes.size(); ++k)
    owner.insert(owner.end(), static_cast<std::size_t>(points.nodes[k].num_dofs), static_cast<int>(k));
  return owner;
}

Eigen::MatrixXi list_dofs(const std::vector<fe::Node>& nodes, int num_dofs) {
  Eigen::MatrixXi map(num_dofs, 2);
  int row = 0;
  for (const auto& node : nodes)
    for (int c = 0; c < node.num_dofs; ++c) map.row(row++) << node.id, (node.num_dofs == 1 ? 0 : c + 1);
  return map;
}

}  // namespace

PointTable::PointTable(const records::Deck& deck, const Eigen::Vector3d& origin, Diagnostics& diagnostics) {
  const fe::CoordinateSystems systems(deck, origin, diagnostics);
  std::map<int, int> grids;  // index of the first card of each id
  for (std::size_t i = 0; i < deck.grids.size(); ++i) grids.emplace(deck.grids[i].id, static_cast<int>(i));
  const auto add = [this](fe::Node node) {
    node.first_gdof = num_gdofs;
    num_gdofs += node.num_dofs;
    index.emplace(node.id, static_cast<int>(nodes.size()));
    nodes.push_back(node);
  };
  for (const auto& [id, i] : grids) {
    const auto& grid = deck.grids[static_cast<std::size_t>(i)];
    const Eigen::Vector3d& x = systems.get_grid_position(i);
    add({id, x, systems.calc_axes(grid.cd, x, deck.locate(grid.at), diagnostics), 0, 6});
  }
  for (const int id : std::set<int>(deck.scalar_points.begin(), deck.scalar_points.end()))
    if (!grids.count(id)) add({id, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), 0, 1});
}

const fe::Node* PointTable::find(int id) const {
  const auto found = index.find(id);
  return found == index.end() ? nullptr : &nodes[static_cast<std::size_t>(found->second)];
}

Eigen::MatrixXi PointTable::calc_default_dofs() const {
  auto by_id = nodes;
  std::sort(by_id.begin(), by_id.end(), [](const fe::Node& a, const fe::Node& b) { return a.id < b.id; });
  return list_dofs(by_id, num_gdofs);
}

Eigen::MatrixXi PointTable::calc_dof_map() const { return list_dofs(nodes, num_gdofs); }

modal::NodalDofs PointTable::calc_nodal_dofs() const {
  const auto is_grid = [](const fe::Node& node) { return node.num_dofs == 6; };
  const auto num_grids = std::count_if(nodes.begin(), nodes.end(), is_grid);
  modal::NodalDofs dofs;
  dofs.num_dofs = num_gdofs;
  dofs.xyz.resize(num_grids, 3);
  dofs.row.resize(num_grids, 6);
  for (Eigen::Index k = 0; k < num_grids; ++k) {  // grids come first
    const auto& node = nodes[static_cast<std::size_t>(k)];
    dofs.xyz.row(k) = node.x;
    for (int c = 0; c < 6; ++c) dofs.row(k, c) = node.first_gdof + c;
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
                                        : std::to_string(points.nodes.size()) + " grids and scalar points have ") +
            std::to_string(dofs.rows()),
        "give a table of dofs with a line for each row of the matrix");
    return P;
  }
  std::vector<Eigen::Triplet<double>> entries;
  std::set<std::pair<int, int>> seen;
  for (int i = 0; i < num_rows; ++i) {
    const int id = dofs(i, 0), code = dofs(i, 1);
    const fe::Node* const found = points.find(id);
    const auto fail = [&](const std::string& message, const std::string& advice) {
      diagnostics.error("reduce.matrix-dof", matrix.at,
                        "row " + std::to_string(i + 1) + " of " + matrix.label + " " + message, advice);
    };
    if (!found) {
      fail("belongs to point " + std::to_string(id) + ", which is no grid",
           "correct the list of dofs, or add the grid");
      return P;
    }
    const fe::Node& node = *found;
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
  const auto get = [&](int k) -> const fe::Node& { return points.nodes[static_cast<std::size_t>(k)]; };
  for (int a = 0; a < static_cast<int>(points.nodes.size()); ++a) {
    const auto& node = get(a);
    std::map<int, MatrixXd> blocks;  // by the other point, not before a
    for (int i = 0; i < node.num_dofs; ++i)
      for (SparseRows::InnerIterator it(A, node.first_gdof + i); it; ++it) {
        const int b = owner[static_cast<std::size_t>(it.col())];
        if (b < a || it.value() == 0) continue;
        MatrixXd& block = blocks[b];
        if (block.size() == 0) block.setZero(node.num_dofs, get(b).num_dofs);
        block(i, it.col() - get(b).first_gdof) = it.value();
      }
    for (auto& [b, block] : blocks) {
      std::vector<int> nodes{a}, gdofs;
      if (b != a) nodes.push_back(b);
      for (const int k : nodes)
        for (int c = 0; c < get(k).num_dofs; ++c) gdofs.push_back(get(k).first_gdof + c);
      list.elements.push_back(
          std::make_unique<fe::DirectElement>(kind, std::move(nodes), std::move(gdofs), std::move(block)));
    }
  }
}

void add_drawn_elements(const records::Deck& deck, const fe::NodeTable& nodes, fe::ElementList& list) {
  Diagnostics ignored;  // these elements carry nothing
  for (const auto& element : fe::make_elements(deck, nodes, ignored).elements)
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
