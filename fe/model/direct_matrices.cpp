#include "fe/model/direct_matrices.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "fe/cards/maker.hpp"
#include "fe/elements/direct.hpp"
#include "fe/model/sets.hpp"

namespace bough::fe {
namespace {

using records::DirectMatrix;
using Entry = DirectMatrix::Entry;
using Blocks = std::map<std::pair<int, int>, MatrixXd>;  ///< by node indices a <= b, in CD axes

/// Nastran demands IFO 6; a square matrix (IFO 1) is as good when its halves are equal.
bool is_symmetric(const DirectMatrix& matrix) {
  if (matrix.form == 6) return true;
  if (matrix.form != 1) return false;
  std::map<std::tuple<int, int, int, int>, double> terms;
  double largest = 0;
  for (const Entry& e : matrix.entries) {
    terms[{e.gi, e.ci, e.gj, e.cj}] = e.value;
    largest = std::max(largest, std::abs(e.value));
  }
  return std::all_of(matrix.entries.begin(), matrix.entries.end(), [&](const Entry& e) {
    const auto mirror = terms.find({e.gj, e.cj, e.gi, e.ci});
    return std::abs((mirror == terms.end() ? 0 : mirror->second) - e.value) <= 1e-12 * largest;
  });
}

/// Position of a component among the dofs of a point, or -1 after reporting.
int find_slot(Maker& maker, const DirectMatrix& matrix, const std::string& who, int point, int component, int index) {
  const bool is_scalar = maker.nodes().node(index).num_dofs == 1;
  if (is_scalar ? component <= 1 : component >= 1 && component <= 6) return is_scalar ? 0 : component - 1;
  maker.error("fe.bad-component", matrix.at,
              who + " has component " + std::to_string(component) + " at " + (is_scalar ? "scalar point " : "grid ") +
                  std::to_string(point) + ", expected " + (is_scalar ? "0 or 1" : "1 to 6"),
              "correct the component");
  return -1;
}

bool check(Maker& maker, const DirectMatrix& matrix, const std::string& who, const std::string& command) {
  if (!is_symmetric(matrix)) {
    maker.error("fe.direct-not-symmetric", matrix.at,
                who + " (IFO " + std::to_string(matrix.form) + ") is not symmetric, as " + command + " needs it",
                "give a symmetric matrix with IFO 6, each term once");
    return false;
  }
  if (std::any_of(matrix.entries.begin(), matrix.entries.end(), [](const Entry& e) { return e.imaginary != 0; })) {
    maker.error("fe.direct-complex", matrix.at, who + " has imaginary parts, which " + command + " cannot use",
                "give a real matrix; damping goes into B2GG");
    return false;
  }
  return true;
}

void add_terms(Maker& maker, const DirectMatrix& matrix, const std::string& who, double factor, Blocks& blocks) {
  // A point that is missing is reported once.
  std::map<int, int> indices;
  const auto find = [&](int point) {
    const auto [found, is_new] = indices.try_emplace(point, -1);
    if (is_new) found->second = maker.find_point(point, who, matrix.at);
    return found->second;
  };
  for (const Entry& e : matrix.entries) {
    int a = find(e.gi), b = find(e.gj);
    if (a < 0 || b < 0) continue;
    int row = find_slot(maker, matrix, who, e.gi, e.ci, a), column = find_slot(maker, matrix, who, e.gj, e.cj, b);
    if (row < 0 || column < 0) continue;
    // A square matrix has both halves: the one below is the mirror.
    const bool is_mirror = std::pair(a, row) > std::pair(b, column);
    if (matrix.form == 1 && is_mirror) continue;
    if (is_mirror) {
      std::swap(a, b);
      std::swap(row, column);
    }
    MatrixXd& block = blocks[{a, b}];
    if (block.size() == 0) block.setZero(maker.nodes().node(a).num_dofs, maker.nodes().node(b).num_dofs);
    block(row, column) += factor * e.value;
    if (a == b && row != column) block(column, row) += factor * e.value;
  }
}

/// Basic axes of a point's dofs by its CD axes.
MatrixXd calc_rotation(const Node& node) {
  if (node.num_dofs == 1) return MatrixXd::Identity(1, 1);
  MatrixXd R = MatrixXd::Zero(6, 6);
  R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = node.R_basic_cd;
  return R;
}

void add_elements(Maker& maker, DirectKind kind, const Blocks& blocks) {
  for (const auto& [pair, block] : blocks) {
    const auto [a, b] = pair;
    const MatrixXd turned =
        calc_rotation(maker.nodes().node(a)) * block * calc_rotation(maker.nodes().node(b)).transpose();
    std::vector<int> nodes{a};
    if (a != b) nodes.push_back(b);
    auto gdofs = maker.list_gdofs(nodes);
    maker.add(std::make_unique<DirectElement>(kind, std::move(nodes), std::move(gdofs), turned));
  }
}

}  // namespace

ElementList make_direct(const records::Deck& deck, const records::Subcase& subcase, const NodeTable& nodes,
                        Diagnostics& diagnostics) {
  ElementList list;
  Maker maker(deck, nodes, diagnostics, list);
  std::set<std::string> used;
  const auto make = [&](std::string command, DirectKind kind, const auto& names, double factor) {
    Blocks blocks;
    // In a response K2PP is one with K2GG.
    std::string direct = command;
    direct.replace(2, 2, "PP");
    if (subcase.commands.count(direct) > 0)
      command = subcase.commands.count(command) > 0 ? command + " or " + direct : direct;
    for (const auto& [scale, name] : names) {
      used.insert(name);
      const auto found = std::find_if(deck.direct_matrices.begin(), deck.direct_matrices.end(),
                                      [&, &n = name](const auto& matrix) { return matrix.name == n; });
      if (found == deck.direct_matrices.end()) {
        maker.error("fe.missing-direct", subcase.find_command(command.substr(0, 4)),
                    command + " selects " + name + ", but the deck has no DMIG of that name",
                    "correct the name or add the DMIG");
        continue;
      }
      const std::string who = "DMIG " + name;
      if (check(maker, *found, who, command)) add_terms(maker, *found, who, factor * scale, blocks);
    }
    add_elements(maker, kind, blocks);
  };
  // PARAM,WTMASS is not for M2GG, but assembly applies it to all mass.
  const double wtmass = get_real_param(deck, "WTMASS", 1, diagnostics);
  make("K2GG", DirectKind::Stiffness, subcase.k2gg, get_real_param(deck, "CK2", 1, diagnostics));
  make("M2GG", DirectKind::Mass, subcase.m2gg, get_real_param(deck, "CM2", 1, diagnostics) / wtmass);
  make("B2GG", DirectKind::Damping, subcase.b2gg, get_real_param(deck, "CB2", 1, diagnostics));
  const auto demand_one = [&](const char* param, bool is_selected) {
    if (is_selected && get_real_param(deck, param, 1, diagnostics) != 1)
      maker.error(
          "fe.unsupported-param", deck.find_param(param)->at,
          std::string("PARAM,") + param + " scales the matrices of the elements, which Bough leaves as they are",
          "scale the materials instead");
  };
  demand_one("CK1", !subcase.k2gg.empty());
  demand_one("CM1", !subcase.m2gg.empty());
  demand_one("CB1", !subcase.b2gg.empty());
  for (const auto& matrix : deck.direct_matrices)
    if (used.count(matrix.name) == 0 && deck.response_matrices.count(matrix.name) == 0)
      diagnostics.warning(
          "fe.direct-unused", deck.locate(matrix.at), "DMIG " + matrix.name + " is not selected and adds nothing",
          "select it with K2GG, M2GG or B2GG in the case control, for a response also with K2PP, M2PP or "
          "B2PP");
  return list;
}

}  // namespace bough::fe
