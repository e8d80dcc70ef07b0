#include "stiffening/reduction.hpp"

#include <algorithm>
#include <set>

namespace bough::stiffening {

using records::BodyFrame;

namespace {

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// The message lists the choices already.
std::string suggest(const std::string& word, const std::vector<std::string>& choices) {
  const auto near = find_nearest(word, choices);
  return near.empty() ? "choose one of them" : "did you mean \"" + near + "\"?";
}

}  // namespace

void Reduction::check_spec() {
  check_basis(spec_, !options_.modes, where(), diagnostics_);
  for (const int s : spec_.select)
    if (s < 1)
      diagnostics_.error("reduce.bad-select", where(), "mode " + std::to_string(s) + " in select, modes count from 1");
  if (std::set<int>(spec_.select.begin(), spec_.select.end()).size() != spec_.select.size())
    diagnostics_.error("reduce.bad-select", where(), "a mode stands twice in select", "name each mode once");
  const std::vector<std::string> masses = {"deck", "lumped", "consistent"};
  if (std::find(masses.begin(), masses.end(), spec_.mass) == masses.end())
    diagnostics_.error("reduce.bad-mass", where(), "mass is \"" + spec_.mass + "\", expected one of " + join(masses),
                       suggest(spec_.mass, masses));
  const std::vector<std::string> methods = {"lumped", "consistent", "exact"};
  if (std::find(methods.begin(), methods.end(), spec_.integrals) == methods.end())
    diagnostics_.error("reduce.bad-integrals", where(),
                       "integrals is \"" + spec_.integrals + "\", expected one of " + join(methods),
                       suggest(spec_.integrals, methods));
  if (spec_.support.size() > 1)
    diagnostics_.error("reduce.bad-support", where(),
                       std::to_string(spec_.support.size()) + " support nodes, expected one that carries all six dofs",
                       "give one node, or none to have three well-spread ones chosen");
  if (!spec_.support.empty() && !is_free())
    diagnostics_.warning("reduce.support-unused", where(), "support is given but the frame is fixed",
                         "the deck's SPC set supports a fixed body");
  if (!spec_.support.empty() && spec_.frame == BodyFrame::Node)
    diagnostics_.warning("reduce.support-unused", where(), "support is given but a node carries the frame",
                         "that node supports the body");
  check_damping(spec_, where(), diagnostics_);
  if (spec_.preload && spec_.preload->subcase == 0 && spec_.preload->load_set == 0 &&
      spec_.preload->temperature_set == 0 && spec_.preload->spin.isZero(0))
    diagnostics_.error("reduce.bad-preload", spec_.preload->at, "the preload names nothing that loads the body",
                       "give subcase, load_set, temperature_set or a spin that is not zero");
  if (spec_.preload && options_.elements)
    diagnostics_.error("reduce.bad-preload", spec_.preload->at,
                       "a preload is given with the matrices of another program, which do not tell their stress",
                       "let that program add the geometric stiffness of the preload to K");
  if (!spec_.augments.empty() && options_.modes)
    diagnostics_.error("reduce.bad-augment", spec_.augments.front().at,
                       "masses are to augment the modes, but the modes are given",
                       "take [[body.augment]] out, or [body.matrices] modes, so that they are solved for");
  diagnostics_.throw_if_errors();
}

fe::ModelOptions Reduction::make_model_options() const {
  fe::ModelOptions options;
  options.subcase = choose_subcase();
  options.ignore_spc = is_free();
  options.origin = spec_.origin;
  options.ignore_cards = spec_.ignore_cards;
  if (spec_.mass == "lumped") options.mass_kind = fe::MassKind::Lumped;
  if (spec_.mass == "consistent") options.mass_kind = fe::MassKind::Consistent;
  return options;
}

void Reduction::check_node(const fe::Model& model, int id, const std::string& what, const SourceLocation& at) {
  const int index = model.find_node(id);
  if (index >= 0 && model.node(index).num_dofs == 6) return;
  diagnostics_.error("reduce.unknown-node", at.file.empty() ? where() : at,
                     what + " names node " + std::to_string(id) +
                         (index < 0 ? ", the deck has no such grid" : ", which is a scalar point"),
                     "name a GRID of the deck");
}

void Reduction::check_nodes(const fe::Model& model) {
  for (const int id : spec_.interface_nodes) check_node(model, id, "interface", {});
  for (const int id : spec_.output_nodes) check_node(model, id, "output", {});
  for (const int id : spec_.support) check_node(model, id, "support", {});
  for (const int id : spec_.frame_nodes) check_node(model, id, "frame_nodes", {});
  for (const auto& augment : spec_.augments) check_node(model, augment.node, "augment", augment.at);
  for (const auto& load : spec_.loads) {
    if (load.load_set > 0 || load.temperature_set > 0) continue;
    check_node(model, load.node, "load \"" + load.name + "\"", load.at);
    if (load.directions.empty() ||
        std::any_of(load.directions.begin(), load.directions.end(), [](int d) { return d < 1 || d > 6; }))
      diagnostics_.error("reduce.bad-direction", load.at, "load \"" + load.name + "\" needs directions from 1 to 6",
                         "1..3 are forces, 4..6 moments");
  }
  diagnostics_.throw_if_errors();
}

}  // namespace bough::stiffening
