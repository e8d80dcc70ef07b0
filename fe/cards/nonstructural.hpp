#pragma once
/// \file Mass that NSM, NSM1, NSML or NSML1 adds to an element. Source: Nastran Quick Reference Guide, NSM, NSML.
#include "fe/elements/carried.hpp"

namespace bough::fe {

/// M = factor times the host's own mass matrix, so that it is spread, and lumped or coupled, as the host's, without
/// rotary inertia on a shell; a host without mass has `mass` in equal parts at its grids. The host outlives this
/// element: both belong to one model.
class NonstructuralMass final : public Element, public OffsetMass {
 public:
  NonstructuralMass(const Element& host, double factor, double mass)
      : Element(host.id(), "NSM", host.nodes(), host.gdofs()), host_(host), factor_(factor), mass_(mass) {}

  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;
  const OffsetMass* offset_mass(MassKind kind) const override;
  bool add_carried(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const override;

 private:
  const Element& host_;
  double factor_, mass_;
};

/// Mass per translation of an element (deck units, before WTMASS).
double calc_element_mass(const Element& element);

/// The added masses of set `nsm` of the case control (0: none), for elements already made. Reports fe.missing-set.
ElementList make_nonstructural(const records::Deck& deck, int nsm,
                               const std::vector<std::unique_ptr<const Element>>& elements, const NodeTable& nodes,
                               Diagnostics& diagnostics);

}  // namespace bough::fe
