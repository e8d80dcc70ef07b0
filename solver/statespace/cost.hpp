#pragma once
/// \file Share of each state of a stable linear model in the mean square of its outputs (docs/theory/linear.md).
#include <Eigen/Dense>

namespace bough::statespace {

/// The part of ẋ = A x that decays: z = L x, ż = T z, and what z means to x is U z. T is upper triangular.
struct StablePart {
  Eigen::MatrixXcd T, U, L;
  int num_rigid = 0;                  ///< states left out: poles at 0, or all that do not decay
  std::complex<double> unstable = 0;  ///< a pole that neither decays nor is at 0; 0: there is none
  /// Returns true if every pole decays or is at 0.
  bool is_stable() const { return unstable == std::complex<double>(0); }
};

/// Schur's form with the poles at 0 (below 1e-6 of the largest) moved after the others and decoupled; with
/// `leave_unstable` all that do not decay.
StablePart split_stable(const Eigen::MatrixXd& A, bool leave_unstable = false);

/// X of A X + X Aᵀ + Q = 0 on the stable part, Q symmetric: X = U Y Uᴴ with T Y + Y Tᴴ + L Q Lᴴ = 0 (Bartels & Stewart,
/// CACM 15 (1972) 820). Poles at 0 take no part.
Eigen::MatrixXd solve_lyapunov(const StablePart& part, const Eigen::MatrixXd& Q);

/// Component cost (Skelton & Hughes, J. Dyn. Sys. Meas. Control 102 (1980) 151): with white noise of unit intensity at
/// every input, V = tr(C X Cᵀ) is the mean square of y, and V_i = [X CᵀC]_ii the part of state i: Σ V_i = V. A part can
/// be negative.
struct ComponentCost {
  double total = 0;
  Eigen::VectorXd state;  ///< one per state
  int num_rigid = 0;      ///< poles at 0, left out
};

/// ẋ = A x + B u, y = C x.
struct StateSpace {
  Eigen::MatrixXd A, B, C;
};

/// Returns true if the poles of the invariant subspace of the projector Π couple inputs to outputs: C Aᵏ Π B is not
/// negligible to |C| |Aᵏ B|, k = 0 to 3.
bool is_seen(const StateSpace& s, const Eigen::MatrixXd& projector);

/// Mean square of y - y_r of two models with the same inputs and outputs, white noise of unit intensity at the inputs;
/// poles at 0 of either take no part. Throws ComputationError "select.unstable".
double calc_mean_square_difference(const StateSpace& full, const StateSpace& reduced);

/// Throws ComputationError "select.unstable" when a pole off 0 does not decay.
ComponentCost calc_component_cost(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, const Eigen::MatrixXd& C);

/// Component cost of a single mode η̈ + 2ζω η̇ + ω² η = bᵀ u, y = c_d η + c_r η̇: |b|² (|c_d|² + ω² |c_r|²) / (4 ζ ω³).
/// Near V_i if the modes are lightly damped and well separated.
double calc_modal_cost(double omega, double zeta, double b_squared, double c_d_squared, double c_r_squared);

}  // namespace bough::statespace
