#include <algorithm>

#include "fe/elements/stress_state.hpp"
#include "fe/loads/second_order.hpp"
#include "fe/loads/temperatures.hpp"
#include "fe/loads/wide_links.hpp"

namespace bough::fe {
namespace {

VectorXd gather_rows(const VectorXd& x, const std::vector<int>& rows) {
  VectorXd result(static_cast<int>(rows.size()));
  for (int i = 0; i < result.size(); ++i) result[i] = x[rows[i]];
  return result;
}

}  // namespace

linear::SymmetricMatrix assemble_geometric_stiffness(const Model& model, DofSet set, const AppliedLoad& load,
                                                     const VectorXd& u_g, const InitialForces* initial) {
  BOUGH_DEMAND(u_g.size() == model.num_gdofs());
  const auto add = [&u_g, initial](const Element& e, Eigen::Ref<MatrixXd> K_G) {
    const StressState* state = e.stress_state();
    if (!state) return;
    VectorXd force = VectorXd::Zero(state->num_internal_forces());
    state->calc_internal_forces(gather_rows(u_g, e.gdofs()), force);
    if (const auto* heated = initial ? initial->find(e) : nullptr) force += heated->force;
    state->add_geometric_stiffness(force, 1, K_G);
  };
  auto forms = calc_second_order(model, make_loads(load), u_g);
  // With the reference's own dofs.
  if (set == DofSet::Global)
    std::erase_if(forms, [](const QuadraticForm& form) { return form.gdofs.size() > kMaxLinkDofs + 6; });
  return assemble(model, set, MatrixKind::Other, add, std::move(forms));
}

}  // namespace bough::fe
