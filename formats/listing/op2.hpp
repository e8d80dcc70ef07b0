#pragma once
/// \file OUTPUT2 files as PARAM,POST,-1 writes them (docs/formats/op2.md).
#include <string>

#include "formats/records/listing.hpp"

namespace bough::listing {

/// Throws InputError("export.large-id") for ids that 10 id + 1 has no 32 bits for.
/// Random responses in OUGPSD2, OUGCRM2, OUGATO2, OUGRMS1, OUGNO1 and those of OVG, OAG, OQG.
/// OGPWG, LAMA, OUGV1, OPG1, OQG1, OQMG1, OEF1, OES1: little endian, words of 4 bytes, reals of single precision.
std::string make_op2(const records::Listing& listing);

}  // namespace bough::listing
