#pragma once
/// \file What elements tell of many displacements at once: forces, stresses, strains, strain energies.
#include "fe/statics/static_case.hpp"

namespace bough::fe {

/// Displacements and what acts beside them. The pointers outlive the call.
struct RecoveryCase {
  const VectorXd* u_g = nullptr;           ///< num_gdofs
  int load = 0;                            ///< LOAD: loads along beams; 0: none
  const InitialForces* initial = nullptr;  ///< of heated elements
  Diagnostics* said = nullptr;             ///< of the loads along beams; may be null
};

struct RecoveredFields {
  bool forces = true, stresses = true, strains = false;
};

/// As calc_element_forces, calc_element_stresses and calc_element_strains give them.
struct ElementResults {
  std::vector<records::ElementForces> forces;
  std::vector<records::ElementStresses> stresses, strains;
};

/// Results of every case. The matrices of an element are formed once for all of them: O(elements) beside a product and
/// what is derived, O(elements x cases). Memory: the results and the numbers of a few elements. Replicated.
std::vector<ElementResults> recover_elements(const Model& model, const records::Deck& deck,
                                             const std::vector<RecoveryCase>& cases, const RecoveredFields& fields);

}  // namespace bough::fe
