#include <cmath>

#include "solver/hinges/cylindrical.hpp"
#include "solver/hinges/fixed.hpp"
#include "solver/hinges/free.hpp"
#include "solver/hinges/general.hpp"
#include "solver/hinges/planar.hpp"
#include "solver/hinges/prismatic.hpp"
#include "solver/hinges/revolute.hpp"
#include "solver/hinges/screw.hpp"
#include "solver/hinges/universal.hpp"

namespace bough::solver {

namespace {
bool check_axis(const Vector3d& axis, const char* key, const records::HingeRecord& record, Diagnostics& diagnostics) {
  if (axis.allFinite() && axis.norm() > 0) return true;
  diagnostics.error("system.zero-axis", record.at,
                    "hinge '" + record.name + "' has no direction in " + key + ": expected a vector of nonzero length");
  return false;
}

std::unique_ptr<const Hinge> make_general(const records::HingeRecord& record, Diagnostics& diagnostics) {
  const std::string &r = record.rotations, &t = record.translations;
  const auto is_axes = [](const std::string& s) {
    return s.size() <= 3 && s.find_first_not_of("xyz") == std::string::npos;
  };
  bool good = (r == "q" || is_axes(r)) && is_axes(t) && !(r + t).empty();
  for (size_t i = 1; i < r.size(); ++i) good = good && r[i] != r[i - 1];
  for (size_t i = 1; i < t.size(); ++i) good = good && t.find(t[i]) == i;
  if (good && r == "q") return std::make_unique<OrientedHinge>(t);
  if (good) return std::make_unique<GeneralHinge>(r, t);
  diagnostics.error(
      "system.bad-axes", record.at,
      "hinge '" + record.name + "': rotations '" + r + "' and translations '" + t + "' are not axes of a hinge",
      "rotations: x y z in any order, no two alike in a row, as \"zxz\", or \"q\" for a quaternion; "
      "translations: each of x y z at most once; a hinge without either is fixed");
  return nullptr;
}
}  // namespace

std::unique_ptr<const Hinge> make_hinge(const records::HingeRecord& record, Diagnostics& diagnostics) {
  using records::HingeType;
  const bool needs_axis = record.type != HingeType::Fixed && record.type != HingeType::Spherical &&
                          record.type != HingeType::Free && record.type != HingeType::General;
  if (needs_axis && !check_axis(record.axis, "axis", record, diagnostics)) return nullptr;
  const Vector3d axis = needs_axis ? record.axis.normalized() : Vector3d::UnitZ();
  switch (record.type) {
    case HingeType::Fixed:
      return std::make_unique<FixedHinge>();
    case HingeType::Revolute:
      return std::make_unique<RevoluteHinge>(axis);
    case HingeType::Prismatic:
      return std::make_unique<PrismaticHinge>(axis);
    case HingeType::Cylindrical:
      return std::make_unique<CylindricalHinge>(axis);
    case HingeType::Planar:
      return std::make_unique<PlanarHinge>(axis);
    case HingeType::Spherical:
      return std::make_unique<SphericalHinge>();
    case HingeType::Free:
      return std::make_unique<FreeHinge>();
    case HingeType::General:
      return make_general(record, diagnostics);
    case HingeType::Screw:
      if (std::isfinite(record.pitch)) return std::make_unique<ScrewHinge>(axis, record.pitch);
      diagnostics.error("system.bad-axes", record.at, "hinge '" + record.name + "': the pitch is no finite number");
      return nullptr;
    case HingeType::Universal: {
      if (!check_axis(record.axis2, "axis2", record, diagnostics)) return nullptr;
      const Vector3d axis2 = record.axis2.normalized();
      if (axis.cross(axis2).norm() < 1e-6) {
        diagnostics.error("system.parallel-axes", record.at,
                          "hinge '" + record.name + "': axis and axis2 of a universal hinge are parallel",
                          "give two different directions, or use a revolute hinge");
        return nullptr;
      }
      return std::make_unique<UniversalHinge>(axis, axis2);
    }
  }
  BOUGH_DEMAND(false);
  return nullptr;
}

}  // namespace bough::solver
