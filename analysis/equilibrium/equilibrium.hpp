#pragma once
/// \file A state of rest, or of steady spin, of a multibody system.
#include <string>
#include <utility>
#include <vector>

#include "analysis/linearize/linearize.hpp"
#include "formats/records/results.hpp"
#include "solver/linear/equilibrium.hpp"

namespace bough::analysis {

struct EquilibriumRequest {
  std::string file;              ///< system file
  std::vector<std::string> set;  ///< "name=value" of [parameters]
};

struct EquilibriumAnswer {
  solver::Equilibrium found;
  Eigen::VectorXd q;                                            ///< as in files
  std::vector<std::pair<std::string, Eigen::VectorXd>> hinges;  ///< those with coordinates, part of q
  // Results of one sample, for plot, export and --start-from.
  records::ResultsHeader header;
  Eigen::VectorXd sample;
  records::Checkpoint checkpoint;
};

/// Warning: equilibrium.unstable. Throws what loading and solver::find_equilibrium throw.
EquilibriumAnswer find_equilibrium(const EquilibriumRequest& request, const CheckFiles& check, Events& events);

}  // namespace bough::analysis
