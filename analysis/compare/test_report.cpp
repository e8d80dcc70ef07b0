#include "analysis/compare/test_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include <Eigen/SVD>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/model_choice.hpp"
#include "analysis/compare/compare.hpp"
#include "fe/statics/build_model.hpp"
#include "formats/matrices/test_shapes.hpp"
#include "modal/compare/test_model.hpp"

namespace bough::analysis {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using modal::MeasuredDof;
using modal::ModalModel;

/// A file without coordinates: nodes get those of the nodes of the analysis with their ids; others are removed.
/// \return the number of nodes removed.
std::size_t place_nodes(const ModalModel& analysis, matrices::TestShapes& test) {
  if (test.node_xyz.rows() > 0) return 0;
  std::map<int, Index> rows;
  for (std::size_t k = 0; k < analysis.node_id.size(); ++k) rows[analysis.node_id[k]] = static_cast<Index>(k);
  const auto all = std::move(test);
  test = {};
  test.frequency_hz = all.frequency_hz;
  test.damping = all.damping;
  test.is_complex = all.is_complex;
  std::vector<Index> places;
  for (std::size_t k = 0; k < all.node_id.size(); ++k) {
    const auto found = rows.find(all.node_id[k]);
    if (found == rows.end()) continue;
    places.push_back(found->second);
    test.node_id.push_back(all.node_id[k]);
    test.phi.push_back(all.phi[k]);
  }
  test.node_xyz = analysis.node_xyz(places, Eigen::all);
  return all.node_id.size() - test.node_id.size();
}

/// Test shapes as a model.
ModalModel make_test(const matrices::TestShapes& test) {
  ModalModel model;
  model.node_id = test.node_id;
  model.frequency_hz = test.frequency_hz;
  model.node_xyz = test.node_xyz;
  const auto p = static_cast<Index>(test.node_id.size()), n = test.frequency_hz.size();
  Eigen::MatrixXcd all(6 * p, n);
  for (Index k = 0; k < p; ++k) all.middleRows(6 * k, 6) = test.phi[static_cast<std::size_t>(k)];
  const MatrixXd real = modal::make_real(all);
  for (Index k = 0; k < p; ++k) model.phi.push_back(real.middleRows(6 * k, 6));
  return model;
}

Eigen::MatrixXcd take_complex(const matrices::TestShapes& test, const std::vector<MeasuredDof>& dofs) {
  Eigen::MatrixXcd shapes(static_cast<Index>(dofs.size()), test.frequency_hz.size());
  for (std::size_t k = 0; k < dofs.size(); ++k)
    shapes.row(static_cast<Index>(k)) = test.phi[static_cast<std::size_t>(dofs[k].b)].row(dofs[k].component);
  return shapes;
}

/// Removes measured dofs that are not free in the finite element model, and returns the deck with the others as ASET.
records::Deck choose_aset(const records::Deck& deck, const fe::Model& whole, TestReport& report,
                          Diagnostics& diagnostics) {
  auto reduced = deck;
  reduced.aset.clear();
  reduced.omit.clear();
  std::vector<MeasuredDof> free;
  std::string first;
  for (const auto& dof : report.dofs) {
    const int id = report.a.node_id[static_cast<std::size_t>(dof.a)];
    const int node = whole.find_node(id);
    if (node < 0)
      throw InputError("cli.test-deck", {deck.locate({}).file}, fmt::format("the deck has no grid {} of the model", id),
                       "give the deck of which the modes were computed");
    if (!whole.node(node).R_basic_cd.isIdentity(1e-12))
      throw InputError("cli.test-axes", {deck.locate({}).file},
                       fmt::format("grid {} has a displacement system (CD), and measured components are along the "
                                   "basic axes",
                                   id),
                       "set CD of measured grids to 0, or use --tam serep");
    if (whole.find_fdof(node, dof.component + 1) < 0) {
      if (first.empty()) first = fmt::format("component {} of grid {}", dof.component + 1, id);
      continue;
    }
    free.push_back(dof);
    records::GridComponents entry;
    entry.g = id;
    entry.c = static_cast<decltype(entry.c)>(1U << static_cast<unsigned>(dof.component));
    reduced.aset.push_back(entry);
  }
  if (free.size() < report.dofs.size())
    diagnostics.warning("cli.test-dofs", {report.file_b},
                        fmt::format("{} of {} measured dofs are constrained or dependent in the deck and are left out, "
                                    "{} first",
                                    report.dofs.size() - free.size(), report.dofs.size(), first),
                        "use --tam serep, or measure where the model is free");
  report.dofs = std::move(free);
  return reduced;
}

/// Guyan or IRS at the measured dofs.
void set_static_model(const TestRequest& request, TestReport& report, Diagnostics& diagnostics) {
  demand_deck(request.deck);
  const ModelChoice choice;
  const auto options = make_model_options(choice);
  const auto deck = read_deck_or_throw(request.deck, options, diagnostics);
  auto plain = deck;
  plain.aset.clear();
  plain.omit.clear();
  Diagnostics ignored;
  const auto reduced = choose_aset(deck, fe::build_model(plain, options, ignored), report, diagnostics);
  const auto model = modal::calc_test_model(fe::build_model(reduced, options, diagnostics), request.kind == "irs");
  std::map<std::pair<int, int>, Index> rows;
  for (std::size_t k = 0; k < model.dofs.size(); ++k) rows[model.dofs[k]] = static_cast<Index>(k);
  std::vector<Index> order;
  for (const auto& dof : report.dofs)
    order.push_back(rows.at({report.a.node_id[static_cast<std::size_t>(dof.a)], dof.component + 1}));
  report.mass = model.M(order, order);
  report.model_hz = model.frequency_hz;
}

void set_serep(TestReport& report) {
  const Index n = std::min<Index>(report.a.num_modes(), static_cast<Index>(report.dofs.size()));
  const MatrixXd Phi = modal::take_dofs(report.a, report.dofs, false).leftCols(n);
  report.mass = modal::calc_serep_mass(Phi, report.a.modal_mass.head(n));
  if (report.mass.size() == 0)
    throw InputError(
        "cli.test-rank", {report.file_b},
        fmt::format("the first {} modes are not independent at the {} measured dofs", n, report.dofs.size()),
        "give a modes file with fewer modes, or measure more dofs");
}

}  // namespace

