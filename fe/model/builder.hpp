#pragma once
/// \file Builds a Model from a deck: systems, nodes, constraints, elements, AUTOSPC, in this order.
#include "fe/model/constraints.hpp"
#include "fe/model/model.hpp"

namespace bough::fe {

class ModelBuilder {
 public:
  /// All arguments must outlive this.
  ModelBuilder(const records::Deck& deck, const ModelOptions& options, Diagnostics& diagnostics)
      : deck_(deck), options_(options), diagnostics_(diagnostics) {}

  /// Throws InputError with every error found.
  Model build(const ElementFactory& factory);

 private:
  void add_nodes();
  void add_scalar_points();
  void set_params();
  /// SPC, rigid elements and MPC; the equations before their chains are resolved.
  std::vector<ConstraintEquation> collect_constraints();
  void make_elements(const ElementFactory& factory);
  /// Masks of permanent and set SPC over the l-set.
  void collect_fixed();
  /// Returns true for a set that sections (BEGIN SUPER) have and the main bulk data do not.
  template <class Card>
  bool is_set_of_section(int sid, std::vector<Card> records::Deck::*cards,
                         std::vector<records::SetUnion> records::Deck::*unions) const;
  void hold_spcd();  ///< fixes the components of SPCD cards; reports fe.spcd-not-fixed if no SPC fixes them
  void fix(const records::Spc& spc);
  /// RBE1, RBE2, RBE3, RROD, RBAR, MPC.
  void collect_equations();
  void add_mpc(const records::Mpc& mpc);
  void check_dependent_not_fixed();
  /// T from the equations and the fixed dofs; again after AUTOSPC has fixed more.
  Elimination set_transform();
  /// The stress of the options by element; after all elements are there (prestress.cpp).
  void set_prestress();
  void apply_autospc(const Elimination& first);
  /// PLOTEL (plot_elements.cpp).
  void add_drawn_lines();

  const records::Deck& deck_;
  const ModelOptions& options_;
  Diagnostics& diagnostics_;
  Model model_;
  std::vector<ConstraintEquation> equations_;
  std::vector<Link> links_;
  std::vector<char> is_fixed_;
  std::vector<std::pair<int, SourceLocation>> fixed_by_;  ///< (l-dof, card) in the order of the cards
};

}  // namespace bough::fe
