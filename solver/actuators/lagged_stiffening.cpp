#include "solver/actuators/lagged_stiffening.hpp"

namespace bough::solver {

void LaggedStiffening::calc_outputs(const BlockInput& in, double* y) const { terms.calc_loads(*in.motion, y); }

void LaggedStiffening::add_load(const BlockInput& in, const double* y, TreeData& data) const {
  const TreeBody& tb = in.motion->tree[body];
  terms.add_modal_force(y, data.q.segment(tb.eta_offset(), n), data.applied.segment(tb.v_offset + 6, n));
}

}  // namespace bough::solver
