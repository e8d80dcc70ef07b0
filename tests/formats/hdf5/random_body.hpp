#pragma once
/// \file Records filled with random numbers, and their exact comparison.
#include "formats/records/flex_body.hpp"
#include "formats/records/modes.hpp"

namespace bough::test {

/// A body with n modes and p nodes; every optional part is there when `full`.
records::FlexBody make_random_body(unsigned seed, int n, int p, bool full);
records::ModesResult make_random_modes(unsigned seed, int n, int p);

/// Bit for bit.
bool are_identical(const records::FlexBody& a, const records::FlexBody& b);
bool are_identical(const records::ModesResult& a, const records::ModesResult& b);

}  // namespace bough::test
