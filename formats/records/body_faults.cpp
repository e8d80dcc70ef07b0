#include "formats/records/body_faults.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace bough::records {

namespace {

using Faults = std::vector<std::string>;

/// Numbers may have passed through text of five digits.
constexpr double kAsymmetry = 1e-4;

/// Against the size that the diagonal allows, at least that of the matrix over its order.
void check_symmetric(Faults& faults, const std::string& path, const MatrixXd& m) {
  if (m.rows() != m.cols() || m.rows() == 0) return;
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const double size = std::max({std::sqrt(std::abs(m(i, i) * m(j, j))), std::abs(m(i, j)), std::abs(m(j, i))});
      if (!(std::abs(m(i, j) - m(j, i)) > kAsymmetry * size)) continue;
      // Roundoff of nothing: a term that is zero but for the digits of the largest.
      if (std::abs(m(i, j) - m(j, i)) <= 1e-12 * m.cwiseAbs().maxCoeff()) continue;
      std::ostringstream what;
      what << path << " is not symmetric: (" << i + 1 << ", " << j + 1 << ") is " << m(i, j) << ", (" << j + 1 << ", "
           << i + 1 << ") is " << m(j, i);
      faults.push_back(what.str());
      return;
    }
}

void check_rigid(Faults& faults, const FlexBody& body) {
  std::ostringstream what;
  if (body.mass < 0) {
    what << "/rigid/mass is " << body.mass;
  } else if (body.mass == 0 && !body.integrals_method.empty() && body.integrals().gamma0.size() > 0 &&
             body.integrals().gamma0.cwiseAbs().maxCoeff() > 0) {
    what << "/rigid/mass is zero, and its modes move mass: gamma0 is not";
  }
  if (std::string text = what.str(); !text.empty()) faults.push_back(std::move(text));
  check_symmetric(faults, "/rigid/inertia", body.inertia);
  const Eigen::Vector3d principal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(body.inertia, Eigen::EigenvaluesOnly).eigenvalues();
  if (principal[0] < -kAsymmetry * std::abs(principal[2])) {
    std::ostringstream found;
    found << "/rigid/inertia has the principal moment " << principal[0];
    faults.push_back(found.str());
  }
  const Eigen::Matrix3d about_cg =
      body.inertia - body.mass * (body.cg.squaredNorm() * Eigen::Matrix3d::Identity() - body.cg * body.cg.transpose());
  const double min_moment =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(about_cg, Eigen::EigenvaluesOnly).eigenvalues()[0];
  if (min_moment < -kAsymmetry * std::abs(principal[2]) && principal[0] >= 0) {
    std::ostringstream found;
    found << "/rigid/inertia, about the origin of the frame, is too small for /rigid/mass at /rigid/cg: about the "
             "centre of mass it has the principal moment "
          << min_moment;
    faults.push_back(found.str());
  }
}

}  // namespace

Faults find_unknown_names(const FlexBody& body) {
  Faults faults;
  const std::set<int> nodes(body.node_id.begin(), body.node_id.end());
  const auto unknown = std::find_if(body.interface_nodes.begin(), body.interface_nodes.end(),
                                    [&](int id) { return nodes.count(id) == 0; });
  if (unknown != body.interface_nodes.end())
    faults.push_back("/nodes/interface names node " + std::to_string(*unknown) + ", which /nodes/id does not have");
  for (const auto& locator : body.locators) {
    if (locator.node == 0 || (nodes.count(locator.node) > 0 && locator.direction >= 1 && locator.direction <= 6))
      continue;
    faults.push_back("locator '" + locator.name + "' is at node " + std::to_string(locator.node) + ", direction " +
                     std::to_string(locator.direction) + ", expected an output node and 1 to 6");
  }
  const auto& method = body.integrals_method;
  if (method != "lumped" && method != "consistent" && method != "exact")
    faults.push_back("/integrals has the method '" + method + "', expected lumped, consistent or exact");
  if (!body.third_order.empty() && !is_valid_choice(body.third_order.large, body.num_modes()))
    faults.push_back("/third_order/large holds " + std::to_string(body.third_order.num_large()) + " of " +
                     std::to_string(body.num_modes()) + " modes, expected 1 to " + std::to_string(kMaxLargeModes) +
                     " mode numbers, ascending, of at most " + std::to_string(kMaxThirdOrderModes) + " modes");
  const auto& directions = body.third_order.directions;
  if (directions.size() > 0 &&
      (directions.rows() != body.third_order.num_large() || directions.cols() != body.num_modes()))
    faults.push_back("/third_order/directions is " + std::to_string(directions.rows()) + " x " +
                     std::to_string(directions.cols()) + ", expected " + std::to_string(body.third_order.num_large()) +
                     " x " + std::to_string(body.num_modes()));
  if (!are_modes(body.next_order.modes, body.num_modes()) || body.next_order.modes.size() > kMaxLargeModes)
    faults.push_back("/next_order/modes is expected to hold at most " + std::to_string(kMaxLargeModes) +
                     " mode numbers up to " + std::to_string(body.num_modes()) + ", ascending");
  const auto num_grids = static_cast<long>(body.mesh.grid_id.size());
  for (std::size_t i = 0; i < body.mesh.blocks.size(); ++i) {
    const auto& indices = body.mesh.blocks[i].connectivity;
    if (indices.size() > 0 && (indices.minCoeff() < 0 || indices.maxCoeff() >= num_grids))
      faults.push_back("/mesh, block " + std::to_string(i + 1) + ": connectivity points past the " +
                       std::to_string(num_grids) + " grids");
  }
  return faults;
}

Faults find_body_faults(const FlexBody& body) {
  Faults faults;
  if (body.num_modes() > 0 && body.integrals().empty())
    faults.push_back("/integrals/" + body.integrals_method + " is missing, the set that the solver uses");
  std::set<int> seen;
  for (const int id : body.node_id) {
    if (seen.insert(id).second) continue;
    faults.push_back("/nodes/id lists node " + std::to_string(id) + " twice");
    break;
  }
  check_rigid(faults, body);
  check_symmetric(faults, "/modal/mass", body.modal_mass);
  check_symmetric(faults, "/modal/stiffness", body.modal_stiffness);
  for (const auto& kg : body.kg_inertial) check_symmetric(faults, "/stiffening/kg_inertial", kg);
  for (const auto& kg : body.kg_external) check_symmetric(faults, "/stiffening/kg_external", kg);
  for (Eigen::Index j = 0; j < body.modal_mass.rows(); ++j) {
    if (!(body.modal_mass(j, j) < 0)) continue;
    std::ostringstream what;
    what << "/modal/mass of mode " << j + 1 << " is " << body.modal_mass(j, j);
    faults.push_back(what.str());
    break;
  }
  return faults;
}

}  // namespace bough::records