TestReport compare_with_test(const TestRequest& request, Events& events) {
  Diagnostics diagnostics;
  TestReport report;
  report.file_a = request.model;
  report.file_b = request.shapes;
  report.kind = request.kind;
  report.a = load_model(request.model, diagnostics);
  demand_file(request.shapes);
  auto test = matrices::read_test_shapes(request.shapes);
  const auto num_unplaced = place_nodes(report.a, test);
  report.b = make_test(test);
  report.damping = test.damping;
  report.match = modal::match_nodes(report.a, report.b);
  if (report.match.pairs.empty())
    throw InputError("cli.no-common-nodes", {request.shapes},
                     "no node has the id and place, or the place, of a node of " + request.model,
                     "give test and model one origin, the same axes and units");
  const auto num_nodes = num_unplaced + report.b.node_id.size();
  if (report.match.pairs.size() < num_nodes)
    diagnostics.warning("cli.test-dofs", {request.shapes},
                        fmt::format("{} of {} nodes of the test are not in the model",
                                    num_nodes - report.match.pairs.size(), num_nodes),
                        "check ids, coordinates and units of the nodes");
  report.dofs = modal::list_measured_dofs(report.b, report.match);
  if (report.dofs.empty())
    throw InputError("cli.test-unmeasured", {request.shapes}, "all shapes are zero at the nodes of the model",
                     "export the shapes at measured nodes");
  with_prior_messages(diagnostics, [&] {
    if (request.kind == "serep")
      set_serep(report);
    else
      set_static_model(request, report, diagnostics);
  });
  const auto seen = modal::keep_measured(report.a, report.dofs);
  report.mac = modal::calc_mac(seen, report.b, report.match);
  report.pairs = modal::pair_modes(seen, report.b, report.match, report.mac);
  report.collinearity = modal::calc_phase_collinearity(take_complex(test, report.dofs));
  const MatrixXd Phi = modal::normalize(modal::take_dofs(report.a, report.dofs, false), report.mass);
  const MatrixXd Psi = modal::normalize(modal::take_dofs(report.b, report.dofs, true), report.mass);
  report.cross_orthogonality = Phi.transpose() * report.mass * Psi;
  report.self_orthogonality = Psi.transpose() * report.mass * Psi;
  std::vector<int> of_a, of_b;
  for (const auto& pair : report.pairs) {
    of_a.push_back(pair.a);
    of_b.push_back(pair.b);
  }
  report.comac = modal::calc_comac(Phi(Eigen::all, of_a), Psi(Eigen::all, of_b));
  add_messages(diagnostics, events);
  return report;
}

SensorReport place_sensors(const std::string& file, int number, Events& events) {
  Diagnostics diagnostics;
  SensorReport report;
  report.file = file;
  report.model = load_model(file, diagnostics);
  const auto& model = report.model;
  std::vector<MeasuredDof> candidates;
  for (std::size_t k = 0; k < model.node_id.size(); ++k)
    for (int c = 0; c < 3; ++c)
      if (!model.phi[k].row(c).isZero(0)) candidates.push_back({static_cast<int>(k), static_cast<int>(k), c});
  report.num_candidates = static_cast<int>(candidates.size());
  if (number < model.num_modes() || number > report.num_candidates)
    throw InputError("cli.few-sensors", {file},
                     fmt::format("{} sensors, expected {} (modes of the file) to {} (translations that move)", number,
                                 model.num_modes(), report.num_candidates),
                     "change --sensors, or give a modes file with fewer modes");
  const MatrixXd Phi = modal::take_dofs(model, candidates, false);
  const Eigen::JacobiSVD<MatrixXd> svd(Phi);
  if (!(svd.singularValues()[model.num_modes() - 1] > 1e-8 * svd.singularValues()[0]))
    throw InputError("cli.test-rank", {file}, "the translations of the modes are not independent",
                     "leave modes out that turn nodes without moving them");
  const auto rows = modal::place_sensors(Phi, number, report.independence);
  for (const int row : rows) {
    const auto& dof = candidates[static_cast<std::size_t>(row)];
    report.dofs.emplace_back(model.node_id[static_cast<std::size_t>(dof.a)], dof.component + 1);
  }
  const MatrixXd chosen = Phi(rows, Eigen::all);
  const MatrixXd products = chosen.transpose() * chosen;
  const VectorXd squares = products.diagonal();
  report.mac = products.cwiseAbs2().cwiseQuotient(squares * squares.transpose());
  add_messages(diagnostics, events);
  return report;
}

}  // namespace bough::analysis
