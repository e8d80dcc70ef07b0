#pragma once
/// \file Pressure of sunlight on a flat panel, and the shadow of a planet.
///
///     F = -P ν A cos θ [(1 - ρ_s) s + 2 (ρ_s cos θ + ρ_d/3) n],   cos θ = n·s > 0
/// s: direction to the sun; n: normal of the lit side; ρ_s, ρ_d: specular and diffuse reflectivity; ν: visible share of
/// the sun's disc. Source: Wertz, Spacecraft Attitude Determination and Control (1978), 17.2; Montenbruck & Gill,
/// Satellite Orbits (2000), 3.4. Bodies named by the panel shade it too (shading.hpp).
#include "solver/forces/element.hpp"
#include "solver/forces/shading.hpp"

namespace bough::solver {

/// Planet that casts a shadow.
struct Shadow {
  Vector3d centre_W = Vector3d::Zero();
  double radius = 0;    ///< 0: no shadow
  double sun_size = 0;  ///< angular radius of the sun
};

/// Visible share of the sun's disc, of two circles on the sky: 1 lit, 0 umbra, 1 - (share that a smaller planet
/// covers). \param p_W  outside the planet.  \param sun_W  unit.
double calc_sunlight(const Shadow& shadow, const Vector3d& p_W, const Vector3d& sun_W);
/// Angles by which the planet and the sun are apart at first and last contact: zero where penumbra begins and ends.
Eigen::Vector2d calc_contacts(const Shadow& shadow, const Vector3d& p_W, const Vector3d& sun_W);

class SolarPressure final : public ForceElement {
 public:
  struct Panel {
    double pressure = 0, area = 0, specular = 0, diffuse = 0;
    Vector3d normal = Vector3d::UnitZ(), sun_W = Vector3d::UnitX();
    bool is_one_sided = false;
    Shadow shadow;
    Shading shading;  ///< by bodies, on a disc of the area, or on the faces
  };
  /// \param marker  centre of the panel, where the force acts.
  SolarPressure(std::string name, int marker, const Panel& panel)
      : ForceElement(std::move(name)), marker_(marker), panel_(panel) {}

  ForceResult calc(const Tree& tree, const TreeData& data, Loads* loads) const override;
  int num_kinks() const override { return panel_.shadow.radius > 0 ? 3 : 1; }
  void calc_kinks(const Tree& tree, const TreeData& data, double* g) const override;
  std::vector<ForceChannel> channels() const override {
    return {{"force", 3, "pressure of sunlight, in the inertial frame", "F"},
            {"sunlight", 1, "visible share of the sun, mean over the panel", "1"}};
  }

 private:
  int marker_;
  Panel panel_;
};

/// Force on a flat panel of this area with the unit normal n, in full light; in W.
Vector3d calc_panel_force(const SolarPressure::Panel& panel, Vector3d n_W, double area);
/// Throws ComputationError "run.inside-planet" if p is inside the planet.
void demand_outside(const Shadow& shadow, const Vector3d& p_W, const std::string& force, double t);

}  // namespace bough::solver
