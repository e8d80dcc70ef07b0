#pragma once
/// \file Sparse matrices of a model in PETSc, assembled element by element by each rank; nothing dense of size ndof².
#include "fe/linear/petsc.hpp"
#include "fe/model/model.hpp"

namespace bough::fe {

enum class DofSet { Free, Global };  ///< f-set (TᵀKT) or g-set

/// K (with K_G0 of a prestressed model), or M (times WTMASS), on PETSC_COMM_WORLD; MATAIJ, zeros left out except on the
/// diagonal; the same to the last bit on any number of ranks. O(elements).
PetscMat assemble_stiffness(const Model& model, DofSet set);
PetscMat assemble_mass(const Model& model, DofSet set, MassKind kind);
/// The part of M on the g-set that moves as the translations of the grids do, and what is not known to do otherwise:
/// all but what calc_carried() tells of (fe/loads/inertial_loads.hpp).
PetscMat assemble_grid_mass(const Model& model, MassKind kind);
/// The viscous damping B of dampers and bushes.
PetscMat assemble_damping(const Model& model, DofSet set);
struct InitialForces;

/// K_G of a load with its static displacements u (num_gdofs) and the forces of heated elements
/// (fe/model/temperatures.hpp), f-set or g-set: of internal forces, carried masses, loads on arms and links.
PetscMat assemble_geometric_stiffness(const Model& model, DofSet set, const AppliedLoad& load, const VectorXd& u_g,
                                      const InitialForces* initial = nullptr);

/// Products with the g-set mass matrix without forming it: M X, num_gdofs x k, replicated on every rank. O(elements k).
MatrixXd calc_mass_times(const Model& model, MassKind kind, const Eigen::Ref<const MatrixXd>& X_g);
/// The same with K.
MatrixXd calc_stiffness_times(const Model& model, const Eigen::Ref<const MatrixXd>& X_g);
/// The same with the share of K that is K_G0 of the prestress.
MatrixXd calc_prestress_times(const Model& model, const Eigen::Ref<const MatrixXd>& X_g);
/// The same with B.
MatrixXd calc_damping_times(const Model& model, const Eigen::Ref<const MatrixXd>& X_g);
/// Σ (g + GE of the element) K_e X, the structural damping of stiffness; direct matrices (K2GG) have g alone.
MatrixXd calc_structural_damping_times(const Model& model, double g, const Eigen::Ref<const MatrixXd>& X_g);
/// Whether any element damps.
bool has_damping(const Model& model);

/// Elements [first, last) of this rank; the union over ranks is every element.
std::pair<int, int> calc_element_range(const Model& model);
/// Sums a replicated matrix over ranks in place.
void sum_over_ranks(Eigen::Ref<MatrixXd> values);

/// Gathers a distributed f-set vector onto every rank / spreads a replicated one.
VectorXd gather(Vec v);
void scatter(const Eigen::Ref<const VectorXd>& values, Vec v);

/// Mass properties about `reference` (basic), with the model's own mass kind.
records::MassProperties calc_mass_properties(const Model& model, MassKind kind, const Vector3d& reference);

/// Nastran's GROUNDCHECK on the g-set: strain energy of the six rigid motions, each divided by the largest that the
/// diagonal of K would allow; about 1e-16 for a model with no hidden ground.
Eigen::Matrix<double, 6, 1> calc_ground_check(const Model& model);

}  // namespace bough::fe
