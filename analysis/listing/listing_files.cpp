#include "analysis/listing/listing_files.hpp"

#include "analysis/common/text_file.hpp"
#include "formats/listing/f06.hpp"
#include "formats/listing/op2.hpp"

namespace bough::analysis {

void write_listings(const ListingFiles& files, const records::Listing& listing) {
  const auto op2 = files.op2.empty() ? std::string() : listing::make_op2(listing);
  if (!files.f06.empty()) write_text_file(files.f06, listing::make_f06(listing));
  if (!files.op2.empty()) write_text_file(files.op2, op2);
}

void write_complex_listing(const ListingFiles& files, const std::vector<listing::ListedComplexModes>& modes) {
  if (!files.f06.empty()) write_text_file(files.f06, listing::make_complex_f06(modes));
}

}  // namespace bough::analysis
