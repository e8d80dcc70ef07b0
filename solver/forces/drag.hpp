#pragma once
/// \file Drag: F = -½ ρ C_d A |v| v on a point that moves at v through the air; of a plate with normal n, A is what the
/// air sees of it, A |n·v|/|v|. About a planet ρ falls with the altitude h, ρ exp(-(h - h0)/H), and the air turns with
/// it.
#include <cmath>

#include "solver/forces/element.hpp"

namespace bough::solver {

class DragElement final : public ForceElement {
 public:
  struct Law {
    double half_density_area = 0;        ///< ½ ρ C_d A
    Vector3d normal = Vector3d::Zero();  ///< unit, in the frame of the body; zero: none
    Vector3d wind_W = Vector3d::Zero();
    // About a planet; scale_height 0: none.
    double scale_height = 0, radius = 0, altitude = 0;  ///< H; radius of the planet; h0
    Vector3d centre_W = Vector3d::Zero(), spin_W = Vector3d::Zero();
  };
  /// \param marker  point that the air acts on.
  DragElement(std::string name, int marker, Law law) : ForceElement(std::move(name)), marker_(marker), law_(law) {}

  ForceResult calc(const Tree& tree, const TreeData& data, Loads* loads) const override {
    const MarkerInWorld k = calc_marker_in_world(data, tree, marker_);
    Vector3d v = k.v - law_.wind_W;
    double share = 1;
    if (law_.scale_height > 0) {
      const Vector3d R = k.p - law_.centre_W;
      v -= law_.spin_W.cross(R);
      share = std::exp(-(R.norm() - law_.radius - law_.altitude) / law_.scale_height);
    }
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
  std::string describe_outside(const Tree& tree, const TreeData& data) const override {
    if (law_.scale_height == 0) return {};
    const double height = (calc_marker_in_world(data, tree, marker_).p - law_.centre_W).norm() - law_.radius;
    if (height >= 0) return {};
    return "force '" + name() + "' is below the ground of its planet, where its density has no meaning";
  }

 private:
  int marker_;
  Law law_;
};

}  // namespace bough::solver
