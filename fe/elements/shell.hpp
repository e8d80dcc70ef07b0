#pragma once
/// \file Flat three- and four-node shell: membrane, bending, transverse shear, drilling (CTRIA3, CQUAD4).
///
/// Dofs per node: u v w θx θy θz in basic axes. Inside, element axes: x along side 1-2, z normal, the reference surface
/// at offset d_i above node i (ZOFFS and the warp of a quadrilateral, carried by rigid arms). Bending and shear:
/// discrete Kirchhoff-Mindlin, Katili, "A new discrete Kirchhoff-Mindlin element based on Mindlin-Reissner plate theory
/// and assumed shear strain fields", Parts I (DKMT) and II (DKMQ), IJNME 36 (1993) 1859-1908: β = Σ N_i β_i + Σ P_k
/// Δβ_k s_k, with Δβ_k from the constant shear of side k. Membrane: four nodes with the incompatible modes of Taylor,
/// Beresford & Wilson, IJNME 10 (1976) 1211-1219 (QM6), which pass the patch test; three nodes with constant strain.
/// Mass: bilinear (linear) in the translations, with rotary inertia, at the centre of mass of the section; lumped: its
/// row sums, without rotary inertia. Drilling: penalty on θz - ½(v,x - u,y) (Hughes & Brezzi, CMAME 72 (1989) 105-121),
/// weight as PARAM,K6ROT. Quadrature: 2 x 2 Gauss, or three interior points.
#include "bough/fe/elements/element.hpp"
#include "bough/fe/materials/shell_section.hpp"

namespace bough::fe {

struct ShellGeometry {
  std::vector<Vector3d> x;  ///< nodes in basic
  double z_offset = 0;      ///< reference surface above the nodes, along the element normal
  /// Unit normals of the whole surface at the nodes (PARAM,SNORM); empty = the element's own normal everywhere.
  /// Rotation about them does no bending, so that a curved surface does not lean on the drilling stiffness.
  std::vector<Vector3d> normals;
};

class Shell final : public Element {
 public:
  /// section: in element axes (x along side 1-2). Geometry must not be degenerate (no area, an angle of 180 degrees or
  /// more).
  Shell(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, const ShellGeometry& geometry,
        const ShellSection& section);

  ElementShape shape() const override;
  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override;
  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;
  /// Membrane forces Nx Ny Nxy at each quadrature point, in element axes.
  int num_internal_forces() const override { return 3 * num_points(); }
  void calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const override;
  std::vector<std::string> internal_force_names() const override;
  /// ∫ N_ab (u,a·u,b) with the slopes w,a = γ_a - β_a of the element's own bending field (Cook et al., "Concepts and
  /// applications of finite element analysis", 4th ed., eq. 18.4-10).
  void add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                               Eigen::Ref<MatrixXd> K_G) const override;

  double area() const { return area_; }
  const Matrix3d& R_basic_element() const { return R_; }  ///< columns: element axes in basic

 private:
  using Dofs = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 24, 24>;
  struct Point;  // fields at a quadrature point
  int num_nodes() const { return static_cast<int>(xy_.size()); }
  int num_points() const { return num_nodes() == 4 ? 4 : 3; }
  Point calc_point(int q) const;
  /// Element-axes dofs on the reference surface from basic dofs at the nodes: rotation and rigid arms.
  void calc_map(Dofs& map) const;
  /// ½(v,x - u,y) at the centre on the element-axes dofs.
  Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, 24> calc_spin() const;
  Dofs calc_local_stiffness(Eigen::Matrix<double, 4, 24>* modes) const;
  void add_mapped(const Dofs& local, double scale, Eigen::Ref<MatrixXd> out) const;

  std::vector<Eigen::Vector2d> xy_;
  std::vector<double> arm_;
  std::vector<Vector3d> normal_;  // at the nodes, in element axes
  Matrix3d R_;
  double z_offset_ = 0, area_ = 0;
  ShellSection section_;
};

}  // namespace bough::fe
