#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/model_choice.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/solution.hpp"
#include "analysis/common/subcase_failures.hpp"
#include "analysis/listing/listing.hpp"
#include "cli/common/console.hpp"
#include "cli/common/deck_tables.hpp"
#include "cli/common/model_options.hpp"
#include "cli/common/options.hpp"
#include "cli/common/solver_option.hpp"
#include "cli/common/text_file.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/common/vtu_file.hpp"
#include "cli/compare/compare_report.hpp"
#include "cli/modes/complex_modes.hpp"
#include "cli/modes/modes_options.hpp"
#include "cli/modes/modes_tables.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/matrices/mass_directions.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/preload.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/records/selection.hpp"
#include "modal/eigen.hpp"
#include "modal/modes_result.hpp"
#include "modal/normalize.hpp"
#include "modal/response/residual_modes.hpp"
#include "modal/subcases.hpp"

namespace bough::cli {

using Eigen::Vector3d;

namespace {

modal::EigenPairs solve(const ModesOptions& options, const records::Deck& deck, fe::Model& model, Console& console,
                        Diagnostics& diagnostics) {
  auto eigen = analysis::choose_eigen_options(options.eigen, deck, model.subcase().method, diagnostics);
  eigen.progress = [&](int converged, int requested) {
    console.show_progress(fmt::format("modes: {} of {} converged", converged, requested));
  };
  auto pairs = modal::calc_normal_modes(model, eigen, diagnostics);
  analysis::note_method_number(options.eigen, deck, model.subcase().method, static_cast<int>(pairs.lambda.size()),
                               diagnostics);
  return pairs;
}

/// One table of the verb: the subcase whose constraints hold, and with --buckling its load.
struct Task {
  int subcase = 0;
  std::optional<modal::BucklingCases> buckling;
};

std::vector<Task> choose_tasks(const ModesOptions& options, const records::Deck& deck) {
  std::vector<Task> chosen;
  if (options.eigen.buckling) {
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

struct Solved {
  records::ModesResult result;
  std::string norm;
  std::vector<modal::SolverUse> solvers;
  std::vector<std::string> loads, unused;  ///< of the residual vectors; loads that brought none
};

/// The modes of `model`; with `selection` also the residual vectors of the loads.
modal::EigenPairs solve_with_residuals(const ModesOptions& options, const records::DynamicDeck& deck,
                                       const records::DynamicSelection& selection, fe::Model& model, Solved& solved,
                                       int& num_residual, Console& console, Diagnostics& diagnostics) {
  const fe::System system(model);
  auto eigen = analysis::choose_eigen_options(options.eigen, deck, model.subcase().method, diagnostics);
  eigen.progress = [&](int converged, int requested) {
    console.show_progress(fmt::format("modes: {} of {} converged", converged, requested));
  };
  auto pairs = modal::calc_normal_modes(system, eigen, diagnostics);
  analysis::note_method_number(options.eigen, deck, model.subcase().method, static_cast<int>(pairs.lambda.size()),
                               diagnostics);
  const auto loads = modal::response::collect_residual_loads(
      model, deck, records::DynamicSubcase(model.subcase(), selection), diagnostics);
  diagnostics.throw_if_errors();
  const auto before = pairs.lambda.size();
  solved.unused = modal::response::append_residual_vectors(system, loads, pairs);
  solved.loads = loads.name;
  num_residual = static_cast<int>(pairs.lambda.size() - before);
  return pairs;
}

Solved solve_task(const ModesOptions& options, const records::DynamicDeck& deck, const records::CaseRequests& requests,
                  const Task& task, fe::ModelOptions model_options, analysis::ListingMaker* listing, Console& console,
                  Diagnostics& diagnostics) {
  model_options.prestress =
      task.buckling
          ? fe::calc_subcase_prestress(deck, model_options, modal::get_preloaded(deck, *task.buckling), diagnostics)
          : analysis::calc_prestress(deck, model_options, diagnostics);
  auto model = fe::build_model(deck, model_options, diagnostics);
  diagnostics.throw_if_errors();
  if (fe::has_damping(model))
    diagnostics.note("fe.damping-unused", deck.locate({}),
                     "the dampers of the deck do not act on its modes, as in SOL 103",
                     "bough reduce adds them to the modal damping");
  const auto norm =
      analysis::choose_norm(deck, task.buckling ? task.buckling->buckling.method : model.subcase().method, model);
  Solved solved;
  int num_residual = 0;
  const auto* selection = analysis::find_selection(requests, model.subcase().id);
  const bool has_residuals = !task.buckling && selection && modal::response::asks_residual_vectors(deck, *selection);
  auto pairs =
      has_residuals ? solve_with_residuals(options, deck, *selection, model, solved, num_residual, console, diagnostics)
      : task.buckling ? modal::solve_buckling(deck, *task.buckling, model_options, model,
                                              analysis::choose_eigen_options(
                                                  options.eigen, deck, task.buckling->buckling.method, diagnostics),
                                              diagnostics)
                      : solve(options, deck, model, console, diagnostics);
  console.end_progress();
  const auto mass = fe::calc_mass_properties(model, model.mass_kind(), Vector3d::Zero());
  if (!options.eigen.buckling) fe::report_mass(model, deck, mass, diagnostics);
  modal::normalize(model, norm, pairs.Phi, diagnostics);
  if (norm.kind != "MASS") pairs.modal_mass.resize(0);
  if (!task.buckling) pairs = modal::sort_negative(std::move(pairs));
  if (listing) {
    listing->add_weight(model);
    listing->add_modes(model, pairs, num_residual, diagnostics);
  }
  modal::ModesExtras extras{options.energies ? &deck : nullptr, options.about_grid};
  if (extras.about_grid == 0 && !options.eigen.buckling && selection)
    extras.about_grid = selection->effective_mass_grid.value_or(0);
  extras.mass = &mass;
  extras.has_shapes = !options.output.empty() || !options.vtu.empty() || !options.compare.empty();
  solved.result = modal::make_modes_result(model, pairs, options.eigen.buckling, extras);
  solved.norm = norm.kind;
  solved.solvers = pairs.solvers;
  std::fill_n(solved.result.kind.end() - num_residual, num_residual, records::ModeKind::Residual);
  return solved;
}

/// The cards of loads over frequency and time, too, where residual vectors are asked for.
records::DynamicDeck read_modes_deck(const ModesOptions& options, const records::CaseRequests& requests,
                                     const fe::ModelOptions& model_options, Diagnostics& diagnostics) {
  Diagnostics own;
  records::DynamicDeck deck;
  static_cast<records::Deck&>(deck) = analysis::read_deck_or_throw(options.deck, model_options, own);
  const bool has_residuals = std::any_of(
      requests.selections.begin(), requests.selections.end(),
      [&](const auto& selection) { return modal::response::asks_residual_vectors(deck, selection.second); });
  if (has_residuals && !options.eigen.buckling)
    return analysis::read_loads_deck_or_throw(options.deck, model_options, false, diagnostics);
  for (const auto& item : own.items()) diagnostics.add(item);
  return deck;
}

int run_modes(const ModesOptions& options) {
  Console console(options.quiet, options.verbosity);
  console.set_subject(options.deck);
  analysis::do_once([&] {
    analysis::demand_deck(options.deck);
    check_outputs(options, {options.output, options.vtu, options.listing.f06, options.listing.op2},
                  {options.deck, options.compare});
    if (!options.compare.empty()) analysis::demand_file(options.compare);
  });
  console.set_rank(fe::initialize_petsc().rank);

  Diagnostics diagnostics;
  auto model_options = analysis::make_model_options(options.model);
  model_options.uses_enforced = options.eigen.buckling;
  Diagnostics of_combinations;  // of static results, which are not made here
  const auto requests = analysis::read_requests_once(options.deck, of_combinations);
  const auto deck = read_modes_deck(options, requests, model_options, diagnostics);
  const auto sources = analysis::calc_sources(deck.files);
  std::vector<Task> tasks;
  analysis::with_prior_messages(diagnostics, [&] { tasks = choose_tasks(options, deck); });
  if (modal::is_buckling_solution(deck) && !options.eigen.buckling)
    diagnostics.note("cli.buckling-deck", deck.locate({}), "the deck asks for buckling (SOL " + deck.sol + ")",
                     "these are its normal modes; --buckling gives the load factors");
  if (!options.eigen.buckling && analysis::asks_complex_modes(deck, model_options.ignore_cards)) {
    std::vector<int> subcases;
    for (const auto& task : tasks) subcases.push_back(task.subcase);
    return run_complex_modes(options, subcases, console);
  }
  analysis::note_solution(deck, diagnostics);
  nlohmann::json json;
  std::string text, written;
  std::vector<std::pair<std::string, std::string>> pictures;
  analysis::SubcaseFailures failures(tasks.size(), deck.subcases.size());
  bool is_first = true;
  std::optional<analysis::ListingMaker> listing;
  if (!options.listing.empty()) listing.emplace(deck, requests, diagnostics);
  if (!listing && !options.energies)
    analysis::note_requests(deck, requests, {{"ESE", "--f06 FILE, or --ese,"}}, diagnostics);
  diagnostics.throw_if_errors();
  for (const auto& task : tasks) {
    Diagnostics own;
    Solved solved;
    try {
      model_options.subcase = task.subcase;
      solved = solve_task(options, deck, requests, task, model_options, listing ? &*listing : nullptr, console, own);
    } catch (const Failure& failure) {
      console.end_progress();
      failures.add(task.buckling ? task.buckling->buckling.id : task.subcase, failure);
      analysis::add_warnings(own, diagnostics);
      continue;
    }
    auto& result = solved.result;
    const auto& norm = solved.norm;
    result.source = sources;
    if (task.buckling && tasks.size() > 1) result.subcase = task.buckling->buckling.id;
    const auto vtu = name_output(options.vtu, result.subcase, is_first);
    if (!vtu.empty() && console.is_root())
      pictures.emplace_back(
          vtu, make_vtu_text(exports::make_picture(result), exports::VtuEncoding::Base64, options.deck, own));
    analysis::add_new(own, diagnostics);
    if (tasks.size() > 1) text += fmt::format("{}subcase {}\n\n", is_first ? "" : "\n", result.subcase);
    if (task.buckling) text += modal::describe_load(task.buckling->statics) + "\n\n";
    text += (options.eigen.buckling ? format_buckling(result) : format_modes(result)) + "\n" +
            format_health(result, solved.solvers, norm, options.eigen.buckling) +
            format_residual_vectors(result, solved.loads, solved.unused);
    text += format_effective_mass_about(result) + format_energies(result);
    auto one = make_json(result, solved.solvers, norm, options.eigen.buckling);
    if (!solved.loads.empty()) one["residual_vectors"] = {{"loads", solved.loads}, {"unused", solved.unused}};
    if (!options.compare.empty() && console.is_root()) {
      Diagnostics of_other;
      const auto pair = compare_models(options.deck, modal::ModalModel::from(result), options.compare,
                                       load_model(options.compare, of_other));
      if (is_first) console.print(of_other);
      text += "\n" + format_report(pair);
      one["comparison"] = make_json(pair);
    }
    if (is_first) json = one;
    if (tasks.size() > 1) json["subcases"].push_back(one);
    const auto output = name_output(options.output, result.subcase, is_first);
    is_first = false;
    if (output.empty()) continue;
    analysis::do_once([&] {
      check_outputs(options, {output, options.vtu, vtu == options.vtu ? "" : vtu}, {options.deck});
      hdf5::write_modes(result, output);
    });
    written += "written: " + output + "\n";
  }
  if (is_first) failures.throw_all(diagnostics);
  if (!failures.is_empty()) json["failed"] = to_json(failures);
  console.print(diagnostics);
  console.print(failures.get_items(diagnostics));
  if (options.json)
    console.print_data(json.dump(2) + "\n");
  else
    console.print(text);
  analysis::do_once([&] {
    for (const auto& [path, picture] : pictures) write_text_file(path, picture);
    if (listing) write_listings(options.listing, listing->get());
  });
  for (const auto& path : {options.listing.f06, options.listing.op2})
    if (!path.empty()) written += "written: " + path + "\n";
  for (const auto& [path, picture] : pictures) written += "written: " + path + "\n";
  if (!options.json) console.print(written);
  // A rank that ends with an error ends the others: the first one must be through.
  analysis::do_once([] { flush_data(); });
  return failures.get_exit_code();
}

}  // namespace

std::string name_output(const std::string& path, int subcase, bool is_first) {
  if (path.empty() || is_first) return path;
  const std::filesystem::path p(path);
  return (p.parent_path() / (p.stem().string() + fmt::format("-subcase-{}", subcase) + p.extension().string()))
      .string();
}

void add_modes(CLI::App& app, Action& action) {
  auto o = std::make_shared<ModesOptions>();
  auto* verb =
      add_verb(app, "modes",
               "Normal modes (SOL 103), complex modes (SOL 107, 110) or buckling load factors (SOL 105) of a deck");
  verb->add_option("deck", o->deck, "Nastran deck")->required();
  verb->add_option("-n,--number,--modes", o->eigen.number,
                   "Number of modes (default: the deck's EIGRL or EIGC, else 10)")
      ->check(make_positive());
  verb->add_option("--min-hz", o->eigen.min_hz, "Lowest frequency wanted (with --buckling: load factor)");
  verb->add_option("--max-hz", o->eigen.max_hz, "Highest frequency wanted (with --buckling: load factor)");
  auto* buckling =
      verb->add_flag("--buckling", o->eigen.buckling, "Load factors of the static subcase instead of normal modes");
  verb->add_flag("--no-check", o->eigen.no_check,
                 "Leave out the count of eigenvalues that proves that no mode was missed");
  add_solver_option(*verb, o->eigen.solver);
  verb->add_flag("--ese,--energies", o->energies,
                 "Strain and kinetic energy of elements and properties in each mode: table, HDF5, VTU")
      ->excludes(buckling);
  verb->add_option("--meffmass", o->about_grid, "Effective masses in units of mass, about this grid")
      ->excludes(buckling)
      ->check(make_positive());
  verb->add_option("--compare", o->compare, "Modes file or flexible body: the modes side by side with it, with MAC");
  verb->add_option("--vtu", o->vtu, "Write the mode shapes to this file for ParaView");
  add_listing_options(*verb, o->listing);
  verb->get_option("--f06")->excludes(buckling);
  verb->get_option("--op2")->excludes(buckling);
  add_model_options(*verb, o->model);
  add_common_options(*verb, *o, kOutput | kJson, "Write the modes to this HDF5 file");
  verb->footer(
      "Example:\n  bough modes boom.bdf --number 6 -o boom-modes.h5 --vtu boom.vtu\n"
      "  bough modes column.bdf --buckling\n  bough modes boom.bdf --ese --compare boom.h5\n"
      "  mpirun -n 2 bough modes boom.bdf");
  verb->callback(
      [&action, o] { action = [o] { return analysis::with_file(o->deck, [&] { return run_modes(*o); }); }; });
}

}  // namespace bough::cli
