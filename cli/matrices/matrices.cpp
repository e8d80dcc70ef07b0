#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/matrices/matrices.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/model_options.hpp"
#include "cli/common/options.hpp"
#include "fe/linear/petsc.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/matrices/matrix_market.hpp"
#include "formats/matrices/op4.hpp"

namespace bough::cli {

namespace {

struct MatricesOptions : CommonOptions {
  analysis::MatricesRequest request;
  std::string format = "h5";
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
    analysis::write_text_file(file, text);
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
  console.set_subject(options.request.deck);
  analysis::do_once([&] {
    analysis::demand_deck(options.request.deck);
    check_output(options, options.output, {options.request.deck});
    if (options.format == "op4") check_outputs(options, {name_dof_file(options.output)}, {options.request.deck});
    if (options.format == "mtx")
      check_outputs(options,
                    {insert_name(options.output, "K"), insert_name(options.output, "M"), name_dof_file(options.output)},
                    {options.request.deck});
  });
  console.set_rank(linear::initialize_petsc().rank);

  ConsoleEvents events(console);
  const auto result = analysis::assemble_matrices(options.request, events);
  console.print(events.get_messages());
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
    print_written_files(options, console, files);
  }
  return kSuccess;
}

}  // namespace

void add_matrices(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_matrices, "matrices", &analysis::MatricesRequest::deck);
  verb->add_option("deck", o->request.deck, "Nastran deck")->required();
  verb->add_option("--to", o->format, "h5 (HDF5), mtx (Matrix Market) or op4 (Nastran OUTPUT4, formatted)")
      ->check(CLI::IsMember({"h5", "mtx", "op4"}))
      ->capture_default_str();
  auto* loads = verb->add_option("--load", o->request.loads,
                                 "Geometric stiffness of this load set (default: every LOAD of the "
                                 "case control); may be repeated")
                    ->allow_extra_args(false);
  verb->add_flag("--no-kg", o->request.no_kg, "No geometric stiffness")->excludes(loads);
  add_model_options(*verb, o->request.model);
  add_common_options(*verb, *o, kOutput | kJson, "File to write; mtx puts the name of each matrix before its ending");
  verb->get_option("--output")->required();
}

}  // namespace bough::cli
