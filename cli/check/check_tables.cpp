#include "cli/check/check_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/common/console.hpp"
#include "cli/common/deck_tables.hpp"
#include "cli/common/json_rows.hpp"

namespace bough::cli {

namespace {

constexpr std::size_t kMaxRows = 20;
constexpr Eigen::Index kMaxShown = 12;

std::string list_frequencies(const Eigen::VectorXd& hz) {
  std::string text;
  for (Eigen::Index i = 0; i < std::min(hz.size(), kMaxShown); ++i)
    text += fmt::format("{}{:.6g}", i > 0 ? ", " : "", hz[i]);
  return hz.size() > kMaxShown ? text + fmt::format(", ... {:.6g}", hz[hz.size() - 1]) : text;
}

std::string format_rows(const std::vector<analysis::SubcaseCheck>& rows) {
  Table table{{"subcase", "LOAD", "TEMP", "SPC", "MPC", "Fx", "Fy", "Fz", "Mx", "My", "Mz", "enforced", "heated"}, {}};
  const auto name = [](int set) { return set ? std::to_string(set) : std::string("-"); };
  for (std::size_t i = 0; i < std::min(rows.size(), kMaxRows); ++i) {
    const auto& row = rows[i];
    const auto& s = row.subcase;
    std::vector<std::string> cells{std::to_string(s.id), name(s.load), name(s.temperature), name(s.spc), name(s.mpc)};
    for (const double f : row.resultant) cells.push_back(row.is_resolved ? fmt::format("{:.5g}", f + 0.0) : "?");
    cells.push_back(row.is_resolved ? std::to_string(row.num_enforced) : "?");
    cells.push_back(row.is_resolved ? std::to_string(row.num_heated) : "?");
    table.rows.push_back(std::move(cells));
  }
  const auto rest = rows.size() - std::min(rows.size(), kMaxRows);
  return "loads of the subcases about the origin\n" + table.to_text() +
         (rest ? fmt::format("... and {} more\n", count(rest, "subcase")) : "");
}

void add_subcases(const std::vector<analysis::SubcaseCheck>& rows, std::string& text, nlohmann::json& json) {
  json["subcases"] = nlohmann::json::array();
  if (rows.empty()) return;
  for (const auto& row : rows) {
    auto cell = nlohmann::json{
        {"id", row.subcase.id},       {"load_set", row.subcase.load}, {"temperature_set", row.subcase.temperature},
        {"spc_set", row.subcase.spc}, {"mpc_set", row.subcase.mpc},   {"resolved", row.is_resolved}};
    if (row.is_resolved) {
      cell["resultant"] = to_json_list(row.resultant);
      cell["num_enforced"] = row.num_enforced;
      cell["num_heated"] = row.num_heated;
    }
    json["subcases"].push_back(std::move(cell));
  }
  text += "\n" + format_rows(rows);
}

void add_responses(const std::vector<analysis::ResponseCheck>& rows, std::string& text, nlohmann::json& json) {
  if (rows.empty()) return;
  const bool is_over_time = rows.front().is_over_time;
  Table table{{"subcase", is_over_time ? "times" : "frequencies", "from", "to", "loads", "motions"}, {}};
  json["responses"] = nlohmann::json::array();
  for (const auto& row : rows) {
    nlohmann::json one{{"id", row.subcase}, {"num_loads", row.num_loads}, {"num_motions", row.num_motions}};
    if (!row.follows_modes) {
      one[is_over_time ? "num_times" : "num_frequencies"] = row.num_steps;
      one["range"] = {row.first, row.last};
    }
    json["responses"].push_back(std::move(one));
    if (table.rows.size() == kMaxRows) continue;
    table.rows.push_back({std::to_string(row.subcase), row.follows_modes ? "by modes" : std::to_string(row.num_steps),
                          row.follows_modes ? "-" : fmt::format("{:.6g}", row.first),
                          row.follows_modes ? "-" : fmt::format("{:.6g}", row.last), std::to_string(row.num_loads),
                          std::to_string(row.num_motions)});
  }
  text += fmt::format("\nresponses over {}\n", is_over_time ? "time" : "frequency, Hz") + table.to_text();
  if (rows.size() > kMaxRows) text += fmt::format("... and {} more\n", count(rows.size() - kMaxRows, "subcase"));
}

void add_superelements(const analysis::DeckCheck& deck, std::string& text, nlohmann::json& json) {
  if (deck.superelements.empty()) return;
  json["superelements"] = nlohmann::json::array();
  for (std::size_t i = 0; i < deck.superelements.size(); ++i) {
    const auto& check = deck.superelements[i];
    text += fmt::format("superelement {}: {}, {}{}\n", check.id,
                        count(static_cast<std::size_t>(check.num_grids), "boundary grid"),
                        count(static_cast<std::size_t>(check.num_points), "generalized coordinate"),
                        check.file.empty() ? "" : ", matrices of " + check.file);
    text += fmt::format("  rigid-body motion: strain energy {:.1e} of the diagonal's, force {:.2e}, moment {:.2e}\n",
                        check.rigid_energy.maxCoeff(), check.rigid_force, check.rigid_moment);
    text += fmt::format("  mass {:.7g}, centre of mass ({:.6g}, {:.6g}, {:.6g})\n", check.mass.mass, check.mass.cg.x(),
                        check.mass.cg.y(), check.mass.cg.z());
    text += fmt::format("  coupling K_bq {:.1e}\n", check.coupling);
    if (check.held_hz.size() > 0) text += fmt::format("  boundary held, Hz: {}\n", list_frequencies(check.held_hz));
    using Check = std::decay_t<decltype(check)>;
    nlohmann::json one{{"mass_properties", to_json(check.mass)}};
    put_members(one, check, "id", &Check::id, "num_grids", &Check::num_grids, "num_points", &Check::num_points,
                "rigid_force", &Check::rigid_force, "rigid_moment", &Check::rigid_moment, "coupling", &Check::coupling);
    one["rigid_energy"] = std::vector<double>(check.rigid_energy.begin(), check.rigid_energy.end());
    one["held_hz"] = std::vector<double>(check.held_hz.begin(), check.held_hz.end());
    std::vector<std::string> tables;
    for (const auto& table : deck.deck.superelements[i].recovery) {
      tables.push_back(table.name);
      text += fmt::format("  {}: {} rows of {} items\n", table.name, table.rows.rows(), table.items.size());
    }
    one["recovery"] = tables;
    json["superelements"].push_back(std::move(one));
  }
  text += "\n";
}

void add_model(const analysis::DeckCheck& check, std::string& text, nlohmann::json& json) {
  const auto& deck = check.deck;
  const auto& model = *check.model;
  text += fmt::format("\n{} nodes, {} elements, {} dofs, {} free after constraints; {} mass\n\n", model.nodes().size(),
                      model.elements().size(), model.num_gdofs(), model.num_fdofs(),
                      model.mass_kind() == fe::MassKind::Lumped ? "lumped" : "consistent");
  add_superelements(check, text, json);
  text += format_sections(deck);
  text += format_mass_properties(check.mass) + "\n" + format_ground_check(check.ground) + "\n" + format_autospc(model) +
          "\n" + format_geometry(model, deck);
  if (check.weight) {
    text += "\n" + format_weight(*check.weight);
    json["weight"] = to_json(*check.weight);
  }
  add_subcases(check.subcases, text, json);
  add_responses(check.responses, text, json);
  json["num_nodes"] = model.nodes().size();
  json["num_elements"] = model.elements().size();
  json["num_dofs"] = model.num_gdofs();
  json["num_free_dofs"] = model.num_fdofs();
  json["mass_properties"] = to_json(check.mass);
  json["ground_check"] = to_json_list(check.ground.g);
  json["ground_check_n"] = to_json_list(check.ground.n);
  json["ground_check_f"] = to_json_list(check.ground.f);
  json["geometry"] = make_geometry_json(model, deck);
  json["sections"] = make_sections_json(deck);
  json["autospc"] = nlohmann::json::array();
  for (const auto& entry : model.autospc()) {
    json["autospc"].push_back({{"grid", entry.node},
                               {"component", entry.component},
                               {"ratio", entry.ratio},
                               {"oblique", entry.is_skew},
                               {"follows", entry.terms}});
  }
}

void add_deck(const analysis::DeckCheck& check, std::string& text, nlohmann::json& json) {
  const auto& deck = check.deck;
  text += fmt::format("Nastran deck, SOL {}, {}, {}\n", deck.sol.empty() ? "-" : deck.sol,
                      count(deck.subcases.size(), "subcase"), count(deck.files.size(), "file"));
  text += format_card_counts(deck);
  json["kind"] = "deck";
  json["sol"] = deck.sol;
  json["cards"] = deck.card_counts;
  json["skipped"] = nlohmann::json::object();
  for (const auto& card : deck.unused) json["skipped"][card.name] = card.count;
  if (check.model) add_model(check, text, json);
}

void add(const analysis::DeckCheck& check, std::string& text, nlohmann::json& json) { add_deck(check, text, json); }

void add(const analysis::BodyCheck& check, std::string& text, nlohmann::json& json) {
  const auto& spec = check.spec;
  json = {{"kind", "body"}, {"name", spec.name}, {"deck", spec.deck}};
  text = fmt::format("body file: \"{}\" from {}, {} frame, {}, {}, {}\n", spec.name, spec.deck,
                     spec.frame == records::BodyFrame::Fixed ? "fixed" : "free",
                     count(static_cast<std::size_t>(spec.num_modes), "mode"),
                     count(spec.interface_nodes.size(), "interface node"), count(spec.loads.size(), "load"));
  if (check.deck) add_deck(*check.deck, text, json);
  json["kind"] = "body";
}

void add(const analysis::SystemCheck& check, std::string& text, nlohmann::json& json) {
  const auto& system = check.loaded.system;
  Table table{{"body", "hinge", "free coordinates", "modes"}, {}};
  auto bodies = nlohmann::json::array();
  for (int b = 0; b < system.num_bodies(); ++b) {
    table.rows.push_back({system.body_name(b), system.hinge_name(b), std::to_string(system.num_hinge_u(b)),
                          std::to_string(system.num_modes(b))});
    bodies.push_back({{"name", system.body_name(b)},
                      {"hinge", system.hinge_name(b)},
                      {"num_hinge_dofs", system.num_hinge_u(b)},
                      {"num_modes", system.num_modes(b)}});
  }
  const auto& spec = check.loaded.spec;
  std::string what;
  for (const auto& [number, name] : std::initializer_list<std::pair<std::size_t, const char*>>{
           {spec.bodies.size(), "body"},
           {spec.hinges.size(), "hinge"},
           {spec.constraints.size(), "constraint"},
           {spec.forces.size() + spec.force_elements.size(), "force"},
           {spec.sensors.size(), "sensor"},
           {spec.inputs.size(), "input"},
           {spec.controllers.size(), "controller"},
           {spec.actuators.size(), "actuator"},
           {spec.functions.size(), "function"},
           {spec.events.size(), "event"}})
    if (number != 0) what += (what.empty() ? "" : ", ") + count(number, name);
  text += fmt::format("system file: {}; {}\n{}integrator {}, duration {:g}\n", what,
                      count(static_cast<std::size_t>(system.num_dofs()), "generalized speed"), table.to_text(),
                      spec.simulation.integrator, spec.simulation.duration);
  json = {{"kind", "system"}, {"bodies", bodies}, {"num_speeds", system.num_dofs()}};
}

void add(const analysis::FlexBodyCheck& check, std::string& text, nlohmann::json& json) {
  const auto num_modes = check.frequency_hz.size();
  text +=
      fmt::format("flexible body \"{}\": mass {:.6g}, {} modes ({:.6g} to {:.6g} Hz), {} nodes, {} interface nodes\n",
                  check.name, check.mass, num_modes, num_modes ? check.frequency_hz[0] : 0.0,
                  num_modes ? check.frequency_hz[num_modes - 1] : 0.0, check.num_nodes, check.num_interface_nodes);
  text += fmt::format("geometric stiffness: {} of 12 inertial loads, {} locators; asymmetry {:.1e}\n",
                      check.num_kg_inertial, check.num_locators, check.kg_asymmetry);
  if (!check.large.empty()) text += fmt::format("third order: {} large\n", count(check.large.size(), "amplitude"));
  if (check.reach) {
    const auto& reach = *check.reach;
    text += fmt::format(
        "second order: a deflection of {:.3g} in mode {} (node {}) is estimated to be off by 1 %; beyond it set "
        "[body.stiffening] order = 3: at most {} large, about {:.0f} kB of file and {:.1f} µs an evaluation more\n",
        reach.deflection, reach.mode + 1, reach.node, count(static_cast<std::size_t>(reach.num_large), "mode"),
        reach.file_kilobytes, reach.evaluation_microseconds);
    json["next_order"] = {{"mode", reach.mode + 1}, {"node", reach.node}, {"deflection", reach.deflection}};
  }
  json["kind"] = "bough-flexbody";
  json["num_modes"] = num_modes;
  json["mass"] = check.mass;
  json["kg_asymmetry"] = check.kg_asymmetry;
}

void add(const analysis::FlxCheck& check, std::string& text, nlohmann::json& json) {
  auto bodies = nlohmann::json::array();
  for (const auto& body : check) {
    bodies.emplace_back();
    add(body, text, bodies.back());
    bodies.back()["body_id"] = body.body_id;
  }
  json = {{"kind", "flx"}, {"bodies", bodies}};
}

void add(const analysis::ResultsCheck& check, std::string& text, nlohmann::json& json) {
  text += fmt::format("results: {} samples from {:g} to {:g}, {} channels, {}{}\n", check.num_samples, check.start,
                      check.end, check.num_channels, check.completed ? "completed" : "not completed",
                      check.reason.empty() ? "" : " (" + check.reason + ")");
  json["kind"] = "bough-results";
  json["num_samples"] = check.num_samples;
  json["completed"] = check.completed;
}

void add(const analysis::ModesCheck& check, std::string& text, nlohmann::json& json) {
  text += fmt::format("modes: {} of {} grids, {} rigid\n", check.num_modes, check.num_grids, check.num_rigid_modes);
  json["kind"] = "bough-modes";
  json["num_modes"] = check.num_modes;
}

void add(const analysis::StaticCheck& check, std::string& text, nlohmann::json& json) {
  json["kind"] = "bough-static";
  json["subcases"] = nlohmann::json::array();
  text += fmt::format("static solutions: {} subcases on {} dofs\n", check.subcases.size(), check.num_dofs);
  for (const auto& subcase : check.subcases) {
    text += fmt::format("subcase {}: load set {}, forces of {}\n", subcase.id, subcase.load_set,
                        subcase.elements.empty() ? "no elements" : fmt::format("{}", fmt::join(subcase.elements, " ")));
    json["subcases"].push_back({{"id", subcase.id}, {"elements", subcase.elements}});
  }
}

void add(const analysis::MatricesCheck& check, std::string& text, nlohmann::json& json) {
  json["kind"] = "bough-matrices";
  json["matrices"] = check.names;
  text += fmt::format("matrices {} on {} dofs\n", fmt::join(check.names, " "), check.num_dofs);
}

void add(const analysis::LinearCheck& check, std::string& text, nlohmann::json& json) {
  text += fmt::format("linear model: {} states, {} inputs, {} outputs at t = {:g}, known to {:.1e}\n", check.num_states,
                      check.num_inputs, check.num_outputs, check.time, check.error);
  json["kind"] = "bough-linear";
  json["num_states"] = check.num_states;
}

void add(std::monostate, std::string&, nlohmann::json&) {}

}  // namespace

void describe(const analysis::CheckAnswer& answer, std::string& text, nlohmann::json& json) {
  std::visit([&](const auto& check) { add(check, text, json); }, answer.content);
}

}  // namespace bough::cli
