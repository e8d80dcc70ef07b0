/// Lateral-torsional buckling of a thin strip modelled with shells, against a beam's closed forms.
#include <cmath>
#include <numbers>

#include "tests/plates/plate_deck.hpp"

namespace bough::test {
namespace {

constexpr double kPi = std::numbers::pi, kLength = 10, kWidth = 0.5, kT = 0.05, kE = 1e7;

struct Kind {
  bool triangles, drilling;
};

/// The strip in the x-y plane from y = -b/2 to b/2, forked at both ends: no twist, no deflection.
DeckText make_strip(const PlateMesh& mesh) {
  DeckText text;
  text.add_mesh(mesh);
  text.add_kirchhoff(kE, 0, kT);
  text.fix_edges(mesh, "WE", "34");
  text.fix("12", mesh.get_id(0, mesh.ny / 2));
  text.fix("2", mesh.get_id(mesh.nx, mesh.ny / 2));
  return text;
}

PlateMesh make_mesh(Kind kind, int nx, int ny) {
  return {nx, ny, kind.triangles, [](double a, double b) { return Vector3d(kLength * a, kWidth * (b - 0.5), 0); },
          kind.drilling};
}

double calc_bending_stiffness(double width, double height) { return kE * width * std::pow(height, 3) / 12; }
// Without transverse shear a strip has J = b t³ / 3 at any width.
double calc_torsion_stiffness() { return kE / 2 * kWidth * std::pow(kT, 3) / 3; }

constexpr Kind kKinds[] = {{false, false}, {true, false}, {false, true}, {true, true}};

std::string name(const char* load, Kind kind, int ny) {
  return std::string(load) +
         (kind.triangles ? (kind.drilling ? " CTRIAR" : " CTRIA3") : (kind.drilling ? " CQUADR" : " CQUAD4")) + " x" +
         std::to_string(ny);
}

/// The first load factor of a strip under the load of make_text(mesh, ny), for all elements and two meshes.
template <class MakeText>
void expect_load_factor(const char* load, double exact, const MakeText& make_text) {
  for (Kind kind : kKinds) {
    double last = 0;
    for (int ny : {4, 8}) {
      VectorXd found(1);
      found << std::abs(calc_load_factors(make_text(make_mesh(kind, 10 * ny, ny), ny), 1)[0]);
      report(name(load, kind, ny), found, {exact});
      const double error = std::abs(found[0] / exact - 1);
      if (ny == 8) {
        EXPECT_LT(error, kind.triangles && !kind.drilling ? last / 2.5 : 0.01);
      }
      last = error;
    }
  }
}

/// Bent in its plane, it buckles out of it: M = π √(EI GJ) / L (Timoshenko & Gere, "Theory of elastic stability", 2nd
/// ed., eq. 6-10). The membrane forces' part of K_G. The constant strain of CTRIA3 bends badly in its plane: it
/// converges.
TEST(Strip, EndMomentsInThePlane) {
  const double exact = kPi * std::sqrt(calc_bending_stiffness(kWidth, kT) * calc_torsion_stiffness()) / kLength;
  expect_load_factor("in plane", exact, [](const PlateMesh& mesh, int ny) {
    DeckText text = make_strip(mesh);
    // Linear in y over both end edges: nodal forces of a consistent linear traction.
    for (int k = 0; k <= ny; ++k) {
      const double h = 1.0 / ny, y = k * h - 0.5, c = 12 * h / kWidth;
      const double f = k == 0 ? c * (y / 2 + h / 6) : k == ny ? c * (y / 2 - h / 6) : c * y;
      if (2 * k == ny) continue;
      text.add_force(mesh.get_id(0, k), {f, 0, 0});
      text.add_force(mesh.get_id(mesh.nx, k), {-f, 0, 0});
    }
    return text;
  });
}

/// Bent out of its plane: the linear theory of the straight strip (no deflection before buckling) has M = π √(EI_z GJ)
/// / L with its large EI_z. Here only moments and transverse shears make K_G.
TEST(Strip, EndMomentsOutOfThePlane) {
  const double exact = kPi * std::sqrt(calc_bending_stiffness(kT, kWidth) * calc_torsion_stiffness()) / kLength;
  expect_load_factor("out of plane", exact, [](const PlateMesh& mesh, int ny) {
    DeckText text = make_strip(mesh);
    for (int k = 0; k <= ny; ++k) {
      const double m = (k == 0 || k == ny ? 0.5 : 1.0) / ny;
      text.add_moment(mesh.get_id(0, k), {0, m, 0});
      text.add_moment(mesh.get_id(mesh.nx, k), {0, -m, 0});
    }
    return text;
  });
}

}  // namespace
}  // namespace bough::test
