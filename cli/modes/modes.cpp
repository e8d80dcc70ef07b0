#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/common/console.hpp"
#include "cli/common/deck_tables.hpp"
#include "cli/common/model_options.hpp"
#include "cli/common/options.hpp"
#include "cli/common/ranks.hpp"
#include "cli/common/solution.hpp"
#include "cli/common/subcase_failures.hpp"
#include "cli/common/text_file.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/common/vtu_file.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/matrices/mass_directions.hpp"
#include "fe/statics/preload.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/records/selection.hpp"
#include "modal/eigen.hpp"
#include "modal/normalize.hpp"
#include "modal/subcases.hpp"

namespace bough::cli {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

struct ModesOptions : CommonOptions {
  std::string deck;
  DeckModelOptions model;
  int number = 0;
  std::optional<double> min_hz, max_hz;
  bool buckling = false;
  bool no_check = false;
  std::string vtu;
};

/// The deck's EIGRL/EIGR of the subcase, overruled by the command line; 10 modes when neither says.
modal::EigenOptions choose_eigen_options(const ModesOptions& options, const records::Deck& deck, int method,
                                         Diagnostics& diagnostics) {
  modal::EigenOptions eigen;
  const auto names = [method](const auto& card) { return method == 0 || card.sid == method; };
  if (method != 0 && std::none_of(deck.eigen_methods.begin(), deck.eigen_methods.end(), names))
    diagnostics.warning("cli.no-method", deck.locate(records::find_selection(deck, "METHOD", method)),
                        fmt::format("METHOD = {} names no EIGRL or EIGR card of the deck", method),
                        "add the card or correct the id; --number, --min-hz and --max-hz go before it");
  eigen.num_modes = 0;
  eigen.check_inertia = !options.no_check;
  for (const auto& card : deck.eigen_methods) {
    if (!names(card)) continue;
    eigen.num_modes = card.num_modes;
    eigen.min_hz = card.f1;
    eigen.max_hz = card.f2;
    if (!options.buckling) {
      // The methods by transformation compute every root; ND then asks for the lowest whatever F1 and F2 say.
      static const std::set<std::string> by_transformation{"GIV", "MGIV", "HOU", "MHOU", "AGIV", "AHOU"};
      if (!card.is_eigrl && card.num_modes > 0 && by_transformation.count(card.method) > 0)
        eigen.min_hz = eigen.max_hz = std::nullopt;
    }
    break;
  }
  if (options.min_hz) eigen.min_hz = options.min_hz;
  if (options.max_hz) eigen.max_hz = options.max_hz;
  if (eigen.min_hz && eigen.max_hz && *eigen.max_hz <= *eigen.min_hz)
    throw InputError("cli.bad-range", {}, fmt::format("the range from {} to {} is empty", *eigen.min_hz, *eigen.max_hz),
                     "give --max-hz above --min-hz; either may also come from the deck's EIGRL");
  if (options.number > 0) eigen.num_modes = options.number;
  if (eigen.num_modes == 0 && !eigen.max_hz) eigen.num_modes = 10;
  return eigen;
}

/// NORM of the deck's card. Throws fe.missing-grid and fe.bad-component where it names no dof.
modal::Norm choose_norm(const records::Deck& deck, int method, const fe::Model& model) {
  for (const auto& card : deck.eigen_methods) {
    if (method != 0 && card.sid != method) continue;
    if (card.norm == "POINT") {
      const std::string who = fmt::format("EIGR {}: NORM = POINT names grid {}", card.sid, card.norm_grid);
      const int node = model.find_node(card.norm_grid);
      if (node < 0)
        throw InputError("fe.missing-grid", deck.locate(card.at), who + ", which the deck does not define",
                         "add the GRID, correct the id, or use NORM = MASS or MAX");
      if (model.node(node).num_dofs == 6 && card.norm_component == 0)
        throw InputError("fe.bad-component", deck.locate(card.at), who + " without a component, expected C = 1 to 6",
                         "name the component");
    }
    return {card.norm, card.norm_grid, card.norm_component};
  }
  return {};
}

records::ModesResult make_result(const fe::Model& model, const modal::EigenPairs& pairs, bool buckling) {
  records::ModesResult result;
  result.subcase = model.subcase().id;
  result.mass_properties = fe::calc_mass_properties(model, model.mass_kind(), Vector3d::Zero());
  const int n = static_cast<int>(pairs.lambda.size());
  std::vector<const fe::Node*> grids;
  for (const auto& node : model.nodes())
    if (node.num_dofs == 6) grids.push_back(&node);
  result.node_xyz.resize(static_cast<Eigen::Index>(grids.size()), 3);
  for (std::size_t k = 0; k < grids.size(); ++k) {
    result.node_id.push_back(grids[k]->id);
    result.node_xyz.row(static_cast<Eigen::Index>(k)) = grids[k]->x.transpose();
    result.phi.push_back(pairs.Phi.middleRows(grids[k]->first_gdof, 6));
  }
  result.residual = pairs.residual;
  result.num_rigid_modes = pairs.num_rigid;
  result.inertia_count = pairs.inertia_count;
  result.mesh = model.calc_mesh();
  if (buckling) {
    result.load_factor = pairs.lambda;
    return result;
  }
  result.eigenvalue = pairs.lambda;
  result.frequency_hz = pairs.lambda.cwiseMax(0.0).cwiseSqrt() / (2 * M_PI);
  result.kind.assign(n, records::ModeKind::Normal);
  const Eigen::MatrixXd M_Phi = fe::calc_mass_times(model, model.mass_kind(), pairs.Phi);
  result.modal_mass = pairs.Phi.cwiseProduct(M_Phi).colwise().sum();
  result.effective_mass = modal::calc_effective_mass(model, pairs.Phi, M_Phi);
  return result;
}

std::string format_modes(const records::ModesResult& r) {
  Table roots{{"mode", "eigenvalue", "rad/s", "Hz", "modal mass", "residual"}, {}};
  Table shares{{"mode", "x", "sum", "y", "sum", "z", "sum", "rx", "ry", "rz"}, {}};
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (int j = 0; j < r.eigenvalue.size(); ++j) {
    const std::string number = std::to_string(j + 1);
    roots.rows.push_back({number, fmt::format("{:.8g}", r.eigenvalue[j]),
                          fmt::format("{:.7g}", 2 * M_PI * r.frequency_hz[j]), fmt::format("{:.7g}", r.frequency_hz[j]),
                          fmt::format("{:.6g}", r.modal_mass[j]), fmt::format("{:.1e}", r.residual[j])});
    std::vector<std::string> row{number};
    for (int a = 0; a < 6; ++a) {
      const double total = r.mass_properties.rigid_mass(a, a);
      const double share = total > 0 ? 100 * r.effective_mass(j, a) / total : 0;
      row.push_back(fmt::format("{:.2f}", share));
      if (a < 3) row.push_back(fmt::format("{:.2f}", sum[a] += share));
    }
    shares.rows.push_back(std::move(row));
  }
  return roots.to_text() + "\neffective mass, % of the mass and of the inertia about the origin\n" + shares.to_text();
}

std::string format_buckling(const records::ModesResult& r) {
  Table table{{"mode", "load factor", "residual"}, {}};
  for (int j = 0; j < r.load_factor.size(); ++j) {
    table.rows.push_back(
        {std::to_string(j + 1), fmt::format("{:.8g}", r.load_factor[j]), fmt::format("{:.1e}", r.residual[j])});
  }
  return table.to_text();
}

std::string format_health(const records::ModesResult& r, const std::string& norm, bool buckling) {
  const auto n = r.residual.size();
  std::string text = buckling ? "" : fmt::format("rigid-body modes: {}\n", r.num_rigid_modes);
  if (norm == "MAX" || norm == "POINT")
    text += fmt::format("shapes: {} (NORM = {} of the deck){}\n",
                        norm == "MAX" ? "the largest component is 1" : "one dof is 1", norm,
                        buckling ? "" : "; modal mass and stiffness go with them");
  // A missed mode is an error of modal (modal.missed-modes); what the count has more is below the range or a copy.
  const char* what = buckling ? "load factors" : "eigenvalues";
  if (n == 0) return text + fmt::format("no {} in the range asked for\n", what);
  if (r.inertia_count >= 0) {
    text +=
        fmt::format("Sturm count: {} {} up to the highest, {} in the table: none missed{}\n", r.inertia_count, what, n,
                    r.inertia_count <= n ? ""
                    : buckling           ? " (the others are farther from zero, below the range or copies of the last)"
                                         : " (the others are below the range or copies of the last root)");
  } else {
    text += "Sturm count: none, or none to be trusted\n";
  }
  if (n > 0) text += fmt::format("largest residual: {:.1e}\n", r.residual.maxCoeff());
  return text;
}

nlohmann::json make_json(const records::ModesResult& r, const std::string& norm, bool buckling) {
  nlohmann::json json{{"subcase", r.subcase},
                      {"mass_properties", to_json(r.mass_properties)},
                      {"num_rigid_modes", r.num_rigid_modes},
                      {"inertia_count", r.inertia_count},
                      {"norm", norm},
                      {"residual", to_json_list(r.residual)}};
  if (buckling) {
    json["load_factor"] = to_json_list(r.load_factor);
    return json;
  }
  json["eigenvalue"] = to_json_list(r.eigenvalue);
  json["frequency_hz"] = to_json_list(r.frequency_hz);
  json["modal_mass"] = to_json_list(r.modal_mass);
  json["effective_mass"] = to_json(r.effective_mass);
  return json;
}

modal::EigenPairs solve(const ModesOptions& options, const records::Deck& deck, fe::Model& model, Console& console,
                        Diagnostics& diagnostics) {
  auto eigen = choose_eigen_options(options, deck, model.subcase().method, diagnostics);
  eigen.progress = [&](int converged, int wanted) {
    console.show_progress(fmt::format("modes: {} of {} converged", converged, wanted));
  };
  return modal::calc_normal_modes(model, eigen, diagnostics);
}

/// One table of the verb: the subcase whose constraints hold, and with --buckling its load.
struct Task {
  int subcase = 0;
  std::optional<modal::BucklingCases> buckling;
};

std::vector<Task> choose_tasks(const ModesOptions& options, const records::Deck& deck) {
  std::vector<Task> chosen;
  if (options.buckling) {
    for (const auto& cases : modal::list_buckling_cases(deck, options.model.subcase)) {
      const bool is_held = cases.buckling.spc != 0 || cases.buckling.mpc != 0;
      chosen.push_back({is_held ? cases.buckling.id : cases.statics.id, cases});
    }
    return chosen;
  }
  if (options.model.subcase != 0) return {{options.model.subcase, {}}};
  for (const int id : modal::list_mode_subcases(deck)) chosen.push_back({id, {}});
  return chosen;
}

/// "boom.h5" is "boom-subcase-2.h5" for a subcase after the first.
std::string name_output(const std::string& path, int subcase, bool is_first) {
  if (path.empty() || is_first) return path;
  const std::filesystem::path p(path);
  return (p.parent_path() / (p.stem().string() + fmt::format("-subcase-{}", subcase) + p.extension().string()))
      .string();
}

struct Solved {
  records::ModesResult result;
  std::string norm;
};

Solved solve_task(const ModesOptions& options, const records::Deck& deck, const Task& task,
                  fe::ModelOptions model_options, Console& console, Diagnostics& diagnostics) {
  model_options.prestress =
      task.buckling
          ? fe::calc_subcase_prestress(deck, model_options, modal::get_preloaded(deck, *task.buckling), diagnostics)
          : calc_prestress(deck, model_options, diagnostics);
  auto model = fe::Model::build(deck, model_options, diagnostics);
  diagnostics.throw_if_errors();
  if (fe::has_damping(model))
    diagnostics.note("fe.damping-unused", deck.locate({}),
                     "the dampers of the deck do not act on its modes, as in SOL 103",
                     "bough reduce adds them to the modal damping");
  const auto norm = choose_norm(deck, task.buckling ? task.buckling->buckling.method : model.subcase().method, model);
  auto pairs = task.buckling
                   ? modal::solve_buckling(
                         deck, *task.buckling, model_options, model,
                         choose_eigen_options(options, deck, task.buckling->buckling.method, diagnostics), diagnostics)
                   : solve(options, deck, model, console, diagnostics);
  console.end_progress();
  if (!options.buckling)
    fe::report_mass(model, deck, fe::calc_mass_properties(model, model.mass_kind(), Vector3d::Zero()), diagnostics);
  modal::normalize(model, norm, pairs.Phi, diagnostics);
  return {make_result(model, pairs, options.buckling), norm.kind};
}

int run_modes(const ModesOptions& options) {
  Console console(options.quiet, options.verbosity);
  console.set_subject(options.deck);
  do_once([&] {
    demand_deck(options.deck);
    check_outputs(options, {options.output, options.vtu}, {options.deck});
  });
  console.set_rank(fe::initialize_petsc().rank);

  Diagnostics diagnostics;
  auto model_options = make_model_options(options.model);
  model_options.uses_enforced = options.buckling;
  const auto deck = read_deck_or_throw(options.deck, model_options, diagnostics);
  const auto sources = calc_sources(deck.files);
  std::vector<Task> tasks;
  say_first(diagnostics, [&] { tasks = choose_tasks(options, deck); });
  if (modal::is_buckling_solution(deck) && !options.buckling)
    diagnostics.note("cli.buckling-deck", deck.locate({}), "the deck asks for buckling (SOL " + deck.sol + ")",
                     "these are its normal modes; --buckling gives the load factors");
  note_solution(deck, diagnostics);
  nlohmann::json json;
  std::string text, written;
  std::vector<std::pair<std::string, std::string>> pictures;
  SubcaseFailures failures(tasks.size(), deck.subcases.size());
  bool is_first = true;
  for (const auto& task : tasks) {
    Diagnostics own;
    Solved solved;
    try {
      model_options.subcase = task.subcase;
      solved = solve_task(options, deck, task, model_options, console, own);
    } catch (const Failure& failure) {
      console.end_progress();
      failures.add(task.buckling ? task.buckling->buckling.id : task.subcase, failure);
      continue;
    }
    auto& [result, norm] = solved;
    result.source = sources;
    if (task.buckling && tasks.size() > 1) result.subcase = task.buckling->buckling.id;
    const auto vtu = name_output(options.vtu, result.subcase, is_first);
    if (!vtu.empty() && console.is_root())
      pictures.emplace_back(
          vtu, make_vtu_text(exports::make_picture(result), exports::VtuEncoding::Base64, options.deck, own));
    add_new(own, diagnostics);
    if (tasks.size() > 1) text += fmt::format("{}subcase {}\n\n", is_first ? "" : "\n", result.subcase);
    if (task.buckling) text += modal::describe_load(task.buckling->statics) + "\n\n";
    text += (options.buckling ? format_buckling(result) : format_modes(result)) + "\n" +
            format_health(result, norm, options.buckling);
    if (is_first) json = make_json(result, norm, options.buckling);
    if (tasks.size() > 1) json["subcases"].push_back(make_json(result, norm, options.buckling));
    const auto output = name_output(options.output, result.subcase, is_first);
    is_first = false;
    if (output.empty()) continue;
    do_once([&] {
      check_outputs(options, {output, options.vtu, vtu == options.vtu ? "" : vtu}, {options.deck});
      hdf5::write_modes(result, output);
    });
    written += "written: " + output + "\n";
  }
  if (is_first) failures.throw_all(diagnostics);
  if (!failures.is_empty()) json["failed"] = failures.to_json();
  console.print(diagnostics);
  console.print(failures.get_items(diagnostics));
  if (options.json)
    console.print_data(json.dump(2) + "\n");
  else
    console.print(text);
  do_once([&] {
    for (const auto& [path, picture] : pictures) write_text_file(path, picture);
  });
  for (const auto& [path, picture] : pictures) written += "written: " + path + "\n";
  if (!options.json) console.print(written);
  // A rank that ends with an error ends the others: the first one must be through.
  do_once([] { flush_data(); });
  return failures.get_exit_code();
}

}  // namespace

