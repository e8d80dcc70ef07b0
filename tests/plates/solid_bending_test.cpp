/// Linear bricks and wedges that bend: a thin cantilever and a clamped plate with one layer over the thickness.
#include <cmath>

#include "tests/plates/plate_deck.hpp"

namespace bough::test {
namespace {

/// nx x ny x 1 bricks, or twice as many wedges whose triangles lie in the plane, of a x b x t.
struct Block {
  int nx, ny;
  double a, b, t;
  bool wedges;
  double skew = 0;  ///< of the inner grids, as a fraction of an element
  int get_id(int i, int j, int k) const { return (k * (ny + 1) + j) * (nx + 1) + i + 1; }
};

DeckText make_block(const Block& m, double E, double nu) {
  DeckText text;
  const auto real = [](double value) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.15E", value);
    return std::string(buffer);
  };
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j <= m.ny; ++j)
      for (int i = 0; i <= m.nx; ++i) {
        const bool inner = i > 0 && i < m.nx && j > 0 && j < m.ny;
        const double shift = inner ? m.skew * ((i + j) % 2 ? 1 : -1) : 0;
        text.add_grid(m.get_id(i, j, k), Vector3d(m.a * (i + shift) / m.nx, m.b * (j - shift) / m.ny, m.t * (k - 0.5)));
        text.fix("456", m.get_id(i, j, k));
      }
  int id = 0;
  for (int j = 0; j < m.ny; ++j)
    for (int i = 0; i < m.nx; ++i) {
      const auto at = [&](int p, int q, int k) { return m.get_id(i + p, j + q, k); };
      if (!m.wedges) {
        text.add("CHEXA", ++id, 1, at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1), at(1, 0, 1), "+\n+",
                 at(1, 1, 1), at(0, 1, 1));
      } else if ((i + j) % 2 == 0) {
        text.add("CPENTA", ++id, 1, at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 0, 1), at(1, 0, 1), at(1, 1, 1));
        text.add("CPENTA", ++id, 1, at(0, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1), at(1, 1, 1), at(0, 1, 1));
      } else {
        text.add("CPENTA", ++id, 1, at(0, 0, 0), at(1, 0, 0), at(0, 1, 0), at(0, 0, 1), at(1, 0, 1), at(0, 1, 1));
        text.add("CPENTA", ++id, 1, at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
      }
    }
  text.add("PSOLID", 1, 1);
  text.add("MAT1", 1, real(E), "", real(nu), "0.");
  return text;
}

/// PL³/(3EI) and the 6/5 of shear, ν = 0: a strip 10 x 1 x t under a tip force across it.
TEST(LinearSolids, CantileverOfOneLayer) {
  for (const auto& [wedges, t] : {std::pair{false, 0.1}, {false, 1.0}, {true, 0.1}, {true, 1.0}})
    for (int n : {5, 10, 20, 40}) {
      const double exact = 4 * 1000 / (1e7 * t * t * t) + 1.2 * 10 / (5e6 * t);
      const Block m{n, std::max(1, n / 10), 10, 1, t, wedges};
      auto text = make_block(m, 1e7, 0);
      for (int j = 0; j <= m.ny; ++j)
        for (int k = 0; k < 2; ++k) {
          text.fix("123", m.get_id(0, j, k));
          const double part = (j == 0 || j == m.ny ? 0.25 : 0.5) / m.ny;
          text.add("FORCE", 10, m.get_id(n, j, k), 0, part, "0.", "0.", "1.");
        }
      VectorXd ratio(1);
      ratio << calc_compliance(text) / exact;
      const std::string what =
          std::string(wedges ? "CPENTA6 " : "CHEXA8 ") + (t < 1 ? "thin " : "thick ") + std::to_string(n);
      report(what, ratio, {1});
      if (n == 40 && (!wedges || t == 1.0)) expect_close(what, ratio, {1}, 0.01);
      // Thin wedges lock in transverse shear, less with the modes (0.284 without them): shown, held from below.
      if (n == 40 && wedges && t < 1) {
        EXPECT_GT(ratio[0], 0.7);
      }
    }
}

/// Clamped square plate t/L = 0.01 under a central force: 0.005612 P L²/D (Timoshenko & Woinowsky-Krieger, table 37).
TEST(LinearSolids, ClampedPlateOfOneLayer) {
  for (bool wedges : {false, true})
    for (double skew : {0.0, 0.15})
      for (int n : {8, 16, 32}) {
        const Block m{n, n, 1, 1, 0.01, wedges, skew};
        auto text = make_block(m, 1e7, 0.3);
        for (int k = 0; k < 2; ++k) {
          for (int i = 0; i <= n; ++i)
            for (int at : {m.get_id(i, 0, k), m.get_id(i, n, k)}) text.fix("123", at);
          for (int j = 1; j < n; ++j)
            for (int at : {m.get_id(0, j, k), m.get_id(n, j, k)}) text.fix("123", at);
          text.add("FORCE", 10, m.get_id(n / 2, n / 2, k), 0, "0.5", "0.", "0.", "1.");
        }
        const double D = 1e7 * 1e-6 / 12 / 0.91;
        VectorXd ratio(1);
        ratio << calc_compliance(text) * D / 0.005612;
        const std::string what =
            std::string(wedges ? "CPENTA6 " : "CHEXA8 ") + (skew > 0 ? "skew " : "plate ") + std::to_string(n);
        report(what, ratio, {1});
        // Bricks that are no parallelepipeds, and wedges, lock when thin: shown.
        if (n == 32 && !wedges && skew == 0) expect_close(what, ratio, {1}, 0.01);
      }
}

}  // namespace
}  // namespace bough::test
