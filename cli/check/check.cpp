#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "analysis/check/try_reduction.hpp"
#include "analysis/common/body_files.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/model_choice.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/solution.hpp"
#include "analysis/common/system_files.hpp"
#include "cli/check/check_components.hpp"
#include "cli/check/check_solutions.hpp"
#include "cli/check/check_subcases.hpp"
#include "cli/check/diagram.hpp"
#include "cli/common/console.hpp"
#include "cli/common/deck_tables.hpp"
#include "cli/common/model_options.hpp"
#include "cli/common/options.hpp"
#include "fe/linear/factor.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/matrices/connected_parts.hpp"
#include "fe/matrices/mass_directions.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/preload.hpp"
#include "formats/flx/flx_file.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/nastran/reader.hpp"
#include "formats/records/params.hpp"
#include "formats/toml/specs.hpp"
#include "solver/simulate/simulate.hpp"

namespace bough::cli {

namespace {

struct CheckOptions : CommonOptions {
  std::vector<std::string> set;
  std::string file, diagram;
  analysis::ModelChoice model;
  std::optional<int> gpwg;  ///< grid of the weight table; 0: the origin
};

/// Grid of the weight table: from the command line, else from PARAM,GRDPNT, whose negative value requests no table.
std::optional<int> choose_weight_grid(const CheckOptions& options, const records::Deck& deck,
                                      Diagnostics& diagnostics) {
  if (options.gpwg) return options.gpwg;
  if (!deck.find_param("GRDPNT")) return std::nullopt;
  const double value = records::get_real_param(deck, "GRDPNT", -1, diagnostics);
  return value < 0 ? std::nullopt : std::optional<int>(static_cast<int>(std::min(value, 1e9)));
}

/// Prints the summary and what was found, as text or JSON, and throws when an error is among it.
int finish(const CheckOptions& options, const Console& console, const std::string& text, nlohmann::json json,
           const Diagnostics& diagnostics) {
  if (options.json) {
    auto messages = nlohmann::json::array();
    for (const auto& item : diagnostics.items()) messages.push_back(format(item));
    json["messages"] = messages;
    json["errors"] = diagnostics.num_errors();
    json["warnings"] = diagnostics.num_warnings();
    write_report(options, console, json.dump(2) + "\n");
    console.print(diagnostics);
  } else {
    const auto sum = count(static_cast<std::size_t>(diagnostics.num_errors()), "error") + ", " +
                     count(static_cast<std::size_t>(diagnostics.num_warnings()), "warning") + "\n";
    // On the screen the messages stand before their sum.
    if (options.output.empty()) console.print(text);
    console.print(diagnostics);
    write_report(options, console, options.output.empty() ? sum : text + sum);
  }
  return diagnostics.num_errors() > 0 ? kInputError : kSuccess;
}

void check_model(const CheckOptions& options, const records::Deck& deck, fe::ModelOptions model_options,
                 std::string& text, nlohmann::json& json, Diagnostics& diagnostics) {
  model_options.uses_enforced = true;
  fe::check_preloads(deck, diagnostics);
  analysis::note_solution(deck, diagnostics);
  const auto model = fe::build_model(deck, model_options, diagnostics);
  if (diagnostics.num_errors() > 0) return;
  const auto mass = fe::calc_mass_properties(model, model.mass_kind(), Vector3d::Zero());
  if (mass.rigid_mass.isZero(0)) {
    const auto M = fe::assemble_mass(model, fe::DofSet::Global, model.mass_kind());
    if (model.num_gdofs() > 0 && linear::get_diagonal(M).maxCoeff() > 0)
      diagnostics.note("cli.no-mass", deck.locate({}), "the only mass is at scalar points, which have no place",
                       "modes are right; a body needs mass at grids");
    else
      diagnostics.note("cli.no-mass", deck.locate({}), "the model has no mass",
                       "for modes and bodies give RHO in MAT1, NSM in a property, or CONM2 and CMASS cards");
  }
  fe::report_mass(model, deck, mass, diagnostics);
  if (const auto loose = fe::describe_loose_parts(model); !loose.what.empty())
    diagnostics.warning("fe.loose-parts", deck.locate({}), loose.what, loose.advice);
  const GroundChecks ground{fe::calc_ground_check(model, fe::GroundSet::Global),
                            fe::calc_ground_check(model, fe::GroundSet::Independent),
                            fe::calc_ground_check(model, fe::GroundSet::Free)};
  text += fmt::format("\n{} nodes, {} elements, {} dofs, {} free after constraints; {} mass\n\n", model.nodes().size(),
                      model.elements().size(), model.num_gdofs(), model.num_fdofs(),
                      model.mass_kind() == fe::MassKind::Lumped ? "lumped" : "consistent");
  check_components(deck, text, json, diagnostics);
  text += format_sections(deck);
  text += format_mass_properties(mass) + "\n" + format_ground_check(ground) + "\n" + format_autospc(model) + "\n" +
          format_geometry(model, deck);
  if (const auto grid = choose_weight_grid(options, deck, diagnostics)) {
    auto weight_grid = *grid;
    if (weight_grid > 0 && model.find_node(weight_grid) < 0 && !options.gpwg) {
      diagnostics.warning("cli.no-weight-grid", deck.locate(deck.find_param("GRDPNT")->at),
                          fmt::format("PARAM,GRDPNT names grid {}, which the deck does not define", weight_grid),
                          "the weight table is about the origin");
      weight_grid = 0;
    }
    const auto weight = fe::calc_grid_point_weight(model, weight_grid);
    text += "\n" + format_weight(weight);
    json["weight"] = to_json(weight);
  }
  check_subcases(deck, model, model_options, text, json, diagnostics);
  json["num_nodes"] = model.nodes().size();
  json["num_elements"] = model.elements().size();
  json["num_dofs"] = model.num_gdofs();
  json["num_free_dofs"] = model.num_fdofs();
  json["mass_properties"] = to_json(mass);
  json["ground_check"] = to_json_list(ground.g);
  json["ground_check_n"] = to_json_list(ground.n);
  json["ground_check_f"] = to_json_list(ground.f);
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

void describe_deck(const records::Deck& deck, std::string& text, nlohmann::json& json) {
  text += fmt::format("Nastran deck, SOL {}, {}, {}\n", deck.sol.empty() ? "-" : deck.sol,
                      count(deck.subcases.size(), "subcase"), count(deck.files.size(), "file"));
  text += format_card_counts(deck);
  json["kind"] = "deck";
  json["sol"] = deck.sol;
  json["cards"] = deck.card_counts;
  json["skipped"] = nlohmann::json::object();
  for (const auto& card : deck.unused) json["skipped"][card.name] = card.count;
}

int check_deck(const CheckOptions& options, Console& console) {
  analysis::do_once([&] { analysis::demand_deck(options.file); });
  console.set_rank(linear::initialize_petsc().rank);
  Diagnostics diagnostics;
  const auto deck = analysis::read_deck_once(options.file, options.model.ignore_cards, diagnostics);
  std::string text;
  nlohmann::json json;
  describe_deck(deck, text, json);
  // A deck with errors is still taken as far as it goes, so that one pass shows all of them.
  check_model(options, deck, analysis::make_model_options(options.model), text, json, diagnostics);
  return finish(options, console, text, json, diagnostics);
}

/// Reports errors that `reduce` would find after its factorizations, as far as rigid-body modes show them: a free body
/// that is constrained, a fixed one that is not. Internal mechanisms are found by `reduce` alone.
void check_support(const CheckOptions& options, bool is_free, const nlohmann::json& json, Diagnostics& diagnostics) {
  const auto calc_largest = [&](const char* set) {
    double largest = 0;
    for (const double x : json.at(set)) largest = std::max(largest, std::isfinite(x) ? x : 0.0);
    return largest;
  };
  if (is_free && calc_largest("ground_check_n") > 1e-8)
    diagnostics.error(
        "reduce.grounded", {options.file},
        fmt::format("a free body must have 6 rigid motions, this model strains in them: {:.1e} of what "
                    "its stiffness allows",
                    calc_largest("ground_check_n")),
        "remove springs and bushes to ground, and CELASi between grids that lie apart (they hold rotations), "
        "or use frame = \"fixed\"");
  if (!is_free && json.at("num_free_dofs").get<int>() > 0 && calc_largest("ground_check_f") < 1e-12)
    diagnostics.error("reduce.mechanism", {options.file},
                      "the constraints do not hold the fixed body: no rigid motion of it strains it",
                      "complete the SPC set and select it in the case control, or use frame = \"free\" (--free)");
}

int check_body(const CheckOptions& options, Console& console) {
  console.set_rank(linear::initialize_petsc().rank);
  Diagnostics diagnostics;
  const auto spec = analysis::read_body_spec_once(options.file, diagnostics);
  nlohmann::json json{{"kind", "body"}, {"name", spec.name}, {"deck", spec.deck}};
  std::string text =
      fmt::format("body file: \"{}\" from {}, {} frame, {}, {}, {}\n", spec.name, spec.deck,
                  spec.frame == records::BodyFrame::Fixed ? "fixed" : "free",
                  count(static_cast<std::size_t>(spec.num_modes), "mode"),
                  count(spec.interface_nodes.size(), "interface node"), count(spec.loads.size(), "load"));
  const auto deck_path = analysis::resolve_beside(options.file, spec.deck);
  if (!spec.deck.empty()) {
    analysis::do_once([&] { analysis::demand_file(deck_path); });
    const auto deck = analysis::read_deck_once(deck_path, spec.ignore_cards, diagnostics);
    describe_deck(deck, text, json);
    json["kind"] = "body";
    auto model_options = analysis::make_model_options(options.model);
    model_options.subcase = spec.subcase;
    model_options.ignore_spc = spec.frame != records::BodyFrame::Fixed;
    model_options.origin = spec.origin;
    model_options.ignore_cards = spec.ignore_cards;
    check_model(options, deck, model_options, text, json, diagnostics);
    if (diagnostics.num_errors() == 0) check_support(options, model_options.ignore_spc, json, diagnostics);
    for (int id : spec.interface_nodes) {
      const bool found = std::any_of(deck.grids.begin(), deck.grids.end(), [&](const auto& g) { return g.id == id; });
      if (!found && diagnostics.num_errors() == 0) {
        diagnostics.error("cli.unknown-interface", {options.file},
                          fmt::format("interface node {} is not a grid of {}", id, spec.deck),
                          "name a GRID of the deck");
      }
    }
  }
  if (diagnostics.num_errors() == 0)
    analysis::try_reduction(options.file, spec, json.value("num_free_dofs", 0), diagnostics);
  return finish(options, console, text, json, diagnostics);
}

int check_system(const CheckOptions& options, const Console& console) {
  Diagnostics diagnostics;
  const auto loaded = analysis::load_system(options.file, diagnostics, {}, options.set);
  const auto& system = loaded.system;
  solver::check_start(system, loaded.spec, diagnostics);
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
  const auto& spec = loaded.spec;
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
  const auto text = fmt::format("system file: {}; {}\n{}integrator {}, duration {:g}\n", what,
                                count(static_cast<std::size_t>(system.num_dofs()), "generalized speed"),
                                table.to_text(), spec.simulation.integrator, spec.simulation.duration);
  if (!options.diagram.empty() && console.is_root()) write_diagram(spec, options.diagram);
  return finish(options, console, text, {{"kind", "system"}, {"bodies", bodies}, {"num_speeds", system.num_dofs()}},
                diagnostics);
}

void check_flex_body(const std::string& path, std::string& text, nlohmann::json& json, Diagnostics& diagnostics) {
  const auto body = analysis::read_body(path, diagnostics);
  int computed = 0;
  for (bool flag : body.kg_inertial_computed) computed += flag ? 1 : 0;
  double worst = 0;
  for (const auto& list : {std::vector<MatrixXd>(body.kg_inertial.begin(), body.kg_inertial.end()), body.kg_external}) {
    for (const auto& kg : list) {
      if (kg.size() > 0) worst = std::max(worst, (kg - kg.transpose()).norm() / std::max(kg.norm(), 1e-300));
    }
  }
  text += fmt::format(
      "flexible body \"{}\": mass {:.6g}, {} modes ({:.6g} to {:.6g} Hz), {} nodes, {} interface nodes\n", body.name,
      body.mass, body.num_modes(), body.num_modes() ? body.frequency_hz[0] : 0.0,
      body.num_modes() ? body.frequency_hz[body.num_modes() - 1] : 0.0, body.num_nodes(), body.interface_nodes.size());
  text += fmt::format("geometric stiffness: {} of 12 inertial loads, {} locators; asymmetry {:.1e}\n", computed,
                      body.locators.size(), worst);
  json["kind"] = "bough-flexbody";
  json["num_modes"] = body.num_modes();
  json["mass"] = body.mass;
  json["kg_asymmetry"] = worst;
  if (worst > 1e-6) {
    diagnostics.error("cli.bad-body", {path}, fmt::format("geometric stiffness is not symmetric, {:.1e}", worst),
                      "reduce the body again");
  }
}

void check_results(const std::string& path, std::string& text, nlohmann::json& json, Diagnostics& diagnostics) {
  const auto results = hdf5::read_results(path);
  const auto nt = results.time.size();
  text += fmt::format("results: {} samples from {:g} to {:g}, {} channels, {}{}\n", nt, nt ? results.time[0] : 0.0,
                      nt ? results.time[nt - 1] : 0.0, results.channels.size(),
                      results.completed ? "completed" : "not completed",
                      results.reason.empty() ? "" : " (" + results.reason + ")");
  for (const auto& [name, values] : results.channels) {
    if (!values.allFinite()) {
      diagnostics.error("cli.not-finite", {path}, "channel " + name + " holds values that are not finite",
                        "look at the sample before the first of them");
    }
  }
  if (!results.completed) {
    diagnostics.warning("cli.incomplete-run", {path}, "the run did not complete",
                        "continue it with bough run --resume");
  }
  json["kind"] = "bough-results";
  json["num_samples"] = nt;
  json["completed"] = results.completed;
}

int check_flat(const CheckOptions& options, const Console& console) {
  Diagnostics diagnostics;
  std::string text;
  nlohmann::json json;
  check_flex_body(options.file, text, json, diagnostics);
  return finish(options, console, text, json, diagnostics);
}

int check_hdf5(const CheckOptions& options, const Console& console) {
  Diagnostics diagnostics;
  const auto info = hdf5::read_info(options.file);
  const auto format = info.attributes.find("format");
  std::string text;
  nlohmann::json json;
  if (format != info.attributes.end() && format->second == "bough-flexbody") {
    check_flex_body(options.file, text, json, diagnostics);
  } else if (format != info.attributes.end() && format->second == "bough-results") {
    check_results(options.file, text, json, diagnostics);
  } else if (format != info.attributes.end() && format->second == "bough-modes") {
    const auto modes = hdf5::read_modes(options.file);
    text += fmt::format("modes: {} of {} grids, {} rigid\n", modes.residual.size(), modes.node_id.size(),
                        modes.num_rigid_modes);
    json["kind"] = "bough-modes";
    json["num_modes"] = modes.residual.size();
  } else if (format != info.attributes.end() && format->second == "bough-static") {
    check_static(options.file, info, text, json, diagnostics);
  } else if (format != info.attributes.end() && format->second == "bough-matrices") {
    check_matrices(options.file, info, text, json, diagnostics);
  } else if (format != info.attributes.end() && format->second == "bough-linear") {
    const auto model = hdf5::read_linear_model(options.file);
    text += fmt::format("linear model: {} states, {} inputs, {} outputs at t = {:g}, known to {:.1e}\n",
                        model.states.size(), model.inputs.size(), model.outputs.size(), model.time,
                        std::max(model.error, model.difference));
    json["kind"] = "bough-linear";
    json["num_states"] = model.states.size();
  } else if (format != info.attributes.end() && format->second.starts_with("bough-")) {
    diagnostics.error("cli.unknown-format", {options.file},
                      "there is nothing that check looks at in a file of format \"" + format->second + "\"",
                      "bough info FILE lists what is in it; bough report FILE makes a page of it");
  } else {
    diagnostics.error("cli.unknown-format", {options.file},
                      "an HDF5 file without a format that Bough knows" +
                          (format == info.attributes.end() ? std::string() : ", found \"" + format->second + "\""),
                      "expected bough-flexbody, bough-modes, bough-results, bough-static, bough-linear or "
                      "bough-matrices");
  }
  return finish(options, console, text, json, diagnostics);
}

/// Every body of the file, or the one that its name chooses.
int check_flx(const CheckOptions& options, const Console& console) {
  Diagnostics diagnostics;
  std::string text;
  auto bodies = nlohmann::json::array();
  const auto name = flx::parse_flx_name(options.file).value_or(flx::FlxName{});
  for (const auto& file : flx::read_flx_bodies(name.path)) {
    if (name.body_id > 0 && name.body_id != file.body_id) continue;
    bodies.emplace_back();
    check_flex_body(name.path + ":" + std::to_string(file.body_id), text, bodies.back(), diagnostics);
    bodies.back()["body_id"] = file.body_id;
  }
  if (bodies.empty()) flx::read_flx(name.path, name.body_id);  // says which there are
  return finish(options, console, text, {{"kind", "flx"}, {"bodies", bodies}}, diagnostics);
}

int check_file(const CheckOptions& options, Console& console) {
  analysis::do_once([&] { analysis::demand_body_file(options.file); });
  if (!options.diagram.empty()) {
    const bool is_toml = analysis::has_suffix(options.file, ".toml");
    analysis::demand_kind(options.file, is_toml ? toml_files::detect_kind(options.file) : "", "system");
    if (!is_toml)
      throw InputError("cli.bad-diagram", {options.file}, "--diagram draws the blocks of a system file",
                       "name a system.toml");
  }
  if (analysis::is_flat(options.file)) return check_flat(options, console);
  if (analysis::is_flx(options.file)) return check_flx(options, console);
  if (analysis::has_suffix(options.file, ".h5") || analysis::has_suffix(options.file, ".hdf5"))
    return check_hdf5(options, console);
  if (analysis::has_suffix(options.file, ".toml")) {
    const auto kind = analysis::share([&] { return toml_files::detect_kind(options.file); });
    if (kind == "body") return check_body(options, console);
    analysis::demand_kind(options.file, kind, "system");
    return check_system(options, console);
  }
  return check_deck(options, console);
}

int run_check(const CheckOptions& options) {
  Console console(options.quiet, options.verbosity);
  analysis::do_once([&] {
    check_outputs(options, {options.output, options.diagram}, {analysis::get_body_path(options.file)});
  });
  try {
    return check_file(options, console);
  } catch (const InputError& failure) {
    if (!options.json) throw;
    Diagnostics diagnostics;
    for (const auto& item : failure.items()) diagnostics.add(item);
    return finish(options, console, {}, {{"kind", nullptr}}, diagnostics);
  }
}

}  // namespace

void add_check(CLI::App& app, Action& action) {
  auto o = std::make_shared<CheckOptions>();
  auto* verb = add_verb(app, "check", "Read a deck, body, system or HDF5 file; print its content and every error");
  verb->add_option("file", o->file, "Nastran deck, body.toml, system.toml, .h5 or .FLX")->required();
  verb->add_option("--gpwg", o->gpwg,
                   "Weights about this grid (0: the origin) as the grid point weight generator of Nastran prints them "
                   "(default: PARAM,GRDPNT)")
      ->check(CLI::NonNegativeNumber)
      ->type_name("GRID");
  verb->add_option("--diagram", o->diagram,
                   "System file: draw its sensors, controllers, actuators, functions and bodies to FILE.dot, or by "
                   "graphviz to FILE.svg, .png or .pdf")
      ->type_name("FILE");
  add_model_options(*verb, o->model);
  add_set_option(*verb, o->set);
  add_common_options(*verb, *o, kOutput | kJson, "Write the report to this file instead of stdout");
  verb->footer("Example:\n  bough check boom.bdf\n  bough check spinup.toml --json");
  verb->callback([&action, o] { action = [o] { return run_check(*o); }; });
}

}  // namespace bough::cli
