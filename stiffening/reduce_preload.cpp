/// The preload of a body, and temperatures as loads: stress that is there before the body deforms.
#include <cstdio>

#include "fe/elements/stress_state.hpp"
#include "fe/statics/preload.hpp"
#include "stiffening/reduction.hpp"

namespace bough::stiffening {

/// A subcase of modes says by STATSUB what preloads them: without other orders it is the one that the body is of.
int Reduction::choose_subcase() const {
  if (spec_.subcase != 0 || spec_.preload || options_.elements) return spec_.subcase;
  for (const auto& subcase : deck_.subcases)
    if (subcase.preload != 0 && subcase.method != 0) return subcase.id;
  return 0;
}

std::shared_ptr<const fe::Prestress> Reduction::calc_prestress(const fe::ModelOptions& options) {
  if (options_.elements) return nullptr;
  if (!spec_.preload) {
    for (const auto& subcase : deck_.subcases)
      if (subcase.id == options.subcase && subcase.id != 0)
        return fe::calc_subcase_prestress(deck_, options, subcase, diagnostics_);
    return nullptr;
  }
  const auto& spec = *spec_.preload;
  auto own = options;
  if (spec.subcase != 0) {
    own.prestress = fe::calc_subcase_prestress(deck_, options, fe::make_elements, spec.subcase, spec.at, diagnostics_);
    if (spec.spin.isZero(0)) return own.prestress;
  }
  fe::Preload preload{spec.load_set, spec.temperature_set, spec.spin, "", spec.at};
  const auto add = [&](const std::string& what) { preload.name += (preload.name.empty() ? "" : ", ") + what; };
  if (spec.load_set != 0) add("LOAD " + std::to_string(spec.load_set));
  if (spec.temperature_set != 0) add("TEMPERATURE " + std::to_string(spec.temperature_set));
  if (!spec.spin.isZero(0)) {
    char text[96];
    std::snprintf(text, sizeof text, "spin (%g, %g, %g)", spec.spin.x(), spec.spin.y(), spec.spin.z());
    add(text);
  }
  auto prestress = fe::calc_prestress(deck_, own, fe::make_elements, preload, diagnostics_);
  diagnostics_.note("fe.preload", spec.at, "the stiffness holds that of the stress of " + prestress->name,
                    "displacements and forces count from the loaded state");
  return prestress;
}

/// What of the stiffness is the preload's, and what of that a moving frame would add again.
void Reduction::set_preload(const fe::Model& model) {
  const auto* prestress = model.prestress();
  if (!prestress) return;
  const MatrixXd K = Phi_.transpose() * fe::calc_prestress_times(model, Phi_);
  body_.kg_preload = 0.5 * (K + K.transpose());
  body_.preload_A_I = prestress->A_I;
  for (std::size_t i = 0; i < body_.kg_inertial.size(); ++i)
    if (prestress->A_I[static_cast<Eigen::Index>(i)] != 0 && !body_.kg_inertial_computed[i]) {
      diagnostics_.error("reduce.bad-preload", prestress->at,
                         "the preload, " + prestress->name +
                             ", holds a spin or acceleration whose own stiffening is left out of the body",
                         "leave [body.stiffening] inertial at \"all\": the motion that made the preload is not to "
                         "count twice");
      diagnostics_.throw_if_errors();
    }
}

/// K_G of the forces that heated elements have at u = 0; those of u are there already.
void Reduction::add_thermal_stiffness(const fe::Model& model, std::size_t load, MatrixXd& K_G) const {
  const auto& initial = loads_[load].initial;
  MatrixXd K, sum = MatrixXd::Zero(Phi_.cols(), Phi_.cols());
  for (const auto& element : model.elements()) {
    const auto* part = initial.find(*element);
    if (!part || part->force.size() == 0) continue;
    K.setZero(element->num_dofs(), element->num_dofs());
    element->stress_state()->add_geometric_stiffness(part->force, 1, K);
    const MatrixXd Phi_e = Phi_(element->gdofs(), Eigen::all);
    sum += Phi_e.transpose() * K * Phi_e;
  }
  K_G += 0.5 * (sum + sum.transpose());
}

}  // namespace bough::stiffening
