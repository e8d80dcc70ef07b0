/// Energy of the soft modes of bodies of second order: against bodies of third order whose large modes they are, and in
/// closed form.
#include <gtest/gtest.h>

#include "stiffening/reduce.hpp"
#include "tests/stiffening/all_kinds.hpp"

namespace bough {
namespace {

records::FlexBody reduce(const std::string& cards, records::BodySpec spec) {
  Diagnostics diagnostics;
  const auto deck = test::read_deck("SOL 103\nCEND\nSPC = 1\nBEGIN BULK\n" + cards, diagnostics);
  return stiffening::reduce(deck, spec, {}, diagnostics).body;
}

/// A beam between clamps: bending in each plane.
std::string make_beam(int num, const std::string& more = "") {
  std::string text = "MAT1,1,7.+10,2.6+10,,2700.\nPBAR,1,1,1.-4,8.-10,2.-9,1.5-9\nSPC1,1,123456,1," +
                     std::to_string(num + 1) + "\n" + more;
  for (int i = 0; i <= num; ++i) {
    char line[80];
    std::snprintf(line, sizeof line, "GRID,%d,,%.6f,0.,0.\n", i + 1, 1.0 * i / num);
    text += line;
    if (i > 0)
      text += "CBAR," + std::to_string(i) + ",1," + std::to_string(i) + "," + std::to_string(i + 1) + ",0.,1.,0.\n";
  }
  return text;
}

TEST(NextOrder, EnergyIsThatOfABodyOfThirdOrder) {
  records::BodySpec spec;
  spec.num_modes = 8;
  spec.interface_nodes = {7};
  spec.residual = {"interface"};
  const std::string cards = make_beam(12, "CONM2,90,5,,.05,.02,.03,-.01\n");
  const auto two = reduce(cards, spec);
  ASSERT_EQ(two.next_order.modes.size(), 4);
  spec.stiffening_order = 3;
  for (const int mode : two.next_order.modes) spec.large_modes.push_back(mode + 1);
  const auto three = reduce(cards, spec);
  EXPECT_TRUE(three.next_order.empty());
  const Eigen::VectorXd &cubic = three.third_order.energy[0], &quartic = three.third_order.energy[1];
  EXPECT_LT((two.next_order.cubic - cubic).cwiseAbs().maxCoeff(), 1e-8 * cubic.cwiseAbs().maxCoeff());
  EXPECT_LT((two.next_order.quartic - quartic).cwiseAbs().maxCoeff(), 1e-8 * quartic.cwiseAbs().maxCoeff());
}

// V_4 = EA/(8 L) (∫v'²)² of a bending mode; the two planes share one axial force.
TEST(NextOrder, BeamBetweenClampsStretches) {
  records::BodySpec spec;
  spec.num_modes = 2;
  spec.interface_nodes = {21};
  const auto body = reduce(make_beam(40), spec);
  const auto& next = body.next_order;
  ASSERT_EQ(next.modes, (std::vector<int>{0, 1}));
  const double k = 4.730040744862704, sigma = (std::cosh(k) - std::cos(k)) / (std::sinh(k) - std::sin(k));
  const auto calc_v = [&](double x) {
    return std::cosh(k * x) - std::cos(k * x) - sigma * (std::sinh(k * x) - std::sin(k * x));
  };
  double square = 0;  // ∫v'²
  constexpr int kNum = 4000;
  for (int i = 0; i < kNum; ++i) {
    const double slope = (calc_v((i + 1.0) / kNum) - calc_v(1.0 * i / kNum)) * kNum;
    square += slope * slope / kNum;
  }
  const auto node = static_cast<std::size_t>(body.find_node(21));
  for (int j = 0; j < 2; ++j) {
    const double scale = body.phi[node].col(j).head<3>().norm() / calc_v(0.5);
    const double expected = 7e10 * 1e-4 / 8 * std::pow(scale * scale * square, 2);
    EXPECT_NEAR(next.quartic[j == 0 ? 4 : 0] / expected, 1, 5e-3) << "mode " << j + 1;
  }
  EXPECT_NEAR(next.quartic[2] / (2 * std::sqrt(next.quartic[0] * next.quartic[4])), 1, 5e-3);
  const Eigen::VectorXd omega = body.eigenvalue.cwiseSqrt();
  EXPECT_LT(next.cubic.cwiseAbs().maxCoeff() / std::pow(omega[0], 3),
            1e-6 * std::sqrt(next.quartic.maxCoeff()) / std::pow(omega[0], 2));
}

// Static shapes, loads of the state, bodies with given motion of one grid by others have none.
TEST(NextOrder, NoneWithoutSeries) {
  records::BodySpec spec;
  spec.num_modes = 2;
  spec.interface_nodes = {7};
  const auto make_rbe3 = [](const std::string& dependent) {
    return "GRID,90,,.5,.1,0.\nRBE3,91,,90," + dependent + ",1.,123456,6,7\n,8\nCONM2,92,90,,.1\n";
  };
  EXPECT_TRUE(reduce(make_beam(12, make_rbe3("12345")), spec).next_order.empty());
  EXPECT_FALSE(reduce(make_beam(12, make_rbe3("123456")), spec).next_order.empty());
  spec.basis = records::BodyBasis::CraigBampton;
  EXPECT_TRUE(reduce(make_beam(12), spec).next_order.empty());
}

}  // namespace
}  // namespace bough
