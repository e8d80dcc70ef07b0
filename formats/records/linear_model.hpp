#pragma once
/// \file A linear model ẋ = A x + B u, y = C x + D u about an operating point (docs/formats/linear.md).
#include <complex>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "formats/records/unit_labels.hpp"

namespace bough::records {

/// States, inputs or outputs of a linear model: a name each, and its dimensions in M L T F.
struct Signals {
  std::vector<std::string> name, dims;
  /// Number of signals.
  int size() const { return static_cast<int>(name.size()); }
};

/// Eigenvalues of A: complex pairs together, by distance from zero.
struct Poles {
  Eigen::VectorXd real, imag;
  Eigen::VectorXd frequency_hz;               ///< |λ| / 2π
  Eigen::VectorXd damping;                    ///< -Re λ / |λ|; 0 at the origin
  Eigen::VectorXd error;                      ///< estimated, of λ; empty where it was not asked for
  std::vector<std::string> mode;              ///< the coordinate that takes part most
  std::vector<std::string> body_mode, hinge;  ///< the mode and the hinge coordinate that do; "" where none does
  /// Number of poles, equal to that of states.
  int size() const { return static_cast<int>(real.size()); }
};

/// Characteristic multipliers of a system with sampled controllers: eigenvalues of the transition over one period.
struct Multipliers {
  double period = 0;    ///< of all samples together; 0: nothing is sampled
  int num_samples = 0;  ///< instants in it
  Eigen::VectorXd real, imag;
  Eigen::VectorXd decay;         ///< ln |z| / period: negative where it dies out
  Eigen::VectorXd frequency_hz;  ///< |arg z| / (2π period), up to multiples of 1 / period
  std::vector<std::string> mode;
};

/// Hankel singular values of the stable part of the model.
struct Hankel {
  Eigen::VectorXd value;  ///< singular values, descending
  Eigen::MatrixXd controllability,
      observability;     ///< Gramians, of all states: X with A X + X Aᵀ + B Bᵀ = 0, and its dual
  int num_left_out = 0;  ///< poles that do not decay
};

/// A mode of a sampled model faster than half the sample rate, whose pole appears at another frequency.
struct AliasedMode {
  std::string mode;
  double frequency_hz = 0;   ///< [1/T] of the continuous motion, |Im λ| / 2π
  double appears_at_hz = 0;  ///< [1/T] of the pole ln z / sample_time, at most 1 / (2 sample_time)
};

/// A parameter that is known between two values: w = δ z with δ from -1 at `low` to 1 at `high`, and as many inputs w
/// and outputs z of the model as `size`.
struct UncertainParameter {
  std::string name;
  double low = 0, high = 0;
  int size = 0;
};

/// With a sample_time: x, u and y from sample to sample, x⁺ = A x + B u; poles are those of ln z / sample_time.
struct LinearModel {
  std::vector<std::pair<std::string, std::string>> source;  ///< (file name, SHA-256)
  double sample_time = 0;                                   ///< 0: continuous
  Eigen::MatrixXd A, B, C, D;
  Signals states, inputs, outputs;
  UnitLabels units;  ///< [units] of the system file

  double time = 0;       ///< of the operating point
  Eigen::VectorXd q, u;  ///< generalized positions (quaternions w, x, y, z) and speeds there
  Signals q_names, u_names;
  std::vector<std::string> periodic;  ///< coordinates that are angles, the same again after 2π
  double residual = 0;                ///< |u̇| there: 0 at rest and in a steady spin
  double error = 0;       ///< estimated, of A and C, relative to the largest entry of the row (docs/formats/linear.md)
  double difference = 0;  ///< between A and C by one step size and by another, likewise

  Eigen::MatrixXd mass;  ///< of the DOFs, n x n: uᵀ mass u / 2 is the kinetic energy; empty if not requested

  Poles poles;
  std::vector<AliasedMode> aliased;  ///< with a sample_time
  bool has_zeros = false;            ///< there are as many outputs as inputs
  Eigen::VectorXd zeros_real, zeros_imag;

  Multipliers multipliers;
  Hankel hankel;

  /// Inputs and outputs of these parameters come first, parameter by parameter (solver/statespace/uncertainty.hpp).
  std::vector<UncertainParameter> uncertainty;
};

/// M δ̈ + D δ̇ + K δ = F u + Z z, δ the displacements of the DOFs, z the other states, of controllers, actuators and
/// sensors: n x n, n x n, n x n, n x num_inputs, n x nz.
struct SecondOrder {
  Eigen::MatrixXd M, D, K, F, Z;
};

/// |z| below which a pole of a sampled model is zero: a held value or a delay, gone within a sample.
constexpr double kGone = 1e-9;

/// Below which pole i is zero: its error, or the rounding of the largest pole.
double calc_origin_radius(const Poles& poles, Eigen::Index i);

/// z = exp(λ sample_time) of pole i of a sampled model; 0 where it is gone.
std::complex<double> calc_z(const LinearModel& model, Eigen::Index i);
/// Returns true for poles at z = 0 of a sampled model: their λ is the logarithm of round-off.
bool is_gone(const LinearModel& model, Eigen::Index i);

/// Returns true for the loop transfer of a cut, one value or, of a lifted loop, several: outputs "NAME:return".
bool is_cut_loop(const LinearModel& model);

/// Second-order form of the model. Empty if the model has no mass matrix or is one from sample to sample.
SecondOrder make_second_order(const LinearModel& model);

}  // namespace bough::records