void add_modes(CLI::App& app, Action& action) {
  auto o = std::make_shared<ModesOptions>();
  auto* verb = app.add_subcommand("modes", "Normal modes (SOL 103) or buckling load factors (SOL 105) of a deck");
  verb->add_option("deck", o->deck, "Nastran deck")->required();
  verb->add_option("-n,--number,--modes", o->number, "Number of modes (default: the deck's EIGRL, else 10)")
      ->check(make_positive());
  verb->add_option("--min-hz", o->min_hz, "Lowest frequency wanted (with --buckling: load factor)");
  verb->add_option("--max-hz", o->max_hz, "Highest frequency wanted (with --buckling: load factor)");
  verb->add_flag("--buckling", o->buckling, "Load factors of the static subcase instead of normal modes");
  verb->add_flag("--no-check", o->no_check, "Leave out the count of eigenvalues that proves that no mode was missed");
  verb->add_option("--vtu", o->vtu, "Write the mode shapes to this file for ParaView");
  add_model_options(*verb, o->model);
  add_common_options(*verb, *o, kOutput | kJson, "Write the modes to this HDF5 file");
  verb->footer(
      "Example:\n  bough modes boom.bdf --number 6 -o boom-modes.h5 --vtu boom.vtu\n"
      "  bough modes column.bdf --buckling\n"
      "  mpirun -n 2 bough modes boom.bdf");
  verb->callback([&action, o] { action = [o] { return blame(o->deck, [&] { return run_modes(*o); }); }; });
}

}  // namespace bough::cli
