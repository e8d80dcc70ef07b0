#include "fe/model/autospc.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "fe/linear/ranks.hpp"
#include "fe/model/element_loop.hpp"
#include "fe/model/element_transform.hpp"

namespace bough::fe {
namespace {

constexpr double kNothing = 1e-14;  ///< below this share of the terms that it is a sum of, stiffness is round-off

struct NodeBlocks {
  std::vector<Matrix3d> K;    ///< 2k and 2k+1: node k's translations and rotations
  std::vector<double> noise;  ///< bound of the round-off of the elements in the block
};

/// Sizes of the terms that sum to the diagonal of K_e: one size for the translations, since directions are sums of
/// others; for the rotations also k r² of a translational stiffness k on an arm r.
VectorXd calc_sizes(const Element& element, const std::vector<Node>& nodes, const std::vector<int>& gdof_node,
                    const MatrixXd& K_e) {
  double arm = 0, largest[2] = {0, 0};
  for (int k : element.nodes()) arm = std::max(arm, (nodes[k].x - nodes[element.nodes()[0]].x).norm());
  std::vector<int> kinds;
  for (int i = 0; i < element.num_dofs(); ++i) {
    const int g = element.gdofs()[i];
    kinds.push_back(g - nodes[gdof_node[g]].first_gdof < 3 ? 0 : 1);
    largest[kinds.back()] = std::max(largest[kinds.back()], std::abs(K_e(i, i)));
  }
  largest[1] = std::max(largest[1], largest[0] * arm * arm);
  VectorXd sizes(element.num_dofs());
  for (int i = 0; i < sizes.size(); ++i) sizes(i) = largest[kinds[i]];
  return sizes;
}

/// Rigid elements whose parts cancel leave the round-off of Σ T_if² d_i; that of several elements adds up like noise.
void add_noise(const VectorXd& sizes, ElementTransform& transform, const std::vector<int>& fdof_block,
               std::vector<double>& noise_squared) {
  const VectorXd& projected = transform.project_diagonal(sizes);
  for (std::size_t i = 0; i < transform.columns().size(); ++i) {
    double& noise = noise_squared[fdof_block[transform.columns()[i]]];
    noise += std::pow(kNothing * projected(static_cast<Eigen::Index>(i)), 2);
  }
}

/// Where the f-dofs belong: the block of each, its row there; and the node of each dof of the l-set.
struct Places {
  const std::vector<int>&gdof_node, &fdof_block, &fdof_slot;
};

/// Sums blocks of what is added, each in a separate transform.
class BlockSum {
 public:
  BlockSum(const Model& model, const Places& places) : model_(model), places_(places) {
    const size_t num = 2 * model.nodes().size();
    sum = {std::vector<Matrix3d>(num, Matrix3d::Zero()), std::vector<double>(num, 0)};
  }
  void add(int, const Element& element) {
    const int n = element.num_dofs();
    K_e_.setZero(n, n);
    model_.add_stiffness(element, K_e_);
    if (K_e_.isZero(0)) return;
    transform_.set(model_.T(), element.gdofs());
    add_noise(calc_sizes(element, model_.nodes(), places_.gdof_node, K_e_), transform_, places_.fdof_block, sum.noise);
    add(K_e_);
  }
  void merge(const BlockSum& second) {
    for (size_t i = 0; i < sum.K.size(); ++i) {
      sum.K[i] += second.sum.K[i];
      sum.noise[i] += second.sum.noise[i];
    }
  }
  void add_forms() {
    for (const auto& form : model_.prestress()->forms) {
      transform_.set(model_.T(), form.gdofs);
      add(calc_form(form, 0));
    }
  }

  NodeBlocks sum;  ///< of the noise, the squares

 private:
  void add(const MatrixXd& K) {
    transform_.hold(K);
    const auto& columns = transform_.columns();
    for (size_t i = 0; i < columns.size(); ++i)
      for (size_t j = i; j < columns.size() && j < i + 6; ++j) {
        if (places_.fdof_block[columns[i]] != places_.fdof_block[columns[j]]) continue;
        Matrix3d& block = sum.K[places_.fdof_block[columns[i]]];
        const int a = places_.fdof_slot[columns[i]], b = places_.fdof_slot[columns[j]];
        const double value = transform_.entry(static_cast<int>(i), static_cast<int>(j));
        block(a, b) += value;
        if (a != b) block(b, a) += value;
      }
  }

