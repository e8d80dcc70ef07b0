#pragma once
/// \file Cards of rotors: lines of grids, spin rates, unbalances (docs/theory/rotors.md).
#include <string>
#include <vector>

#include "formats/records/card_location.hpp"

namespace bough::records {

struct RotorLine {  ///< ROTORG
  struct Range {
    int first = 0, last = 0, step = 1;
    bool is_thru = false;  ///< of a range those grids that exist
  };
  int id = 0;
  std::vector<Range> grids;
  CardLocation at;
};

/// RSPINR: direction of positive spin, spin rates in proportion to other rotors, damping of the rotor.
struct RotorSpin {
  int rotor = 0, grid_a = 0, grid_b = 0;
  double unit = 1;  ///< rad per unit of time of one unit of the rates
  int table = 0;    ///< DDVAL; 0: `rate`
  double rate = 0;
  double gr = 0, alpha1 = 0, alpha2 = 0;
  double wr3 = 0, wr4 = 0;  ///< [1/T] where GR and GE become viscous; 0: PARAM,WR3 and WR4
  CardLocation at;
};

struct RotorAnalysis {  ///< RGYRO
  int sid = 0, reference = 0;
  bool is_synchronous = false;
  double unit = 1;           ///< as RotorSpin::unit
  double low = 0, high = 0;  ///< synchronous: range of the reference rotor
  int speeds = 0;            ///< RSPEED; 0: `speed`
  double speed = 0;
  CardLocation at;
};

struct SpeedList {  ///< RSPEED: first + i step, i = 0..count
  int sid = 0, count = 1;
  double first = 0, step = 0;
  CardLocation at;
};

struct ValueList {  ///< DDVAL
  int id = 0;
  std::vector<double> values;
  CardLocation at;
};

/// ROTORD of Simcenter Nastran: speeds and rotors on one card.
struct RotorSweepCard {
  struct Rotor {
    int id = 0, line = 0;      ///< RID, RSET
    double speed = 1;          ///< RSPEED, relative to the speeds of the card
    int cid = 0;               ///< RCORD: turns about its z axis
    bool is_rotating = false;  ///< REFSYS of the card: ROT, else FIX
    bool has_stress = false;   ///< RFORCE names the centrifugal load
    double w3 = 0, w4 = 0;     ///< [1/T]
    CardLocation at;
  };
  int sid = 0, count = 1;
  double first = 0, step = 0;  ///< [1/T] rad per unit of time
  double shapes_at = -1;       ///< [1/T] CMOUT; negative: all speeds
  std::vector<Rotor> rotors;
  CardLocation at;
};

/// UNBALNC: the force m r ω² of a mass m at radius r, turning with the rotor.
struct Unbalance {
  int sid = 0, grid = 0;
  double mass = 0, radius = 1, offset = 0;                 ///< offset: along the axis
  int mass_table = 0, radius_table = 0, offset_table = 0;  ///< TABLEDi over frequency; 0: the number
  double x[3] = {0, 0, 0};                                 ///< direction of angle 0, in the CD axes of the grid
  double angle_deg = 0;
  double from_hz = 0, to_hz = 1e30;
  CardLocation at;
};

struct RotorCards {
  std::vector<RotorLine> lines;
  std::vector<RotorSpin> spins;
  std::vector<RotorAnalysis> analyses;
  std::vector<SpeedList> speeds;
  std::vector<ValueList> values;
  std::vector<RotorSweepCard> sweeps;
  std::vector<Unbalance> unbalances;
};

}  // namespace bough::records
