#pragma once
/// \file Decks of structured meshes written as text, read by the Nastran reader, and solved.
#include <gtest/gtest.h>

#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "fe/loads/loads.hpp"
#include "fe/statics/statics.hpp"
#include "formats/nastran/reader.hpp"
#include "modal/eigen.hpp"

namespace bough::test {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// (nx + 1) x (ny + 1) grids over the unit square, numbered row by row from 1, and its quadrilaterals or triangles.
struct PlateMesh {
  int nx = 8, ny = 8;
  bool triangles = false;
  std::function<Vector3d(double, double)> place;
  bool drilling = false;  ///< CQUADR, CTRIAR
  int get_id(int i, int j) const { return j * (nx + 1) + i + 1; }
};

class DeckText {
 public:
  DeckText() { text_.precision(15); }
  template <class... Fields>
  DeckText& add(const char* name, const Fields&... fields) {
    text_ << name;
    ((text_ << ',' << fields), ...);
    text_ << '\n';
    return *this;
  }
  void add_grid(int id, const Vector3d& x) { add("GRID", id, "", real(x.x()), real(x.y()), real(x.z())); }
  void add_mesh(const PlateMesh& mesh);
  /// MAT1 1 and PSHELL 1 with bending and shear.
  void add_plate(double E, double nu, double rho, double t);
  /// The same without mass and without transverse shear flexibility (MID3 blank).
  void add_kirchhoff(double E, double nu, double t);
  /// Fixes the components on the edges named: any of "WESN" (x = 0, x = 1, y = 0, y = 1).
  void fix_edges(const PlateMesh& mesh, const char* edges, const char* components);
  void fix(const char* components, int grid) { add("SPC1", 1, components, grid); }
  /// A force in set 10 spread along an edge of a mesh as a uniform traction's nodal forces (equal elements).
  void add_edge_load(const PlateMesh& mesh, char edge, const Vector3d& total);
  /// Into set 10, in basic.
  void add_force(int grid, const Vector3d& f) {
    add("FORCE", 10, grid, 0, real(1.0), real(f.x()), real(f.y()), real(f.z()));
  }
  void add_moment(int grid, const Vector3d& m) {
    add("MOMENT", 10, grid, 0, real(1.0), real(m.x()), real(m.y()), real(m.z()));
  }
  std::string str() const { return text_.str(); }

 private:
  /// Nastran's reals carry a point.
  static std::string real(double value);
  std::ostringstream text_;
};

struct Solved {
  records::Deck deck;
  VectorXd lambda;  ///< of the modes asked for
  VectorXd hz;
  int num_rigid = 0;
};

records::Deck read_plate_deck(const DeckText& text);
/// Modes of the bulk data (its only SPC set), elastic ones only in hz.
VectorXd calc_elastic_hz(const DeckText& text, int num_elastic, int num_rigid = 0);
/// The displacements under set 10.
struct PlateStatics {
  explicit PlateStatics(const DeckText& text);

  Diagnostics diagnostics;
  records::Deck deck;
  fe::Model model;
  fe::AppliedLoad load;
  MatrixXd u;
};
/// Load factors of set 10.
VectorXd calc_load_factors(const DeckText& text, int num);
/// The work of set 10 on its own displacement (the tip displacement for a unit load).
double calc_compliance(const DeckText& text);

/// One row of a ladder, printed: computed against target.
void report(const std::string& what, const VectorXd& computed, const std::vector<double>& target);
/// |computed / target - 1| <= tolerance for every one of the targets.
void expect_close(const std::string& what, const VectorXd& computed, const std::vector<double>& target,
                  double tolerance);

}  // namespace bough::test
