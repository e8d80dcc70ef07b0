#pragma once
/// \file Eigenvalue request of `bough modes`: the deck's EIGRL or EIGR, overridden by the command line.
#include <optional>
#include <string>

#include "cli/common/model_options.hpp"
#include "cli/common/options.hpp"
#include "cli/listing/listing.hpp"
#include "modal/eigen.hpp"
#include "modal/normalize.hpp"

namespace bough::cli {

struct ModesOptions : CommonOptions {
  std::string deck;
  DeckModelOptions model;
  int number = 0;
  std::optional<double> min_hz, max_hz;
  bool buckling = false;
  bool no_check = false;
  std::string solver;
  std::string vtu, compare;
  bool energies = false;
  int about_grid = 0;
  ListingOptions listing;
};

/// The deck's EIGRL/EIGR of the subcase, overruled by the command line; 10 modes when neither says.
modal::EigenOptions choose_eigen_options(const ModesOptions& options, const records::Deck& deck, int method,
                                         Diagnostics& diagnostics);

/// A note where the number of the deck's card bounds a range of the command line: as many modes were found.
void note_method_number(const ModesOptions& options, const records::Deck& deck, int method, int found,
                        Diagnostics& diagnostics);

/// EIGR of the methods that compute every root: ND then asks for the lowest whatever F1 and F2 say.
bool counts_whatever_range(const records::EigenMethod& card);

/// "boom.h5" is "boom-subcase-2.h5" for a subcase after the first.
std::string name_output(const std::string& path, int subcase, bool is_first);

/// NORM of the deck's card. Throws fe.missing-grid and fe.bad-component where it names no dof.
modal::Norm choose_norm(const records::Deck& deck, int method, const fe::Model& model);

}  // namespace bough::cli
