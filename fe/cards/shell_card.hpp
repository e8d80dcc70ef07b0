#pragma once
/// \file Data of a shell card before it becomes an element: grids, property, material angle, surface normals.
/// Internal.
#include <unordered_map>
#include <utility>
#include <vector>

#include "fe/cards/shell_sections.hpp"

namespace bough::fe {

/// A shell card whose grids and property exist and whose corners make a proper convex facet.
struct ResolvedShell {
  const records::ShellElement* card = nullptr;
  std::string who;                        ///< "CQUAD4 17"
  std::vector<int> nodes;                 ///< indices of the corners
  std::vector<int> midsides;              ///< indices, -1 = absent; as card->midsides
  std::vector<Vector3d> x;                ///< corners in basic
  Vector3d normal = Vector3d::UnitZ();    ///< of the mean plane of the corners
  const ShellSection* section = nullptr;  ///< in material axes, at the mean of the corner thicknesses
  /// Thickness at the corners: T1... with TFLAG applied, the property's where blank; empty = uniform.
  std::vector<double> thickness;
};

/// Thicknesses of the corners: T1... with TFLAG applied, the property's where blank; empty without T1...
std::vector<double> list_thicknesses(const records::ShellElement& card, double of_property);

/// Empty after reporting fe.missing-grid, fe.missing-property, fe.bad-property or fe.bad-facet.
std::optional<ResolvedShell> resolve_shell(Maker& maker, ShellSections& sections, const records::ShellElement& card);

/// Angle (radians) about `normal` from `side` to the material's x-axis: THETA, or the x-axis of MCID at x projected; 0
/// where that is normal to an isotropic shell. Empty after reporting fe.missing-coordinates or fe.bad-material-axes.
std::optional<double> calc_material_angle(Maker& maker, const ResolvedShell& shell, const Vector3d& x,
                                          const Vector3d& normal, const Vector3d& side);
/// Angle of the material axis at the centre of the corners, from side 1-2.
std::optional<double> calc_material_angle(Maker& maker, const ResolvedShell& shell);

/// Unit normals (basic) of the flat shells of sections (BEGIN SUPER) at the grids, ids of the deck, to which SECONCT
/// joins them. In fe/model, which resolves coordinate systems.
std::vector<std::pair<int, Vector3d>> list_neighbor_normals(const records::Deck& deck);

/// Normals of the surface at every node where all shells agree within PARAM,SNORM degrees (default 20): the sum of the
/// unit normals, each turned to the side of the first, with those of shells of other sections (BEGIN SUPER) at shared
/// grids.
std::unordered_map<int, Vector3d> calc_surface_normals(Maker& maker, const std::vector<ResolvedShell>& shells);

}  // namespace bough::fe
