#pragma once
/// \file A driven model in all its free dofs: solved directly, without modes (docs/theory/response.md).
#include <functional>

#include "fe/linear/complex_lu.hpp"
#include "fe/linear/factor.hpp"
#include "fe/matrices/system.hpp"
#include "modal/response/frequency_list.hpp"
#include "modal/response/response_model.hpp"

namespace bough::modal::response {

using Eigen::MatrixXcd;

/// u = T q + X d with X = T_fixed D, and u_o = -K_oo⁻¹ K_os d of what ASET leaves out, on the f-set
///   M q̈ + B q̇ + (K + i S) q = Tᵀ (F p - M X d̈ - B X ḋ - (K + i S) X d).
/// Over time S is in B, at the rates W3 and W4.
struct DirectModel {
  linear::SymmetricMatrix K, M, B, S;  ///< B, S: empty if nothing damps
  VectorXd K_diagonal, M_diagonal;     ///< |K_ii|, M_ii
  MatrixXd X;                          ///< num_gdofs x k
  MatrixXd F, K_X, M_X, B_X, S_X;      ///< Tᵀ of the patterns, num_fdofs x m or k
};
/// Assembles the matrices with the direct input of the subcase; B contains α1 M + α2 K, and over time the viscous
/// equivalents g/ω3 and 1/ω4 of the structural damping. Collective.
DirectModel make_direct_model(const fe::System& system, const records::DynamicDeck& deck,
                              const records::DynamicSubcase& subcase, const Excitation& excitation,
                              const DampingChoice& damping);

/// Random load with a component along every motion, to detect a singular matrix. Fixed seed.
VectorXd make_probe(Eigen::Index n);

/// Motion on the g-set (basic), a column per sample, and the amplitudes p of the forces.
template <class Values>
struct MotionBlock {
  VectorXd x;  ///< Hz, or time
  Values u, u_dot, u_ddot, p;
};

/// Unsymmetric addition to the dynamic stiffness at a frequency [1/T, cycles], num_gdofs x num_gdofs.
using AddedStiffness = std::function<linear::ComplexSparse(double hz)>;

/// One factorization of K + iS + iωB - ω²M, and of `added` if it is not empty, for each frequency; `take` gets the
/// solutions some at a time. Leaves out
/// (BoundedFrequencies) where the matrix is singular to working precision, and 0 Hz where supports move by a velocity
/// or an acceleration. Returns the largest residual (ResidualRecord).
double solve_spectrum(const fe::Model& model, const DirectModel& direct, const Excitation& excitation,
                      const VectorXd& hz, const std::function<void(const MotionBlock<MatrixXcd>&)>& take,
                      Diagnostics& diagnostics, const AddedStiffness& added = {});

/// Radau IIA of three stages (Hairer & Wanner, "Solving ordinary differential equations II", 2nd ed., IV.5): of order
/// 5, without bound of the step, and what has no mass or is far too quick for the step follows its loads at once. Loads
/// are taken at the stages, motions of the supports are those of the modal solution (sampled_curve.hpp). For each size
/// of step one real and one complex factorization. Returns the residual of the equation of motion at the ends of steps.
double solve_history(const fe::Model& model, const DirectModel& direct, const Excitation& excitation,
                     const StartMotion& start, const TimeGrid& grid,
                     const std::function<void(const MotionBlock<MatrixXd>&)>& take);

}  // namespace bough::modal::response
