#pragma once
/// \file Files of matrices and mode shapes for `reduce --matrices`.
#include <string>
#include <vector>

#include "formats/records/body_spec.hpp"
#include "stiffening/reduce_matrices.hpp"

namespace bough::analysis {

/// --matrices of the command line into the spec: FILE, or KEY=VALUE with a key of [body.matrices], K, M, B, phi, or the
/// name of an inertial load. Throws InputError("cli.bad-matrices").
void add_matrices_option(const std::string& text, records::MatricesSpec& spec);

/// Reads them all; file names that were read are added to `files`.
stiffening::GivenMatrices read_given_matrices(const records::MatricesSpec& spec, const records::Deck& deck,
                                              std::vector<std::string>& files, Diagnostics& diagnostics);
/// A matrix with a column for each mode, or an OP2 or punch file ("FILE:SUBCASE" where it has several).
stiffening::GivenModes read_given_modes(const records::MatrixSource& source, const records::MatricesSpec& spec,
                                        const records::Deck& deck, Diagnostics& diagnostics);

}  // namespace bough::analysis
