#include "tests/plates/plate_deck.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "fe/loads/loads.hpp"
#include "fe/statics/build_model.hpp"

namespace bough::test {

std::string DeckText::real(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.15E", value);
  return text;
}

void DeckText::add_mesh(const PlateMesh& mesh) {
  for (int j = 0; j <= mesh.ny; ++j)
    for (int i = 0; i <= mesh.nx; ++i)
      add_grid(mesh.get_id(i, j), mesh.place(i / static_cast<double>(mesh.nx), j / static_cast<double>(mesh.ny)));
  int id = 0;
  for (int j = 0; j < mesh.ny; ++j)
    for (int i = 0; i < mesh.nx; ++i) {
      const int a = mesh.get_id(i, j), b = mesh.get_id(i + 1, j), c = mesh.get_id(i + 1, j + 1),
                d = mesh.get_id(i, j + 1);
      if (mesh.triangles) {
        add(mesh.drilling ? "CTRIAR" : "CTRIA3", ++id, 1, a, b, c);
        add(mesh.drilling ? "CTRIAR" : "CTRIA3", ++id, 1, a, c, d);
      } else {
        add(mesh.drilling ? "CQUADR" : "CQUAD4", ++id, 1, a, b, c, d);
      }
    }
}

void DeckText::add_plate(double E, double nu, double rho, double t) {
  add("MAT1", 1, real(E), "", real(nu), real(rho));
  add("PSHELL", 1, 1, real(t), 1, "", 1);
}

void DeckText::add_kirchhoff(double E, double nu, double t) {
  add("MAT1", 1, real(E), "", real(nu));
  add("PSHELL", 1, 1, real(t), 1);
}

void DeckText::fix_edges(const PlateMesh& mesh, const char* edges, const char* components) {
  for (const char* e = edges; *e; ++e)
    for (int k = 0; k <= (*e == 'W' || *e == 'E' ? mesh.ny : mesh.nx); ++k)
      fix(components, *e == 'W'   ? mesh.get_id(0, k)
                      : *e == 'E' ? mesh.get_id(mesh.nx, k)
                      : *e == 'S' ? mesh.get_id(k, 0)
                                  : mesh.get_id(k, mesh.ny));
}

void DeckText::add_edge_load(const PlateMesh& mesh, char edge, const Vector3d& total) {
  const bool along_y = edge == 'W' || edge == 'E';
  const int n = along_y ? mesh.ny : mesh.nx;
  for (int k = 0; k <= n; ++k) {
    const int grid = edge == 'W'   ? mesh.get_id(0, k)
                     : edge == 'E' ? mesh.get_id(mesh.nx, k)
                     : edge == 'S' ? mesh.get_id(k, 0)
                                   : mesh.get_id(k, mesh.ny);
    const Vector3d f = total / n * (k == 0 || k == n ? 0.5 : 1.0);
    add("FORCE", 10, grid, 0, real(1.0), real(f.x()), real(f.y()), real(f.z()));
  }
}

records::Deck read_plate_deck(const DeckText& text) {
  Diagnostics diagnostics;
  auto deck = nastran::read_deck_text(text.str(), "plate.bdf", {}, diagnostics);
  for (const auto& d : diagnostics.items())
    if (d.severity != Severity::Note) ADD_FAILURE() << format(d);
  return deck;
}

VectorXd calc_elastic_hz(const DeckText& text, int num_elastic, int num_rigid) {
  const auto deck = read_plate_deck(text);
  Diagnostics diagnostics;
  const auto model = fe::build_model(deck, {}, diagnostics);
  modal::EigenOptions options;
  options.num_modes = num_elastic + num_rigid;
  const auto pairs = calc_normal_modes(model, options, diagnostics);
  EXPECT_EQ(pairs.num_rigid, num_rigid);
  return pairs.lambda.tail(pairs.lambda.size() - pairs.num_rigid).cwiseSqrt() / (2 * std::numbers::pi);
}

PlateStatics::PlateStatics(const DeckText& text)
    : deck(read_plate_deck(text)),
      model(fe::build_model(deck, {}, diagnostics)),
      load(calc_applied_load(model, deck, 10, diagnostics)),
      u(fe::StaticSolver(model, fe::assemble_stiffness(model, fe::DofSet::Free)).solve(load.F)) {}

VectorXd calc_load_factors(const DeckText& text, int num) {
  PlateStatics plate(text);
  modal::EigenOptions options;
  options.num_modes = num;
  return calc_buckling_modes(plate.model, plate.load, plate.u.col(0), options, plate.diagnostics).lambda;
}

double calc_compliance(const DeckText& text) {
  const PlateStatics plate(text);
  return plate.load.F.col(0).dot(plate.u.col(0));
}

void report(const std::string& what, const VectorXd& computed, const std::vector<double>& target) {
  std::printf("  %-28s", what.c_str());
  for (Eigen::Index i = 0; i < computed.size() && i < static_cast<Eigen::Index>(target.size()); ++i)
    std::printf(" %.6g (%+.2f%%)", computed[i], 100 * (computed[i] / target[static_cast<std::size_t>(i)] - 1));
  std::printf("\n");
}

void expect_close(const std::string& what, const VectorXd& computed, const std::vector<double>& target,
                  double tolerance) {
  ASSERT_GE(computed.size(), static_cast<Eigen::Index>(target.size())) << what;
  for (std::size_t i = 0; i < target.size(); ++i)
    EXPECT_NEAR(computed[static_cast<Eigen::Index>(i)] / target[i], 1, tolerance)
        << what << ", number " << i + 1 << ": " << computed[static_cast<Eigen::Index>(i)] << " against " << target[i];
}

}  // namespace bough::test
