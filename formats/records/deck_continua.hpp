#pragma once
/// \file Cards of plates, shells and solids in a deck: included by deck.hpp.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "formats/records/card_location.hpp"

namespace bough::records {

/// MAT2: anisotropic plane-stress elasticity, 3 x 3 symmetric.
struct Mat2 {
  int id = 0;
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
  double rho = 0;
  Eigen::Vector3d alpha = Eigen::Vector3d::Zero();  ///< thermal expansion xx yy xy
  std::optional<double> tref;                       ///< empty: TEMPERATURE(INITIAL), or zero
  double ge = 0;
  CardLocation at;
};
/// Limits of a ply in its own axes, all positive; 0: not given. Of strain with `is_strain` (STRN), else of stress.
struct PlyStrength {
  double Xt = 0, Xc = 0, Yt = 0, Yc = 0;  ///< tension and compression along 1 and 2
  double S = 0;                           ///< shear
  double F12 = 0;                         ///< of the Tsai-Wu criterion
  bool is_strain = false;
};

/// MAT8: orthotropic plane-stress elasticity. G1z, G2z zero: no transverse shear flexibility from this material.
struct Mat8 {
  int id = 0;
  double E1 = 0, E2 = 0, nu12 = 0, G12 = 0, G1z = 0, G2z = 0, rho = 0;
  double a1 = 0, a2 = 0;       ///< thermal expansion along 1 and 2
  std::optional<double> tref;  ///< empty: TEMPERATURE(INITIAL), or zero
  double ge = 0;               ///< structural damping
  PlyStrength strength;
  CardLocation at;
};
/// MAT9: 6 x 6 law of a solid, Voigt xx yy zz xy yz zx.
struct Mat9 {
  int id = 0;
  Eigen::Matrix<double, 6, 6> G = Eigen::Matrix<double, 6, 6>::Zero();
  double rho = 0;
  Eigen::Matrix<double, 6, 1> alpha = Eigen::Matrix<double, 6, 1>::Zero();  ///< thermal expansion
  std::optional<double> tref;                                               ///< empty: TEMPERATURE(INITIAL), or zero
  double ge = 0;
  CardLocation at;
};

struct Pshell {
  int id = 0;
  int mid1 = 0, mid2 = 0, mid3 = 0, mid4 = 0;  ///< membrane, bending, shear, coupling; 0 = none (mid2 -1: plane strain)
  std::optional<double> t;                     ///< empty: from the element's corners
  double bending_ratio = 1;                    ///< 12 I / T³
  double shear_ratio = 5.0 / 6;                ///< TS / T
  double nsm = 0;
  std::optional<double> z1, z2;  ///< where stresses are given; empty: at -T/2 and T/2
  CardLocation at;
};

struct Ply {
  int mid = 0;
  double t = 0, theta_deg = 0;
};
/// Arrangement of plies. Smeared (LAM = SMEAR): their order does not count. SmearedCore (SMCORE): the last is a core,
/// the others, smeared, are half below and half above it.
enum class Layup { Stacked, Smeared, SmearedCore };
/// PCOMP and PCOMPG, all plies listed (a symmetric layup is already unfolded).
struct Pcomp {
  int id = 0;
  double z0 = 0;  ///< bottom surface from the reference surface
  double nsm = 0;
  double tref = 0;                       ///< of all plies; those of their materials do not count
  double ge = 0;                         ///< structural damping; those of the materials do not count
  double sb = 0;                         ///< shear strength of the bond; 0: none
  std::string failure;                   ///< FT: HILL, HOFF, TSAI, STRN; empty: none
  std::vector<Ply> plies;                ///< from the bottom up
  bool bending = true, membrane = true;  ///< LAM = MEM: no bending; BEND: no membrane
  Layup layup = Layup::Stacked;
  CardLocation at;
};

struct ShellElement {
  int id = 0, pid = 0;
  std::string card;           ///< CQUAD4, CTRIA3, CQUADR, CTRIAR, CQUAD8, CTRIA6
  std::vector<int> grids;     ///< the corners
  std::vector<int> midsides;  ///< CQUAD8, CTRIA6: one per side from 1-2 on, 0 = absent; empty = none
  double theta_deg = 0;       ///< material angle from side 1-2
  std::optional<int> mcid;    ///< or: its x-axis projected on the element
  double z_offset = 0;
  bool relative_thickness = false;  ///< TFLAG 1: t multiplies the property's
  std::vector<double> t;            ///< corner thickness; empty = the property's
  CardLocation at;
};

/// CSHEAR: carries shear, and by F1, F2 of PSHEAR rods along its sides.
struct ShearPanel {
  int id = 0, pid = 0;
  std::array<int, 4> grids{};
  CardLocation at;
};
struct Pshear {
  int id = 0, mid = 0;
  double t = 0, nsm = 0;
  double f1 = 0, f2 = 0;  ///< effectiveness for extension along sides 1-2, 3-4 and 2-3, 4-1 (docs/elements)
  CardLocation at;
};

struct Psolid {
  int id = 0, mid = 0;
  int cordm = 0;            ///< material system; 0 basic, -1 element
  int points = 0;           ///< IN: 2 or 3 integration points a direction; 0: blank or BUBBLE
  bool is_full = false;     ///< ISOP is FULL: plain isoparametric
  bool is_reduced = false;  ///< ISOP says REDUCED; blank is the same
  CardLocation at;
};
struct SolidElement {
  int id = 0, pid = 0;
  std::string card;  ///< CHEXA, CPENTA, CTETRA, CPYRAM, CIHEX3
  std::vector<int> corners;
  std::vector<int> midsides;  ///< one per edge, 0 = absent; empty = none; CIHEX3: two, by the edge's first corner first
  CardLocation at;
};

}  // namespace bough::records
