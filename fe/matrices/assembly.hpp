#pragma once
/// \file Sparse matrices of a model in PETSc, assembled element by element by each rank; nothing dense of size ndof².
#include "fe/linear/ranks.hpp"
#include "fe/matrices/wide_part.hpp"

namespace bough::fe {

enum class DofSet { Free, Global };  ///< f-set (TᵀKT) or g-set

/// Stiffness is split such that its sparse part is definite where it is, see split_transform().
enum class MatrixKind { Stiffness, Other };

/// Σ of element matrices and of forms on PETSC_COMM_WORLD; MATAIJ, zeros left out except on the diagonal; the same to
/// the last bit on any number of ranks. With a part of low rank where constraints or forms of the f-set are wide
/// (wide_part.hpp). O(elements).
linear::SymmetricMatrix assemble(const Model& model, DofSet set, MatrixKind kind, const AddElementMatrix& add,
                                 std::vector<QuadraticForm> forms = {});
/// Sum over the elements for which `takes` is true, on the g-set; add is not called for the others.
using TakesElement = std::function<bool(const Element&)>;
linear::SymmetricMatrix assemble_some(const Model& model, const AddElementMatrix& add, const TakesElement& takes);
/// Sum over elements that no model has yet, on the g-set, whole on every rank.
SparseRows sum_elements(const Elements& elements, int num_gdofs, const AddElementMatrix& add);

/// K (with K_G0 of a prestressed model), or M (times WTMASS).
linear::SymmetricMatrix assemble_stiffness(const Model& model, DofSet set);
/// M of a kind on a set, times WTMASS.
linear::SymmetricMatrix assemble_mass(const Model& model, DofSet set, MassKind kind);
/// Gives the memory of K of the f-set back to the system as long as no function reads it, until restore_stiffness()
/// makes it again, bit for bit. False, and nothing happens, where K has a part of low rank or is on several processes.
bool drop_stiffness(const linear::SymmetricMatrix& K);
/// Assembles K again after drop_stiffness(), equal bit for bit.
void restore_stiffness(const Model& model, const linear::SymmetricMatrix& K);
/// The viscous damping B of dampers and bushes.
linear::SymmetricMatrix assemble_damping(const Model& model, DofSet set);
/// Products with the g-set mass matrix without forming it: M X, num_gdofs x k, replicated on every rank. O(elements k).
MatrixXd calc_mass_times(const Model& model, MassKind kind, const Eigen::Ref<const MatrixXd>& X_g);
/// Product K X_g. `energy`, if given: ½ x_eᵀ K_e x_e, elements x k, of this rank's elements; others have zeros.
MatrixXd calc_stiffness_times(const Model& model, const Eigen::Ref<const MatrixXd>& X_g, MatrixXd* energy = nullptr);
/// Product with the share of K that is K_G0 of the prestress.
MatrixXd calc_prestress_times(const Model& model, const Eigen::Ref<const MatrixXd>& X_g);
/// Product with B.
MatrixXd calc_damping_times(const Model& model, const Eigen::Ref<const MatrixXd>& X_g);
/// Σ (g + GE of the element) K_e X, the structural damping of stiffness; direct matrices (K2GG) have g alone.
MatrixXd calc_structural_damping_times(const Model& model, double g, const Eigen::Ref<const MatrixXd>& X_g);
/// Returns true if any element damps.
bool has_damping(const Model& model);

/// Mass properties about `reference` (basic), with the model's own mass kind.
records::MassProperties calc_mass_properties(const Model& model, MassKind kind, const Vector3d& reference);

/// Nastran's GROUNDCHECK on the g-set: strain energy of the six rigid motions, each divided by the largest that the
/// diagonal of K would allow; about 1e-16 for a model with no hidden ground.
Eigen::Matrix<double, 6, 1> calc_ground_check(const Model& model);

}  // namespace bough::fe
