#pragma once
/// \file Numbers like random ones that are always the same: start vectors and weights free of any layout over ranks.

namespace bough::linear {

/// A number in (-1, 1) that depends on index and start only.
double calc_fixed_number(int index, int start);

}  // namespace bough::linear
