#pragma once
/// \file The second order of rigid links: what turns when the grids that carry them turn (docs/theory/links.md).
#include <array>
#include <map>
#include <vector>

#include "fe/elements/element.hpp"
#include "fe/model/constraints.hpp"

namespace bough::fe {

/// ½ Σ_k λ_k (L q)ᵀ W_k (L q): potential of the forces λ that equations [first, first + W.size()) carry, in the basic
/// g-dofs of a few grids.
struct Link {
  int first_equation = 0;
  std::vector<int> gdofs;
  MatrixXd L;               ///< r x gdofs: rotations and other motions of the link
  std::vector<MatrixXd> W;  ///< r x r, symmetric, one per equation
};

/// K_G += Lᵀ W_c L of load c, on g-dofs in basic axes. Column c of `weights`: the lower triangle of W_c, column after
/// column.
struct QuadraticForm {
  std::vector<int> gdofs;
  MatrixXd L;        ///< r x gdofs
  MatrixXd weights;  ///< r (r + 1) / 2 x loads
};
/// Position of W(i, j), i ≥ j, in the columns of `weights`.
int find_weight(int r, int i, int j);
MatrixXd calc_form(const QuadraticForm& form, Eigen::Index load);  ///< Lᵀ W_c L

/// The links of a model, with all its constraint equations (those of MPC too) before chains are resolved: a link passes
/// on the forces of all that is attached to its dependent grids.
class Links {
 public:
  Links() = default;
  /// `equations`: u_dependent = Σ c u over the l-set, without cycles.
  Links(std::vector<Link> links, std::vector<ConstraintEquation> equations);

  /// Returns true if the model has no link with a second order.
  bool empty() const { return links_.empty(); }
  /// l-dofs whose residual forces are needed, ascending.
  const std::vector<int>& dependents() const { return dependents_; }
  /// `force`: dependents x loads, F - K u in the displacement axes of the grids.
  std::vector<QuadraticForm> calc_forms(const Eigen::Ref<const MatrixXd>& force) const;

 private:
  std::vector<Link> links_;
  std::vector<ConstraintEquation> equations_;
  std::vector<int> order_;  ///< equations, each after all that use its dependent dof
  std::vector<int> dependents_;
};

/// A motion as a sum over g-dofs (basic).
using DofSum = std::map<int, double>;

/// Writes one link: rows of L and, equation by equation, W.
class LinkBuilder {
 public:
  /// One component of a grid of the link: its place from the frame's point, its axis in basic.
  struct Component {
    const Node* node = nullptr;
    Vector3d place = Vector3d::Zero(), axis = Vector3d::Zero();
    bool is_rotation = false;
    bool is_whole = false;  ///< the link joins all three translations (rotations) of the grid
  };

  /// The frame's motion: v of its point, θ.
  LinkBuilder(const std::array<DofSum, 3>& v, const std::array<DofSum, 3>& theta);

  /// Number of rows of L so far.
  int num_rows() const { return static_cast<int>(rows_.size()); }
  /// Adds a row to L and returns its index.
  int add_row(DofSum row);
  /// Starts W of the next equation, zero.
  void start_equation() { W_.emplace_back(); }
  /// W of the current equation += factor times that of a unit force (moment) on the component: the second order of
  /// where it goes as the frame turns, axes and all.
  void add_component(const Component& component, double factor);
  /// W(i, j) and W(j, i) += value; twice on the diagonal is for the caller to avoid.
  void add_weight(int i, int j, double value) { W_.back()[{std::max(i, j), std::min(i, j)}] += value; }

  /// Returns the link: L on the g-dofs of its rows, ascending, and a symmetric W per equation. `first_equation`: index
  /// of the first one.
  Link finish(int first_equation) const;

 private:
  int find_own_rows(const Component& component);

  std::array<DofSum, 3> v_;
  std::vector<DofSum> rows_;
  std::map<std::pair<int, bool>, int> own_;  ///< first row of u_i - v, of θ_i, by first g-dof
  std::vector<std::map<std::pair<int, int>, double>> W_;
};

}  // namespace bough::fe
