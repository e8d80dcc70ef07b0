#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/model_choice.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/subcase_failures.hpp"
#include "cli/common/console.hpp"
#include "cli/common/model_options.hpp"
#include "cli/common/options.hpp"
#include "cli/common/text_file.hpp"
#include "fe/loads/second_order.hpp"
#include "fe/loads/wide_links.hpp"
#include "fe/matrices/system.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/matrices/matrix_market.hpp"
#include "formats/matrices/op4.hpp"

namespace bough::cli {

namespace {

struct MatricesOptions : CommonOptions {
  std::string deck, format = "h5";
  analysis::ModelChoice model;
  std::vector<int> loads;
  bool no_kg = false;
};

/// A load set and the subcase whose constraints hold the structure under it.
struct LoadCase {
  int load = 0, temperature = 0, subcase = 0;

  std::string get_name() const { return load > 0 ? fmt::format("LOAD_{}", load) : fmt::format("TEMP_{}", temperature); }
};

/// --load, or every LOAD of the case control (of one subcase with --subcase), each set once.
std::vector<LoadCase> choose_load_cases(const records::Deck& deck, const MatricesOptions& options) {
  std::vector<LoadCase> cases;
  if (options.no_kg) return cases;
  const auto add = [&](const LoadCase& one) {
    const auto same = [&](const LoadCase& c) { return c.get_name() == one.get_name(); };
    if ((one.load > 0 || one.temperature > 0) && std::none_of(cases.begin(), cases.end(), same)) cases.push_back(one);
  };
  for (int load : options.loads) {
    LoadCase one{load, 0, options.model.subcase};
    for (const auto& s : deck.subcases)
      if (one.subcase == 0 && s.load == load) one = {load, s.temperature, s.id};
    add(one);
  }
  if (!options.loads.empty()) return cases;
  for (const auto& s : deck.subcases)
    if (options.model.subcase == 0 || s.id == options.model.subcase) add({s.load, s.temperature, s.id});
  return cases;
}

/// K_G of one load case after the other; model and factor stay while the subcase does.
class GeometricStiffness {
 public:
  /// `model`: of the subcase that --subcase names, else the first.
  GeometricStiffness(const records::Deck& deck, const MatricesOptions& options, const fe::Model& model)
      : deck_(deck), options_(options), model_(&model) {}

  fe::SymmetricMatrix calc(const LoadCase& load_case, Diagnostics& diagnostics) {
    if (load_case.subcase != 0 && load_case.subcase != model_->subcase().id) change_to(load_case.subcase, diagnostics);
    records::Subcase subcase;
    subcase.load = load_case.load;
    subcase.temperature = load_case.temperature;
    auto load = fe::calc_static_load(*model_, deck_, subcase, diagnostics);
    fe::report_wide_links(deck_, diagnostics);
    diagnostics.throw_if_errors();
    if (!solver_) {
      const auto relief = fe::read_inertia_relief(deck_, diagnostics);
      auto held = fe::choose_suport(*model_, deck_, relief, diagnostics);
      diagnostics.throw_if_errors();
      solver_.emplace(*model_, fe::get_stiffness(*model_), held);
      suport_ =
          fe::calc_suport(*model_, *solver_, std::move(held), relief, fe::locate_relief(*model_, deck_), diagnostics);
    }
    fe::add_relief(*model_, suport_, load);
    return fe::assemble_geometric_stiffness(*model_, fe::DofSet::Global, load,
                                            fe::solve_static_case(*model_, *solver_, load, suport_).displacement,
                                            &load.initial);
  }

 private:
  void change_to(int subcase, Diagnostics& diagnostics) {
    auto model_options = analysis::make_model_options(options_.model);
    model_options.subcase = subcase;
    model_options.uses_enforced = true;
    analysis::with_prior_messages(
        diagnostics, [&] { model_options.prestress = analysis::calc_prestress(deck_, model_options, diagnostics); });
    solver_.reset();
    Diagnostics own;  // what the other model said too is not said again
    model_ = &own_.emplace(fe::build_model(deck_, model_options, own));
    analysis::add_new(own, diagnostics);
  }

