#include "stiffening/reduce.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/solution.hpp"
#include "analysis/common/system_files.hpp"
#include "analysis/reduce/matrix_files.hpp"
#include "analysis/reduce/reduce_body.hpp"
#include "cli/common/console.hpp"
#include "cli/common/deck_tables.hpp"
#include "cli/common/options.hpp"
#include "cli/common/solver_option.hpp"
#include "cli/common/text_file.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/compare/compare_report.hpp"
#include "formats/hdf5/body_accuracy.hpp"
#include "formats/nastran/loads_deck.hpp"
#include "formats/toml/specs.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

struct ReduceVerbOptions : CommonOptions {
  std::string file;
  std::string name;
  int num_modes = 0;
  std::optional<double> max_hz;
  bool free = false;
  std::vector<int> interface_nodes;
  std::vector<std::string> loads;
  bool full = false;
  std::vector<std::string> recover;
  bool strain_energy = false;
  bool integrals_report = false;
  std::string mass, integrals;
  std::vector<double> origin;
  std::vector<std::string> ignore_cards;
  int subcase = 0;
  double damping = -1;
  std::vector<std::string> matrices;
  bool force_outside = false;
  std::string solver;
  std::string loads_deck;
  int loads_set = nastran::kFirstInertialSet;
};

/// "[NAME=]NODE:DIRECTIONS", "[NAME=]set:ID" or "[NAME=]temperature:ID".
records::ExternalLoadSpec parse_load(const std::string& text) {
  const auto fail = [&]() -> InputError {
    return {"cli.bad-load",
            {},
            "cannot read --load \"" + text + "\"",
            "write NODE:DIRECTIONS such as 41:2 or 41:123, set:ID or temperature:ID; NAME= may stand before"};
  };
  records::ExternalLoadSpec load;
  std::string rest = text;
  if (const auto equals = rest.find('='); equals != std::string::npos) {
    load.name = rest.substr(0, equals);
    rest.erase(0, equals + 1);
  }
  const auto colon = rest.find(':');
  if (colon == std::string::npos || colon + 1 == rest.size()) throw fail();
  const auto before = rest.substr(0, colon), after = rest.substr(colon + 1);
  const auto is_number = [](const std::string& s) {
    return !s.empty() && s.size() < 9 && s.find_first_not_of("0123456789") == std::string::npos;
  };
  if (!is_number(after)) throw fail();
  if (before == "set") {
    load.load_set = std::stoi(after);
  } else if (before == "temperature") {
    load.temperature_set = std::stoi(after);
  } else {
    if (!is_number(before)) throw fail();
    load.node = std::stoi(before);
    for (char c : after) {
      if (c < '1' || c > '6') throw fail();
      load.directions.push_back(c - '0');
    }
  }
  if (load.name.empty()) load.name = "load " + rest;
  return load;
}

void add_matrices(const ReduceVerbOptions& o, records::BodySpec& spec) {
  if (o.matrices.empty()) return;
  if (!spec.matrices) spec.matrices.emplace();
  // The common file first: ":NAME" of the others is in it.
  for (const bool is_file : {true, false})
    for (const auto& text : o.matrices)
      if ((text.find('=') == std::string::npos) == is_file) analysis::add_matrices_option(text, *spec.matrices);
  if (spec.name.empty())
    spec.name = fs::path(spec.matrices->file.empty() ? spec.matrices->stiffness.file : spec.matrices->file).stem();
}

