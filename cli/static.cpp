#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "console.hpp"
#include "fe/statics/preload.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/hdf5/files.hpp"
#include "model_options.hpp"
#include "options.hpp"
#include "ranks.hpp"
#include "solution.hpp"
#include "static_tables.hpp"
#include "subcase_failures.hpp"
#include "text_file.hpp"
#include "vtu_file.hpp"

namespace bough::cli {

using Eigen::VectorXd;

namespace {

struct StaticOptions : CommonOptions {
  std::string deck, vtu;
  DeckModelOptions model;
  bool full = false, in_cd = false, is_linear = false;
};

/// The subcases with a load, temperatures, or with displacements that their SPC set enforces; the one asked for in any
/// case.
std::vector<records::Subcase> choose_subcases(const records::Deck& deck, int asked) {
  const auto enforces = [&](int set) {
    return set != 0 && std::any_of(deck.spc.begin(), deck.spc.end(), [](const auto& spc) { return spc.d != 0; });
  };
  const auto is_loaded = [&](const records::Subcase& s) {
    return s.load != 0 || s.temperature != 0 || enforces(s.spc);
  };
  std::vector<records::Subcase> chosen;
  for (const auto& subcase : deck.subcases)
    if (asked != 0 ? subcase.id == asked : is_loaded(subcase)) chosen.push_back(subcase);
  const bool has_load = std::any_of(chosen.begin(), chosen.end(), is_loaded);
  if (has_load || (asked != 0 && chosen.empty())) return chosen;
  throw InputError("cli.no-static-load", {deck.files.empty() ? std::string{} : deck.files[0]},
                   "a static solution needs a subcase with LOAD or TEMPERATURE(LOAD), found none",
                   "write LOAD = n in the case control");
}

/// Solves subcases one after the other; model and factor are kept while the constraints stay the same.
class CaseSolver {
 public:
  CaseSolver(const records::Deck& deck, const DeckModelOptions& options)
      : deck_(deck), model_options_(make_model_options(options)) {
    model_options_.uses_enforced = true;
  }

  /// Throws what is wrong with this subcase alone; warnings are added to `diagnostics`.
  records::StaticSubcase solve(const records::Subcase& subcase, Diagnostics& diagnostics) {
    prepare(subcase, diagnostics);
    Diagnostics own;
    const auto load = fe::calc_static_load(*model_, deck_, subcase, own);
    own.throw_if_errors();
    auto solved = fe::solve_static_case(*model_, *solver_, load, suport_, &own);
    solved.id = subcase.id;
    solved.label = subcase.label.empty() ? subcase.subtitle : subcase.label;
    solved.load_set = subcase.load;
    solved.temperature_set = subcase.temperature;
    solved.spc_set = subcase.spc;
    solved.mpc_set = subcase.mpc;
    solved.elements = fe::calc_element_forces(*model_, solved.displacement, deck_, subcase.load, own, load.initial);
    add_new(own, diagnostics);
    return solved;
  }

  const fe::Model& model() const { return *model_; }

 private:
  void prepare(const records::Subcase& subcase, Diagnostics& diagnostics) {
    const std::array<int, 4> held{subcase.spc, subcase.mpc, subcase.suport1, subcase.preload};
    if (held_ == held && (!model_ || model_->is_held_for(deck_, subcase.load))) {
      if (failure_) std::rethrow_exception(failure_);
      return;
    }
    held_ = held;
    failure_ = nullptr;
    solver_.reset();
    try {
      Diagnostics own;
      model_options_.subcase = subcase.id;
      model_options_.prestress = nullptr;
      model_options_.prestress = fe::calc_subcase_prestress(deck_, model_options_, subcase, own);
      auto model = fe::Model::build(deck_, model_options_, own);
      const auto relief = fe::read_inertia_relief(deck_, own);
      auto fdofs = fe::choose_suport(model, deck_, relief, own);
      own.throw_if_errors();
      auto solver = model.num_fdofs() == 0 ? std::make_unique<fe::StaticSolver>(model)
                                           : std::make_unique<fe::StaticSolver>(
                                                 model, fe::assemble_stiffness(model, fe::DofSet::Free), fdofs);
      suport_ = fe::calc_suport(model, *solver, std::move(fdofs), relief, own);
      model_.emplace(std::move(model));
      solver_ = std::move(solver);
      add_new(own, diagnostics);
    } catch (const Failure&) {
      failure_ = std::current_exception();
      throw;
    }
  }

