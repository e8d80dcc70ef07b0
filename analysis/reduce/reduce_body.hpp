#pragma once
/// \file A body specification with the files it names, reduced.
#include <optional>

#include "formats/records/body_spec.hpp"
#include "formats/records/flex_body.hpp"
#include "stiffening/reduce.hpp"
#include "stiffening/reduce_matrices.hpp"

namespace bough::analysis {

struct Reduced {
  records::FlexBody body;
  stiffening::BasisCheck basis;                ///< of its modal matrices
  std::optional<stiffening::ModeCheck> check;  ///< with other modes, where the specification names some
};

/// Reads the deck, or the matrices of another program, and reduces them; `source` of the body is what was read. Its
/// deck is relative to the working directory. Collective; PETSc must be initialized. Throws what reading and
/// stiffening::reduce throw.
Reduced reduce_body(const records::BodySpec& spec, const stiffening::ReduceOptions& options, Diagnostics& diagnostics);

}  // namespace bough::analysis