records::BodySpec make_spec(const ReduceVerbOptions& o, Diagnostics& diagnostics) {
  records::BodySpec spec;
  const bool is_toml = analysis::has_suffix(o.file, ".toml");
  if (is_toml) {
    analysis::do_once([&] { analysis::demand_kind(o.file, toml_files::detect_kind(o.file), "body"); });
    spec = analysis::read_body_spec_once(o.file, diagnostics);
    diagnostics.throw_if_errors();
    if (!spec.deck.empty()) spec.deck = analysis::resolve_beside(o.file, spec.deck);
    add_matrices(o, spec);
  } else {
    if (!o.file.empty()) analysis::do_once([&] { analysis::demand_deck(o.file); });
    spec.deck = o.file;
    spec.name = fs::path(o.file).stem().string();
    add_matrices(o, spec);
    const bool has_modes = spec.matrices && !spec.matrices->modes.empty();
    if (o.num_modes == 0 && !o.max_hz && !has_modes) {
      throw InputError("cli.no-modes", {o.file}, "the number of modes is not given", "add --modes N or --max-hz F");
    }
  }
  if (!o.name.empty()) spec.name = o.name;
  if (o.num_modes > 0) spec.num_modes = o.num_modes;
  if (o.max_hz) spec.max_frequency_hz = o.max_hz;
  if (o.free) spec.frame = records::BodyFrame::Free;
  if (!o.interface_nodes.empty()) spec.interface_nodes = o.interface_nodes;
  for (const auto& load : o.loads) spec.loads.push_back(parse_load(load));
  if (o.full) spec.full = true;
  if (!o.recover.empty()) spec.recover = o.recover;
  if (o.strain_energy) spec.strain_energy = true;
  if (!o.mass.empty()) spec.mass = o.mass;
  if (!o.integrals.empty()) spec.integrals = o.integrals;
  if (!o.origin.empty()) spec.origin = Vector3d(o.origin[0], o.origin[1], o.origin[2]);
  spec.ignore_cards.insert(spec.ignore_cards.end(), o.ignore_cards.begin(), o.ignore_cards.end());
  if (o.subcase > 0) spec.subcase = o.subcase;
  if (o.damping >= 0) {
    spec.damping_ratio = o.damping;
    spec.damping_ratios.clear();
  }
  return spec;
}

std::string choose_output(const ReduceVerbOptions& o, const records::BodySpec& spec) {
  if (!o.output.empty()) return o.output;
  if (!spec.output_file.empty()) return analysis::resolve_beside(spec.file, spec.output_file);
  return spec.name + ".h5";
}

/// The mass that each direction moves: the resultant of a unit acceleration that way. All are body.mass but where
/// scalar masses or given matrices have another one in some direction.
Vector3d calc_masses(const records::FlexBody& body) {
  if (body.F_I.rows() != body.dof_map.rows() || body.F_I.cols() < 3) return Vector3d::Constant(body.mass);
  Vector3d masses = Vector3d::Zero();
  for (Eigen::Index row = 0; row < body.dof_map.rows(); ++row)
    if (const int code = body.dof_map(row, 1); code >= 1 && code <= 3) masses[code - 1] -= body.F_I(row, code - 1);
  return masses;
}

/// Check that no normal mode is missing and that each is one.
std::string format_modes_check(const records::FlexBody& body, const modal::bases::ModesCheck& check) {
  if (check.num_found == 0) return {};
  const bool is_held = std::find(body.kind.begin(), body.kind.end(), records::ModeKind::Constraint) != body.kind.end();
  const std::string count =
      check.inertia_count < 0
          ? "none, or none to be trusted"
          : fmt::format("{} eigenvalues up to the highest{}, {} found: none missed{}", check.inertia_count,
                        is_held ? " with the interface held" : "", check.num_found,
                        check.inertia_count > check.num_found ? " (the others are copies of the last root)" : "");
  return fmt::format("Sturm count: {}\nlargest residual of a mode: {:.1e}\neigensolver: {}\n", count, check.residual,
                     modal::describe_uses(check.solvers));
}

std::string format_summary(const records::FlexBody& body, const stiffening::BasisCheck& basis,
                           const std::string& output) {
  const Vector3d masses = calc_masses(body);
  Table table{{"mode", "Hz", "rad/s", "mx %", "my %", "mz %"}, {}};
  for (int j = 0; j < body.num_modes(); ++j) {
    std::vector<std::string> row{std::to_string(j + 1), fmt::format("{:.7g}", body.frequency_hz[j]),
                                 fmt::format("{:.7g}", std::sqrt(std::max(0.0, body.eigenvalue[j])))};
    for (int a = 0; a < 3; ++a) {
      row.push_back(fmt::format("{:.2f}", body.effective_mass.size() > 0 && masses[a] > 0
                                              ? 100 * body.effective_mass(j, a) / masses[a]
                                              : 0.0));
    }
    table.rows.push_back(row);
  }
  return fmt::format(
      "body \"{}\": mass {:.8g}, centre of mass ({:.6g}, {:.6g}, {:.6g}), {} nodes\n{}{} locators, "
      "interface nodes: {}\n{}modal matrices against the shapes: mass {:.1e}, stiffness {:.1e}\nwritten: {}\n",
      body.name, body.mass, body.cg.x() + 0.0, body.cg.y() + 0.0, body.cg.z() + 0.0, body.num_nodes(), table.to_text(),
      body.locators.size(),
      body.interface_nodes.empty() ? "none" : fmt::format("{}", fmt::join(body.interface_nodes, " ")),
      format_modes_check(body, basis.modes), basis.mass, basis.stiffness, output);
}

