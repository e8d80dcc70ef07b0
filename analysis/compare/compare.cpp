#include "analysis/compare/compare.hpp"

#include <fmt/format.h>

#include <limits>

#include "analysis/common/body_files.hpp"
#include "analysis/common/choices.hpp"
#include "analysis/common/inputs.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/hdf5/sparse_file.hpp"

namespace bough::analysis {

namespace {

/// A body keeps its record; a modes file has shapes only.
struct Loaded {
  modal::ModalModel model;
  std::optional<records::FlexBody> body;
};

Loaded load(const std::string& file, Diagnostics& diagnostics) {
  demand_body_file(file);
  const auto format = read_file_format(file);
  if (format == "bough-flexbody") {
    auto body = read_body(file, diagnostics);
    auto model = modal::ModalModel::from(body);
    return {std::move(model), std::move(body)};
  }
  if (format == "bough-modes") return {modal::ModalModel::from(hdf5::read_modes(file)), {}};
  throw InputError("cli.not-comparable", {file},
                   "compare takes flexible bodies and modes files, found format \"" + format + "\"",
                   "give files that bough reduce or bough modes wrote");
}

bool is_response_file(const std::string& file) {
  demand_body_file(file);
  return read_file_format(file) == "bough-frequency";
}

records::FlexBody load_body(const std::string& file, Diagnostics& diagnostics) {
  auto loaded = load(file, diagnostics);
  if (!loaded.body)
    throw InputError("cli.not-a-body", {file}, "expected a flexible body, found a modes file", "reduce the deck");
  return std::move(*loaded.body);
}

SingleReport compare_with_itself(const std::string& file, Diagnostics& diagnostics) {
  auto report = check_integrals(load_body(file, diagnostics));
  if (!report.check.has[2])
    throw InputError("cli.no-exact-integrals", {file}, "the body has no exact mass integrals", "reduce the body again");
  return report;
}

MatrixXd calc_mass_mac(const CompareRequest& request, const PairReport& r) {
  demand_file(request.mass);
  const auto file = hdf5::read_sparse_file(request.mass);
  for (const auto& [name, matrix] : file.matrices) {
    if (name != "M" || file.dof_map.rows() != matrix.num_rows) continue;
    const auto found = modal::calc_mass_mac(r.a, r.b, r.match, matrix, file.dof_map);
    if (found.mac) return *found.mac;
    throw InputError("cli.mass-without-shape", {request.mass},
                     fmt::format("{} rows of the mass matrix have no shape at a common node", found.num_missing),
                     "give the matrices of A's deck, and models with shapes at every grid");
  }
  throw InputError("cli.no-mass-matrix", {request.mass}, "no matrix M with a dof_map in the file",
                   "give a file that bough matrices wrote");
}

PairReport compare_two(const CompareRequest& request, Diagnostics& diagnostics) {
  const auto a = load(request.files[0], diagnostics), b = load(request.files[1], diagnostics);
  auto r = compare_models(request.files[0], a.model, request.files[1], b.model);
  if (!request.mass.empty()) r.mass_mac = calc_mass_mac(request, r);
  if (a.body && b.body) r.bodies = modal::compare_bodies(*a.body, *b.body, r.pairs, r.match.offset);
  return r;
}

RefinementReport compare_meshes(const CompareRequest& request, Diagnostics& diagnostics) {
  std::array<records::FlexBody, 3> bodies;
  RefinementReport report{request.files, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    bodies[i] = load_body(request.files[i], diagnostics);
    report.element_size[i] = modal::calc_element_size(bodies[i].mesh);
    if (report.element_size[i] <= 0 || (i > 0 && report.element_size[i] >= 0.999 * report.element_size[i - 1]))
      throw InputError(
          "cli.not-refined", {request.files[i]},
          fmt::format("mean element size {:.6g}, expected smaller meshes from file to file", report.element_size[i]),
          "give three bodies, coarse to fine");
  }
  report.rows = modal::calc_convergence({&bodies[0], &bodies[1], &bodies[2]}, report.element_size);
  return report;
}

}  // namespace

SingleReport check_integrals(const records::FlexBody& body) {
  return {body.name, body.frequency_hz, body.integrals_method, modal::check_integrals(body)};
}

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

std::string find_wrong_number(const CompareRequest& request) {
  const auto num = request.files.size();
  if (request.refinement) return num == 3 ? "" : "--refinement takes three";
  if (!request.test.empty() || request.sensors > 0) return num == 1 ? "" : "--test and --sensors take one";
  return num == 1 || num == 2 ? "" : "give one or two; three with --refinement";
}

CompareAnswer compare_files(const CompareRequest& request, Events& events) {
  if (const auto advice = find_wrong_number(request); !advice.empty())
    throw InputError("cli.bad-option", {}, fmt::format("{} files given", request.files.size()), advice);
  demand_word("--tam", request.tam, {"serep", "guyan", "irs"});
  demand_range("--sensors", request.sensors, 0, std::numeric_limits<int>::max());
  Diagnostics diagnostics;
  CompareAnswer answer = [&]() -> CompareAnswer {
    if (request.refinement) return compare_meshes(request, diagnostics);
    if (!request.test.empty() && is_response_file(request.files[0]))
      return compare_responses(request.files[0], request.test, events);
    if (!request.test.empty())
      return compare_with_test({request.files[0], request.test, request.deck, request.tam}, events);
    if (request.sensors > 0) return place_sensors(request.files[0], request.sensors, events);
    if (request.files.size() == 2) return compare_two(request, diagnostics);
    return compare_with_itself(request.files[0], diagnostics);
  }();
  add_messages(diagnostics, events);
  return answer;
}

}  // namespace bough::analysis
