#include "formats/toml/detail/inertia.hpp"

#include <sstream>

namespace bough::toml_files {

namespace {

/// No body has a principal moment above the sum of the two others. A little above is a warning of the command that runs
/// it; this far above the numbers are in the wrong places. One about a single axis, the others zero, is a planar model.
void check_inertia(const Eigen::Matrix3d& inertia, const Fields& table, Diagnostics& diagnostics) {
  if (!inertia.allFinite()) return;
  const Eigen::Vector3d principal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  const double others = principal[0] + principal[1];
  if (principal[0] < 0 || others <= 1e-12 * principal[2] || principal[2] <= 2 * others) return;
  std::ostringstream what;
  what << "no body has the inertia with the principal values " << principal[0] << ", " << principal[1] << ", "
       << principal[2] << ": the largest is more than twice the sum of the others";
  diagnostics.error("toml.bad-value", table.locate("inertia"), what.str(),
                    "give it about the centre of mass, as [Ixx, Iyy, Izz, Ixy, Ixz, Iyz] or three rows");
}

}  // namespace

Eigen::Matrix3d read_inertia(const Fields& table, Diagnostics& diagnostics) {
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  const Value* v = table.find("inertia");
  if (!v || !v->is_array()) return inertia;
  const std::vector<double> c = table.get_numbers("inertia");
  if (c.size() == 6 && v->items.size() == 6) {
    inertia << c[0], c[3], c[4], c[3], c[1], c[5], c[4], c[5], c[2];
  } else if (c.size() == 3 && v->items.size() == 3) {
    inertia.diagonal() << c[0], c[1], c[2];
  } else if (c.empty() && v->items.size() == 3) {
    for (int i = 0; i < 3; ++i) {
      const auto& row = v->items[static_cast<std::size_t>(i)].items;
      for (int j = 0; j < 3 && row.size() == 3; ++j) inertia(i, j) = row[static_cast<std::size_t>(j)].number;
    }
    if (!inertia.isApprox(inertia.transpose(), 1e-10)) {
      diagnostics.error("toml.bad-value", table.locate("inertia"), "inertia is not symmetric",
                        "give three rows of a symmetric tensor, or six components");
    }
  } else {
    diagnostics.error("toml.wrong-length", table.locate("inertia"),
                      "inertia is neither three moments nor six components nor three rows of three",
                      "give [Ixx, Iyy, Izz], [Ixx, Iyy, Izz, Ixy, Ixz, Iyz] or [[..], [..], [..]]");
  }
  check_inertia(inertia, table, diagnostics);
  return inertia;
}

}  // namespace bough::toml_files
