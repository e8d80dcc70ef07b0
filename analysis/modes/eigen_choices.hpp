#pragma once
/// \file Eigenvalue request of `bough modes`: the deck's EIGRL or EIGR, overridden by a choice.
#include <optional>
#include <string>

#include "fe/model/model.hpp"
#include "formats/records/deck.hpp"
#include "modal/eigen.hpp"
#include "modal/normalize.hpp"

namespace bough::analysis {

struct EigenChoice {
  int number = 0;  ///< of modes; 0: that of the deck
  std::optional<double> min_hz, max_hz;
  bool buckling = false;  ///< the range is one of load factors
  bool no_check = false;  ///< without the inertia count
  std::string solver;     ///< of SLEPc; empty: the one that suits the model
};

/// The deck's EIGRL/EIGR of the subcase, overruled by the choice; 10 modes when neither says.
modal::EigenOptions choose_eigen_options(const EigenChoice& choice, const records::Deck& deck, int method,
                                         Diagnostics& diagnostics);

/// A note where the number of the deck's card bounds a range of the command line: as many modes were found.
void note_method_number(const EigenChoice& choice, const records::Deck& deck, int method, int found,
                        Diagnostics& diagnostics);

/// EIGR of the methods that compute every root: ND then asks for the lowest whatever F1 and F2 say.
bool counts_whatever_range(const records::EigenMethod& card);

/// NORM of the deck's card. Throws fe.missing-grid and fe.bad-component where it names no dof.
modal::Norm choose_norm(const records::Deck& deck, int method, const fe::Model& model);

}  // namespace bough::analysis
