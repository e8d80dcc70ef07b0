#include <algorithm>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "base/rotation.hpp"
#include "fe/cards/maker.hpp"
#include "fe/elements/general.hpp"

namespace bough::fe {
namespace {

/// A component of a point: its node and the unit row of its dofs, in basic.
struct Component {
  int node = -1;
  VectorXd row;
};

/// The components of a list; empty after reporting.
std::optional<std::vector<Component>> find_components(Maker& maker, const std::vector<records::GridComponent>& list,
                                                      const std::string& who, const records::CardLocation& at) {
  std::vector<Component> found;
  bool ok = true;
  for (const auto& [g, c] : list) {
    Component component;
    component.node = maker.find_point(g, who, at);
    if (component.node < 0) {
      ok = false;
      continue;
    }
    const Node& node = maker.nodes().node(component.node);
    component.row = VectorXd::Zero(node.num_dofs);
    if (node.num_dofs == 1 && c <= 1) {
      component.row[0] = 1;
    } else if (node.num_dofs == 6 && c >= 1 && c <= 6) {
      component.row.segment<3>(c <= 3 ? 0 : 3) = node.R_basic_cd.col((c - 1) % 3);
    } else {
      maker.error("fe.bad-component", at,
                  who + " names component " + std::to_string(c) + " of point " + std::to_string(g) + ", expected " +
                      (node.num_dofs == 1 ? "0" : "1 to 6"),
                  "correct the component");
      ok = false;
    }
    found.push_back(std::move(component));
  }
  if (!ok) return std::nullopt;
  return found;
}

/// Displacements of each component in the rigid-body motions about the origin (m x 6); scalar points do not move.
MatrixXd calc_rigid_rows(const Maker& maker, const std::vector<Component>& components) {
  MatrixXd rows = MatrixXd::Zero(static_cast<Eigen::Index>(components.size()), 6);
  for (std::size_t i = 0; i < components.size(); ++i) {
    const Node& node = maker.nodes().node(components[i].node);
    if (node.num_dofs != 6) continue;
    MatrixXd motion = MatrixXd::Identity(6, 6);
    motion.topRightCorner<3, 3>() = -skew(node.x);
    rows.row(static_cast<Eigen::Index>(i)) = components[i].row.transpose() * motion;
  }
  return rows;
}

/// S by which u_i follows u_d as one rigid body; nothing when u_d does not hold it (reported). Fewer than six
/// components hold it where the others do not move u_i, as in a plane model.
std::optional<MatrixXd> calc_rigid_s(Maker& maker, const std::vector<Component>& ui, const std::vector<Component>& ud,
                                     const std::string& who, const records::CardLocation& at) {
  const MatrixXd P_d = calc_rigid_rows(maker, ud), P_i = calc_rigid_rows(maker, ui);
  const Eigen::CompleteOrthogonalDecomposition<MatrixXd> factor(P_d);
  if (factor.rank() == P_d.rows()) {
    const MatrixXd S = P_i * factor.pseudoInverse();
    if ((S * P_d - P_i).norm() <= 1e-9 * P_i.norm()) return S;
  }
  maker.error(
      "fe.rigid-independent", at,
      who + " has no S and its UD list has " + std::to_string(P_d.rows()) + " components that do not hold a body",
      "give S, or components in UD that fix its rigid-body motions");
  return std::nullopt;
}

void make_general(Maker& maker, const records::Genel& card) {
  const std::string who = "GENEL " + std::to_string(card.id);
  const auto ui = find_components(maker, card.ui, who, card.at), ud = find_components(maker, card.ud, who, card.at);
  if (!ui || !ud) return;
  MatrixXd k = card.matrix;
  if (card.is_flexibility) {
    const Eigen::LLT<MatrixXd> factor(k);
    if (factor.info() != Eigen::Success) {
      maker.error("fe.bad-property", card.at, who + " has a flexibility Z that is not positive definite",
                  "correct Z, or give K");
      return;
    }
    k = factor.solve(MatrixXd::Identity(k.rows(), k.cols()));
  }
  std::optional<MatrixXd> S = card.s;
  if (!ud->empty() && card.s.size() == 0) S = calc_rigid_s(maker, *ui, *ud, who, card.at);
  if (!S) return;
  std::vector<int> nodes;
  for (const auto* list : {&*ui, &*ud})
    for (const auto& component : *list)
      if (std::find(nodes.begin(), nodes.end(), component.node) == nodes.end()) nodes.push_back(component.node);
  auto gdofs = maker.list_gdofs(nodes);
  const auto find_first = [&](int node) {
    const int gdof = maker.nodes().node(node).first_gdof;
    return static_cast<Eigen::Index>(std::find(gdofs.begin(), gdofs.end(), gdof) - gdofs.begin());
  };
  const auto make_rows = [&](const std::vector<Component>& list) {
    MatrixXd rows = MatrixXd::Zero(static_cast<Eigen::Index>(list.size()), static_cast<Eigen::Index>(gdofs.size()));
    for (std::size_t i = 0; i < list.size(); ++i)
      rows.row(static_cast<Eigen::Index>(i)).segment(find_first(list[i].node), list[i].row.size()) = list[i].row;
    return rows;
  };
  MatrixXd B = make_rows(*ui);
  if (!ud->empty()) B -= *S * make_rows(*ud);
  maker.add(std::make_unique<General>(card.id, std::move(nodes), std::move(gdofs), std::move(k), std::move(B)));
}

}  // namespace

void make_generals(Maker& maker) {
  for (const auto& card : maker.deck().special.genel) make_general(maker, card);
}

}  // namespace bough::fe
