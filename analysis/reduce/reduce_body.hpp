#pragma once
/// \file A body specification with the files it names, reduced.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/common/events.hpp"
#include "formats/records/body_spec.hpp"
#include "formats/records/flex_body.hpp"
#include "stiffening/reduce.hpp"
#include "stiffening/reduce_matrices.hpp"

namespace bough::analysis {

/// A body file (.toml), a deck, or matrices alone; every other choice replaces or extends that of the body file.
struct ReduceRequest {
  std::string file, name;
  std::optional<int> num_modes;
  std::optional<double> max_hz;
  bool free = false;  ///< frame of free-free modes
  std::vector<int> interface_nodes;
  std::vector<std::string> loads;  ///< "[NAME=]NODE:DIRECTIONS", "[NAME=]set:ID" or "[NAME=]temperature:ID"
  std::optional<bool> full;
  bool strain_energy = false;
  std::vector<std::string> recover;  ///< kinds of recovery
  std::string mass, integrals;
  std::vector<double> origin;  ///< [3], or empty
  std::vector<std::string> ignore_cards;
  int subcase = 0;
  std::optional<double> damping;      ///< ratio of every mode
  std::vector<std::string> matrices;  ///< FILE or KEY=VALUE (add_matrices_option)
  std::string solver;                 ///< of SLEPc; empty: the one that suits the model
};

struct Reduced {
  records::FlexBody body;
  stiffening::BasisCheck basis;                ///< of its modal matrices
  std::optional<stiffening::ModeCheck> check;  ///< with other modes, where the specification names some
};

/// Reads the deck, or the matrices of another program, and reduces them; `source` of the body is what was read. Its
/// deck is relative to the working directory. Collective; PETSc must be initialized. Throws what reading and
/// stiffening::reduce throw.
Reduced reduce_body(const records::BodySpec& spec, const stiffening::ReduceOptions& options, Diagnostics& diagnostics);

/// Reads the files of a request and reduces the body. `check_spec` is called before the computation and may reject the
/// request. Collective.
/// \throws InputError "cli.no-modes", "cli.bad-load"; exceptions of reading and of stiffening::reduce.
Reduced reduce_body(const ReduceRequest& request, const std::function<void(const records::BodySpec&)>& check_spec,
                    Events& events);

}  // namespace bough::analysis
