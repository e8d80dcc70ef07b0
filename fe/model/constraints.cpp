#include "fe/model/constraints.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <Eigen/LU>

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

bool names(const ConstraintEquation& equation, int ldof) {
  return std::any_of(equation.terms.begin(), equation.terms.end(), [ldof](const auto& t) { return t.first == ldof; });
}

/// Groups of equations that depend on each other in a circle (most groups are one equation), those that a group needs
/// before it: the strongly connected components (Tarjan, SIAM J. Comput. 1 (1972) 146), without recursion.
std::vector<std::vector<int>> find_groups(const std::vector<ConstraintEquation>& equations,
                                          const std::vector<int>& equation_of) {
  const int num = static_cast<int>(equations.size());
  std::vector<int> order(num, -1), low(num, 0), open;
  std::vector<char> is_open(num, 0);
  std::vector<std::pair<int, size_t>> path;  // equation, its next term
  std::vector<std::vector<int>> groups;
  int count = 0;
  const auto enter = [&](int e) {
    order[e] = low[e] = count++;
    open.push_back(e);
    is_open[e] = 1;
    path.emplace_back(e, 0);
  };
  for (int first = 0; first < num; ++first) {
    if (order[first] < 0) enter(first);
    while (!path.empty()) {
      const int e = path.back().first;
      if (path.back().second < equations[e].terms.size()) {
        const int other = equation_of[equations[e].terms[path.back().second++].first];
        if (other < 0) continue;
        if (order[other] < 0)
          enter(other);
        else if (is_open[other])
          low[e] = std::min(low[e], order[other]);
        continue;
      }
      path.pop_back();
      if (!path.empty()) low[path.back().first] = std::min(low[path.back().first], low[e]);
      if (low[e] != order[e]) continue;
      auto& group = groups.emplace_back();
      for (int member = -1; member != e;) {
        member = open.back();
        open.pop_back();
        is_open[member] = 0;
        group.push_back(member);
      }
      std::sort(group.begin(), group.end());
    }
  }
  return groups;
}

/// Adds the terms of an equation, with resolved equations substituted; equations of `group` (ascending) are skipped.
void add_resolved(const ConstraintEquation& equation, const std::vector<int>& equation_of,
                  const std::vector<ConstraintEquation>& equations, const std::vector<int>& group,
                  std::vector<Term>& terms) {
  for (const auto& [ldof, c] : equation.terms) {
    const int other = equation_of[ldof];
    if (other < 0)
      terms.push_back({ldof, c, std::abs(c)});
    else if (!std::binary_search(group.begin(), group.end(), other))
      for (const auto& [far, d] : equations[other].terms) terms.push_back({far, c * d, std::abs(c * d)});
  }
}

/// (1 - A) u_m = B u_n of the dependent dofs u_m of a group, as Nastran factors R_mm: u_m in independent dofs. False
/// when 1 - A is singular, judged after its rows and columns are scaled to one.
bool solve_group(const std::vector<int>& group, const std::vector<int>& equation_of,
                 std::vector<ConstraintEquation>& equations) {
  const auto size = static_cast<Eigen::Index>(group.size());
  Eigen::MatrixXd R = Eigen::MatrixXd::Identity(size, size);
  std::vector<std::vector<std::pair<int, double>>> rights;
  std::unordered_map<int, Eigen::Index> column_of;
  std::vector<int> ldofs;
  std::vector<Term> terms;
  for (Eigen::Index i = 0; i < size; ++i) {
    const auto& equation = equations[group[static_cast<size_t>(i)]];
    for (const auto& [ldof, c] : equation.terms) {
      const auto at = std::lower_bound(group.begin(), group.end(), equation_of[ldof]);
      if (equation_of[ldof] >= 0 && at != group.end() && *at == equation_of[ldof]) R(i, at - group.begin()) -= c;
    }
    terms.clear();
    add_resolved(equation, equation_of, equations, group, terms);
    rights.push_back(combine(terms));
    for (const auto& [ldof, c] : rights.back())
      if (column_of.emplace(ldof, static_cast<Eigen::Index>(ldofs.size())).second) ldofs.push_back(ldof);
  }
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(size, static_cast<Eigen::Index>(ldofs.size()));
  for (Eigen::Index i = 0; i < size; ++i)
    for (const auto& [ldof, c] : rights[static_cast<size_t>(i)]) B(i, column_of.at(ldof)) = c;
  const Eigen::VectorXd rows = R.cwiseAbs().rowwise().maxCoeff();
  if (!(rows.minCoeff() > 0)) return false;
  R = rows.cwiseInverse().asDiagonal() * R;
  B = rows.cwiseInverse().asDiagonal() * B;
  const Eigen::VectorXd columns = R.cwiseAbs().colwise().maxCoeff();
  if (!(columns.minCoeff() > 0)) return false;
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(R * columns.cwiseInverse().asDiagonal());
  if (!(lu.rcond() > 1e-12)) return false;
  const Eigen::MatrixXd X = columns.cwiseInverse().asDiagonal() * lu.solve(B);
  for (Eigen::Index i = 0; i < size; ++i) {
    auto& solved = equations[group[static_cast<size_t>(i)]].terms;
    solved.clear();
    const double largest = X.cols() > 0 ? X.row(i).cwiseAbs().maxCoeff() : 0;
    for (Eigen::Index j = 0; j < X.cols(); ++j)
      if (std::abs(X(i, j)) > 1e-14 * largest) solved.emplace_back(ldofs[static_cast<size_t>(j)], X(i, j));
    std::sort(solved.begin(), solved.end());
  }
  return true;
}

