#pragma once
/// \file One interface for whatever acts between bodies or along hinge coordinates.
///
/// An element looks at positions and rates and gives wrenches at markers (or forces along hinge coordinates), the
/// energy that it stores, the power that it gives back from it and the power that it turns into heat:
///     power of all its wrenches = stored - dissipated + what is left, which is work done on the system
#include <array>
#include <string>
#include <vector>

#include "solver/functions/function.hpp"
#include "solver/tree/data.hpp"

namespace bough::solver {

struct ForceResult {
  double strain = 0, potential = 0;  ///< stored: as a spring does, in a field of gravity
  double power = 0;                  ///< -d/dt (strain + potential)
  double dissipated = 0;             ///< power lost
  std::array<double, 12> values{};   ///< what channels() describe, one after the other
};

/// One result that an element records.
struct ForceChannel {
  std::string name;
  int size = 1;
  std::string description, dims;
};

/// Position and velocity of a marker, in W.
struct MarkerInWorld {
  Vector3d p, v, w;
  Matrix3d R;
  Place place;  ///< of p
};
/// Motion of a marker, its node deformed, after calc_velocity. R_WM; v and w in W.
MarkerInWorld calc_marker_in_world(const TreeData& data, const Tree& tree, int marker);

/// State outside of the validity of an element.
struct ValidityWarning {
  const char* id = nullptr;  ///< nullptr: within it
  std::string message, advice;
};

/// Where an element puts its loads.
class Loads {
 public:
  Loads(const Tree& tree, TreeData& data) : tree_(tree), data_(data) {}
  /// A force and a moment at a marker, in W.
  void add_wrench(int marker, const Vector3d& f_W, const Vector3d& t_W);
  /// A force at Bo and a moment about it, in B.
  void add_to_body(int body, const Vector3d& f_B, const Vector3d& t_B);
  /// Adds a generalized force on a mode of a body.
  void add_to_mode(int body, int mode, double force) { data_.applied[tree_[body].v_offset + 6 + mode] += force; }
  /// Adds a force or moment along a hinge coordinate, by its row of u.
  void add_to_hinge(int row, double force) { data_.hinge_force[row] += force; }

 private:
  const Tree& tree_;
  TreeData& data_;
};

class ForceElement {
 public:
  /// \param name  of the table in the system file, for results and messages.
  explicit ForceElement(std::string name) : name_(std::move(name)) {}
  virtual ~ForceElement() = default;
  /// Name of the table in the system file.
  const std::string& name() const { return name_; }

  /// After calc_velocity. With `loads` it also acts. No allocation.
  virtual ForceResult calc(const Tree& tree, const TreeData& data, Loads* loads) const = 0;
  /// Functions of the state at whose zeros the force has a kink (a contact closes, a cable goes taut), so that no
  /// step need go over it.
  virtual int num_kinks() const { return 0; }
  virtual void calc_kinks(const Tree&, const TreeData&, double* /*g*/) const {}
  /// Returns true if the element acts along hinge coordinates, not at markers and bodies.
  virtual bool is_along_hinge() const { return false; }
  /// The function of time in it, or nullptr.
  virtual const TimeFunction* function() const { return nullptr; }
  /// Returns a warning without time if the state is outside of the element's validity; without an id within it.
  virtual ValidityWarning check_validity(const Tree&, const TreeData&) const { return {}; }
  /// Further channels of the results; none by default.
  virtual std::vector<ForceChannel> channels() const { return {}; }
  /// Adds -∂force/∂q and -∂force/∂u of the coordinates that it acts along, where they are not negative (num_u).
  virtual void add_tangent(const Tree&, const TreeData&, Eigen::Ref<VectorXd> /*stiffness*/,
                           Eigen::Ref<VectorXd> /*damping*/) const {}

 private:
  std::string name_;
};

}  // namespace bough::solver
