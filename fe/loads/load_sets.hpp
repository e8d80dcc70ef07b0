#pragma once
/// \file The families of load cards, each adding the cards of one set to a load vector. Internal to fe.
#include <unordered_map>

#include "fe/loads/follower_loads.hpp"
#include "fe/loads/loads.hpp"
#include "fe/model/load_selection.hpp"

namespace bough::fe {

/// Where the cards of one load set go: F += scale times them. Those of accelerated frames go into A_I instead.
struct LoadTarget {
  const Model& model;
  const records::Deck& deck;
  int set;
  double scale;
  VectorXd& F;
  Diagnostics& diagnostics;
  Vector12d& A_I;
  std::vector<ArmLoad>& arms;
  std::vector<QuadraticForm>& followers;
  FollowerLoads* moving = nullptr;  ///< gains the loads that follow the grids, if it is there

  /// Index of a grid with six dofs, or -1 after reporting fe.missing-grid.
  int find_grid(int id, const std::string& card, const records::CardLocation& at) const;
};

/// All return whether the set has such cards.
bool add_point_loads(const LoadTarget& target);         ///< FORCE, FORCE1, FORCE2, MOMENT, MOMENT1, MOMENT2, SLOAD
bool add_body_loads(const LoadTarget& target);          ///< GRAV, RFORCE
bool add_surface_loads(const LoadTarget& target);       ///< PLOAD, PLOAD2, PLOAD4
bool add_beam_loads(const LoadTarget& target);          ///< PLOAD1
bool add_superelement_loads(const LoadTarget& target);  ///< SELOAD

/// Adds the loads that sections with elements have in set `set`, which LOAD of the case control selects: it is a set of
/// each section by itself, with the geometric stiffness of their stress. \return whether a section has such a set.
bool add_part_loads(const Model& model, int set, AppliedLoad& load);

/// Superelements on whose mass GRAV, RFORCE and ACCEL of the main bulk data do not act: sections with elements, which
/// have these cards themselves, and external ones unless PARAM,CMSALOAD,YES requests it.
std::vector<const Element*> list_without_gravity(const Model& model, const records::Deck& deck);
/// The force M a of the acceleration field `a` (num_gdofs) on these superelements, num_gdofs.
VectorXd calc_superelement_force(const Model& model, const VectorXd& a,
                                 const std::vector<const Element*>& superelements);
/// Reports fe.superelement-gravity of load set `set`, whose GRAV, RFORCE or ACCEL cards accelerate the model: a warning
/// for superelements that have no such load, an error for grounded ones that PARAM,CMSALOAD,YES accelerates.
void report_gravity(const Model& model, const records::Deck& deck, int set, Diagnostics& diagnostics);

/// Values of recovered items (by index into Model::elements()) of the loads inside superelements that set `set` brings.
std::unordered_map<int, VectorXd> calc_interior_values(const Model& model, const records::Deck& deck, int set);

/// fe.unread-load for each kind of card of this set that is not read; returns whether there are such.
bool report_unread_loads(const records::Deck& deck, const std::string& command, int set, Diagnostics& diagnostics);

/// Loads along beams as they act on the element alone: equivalent forces at its ends (12, element axes), by index into
/// Model::elements(). What the beam's own section forces need besides its displacements.
std::unordered_map<int, VectorXd> calc_beam_end_loads(const Model& model, const records::Deck& deck, int set,
                                                      Diagnostics& diagnostics);

}  // namespace bough::fe