  const records::Deck& deck_;
  fe::ModelOptions model_options_;
  std::optional<std::array<int, 4>> held_;  ///< SPC, MPC, SUPORT1 and preload of what is kept
  std::exception_ptr failure_;              ///< what came of them
  std::optional<fe::Model> model_;
  std::unique_ptr<fe::StaticSolver> solver_;
  fe::Suport suport_;
};

/// Vectors in the displacement axes of their grids, as other programs print them.
records::StaticResult turn_to_cd(const fe::Model& model, records::StaticResult result) {
  for (auto& s : result.subcases)
    for (VectorXd* v : {&s.displacement, &s.load, &s.reaction, &s.mpc_force, &s.inertia})
      for (const auto& node : model.nodes())
        for (int i = 0; i < node.num_dofs / 3 && v->size() > 0; ++i) {
          auto part = v->segment<3>(node.first_gdof + 3 * i);
          part = (node.R_basic_cd.transpose() * part).eval();
        }
  return result;
}

int run_static(const StaticOptions& options) {
  Console console(options.quiet, options.verbosity);
  console.set_subject(options.deck);
  do_once([&] {
    demand_deck(options.deck);
    check_outputs(options, {options.output, options.vtu}, {options.deck});
  });
  console.set_rank(fe::initialize_petsc().rank);

  Diagnostics diagnostics;
  const auto deck = read_deck_or_throw(options.deck, make_model_options(options.model), diagnostics);
  auto subcases = choose_subcases(deck, options.model.subcase);
  if (subcases.empty()) {  // Model::build reports it
    subcases.emplace_back();
    subcases.back().id = options.model.subcase;
  }
  demand_static_solution(deck, options.is_linear, diagnostics);
  records::StaticResult result;
  CaseSolver solver(deck, options.model);
  SubcaseFailures failures(subcases.size(), deck.subcases.size());
  for (const auto& subcase : subcases) {
    try {
      result.subcases.push_back(solver.solve(subcase, diagnostics));
    } catch (const Failure& failure) {
      failures.add(subcase.id, failure);
    }
  }
  if (result.subcases.empty()) failures.throw_all(diagnostics);
  result.dof_map = solver.model().calc_dof_map();
  result.mesh = solver.model().calc_mesh();
  result.source = calc_sources(deck.files);
  std::string picture;
  if (!options.vtu.empty() && console.is_root())
    picture = make_vtu_text(exports::make_picture(result), exports::VtuEncoding::Base64, options.deck, diagnostics);
  console.print(diagnostics);
  console.print(failures.get_items(diagnostics));

  if (!options.output.empty() && console.is_root()) hdf5::write_static(result, options.output);
  if (options.in_cd) result = turn_to_cd(solver.model(), std::move(result));
  if (options.json) {
    nlohmann::json json{{"subcases", nlohmann::json::array()}};
    for (const auto& subcase : result.subcases) json["subcases"].push_back(to_json(result, subcase, options.full));
    if (!failures.is_empty()) json["failed"] = failures.to_json();
    console.print_data(json.dump(2) + "\n");
  } else {
    for (const auto& subcase : result.subcases) console.print(format_static(result, subcase, options.full));
  }
  if (!picture.empty()) write_text_file(options.vtu, picture);
  for (const auto& path : {options.output, options.vtu})
    if (!path.empty() && !options.json) console.print("written: " + path + "\n");
  // A rank that ends with an error ends the others: the first one must be through.
  do_once([] { flush_data(); });
  return failures.get_exit_code();
}

}  // namespace

void add_static(CLI::App& app, Action& action) {
  auto o = std::make_shared<StaticOptions>();
  auto* verb = app.add_subcommand("static", "Static solution (SOL 101) of every subcase with a load");
  verb->add_option("deck", o->deck, "Nastran deck")->required();
  verb->add_flag("--full", o->full, "Every grid and element instead of the largest values");
  verb->add_flag("--cd", o->in_cd, "Print vectors in the displacement (CD) axes of each grid, not in basic");
  verb->add_flag("--linear", o->is_linear, "Solve the cards linearly though SOL is nonlinear (106, 129, 400, ...)");
  verb->add_option("--vtu", o->vtu, "Write the displacements of every subcase to this file for ParaView");
  add_model_options(*verb, o->model);
  add_common_options(*verb, *o, kOutput | kJson, "Write displacements, reactions and forces to this HDF5 file");
  verb->footer("Example:\n  bough static frame.bdf -o frame-static.h5\n  bough static frame.bdf --subcase 2 --full");
  verb->callback([&action, o] { action = [o] { return blame(o->deck, [&] { return run_static(*o); }); }; });
}

}  // namespace bough::cli
