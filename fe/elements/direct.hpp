#pragma once
/// \file DMIG selected by K2GG, M2GG, B2GG: stiffness, mass or damping given term by term.
/// Sources: Nastran Quick Reference Guide, DMIG, K2GG, M2GG, B2GG; OptiStruct Reference Guide, PARAM,CK2 and CM2.
#include "fe/elements/carried.hpp"
#include "fe/elements/damping.hpp"
#include "fe/elements/element.hpp"

namespace bough::fe {

enum class DirectKind { Stiffness, Mass, Damping };

/// Coupling of two points, or of one point with itself, by a direct matrix: one element for each pair, so that the
/// global matrices stay as sparse as the DMIG. A one-point element has a symmetric block on its own dofs (N = n_a); of
/// two points the block is K_ab (n_a x n_b, basic axes), with its transpose below the diagonal (N = n_a + n_b). A
/// single element need be neither semidefinite nor free of rigid-body modes; only the whole matrix is.
class DirectElement final : public Element, public OffsetMass, public Damping {
 public:
  DirectElement(DirectKind kind, std::vector<int> nodes, std::vector<int> gdofs, MatrixXd block)
      : Element(0, "DMIG", std::move(nodes), std::move(gdofs)), kind_(kind), block_(std::move(block)) {}

  /// Returns the matrix that the block is part of: stiffness, mass or damping.
  DirectKind kind() const { return kind_; }
  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override;
  /// Consistent and lumped alike.
  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;
  /// Unless it is one mass between translations.
  const OffsetMass* offset_mass(MassKind) const override {
    return kind_ == DirectKind::Mass && !is_plain() ? this : nullptr;
  }
  /// Adds the body if the block is the mass of a rigid body at one grid.
  bool add_carried(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const override;
  const Damping* damping() const override { return kind_ == DirectKind::Damping ? this : nullptr; }
  void add_damping(double scale, Eigen::Ref<MatrixXd> B) const override;

 private:
  bool is_plain() const;
  void add_block(double scale, Eigen::Ref<MatrixXd> A) const;

  DirectKind kind_;
  MatrixXd block_;
};

}  // namespace bough::fe
