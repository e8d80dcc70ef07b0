#pragma once
/// \file Rarer structural cards of MSC and NX decks: included by deck.hpp.
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "formats/records/card_location.hpp"

namespace bough::records {

/// PBCOMP: a beam section with lumped areas of several materials, for CBEAM.
struct Pbcomp {
  struct Lump {
    Eigen::Vector2d r = Eigen::Vector2d::Zero();  ///< (y, z) from the shear centre
    double fraction = 0;                          ///< of the area
    int mid = 0;
  };
  int id = 0, mid = 0;
  double A = 0, I1 = 0, I2 = 0, I12 = 0, J = 0, nsm = 0;
  double k1 = 1, k2 = 1;                        ///< shear factors; 0: no shear flexibility
  Eigen::Vector2d m = Eigen::Vector2d::Zero();  ///< (y, z) of the nonstructural mass
  Eigen::Vector2d n = Eigen::Vector2d::Zero();  ///< (y, z) of the neutral axis
  int section = 0;                              ///< symmetry: 1 y and z, 2 y, 3 z, 4 the point, 5 none; 0: no lumps
  std::vector<Lump> lumps;                      ///< as on the card, not mirrored
  CardLocation at;
};

/// A component of a grid (1..6) or a scalar point (0).
struct GridComponent {
  int g = 0, c = 0;
};
/// GENEL: a general element given by its stiffness or flexibility on UI, and rigid-body motions of UI by S from UD.
struct Genel {
  int id = 0;
  std::vector<GridComponent> ui, ud;
  bool is_flexibility = false;  ///< `matrix` is Z, not K
  Eigen::MatrixXd matrix;       ///< ui x ui, symmetric
  Eigen::MatrixXd s;            ///< ui x ud; empty: from the geometry (six ud that hold a rigid body)
  CardLocation at;
};

/// CBEND: a circular arc. geom 1: x or g0 points to the centre; 2: towards it, with RB; 3, 4: with RB (docs/elements).
struct Cbend {
  int id = 0, pid = 0, ga = 0, gb = 0;
  int g0 = 0;
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  int geom = 1;
  CardLocation at;
};
/// PBEND: by properties (A, I1, I2, J), or a pipe by its mean radius and wall.
struct Pbend {
  int id = 0, mid = 0;
  double A = 0, I1 = 0, I2 = 0, J = 0;
  double k1 = 0, k2 = 0;           ///< shear factors; 0: no shear flexibility
  double rb = 0, theta_b_deg = 0;  ///< radius, angle of the arc
  double nsm = 0, rc = 0, zc = 0;  ///< nonstructural mass; offset of the axis from the grids
  std::optional<double> delta_n;   ///< neutral axis from the axis of the centroid; empty: by the section
  bool is_pipe = false;
  int fsi = 0;                         ///< pipes: rule of the flexibility factor
  double rm = 0, t = 0, pressure = 0;  ///< pipes: mean radius, wall, internal pressure
  CardLocation at;
};

/// NSM, NSM1, NSML, NSML1: nonstructural mass of properties or elements.
struct NonstructuralMass {
  int sid = 0;
  std::string type;                        ///< PSHELL, PBAR, ..., ELEMENT
  bool is_total = false;                   ///< NSML: `value` is spread over all that it names
  bool is_all = false;                     ///< every property of the type
  std::vector<std::pair<int, int>> range;  ///< ids first..last, one step
  double value = 0;
  CardLocation at;
};

/// RSPLINE: dependent components follow the spline of a beam through the independent ones, in order.
struct Rspline {
  struct Point {
    int g = 0;
    unsigned c = 0;  ///< dependent components; none: independent
  };
  int id = 0;
  double ratio = 0.1;  ///< D/L
  std::vector<Point> points;
  CardLocation at;
};

/// CGAP and PGAP: in linear analysis a spring of the state at the start.
struct Cgap {
  int id = 0, pid = 0, ga = 0, gb = 0;
  int g0 = 0;
  std::optional<Eigen::Vector3d> v;
  std::optional<int> cid;
  CardLocation at;
};
struct Pgap {
  int id = 0;
  double u0 = 0, f0 = 0;          ///< opening and preload at the start
  double ka = 0, kb = 0, kt = 0;  ///< closed, open, transverse when closed
  CardLocation at;
};

/// CFAST: a fastener between two shells.
struct Cfast {
  int id = 0, pid = 0;
  bool by_elements = false;                      ///< TYPE = ELEM: the shells are two elements, else two properties
  int ida = 0, idb = 0;                          ///< the shells
  int gs = 0, ga = 0, gb = 0;                    ///< grid that locates it; places of its ends; 0: none
  Eigen::Vector3d xs = Eigen::Vector3d::Zero();  ///< place where gs is 0, basic
  CardLocation at;
};
struct Pfast {
  int id = 0;
  double d = 0;                      ///< diameter
  int mcid = -1, mflag = 0;          ///< axes of the stiffnesses
  std::array<double, 3> kt{}, kr{};  ///< along and about the axes
  double mass = 0, ge = 0;
  CardLocation at;
};
/// CWELD: a weld between two patches of shells, or between two grids (ALIGN).
struct Cweld {
  int id = 0, pid = 0;
  std::string format;                            ///< GRIDID, ELEMID, ELPAT, PARTPAT, ALIGN
  int gs = 0, ga = 0, gb = 0;                    ///< grid that locates it; places of its ends; 0: none
  std::string types;                             ///< GRIDID: Q or T for each side, "QT"
  int ida = 0, idb = 0;                          ///< ELEMID, ELPAT: elements; PARTPAT: properties
  std::vector<int> grids_a, grids_b;             ///< GRIDID, without blanks
  Eigen::Vector3d xs = Eigen::Vector3d::Zero();  ///< place where gs is 0, basic
  CardLocation at;
};
struct Pweld {
  int id = 0, mid = 0;
  double d = 0;
  bool is_spot = false;             ///< TYPE = SPOT: the length of the beam is that of half the shells
  double ld_min = 0.2, ld_max = 5;  ///< bounds of the ratio of length to diameter
  CardLocation at;
};

/// ACCEL1 (every grid of a list) and ACCEL (along a direction).
struct GridAcceleration {
  int sid = 0, cid = 0;
  double a = 0;  ///< ACCEL1
  Eigen::Vector3d n = Eigen::Vector3d::Zero();
  bool is_all = false;
  std::vector<int> grids;                        ///< ACCEL1, those of THRU ranges included
  bool skip_if_missing = false;                  ///< the list has a range
  int direction = -1;                            ///< ACCEL: 0 x, 1 y, 2 z of cid along which it varies
  std::vector<std::pair<double, double>> table;  ///< ACCEL: place and value
  CardLocation at;
};

struct SpecialCards {
  std::vector<Pbcomp> pbcomp;
  std::vector<Genel> genel;
  std::vector<Cbend> cbend;
  std::vector<Pbend> pbend;
  std::vector<NonstructuralMass> nsm;
  std::vector<std::pair<int, std::vector<int>>> nsmadd;  ///< set, its sets
  std::vector<Rspline> rspline;
  std::vector<Cgap> cgap;
  std::vector<Pgap> pgap;
  std::vector<Cfast> cfast;
  std::vector<Pfast> pfast;
  std::vector<Cweld> cweld;
  std::vector<Pweld> pweld;
  std::vector<GridAcceleration> accelerations;
};

}  // namespace bough::records
