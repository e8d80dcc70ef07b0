/// Thin square plates against the Kirchhoff values (Navier, and Ritz to the digits shown), and buckling factors.
#include <cmath>
#include <numbers>

#include "tests/plates/plate_deck.hpp"

namespace bough::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kE = 1e7, kNu = 0.3, kRho = 1e-3, kT = 0.002;
const double kD = kE * kT * kT * kT / 12 / (1 - kNu * kNu);

struct Boundary {
  const char* name;
  std::vector<double> lambda2;
  int num_rigid;
};

void PrintTo(const Boundary& boundary, std::ostream* out) { *out << boundary.name; }

DeckText make_square(int n, bool triangles, const std::string& name) {
  PlateMesh mesh{n, n, triangles, [](double a, double b) { return Vector3d(a, b, 0); }};
  DeckText text;
  text.add_mesh(mesh);
  text.add_plate(kE, kNu, kRho, kT);
  text.add("SPC1", 1, 126, 1, "THRU", (n + 1) * (n + 1));
  if (name == "SSSS") {
    text.fix_edges(mesh, "WE", "34");
    text.fix_edges(mesh, "SN", "35");
  } else if (name == "CCCC") {
    text.fix_edges(mesh, "WESN", "345");
  } else if (name == "CFFF") {
    text.fix_edges(mesh, "W", "345");
  }
  return text;
}

class SquarePlate : public testing::TestWithParam<Boundary> {};

TEST_P(SquarePlate, KirchhoffFrequencies) {
  const auto& c = GetParam();
  for (bool triangles : {false, true})
    for (int n : {10, 20, 40}) {
      const VectorXd hz =
          calc_elastic_hz(make_square(n, triangles, c.name), static_cast<int>(c.lambda2.size()), c.num_rigid);
      const VectorXd lambda2 = 2 * kPi * hz * std::sqrt(kRho * kT / kD);
      const std::string what = std::string(c.name) + (triangles ? " CTRIA3 " : " CQUAD4 ") + std::to_string(n);
      report(what, lambda2, c.lambda2);
      if (n == 40) expect_close(what, lambda2, c.lambda2, 0.005);
    }
}

INSTANTIATE_TEST_SUITE_P(Kirchhoff, SquarePlate,
                         testing::Values(Boundary{"SSSS", {19.7392, 49.3480, 49.3480, 78.9568}, 0},
                                         Boundary{"CCCC", {35.9852, 73.3938, 73.3938, 108.2165, 131.5808, 132.2048}, 0},
                                         Boundary{"FFFF", {13.4682, 19.5961, 24.2702, 34.8009, 34.8009, 61.0932}, 3},
                                         Boundary{"CFFF", {3.4711, 8.5067, 21.2850, 27.1989, 30.9563, 54.1872}, 0}),
                         [](const auto& param) { return std::string(param.param.name); });

/// k of σ_cr t = k π² D / b² for a plate a x b; edges W and E are the loaded ones of a uniaxial case.
struct Buckling {
  const char* name;
  double a;
  bool shear;
  const char *clamped, *supported;  ///< edges
  double k;
  double tolerance;
  int num;  ///< elements along b on the finest mesh
};

void PrintTo(const Buckling& buckling, std::ostream* out) { *out << buckling.name; }

class PlateBuckling : public testing::TestWithParam<Buckling> {};

