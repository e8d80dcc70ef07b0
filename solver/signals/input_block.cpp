#include "solver/signals/input_block.hpp"

#include <algorithm>

namespace bough::solver {

InputBlock::InputBlock(const records::InputRecord& record)
    : start_(record.start), is_linear_(record.hold == records::InputHold::Linear) {
  set_name(BlockKind::Input, record.name);
  label = "input '" + record.name + "'";
  description = "set from outside";
  dims = record.dims.empty() ? "by the host" : record.dims;
  at = record.at;
  sizes.has_feedthrough = false;
  sizes.memory = kNumRows;
}

void InputBlock::start(double*, double* d) const { d[kValue] = d[kNext] = start_; }

double InputBlock::calc_value(double t, const double* d) {
  // A value that is held has no line, also at times before it was set.
  if (t >= d[kUntil] || d[kUntil] <= d[kFrom]) return d[kNext];
  const double share = (std::max(t, d[kFrom]) - d[kFrom]) / (d[kUntil] - d[kFrom]);
  return d[kValue] + share * (d[kNext] - d[kValue]);
}

}  // namespace bough::solver
