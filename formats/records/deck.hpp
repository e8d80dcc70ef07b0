#pragma once
/// \file A Nastran deck as plain records: what the reader hands to fe. No I/O, no physics.
///
/// Ids are the deck's. Defaults of the format (GRDSET, BAROR, BEAMOR, field defaults) are already applied; a property
/// that the deck leaves open keeps std::optional, since "blank" then means something to fe (e.g. no shear flexibility).
/// Component lists ("126") are bit masks: bit c-1 set for component c = 1..6; a scalar point's component 0 is mask 0.
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "base/diagnostic.hpp"
#include "formats/records/card_location.hpp"
#include "formats/records/deck_continua.hpp"
#include "formats/records/deck_loads.hpp"
#include "formats/records/deck_special.hpp"
#include "formats/records/deck_superelements.hpp"
#include "formats/records/deck_temperatures.hpp"

namespace bough::records {

using Eigen::Vector3d;

struct Grid {
  int id = 0;
  int cp = 0;                     ///< system of x
  Vector3d x = Vector3d::Zero();  ///< as in the deck: cylindrical/spherical angles in degrees
  int cd = 0;                     ///< system of displacements, constraints, scalar elements
  unsigned ps = 0;                ///< permanent single-point constraints, mask
  CardLocation at;
};

enum class CoordKind { Rectangular, Cylindrical, Spherical };

/// CORD1x (by three grids) and CORD2x (by three points in system rid).
struct CoordSystem {
  int id = 0;
  CoordKind kind = CoordKind::Rectangular;
  bool by_grids = false;
  std::array<int, 3> grids{};
  int rid = 0;
  Vector3d a = Vector3d::Zero(), b = Vector3d::Zero(), c = Vector3d::Zero();  ///< origin, point on z, point in xz-plane
  CardLocation at;
};

struct Mat1 {
  int id = 0;
  double E = 0, G = 0, nu = 0;  ///< the missing one of three is already filled from E = 2(1+ν)G
  double rho = 0, alpha = 0, ge = 0;
  std::optional<double> tref;     ///< empty: TEMPERATURE(INITIAL), or zero
  double st = 0, sc = 0, ss = 0;  ///< stress limits: tension, compression, shear; 0: none
  CardLocation at;
  char filled = 0;  ///< E, G or N (nu): the one that was missing on the card
};

/// Four times zero: where a section gives no points for stress (Eigen sets nothing by itself).
inline std::array<Eigen::Vector2d, 4> make_no_points() {
  const Eigen::Vector2d zero = Eigen::Vector2d::Zero();
  return {zero, zero, zero, zero};
}

struct Pbar {
  int id = 0, mid = 0;
  double A = 0, I1 = 0, I2 = 0, I12 = 0, J = 0, nsm = 0;
  std::optional<double> k1, k2;                                ///< shear factors; empty = no shear flexibility
  std::array<Eigen::Vector2d, 4> recovery = make_no_points();  ///< C D E F
  CardLocation at;
};

/// PBARL: a section by shape ("ROD", "TUBE", "BAR", "BOX", "I", ...) and its dimensions.
struct Pbarl {
  int id = 0, mid = 0;
  std::string shape;
  std::vector<double> dims;
  double nsm = 0;
  CardLocation at;
};

struct PbeamStation {
  double x_over_L = 0;
  double A = 0, I1 = 0, I2 = 0, I12 = 0, J = 0, nsm = 0;
  std::array<Eigen::Vector2d, 4> recovery = make_no_points();
};
struct Pbeam {
  int id = 0, mid = 0;
  std::vector<PbeamStation> stations;  ///< sorted, first at 0, last at 1
  std::optional<double> k1, k2;  ///< shear factors as in the deck (blank: 1.0 by Nastran; 0.0: no shear flexibility)
  double s1 = 0, s2 = 0;         ///< shear relief (taper)
  double nsi_a = 0, nsi_b = 0;   ///< nonstructural mass moment of inertia per length
  double cw_a = 0, cw_b = 0;     ///< warping coefficients
  double m1_a = 0, m2_a = 0, m1_b = 0, m2_b = 0;  ///< (y,z) of the centre of nonstructural mass
  double n1_a = 0, n2_a = 0, n1_b = 0, n2_b = 0;  ///< (y,z) of the neutral axis from the shear centre
  CardLocation at;
};

struct PbeamlStation {
  double x_over_L = 0;
  std::vector<double> dims;
  double nsm = 0;
};
struct Pbeaml {
  int id = 0, mid = 0;
  std::string shape;
  std::vector<PbeamlStation> stations;
  CardLocation at;
};

struct Prod {
  int id = 0, mid = 0;
  double A = 0, J = 0, c = 0, nsm = 0;
  CardLocation at;
};
struct Ptube {
  int id = 0, mid = 0;
  double od = 0, t = 0, nsm = 0;
  std::optional<double> od2;  ///< outer diameter at end B; empty = od
  CardLocation at;
};
struct Pelas {
  int id = 0;
  double k = 0, ge = 0, s = 0;
  CardLocation at;
};
struct Pbush {
  int id = 0;
  std::array<double, 6> k{}, b{}, ge{};
  std::array<double, 4> rcv{1, 1, 1,
                            1};  ///< SA ST EA ET: stress per force and moment, strain per translation, rotation
  double mass = 0;
  CardLocation at;
};
/// PBUSH1D: the linear part; a table or equation on it is reported.
struct Pbush1d {
  int id = 0;
  double k = 0, c = 0, m = 0;  ///< stiffness, viscous damping, mass
  CardLocation at;
};
struct Pdamp {
  int id = 0;
  double b = 0;
  CardLocation at;
};
struct Pvisc {
  int id = 0;
  double ce = 0, cr = 0;  ///< viscous coefficients, extension and rotation
  CardLocation at;
};
struct Pmass {
  int id = 0;
  double m = 0;
  CardLocation at;
};

/// CBAR and CBEAM.
struct BeamElement {
  int id = 0, pid = 0, ga = 0, gb = 0;
  bool is_cbeam = false;
  int g0 = 0;                     ///< orientation grid, 0 = use v
  Vector3d v = Vector3d::Zero();  ///< orientation vector from end A
  std::string offt = "GGG";       ///< frames of v, wa, wb: G displacement system (or basic for B), O element
  unsigned pin_a = 0, pin_b = 0;  ///< released element dofs, masks in element axes
  Vector3d wa = Vector3d::Zero(), wb = Vector3d::Zero();
  int sa = 0, sb = 0;  ///< warping scalar points (CBEAM)
  CardLocation at;
};
struct Crod {
  int id = 0, pid = 0, ga = 0, gb = 0;
  CardLocation at;
};
struct Conrod {
  int id = 0, ga = 0, gb = 0, mid = 0;
  double A = 0, J = 0, c = 0, nsm = 0;
  CardLocation at;
};
struct Ctube {
  int id = 0, pid = 0, ga = 0, gb = 0;
  CardLocation at;
};
/// CELAS1 (pid > 0) and CELAS2 (pid = 0, k given). g = 0: grounded. c = component 1..6, 0 for a scalar point.
struct ScalarSpring {
  int id = 0, pid = 0;
  double k = 0, ge = 0, s = 0;
  int g1 = 0, c1 = 0, g2 = 0, c2 = 0;
  CardLocation at;
  bool by_scalar_points = false;  ///< CELAS3 and CELAS4: g1 and g2 are scalar points
};
struct Cbush {
  int id = 0, pid = 0, ga = 0, gb = 0;  ///< gb = 0: grounded
  int g0 = 0;
  std::optional<Vector3d> v;  ///< orientation vector
  std::optional<int> cid;     ///< element system; overrides v, g0
  double s = 0.5;             ///< location of the spring from A to B
  int ocid = -1;              ///< -1: s is used; otherwise s_offset in this system
  Vector3d s_offset = Vector3d::Zero();
  CardLocation at;
};
/// CBUSH1D: spring, damper and mass along the line of two grids, or along x of cid.
struct Cbush1d {
  int id = 0, pid = 0, ga = 0, gb = 0;  ///< gb = 0: grounded
  std::optional<int> cid;
  CardLocation at;
};
/// CDAMP1, CDAMP3 (pid > 0) and CDAMP2, CDAMP4 (pid = 0, b given). g = 0: grounded.
struct ScalarDamper {
  int id = 0, pid = 0;
  double b = 0;
  int g1 = 0, c1 = 0, g2 = 0, c2 = 0;
  CardLocation at;
  bool by_scalar_points = false;  ///< CDAMP3 and CDAMP4
};
struct Cvisc {
  int id = 0, pid = 0, ga = 0, gb = 0;
  CardLocation at;
};
/// PLOTEL: a line that is drawn and carries nothing.
struct Plotel {
  int id = 0, ga = 0, gb = 0;
  CardLocation at;
};
/// CMASS1 (pid > 0) and CMASS2.
struct ScalarMass {
  int id = 0, pid = 0;
  double m = 0;
  int g1 = 0, c1 = 0, g2 = 0, c2 = 0;
  CardLocation at;
  bool by_scalar_points = false;  ///< CMASS3 and CMASS4
};
struct Conm1 {
  int id = 0, g = 0, cid = 0;
  Eigen::Matrix<double, 6, 6> m = Eigen::Matrix<double, 6, 6>::Zero();
  CardLocation at;
};
struct Conm2 {
  int id = 0, g = 0;
  int cid = 0;  ///< -1: x is the position of the mass in basic, not an offset
  double m = 0;
  Vector3d x = Vector3d::Zero();
  std::array<double, 6> inertia{};  ///< I11 I21 I22 I31 I32 I33 as in the deck (positive products of inertia)
  CardLocation at;
};

struct Rbe2 {
  int id = 0, gn = 0;
  unsigned cm = 0;
  std::vector<int> gm;
  CardLocation at;
};

/// RBE3: the reference components follow the weighted mean motion of the connected grids.
struct Rbe3 {
  struct Group {
    double weight = 1;
    unsigned c = 0;  ///< components of these grids that count, in their CD axes
    std::vector<int> grids;
  };
  struct Dependent {
    int g = 0;
    unsigned c = 0;
  };
  int id = 0, ref_grid = 0;
  unsigned ref_c = 0;
  std::vector<Group> groups;
  std::vector<Dependent> um;  ///< dependent components; empty = ref_c of ref_grid
  CardLocation at;
};
/// RROD: a rod of constant length, pinned at both ends.
struct Rrod {
  int id = 0, ga = 0, gb = 0;
  int cma = 0, cmb = 0;  ///< one translation 1..3, the other 0
  CardLocation at;
};
struct Rbar {
  int id = 0, ga = 0, gb = 0;
  unsigned cna = 0, cnb = 0, cma = 0, cmb = 0;
  CardLocation at;
};

/// Components of one grid: a term of RBE1, SUPORT, ASET, OMIT.
struct GridComponents {
  int g = 0;
  unsigned c = 0;  ///< 0: a scalar point
  CardLocation at;
};
/// RBE1: the six independent components hold the body, the dependent ones follow it.
struct Rbe1 {
  int id = 0;
  std::vector<GridComponents> independent, dependent;
  CardLocation at;
};
/// DMIG: a matrix given term by term on the displacement (CD) axes.
struct DirectMatrix {
  struct Entry {
    int gj = 0, cj = 0, gi = 0, ci = 0;  ///< column, row; component 0 = scalar point
    double value = 0;                    ///< real part
    double imaginary = 0;
  };
  std::string name;
  int form = 6;  ///< 1 square, 2 rectangular, 6 symmetric (a term stands for its mirror), 9 rectangular
  bool is_complex = false;
  std::vector<Entry> entries;
  CardLocation at;
};

/// SPC (with enforced value d) and SPC1 flattened to one record per grid and mask.
struct Spc {
  int sid = 0, g = 0;
  unsigned c = 0;
  double d = 0;
  bool skip_if_missing = false;  ///< from a THRU range: Nastran ignores ids that do not exist
  CardLocation at;
};
struct MpcTerm {
  int g = 0, c = 0;
  double a = 0;
};
struct Mpc {
  int sid = 0;
  std::vector<MpcTerm> terms;  ///< the first one is dependent
  CardLocation at;
};
struct SetUnion {  ///< SPCADD, MPCADD
  int sid = 0;
  std::vector<int> sets;
  CardLocation at;
};

struct PointLoad {  ///< FORCE or MOMENT
  int sid = 0, g = 0, cid = 0;
  double f = 0;
  Vector3d n = Vector3d::Zero();
  bool is_moment = false;
  CardLocation at;
};
struct Gravity {
  int sid = 0, cid = 0;
  double a = 0;
  Vector3d n = Vector3d::Zero();
  CardLocation at;
};
struct LoadCombination {
  int sid = 0;
  double s = 1;
  std::vector<std::pair<double, int>> terms;  ///< (scale, set)
  CardLocation at;
};

/// EIGRL and EIGR; f1, f2 in Hz (load factors for buckling).
struct EigenMethod {
  int sid = 0;
  bool is_eigrl = true;
  std::string method;  ///< EIGR: LAN, GIV, ...
  std::optional<double> f1, f2;
  int num_modes = 0;            ///< 0: by range
  bool is_lowest_only = false;  ///< num_modes is 1 for want of a number and of an upper end
  std::string norm = "MASS";    ///< MASS, MAX, POINT
  int norm_grid = 0, norm_component = 0;
  CardLocation at;
};

struct Param {
  std::string name;   ///< upper case
  std::string value;  ///< first value, as text, upper case
  CardLocation at;
};

struct Subcase {
  int id = 0;  ///< 0: what stands above the first SUBCASE (already merged into each subcase)
  std::string title, subtitle, label;
  int spc = 0, mpc = 0, load = 0, method = 0, statsub = 0;  ///< 0: none
  int preload = 0;                                          ///< STATSUB(PRELOAD), and STATSUB of modes of any kind
  CardLocation preload_at;
  int temperature = 0;          ///< TEMPERATURE(LOAD) or (BOTH)
  int initial_temperature = 0;  ///< TEMPERATURE(INITIAL)
  int material_temperature =
      0;  ///< TEMPERATURE(MATERIAL), (BOTH) or without parentheses: where materials are evaluated
  int suport1 = 0, nsm = 0;
  int deform = 0;                                                ///< DEFORM, which is not read: an error where it loads
  std::vector<std::pair<double, std::string>> k2gg, m2gg, b2gg;  ///< (scale, DMIG name)
  std::map<std::string, CardLocation> commands;  ///< where "SPC", "LOAD", "METHOD", ... of this subcase stand

