#pragma once
/// \file Points at which elements give stresses and strains, and what is derived from those: von Mises, principal,
/// failure indices.
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "formats/records/deck_continua.hpp"

namespace bough::fe {

enum class StressKind {
  Axial,  ///< xx
  Rod,    ///< xx, and the shear of torsion
  Shear,  ///< xy alone
  Plane,  ///< xx yy xy
  Ply,    ///< 11 22 12, in the axes of the ply
  Bond,   ///< xz yz between two plies, in the axes of the laminate
  Solid,  ///< xx yy zz xy yz zx
  Mid  ///< strains alone: xx yy xy of the reference surface of a shell, and its curvatures κ, so that ε(z) = ε + z κ
};

/// The criterion of a ply (FT of PCOMP).
enum class FailureTheory { None, Hill, Hoffman, TsaiWu, Strain };

struct StressPoint {
  std::string name;  ///< "top", "C_a", "ply3"; empty: the element has this one alone
  StressKind kind = StressKind::Plane;
  FailureTheory theory = FailureTheory::None;
  records::PlyStrength strength;                         ///< with a theory
  Eigen::Matrix3d compliance = Eigen::Matrix3d::Zero();  ///< Strain: ply strains of ply stresses
  double bond = 0;                                       ///< of a Bond: its shear strength; 0: none
};

/// Names of the components of a kind: "xx", "yy", ...
const std::vector<std::string>& list_components(StressKind kind);
/// "stress_xx@top" for every component of every point: the rows of Element::calc_stresses.
std::vector<std::string> list_stress_names(const std::vector<StressPoint>& points);

/// With what is derived: "xx@top", "yy@top", "xy@top", "von_mises@top", ... , and over all axial points of an end or
/// all plies the extremes: "max", "min", "von_mises", "failure".
std::vector<std::string> list_result_names(const std::vector<StressPoint>& points);
/// The values under those names.
Eigen::VectorXd calc_stress_results(const std::vector<StressPoint>& points,
                                    const Eigen::Ref<const Eigen::VectorXd>& stress);

/// Names of derived strains (shears are angles γ): "xx@top", "von_mises@top", "major@top", ..., and over all points of
/// an element "max", "min", "von_mises". Plies derive nothing.
std::vector<std::string> list_strain_result_names(const std::vector<StressPoint>& points);
Eigen::VectorXd calc_strain_results(const std::vector<StressPoint>& points,
                                    const Eigen::Ref<const Eigen::VectorXd>& strain);

/// Both, of the points of one element and the values of many cases.
class PointResults {
 public:
  PointResults(std::vector<StressPoint> points, bool of_strain);
  /// Number of results of an element.
  Eigen::Index size() const { return size_; }
  /// Computes the results of one column of values: `given` as the points have them, `out` of size().
  void calc(const Eigen::Ref<const Eigen::VectorXd>& given, Eigen::Ref<Eigen::VectorXd> out) const;

 private:
  std::vector<StressPoint> points_;
  std::vector<Eigen::Index> num_components_, num_derived_;
  Eigen::Index num_extremes_ = 0, size_ = 0;
  bool of_strain_;
};

/// √(4/9 (εx² - εxεy + εy²) + γ²/3): √(2/3 e:e) of the deviator e with εz = 0, as Nastran prints it.
double calc_plane_von_mises_strain(const Eigen::Vector3d& strain);
/// √(2/9 ((εx - εy)² + (εy - εz)² + (εz - εx)²) + (γxy² + γyz² + γzx²)/3), of xx yy zz xy yz zx.
double calc_solid_von_mises_strain(const Eigen::Matrix<double, 6, 1>& strain);
/// Shears γ become the γ/2 of a tensor, of which stresses and strains have the same principal values.
Eigen::VectorXd halve_shears(StressKind kind, Eigen::VectorXd strain);

/// √(σx² - σxσy + σy² + 3τ²).
double calc_plane_von_mises(const Eigen::Vector3d& stress);
/// Von Mises stress of xx yy zz xy yz zx.
double calc_solid_von_mises(const Eigen::Matrix<double, 6, 1>& stress);

/// Failure index of a ply for stresses 11 22 12: 1 on the limit. Hill: σ1²/X² - σ1σ2/X² + σ2²/Y² + τ²/S²; Hoffman and
/// Tsai-Wu: quadratic with linear terms (MSC Nastran Quick Reference Guide, PCOMP; Jones, "Mechanics of composite
/// materials", 2nd ed., 2.9); Strain: the largest strain over its limit. 0 where a limit that it needs is not given.
double calc_failure_index(const StressPoint& ply, const Eigen::Vector3d& stress);

}  // namespace bough::fe
