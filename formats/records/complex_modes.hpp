#pragma once
/// \file Output of `modes` for complex eigenvalues: poles, damping and complex shapes of a deck.
#include <optional>

#include "formats/records/flex_body.hpp"
#include "formats/records/linear_sweep.hpp"

namespace bough::records {

/// Modes over the speed of rotors.
struct RotorSpeeds {
  struct Rotor {
    int id = 0, num_grids = 0, num_elements = 0;
    double mass = 0, polar_inertia = 0;  ///< [M], [M L²] about the axis
  };
  /// A speed at which Im λ is the magnitude of the speed, or Re λ changes its sign.
  struct Point {
    int branch = 0;           ///< column of the sweep
    double speed = 0;         ///< [1/T] of the reference rotor
    double frequency_hz = 0;  ///< [1/T] Im λ / 2π
    double whirl = 0;
    bool is_onset = true;  ///< of thresholds: the mode is unstable above the speed; false: below it
  };
  int reference = 0;            ///< rotor id; 0: the speeds of ROTORD
  bool is_synchronous = false;  ///< rotors turn at the frequency of each mode
  std::vector<Rotor> rotors;
  LinearSweep sweep;              ///< without models; columns with Im λ > 0; empty for synchronous analyses
  std::vector<Point> critical;    ///< ascending speed
  std::vector<Point> thresholds;  ///< ascending speed; a mode becomes unstable or stable
};

struct ComplexModesResult {
  std::vector<std::pair<std::string, std::string>> source;
  int subcase = 0;
  bool is_by_modes = false;     ///< SOL 110; else on the full matrices
  std::string method;           ///< METHOD of EIGC
  std::string norm = "MAX";     ///< MAX, POINT
  Eigen::VectorXcd eigenvalue;  ///< n, Im ≥ 0; ascending Im, then descending Re
  VectorXd frequency_hz;        ///< Im λ / 2π
  VectorXd damping;             ///< g = -2 Re λ / Im λ; 0 for real eigenvalues, as in Nastran
  VectorXd damping_ratio;       ///< ζ = -Re λ / |λ|
  /// Whirl of rotors: 1 a circular orbit in the direction of the spin, -1 against it, 0 along a line; at the grid with
  /// the largest orbit; empty without rotors.
  VectorXd whirl;
  double speed = -1;  ///< [1/T] of the reference rotor; negative: no rotors, or the speed of each motion
  VectorXd residual;  ///< norm of (λ² M + λ B + K) φ over the sum of the norms of its terms
  std::vector<int> node_id;
  MatrixXd node_xyz;                   ///< p x 3
  std::vector<Eigen::MatrixXcd> phi;   ///< [k] 6 x n, basic axes
  std::vector<Eigen::MatrixXcd> left;  ///< [k] 6 x n, ψᵀ (λ² M + λ B + K) = 0; empty if the matrices are symmetric
  std::vector<int> point_id;           ///< scalar points and extra points
  Eigen::MatrixXcd point_phi, point_left;  ///< points x n
  BodyMesh mesh;
  std::optional<RotorSpeeds> rotors;
  double biorthogonality = -1;  ///< largest off-diagonal term of Ψᵀ ((λ_i + λ_j) M + B) Φ; negative: not available
  std::complex<double> shift;
  int num_unknowns = 0, num_iterations = 0, num_mirrored = 0;
  double factor_entries = 0;
  bool is_complete = false;  ///< every eigenvalue of the matrices was computed
};

}  // namespace bough::records
