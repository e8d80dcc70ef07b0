#pragma once
/// \file Listings as Nastran prints them (docs/formats/f06.md).
#include <string>

#include "formats/records/listing.hpp"

namespace bough::listing {

/// Pages of at most 50 rows, each with title, subtitle, label, subcase and the headings of its table.
std::string make_f06(const records::Listing& listing);

}  // namespace bough::listing