  const records::Deck& deck_;
  const MatricesOptions& options_;
  const fe::Model* model_;
  std::optional<fe::Model> own_;
  std::optional<fe::StaticSolver> solver_;
  fe::Suport suport_;
};

/// "boom.mtx" for K gives "boom.K.mtx".
std::string insert_name(const std::string& path, const std::string& name) {
  const auto dot = path.rfind('.');
  const auto slash = path.rfind('/');
  if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return path + "." + name;
  return path.substr(0, dot) + "." + name + path.substr(dot);
}

/// "boom.mtx" gives "boom.dofs.csv".
std::string name_dof_file(const std::string& path) {
  const std::string named = insert_name(path, "dofs");
  const auto dot = named.rfind('.');
  return (named.substr(dot) == ".dofs" ? named : named.substr(0, dot)) + ".csv";
}

std::string format_dof_map(const Eigen::MatrixXi& dof_map) {
  std::string text = "node,component\n";
  for (Eigen::Index i = 0; i < dof_map.rows(); ++i) text += fmt::format("{},{}\n", dof_map(i, 0), dof_map(i, 1));
  return text;
}

/// The files written.
std::vector<std::string> write(const records::MatricesResult& result, const MatricesOptions& options) {
  const std::string& path = options.output;
  if (options.format == "h5") {
    hdf5::write_matrices(result, path);
    return {path};
  }
  std::vector<std::pair<std::string, const records::SparseMatrix*>> matrices{{"K", &result.K}, {"M", &result.M}};
  if (result.B.num_rows > 0) matrices.emplace_back("B", &result.B);
  for (const auto& [name, matrix] : result.K_G)
    matrices.emplace_back((name[0] == 'T' ? "KGT" : "KG") + name.substr(5), &matrix);
  std::vector<std::string> files;
  const auto keep = [&](const std::string& file, const std::string& text) {
    write_text_file(file, text);
    files.push_back(file);
  };
  std::ostringstream op4;
  for (const auto& [name, matrix] : matrices) {
    if (options.format == "op4") {
      matrices::write_op4(op4, *matrix, name, {});
      continue;
    }
    std::ostringstream text;
    matrices::write_matrix_market(text, *matrix, name + " on the dofs listed in " + name_dof_file(path));
    keep(insert_name(path, name), text.str());
  }
  if (options.format == "op4") keep(path, op4.str());
  keep(name_dof_file(path), format_dof_map(result.dof_map));
  return files;
}

int run_matrices(const MatricesOptions& options) {
  Console console(options.quiet, options.verbosity);
  console.set_subject(options.deck);
  analysis::do_once([&] {
    analysis::demand_deck(options.deck);
    check_output(options, options.output, {options.deck});
    if (options.format == "op4") check_outputs(options, {name_dof_file(options.output)}, {options.deck});
    if (options.format == "mtx")
      check_outputs(options,
                    {insert_name(options.output, "K"), insert_name(options.output, "M"), name_dof_file(options.output)},
                    {options.deck});
  });
  console.set_rank(fe::initialize_petsc().rank);

  Diagnostics diagnostics;
  const auto deck =
      analysis::read_deck_or_throw(options.deck, analysis::make_model_options(options.model), diagnostics);
  auto model_options = analysis::make_model_options(options.model);
  model_options.uses_enforced = true;
  model_options.prestress = analysis::calc_prestress(deck, model_options, diagnostics);
  const auto model = fe::build_model(deck, model_options, diagnostics);
  diagnostics.throw_if_errors();
  records::MatricesResult result;
  result.source = analysis::calc_sources(deck.files);
  result.dof_map = model.calc_dof_map();
  result.mesh = model.calc_mesh();
  result.K = fe::gather_sparse(fe::assemble_stiffness(model, fe::DofSet::Global));
  result.M = fe::gather_sparse(fe::assemble_mass(model, fe::DofSet::Global, model.mass_kind()));
  if (fe::has_damping(model)) result.B = fe::gather_sparse(fe::assemble_damping(model, fe::DofSet::Global));
  GeometricStiffness geometric(deck, options, model);
  for (const auto& load_case : choose_load_cases(deck, options))
    result.K_G.emplace_back(load_case.get_name(), fe::gather_sparse(geometric.calc(load_case, diagnostics)));
  console.print(diagnostics);
  if (!console.is_root()) return kSuccess;

  const auto files = write(result, options);
  nlohmann::json json{{"num_dofs", result.K.num_rows}, {"files", files}};
  Table table{{"matrix", "rows", "entries"}, {}};
  const auto add = [&](const std::string& name, const records::SparseMatrix& matrix) {
    table.rows.push_back({name, std::to_string(matrix.num_rows), std::to_string(matrix.data.size())});
    json["entries"][name] = matrix.data.size();
  };
  add("K", result.K);
  add("M", result.M);
  if (result.B.num_rows > 0) add("B", result.B);
  for (const auto& [name, matrix] : result.K_G) add("KG/" + name, matrix);
  if (options.json) {
    console.print_data(json.dump(2) + "\n");
  } else {
    console.print(table.to_text());
    for (const auto& file : files) console.print("written: " + file + "\n");
  }
  return kSuccess;
}

}  // namespace

void add_matrices(CLI::App& app, Action& action) {
  auto o = std::make_shared<MatricesOptions>();
  auto* verb =
      add_verb(app, "matrices", "Stiffness, mass, damping and geometric stiffness of a deck before constraints");
  verb->add_option("deck", o->deck, "Nastran deck")->required();
  verb->add_option("--to", o->format, "h5 (HDF5), mtx (Matrix Market) or op4 (Nastran OUTPUT4, formatted)")
      ->check(CLI::IsMember({"h5", "mtx", "op4"}))
      ->capture_default_str();
  auto* loads = verb->add_option("--load", o->loads,
                                 "Geometric stiffness of this load set (default: every LOAD of the "
                                 "case control); may be repeated")
                    ->allow_extra_args(false);
  verb->add_flag("--no-kg", o->no_kg, "No geometric stiffness")->excludes(loads);
  add_model_options(*verb, o->model);
  add_common_options(*verb, *o, kOutput | kJson, "File to write; mtx puts the name of each matrix before its ending");
  verb->get_option("--output")->required();
  verb->footer(
      "Example:\n  bough matrices column.bdf -o column.h5\n  bough matrices column.bdf --to mtx -o column.mtx");
  verb->callback(
      [&action, o] { action = [o] { return analysis::with_file(o->deck, [&] { return run_matrices(*o); }); }; });
}

}  // namespace bough::cli
