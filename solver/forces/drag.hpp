#pragma once
/// \file Drag: F = -½ ρ C_d A |v| v on a point that moves at v through the air; of a plate with normal n, A is what the
/// air sees of it, A |n·v|/|v|. About a planet ρ falls with the altitude h, ρ exp(-(h - h0)/H) or by a table, and the
/// air turns with it.
#include <cmath>
#include <sstream>

#include "solver/forces/density_table.hpp"
#include "solver/forces/element.hpp"

namespace bough::solver {

class DragElement final : public ForceElement {
 public:
  struct Law {
    double half_density_area = 0;        ///< ½ ρ C_d A
    Vector3d normal = Vector3d::Zero();  ///< unit, in the frame of the body; zero: none
    Vector3d wind_W = Vector3d::Zero();
    bool has_planet = false;
    double scale_height = 0, radius = 0, altitude = 0;  ///< H; radius of the planet; h0
    DensityTable table;                                 ///< empty: exponential; else half_density_area is ½ C_d A
    Vector3d centre_W = Vector3d::Zero(), spin_W = Vector3d::Zero();

    /// Density over that of half_density_area at p; v becomes the velocity through the air.
    double calc_air(const Vector3d& p_W, Vector3d& v) const {
      v -= wind_W;
      if (!has_planet) return 1;
      const Vector3d R = p_W - centre_W;
      const double height = R.norm() - radius;
      v -= spin_W.cross(R);
      return table.empty() ? std::exp(-(height - altitude) / scale_height) : table.calc(height);
    }
    /// Warning if p is below the ground or outside the table.
    ValidityWarning check_height(const std::string& name, const Vector3d& p_W) const {
      if (!has_planet) return {};
      const double height = (p_W - centre_W).norm() - radius;
      const auto& [min_altitude, max_altitude] = table.range();
      if (!table.empty() && !(height >= min_altitude && height <= max_altitude)) {
        std::ostringstream message;
        message << "force '" << name << "' is at an altitude of " << height << ", and its density_table is from "
                << min_altitude << " to " << max_altitude << ": the density goes on exponentially";
        return {"run.outside-atmosphere", message.str(), "extend the table, or end the run there by an event"};
      }
      if (height >= 0 || !table.empty()) return {};
      return {"run.below-ground",
              "force '" + name + "' is below the ground of its planet, where its density has no meaning",
              "end the run at the ground by an event, or check the radius of the planet and the start"};
    }
  };
  /// \param marker  point that the air acts on.
  DragElement(std::string name, int marker, Law law) : ForceElement(std::move(name)), marker_(marker), law_(law) {}

  ForceResult calc(const Tree& tree, const TreeData& data, Loads* loads) const override {
    const MarkerInWorld k = calc_marker_in_world(data, tree, marker_);
    Vector3d v = k.v;
    const double share = law_.calc_air(k.p, v);
    const bool is_plate = !law_.normal.isZero(0);
    const auto drag =
        evaluate_law<3, 4>(data.tangents, {this, "force", name()}, 0,
                           {is_plate ? (k.R * law_.normal).dot(v) : 0, v.x(), v.y(), v.z()}, [&](const auto& at) {
                             using std::abs, std::sqrt;
                             const auto square = at[1] * at[1] + at[2] * at[2] + at[3] * at[3];
                             const auto by = -law_.half_density_area * (is_plate ? abs(at[0]) : sqrt(square));
                             return std::array{by * at[1], by * at[2], by * at[3]};
                           });
    const Vector3d f = share * Vector3d(drag[0], drag[1], drag[2]);
    if (loads != nullptr) loads->add_wrench(marker_, f, Vector3d::Zero());
    ForceResult result;
    for (int i = 0; i < 3; ++i) result.values[static_cast<size_t>(i)] = f[i];
    return result;
  }
  std::vector<ForceChannel> channels() const override { return {{"force", 3, "drag, in the inertial frame", "F"}}; }
  ValidityWarning check_validity(const Tree& tree, const TreeData& data) const override {
    return law_.check_height(name(), calc_marker_in_world(data, tree, marker_).p);
  }

 private:
  int marker_;
  Law law_;
};

}  // namespace bough::solver
