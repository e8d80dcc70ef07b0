#pragma once
/// \file Load cards beyond FORCE, MOMENT and GRAV: included by deck.hpp.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "formats/records/card_location.hpp"

namespace bough::records {

/// FORCE1, FORCE2, MOMENT1, MOMENT2: along grids[0] -> grids[1], or across that and grids[2] -> grids[3].
struct DirectedLoad {
  int sid = 0, g = 0;
  double f = 0;
  std::array<int, 4> grids{};
  bool is_cross = false;  ///< FORCE2, MOMENT2
  bool is_moment = false;
  CardLocation at;
};

/// PLOAD1 on a CBAR or CBEAM.
struct BeamLoad {
  int sid = 0, element = 0;
  bool is_moment = false;
  int axis = 0;                  ///< 0 x, 1 y, 2 z
  bool in_element_axes = false;  ///< FXE ... MZE; otherwise basic
  bool is_fraction = false;      ///< x1, x2 are fractions of the length (FR, FRPR)
  bool is_projected = false;     ///< LEPR, FRPR: intensity per length seen along the load
  double x1 = 0, p1 = 0;
  std::optional<double> x2;  ///< empty or x1: a load at the point x1
  double p2 = 0;             ///< at x2; blank is zero
  CardLocation at;
};

/// PLOAD: pressure on three or four grids, positive along the normal of their order.
struct GridPressure {
  int sid = 0;
  double p = 0;
  std::vector<int> grids;
  CardLocation at;
};

/// PLOAD2 and PLOAD4: pressure on a shell, or on a face of a solid.
struct ElementPressure {
  int sid = 0, element = 0;
  std::array<double, 4> p{};  ///< at the corners of the face, from g1 on
  int g1 = 0, g34 = 0;        ///< solids: corner of the face; the opposite one, or the one off it (CTETRA)
  int cid = 0;
  std::optional<Eigen::Vector3d> n;  ///< direction in cid; empty: along the normal (solids: inward)
  bool skip_if_missing = false;      ///< from a THRU range
  CardLocation at;
};

/// RFORCE: steady and accelerated rotation about an axis through a grid.
struct Rotation {
  int sid = 0, g = 0, cid = 0;  ///< g 0: the origin of basic
  double a = 0;                 ///< revolutions per time, times |r|
  Eigen::Vector3d r = Eigen::Vector3d::Zero();
  double racc = 0;  ///< revolutions per time squared, times |r|
  CardLocation at;
};

struct Spcd {
  int sid = 0, g = 0;
  unsigned c = 0;
  double d = 0;
  CardLocation at;
};
struct ScalarLoad {  ///< SLOAD
  int sid = 0, point = 0;
  double f = 0;
  CardLocation at;
};

struct LoadCards {
  std::vector<DirectedLoad> directed;
  std::vector<BeamLoad> beams;
  std::vector<GridPressure> grid_pressures;
  std::vector<ElementPressure> pressures;
  std::vector<Rotation> rotations;
  std::vector<Spcd> spcd;
  std::vector<ScalarLoad> scalar;
};

}  // namespace bough::records
