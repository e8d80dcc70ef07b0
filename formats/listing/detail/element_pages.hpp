#pragma once
/// \file Tables of element forces and stresses.
#include "formats/listing/detail/pages.hpp"
#include "formats/records/listing.hpp"

namespace bough::listing::detail {

void add_force_pages(const records::ListedStep& step, const records::ListedElements& block, Pages& pages);
void add_stress_pages(const records::ListedStep& step, const records::ListedElements& block, Pages& pages);

}  // namespace bough::listing::detail
