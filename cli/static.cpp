#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "bough/fe/static_case.hpp"
#include "bough/formats/hdf5/files.hpp"
#include "console.hpp"
#include "model_options.hpp"
#include "options.hpp"
#include "ranks.hpp"
#include "static_tables.hpp"
#include "text_file.hpp"
#include "vtu_file.hpp"

namespace bough::cli {

using Eigen::VectorXd;

namespace {

struct StaticOptions : CommonOptions {
  std::string deck, vtu;
  DeckModelOptions model;
  bool full = false, in_cd = false;
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

/// A model and its factor, kept while the constraints stay the same.
struct Prepared {
  fe::Model model;
  std::unique_ptr<fe::StaticSolver> solver;
  fe::Suport suport;
  int spc = 0, mpc = 0, suport1 = 0;
};

std::unique_ptr<Prepared> prepare(const records::Deck& deck, const StaticOptions& options,
                                  const records::Subcase& subcase, Diagnostics& diagnostics) {
  auto model_options = make_model_options(options.model);
  model_options.subcase = subcase.id;
  model_options.uses_enforced = true;
  auto prepared = std::make_unique<Prepared>(Prepared{
      fe::Model::build(deck, model_options, diagnostics), nullptr, {}, subcase.spc, subcase.mpc, subcase.suport1});
  const auto relief = fe::read_inertia_relief(deck, diagnostics);
  auto held = fe::choose_suport(prepared->model, deck, relief, diagnostics);
  diagnostics.throw_if_errors();
  const auto K = fe::assemble_stiffness(prepared->model, fe::DofSet::Free);
  prepared->solver = std::make_unique<fe::StaticSolver>(prepared->model, K, held);
  prepared->suport = fe::calc_suport(prepared->model, *prepared->solver, std::move(held), relief, diagnostics);
  return prepared;
}

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
    if (!options.output.empty()) check_output(options, options.output, {options.deck});
    if (!options.vtu.empty()) check_output(options, options.vtu, {options.deck});
  });
  console.set_rank(fe::initialize_petsc().rank);

  Diagnostics diagnostics;
  const auto deck = read_deck_or_throw(options.deck, make_model_options(options.model), diagnostics);
  auto subcases = choose_subcases(deck, options.model.subcase);
  if (subcases.empty()) {  // Model::build reports it
    subcases.emplace_back();
    subcases.back().id = options.model.subcase;
  }
  records::StaticResult result;
  std::unique_ptr<Prepared> prepared;
  for (const auto& subcase : subcases) {
    if (!prepared || prepared->spc != subcase.spc || prepared->mpc != subcase.mpc ||
        prepared->suport1 != subcase.suport1)
      prepared = prepare(deck, options, subcase, diagnostics);
    const auto load = fe::calc_static_load(prepared->model, deck, subcase, diagnostics);
    diagnostics.throw_if_errors();
    auto solved = fe::solve_static_case(prepared->model, *prepared->solver, load, prepared->suport, &diagnostics);
    solved.id = subcase.id;
    solved.label = subcase.label.empty() ? subcase.subtitle : subcase.label;
    solved.load_set = subcase.load;
    solved.temperature_set = subcase.temperature;
    solved.spc_set = subcase.spc;
    solved.mpc_set = subcase.mpc;
    solved.elements =
        fe::calc_element_forces(prepared->model, solved.displacement, deck, subcase.load, diagnostics, load.initial);
    result.subcases.push_back(std::move(solved));
  }
  result.dof_map = prepared->model.calc_dof_map();
  result.mesh = prepared->model.calc_mesh();
  result.source = calc_sources(deck.files);
  std::string picture;
  if (!options.vtu.empty() && console.is_root())
    picture = make_vtu_text(exports::make_picture(result), exports::VtuEncoding::Base64, options.deck, diagnostics);
  console.print(diagnostics);

  if (!options.output.empty() && console.is_root()) hdf5::write_static(result, options.output);
  if (options.in_cd) result = turn_to_cd(prepared->model, std::move(result));
  if (options.json) {
    nlohmann::json json{{"subcases", nlohmann::json::array()}};
    for (const auto& subcase : result.subcases) json["subcases"].push_back(to_json(result, subcase, options.full));
    console.print_data(json.dump(2) + "\n");
  } else {
    for (const auto& subcase : result.subcases) console.print(format_static(result, subcase, options.full));
  }
  if (!picture.empty()) write_text_file(options.vtu, picture);
  if (options.json) return kSuccess;
  for (const auto& path : {options.output, options.vtu})
    if (!path.empty()) console.print("written: " + path + "\n");
  return kSuccess;
}

}  // namespace

void add_static(CLI::App& app, Action& action) {
  auto o = std::make_shared<StaticOptions>();
  auto* verb = app.add_subcommand("static", "Static solution (SOL 101) of every subcase with a load");
  verb->add_option("deck", o->deck, "Nastran deck")->required();
  verb->add_flag("--full", o->full, "Every grid and element instead of the largest values");
  verb->add_flag("--cd", o->in_cd, "Print vectors in the displacement (CD) axes of each grid, not in basic");
  verb->add_option("--vtu", o->vtu, "Write the displacements of every subcase to this file for ParaView");
  add_model_options(*verb, o->model);
  add_common_options(*verb, *o, kOutput | kJson, "Write displacements, reactions and forces to this HDF5 file");
  verb->footer("Example:\n  bough static frame.bdf -o frame-static.h5\n  bough static frame.bdf --subcase 2 --full");
  verb->callback([&action, o] { action = [o] { return blame(o->deck, [&] { return run_static(*o); }); }; });
}

}  // namespace bough::cli
