#pragma once
/// \file CFAST and CWELD: springs or a beam between two points of shells, whose six motions follow the grids of the
/// shells. Source: Nastran Quick Reference Guide, CFAST, PFAST, CWELD and PWELD.
#include "fe/elements/element.hpp"
#include "fe/elements/stress_state.hpp"

namespace bough::fe {

/// Ends A and B, and their motion by the grids: q = G u, q = [u_A θ_A u_B θ_B] in basic, 12 x N.
struct ConnectorData {
  MatrixXd G;
  /// Weights of the grids in the translation of the ends, 2 x nodes; each row adds up to 1.
  MatrixXd weights;
  double mass = 0;          ///< [M] half of it at each end
  std::vector<int> shells;  ///< ids of the shells that the ends are on, ascending; none of ends given by grids
};

/// K = Gᵀ K_c G with the springs or the beam K_c (12 x 12) of the core. G reproduces rigid-body motion, so that K_c
/// with none for such a motion has none here. Internal forces and K_G are those of the core for q = G u. Mass: that of
/// the ends by the weights, in all directions alike.
class Connector final : public Element, public StressState {
 public:
  /// \param core  two nodes, 12 DOFs in the order of q, with a stress state.
  Connector(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, ConnectorData data,
            std::unique_ptr<const Element> core);

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
};

}  // namespace bough::fe
