#include "formats/hdf5/detail/body_sense.hpp"

#include <cmath>
#include <set>
#include <sstream>

namespace bough::hdf5 {

namespace {

using Eigen::MatrixXd;

/// Numbers may have passed through text of five digits.
constexpr double kAsymmetry = 1e-4;
constexpr const char* kAdvice = "correct the file, or write it again";

/// Against the size that the diagonal allows, at least that of the matrix over its order.
void check_symmetric(FileReader& file, const std::string& path, const MatrixXd& m) {
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
      return file.error("hdf5.value", what.str(), kAdvice);
    }
}

void check_rigid(FileReader& file, const records::FlexBody& body) {
  std::ostringstream what;
  if (body.mass < 0) {
    what << "/rigid/mass is " << body.mass;
  } else if (body.mass == 0 && !body.integrals_method.empty() && body.integrals().gamma0.size() > 0 &&
             body.integrals().gamma0.cwiseAbs().maxCoeff() > 0) {
    what << "/rigid/mass is zero, and its modes move mass: gamma0 is not";
  }
  if (const std::string text = what.str(); !text.empty()) file.error("hdf5.value", text, kAdvice);
  check_symmetric(file, "/rigid/inertia", body.inertia);
  const Eigen::Vector3d principal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(body.inertia, Eigen::EigenvaluesOnly).eigenvalues();
  if (principal[0] < -kAsymmetry * std::abs(principal[2])) {
    std::ostringstream found;
    found << "/rigid/inertia has the principal moment " << principal[0];
    file.error("hdf5.value", found.str(), kAdvice);
  }
  const Eigen::Matrix3d about_cg =
      body.inertia - body.mass * (body.cg.squaredNorm() * Eigen::Matrix3d::Identity() - body.cg * body.cg.transpose());
  const double least =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(about_cg, Eigen::EigenvaluesOnly).eigenvalues()[0];
  if (least < -kAsymmetry * std::abs(principal[2]) && principal[0] >= 0) {
    std::ostringstream found;
    found << "/rigid/inertia, about the origin of the frame, is too small for /rigid/mass at /rigid/cg: about the "
             "centre of mass it has the principal moment "
          << least;
    file.error("hdf5.value", found.str(), kAdvice);
  }
}

}  // namespace

void check_sense(FileReader& file, const records::FlexBody& body) {
  std::set<int> seen;
  for (const int id : body.node_id) {
    if (seen.insert(id).second) continue;
    file.error("hdf5.value", "/nodes/id lists node " + std::to_string(id) + " twice", kAdvice);
    break;
  }
  check_rigid(file, body);
  check_symmetric(file, "/modal/mass", body.modal_mass);
  check_symmetric(file, "/modal/stiffness", body.modal_stiffness);
  for (const auto& kg : body.kg_inertial) check_symmetric(file, "/stiffening/kg_inertial", kg);
  for (const auto& kg : body.kg_external) check_symmetric(file, "/stiffening/kg_external", kg);
  for (Eigen::Index j = 0; j < body.modal_mass.rows(); ++j) {
    if (!(body.modal_mass(j, j) < 0)) continue;
    std::ostringstream what;
    what << "/modal/mass of mode " << j + 1 << " is " << body.modal_mass(j, j);
    file.error("hdf5.value", what.str(), kAdvice);
    break;
  }
}

}  // namespace bough::hdf5
