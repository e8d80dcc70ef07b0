#pragma once
/// \file Fields on the g-set, of a model by parts as far as the elements of a rank reach.
#include <vector>

#include "fe/linear/own_rows.hpp"
#include "fe/model/model.hpp"

namespace bough::fe {

/// The rows of g-set fields that a rank keeps: those of the elements that it owns and of its own nodes, ascending; the
/// ranks together have all. Of a whole model all of them.
struct Reach {
  std::vector<int> gdofs;
  std::vector<int> place;  ///< of every g-dof: its row, -1 for none; empty: the g-dof itself

  int find_row(int gdof) const { return place.empty() ? gdof : place[static_cast<std::size_t>(gdof)]; }
};
Reach find_reach(const Model& model);

/// T X of own rows X; a few columns at a time are whole. Collective.
MatrixXd expand(const Model& model, const OwnRows& rows, const Reach& reach, const Eigen::Ref<const MatrixXd>& X);
/// Φ_R about `point`, rows of `reach`.
MatrixXd take_rigid_modes(const Model& model, const Reach& reach, const Vector3d& point);
/// What this rank adds to M X (times WTMASS), rows of `reach`: the sum over ranks of Yᵀ times it is Yᵀ M X.
MatrixXd calc_own_mass_times(const Model& model, MassKind kind, const Reach& reach,
                             const Eigen::Ref<const MatrixXd>& X);
/// Columns that products of many vectors take at a time: their memory counts beside that of the vectors.
constexpr Eigen::Index kColumnsAtOnce = 128;
/// XᵀMX, alike on every rank; M X of some columns at a time. Collective, as the next.
MatrixXd calc_mass_gram(const Model& model, MassKind kind, const Reach& reach, const MatrixXd& X);
/// Its diagonal.
VectorXd calc_modal_mass(const Model& model, MassKind kind, const Reach& reach, const MatrixXd& X);

}  // namespace bough::fe
