#pragma once
/// \file Contact of a sphere (radius zero: a point) at A with a plane or a sphere at B.
///
/// Depth δ > 0, approach speed δ̇, sliding velocity v_t at the point of contact:
///     normal    N = k δ^e (1 + c δ̇), not below zero            Hunt & Crossley, J. Appl. Mech. 42 (1975) 440
///     friction  -μ N v_t / √(v_t² + v_s²)                       Coulomb's, smooth over the speed v_s
/// Hertz: e = 3/2, k = 4/3 E* √R. Both bodies get it at one point, on the surface of B.
#include "solver/forces/element.hpp"

namespace bough::solver {

class ContactElement final : public ForceElement {
 public:
  struct Law {
    double stiffness = 0, exponent = 1.5, damping = 0, friction = 0, slip_velocity = 0;
    double radius = 0, to_radius = 0;
    bool is_plane = true;
    Vector3d normal = Vector3d::UnitZ();  ///< unit, in the frame of B's marker
  };
  /// \param from  marker A, centre of the sphere. \param to  marker B, on the plane or at the centre of the other
  /// sphere.
  ContactElement(std::string name, int from, int to, Law law)
      : ForceElement(std::move(name)), from_(from), to_(to), law_(std::move(law)) {}

  ForceResult calc(const Tree& tree, const TreeData& data, Loads* loads) const override;
  int num_kinks() const override { return 1; }
  void calc_kinks(const Tree& tree, const TreeData& data, double* g) const override {
    g[0] = calc(tree, data, nullptr).values[0];
  }
  std::vector<ForceChannel> channels() const override;

 private:
  /// [elastic, normal, friction x, y, z] at [separation, rate, slip x, y, z]; the separation is that of a point and the
  /// surface, or of two centres.
  template <class T>
  std::array<T, 5> calc_forces(const std::array<T, 5>& at) const;

  int from_, to_;
  Law law_;
};

}  // namespace bough::solver
