#pragma once
/// \file CFAST and CWELD: springs or a beam between two points of shells, whose six motions follow the grids of the
/// shells. Source: Nastran Quick Reference Guide, CFAST, PFAST, CWELD and PWELD.
#include <array>

#include "fe/elements/element.hpp"
#include "fe/elements/stress_state.hpp"

namespace bough::fe {

/// Second order of an end that follows four points p (12 translations) by the rotation R of best fit: place x̄ + R arm,
/// rotation vector θ + θ₂, θ₂_c = ½ pᵀ forms[c] p. Basic.
struct PatchRotation {
  Vector3d arm = Vector3d::Zero();     ///< of the end, from the centre x̄ of the points
  Eigen::Matrix<double, 3, 4> points;  ///< from their centre
  std::array<Eigen::Matrix<double, 12, 12>, 3> forms;
};

/// An end of a connector on shells.
struct ConnectorEnd {
  Vector3d x = Vector3d::Zero();  ///< place, basic
  MatrixXd shares;                ///< 4 x nodes: of the grids in the points
  PatchRotation rotation;
};

/// Ends A and B, and their motion by the grids: q = G u, q = [u_A θ_A u_B θ_B] in basic, 12 x N.
struct ConnectorData {
  MatrixXd G;
  std::vector<ConnectorEnd> ends;  ///< none: the ends are the two grids
  /// Weights of the grids in the translation of the ends, 2 x nodes; each row adds up to 1.
  MatrixXd weights;
  double mass = 0;          ///< [M] half of it at each end
  std::vector<int> shells;  ///< ids of the shells that the ends are on, ascending; none of ends given by grids
};

/// K = Gᵀ K_c G with the springs or the beam K_c (12 x 12) of the core. G reproduces rigid-body motion, so that K_c
/// with none for such a motion has none here. Internal forces are those of the core for q = G u. K_G: that of the core,
/// and the forces on the ends times the second order of their motion. Mass: that of the ends by the weights, in all
/// directions alike.
class Connector final : public Element, public StressState {
 public:
  /// \param core  two nodes, 12 DOFs in the order of q, with a stress state.
  Connector(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, ConnectorData data,
            std::unique_ptr<const Element> core);

  /// Ends and their motion by the grids.
  const ConnectorData& data() const { return data_; }
  /// Springs or beam between the ends: two nodes, 12 DOFs.
  const Element& core() const { return *core_; }
  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override;
  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;
  /// Ids of the shells that the ends are on, ascending; empty if the card names grids.
  const std::vector<int>& shells() const { return data_.shells; }
  const StressState* stress_state() const override { return this; }
  int num_internal_forces() const override { return core_->stress_state()->num_internal_forces(); }
  std::vector<std::string> internal_force_names() const override {
    return core_->stress_state()->internal_force_names();
  }
  int num_printed_forces() const override { return core_->stress_state()->num_printed_forces(); }
  void calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const override;
  void add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                               Eigen::Ref<MatrixXd> K_G) const override;

 private:
  ConnectorData data_;
  std::unique_ptr<const Element> core_;
  MatrixXd end_forces_;  ///< 12 x s: forces K_c q on the ends by the internal forces
};

}  // namespace bough::fe
