#pragma once
/// \file `check` of a body file by what `reduce` does with it.
#include <string>

#include "base/diagnostic.hpp"
#include "formats/records/body_spec.hpp"

namespace bough::analysis {

/// Reduces the body and throws the result away: reports all that `reduce` would refuse. Not of a model with more than
/// 6000 free dofs, or of matrices of more than 20 MB, which would take long: the note "cli.not-reduced" says so.
/// Collective; throws nothing of what it finds.
void try_reduction(const std::string& file, records::BodySpec spec, int num_free_dofs, Diagnostics& diagnostics);

}  // namespace bough::analysis