  const Model& model_;
  const Places& places_;
  ElementTransform transform_;
  MatrixXd K_e_;
};

NodeBlocks calc_node_blocks(const Model& model, const Places& places) {
  constexpr int kMinElementsOfThread = 2000;  // fewer are done before a thread has started
  BlockSum sum =
      sum_over_elements(model, get_all_elements(model), kMinElementsOfThread, [&] { return BlockSum(model, places); });
  NodeBlocks& result = sum.sum;
  if (model.prestress()) sum.add_forms();
  for (double& noise : result.noise) noise = std::sqrt(noise);
  return std::move(result);
}

/// Eigenvalues by size, the smallest first, with their vectors: a negative stiffness is one.
std::pair<VectorXd, MatrixXd> find_principal_stiffness(const MatrixXd& K) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(K);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(K.rows()));
  std::iota(order.begin(), order.end(), 0);
  const VectorXd size = solver.eigenvalues().cwiseAbs();
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return size(a) < size(b); });
  return {size(order), solver.eigenvectors()(Eigen::all, order)};
}

/// Returns true if the free part of K is definite with its smallest eigenvalue well above `limit`, by the bound
/// λ1 = det / (λ2 λ3) >= 4 det / trace². Most blocks are, and need no eigenvalues.
bool is_stiff(Matrix3d K, const std::array<char, 3>& is_free, double scale, double limit) {
  for (int s = 0; s < 3; ++s) {
    if (is_free[static_cast<std::size_t>(s)]) continue;
    K.row(s).setZero();
    K.col(s).setZero();
    K(s, s) = scale;
  }
  const double minor = K(0, 0) * K(1, 1) - K(0, 1) * K(1, 0), determinant = K.determinant(), trace = K.trace();
  return K(0, 0) > 0 && minor > 0 && 4 * determinant > trace * trace * std::max(2 * limit, 1e-6 * scale);
}

/// Makes the entries of a block oblique if a constrained component has stiffness: for the directions N without
/// stiffness (columns, rows `slots`) the constrained components follow the free ones by Nᵀ u = 0. `limit`: largest
/// stiffness that is negligible.
void set_oblique(const Matrix3d& K, const std::vector<int>& slots, double limit, bool is_rotation,
                 std::vector<AutospcEntry>& entries, std::size_t first) {
  const auto slot_of = [&](const AutospcEntry& e) { return e.component - 1 - (is_rotation ? 3 : 0); };
  const auto m = static_cast<Eigen::Index>(entries.size() - first);
  std::vector<Eigen::Index> held, free;  // of slots
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const bool is_held = std::any_of(entries.begin() + static_cast<std::ptrdiff_t>(first), entries.end(),
                                     [&](const AutospcEntry& e) { return slot_of(e) == slots[i]; });
    (is_held ? held : free).push_back(static_cast<Eigen::Index>(i));
  }
  for (std::size_t e = first; e < entries.size(); ++e)
    entries[e].is_skew = std::abs(K(slot_of(entries[e]), slot_of(entries[e]))) > limit;
  const bool is_any = std::any_of(entries.begin() + static_cast<std::ptrdiff_t>(first), entries.end(),
                                  [](const AutospcEntry& e) { return e.is_skew; });
  if (!is_any || free.empty()) return;
  const auto [stiffness, directions] = find_principal_stiffness(K(slots, slots));
  if (stiffness[m - 1] > limit || stiffness[m] <= limit) return;
  const MatrixXd N = directions.leftCols(m);
  const Eigen::FullPivLU<MatrixXd> lu(MatrixXd(N(held, Eigen::all).transpose()));
  if (lu.rcond() < 1e-6) return;
  const MatrixXd C = lu.solve(-MatrixXd(N(free, Eigen::all).transpose()));
  for (std::size_t i = 0; i < held.size(); ++i)
    for (std::size_t j = 0; j < free.size(); ++j)
      if (const double c = C(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)); std::abs(c) > 1e-12)
        entries[first + i].terms.emplace_back(slots[static_cast<std::size_t>(free[j])] + 1 + (is_rotation ? 3 : 0), c);
}

}  // namespace

