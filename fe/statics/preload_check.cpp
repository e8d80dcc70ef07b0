#include "fe/statics/preload_check.hpp"

#include <algorithm>

#include <Eigen/Eigenvalues>

#include "fe/linear/factor.hpp"
#include "fe/linear/inertia.hpp"
#include "fe/linear/products.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "fe/model/row_kinds.hpp"
#include "fe/statics/statics.hpp"

namespace bough::fe {
namespace {

/// A with rows of these kinds, and a little of its diagonal, so that motions without stiffness are not negative by
/// roundoff.
linear::SymmetricMatrix lift(const linear::SymmetricMatrix& A, const linear::RowKinds& kinds) {
  return linear::add_diagonal(A, 1e-13 * linear::raise_diagonal(linear::get_diagonal(A).cwiseAbs(), kinds, 1e-6));
}

/// Returns true if A, which is not positive definite, has a negative eigenvalue beyond roundoff; those of motions
/// without stiffness are none.
bool has_negative(const linear::SymmetricMatrix& A, const linear::RowKinds& kinds) {
  const linear::SymmetricMatrix lifted = lift(A, kinds);
  if (linear::initialize_petsc().size == 1) return !linear::SymmetricFactor::try_definite(lifted);
  return linear::count_negative_eigenvalues(lifted).value_or(0) > 0;
}

/// Negative directions of the stress among the rigid-body motions of a model that nothing holds; 0 if it is held. A
/// motion on which the stress does no work, but whose forces strain the body, is one of second order.
int count_tipping(const Model& model, const linear::SymmetricMatrix& K) {
  for (const int dof : model.fixed_dofs()) {
    const auto is_it = [&](const AutospcEntry& entry) {
      return model.node(model.find_node(entry.node)).first_gdof + std::max(entry.component - 1, 0) == dof;
    };
    if (std::none_of(model.autospc().begin(), model.autospc().end(), is_it)) return 0;
  }
  Vector3d centre = Vector3d::Zero();
  for (const Node& node : model.nodes()) centre += node.x / static_cast<double>(model.nodes().size());
  const MatrixXd R = model.calc_rigid_modes(centre), K_G_R = calc_prestress_times(model, R);
  const Eigen::Matrix<double, 6, 6> G = R.transpose() * K_G_R,
                                    elastic = R.transpose() * calc_stiffness_times(model, R) - G;
  const double roundoff = 1e-14 * linear::get_diagonal(K).cwiseAbs().sum() * R.cwiseAbs2().maxCoeff();
  if (!(elastic.norm() < 1e-6 * G.norm() + roundoff)) return 0;  // springs to ground
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(linear::symmetrize(G));
  const double largest = solver.eigenvalues().cwiseAbs().maxCoeff();
  const VectorXd force = (MatrixXd(model.T().transpose() * K_G_R) * solver.eigenvectors()).colwise().norm();
  int count = 0;
  for (int i = 0; i < 6; ++i) {
    const double g = solver.eigenvalues()[i];
    count += g < -1e-9 * largest || (g <= 1e-9 * largest && force[i] > 1e-6 * force.maxCoeff()) ? 1 : 0;
  }
  return count;
}

/// Constrains the support of a free model. If rigid-body motions need no force, the signs of the other pivots are
/// unchanged.
linear::SymmetricMatrix hold_support(const Model& model, const linear::SymmetricMatrix& A, linear::RowKinds& kinds) {
  std::vector<int> held, kept;
  try {
    held = choose_determinate_support(model, 0);
  } catch (const InputError&) {
    return A;
  }
  for (int f = 0; f < model.num_fdofs(); ++f)
    if (std::find(held.begin(), held.end(), f) == held.end()) kept.push_back(f);
  kinds = list_row_kinds(model, kept);
  return linear::take_kept(A, kept);
}

}  // namespace

std::shared_ptr<const CheckedStiffness> check_preload(const Model& model, bool is_free, Diagnostics& diagnostics) {
  if (!model.prestress() || model.num_fdofs() == 0) return nullptr;
  auto checked = std::make_shared<CheckedStiffness>();
  checked->K = assemble_stiffness(model, DofSet::Free);
  checked->factor = linear::SymmetricFactor::try_definite(checked->K);
  if (checked->factor) return checked;
  linear::RowKinds kinds = list_row_kinds(model);
  const linear::SymmetricMatrix held = is_free ? hold_support(model, checked->K, kinds) : linear::SymmetricMatrix();
  if (held && linear::SymmetricFactor::try_definite(held)) return checked;
  if (!has_negative(held ? held : checked->K, kinds)) return checked;
  // With as many negative directions in all as among the rigid-body motions, the energy of the elastic motions is
  // positive (Haynsworth): Nastran has such modes too, with negative eigenvalues.
  const int tipping = held ? 0 : count_tipping(model, checked->K);
  if (const int negative = tipping > 0 ? linear::count_negative_eigenvalues(lift(checked->K, kinds)).value_or(0) : 0;
      negative > 0 && negative <= tipping) {
    diagnostics.warning("fe.preload-tips", model.prestress()->at,
                        "the loads of the preload, " + model.prestress()->name +
                            ", keep their direction and tip the free body over: " + std::to_string(negative) +
                            " of its rigid-body motions have negative stiffness, however small the load",
                        "the structure itself does not buckle; modes prints these motions with negative eigenvalues");
    return checked;
  }
  throw ComputationError("fe.preload-buckles", model.prestress()->at,
                         "the structure buckles under its preload, " + model.prestress()->name +
                             ": its stiffness with that of the stress is not positive definite",
                         "lower the load below its first load factor (bough modes --buckling), or look for rods and "
                         "membranes under compression");
}

}  // namespace bough::fe
