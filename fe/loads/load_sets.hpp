#pragma once
/// \file The families of load cards, each adding the cards of one set to a load vector. Internal to fe.
#include <unordered_map>

#include "fe/model/model.hpp"

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

  /// Index of a grid with six dofs, or -1 after reporting fe.missing-grid.
  int find_grid(int id, const std::string& card, const records::CardLocation& at) const;
};

/// All return whether the set has such cards.
bool add_point_loads(const LoadTarget& target);    ///< FORCE, FORCE1, FORCE2, MOMENT, MOMENT1, MOMENT2, SLOAD
bool add_body_loads(const LoadTarget& target);     ///< GRAV, RFORCE
bool add_surface_loads(const LoadTarget& target);  ///< PLOAD, PLOAD2, PLOAD4
bool add_beam_loads(const LoadTarget& target);     ///< PLOAD1

/// A plain set among those that a LOAD card adds up.
struct PlainLoadSet {
  int sid = 0;
  double scale = 1;
  records::CardLocation at;    ///< of the LOAD card that names it; empty: the set itself was asked for
  bool enforced_only = false;  ///< its SPCD cards alone: those with the id of a LOAD card, beside it
  bool is_circle = false;      ///< a LOAD card that is on the way to itself
};

/// The plain sets that `set` stands for: itself, or the terms of its LOAD card. A term with cards of its own is that
/// plain set; one that is a LOAD card only stands for the terms of that.
std::vector<PlainLoadSet> list_plain_sets(const records::Deck& deck, int set);

/// Warns of the cards of one plain set that keep their direction although PARAM,FOLLOWK,YES would have them follow
/// (fe.dead-load).
void report_dead_loads(const records::Deck& deck, int set, Diagnostics& diagnostics);

/// fe.unread-load for each kind of card of this set that is not read; returns whether there are such.
bool report_unread_loads(const records::Deck& deck, const std::string& command, int set, Diagnostics& diagnostics);

/// Calls visit(set, scale, card) for each of them that loads.
template <class Visit>
void for_each_plain_set(const records::Deck& deck, int set, const Visit& visit) {
  for (const auto& plain : list_plain_sets(deck, set))
    if (!plain.enforced_only) visit(plain.sid, plain.scale, plain.at);
}

/// The dofs that the SPCD cards of load set `set` move (rows of the l-set), each with its card. Grids that do not exist
/// are left to calc_enforced().
std::vector<std::pair<int, const records::Spcd*>> list_spcd_dofs(const Model& model, const records::Deck& deck,
                                                                 int set);

/// Loads along beams as they act on the element alone: equivalent forces at its ends (12, element axes), by index into
/// Model::elements(). What the beam's own section forces need besides its displacements.
std::unordered_map<int, VectorXd> calc_beam_end_loads(const Model& model, const records::Deck& deck, int set,
                                                      Diagnostics& diagnostics);

}  // namespace bough::fe
