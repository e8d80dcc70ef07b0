/// Degree 2 of the work of loads at third order against K_G2: equation (7) of docs/theory/third-order.md.
#include <gtest/gtest.h>

#include "fe/statics/statics.hpp"
#include "stiffening/reduce.hpp"
#include "tests/stiffening/all_kinds.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

struct Case {
  const char* name;
  std::string cards;
  int tip;
  double smallest_ratio;  ///< of the stress of the modes to K_G2, which the old road leaves out
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

std::string make_grids(int first, int num, const char* direction) {
  std::string text;
  for (int i = 0; i < num; ++i) {
    char line[80];
    const double s = 0.1 * (i + 1);
    const double x = direction[0] == 'x' ? s : 1, y = direction[0] == 'x' ? 0 : s;
    std::snprintf(line, sizeof line, "GRID,%d,,%.3f,%.3f,%.3f\n", first + i, x, y, 0.3 * y);
    text += line;
  }
  return text;
}

const std::string kMaterial =
    "MAT1,1,7.+10,,.3,2700.\nPBAR,1,1,1.-4,8.-10,2.-9,1.5-9\nSPC1,1,123456,1\nGRID,1,,0.,0.,0.\n";

/// Bars along x, then along y and z.
std::string make_frame(const std::string& first_of_second_leg = "11") {
  std::string text = kMaterial + make_grids(2, 10, "x") + make_grids(12, 7, "y");
  for (int i = 1; i < 18; ++i) {
    const std::string start = i == 11 ? first_of_second_leg : std::to_string(i);
    text += "CBAR," + std::to_string(i) + ",1," + start + "," + std::to_string(i + 1) +
            (i < 11 ? ",0.,1.,0.\n" : ",1.,0.,0.\n");
  }
  return text;
}

/// A strip of CQUAD4 along x, held at one end; a bar at the other.
std::string make_strip() {
  std::string text = kMaterial + "PSHELL,2,1,.002,1,,1\nGRID,102,,0.,.1,0.\nSPC1,1,123456,102\n";
  for (int i = 1; i <= 8; ++i) {
    const std::string x = std::to_string(0.1 * i);
    text += "GRID," + std::to_string(10 * i + 1) + ",," + x + ",0.,0.\nGRID," + std::to_string(10 * i + 2) + ",," + x +
            ",.1,0.\n";
    const auto left = [&](int side) {
      return i == 1 ? std::string(side == 1 ? "1" : "102") : std::to_string(10 * (i - 1) + side);
    };
    text += "CQUAD4," + std::to_string(i) + ",2," + left(1) + "," + std::to_string(10 * i + 1) + "," +
            std::to_string(10 * i + 2) + "," + left(2) + "\n";
  }
  return text;
}

/// The frame with an arc, a rod, a tube and a bush across it.
std::string make_braced_frame() {
  return make_frame() +
         "PBEND,3,1,4.-4,3.-8,5.-8,6.-8,2,1.5\nCBEND,105,3,6,14,0.,1.,0.,1\nPROD,4,1,2.-5\nCROD,106,4,2,14\n"
         "PTUBE,5,1,.02,.002\nCTUBE,107,5,3,15\nPBUSH,6,K,1.+5,2.+5,3.+5,1.+3,2.+3,3.+3\nCBUSH,108,6,5,13,0.,0.,1.\n";
}

class DegreeTwo : public ::testing::TestWithParam<Case> {};

// Work of a unit load at degree 2: -½ ηᵀK_G2 η - K_G(Φη)(Φη, u_s) + ½ V‴(Φη, Φη, Φ K⁻¹Φᵀf), u_s its static solution.
TEST_P(DegreeTwo, IsK_G2AndTheStressOfTheModes) {
  Diagnostics diagnostics;
  const auto deck = test::read_deck("SOL 103\nCEND\nSPC = 1\nBEGIN BULK\n" + GetParam().cards, diagnostics);
  records::BodySpec spec;
  spec.num_modes = 5;
  spec.interface_nodes = {GetParam().tip};
  spec.stiffening_order = 3;
  spec.num_large = spec.num_modes;
  spec.full = true;
  const auto body = stiffening::reduce(deck, spec, {}, diagnostics).body;
  const auto& third = body.third_order;
  const MatrixXd& Phi = body.full_phi;
  const auto n = Phi.cols();
  const auto model = fe::build_model(deck, {}, diagnostics);
  ASSERT_EQ(model.num_gdofs(), Phi.rows());
  const auto ne = static_cast<Eigen::Index>(body.locators.size());
  ASSERT_EQ(ne, 6);
  MatrixXd F = MatrixXd::Zero(Phi.rows(), ne);
  for (int a = 0; a < 6; ++a) F(model.node(model.find_node(GetParam().tip)).first_gdof + a, a) = 1;
  const fe::StaticSolver solver(model, fe::assemble_stiffness(model, fe::DofSet::Free));
  MatrixXd both(Phi.rows(), n + ne);
  both << Phi, solver.solve(F);
  const auto M = fe::assemble_mass(model, fe::DofSet::Global, model.mass_kind());
  const MatrixXd W = linear::multiply(M, Phi) * body.eigenvalue.asDiagonal();
  const fe::AppliedLoads loads{W, MatrixXd::Zero(records::kNumInertialLoads, n), {}};
  const auto stress = stiffening::calc_generalized_geometric_stiffness(model, loads, Phi, both);

  const Eigen::MatrixXi pairs = records::list_exponents(static_cast<int>(n), 2);
  const Eigen::MatrixXi triples = records::list_exponents(static_cast<int>(n), 3);
  const MatrixXd C = body.modal_stiffness.ldlt().solve(Phi.transpose() * F);  // amplitudes of the load
  const VectorXd unit = body.modal_stiffness.diagonal().cwiseSqrt().cwiseInverse();
  double of_modes = 0, whole = 0;
  VectorXd sizes(ne), errors(ne);
  for (Eigen::Index e = 0; e < ne; ++e) {
    const MatrixXd& K_G2 = body.kg_external[static_cast<std::size_t>(e)];
    double size = 0, error = 0, second = 0;
    for (Eigen::Index i = 0; i < pairs.rows(); ++i) {
      std::vector<Eigen::Index> factors;
      for (Eigen::Index j = 0; j < n; ++j) factors.insert(factors.end(), static_cast<std::size_t>(pairs(i, j)), j);
      const auto a = factors[0], b = factors[1];
      const double half = a == b ? 0.5 : 1;
      const auto at = [&](Eigen::Index j, Eigen::Index l) { return stress[static_cast<std::size_t>(j)](l, n + e); };
      const double first = -half * 0.5 * (K_G2(a, b) + K_G2(b, a)), modes = -half * (at(a, b) + at(b, a));
      double shift = 0;  // ∂V₃/∂η_k C_k
      for (Eigen::Index t = 0; t < triples.rows(); ++t)
        for (Eigen::Index k = 0; k < n; ++k) {
          Eigen::RowVectorXi left = triples.row(t);
          if (--left[k] >= 0 && left == pairs.row(i)) shift += triples(t, k) * third.energy[0][t] * C(k, e);
        }
      const double scale = unit[a] * unit[b];
      size = std::max(size, scale * std::abs(first));
      second = std::max(second, scale * std::abs(modes));
      error = std::max(error, scale * std::abs(third.load[0](i, e) - first - modes - shift));
    }
    sizes[e] = std::max(size, second);
    errors[e] = error;
    of_modes = std::max(of_modes, second);
    whole = std::max(whole, size);
  }
  // Out of its plane the strip's loads have no work of degree 2: round-off is measured by the other loads.
  const double worst = errors.cwiseQuotient(sizes.cwiseMax(1e-6 * sizes.maxCoeff())).maxCoeff();
  std::printf("%s: off by %.1e, stress of the modes %.1e of K_G2\n", GetParam().name, worst, of_modes / whole);
  EXPECT_LT(worst, 1e-9);
  EXPECT_GT(of_modes / whole, GetParam().smallest_ratio);
}

INSTANTIATE_TEST_SUITE_P(
    Bodies, DegreeTwo,
    ::testing::Values(
        Case{"frame", make_frame(), 18, 1e-2},
        Case{"rigid links", make_frame("30") + "GRID,30,,1.,.05,.02\nRBE2,40,11,123456,30\n", 18, 1e-2},
        Case{"mean of grids",
             make_frame() +
                 "GRID,30,,1.2,.9,.1\nGRID,31,,.7,.3,.4\nRBE3,40,,31,123456,1.,123,4,2.\n,123456,9,.7,123,15\n"
                 "MAT1,2,7.+10,,.3,0.\nPBAR,2,2,1.-4,8.-10,2.-9,1.5-9\nCBAR,41,2,31,30,0.,1.,0.\n",
             30, 1e-2},
        Case{"mass", make_frame() + "CONM2,50,18,,.2\n", 18, 1e-2}, Case{"braces", make_braced_frame(), 18, 1e-2},
        Case{"strip", make_strip(), 82, 1e-6}),
    [](const auto& info) {
      std::string name = info.param.name;
      std::replace(name.begin(), name.end(), ' ', '_');
      return name;
    });

}  // namespace
}  // namespace bough