TEST_P(PlateBuckling, Factor) {
  const auto& c = GetParam();
  for (int n : {c.num / 2, c.num}) {
    const int nx = static_cast<int>(std::lround(n * c.a));
    PlateMesh mesh{nx, n, false, [&](double x, double y) { return Vector3d(c.a * x, y, 0); }};
    DeckText text;
    text.add_mesh(mesh);
    text.add_plate(kE, kNu, kRho, kT);
    text.add("SPC1", 1, 6, 1, "THRU", (nx + 1) * (n + 1));
    text.fix("12", mesh.get_id(0, 0));
    text.fix("2", mesh.get_id(nx, 0));
    text.fix_edges(mesh, c.clamped, "345");
    for (const char* e = c.supported; *e; ++e) {
      const char edge[2] = {*e, 0};
      text.fix_edges(mesh, edge, *e == 'W' || *e == 'E' ? "34" : "35");
    }
    // Unit running load: the total is the length of the edge.
    if (c.shear) {
      text.add_edge_load(mesh, 'E', Vector3d(0, 1, 0));
      text.add_edge_load(mesh, 'W', Vector3d(0, -1, 0));
      text.add_edge_load(mesh, 'N', Vector3d(c.a, 0, 0));
      text.add_edge_load(mesh, 'S', Vector3d(-c.a, 0, 0));
    } else {
      text.add_edge_load(mesh, 'E', Vector3d(-1, 0, 0));
      text.add_edge_load(mesh, 'W', Vector3d(1, 0, 0));
    }
    const VectorXd k = calc_load_factors(text, 1).cwiseAbs() / (kPi * kPi * kD);
    const std::string what = std::string(c.name) + " " + std::to_string(nx) + "x" + std::to_string(n);
    report(what, k, {c.k});
    if (n == c.num) expect_close(what, k, {c.k}, c.tolerance);
  }
}

INSTANTIATE_TEST_SUITE_P(Ritz, PlateBuckling,
                         testing::Values(Buckling{"uniaxial_ssss_1", 1, false, "", "WESN", 4.000, 0.005, 24},
                                         Buckling{"uniaxial_ssss_2", 2, false, "", "WESN", 4.000, 0.005, 16},
                                         Buckling{"uniaxial_ss_clamped_sides", 0.662, false, "SN", "WE", 6.971, 0.01,
                                                  32},
                                         Buckling{"uniaxial_free_side", 5, false, "", "WES", 0.4642, 0.01, 12},
                                         Buckling{"uniaxial_cccc", 1, false, "WESN", "", 10.074, 0.01, 32},
                                         Buckling{"shear_ssss_1", 1, true, "", "WESN", 9.3245, 0.01, 32},
                                         Buckling{"shear_ssss_2", 2, true, "", "WESN", 6.546, 0.01, 24},
                                         Buckling{"shear_cccc", 1, true, "WESN", "", 14.642, 0.01, 32}),
                         [](const auto& param) { return std::string(param.param.name); });

/// NASA-CR-202063, 4.1.4.3: 72 x 48 x 0.1 in, simply supported, running load on the short edges; theory 0.1675 lb/in.
TEST(ReportPlate, BucklingLoad) {
  for (int r : {1, 2, 4}) {
    PlateMesh mesh{12 * r, 8 * r, false, [](double x, double y) { return Vector3d(72 * x, 48 * y, 0); }};
    DeckText text;
    text.add_mesh(mesh);
    text.add_plate(9.84e4, 0.3, 2.11e-4, 0.1);
    text.add("SPC1", 1, 6, 1, "THRU", (mesh.nx + 1) * (mesh.ny + 1));
    text.fix("12", mesh.get_id(0, 0));
    text.fix("2", mesh.get_id(mesh.nx, 0));
    text.fix_edges(mesh, "WE", "34");
    text.fix_edges(mesh, "SN", "35");
    text.add_edge_load(mesh, 'E', Vector3d(-48, 0, 0));
    text.add_edge_load(mesh, 'W', Vector3d(48, 0, 0));
    const VectorXd p = calc_load_factors(text, 1);
    const std::string what = "report plate " + std::to_string(mesh.nx) + "x" + std::to_string(mesh.ny);
    report(what, p, {0.1675});
    if (r == 2) expect_close(what, p, {0.1675}, 0.01);
    if (r == 4) expect_close(what, p, {0.1675}, 0.003);
  }
}

}  // namespace
}  // namespace bough::test