  /// Where `command` selects something for this subcase; line 0 where none does.
  CardLocation find_command(const std::string& command) const;
};

/// A card that Bough does not use: what it would have carried, how often, and where first.
enum class CardEffect { Stiffness, Mass, Constraint, Load, Damping, None };
struct UnusedCard {
  std::string name;
  CardEffect effect = CardEffect::None;
  int count = 0;
  CardLocation first;
};

/// A set of load cards that is not read, and no --ignore leaves out: an error where it loads.
struct UnreadLoad {
  std::string card;     ///< its name
  std::string command;  ///< of the case control that selects it: LOAD, TEMPERATURE
  int set = 0;
  CardLocation at;  ///< of the first card of the set
};

struct Deck {
  std::vector<std::string> files;  ///< as opened; files[0] is the deck
  std::string sol;                 ///< "103", "SEMODES", ... upper case; empty in a fragment
  /// Settings of NASTRAN statements, upper case: "BARMASS" -> "1", "SYSTEM(304)" -> "5"; the last one given counts.
  std::map<std::string, std::string> system_cells;
  std::vector<Subcase> subcases;  ///< at least one

  std::vector<Grid> grids;
  std::vector<int> scalar_points;  ///< SPOINT, and those that CELAS3/4, CMASS3/4 name
  std::vector<CoordSystem> coord_systems;
  std::vector<Mat1> mat1;
  std::vector<Mat2> mat2;
  std::vector<Mat8> mat8;
  std::vector<Mat9> mat9;
  std::vector<Pbar> pbar;
  std::vector<Pbarl> pbarl;
  std::vector<Pbeam> pbeam;
  std::vector<Pbeaml> pbeaml;
  std::vector<Prod> prod;
  std::vector<Ptube> ptube;
  std::vector<Pelas> pelas;
  std::vector<Pbush> pbush;
  std::vector<Pmass> pmass;
  std::vector<Pbush1d> pbush1d;
  std::vector<Pdamp> pdamp;
  std::vector<Pvisc> pvisc;
  std::vector<Pshell> pshell;
  std::vector<Pcomp> pcomp;
  std::vector<Pshear> pshear;
  std::vector<Psolid> psolid;
  std::vector<BeamElement> beams;
  std::vector<Crod> crod;
  std::vector<Conrod> conrod;
  std::vector<Ctube> ctube;
  std::vector<ScalarSpring> springs;
  std::vector<Cbush> cbush;
  std::vector<Cbush1d> cbush1d;
  std::vector<ScalarDamper> dampers;
  std::vector<Cvisc> cvisc;
  std::vector<ShellElement> shells;
  std::vector<ShearPanel> shear_panels;
  std::vector<SolidElement> solids;
  std::vector<ScalarMass> scalar_masses;
  std::vector<Conm1> conm1;
  std::vector<Conm2> conm2;
  std::vector<Rbe2> rbe2;
  std::vector<Rbe3> rbe3;
  std::vector<Rbar> rbar;
  std::vector<Rrod> rrod;
  std::vector<Rbe1> rbe1;
  std::vector<DirectMatrix> direct_matrices;
  std::set<std::string> response_matrices;  ///< names that K2PP, M2PP and B2PP select where no response is asked for
  std::vector<GridComponents> suport;       ///< SUPORT
  std::map<int, std::vector<GridComponents>> suport1;  ///< SUPORT1, by set
  std::vector<GridComponents> aset, omit;              ///< ASETi, OMITi, flattened; empty: no reduction
  std::vector<GridComponents> qset;                    ///< QSETi: component modes, which are not computed
  std::vector<GridComponents> bset, cset;              ///< BSETi, CSETi: the boundary of a component
  std::vector<Plotel> plotel;
  std::vector<Spc> spc;
  std::vector<SetUnion> spcadd;
  std::vector<Mpc> mpc;
  std::vector<SetUnion> mpcadd;
  std::vector<PointLoad> point_loads;
  std::vector<Gravity> gravity;
  std::vector<LoadCombination> loads;
  TemperatureCards temperatures;
  LoadCards load_cards;  ///< PLOADx, RFORCE, SPCD, SLOAD, FORCE1 ...
  SuperelementCards super;
  std::vector<Superelement> superelements;  ///< of `super`, with their matrices (matrices::read_superelements)
  SpecialCards special;                     ///< PBCOMP, GENEL, CBEND, NSM, RSPLINE, CGAP, ACCEL
  std::vector<EigenMethod> eigen_methods;
  std::vector<Param> params;
  std::optional<Param> autospc_command;  ///< AUTOSPC of the case control, above PARAM,AUTOSPC
  std::vector<UnusedCard> unused;
  std::vector<UnreadLoad> unread_loads;
  std::vector<std::string> left_out;       ///< what the record does not keep of cards that it reads: "12 fluid GRID"
  std::map<std::string, int> card_counts;  ///< every card name in the bulk data
  /// Ids of cards that were rejected with an error, by card name: references to them are not reported again.
  std::map<std::string, std::set<int>> refused;

  /// Value of a PARAM, the last one given; nullptr when absent.
  /// The last of its name; for AUTOSPC the command of the case control, where there is one.
  const Param* find_param(const std::string& name) const;
  /// File and line of a card; an empty file name if it is not of this deck.
  SourceLocation locate(const CardLocation& at) const;
  /// Returns true if one of the cards (names such as "MAT1") was rejected under this id.
  bool is_refused(int id, const std::vector<std::string>& cards) const;
};

}  // namespace bough::records
