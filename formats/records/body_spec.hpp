#pragma once
/// \file A body file (TOML: [body] [body.modes] [[body.load]] [body.damping] [body.output]) as a record.
#include <optional>
#include <string>
#include <vector>

#include "bough/base/diagnostic.hpp"
#include "bough/formats/records/flex_body.hpp"
#include "bough/formats/records/matrices_spec.hpp"

namespace bough::records {

enum class BodyFrame {
  Fixed,  ///< the deck's SPC set carries the frame: fixed-frame modes
  Free    ///< free-free modes; rigid modes are removed
};

struct ExternalLoadSpec {
  std::string name;
  int node = 0;                 ///< with direction: a unit load there
  std::vector<int> directions;  ///< 1..6
  int load_set = 0;             ///< or a LOAD/FORCE/MOMENT/GRAV set of the deck
  SourceLocation at;
};

struct BodySpec {
  std::string file;  ///< the TOML file, empty when made from the command line
  std::string name;
  std::string deck;  ///< path, relative to the TOML file's folder when read from one
  int subcase = 0;   ///< 0: the first
  BodyFrame frame = BodyFrame::Fixed;
  std::vector<int> support;  ///< free: node(s) of the determinate support on which K_G is solved; empty = chosen
  std::vector<int> interface_nodes;  ///< get three translational locators each
  std::optional<Vector3d> origin;    ///< Bo in basic; default: basic origin

  int num_modes = 0;
  std::optional<double> max_frequency_hz;
  std::vector<int> select;          ///< 1-based elastic modes kept, in this order; empty = all
  std::string mass = "deck";        ///< "deck" (COUPMASS decides), "lumped", "consistent"
  std::string integrals = "exact";  ///< set the solver uses

  std::vector<InertialLoad> inertial_loads;  ///< empty = all twelve
  std::vector<ExternalLoadSpec> loads;

  double damping_ratio = 0;            ///< uniform
  std::vector<double> damping_ratios;  ///< or per mode

  std::vector<int> output_nodes;  ///< empty = all grids
  std::string output_file;        ///< empty = NAME.h5
  bool full = false;
  std::vector<std::string> ignore_cards;

  std::optional<MatricesSpec> matrices;  ///< instead of the deck's elements
};

}  // namespace bough::records
