#include <algorithm>
#include <cmath>
#include <set>

#include "stiffening/given_model.hpp"
#include "stiffening/stages.hpp"

namespace bough::stiffening {

using records::BodyBasis;
using records::BodyFrame;
using records::BodySpec;

namespace {

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

void check_choice(const BodyRequest& request, const std::string& id, const std::string& key, const std::string& word,
                  const std::vector<std::string>& choices) {
  if (std::find(choices.begin(), choices.end(), word) != choices.end()) return;
  const auto near = find_nearest(word, choices);
  request.error_at(key, id, key + " is \"" + word + "\", expected one of " + join(choices),
                   near.empty() ? "choose one of them" : "did you mean \"" + near + "\"?");
}

void check_basis_spec(const BodyRequest& request) {
  const BodySpec& spec = request.spec;
  const bool has_given_modes = request.given && has_modes(*request.given);
  if (!has_given_modes && spec.num_modes <= 0 && !spec.max_frequency_hz && spec.select.empty() &&
      spec.basis == BodyBasis::Normal && spec.residual.empty())
    request.error_at("modes", "reduce.no-modes", "the body asks for no modes",
                     "give [body.modes] number, max_frequency or select");
  if (spec.basis != BodyBasis::Normal && spec.interface_nodes.empty())
    request.error_at("modes/basis", "reduce.bad-basis", "the basis needs interface nodes", "name them in interface");
  const bool is_craig_bampton = spec.basis == BodyBasis::CraigBampton;
  if (!spec.orthogonalize && !is_craig_bampton && spec.augments.empty())
    request.error_at("modes/basis", "reduce.bad-basis",
                     "orthogonalize = false has a meaning for craig-bampton and augmented modes only",
                     "remove it, or set basis = \"craig-bampton\"");
  if (!spec.orthogonalize && is_craig_bampton && spec.frame != BodyFrame::Fixed && spec.frame != BodyFrame::Node)
    request.error_at("modes/basis", "reduce.bad-basis",
                     "orthogonalize = false keeps the rigid-body motions of the interface, which this frame removes",
                     "use frame = \"fixed\", or \"node\" with one of the interface nodes");
  std::set<std::string> names{"inertial", "interface"};
  for (const auto& load : spec.loads) names.insert(load.name);
  names.erase("");
  for (const auto& name : spec.residual)
    if (!names.count(name))
      request.error_at("modes/residual", "reduce.unknown-load",
                       "residual names '" + name + "', no load of the body is called so",
                       "the body has " + join({names.begin(), names.end()}));
  if (!spec.augments.empty() && has_given_modes)
    request.diagnostics.error("reduce.bad-augment", spec.augments.front().at,
                              "masses are to augment the modes, but the modes are given",
                              "remove [[body.augment]], or [body.matrices] modes, so that they are solved for");
}

void check_select(const BodyRequest& request) {
  const auto& select = request.spec.select;
  for (const int s : select)
    if (s < 1)
      request.error_at("modes/select", "reduce.bad-select",
                       "mode " + std::to_string(s) + " in select, modes count from 1");
  if (std::set<int>(select.begin(), select.end()).size() != select.size())
    request.error_at("modes/select", "reduce.bad-select", "a mode occurs twice in select", "name each mode once");
}

void check_support(const BodyRequest& request) {
  const BodySpec& spec = request.spec;
  if (spec.support.size() > 1)
    request.error_at("support", "reduce.bad-support",
                     std::to_string(spec.support.size()) + " support nodes, expected one that carries all six dofs",
                     "give one node, or none to have three well-spread ones chosen");
  if (!spec.support.empty() && !request.is_free())
    request.warning_at("support", "reduce.support-unused", "support is given but the frame is fixed",
                       "the deck's SPC set supports a fixed body");
  if (!spec.support.empty() && spec.frame == BodyFrame::Node)
    request.warning_at("support", "reduce.support-unused", "support is given but a node carries the frame",
                       "that node supports the body");
}

void check_damping(const BodyRequest& request) {
  const BodySpec& spec = request.spec;
  const auto add_error = [&](const std::string& message, const std::string& advice) {
    request.error_at("damping", "reduce.bad-damping", message, advice);
  };
  const auto& ratios = spec.damping_ratios;
  if (spec.damping_ratio < 0 || std::any_of(ratios.begin(), ratios.end(), [](double z) { return z < 0; }) ||
      spec.residual_damping.value_or(0) < 0)
    add_error("a damping ratio is negative", "give ratios of 0 or more");
  if (spec.rayleigh_alpha < 0 || spec.rayleigh_beta < 0 || spec.structural_damping < 0)
    add_error("a damping factor is negative", "give 0 or more");
  const auto& table = spec.damping_table;
  for (std::size_t i = 1; i < table.points.size(); ++i)
    if (!(table.points[i].first > table.points[i - 1].first))
      add_error("frequency " + std::to_string(i + 1) + " of the damping table is not above the one before",
                "sort the table by frequency, each once");
  if (table.kind == "quality" &&
      std::any_of(table.points.begin(), table.points.end(), [](const auto& p) { return !(p.second > 0); }))
    add_error("a quality factor is not above 0", "give Q > 0, or a table of ratios");
  if (spec.residual_damping && !spec.orthogonalize)
    add_error("residual_ratio is given with orthogonalize = false, where no mode is a residual vector",
              "remove one of them");
}

void check_preload(const BodyRequest& request) {
  if (!request.spec.preload) return;
  const auto& preload = *request.spec.preload;
  if (preload.subcase == 0 && preload.load_set == 0 && preload.temperature_set == 0 && preload.spin.isZero(0))
    request.diagnostics.error("reduce.bad-preload", preload.at, "the preload names nothing that loads the body",
                              "give subcase, load_set, temperature_set or a spin that is not zero");
  const std::string nonlinear = "nonlinear = true is given, but ";
  if (preload.is_nonlinear && !preload.spin.isZero(0))
    request.diagnostics.error("reduce.bad-preload", preload.at,
                              nonlinear + "a spin loads the places of the undeformed structure",
                              "leave the spin to the solver, or leave nonlinear = true out");
  if (preload.is_nonlinear && request.is_free())
    request.diagnostics.error("reduce.bad-preload", preload.at,
                              nonlinear + "nothing holds the free body while it deforms",
                              "set frame = \"fixed\" and hold the deck by SPC, or leave nonlinear = true out");
  if (request.given)
    request.diagnostics.error("reduce.bad-preload", preload.at,
                              "a preload is given with the matrices of another program, which do not contain their "
                              "stress",
                              "let that program add the geometric stiffness of the preload to K");
}

void check_nodes(const BodyRequest& request) {
  const BodySpec& spec = request.spec;
  std::set<int> grids;
  for (const auto& grid : request.deck.grids) grids.insert(grid.id);
  const auto& scalars = request.deck.scalar_points;
  const auto check = [&](int id, const std::string& key, const SourceLocation& at) {
    if (grids.count(id)) return;
    const bool is_scalar = std::find(scalars.begin(), scalars.end(), id) != scalars.end();
    request.diagnostics.error("reduce.unknown-node",
                              at.file.empty() ? request.where(key == "output" ? "output/nodes" : key) : at,
                              key + " names node " + std::to_string(id) +
                                  (is_scalar ? ", which is a scalar point" : ", the deck has no such grid"),
                              "name a GRID of the deck");
  };
  const auto check_all = [&](const std::vector<int>& ids, const std::string& key) {
    for (const int id : ids) check(id, key, {});
  };
  if (spec.origin_node > 0) check(spec.origin_node, "origin", {});
  check_all(spec.interface_nodes, "interface");
  check_all(spec.output_nodes, "output");
  check_all(spec.support, "support");
  check_all(spec.frame_nodes, "frame_nodes");
  for (const auto& augment : spec.augments) check(augment.node, "augment", augment.at);
  for (const auto& load : spec.loads) {
    if (load.load_set > 0 || load.temperature_set > 0) continue;
    check(load.node, "load \"" + load.name + "\"", load.at);
    if (load.directions.empty() ||
        std::any_of(load.directions.begin(), load.directions.end(), [](int d) { return d < 1 || d > 6; }))
      request.diagnostics.error("reduce.bad-direction", load.at,
                                "load \"" + load.name + "\" needs directions from 1 to 6",
                                "1..3 are forces, 4..6 moments");
  }
}

/// The number of frame_nodes is that of the frame; of a frame without nodes they would be ignored.
void check_frame(const BodyRequest& request) {
  const char* expected = modal::bases::find_expected_nodes(make_frame_spec(request.spec));
  if (expected == nullptr) return;
  const auto count = request.spec.frame_nodes.size();
  request.diagnostics.error(
      "modal.bad-frame", request.where(count > 0 ? "frame_nodes" : "frame"),
      "the frame has " + std::to_string(count) + " frame_nodes, expected " + expected,
      "give as many as the frame takes: one for node, three for 3-2-1, none for fixed, free, mean");
}

}  // namespace

void check_spec(const BodyRequest& request) {
  check_basis_spec(request);
  check_frame(request);
  check_select(request);
  check_choice(request, "reduce.bad-mass", "mass", request.spec.mass, {"deck", "lumped", "consistent"});
  check_choice(request, "reduce.bad-integrals", "integrals", request.spec.integrals, {"lumped", "consistent", "exact"});
  check_support(request);
  check_damping(request);
  check_preload(request);
  check_nodes(request);
  request.diagnostics.throw_if_errors();
}

}  // namespace bough::stiffening
