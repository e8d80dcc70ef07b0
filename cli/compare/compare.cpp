#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "analysis/common/body_files.hpp"
#include "analysis/common/inputs.hpp"
#include "cli/common/console.hpp"
#include "cli/common/options.hpp"
#include "cli/compare/compare_report.hpp"
#include "cli/export/export_matrices.hpp"
#include "formats/hdf5/comparison_file.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/hdf5/sparse_file.hpp"

namespace bough::cli {

namespace {

struct CompareOptions : CommonOptions {
  std::vector<std::string> files;
  std::string mass;
  bool refinement = false;
};

/// A body keeps its record; a modes file has shapes only.
struct Loaded {
  modal::ModalModel model;
  std::optional<records::FlexBody> body;
};

Loaded load(const std::string& file, Diagnostics& diagnostics) {
  analysis::demand_body_file(file);
  const auto format = analysis::read_file_format(file);
  if (format == "bough-flexbody") {
    auto body = analysis::read_body(file, diagnostics);
    auto model = modal::ModalModel::from(body);
    return {std::move(model), std::move(body)};
  }
  if (format == "bough-modes") return {modal::ModalModel::from(hdf5::read_modes(file)), {}};
  throw InputError("cli.not-comparable", {file},
                   "compare takes flexible bodies and modes files, found format \"" + format + "\"",
                   "give files that bough reduce or bough modes wrote");
}

records::FlexBody load_body(const std::string& file, Diagnostics& diagnostics) {
  auto loaded = load(file, diagnostics);
  if (!loaded.body)
    throw InputError("cli.not-a-body", {file}, "expected a flexible body, found a modes file", "reduce the deck");
  return std::move(*loaded.body);
}

SingleReport compare_with_itself(const records::FlexBody& body, const std::string& file) {
  SingleReport report{body, modal::check_integrals(body)};
  if (!report.check.has[2])
    throw InputError("cli.no-exact-integrals", {file}, "the body has no exact mass integrals", "reduce the body again");
  return report;
}

MatrixXd calc_mass_mac(const CompareOptions& o, const PairReport& r) {
  analysis::demand_file(o.mass);
  const auto file = hdf5::read_sparse_file(o.mass);
  for (const auto& [name, matrix] : file.matrices) {
    if (name != "M" || file.dof_map.rows() != matrix.num_rows) continue;
    const auto found = modal::calc_mass_mac(r.a, r.b, r.match, matrix, file.dof_map);
    if (found.mac) return *found.mac;
    throw InputError("cli.mass-without-shape", {o.mass},
                     fmt::format("{} rows of the mass matrix have no shape at a common node", found.num_missing),
                     "give the matrices of A's deck, and models with shapes at every grid");
  }
  throw InputError("cli.no-mass-matrix", {o.mass}, "no matrix M with a dof_map in the file",
                   "give a file that bough matrices wrote");
}

PairReport compare_two(const CompareOptions& o, Diagnostics& diagnostics) {
  const auto a = load(o.files[0], diagnostics), b = load(o.files[1], diagnostics);
  auto r = compare_models(o.files[0], a.model, o.files[1], b.model);
  if (!o.mass.empty()) r.mass_mac = calc_mass_mac(o, r);
  if (a.body && b.body) r.bodies = modal::compare_bodies(*a.body, *b.body, r.pairs, r.match.offset);
  return r;
}

RefinementReport compare_meshes(const CompareOptions& o, Diagnostics& diagnostics) {
  std::array<records::FlexBody, 3> bodies;
  RefinementReport report{o.files, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    bodies[i] = load_body(o.files[i], diagnostics);
    report.element_size[i] = modal::calc_element_size(bodies[i].mesh);
    if (report.element_size[i] <= 0 || (i > 0 && report.element_size[i] >= 0.999 * report.element_size[i - 1]))
      throw InputError(
          "cli.not-refined", {o.files[i]},
          fmt::format("mean element size {:.6g}, expected smaller meshes from file to file", report.element_size[i]),
          "give three bodies, coarse to fine");
  }
  report.rows = modal::calc_convergence({&bodies[0], &bodies[1], &bodies[2]}, report.element_size);
  return report;
}

template <class Report>
void write_report(const Report& report, const CompareOptions& o, const Console& console) {
  if (!o.output.empty()) {
    records::Comparison file;
    std::vector<std::string> files;
    for (const auto& name : o.files) files.push_back(analysis::get_body_path(name));
    file.source = analysis::calc_sources(files);
    add_arrays(report, file);
    hdf5::write_comparison(file, o.output);
  }
  if (o.json)
    console.print_data(make_json(report).dump(2) + "\n");
  else
    console.print(format_report(report) + (o.output.empty() ? "" : "\nwritten: " + o.output + "\n"));
}

int run_compare(const CompareOptions& o) {
  const Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  const std::size_t max_files = o.refinement ? 3 : 2, min_files = o.refinement ? 3 : 1;
  if (o.files.size() < min_files || o.files.size() > max_files) {
    console.print_error("cli.usage", fmt::format("{} files given", o.files.size()),
                        o.refinement ? "--refinement takes three" : "give one or two; three with --refinement");
    return kUsageError;
  }
  if (!o.output.empty()) {
    std::vector<std::string> inputs{o.mass};
    for (const auto& name : o.files) inputs.push_back(analysis::get_body_path(name));
    check_output(o, o.output, inputs);
  }
  Diagnostics diagnostics;
  if (o.refinement) {
    write_report(compare_meshes(o, diagnostics), o, console);
  } else if (o.files.size() == 2) {
    write_report(compare_two(o, diagnostics), o, console);
  } else {
    const auto body = load_body(o.files[0], diagnostics);
    write_report(compare_with_itself(body, o.files[0]), o, console);
  }
  console.print(diagnostics);
  return kSuccess;
}

}  // namespace

PairReport compare_models(const std::string& file_a, modal::ModalModel a, const std::string& file_b,
                          modal::ModalModel b) {
  PairReport r{file_a, file_b, std::move(a), std::move(b), {}, {}, {}, {}, {}};
  r.match = modal::match_nodes(r.a, r.b);
  if (r.match.pairs.empty())
    throw InputError("cli.no-common-nodes", {file_b},
                     "no node has the id and place, or the place, of a node of " + file_a,
                     "compare models of one geometry in the same units");
  r.mac = modal::calc_mac(r.a, r.b, r.match);
  r.pairs = modal::pair_modes(r.a, r.b, r.match, r.mac);
  return r;
}

modal::ModalModel load_model(const std::string& file, Diagnostics& diagnostics) {
  return load(file, diagnostics).model;
}

void add_compare(CLI::App& app, Action& action) {
  auto o = std::make_shared<CompareOptions>();
  auto* verb = add_verb(app, "compare", "Two bodies or modes files side by side; the integrals of one body");
  verb->add_option("files", o->files,
                   "Two flexible bodies or modes files; or one body: its integrals by method; or three with "
                   "--refinement")
      ->required();
  verb->add_option("--mass", o->mass, "Matrices file of A's deck: the MAC weighted with its mass matrix, too");
  verb->add_flag("--refinement", o->refinement, "Three bodies of refined meshes, coarse to fine: observed orders");
  add_common_options(*verb, *o, kOutput | kJson, "HDF5 file with the numbers");
  verb->footer(
      "Example:\n  bough compare boom.h5\n  bough compare boom.h5 boom-modes.h5 --mass boom-matrices.h5\n"
      "  bough compare --refinement boom10.h5 boom20.h5 boom40.h5");
  verb->callback([&action, o] { action = [o] { return run_compare(*o); }; });
}

}  // namespace bough::cli
