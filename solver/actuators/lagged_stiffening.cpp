#include "solver/actuators/lagged_stiffening.hpp"

#include <algorithm>
#include <array>

#include "solver/system/node_load.hpp"

namespace bough::solver {
namespace {

/// What loads a node, and K_G2 of its six components (empty: no locator). Of a load pattern the first is its value.
struct StiffeningSource {
  NodeSource source;
  std::array<MatrixXd, 6> K2 = {};
};

/// A_I, then force and moment of each source, in B.
class LaggedStiffening final : public Block {
 public:
  int body = 0, n = 0;
  std::array<MatrixXd, records::kNumInertialLoads> K1;  ///< empty: not computed
  std::vector<StiffeningSource> sources;

  bool is_actuator() const override { return true; }

  void calc_outputs(const BlockInput& in, double* y) const override {
    const BodyState& s = in.data->tree[body].state;
    const Vector3d a = s.a_B - s.R_WB.transpose() * in.system->impl().gravity;
    const Vector3d& w = s.w_B;
    Eigen::Map<Eigen::Matrix<double, 12, 1>>(y) << a, s.alpha_B, w.cwiseAbs2(), w.x() * w.y(), w.x() * w.z(),
        w.y() * w.z();
    for (size_t i = 0; i < sources.size(); ++i) {
      Eigen::Map<Vector6d> load(y + 12 + 6 * i);
      const AppliedForce* f = sources[i].source.force;
      if (f != nullptr && f->pattern.size() > 0) {
        load << (f->function ? in.data->tree.functions[*f->function].calc(in.data->tree.t).f : 1.0), 0, 0, 0, 0, 0;
      } else {
        load = calc_node_load(sources[i].source, body, *in.system, *in.data);
      }
    }
  }
  void add_load(const BlockInput& in, const double* y, SystemData& data) const override {
    const TreeBody& tb = in.system->impl().tree[body];
    const auto eta = data.tree.q.segment(tb.eta_offset(), n);
    auto modal = data.tree.applied.segment(tb.v_offset + 6, n);
    for (size_t i = 0; i < K1.size(); ++i)
      if (K1[i].size() > 0 && y[i] != 0) modal.noalias() -= y[i] * (K1[i] * eta);
    for (size_t i = 0; i < sources.size(); ++i) {
      for (size_t c = 0; c < 6; ++c) {
        const double value = y[12 + 6 * i + c];
        const MatrixXd& K = sources[i].K2[c];
        if (K.size() > 0 && value != 0) modal.noalias() -= value * (K * eta);
      }
    }
  }
};

/// K_G2 of the unit loads at a node; false without any.
bool find_locators(const records::FlexBody& flex, int node_id, int n, StiffeningSource& source) {
  bool has_any = false;
  for (size_t e = 0; e < flex.locators.size(); ++e) {
    const auto& locator = flex.locators[e];
    if (locator.node != node_id || locator.direction < 1 || e >= flex.kg_external.size()) continue;
    source.K2[static_cast<size_t>(locator.direction) - 1] = flex.kg_external[e].topLeftCorner(n, n);
    has_any = true;
  }
  return has_any;
}

/// K_G2 of a load pattern by its name; false without.
bool find_pattern(const records::FlexBody& flex, const records::SystemSpec& spec, const AppliedForce& force, int n,
                  StiffeningSource& source) {
  for (const auto& r : spec.forces) {
    if (r.name != force.name) continue;
    for (size_t e = 0; e < flex.locators.size(); ++e) {
      if (flex.locators[e].name != r.locator || e >= flex.kg_external.size()) continue;
      source.K2[0] = flex.kg_external[e].topLeftCorner(n, n);
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::unique_ptr<Block>> make_lagged_stiffening(const records::SystemSpec& spec, const System& system,
                                                           const FlexMap& flex, Diagnostics& diagnostics) {
  std::vector<std::unique_ptr<Block>> all;
  const System::Impl& impl = system.impl();
  const auto& simulation = spec.simulation;
  std::string others, with_hinges;
  for (const auto& r : spec.bodies) {
    const int b = system.find_body(r.name);
    const auto record = flex.find(r.file);
    if (b < 0 || !system.is_sound(b) || record == flex.end() || !r.stiffening || system.num_modes(b) == 0) continue;
    auto made = std::make_unique<LaggedStiffening>();
    made->body = b;
    made->n = system.num_modes(b);
    for (size_t i = 0; i < made->K1.size(); ++i)
      if (record->second.kg_inertial_computed[i])
        made->K1[i] = record->second.kg_inertial[i].topLeftCorner(made->n, made->n);
    const auto& nodes = impl.tree[b].body.nodes();
    for (const auto& source : list_node_sources(system, b)) {
      if (source.constraint >= 0) continue;
      StiffeningSource stiffening{source};
      const int id = nodes[static_cast<size_t>(source.node)].id;
      if (find_locators(record->second, id, made->n, stiffening)) made->sources.push_back(std::move(stiffening));
    }
    for (const AppliedForce& force : impl.forces) {
      if (force.body != b || force.pattern.size() == 0) continue;
      StiffeningSource stiffening{{0, -1, -1, false, &force}};
      if (find_pattern(record->second, spec, force, made->n, stiffening))
        made->sources.push_back(std::move(stiffening));
    }
    if (std::any_of(made->sources.begin(), made->sources.end(), [](const auto& s) { return s.source.hinge >= 0; }))
      with_hinges += (with_hinges.empty() ? "" : ", ") + r.name;
    made->name = r.name;
    made->path = "/stiffening/" + r.name;
    made->label = "lagged stiffening of body '" + r.name + "'";
    made->description =
        "A_I (12), then FCONI, as the step before had them: force and moment at each node with locators, or a "
        "pattern's value and five zeros";
    made->dims = "as A_I and FCONI";
    made->at = simulation.at;
    made->sizes.outputs = 12 + 6 * static_cast<int>(made->sources.size());
    made->sizes.sample_time = simulation.stiffening_step > 0 ? simulation.stiffening_step : simulation.step;
    made->sizes.reads_acceleration = true;
    all.push_back(std::move(made));
  }
  for (const auto& r : spec.actuators)
    if (!r.body.empty()) others += (others.empty() ? "" : ", ") + r.name;
  for (const auto& r : spec.force_elements) others += (others.empty() ? "" : ", ") + r.name;
  for (const auto& force : impl.driven) others += (others.empty() ? "" : ", ") + force.name;
  for (const auto& r : spec.constraints) others += (others.empty() ? "" : ", ") + r.name;
  if (!all.empty() && !others.empty())
    diagnostics.warning(
        "system.lagged-loads", simulation.at,
        "lagged stiffening knows the loads of hinges and of forces without a type only, not of: " + others,
        "take stiffening = \"consistent\", which sees them all");
  if (!with_hinges.empty())
    diagnostics.warning("system.lagged-hinges", simulation.at,
                        "what crosses the hinges of " + with_hinges +
                            " is fed back a step late: where it accelerates light modes it may go to and fro and grow",
                        "compare with stiffening = \"consistent\"; keep fewer modes, or damp them");
  return all;
}

}  // namespace bough::solver
