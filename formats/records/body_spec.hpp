#pragma once
/// \file A body file (TOML: [body] [body.modes] [body.preload] [[body.load]] [body.damping] [body.output]) as a record.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/flex_body.hpp"
#include "formats/records/matrices_spec.hpp"

namespace bough::records {

/// Reference conditions of the body frame (docs/theory/bases.md). All but Fixed ignore the SPC set and remove the
/// rigid-body modes.
enum class BodyFrame {
  Fixed,       ///< the deck's SPC set: fixed-frame modes
  Free,        ///< nothing: free-free modes, whose mean axes the frame is
  MeanAxes,    ///< the same for any basis
  Node,        ///< one node: its translation and rotation
  ThreeNodes,  ///< 3-2-1
  MassCentre   ///< the centre of mass; turns as a node, as three, or as mean axes
};

enum class BodyBasis { Normal, CraigBampton, CraigChang };

struct DampingTableSpec {
  std::vector<std::pair<double, double>> points;  ///< Hz, value
  std::string kind = "ratio";                     ///< "ratio", "structural" (2 ζ), "quality" (1 / 2ζ)
};

struct ExternalLoadSpec {
  std::string name;
  int node = 0;                 ///< with direction: a unit load there
  std::vector<int> directions;  ///< 1..6
  int load_set = 0;             ///< or a LOAD/FORCE/MOMENT/GRAV set of the deck
  int temperature_set = 0;      ///< or a temperature set
  SourceLocation at;
};

/// Mass and inertia of a body attached to a node: included in the modes of this body, then subtracted again.
struct AugmentSpec {
  int node = 0;
  double mass = 0;                      ///< as the body's: with WTMASS
  Vector3d cg = Vector3d::Zero();       ///< its centre of mass from the node, body axes
  Matrix3d inertia = Matrix3d::Zero();  ///< about its centre of mass, body axes
  SourceLocation at;
};

/// The state of stress that the body starts from: a subcase, or sets of loads and a spin together.
struct PreloadSpec {
  int subcase = 0, load_set = 0, temperature_set = 0;
  Vector3d spin = Vector3d::Zero();  ///< angular velocity about Bo, body axes
  bool is_nonlinear = false;         ///< large displacements: the body starts from the deformed shape
  SourceLocation at;
};

struct BodySpec {
  std::string file;  ///< the TOML file, empty when made from the command line
  /// Places of the keys in the file by their paths below [body]: "frame", "modes", "modes/select".
  std::map<std::string, SourceLocation> places;
  std::string name;
  std::string deck;  ///< path, relative to the TOML file's folder when read from one
  int subcase = 0;   ///< 0: the first
  BodyFrame frame = BodyFrame::Fixed;
  std::vector<int> support;  ///< free: node(s) of the determinate support on which K_G is solved; empty = chosen
  std::vector<int> interface_nodes;  ///< get locators: three forces, three moments
  bool interface_moments = true;     ///< false: no moments there
  std::vector<int> frame_nodes;      ///< Node: one; ThreeNodes: three; MassCentre: none, one or three
  std::optional<Vector3d> origin;    ///< Bo in basic; default: basic origin
  int origin_node = 0;               ///< or at this node
  bool origin_at_mass_centre = false;

  BodyBasis basis = BodyBasis::Normal;
  bool orthogonalize = true;          ///< Craig-Bampton, augmented: modes of K^N = M^ND, else its own coordinates
  std::vector<std::string> residual;  ///< loads with a residual vector: names, "inertial", "interface"
  int num_modes = 0;
  std::optional<double> max_frequency_hz;
  std::vector<int> select;          ///< 1-based elastic modes kept, in this order; empty = all
  std::string mass = "deck";        ///< "deck" (COUPMASS decides), "lumped", "consistent"
  std::string integrals = "exact";  ///< set the solver uses

  std::vector<InertialLoad> inertial_loads;  ///< empty = all twelve
  int stiffening_order = 2;                  ///< 3: displacements to degree 4 in the large modes
  int num_large = 0;                         ///< large modes, the first; 0: kDefaultLargeModes at most
  std::vector<int> large_modes;              ///< or those named, from 1
  std::vector<ExternalLoadSpec> loads;
  std::optional<PreloadSpec> preload;
  std::vector<AugmentSpec> augments;

  double damping_ratio = 0;            ///< uniform
  std::vector<double> damping_ratios;  ///< or per mode
  DampingTableSpec damping_table;      ///< or over frequency
  double rayleigh_alpha = 0, rayleigh_beta = 0;
  double structural_damping = 0;           ///< g, besides
  bool has_material_damping = false;       ///< GE of the deck, PARAM,G
  std::optional<double> residual_damping;  ///< ζ of residual and attachment vectors

  std::vector<int> output_nodes;  ///< empty = all grids
  std::string output_file;        ///< empty = NAME.h5
  bool full = false;
  std::vector<std::string> recover;  ///< elements with /recovery: ALL, ids, ranges "A-B", "property:ID", "card:CBAR"
  bool strain_energy = false;        ///< of each element, in the modes
  std::vector<std::string> ignore_cards;

  std::optional<MatricesSpec> matrices;  ///< instead of the deck's elements

  /// Place of a key; of its table, or of the file, where it is absent.
  SourceLocation locate(const std::string& key) const {
    for (const std::string& name : {key, key.substr(0, key.find('/'))})
      if (const auto found = places.find(name); found != places.end()) return found->second;
    return {file, 0, 0};
  }
};

}  // namespace bough::records