/// Each mode of the body with the most similar one of the others.
Table make_check_table(const records::FlexBody& body, const stiffening::ModeCheck& check) {
  Table table{{"mode", "Hz", "other", "Hz", "difference %", "MAC"}, {}};
  for (int j = 0; j < body.num_modes() && check.mac.cols() > 0; ++j) {
    Eigen::Index other = 0;
    const double mac = check.mac.row(j).maxCoeff(&other);
    const double hz = check.frequency_hz[other];
    table.rows.push_back({std::to_string(j + 1), fmt::format("{:.7g}", body.frequency_hz[j]), std::to_string(other + 1),
                          hz < 0 ? "-" : fmt::format("{:.7g}", hz),
                          hz > 0 ? fmt::format("{:.4f}", 100 * (body.frequency_hz[j] / hz - 1)) : "-",
                          fmt::format("{:.6f}", mac)});
  }
  return table;
}

int run_reduce(const ReduceVerbOptions& o) {
  Console console(o.quiet, o.verbosity);
  console.set_subject(o.file);
  if (!o.file.empty()) analysis::do_once([&] { analysis::demand_file(o.file); });
  Diagnostics diagnostics;
  const auto spec = make_spec(o, diagnostics);
  const auto output = choose_output(o, spec);
  analysis::do_once([&] {
    // A body file may come from anywhere: it does not choose which file of the user's goes.
    if (o.output.empty() && !spec.output_file.empty() && !o.force_outside &&
        !is_inside(output, fs::path(o.file).parent_path().string()))
      throw InputError("cli.output-outside", {o.file},
                       "[body.output] file = \"" + output + "\" does not lie in the folder of the body file",
                       "name the file with -o, or give --force-outside");
    check_outputs(o, {output, o.loads_deck}, {o.file, spec.deck});
  });
  console.set_rank(fe::initialize_petsc().rank);
  stiffening::ReduceOptions options;
  options.progress = [&](const std::string& stage) { console.show_progress("reduce: " + stage); };
  if (!o.solver.empty()) options.solver = modal::find_eps_type(o.solver);
  const auto [body, basis, check] = analysis::reduce_body(spec, options, diagnostics);
  console.end_progress();
  console.print(diagnostics);
  diagnostics.throw_if_errors();
  analysis::do_once([&, &body = body, &basis = basis] {
    hdf5::write_flex_body(body, hdf5::BodyAccuracy{basis.mass, basis.stiffness}, output);
    if (!o.loads_deck.empty()) write_text_file(o.loads_deck, nastran::write_loads_deck(body, o.loads_set));
  });
  if (o.json) {
    nlohmann::json json{{"name", body.name},
                        {"output", output},
                        {"mass", body.mass},
                        {"cg", to_json_list(body.cg)},
                        {"frequency_hz", to_json_list(body.frequency_hz)},
                        {"eigenvalue", to_json_list(body.eigenvalue)},
                        {"effective_mass", to_json(body.effective_mass)},
                        {"interface_nodes", body.interface_nodes},
                        {"num_locators", body.locators.size()},
                        {"accuracy", {{"mass", basis.mass}, {"stiffness", basis.stiffness}}}};
    if (basis.modes.num_found > 0)
      json["modes_check"] = {{"found", basis.modes.num_found},
                             {"inertia_count", basis.modes.inertia_count},
                             {"residual", basis.modes.residual},
                             {"solvers", to_json(basis.modes.solvers)}};
    if (check) json["check"] = {{"frequency_hz", to_json_list(check->frequency_hz)}, {"mac", to_json(check->mac)}};
    console.print_data(json.dump(2) + "\n");
  } else {
    console.print(format_summary(body, basis, output));
    if (!o.loads_deck.empty()) console.print("written: " + o.loads_deck + "\n");
    if (o.integrals_report) console.print("\n" + format_report(SingleReport{body, modal::check_integrals(body)}));
    if (check) console.print("compared with other modes:\n" + make_check_table(body, *check).to_text());
  }
  return kSuccess;
}

}  // namespace

