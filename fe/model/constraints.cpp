#include "bough/fe/model/constraints.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace bough::fe {
namespace {

struct Term {
  int ldof;
  double value;
  double size;  ///< sum of the magnitudes that were added: what is left of a cancellation is judged against it
};

/// Sums equal dofs and drops what only round-off left of a cancellation.
std::vector<std::pair<int, double>> combine(std::vector<Term>& terms) {
  std::sort(terms.begin(), terms.end(), [](const Term& a, const Term& b) { return a.ldof < b.ldof; });
  std::vector<std::pair<int, double>> result;
  for (size_t i = 0; i < terms.size();) {
    double value = 0, size = 0;
    const int ldof = terms[i].ldof;
    for (; i < terms.size() && terms[i].ldof == ldof; ++i) {
      value += terms[i].value;
      size += terms[i].size;
    }
    if (std::abs(value) > 1e-14 * size) result.emplace_back(ldof, value);
  }
  return result;
}

}  // namespace

std::vector<ConstraintEquation> resolve_chains(int num_ldofs, std::vector<ConstraintEquation> equations,
                                               const std::function<std::string(int)>& name_dof,
                                               Diagnostics& diagnostics) {
  const int num = static_cast<int>(equations.size());
  std::vector<int> equation_of(num_ldofs, -1);
  bool is_good = true;
  for (int e = 0; e < num; ++e) {
    int& owner = equation_of[equations[e].dependent];
    if (owner >= 0) {
      diagnostics.error("fe.dependent-twice", equations[e].at,
                        name_dof(equations[e].dependent) + " is made dependent by " + equations[e].card +
                            " and already by " + equations[owner].card,
                        "make it dependent in one of them only");
      is_good = false;
    }
    owner = e;
  }
  if (!is_good) return {};

  // Kahn's order: an equation is ready when every dependent dof among its terms is resolved.
  std::vector<int> num_open(num, 0);
  std::vector<std::vector<int>> users(num);
  std::vector<int> ready;
  for (int e = 0; e < num; ++e) {
    for (const auto& [ldof, c] : equations[e].terms)
      if (const int other = equation_of[ldof]; other >= 0) {
        ++num_open[e];
        users[other].push_back(e);
      }
    if (num_open[e] == 0) ready.push_back(e);
  }
  std::vector<Term> terms;
  size_t done = 0;
  for (; done < ready.size(); ++done) {
    ConstraintEquation& equation = equations[ready[done]];
    terms.clear();
    for (const auto& [ldof, c] : equation.terms) {
      const int other = equation_of[ldof];
      if (other < 0)
        terms.push_back({ldof, c, std::abs(c)});
      else
        for (const auto& [far, d] : equations[other].terms) terms.push_back({far, c * d, std::abs(c * d)});
    }
    equation.terms = combine(terms);
    for (int user : users[ready[done]])
      if (--num_open[user] == 0) ready.push_back(user);
  }
  if (static_cast<int>(done) == num) return equations;

  // What is left is on a cycle or behind one; one walk along open terms ends on a cycle.
  int e = 0;
  while (num_open[e] == 0) ++e;
  std::vector<char> seen(num, 0);
  const auto next = [&](int from) {
    for (const auto& [ldof, c] : equations[from].terms)
      if (const int other = equation_of[ldof]; other >= 0 && num_open[other] > 0) return other;
    return from;
  };
  while (!seen[e]) {
    seen[e] = 1;
    e = next(e);
  }
  std::string chain = name_dof(equations[e].dependent) + " (" + equations[e].card + ")";
  for (int k = next(e); k != e; k = next(k))
    chain += " -> " + name_dof(equations[k].dependent) + " (" + equations[k].card + ")";
  diagnostics.error("fe.cyclic-constraints", equations[e].at, "dependent dofs depend on each other: " + chain,
                    "choose another dependent dof so that each is expressed in independent ones");
  return {};
}

Elimination eliminate(int num_ldofs, const std::vector<ConstraintEquation>& resolved,
                      const std::vector<char>& is_fixed) {
  std::vector<int> equation_of(num_ldofs, -1), fdof_of(num_ldofs, -1);
  for (size_t e = 0; e < resolved.size(); ++e) equation_of[resolved[e].dependent] = static_cast<int>(e);
  Elimination result;
  for (int l = 0; l < num_ldofs; ++l)
    if (equation_of[l] < 0 && !is_fixed[l]) {
      fdof_of[l] = static_cast<int>(result.fdof_ldof.size());
      result.fdof_ldof.push_back(l);
    }
  result.C.resize(num_ldofs, static_cast<int>(result.fdof_ldof.size()));
  Eigen::VectorXi sizes = Eigen::VectorXi::Zero(num_ldofs);
  for (int l = 0; l < num_ldofs; ++l)
    sizes[l] =
        equation_of[l] >= 0 ? static_cast<int>(resolved[equation_of[l]].terms.size()) : (fdof_of[l] >= 0 ? 1 : 0);
  result.C.reserve(sizes);
  for (int l = 0; l < num_ldofs; ++l) {
    if (fdof_of[l] >= 0) result.C.insert(l, fdof_of[l]) = 1;
    if (equation_of[l] >= 0)
      for (const auto& [ldof, c] : resolved[equation_of[l]].terms)
        if (fdof_of[ldof] >= 0) result.C.insert(l, fdof_of[ldof]) = c;
  }
  result.C.makeCompressed();
  return result;
}

}  // namespace bough::fe
