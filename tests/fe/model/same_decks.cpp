#include "tests/fe/model/same_decks.hpp"

#include <gtest/gtest.h>

#include <deque>

#include <Eigen/Eigenvalues>

#include "fe/statics/build_model.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::fe::test {
namespace {

struct Solved {
  records::Deck deck;
  std::deque<Model> models;  ///< one per subcase
  std::vector<VectorXd> u;
};

std::string say(const Diagnostics& d) {
  std::string text;
  for (const auto& item : d.items()) text += format(item) + "\n";
  return text;
}

Solved solve(const std::string& text) {
  Solved s;
  Diagnostics d;
  s.deck = nastran::read_deck_text(text, "deck.bdf", {}, d);
  EXPECT_EQ(d.num_errors(), 0) << say(d);
  for (const auto& subcase : s.deck.subcases) {
    ModelOptions options;
    options.subcase = subcase.id;
    options.uses_enforced = true;
    s.models.push_back(build_model(s.deck, options, d));
    const Model& model = s.models.back();
    const StaticSolver solver(model, assemble_stiffness(model, DofSet::Free));
    const auto load = calc_static_load(model, s.deck, subcase, d);
    d.throw_if_errors();
    s.u.push_back(solve_static_case(model, solver, load).displacement);
  }
  return s;
}

/// Eigenvalues of L⁻¹ M L⁻ᵀ with K = L Lᵀ, from small to large.
VectorXd calc_eigenvalues(const Model& model) {
  const MatrixXd T = model.T();
  const MatrixXd K = T.transpose() * calc_stiffness_times(model, T);
  const MatrixXd M = T.transpose() * calc_mass_times(model, model.mass_kind(), T);
  const MatrixXd L = K.llt().matrixL();
  const MatrixXd half = L.triangularView<Eigen::Lower>().solve(M);
  MatrixXd A = L.triangularView<Eigen::Lower>().solve(half.transpose());
  A = (0.5 * (A + A.transpose())).eval();
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace

void expect_same(const std::string& a, const std::string& b, double tolerance) {
  const Solved first = solve(a), second = solve(b);
  ASSERT_EQ(first.u.size(), second.u.size());
  for (std::size_t i = 0; i < first.u.size(); ++i) {
    const Model &m = first.models[i], &n = second.models[i];
    const double size = first.u[i].cwiseAbs().maxCoeff();
    for (const Node& node : m.nodes()) {
      const int other = n.find_node(node.id);
      if (other < 0) continue;
      const VectorXd u = first.u[i].segment(node.first_gdof, node.num_dofs);
      const VectorXd v = second.u[i].segment(n.node(other).first_gdof, node.num_dofs);
      EXPECT_LE((u - v).cwiseAbs().maxCoeff(), tolerance * size)
          << "subcase " << i + 1 << ", grid " << node.id << ": " << u.transpose() << " against " << v.transpose();
    }
  }
  const Model &m = first.models[0], &n = second.models[0];
  const auto rigid = calc_mass_properties(m, m.mass_kind(), Vector3d::Zero()).rigid_mass;
  const auto same = calc_mass_properties(n, n.mass_kind(), Vector3d::Zero()).rigid_mass;
  EXPECT_LE((rigid - same).norm(), tolerance * rigid.norm()) << rigid << "\nagainst\n" << same;
  if (rigid.isZero(0)) return;
  const VectorXd p = calc_eigenvalues(m), q = calc_eigenvalues(n);
  const auto num = std::min<Eigen::Index>({6, p.size(), q.size()});
  for (Eigen::Index i = 0; i < num; ++i) {
    const double x = p[p.size() - 1 - i], y = q[q.size() - 1 - i];
    EXPECT_NEAR(x, y, tolerance * p[p.size() - 1]) << "eigenvalue " << i + 1;
  }
}

std::vector<double> solve_at(const std::string& text, int grid, int subcase) {
  const Solved s = solve(text);
  std::size_t i = 0;
  while (subcase != 0 && i + 1 < s.u.size() && s.deck.subcases[i].id != subcase) ++i;
  const Node& node = s.models[i].node(s.models[i].find_node(grid));
  const VectorXd u = s.u[i].segment(node.first_gdof, node.num_dofs);
  return {u.data(), u.data() + u.size()};
}

}  // namespace bough::fe::test
