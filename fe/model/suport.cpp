#include "fe/model/suport.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "fe/model/named_grid.hpp"
#include "fe/model/sets.hpp"

namespace bough::fe {
namespace {

/// f-dofs of one entry of SUPORT.
void add_fdofs(const Model& model, const records::GridComponents& term, const SourceLocation& at,
               Diagnostics& diagnostics, std::vector<int>& fdofs) {
  const int index = find_named_grid(model, term.g, "SUPORT", at, diagnostics);
  if (index < 0) return;
  const bool is_scalar = model.node(index).num_dofs == 1;
  if (!is_scalar && term.c == 0) {
    diagnostics.error("fe.bad-component", at, "SUPORT names no component of grid " + std::to_string(term.g),
                      "give components 1 to 6");
    return;
  }
  for (int c = is_scalar ? 0 : 1; c <= (is_scalar ? 0 : 6); ++c) {
    if (c > 0 && !(term.c >> (c - 1) & 1u)) continue;
    if (const int fdof = model.find_fdof(index, c); fdof >= 0) {
      fdofs.push_back(fdof);
      continue;
    }
    const auto& held = model.autospc();
    if (std::any_of(held.begin(), held.end(), [&](const auto& e) { return e.node == term.g && e.component == c; }))
      diagnostics.warning("fe.suport-autospc", at,
                          "SUPORT names " + name_suport(term.g, c) + ", which has no stiffness",
                          "AUTOSPC holds it; leave it out");
    else
      diagnostics.error("fe.suport-not-free", at,
                        "SUPORT names " + name_suport(term.g, c) + ", which is fixed, dependent or omitted",
                        "name dofs that are free, and in ASET if the deck has one");
  }
}

}  // namespace

std::string name_suport(int grid, int component) {
  return (component == 0 ? "scalar point " + std::to_string(grid)
                         : "grid " + std::to_string(grid) + " component " + std::to_string(component));
}

std::vector<int> find_suport(const Model& model, const records::Deck& deck, Diagnostics& diagnostics) {
  std::vector<int> fdofs;
  for (const auto& term : deck.suport) add_fdofs(model, term, deck.locate(term.at), diagnostics, fdofs);
  if (const int sid = model.subcase().suport1; sid != 0) {
    const auto found = deck.suport1.find(sid);
    if (found == deck.suport1.end())
      diagnostics.error("fe.missing-set", deck.locate(model.subcase().find_command("SUPORT1")),
                        "SUPORT1 set " + std::to_string(sid) + " is selected but has no cards", "correct the set id");
    else
      for (const auto& term : found->second) add_fdofs(model, term, deck.locate(term.at), diagnostics, fdofs);
  }
  std::sort(fdofs.begin(), fdofs.end());
  fdofs.erase(std::unique(fdofs.begin(), fdofs.end()), fdofs.end());
  return fdofs;
}

void report_suport(const Model& model, const records::Deck& deck, Diagnostics& diagnostics) {
  if (deck.suport.empty() && model.subcase().suport1 == 0) return;
  Diagnostics found;                      // not used: the warnings are issued again when the DOFs are constrained
  std::vector<std::array<int, 3>> named;  // f-dofs may be numbered by rank
  for (const int fdof : find_suport(model, deck, found)) {
    const auto [grid, component] = model.describe_fdof(fdof);
    named.push_back({model.find_node(grid), component, grid});
  }
  std::sort(named.begin(), named.end());
  std::string list;
  for (const auto& [node, component, grid] : named) list += (list.empty() ? "" : ", ") + name_suport(grid, component);
  for (const auto& item : found.items())
    if (item.severity == Severity::Error) diagnostics.add(item);
  diagnostics.throw_if_errors();
  if (list.empty()) return;
  diagnostics.note("fe.suport", deck.locate(deck.suport.empty() ? records::CardLocation{} : deck.suport[0].at),
                   "SUPORT names " + list, "static holds these dofs; in modes and reduce they stay free");
}

}  // namespace bough::fe
