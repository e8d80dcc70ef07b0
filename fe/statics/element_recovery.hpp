#pragma once
/// \file Element recovery for many displacements at once: forces, stresses, strains, strain energies.
#include "fe/statics/static_case.hpp"

namespace bough::fe {

/// Large displacements (nonlinear.hpp), by element.
struct DeformedElements {
  std::vector<VectorXd> displacements;
  std::vector<VectorXd> internal_forces;  ///< empty without a stress state
  std::vector<VectorXd> forces;           ///< on the grids, in basic; empty without stiffness
};

/// Displacements with the loads and temperatures of their case. The pointers outlive the call.
struct RecoveryCase {
  const VectorXd* u_g = nullptr;           ///< num_gdofs
  int load = 0;                            ///< LOAD: loads along beams; 0: none
  const InitialForces* initial = nullptr;  ///< of heated elements
  Diagnostics* diagnostics = nullptr;      ///< of the loads along beams; may be null
  /// Elements by themselves, instead of u_g.
  const DeformedElements* deformed = nullptr;
};

struct RecoveredFields {
  bool forces = true, stresses = true, strains = false;
};

/// Results of one case, in the blocks of calc_element_forces, calc_element_stresses and calc_element_strains.
struct ElementResults {
  std::vector<records::ElementForces> forces;
  std::vector<records::ElementStresses> stresses, strains;
};

/// Elements of one card with the same results.
struct RecoveryGroup {
  std::string card;  ///< with the number of the group: ElementGroup::name
  std::vector<std::string> names;
  std::vector<int> elements, id, property;  ///< elements: indices into Model::elements()
};

/// Requested results of the elements, group by group.
struct RecoveryLayout {
  RecoveryLayout(const Model& model, const records::Deck& deck, const RecoveredFields& fields);

  /// Group and row of an element; none if `group` is negative.
  struct Place {
    int group = -1;
    Eigen::Index row = 0;
  };
  struct Table {
    bool is_asked = false;
    std::vector<RecoveryGroup> groups;
    std::vector<Place> places;  ///< of all elements
    /// Returns true if results of this element, an index into Model::elements(), are requested and exist.
    bool holds(int element) const { return is_asked && places[static_cast<std::size_t>(element)].group >= 0; }
  };
  Table forces, stresses, strains;
};

/// Results of every case. `energy`, if given: elements x cases, ½ uᵀ K u of this rank's elements
/// (calc_stiffness_times), which spares forming K again. The matrices of an element are formed once for all of them:
/// O(elements), and for a product and the derived values O(elements x cases). Memory: the results and the numbers of a
/// few elements. Replicated.
std::vector<ElementResults> recover_elements(const Model& model, const records::Deck& deck,
                                             const std::vector<RecoveryCase>& cases, const RecoveredFields& fields);
/// Results in a given layout.
std::vector<ElementResults> recover_elements(const Model& model, const records::Deck& deck,
                                             const std::vector<RecoveryCase>& cases, const RecoveryLayout& layout,
                                             const MatrixXd* energy = nullptr);

}  // namespace bough::fe