std::vector<AutospcEntry> find_singular_dofs(const Model& model, const std::vector<int>& fdof_ldof, double epsilon) {
  const auto& nodes = model.nodes();
  // A scalar point is a block of one translation.
  std::vector<int> ldof_node;
  for (size_t k = 0; k < nodes.size(); ++k) ldof_node.insert(ldof_node.end(), nodes[k].num_dofs, static_cast<int>(k));
  const int num_blocks = 2 * static_cast<int>(nodes.size());
  std::vector<int> fdof_block(fdof_ldof.size()), fdof_slot(fdof_ldof.size());
  std::vector<std::array<char, 3>> is_free(num_blocks, {0, 0, 0});
  for (size_t f = 0; f < fdof_ldof.size(); ++f) {
    const int k = ldof_node[fdof_ldof[f]], component = fdof_ldof[f] - nodes[k].first_gdof;
    fdof_block[f] = 2 * k + component / 3;
    fdof_slot[f] = component % 3;
    is_free[fdof_block[f]][fdof_slot[f]] = 1;
  }
  const auto [blocks, noise] = calc_node_blocks(model, {ldof_node, fdof_block, fdof_slot});
  std::vector<AutospcEntry> entries;
  for (int b = 0; b < num_blocks; ++b) {
    const double scale = blocks[b].diagonal().cwiseAbs().maxCoeff();
    const double limit = std::max(epsilon * scale, noise[b]);
    if (scale > noise[b] && is_stiff(blocks[b], is_free[b], scale, limit)) continue;
    const Node& node = nodes[b / 2];
    std::vector<int> slots;
    for (int s = 0; s < 3; ++s)
      if (is_free[b][s]) slots.push_back(s);
    const auto all_slots = slots;
    const size_t first = entries.size();
    while (!slots.empty()) {
      int singular = 0;
      double ratio = 0;
      if (scale > noise[b]) {
        const auto [stiffness, directions] = find_principal_stiffness(blocks[b](slots, slots));
        ratio = stiffness[0] / scale;
        if (stiffness[0] > limit) break;
        // The last of equal shares: a rod along a diagonal keeps its first component.
        const Eigen::VectorXd share = directions.col(0).cwiseAbs();
        for (int i = 0; i < share.size(); ++i)
          if (share[i] >= share.maxCoeff() - 1e-9) singular = i;
      }
      const int component = node.num_dofs == 1 ? 0 : 3 * (b % 2) + slots[singular] + 1;
      entries.push_back({node.id, component, ratio});
      slots.erase(slots.begin() + singular);
    }
    std::sort(entries.begin() + static_cast<std::ptrdiff_t>(first), entries.end(),
              [](const AutospcEntry& x, const AutospcEntry& y) { return x.component < y.component; });
    if (entries.size() > first && node.num_dofs == 6 && scale > noise[b])
      set_oblique(blocks[b], all_slots, limit, b % 2 == 1, entries, first);
  }
  return entries;
}

std::vector<double> calc_masses(const Model& model, const std::vector<int>& fdof_ldof,
                                const std::vector<AutospcEntry>& entries) {
  std::unordered_map<int, std::size_t> at_dof;  // entries
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const int node = model.find_node(entries[e].node);
    at_dof[model.node(node).first_gdof + std::max(entries[e].component - 1, 0)] = e;
  }
  std::vector<int> entry_of(fdof_ldof.size(), -1);
  for (std::size_t f = 0; f < fdof_ldof.size(); ++f)
    if (const auto found = at_dof.find(fdof_ldof[f]); found != at_dof.end())
      entry_of[f] = static_cast<int>(found->second);
  VectorXd mass = VectorXd::Zero(static_cast<Eigen::Index>(entries.size()));
  ElementTransform transform;
  MatrixXd M_e;
  for (const auto& element : model.elements()) {
    transform.set(model.T(), element->gdofs());
    const auto& columns = transform.columns();
    if (std::none_of(columns.begin(), columns.end(), [&](int f) { return entry_of[static_cast<std::size_t>(f)] >= 0; }))
      continue;
    M_e.setZero(element->num_dofs(), element->num_dofs());
    element->add_mass(model.mass_kind(), 1, M_e);
    if (M_e.isZero(0)) continue;
    transform.hold(M_e);
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (const int e = entry_of[static_cast<std::size_t>(columns[i])]; e >= 0)
        mass(e) += transform.entry(static_cast<int>(i), static_cast<int>(i));
  }
  return {mass.begin(), mass.end()};
}

}  // namespace bough::fe
