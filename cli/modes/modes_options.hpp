#pragma once
/// \file Options of `bough modes`.
#include <string>

#include "analysis/modes/eigen_choices.hpp"
#include "cli/common/model_options.hpp"
#include "cli/common/options.hpp"

namespace bough::cli {

struct ModesOptions : CommonOptions {
  std::string deck;
  analysis::ModelChoice model;
  analysis::EigenChoice eigen;
  std::string vtu, compare;
  bool energies = false;
  int about_grid = 0;
  ListingOptions listing;
};

/// "boom.h5" is "boom-subcase-2.h5" for a subcase after the first.
std::string name_output(const std::string& path, int subcase, bool is_first);

}  // namespace bough::cli
