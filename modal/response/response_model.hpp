#pragma once
/// \file A driven model in few coordinates (docs/theory/response.md): normal modes, residual vectors of what drives it,
/// the motion of its supports.
#include <functional>
#include <optional>

#include "modal/bases/ritz.hpp"
#include "modal/eigen.hpp"
#include "modal/response/excitation.hpp"

namespace bough::modal::response {

/// Modes of the model from the lowest up, unit generalized mass.
struct ModeBasis {
  VectorXd lambda;
  MatrixXd Phi;
  int num_rigid = 0;     ///< first
  int num_left_out = 0;  ///< of them, the first: below V1 of EIGRL or PARAM,LFREQ; they take no part
};

struct DampingChoice {
  double g = 0;                   ///< PARAM,G
  double w3 = 0, w4 = 0;          ///< over time: where g and GE become viscous; 0: they do not act
  double alpha1 = 0, alpha2 = 0;  ///< B += α1 M + α2 K
  /// K2PP X, which neither g nor α2 acts on; empty if there is none.
  std::function<MatrixXd(const MatrixXd&)> times_direct;
  bool is_over_time = false;
  bool is_stiffness = false;                     ///< PARAM,KDAMP,-1: the curve is structural damping
  const records::DampingCurve* curve = nullptr;  ///< SDAMPING
  /// PARAM,ENFMOTN,REL: the curve damps the motion relative to the supports, q; else the absolute one, q + Φᵀ M Ψ d.
  bool is_relative = false;
};

/// u = Φ q + Ψ d on the g-set, basic axes, with
///   m q̈ + D q̇ + (Λ + i S) q = P a, m = 1 or 0.
/// d: motions of the supports (columns of Excitation::D), Ψ: what follows them statically. Loads a, m + 3 k of them:
/// forces of F, then of M Ψ (amplitude -d̈), B Ψ (-ḋ), K_s Ψ (-i d).
struct ResponseModel {
  MatrixXd Phi;  ///< rigid-body motions, normal modes, residual vectors; then what has no mass, of unit stiffness
  VectorXd lambda;
  int num_rigid = 0, num_normal = 0;  ///< what is after num_normal are residual vectors
  int num_massless = 0;               ///< the last ones
  MatrixXd Psi;
  MatrixXd P;               ///< n x (m + 3k)
  MatrixXd D, S;            ///< n x n, viscous and structural
  bool is_coupled = false;  ///< D or S has terms off the diagonal
  VectorXd damping_ratio;   ///< n, of each coordinate: D_jj / 2ω + S_jj / 2λ; 0 for rigid and massless ones
  VectorXd u0, v0;          ///< start of those with mass: M-projection of TIC; empty without

  /// Number of coordinates with mass, the first ones.
  Eigen::Index num_dynamic() const { return lambda.size() - num_massless; }
};

struct StartMotion {
  VectorXd u, v;            ///< g-set, basic; empty: at rest
  VectorXd u_free, v_free;  ///< the same on the f-set
};
/// IC of the subcase. Reports modal.missing-initial, fe.missing-grid, fe.bad-component, modal.initial-held.
StartMotion calc_start(const fe::Model& model, const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                       Diagnostics& diagnostics);

/// B X and K_s X on the g-set: over time K_s is in B, at the rates W3 and W4.
MatrixXd times_damping(const fe::Model& model, const DampingChoice& damping, const MatrixXd& X);
/// K_s X, structural damping of elements and g of PARAM,G; zero over time, where it is in B.
MatrixXd times_structural(const fe::Model& model, const DampingChoice& damping, const MatrixXd& X);

/// `solve`: static solutions on the supports (with rigid modes: any determinate ones). `with_residuals`: RESVEC.
/// Warnings: modal.negative-damping, modal.massless-damper (over time).
ResponseModel make_response_model(const fe::Model& model, const ModeBasis& modes, const bases::StaticSolve& solve,
                                  const Excitation& excitation, const StartMotion& start, const DampingChoice& damping,
                                  bool with_residuals, Diagnostics& diagnostics);

/// Leaves normal modes out of which MODSEL of the subcase does not name the number, residual vectors of all modes stay.
/// Reports modal.missing-set and modal.empty-selection. \param num_left_out  modes below the first of `model`.
void select_modes(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase, int num_left_out,
                  ResponseModel& model, Diagnostics& diagnostics);

}  // namespace bough::modal::response
