#pragma once
/// \file Files of a listing: text in Nastran's order (F06) and OUTPUT2.
#include <string>
#include <vector>

#include "formats/listing/complex_f06.hpp"
#include "formats/records/listing.hpp"

namespace bough::analysis {

/// Paths of the files; empty: none.
struct ListingFiles {
  std::string f06, op2;
  /// Returns true if neither a listing nor an OUTPUT2 file is requested.
  bool empty() const { return f06.empty() && op2.empty(); }
};

/// Writes the requested files. Call it on one rank. Throws ComputationError "cli.write".
void write_listings(const ListingFiles& files, const records::Listing& listing);
/// Writes the F06 of complex modes if one is requested. Call it on one rank. Throws ComputationError "cli.write".
void write_complex_listing(const ListingFiles& files, const std::vector<listing::ListedComplexModes>& modes);

}  // namespace bough::analysis
