#include "fe/loads/follower_loads.hpp"

#include "base/rotation.hpp"
#include "fe/shape/face_load.hpp"

namespace bough::fe {

namespace {

using Eigen::Index;

Vector3d get_present_place(const NodeTable& nodes, int node, const VectorXd& u) {
  return nodes.node(node).x + u.segment<3>(nodes.node(node).first_gdof);
}

/// A face in its deformed position, as input of calc_face_load.
struct PresentFace {
  std::vector<Vector3d> corners, midside;

  PresentFace(const NodeTable& nodes, const FollowerPressure& load, const VectorXd& u) {
    std::size_t next = 0;
    for (; next < load.p.size(); ++next) corners.push_back(get_present_place(nodes, load.nodes[next], u));
    for (const char is_there : load.has_midside)
      midside.push_back(is_there ? get_present_place(nodes, load.nodes[next++], u) : Vector3d(Vector3d::Zero()));
  }
};

Vector3d calc_present_edge(const NodeTable& nodes, const FollowerForce& load, std::size_t first, const VectorXd& u) {
  return get_present_place(nodes, load.nodes[first + 1], u) - get_present_place(nodes, load.nodes[first], u);
}

Vector3d calc_present_direction(const NodeTable& nodes, const FollowerForce& load, const VectorXd& u) {
  const Vector3d a = calc_present_edge(nodes, load, 0, u);
  return load.is_cross ? a.cross(calc_present_edge(nodes, load, 2, u)) : a;
}

int get_loaded_dof(const NodeTable& nodes, const FollowerForce& load) {
  return nodes.node(load.node).first_gdof + (load.is_moment ? 3 : 0);
}

void append_translation_dofs(const NodeTable& nodes, int node, std::vector<int>& gdofs) {
  for (int a = 0; a < 3; ++a) gdofs.push_back(nodes.node(node).first_gdof + a);
}

}  // namespace

void add_follower_forces(const NodeTable& nodes, const FollowerLoads& loads, double scale, const VectorXd& u,
                         VectorXd& F) {
  for (const auto& load : loads.pressures) {
    const PresentFace face(nodes, load, u);
    const Eigen::Matrix3Xd f =
        calc_face_load(face.corners, face.midside, load.has_midside, load.p,
                       [](double p, const Vector3d&, const Vector3d& normal) { return Vector3d(p * normal); });
    for (std::size_t i = 0; i < load.nodes.size(); ++i)
      F.segment<3>(nodes.node(load.nodes[i]).first_gdof) += scale * f.col(static_cast<Index>(i));
  }
  for (const auto& load : loads.forces)
    F.segment<3>(get_loaded_dof(nodes, load)) +=
        scale * load.size * calc_present_direction(nodes, load, u).normalized();
}

void visit_follower_stiffness(const NodeTable& nodes, const FollowerLoads& loads, const VectorXd& u,
                              const std::function<void(const std::vector<int>& gdofs, const MatrixXd& K)>& visit) {
  std::vector<int> gdofs;
  for (const auto& load : loads.pressures) {
    const PresentFace face(nodes, load, u);
    gdofs.clear();
    for (const int node : load.nodes) append_translation_dofs(nodes, node, gdofs);
    visit(gdofs, calc_follower_stiffness(face.corners, face.midside, load.has_midside, load.p));
  }
  for (const auto& load : loads.forces) {
    const Vector3d direction = calc_present_direction(nodes, load, u), n = direction.normalized();
    const Matrix3d turned = -load.size / direction.norm() * (Matrix3d::Identity() - n * n.transpose());
    gdofs.clear();
    for (int a = 0; a < 3; ++a) gdofs.push_back(get_loaded_dof(nodes, load) + a);
    const std::size_t count = load.is_cross ? 4 : 2;
    MatrixXd K = MatrixXd::Zero(3 + 3 * static_cast<Index>(count), 3 + 3 * static_cast<Index>(count));
    for (std::size_t i = 0; i < count; ++i) {
      append_translation_dofs(nodes, load.nodes[i], gdofs);
      Matrix3d of_edge = Matrix3d::Identity();  // δ(a × b) = -b̃ δa + ã δb
      if (load.is_cross)
        of_edge =
            i < 2 ? Matrix3d(-skew(calc_present_edge(nodes, load, 2, u))) : skew(calc_present_edge(nodes, load, 0, u));
      K.block<3, 3>(0, 3 + 3 * static_cast<Index>(i)) = (i % 2 == 0 ? -1 : 1) * turned * of_edge;
    }
    visit(gdofs, K);
  }
}

}  // namespace bough::fe