void add_reduce(CLI::App& app, Action& action) {
  auto o = std::make_shared<ReduceVerbOptions>();
  auto* verb = add_verb(app, "reduce", "A deck becomes a flexible body: modes, mass integrals, geometric stiffness");
  verb->add_option("file", o->file, "Body file (.toml) or Nastran deck; may be missing with --matrices");
  verb->add_option("-n,--modes,--number", o->num_modes, "Number of elastic modes")->check(make_positive());
  verb->add_option("--max-hz", o->max_hz, "Highest frequency wanted");
  add_solver_option(*verb, o->solver);
  verb->add_option("--name", o->name, "Name of the body (default: the file's)");
  verb->add_flag("--free", o->free, "Free-free modes: no node carries the frame, SPC sets are left out");
  verb->add_option("--interface", o->interface_nodes,
                   "Grids where hinges or forces attach: six locators each (forces, moments), e.g. 1,41")
      ->delimiter(',');
  verb->add_option(
          "--load", o->loads,
          "Unit loads NODE:DIRECTIONS, a load set set:ID or a temperature set temperature:ID, with K_G; may be "
          "repeated")
      ->allow_extra_args(false);
  verb->add_option("--mass", o->mass, "Mass matrix: deck, lumped or consistent")
      ->check(CLI::IsMember({"deck", "lumped", "consistent"}));
  verb->add_option("--integrals", o->integrals, "Mass integrals that the solver uses: exact, consistent or lumped")
      ->check(CLI::IsMember({"exact", "consistent", "lumped"}));
  verb->add_option("--origin", o->origin, "Origin of the body frame in basic: X Y Z")->expected(3);
  verb->add_option("--damping", o->damping, "Modal damping ratio of every mode")->check(make_not_negative());
  verb->add_option("--subcase", o->subcase, "Subcase whose SPC and MPC sets are used (default: the first)");
  verb->add_option("--ignore", o->ignore_cards,
                   "Leave out this card, command or parameter though it changes the answer")
      ->allow_extra_args(false);
  verb->add_option(
          "--matrices", o->matrices,
          "Matrices of another program instead of the deck's elements: FILE with K and M, or KEY=FILE:NAME with "
          "K, M, B, phi, check, wx2, ...; may be repeated (docs/other-fe-codes.md)")
      ->allow_extra_args(false);
  verb->add_flag("--integrals-report", o->integrals_report,
                 "Print the mass integrals by three methods side by side, as bough compare BODY.h5 does");
  verb->add_flag("--force-outside", o->force_outside,
                 "Write to [body.output] file also outside the body file's folder");
  verb->add_option("--recover", o->recover,
                   "Elements whose forces and stresses the body recovers: ALL, ids, ranges 17-25, property:3, "
                   "card:CBAR; e.g. 17,20-25")
      ->delimiter(',');
  verb->add_flag("--strain-energy", o->strain_energy,
                 "Write the strain energy of each element in the modes too: colours of the report page and of export");
  verb->add_option("--loads-deck", o->loads_deck,
                   "Also write the twelve inertial loads F_I to this file, as FORCE and MOMENT cards for another FE "
                   "program");
  verb->add_option("--loads-set", o->loads_set, "First of the twelve load sets of --loads-deck")
      ->check(CLI::Range(1, 99999988))
      ->capture_default_str();
  verb->add_flag("--full", o->full, "Write the modes and inertial loads of every dof too");
  add_common_options(*verb, *o, kOutput | kJson, "Flexible-body HDF5 file (default: the body file's, else NAME.h5)");
  verb->footer(
      "Example:\n  bough reduce boom.toml\n  bough reduce boom.bdf --modes 3 --interface 41 -o boom.h5\n"
      "  bough reduce boom.bdf --modes 3 --interface 41 --recover 1,20-25 -o boom.h5\n"
      "  bough reduce boom.bdf --matrices boom.op4 --modes 3\n  mpirun -n 2 bough reduce boom.toml");
  verb->callback([&action, o] {
    if (o->file.empty() && o->matrices.empty()) throw CLI::RequiredError("file");
    action = [o] { return analysis::with_file(o->file, [&] { return run_reduce(*o); }); };
  });
}

}  // namespace bough::cli
