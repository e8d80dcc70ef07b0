#include "stiffening/reduce.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/output_folder.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/system_files.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/reduce/reduce_body.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/deck_tables.hpp"
#include "cli/common/number_checks.hpp"
#include "cli/common/options.hpp"
#include "cli/common/solver_option.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/compare/compare_report.hpp"
#include "formats/hdf5/body_accuracy.hpp"
#include "formats/nastran/loads_deck.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

struct ReduceVerbOptions : CommonOptions {
  analysis::ReduceRequest request;
  bool integrals_report = false, force_outside = false;
  std::string loads_deck;
  int loads_set = nastran::kFirstInertialSet;
};

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
  const auto& file = o.request.file;
  console.set_subject(file);
  std::string output;
  const auto check_spec = [&](const records::BodySpec& spec) {
    output = choose_output(o, spec);
    analysis::do_once([&] {
      // A body file may come from anywhere: it does not choose which file of the user's goes.
      if (o.output.empty() && !spec.output_file.empty() && !o.force_outside &&
          !analysis::is_inside(output, fs::path(file).parent_path().string()))
        throw InputError("cli.output-outside", {file},
                         "[body.output] file = \"" + output + "\" does not lie in the folder of the body file",
                         "name the file with -o, or give --force-outside");
      check_outputs(o, {output, o.loads_deck}, {file, spec.deck});
    });
    console.set_rank(linear::initialize_petsc().rank);
  };
  ConsoleEvents events(console);
  const auto [body, basis, check] = analysis::reduce_body(o.request, check_spec, events);
  console.print(events.get_messages());
  analysis::do_once([&, &body = body, &basis = basis] {
    hdf5::write_flex_body(body, hdf5::BodyAccuracy{basis.mass, basis.stiffness}, output);
    if (!o.loads_deck.empty()) analysis::write_text_file(o.loads_deck, nastran::write_loads_deck(body, o.loads_set));
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
    if (o.integrals_report) console.print("\n" + format_report(analysis::check_integrals(body)));
    if (check) console.print("compared with other modes:\n" + make_check_table(body, *check).to_text());
  }
  return kSuccess;
}

}  // namespace

void add_reduce(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb<ReduceVerbOptions>(app, "reduce");
  verb->add_option("file", o->request.file, "Body file (.toml) or Nastran deck; may be missing with --matrices");
  verb->add_option("-n,--modes,--number", o->request.num_modes, "Number of elastic modes")->check(make_positive());
  verb->add_option("--max-hz", o->request.max_hz, "Highest frequency wanted")->check(make_positive());
  add_solver_option(*verb, o->request.solver);
  verb->add_option("--name", o->request.name, "Name of the body (default: the file's)");
  verb->add_flag("--free", o->request.free, "Free-free modes: no node carries the frame, SPC sets are left out");
  verb->add_option("--interface", o->request.interface_nodes,
                   "Grids where hinges or forces attach: six locators each (forces, moments), e.g. 1,41")
      ->delimiter(',');
  verb->add_option(
          "--load", o->request.loads,
          "Unit loads NODE:DIRECTIONS, a load set set:ID or a temperature set temperature:ID, with K_G; may be "
          "repeated")
      ->allow_extra_args(false);
  verb->add_option("--mass", o->request.mass, "Mass matrix: deck, lumped or consistent")
      ->check(CLI::IsMember({"deck", "lumped", "consistent"}));
  verb->add_option("--integrals", o->request.integrals,
                   "Mass integrals that the solver uses: exact, consistent or lumped")
      ->check(CLI::IsMember({"exact", "consistent", "lumped"}));
  verb->add_option("--origin", o->request.origin, "Origin of the body frame in basic: X Y Z")
      ->expected(3)
      ->check(make_finite());
  verb->add_option("--damping", o->request.damping, "Modal damping ratio of every mode")->check(make_not_negative());
  verb->add_option("--subcase", o->request.subcase, "Subcase whose SPC and MPC sets are used (default: the first)");
  verb->add_option("--ignore", o->request.ignore_cards,
                   "Leave out this card, command or parameter though it changes the answer")
      ->allow_extra_args(false);
  verb->add_option(
          "--matrices", o->request.matrices,
          "Matrices of another program instead of the deck's elements: FILE with K and M, or KEY=FILE:NAME with "
          "K, M, B, phi, check, wx2, ...; may be repeated (docs/other-fe-codes.md)")
      ->allow_extra_args(false);
  verb->add_flag("--integrals-report", o->integrals_report,
                 "Print the mass integrals by three methods side by side, as bough compare BODY.h5 does");
  verb->add_flag("--force-outside", o->force_outside,
                 "Write to [body.output] file also outside the body file's folder");
  verb->add_option("--recover", o->request.recover,
                   "Elements whose forces and stresses the body recovers: ALL, ids, ranges 17-25, property:3, "
                   "card:CBAR; e.g. 17,20-25")
      ->delimiter(',');
  verb->add_flag("--strain-energy", o->request.strain_energy,
                 "Write the strain energy of each element in the modes too: colours of the report page and of export");
  verb->add_option("--loads-deck", o->loads_deck,
                   "Also write the twelve inertial loads F_I to this file, as FORCE and MOMENT cards for another FE "
                   "program");
  verb->add_option("--loads-set", o->loads_set, "First of the twelve load sets of --loads-deck")
      ->check(is_within(1, 99999988))
      ->capture_default_str();
  verb->add_flag_callback(
      "--full", [o = o] { o->request.full = true; }, "Write the modes and inertial loads of every dof too");
  add_common_options(*verb, *o, kOutput | kJson, "Flexible-body HDF5 file (default: the body file's, else NAME.h5)");
  verb->callback([&action, o = o] {
    if (o->request.file.empty() && o->request.matrices.empty()) throw CLI::RequiredError("file");
    action = [o] { return analysis::with_file(o->request.file, [&] { return run_reduce(*o); }); };
  });
}

}  // namespace bough::cli
