#pragma once
/// \file Internal forces of an element and the geometric stiffness that is linear in them.
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::fe {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class GeometricProjection;

/// Forces that static solutions print of an element.
class PrintedForces {
 public:
  /// Names of the printed forces: "force" or those of the internal forces.
  virtual std::vector<std::string> printed_force_names() const = 0;
  /// Forces of nodal displacements u (N), linear in u, in the order of the names.
  virtual VectorXd calc_printed_forces(const Eigen::Ref<const VectorXd>& u) const = 0;

 protected:
  ~PrintedForces() = default;
};

/// Stress resultants of an element, s > 0 of them, and its K_G; the first of the resultants are printed.
class StressState : public PrintedForces {
 public:
  /// Number s of internal forces.
  virtual int num_internal_forces() const = 0;
  /// Names of the internal forces, s of them, with the point of an element that has several.
  virtual std::vector<std::string> internal_force_names() const = 0;
  /// force (s) = internal forces of nodal displacements u (N), linear in u.
  virtual void calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const = 0;
  /// forces (s x m) of every column of U (N x m). Overridden where the map from u to forces is expensive.
  virtual void calc_internal_forces_of(const Eigen::Ref<const MatrixXd>& U, Eigen::Ref<MatrixXd> forces) const;
  /// K_G += scale K_G(force), N x N, symmetric and linear in force.
  virtual void add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                                       Eigen::Ref<MatrixXd> K_G) const = 0;
  /// sums += Φᵀ K_G(forces of u_c) Φ for every column u_c of U (N x m); Phi: N x n. The default calls the two functions
  /// above, load after load or, if the internal forces are fewer, one unit force after the other.
  virtual void add_projected_geometric_stiffness(const Eigen::Ref<const MatrixXd>& U,
                                                 const Eigen::Ref<const MatrixXd>& Phi,
                                                 GeometricProjection& sums) const;

  /// Number of leading internal forces that are printed.
  virtual int num_printed_forces() const { return num_internal_forces(); }
  std::vector<std::string> printed_force_names() const final;
  VectorXd calc_printed_forces(const Eigen::Ref<const VectorXd>& u) const final;

 protected:
  ~StressState() = default;
};

}  // namespace bough::fe
