#pragma once
/// \file Mass that is attached to grids: points that an element moves, their masses, and the second order of their
/// motion (docs/theory/carried-bodies.md).
#include <array>
#include <vector>

#include "fe/elements/element.hpp"

namespace bough::fe {

/// A place x that moves by H q, q the N dofs of the element; or an arm, the difference of two places.
struct CarriedPoint {
  bool is_place = true;
  Vector3d x = Vector3d::Zero();  ///< place or arm, basic
  Matrix3Xd H;                    ///< 3 x N
};

/// A rotation θ = Theta q that turns arms: to second order point p moves by B ½ θ×(θ×arm) more.
struct CarriedTurn {
  struct Part {
    int point = 0;
    Vector3d arm = Vector3d::Zero();
    Matrix3d B = Matrix3d::Identity();
  };
  int slot = -1;    ///< first dof of the element where θ is a grid's own rotation; else -1
  Matrix3Xd Theta;  ///< 3 x N
  std::vector<Part> parts;
};

/// A point that two ends move: by `motion` of their dofs [u_A θ_A u_B θ_B] (basic); an arm by `turn` too.
struct ChordPoint {
  int point = 0;
  Eigen::Matrix<double, 3, 12> motion = Eigen::Matrix<double, 3, 12>::Zero(), turn = motion;
};

/// The second order of points that move between two ends: point p moves by (L q)ᵀ Q_pa (L q) more along axis a.
struct CarriedField {
  struct Part {
    int point = 0;
    std::array<Eigen::Matrix<double, 9, 9>, 3> Q;
  };
  MatrixXd L;  ///< 9 x N: θ of end A, motion of end B from A, θ of end B
  std::vector<Part> parts;
  // For higher orders (fe/corotational/chord_series.hpp)
  Vector3d x_a = Vector3d::Zero(), chord = x_a;  ///< end A and the way to end B
  std::array<Vector3d, 2> arms = {x_a, x_a};     ///< from the grids to the ends
  std::vector<ChordPoint> moved;                 ///< in the order of `parts`
};

/// Detail of the offset mass that is requested of an element: each level contains the one before.
enum class CarriedDetail { Whether, Points, SecondOrder };

/// Kinetic energy ½ Σ μ_rs ẋ_r·ẋ_s. A material point s from a grid is the place and three arms.
struct CarriedMass {
  explicit CarriedMass(int num_dofs_, CarriedDetail detail_ = CarriedDetail::SecondOrder)
      : num_dofs(num_dofs_), detail(detail_) {}

  int num_dofs;
  CarriedDetail detail;  ///< an element may leave out what is more
  std::vector<CarriedPoint> points;
  std::vector<CarriedTurn> turns;
  std::vector<CarriedField> fields;
  MatrixXd mu = MatrixXd::Zero(0, 0);

  /// Index of a new point without mass.
  int add_point(bool is_place, const Vector3d& x, const Eigen::Ref<const Matrix3Xd>& H);
  /// Index of a new turn of the rotations at `slot`.
  int add_turn(int slot);

  /// A rigid body of moments m, S = Σ m s, E = Σ m s sᵀ about x, which moves by U q and turns by Theta q (slot as in
  /// CarriedTurn). Returns its first point: the place, then the arms along x y z unless S and E are zero. Without
  /// `has_turn` the second order is the caller's.
  int add_body(const Vector3d& x, double m, const Vector3d& S, const Matrix3d& E, const Eigen::Ref<const Matrix3Xd>& U,
               const Eigen::Ref<const Matrix3Xd>& Theta, int slot = -1, bool has_turn = true);
  /// Adds a rigid body at a grid whose six dofs start at `first`.
  void add_grid_body(const Vector3d& x, double m, const Vector3d& S, const Matrix3d& E, int first);

  /// Points of an element that deforms in the frame of its chord from x_a to x_a + chord, turned by the mean of the end
  /// rotations: adds their second order, so that a rigid-body motion of the ends is one of the points. ends: 12 x N, of
  /// grids that carry the ends by arms.
  std::vector<ChordPoint> chord_points;  ///< those of the last call, for an element made of such elements
  /// Adds the second order of points of an element that deforms in the frame of its chord; `moved`: their motion by the
  /// ends.
  void add_chord_field(const Vector3d& x_a, const Vector3d& chord, const Eigen::Ref<const MatrixXd>& ends,
                       const std::vector<ChordPoint>& moved);

  /// Selects three dofs: 3 x N.
  Matrix3Xd select(int first) const;
  /// Σ μ_rs H_rᵀ H_s, N x N.
  MatrixXd calc_mass() const;
};

/// Mass of an element that is off its grids or has rotary inertia.
class OffsetMass {
 public:
  /// Adds the bodies of M at scale 1, with the nodes at x (3 x nodes, basic). \return false if M is not that of bodies.
  virtual bool add_carried(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const = 0;

 protected:
  ~OffsetMass() = default;
};

/// Moments of a 6 x 6 mass about its grid.
struct MassMoments {
  double m = 0;
  Vector3d S = Vector3d::Zero();
  Matrix3d E = Matrix3d::Zero();
};
/// False when M (basic axes, symmetric) is not that of a rigid body: [m 1, -S̃; S̃, tr(E) 1 - E].
bool find_moments(const Eigen::Matrix<double, 6, 6>& M, MassMoments& moments);

/// Stiffness of a dead force f on the end of an arm that rotates: the potential -f·½ θ×(θ×arm) is ½ θᵀK θ,
/// K = (f·arm) 1 - ½ (f armᵀ + arm fᵀ).
Matrix3d calc_arm_stiffness(const Vector3d& f, const Vector3d& arm);

}  // namespace bough::fe
