#include "stiffening/given_model.hpp"

#include <algorithm>
#include <set>

#include "fe/linear/factor.hpp"
#include "formats/records/element_cards.hpp"
#include "stiffening/given_checks.hpp"
#include "stiffening/given_rigid.hpp"

namespace bough::stiffening {

using records::BodySpec;
using records::Deck;
using records::FlexBody;

namespace {

template <class Container, class Value>
bool has(const Container& values, const Value& value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

void check_given(const Deck& deck, const BodySpec& spec, const GivenMatrices& matrices, Diagnostics& diagnostics) {
  if (spec.mass != "deck")
    diagnostics.error("reduce.bad-mass", matrices.M.at, "mass is \"" + spec.mass + "\", but the mass matrix is given",
                      "remove the key");
  if (deck.card_counts.count("SEQGP") > 0 && matrices.K.row_dofs.rows() == 0)
    diagnostics.warning("reduce.matrix-order", matrices.K.at,
                        matrices.K.label + " names no dofs and the deck has SEQGP: rows are taken by the ids of points",
                        "give a table of dofs in the order of the matrix");
  for (const int id : matrices.clamped)
    if (std::none_of(deck.grids.begin(), deck.grids.end(), [id](const auto& g) { return g.id == id; }))
      diagnostics.error("reduce.unknown-node", matrices.K.at,
                        "clamped names node " + std::to_string(id) + ", there is no such grid", "correct the id");
}

/// P A Pᵀ, symmetric to the last bit; a matrix that is not symmetric is an error.
SparseRows place(const PointTable& points, const GivenMatrix& matrix, Diagnostics& diagnostics) {
  const SparseRows P = calc_placement(points, matrix, diagnostics);
  if (diagnostics.num_errors() > 0) return SparseRows(points.num_gdofs, points.num_gdofs);
  check_symmetry(matrix, diagnostics);
  const SparseRows A = P * matrix.values * SparseRows(P.transpose());
  return 0.5 * (A + SparseRows(A.transpose()));
}

/// The load of a K_G on the g-set; empty without one.
VectorXd place_load(const PointTable& points, const GivenGeometric& g, Diagnostics& diagnostics) {
  if (g.load.empty()) return {};
  const SparseRows P = calc_placement(points, g.load, diagnostics);
  if (g.load_column > g.load.values.cols())
    diagnostics.error("reduce.matrix-size", g.load.at,
                      "column " + std::to_string(g.load_column) + " of " + g.load.label + ", which has " +
                          std::to_string(g.load.values.cols()),
                      "give one of its columns");
  else if (diagnostics.num_errors() == 0)
    return P * VectorXd(MatrixXd(g.load.values).col(g.load_column - 1));
  return {};
}

std::vector<char> find_rows(const PointTable& points, const GivenMatrix& matrix, Diagnostics& diagnostics) {
  const SparseRows P = calc_placement(points, matrix, diagnostics);
  std::vector<char> has_row(static_cast<std::size_t>(points.num_gdofs), 0);
  for (int i = 0; i < P.outerSize(); ++i) has_row[static_cast<std::size_t>(i)] = P.row(i).nonZeros() > 0;
  return has_row;
}

/// Returns true if the deck ties points that K need not couple.
bool has_constraint_equations(const Deck& deck) {
  return records::count_elements(deck, records::ElementRole::Rigid) > 0;
}

/// Removes the round-off strain in rigid-body motions from a stiffness that another program condensed.
void restore_rigid_motions(const Deck& deck, GivenModel& given, Diagnostics& diagnostics) {
  const auto check = check_rigid_motions(given.points, given.K, given.M);
  if (check.is_exact || !(check.elastic > 0)) return;
  const GivenMatrix& K = given.matrices.K;
  if (check.num_mechanisms > 0 && check.num_rigid == 6 && !has_constraint_equations(deck)) {
    diagnostics.error("reduce.mechanism", K.at,
                      K.label + " has " + std::to_string(check.num_mechanisms) +
                          " zero-energy mode(s) in addition to the six rigid-body motions",
                      "look for hinges, and for parts or points that nothing holds");
    return;
  }
  if (!check.is_free) return;
  given.K = check.K;
  diagnostics.note(
      "reduce.rigid-roundoff", K.at,
      K.label + " strains in rigid-body motions by round-off: " + describe(check) + "; they are taken as rigid",
      "nothing to do; use frame = \"fixed\" if the body is held by springs as soft as these");
}

/// M gives one set of momentum integrals, under the name of its kind.
void check_integrals(const BodySpec& spec, const GivenModel& given, Diagnostics& diagnostics) {
  if (spec.integrals == (given.is_lumped ? "consistent" : "lumped"))
    diagnostics.error("reduce.bad-integrals", given.matrices.M.at,
                      "integrals is \"" + spec.integrals + "\", but the mass matrix given is " +
                          (given.is_lumped ? "lumped" : "consistent"),
                      std::string("choose \"exact\" or \"") + (given.is_lumped ? "lumped" : "consistent") + "\"");
}

}  // namespace

Deck remove_elements(const Deck& deck, const GivenMatrices& matrices) {
  Deck kept = deck;
  records::clear_elements(kept, records::ElementRole::Element);
  kept.direct_matrices.clear();
  for (auto& subcase : kept.subcases) subcase.k2gg.clear(), subcase.m2gg.clear(), subcase.b2gg.clear();
  const std::set<std::string> of_elements = {"WTMASS", "COUPMASS", "CK1", "CK2", "CM1", "CM2", "CB1", "CB2", "AUTOSPC"};
  const auto is_of_elements = [&](const records::Param& p) { return of_elements.count(p.name) > 0; };
  kept.params.erase(std::remove_if(kept.params.begin(), kept.params.end(), is_of_elements), kept.params.end());
  // A matrix on fewer dofs than the g-set was reduced already.
  const auto num_gdofs = 6 * deck.grids.size() + deck.scalar_points.size();
  if (static_cast<std::size_t>(matrices.K.values.rows()) < num_gdofs) kept.aset.clear(), kept.omit.clear();
  for (auto& grid : kept.grids)
    if (has(matrices.clamped, grid.id)) grid.ps = 63;
  return kept;
}

BodySpec add_given_loads(const BodySpec& spec, const GivenMatrices& matrices) {
  BodySpec result = spec;
  for (const auto& g : matrices.geometric) {
    if (g.inertial >= 0 || !g.load.empty()) continue;
    if (g.node > 0 && g.direction <= 3 && has(spec.interface_nodes, g.node)) continue;
    records::ExternalLoadSpec load;
    load.name = g.name;
    load.node = g.node;
    if (g.node > 0) load.directions = {g.direction};
    load.load_set = g.load_set;
    load.at = g.K_G.at;
    result.loads.push_back(load);
  }
  return result;
}

GivenModel make_given_model(const Deck& deck, const BodySpec& spec, const GivenMatrices& matrices,
                            Diagnostics& diagnostics) {
  check_given(deck, spec, matrices, diagnostics);
  Diagnostics of_grids;  // the model reports them
  const auto origin = find_origin(deck, spec).value_or(Eigen::Vector3d::Zero());
  GivenModel given{matrices, PointTable(deck, origin, of_grids), {}, {}, {}, {}, false, {}, {}, {}};
  if (of_grids.num_errors() > 0) return given;
  const PointTable& points = given.points;
  given.K = place(points, matrices.K, diagnostics);
  given.M = matrices.mass_scale * place(points, matrices.M, diagnostics);
  if (!matrices.B.empty()) given.B = place(points, matrices.B, diagnostics);
  for (const auto& g : matrices.geometric) {
    given.K_G.push_back(place(points, g.K_G, diagnostics));
    given.F.push_back(place_load(points, g, diagnostics));
  }
  SparseRows P_modes;
  if (has_modes(given)) P_modes = calc_placement(points, matrices.modes.Phi, diagnostics);
  if (diagnostics.num_errors() > 0) return given;
  if (has_modes(given)) given.Phi = P_modes * MatrixXd(matrices.modes.Phi.values);
  given.has_row = find_rows(points, matrices.K, diagnostics);
  check_mass(given.M, matrices.M, points, diagnostics);
  given.is_lumped = !couples_points(points, given.M);
  check_integrals(spec, given, diagnostics);
  if (spec.frame != records::BodyFrame::Fixed && diagnostics.num_errors() == 0)
    restore_rigid_motions(deck, given, diagnostics);
  return given;
}

fe::ElementList make_given_elements(const GivenModel& given, const Deck& deck, const fe::NodeTable& nodes) {
  fe::ElementList list;
  if (given.K.rows() == 0) return list;  // the grids have errors
  for (std::size_t k = 0; k < given.points.nodes.size(); ++k)
    BOUGH_DEMAND(nodes.node(static_cast<int>(k)).id == given.points.nodes[k].id);
  add_direct_elements(given.points, given.K, fe::DirectKind::Stiffness, list);
  add_direct_elements(given.points, given.M, fe::DirectKind::Mass, list);
  if (given.B.rows() > 0) add_direct_elements(given.points, given.B, fe::DirectKind::Damping, list);
  add_drawn_elements(deck, nodes, list);
  return list;
}

}  // namespace bough::stiffening
