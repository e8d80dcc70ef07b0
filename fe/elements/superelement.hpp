#pragma once
/// \file External superelement: the matrices of a component on its exterior points, and the rows of its interior.
/// Sources: Craig & Bampton, AIAA J. 6 (1968) 1313; Nastran Quick Reference Guide, EXTSEOUT, SEBULK, SECONCT.
#include <map>

#include "fe/elements/carried.hpp"
#include "fe/elements/damping.hpp"
#include "fe/elements/element.hpp"
#include "fe/elements/stress_state.hpp"

namespace bough::fe {

/// K, M, B and K4 (structural damping) given on N dofs in basic axes; empty: zero. The interior has followed these dofs
/// already: K has the rigid-body motions of the component to the round-off of its condensation. Its internal forces are
/// the forces on its exterior dofs.
class Superelement final : public Element, public OffsetMass, public Damping, public StressState {
 public:
  struct Matrices {
    MatrixXd K, M, B, K4;
    /// Forces of its exterior dofs: rows of K u, and K_G of a unit of each; empty: K_G is not known.
    MatrixXd force;
    std::vector<MatrixXd> K_G;
    /// K_G of the stress of each load with the exterior dofs held, by column of P; empty: not known.
    std::vector<MatrixXd> K_G_of_loads;
    MatrixXd P;                       ///< loads, a column each
    std::map<int, int> load_columns;  ///< of P, by load of the component
    bool is_part = false;             ///< loads of the component are sets of LOAD of the case control
  };

  Superelement(int id, std::vector<int> nodes, std::vector<int> gdofs, Matrices matrices)
      : Element(id, "SEBULK", std::move(nodes), std::move(gdofs)), m_(std::move(matrices)) {
    if (m_.K4.size() > 0) set_structural_damping(1);  // responses look for it; the values are those of K4
  }

  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override { add(scale, m_.K, K); }
  /// Consistent and lumped alike.
  void add_mass(MassKind, double scale, Eigen::Ref<MatrixXd> M) const override { add(scale, m_.M, M); }
  void add_structural_damping(double g, Eigen::Ref<MatrixXd> K) const override;
  const OffsetMass* offset_mass(MassKind) const override { return m_.M.size() > 0 ? this : nullptr; }
  /// False: its mass is known by its momenta alone.
  bool add_carried(MassKind, const Eigen::Ref<const Matrix3Xd>&, CarriedMass&) const override { return false; }
  const Damping* damping() const override { return m_.B.size() > 0 ? this : nullptr; }
  void add_damping(double scale, Eigen::Ref<MatrixXd> B) const override { add(scale, m_.B, B); }
  const StressState* stress_state() const override { return m_.K_G.empty() ? nullptr : this; }
  /// The forces on its exterior dofs are not printed.
  const PrintedForces* printed_forces() const override { return nullptr; }
  int num_internal_forces() const override { return static_cast<int>(m_.K_G.size()); }
  std::vector<std::string> internal_force_names() const override;
  void calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const override {
    force = m_.force * u;
  }
  void add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                               Eigen::Ref<MatrixXd> K_G) const override {
    for (std::size_t i = 0; i < m_.K_G.size(); ++i) K_G += scale * force[static_cast<Eigen::Index>(i)] * m_.K_G[i];
  }
  int num_printed_forces() const override { return 0; }
  /// Forces of a load of the component on the N dofs, in basic; empty: it has no such load.
  VectorXd get_load(int load) const {
    const auto column = m_.load_columns.find(load);
    return column == m_.load_columns.end() ? VectorXd() : VectorXd(m_.P.col(column->second));
  }

  /// Geometric stiffness (N x N, basic) of the stress of a load with the exterior dofs held; empty: not known, or no
  /// such load.
  MatrixXd get_load_stiffness(int load) const {
    const auto column = m_.load_columns.find(load);
    return column == m_.load_columns.end() || m_.K_G_of_loads.empty()
               ? MatrixXd()
               : m_.K_G_of_loads[static_cast<std::size_t>(column->second)];
  }

  /// Returns true if LOAD of the case control selects its loads; else SELOAD does.
  bool is_part() const { return m_.is_part; }
  /// Returns true if get_load() of this load is not empty.
  bool has_load(int load) const { return m_.load_columns.contains(load); }

 private:
  static void add(double scale, const MatrixXd& of, Eigen::Ref<MatrixXd> sum) {
    if (of.size() > 0) sum += scale * of;
  }

  Matrices m_;
};

/// Values of the loads of a superelement with its exterior points held.
struct InteriorValues {
  int superelement = 0;
  bool is_part = false;             ///< as Superelement::is_part()
  std::map<int, int> load_columns;  ///< of values, by load
  MatrixXd values;                  ///< components x loads
};

/// Recovered values of the interior of a superelement: rows times the motion of its exterior points.
class RecoveredItem final : public Element, public PrintedForces {
 public:
  /// card: "MUG1_101"; rows: in basic axes of the exterior points, components.size() x N.
  RecoveredItem(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs,
                std::vector<std::string> components, MatrixXd rows, InteriorValues of_loads = {})
      : Element(id, std::move(card), std::move(nodes), std::move(gdofs)),
        components_(std::move(components)),
        rows_(std::move(rows)),
        of_loads_(std::move(of_loads)) {}

  const PrintedForces* printed_forces() const override { return this; }
  std::vector<std::string> printed_force_names() const override { return components_; }
  VectorXd calc_printed_forces(const Eigen::Ref<const VectorXd>& u) const override { return rows_ * u; }
  /// Loads of the superelement with the exterior points held: their part of the printed values.
  const InteriorValues& of_loads() const { return of_loads_; }

 private:
  std::vector<std::string> components_;
  MatrixXd rows_;
  InteriorValues of_loads_;
};

}  // namespace bough::fe
