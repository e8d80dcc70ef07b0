#pragma once
/// \file Symmetric sparse matrices as text for other programs.
#include <ostream>
#include <string>

#include "bough/formats/records/static_result.hpp"

namespace bough::exports {

/// Matrix Market, coordinate real symmetric: the lower triangle (Boisvert, Pozo & Remington, NISTIR 5935). `comment`:
/// one line behind '%'.
void write_matrix_market(std::ostream& out, const records::SparseMatrix& matrix, const std::string& comment);

/// Nastran OUTPUT4, formatted, one matrix (form 6, type 2): each column from its first to its last entry. Name of up to
/// eight letters. A file holds any number of matrices one after the other.
void write_output4(std::ostream& out, const records::SparseMatrix& matrix, const std::string& name);

}  // namespace bough::exports