/// One walk inside the group ends on a circle; it is printed by the names of its dofs.
void report_cycle(const std::vector<int>& group, const std::vector<int>& equation_of,
                  const std::vector<ConstraintEquation>& equations, const std::function<std::string(int)>& name_dof,
                  Diagnostics& diagnostics) {
  const auto next = [&](int from) {
    for (const auto& [ldof, c] : equations[from].terms)
      if (const int other = equation_of[ldof]; std::binary_search(group.begin(), group.end(), other)) return other;
    return from;
  };
  std::vector<char> seen(equations.size(), 0);
  int e = group.front();
  while (!seen[e]) {
    seen[e] = 1;
    e = next(e);
  }
  std::string chain = name_dof(equations[e].dependent) + " (" + equations[e].card + ")";
  for (int k = next(e); k != e; k = next(k))
    chain += " -> " + name_dof(equations[k].dependent) + " (" + equations[k].card + ")";
  diagnostics.error("fe.cyclic-constraints", equations[e].at,
                    "dependent dofs depend on each other and their equations are singular: " + chain,
                    "choose another dependent dof so that each is expressed in independent ones");
}

}  // namespace

std::vector<ConstraintEquation> resolve_chains(int num_ldofs, std::vector<ConstraintEquation> equations,
                                               const std::function<std::string(int)>& name_dof,
                                               Diagnostics& diagnostics) {
  const int num = static_cast<int>(equations.size());
  std::vector<int> equation_of(num_ldofs, -1);
  bool is_valid = true;
  for (int e = 0; e < num; ++e) {
    int& owner = equation_of[equations[e].dependent];
    if (owner >= 0) {
      diagnostics.error("fe.dependent-twice", equations[e].at,
                        name_dof(equations[e].dependent) + " is made dependent by " + equations[e].card +
                            " and already by " + equations[owner].card,
                        "make it dependent in one of them only");
      is_valid = false;
    }
    owner = e;
  }
  if (!is_valid) return {};

  // Groups of equations that name each other, what each group names before it.
  std::vector<Term> terms;
  for (const auto& group : find_groups(equations, equation_of)) {
    if (group.size() > 1 || names(equations[group[0]], equations[group[0]].dependent)) {
      if (!solve_group(group, equation_of, equations)) {
        report_cycle(group, equation_of, equations, name_dof, diagnostics);
        return {};
      }
      continue;
    }
    ConstraintEquation& equation = equations[group[0]];
    terms.clear();
    add_resolved(equation, equation_of, equations, {}, terms);
    equation.terms = combine(terms);
  }
  return equations;
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

FixedPart collect_fixed_part(int num_ldofs, const std::vector<ConstraintEquation>& resolved,
                             const std::vector<char>& is_fixed) {
  FixedPart part;
  std::vector<char> is_dependent(static_cast<std::size_t>(num_ldofs), 0);
  std::vector<int> column(static_cast<std::size_t>(num_ldofs), -1);
  for (const auto& equation : resolved) is_dependent[static_cast<std::size_t>(equation.dependent)] = 1;
  std::vector<Eigen::Triplet<double>> entries;
  for (int l = 0; l < num_ldofs; ++l)
    if (is_fixed[static_cast<std::size_t>(l)] && !is_dependent[static_cast<std::size_t>(l)]) {
      column[static_cast<std::size_t>(l)] = static_cast<int>(part.ldofs.size());
      entries.emplace_back(l, static_cast<int>(part.ldofs.size()), 1.0);
      part.ldofs.push_back(l);
    }
  for (const auto& equation : resolved)
    for (const auto& [ldof, c] : equation.terms)
      if (const int j = column[static_cast<std::size_t>(ldof)]; j >= 0) entries.emplace_back(equation.dependent, j, c);
  part.C.resize(num_ldofs, static_cast<int>(part.ldofs.size()));
  part.C.setFromTriplets(entries.begin(), entries.end());
  return part;
}

}  // namespace bough::fe
