#include "solver/builder/lagged_stiffening.hpp"

#include "solver/actuators/lagged_stiffening.hpp"

namespace bough::solver {

std::vector<std::unique_ptr<Block>> make_lagged_stiffening(const records::SystemSpec& spec, const System& system,
                                                           const FlexMap& flex, Diagnostics& diagnostics) {
  std::vector<std::unique_ptr<Block>> all;
  const auto& simulation = spec.simulation;
  std::string others, with_hinges;
  for (const auto& r : spec.bodies) {
    const int b = system.find_body(r.name);
    const auto record = flex.find(r.file);
    if (b < 0 || !system.is_valid(b) || record == flex.end() || !r.stiffening || system.num_modes(b) == 0) continue;
    auto made = std::make_unique<LaggedStiffening>();
    made->body = b;
    made->n = system.num_modes(b);
    made->terms = StiffeningTerms::collect(spec, system.tree, system.loops, system.forces, record->second, b, false);
    if (made->terms.has_hinges()) with_hinges += (with_hinges.empty() ? "" : ", ") + r.name;
    made->set_name(BlockKind::Stiffening, r.name);
    made->label = "lagged stiffening of body '" + r.name + "'";
    made->description =
        "A_I (12), then FCONI, as the step before had them: force and moment at each node with locators, or a "
        "pattern's value and five zeros";
    made->dims = "as A_I and FCONI";
    made->at = simulation.at;
    made->sizes.outputs = made->terms.num_loads();
    made->sizes.sample_time = simulation.stiffening_step > 0 ? simulation.stiffening_step : simulation.step;
    made->sizes.reads_acceleration = true;
    all.push_back(std::move(made));
  }
  for (const auto& r : spec.actuators)
    if (!r.body.empty()) others += (others.empty() ? "" : ", ") + r.name;
  for (const auto& r : spec.force_elements)
    if (r.type != records::ElementType::CentralGravity) others += (others.empty() ? "" : ", ") + r.name;
  for (const auto& force : system.driven) others += (others.empty() ? "" : ", ") + force.name;
  for (const auto& r : spec.constraints) others += (others.empty() ? "" : ", ") + r.name;
  if (!all.empty() && !others.empty())
    diagnostics.warning(
        "system.lagged-loads", simulation.at,
        "lagged stiffening uses the loads of hinges and of forces without a type only, not of: " + others,
        "take stiffening = \"consistent\", which sees them all");
  if (!with_hinges.empty())
    diagnostics.warning("system.lagged-hinges", simulation.at,
                        "what crosses the hinges of " + with_hinges +
                            " is fed back a step late: where it accelerates light modes it may go to and fro and grow",
                        "compare with stiffening = \"consistent\"; keep fewer modes, or damp them");
  return all;
}

}  // namespace bough::solver
