#pragma once
/// \file A deck with what drives it: loads over frequency and time, tables, damping, and what its case control asks of
/// a response. Apart from deck.hpp, which most of Bough is compiled with and which needs none of it.
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "formats/records/deck.hpp"
#include "formats/records/deck_rotors.hpp"
#include "formats/records/function_table.hpp"

namespace bough::records {

/// RLOAD1, RLOAD2 (over frequency), TLOAD1, TLOAD2 (over time).
struct DynamicLoad {
  enum class Kind { Rload1, Rload2, Tload1, Tload2 };
  enum class Excitation { Force, Displacement, Velocity, Acceleration };
  Kind kind = Kind::Rload1;
  Excitation excitation = Excitation::Force;
  int sid = 0, excite = 0;  ///< EXCITEID: DAREA, static loads, or SPCD of this set
  int delay_set = 0, phase_set = 0;
  double delay = 0, phase_deg = 0;  ///< where they are numbers
  int table_a = 0, table_b = 0;     ///< TC and TD, TB and TP, TID; 0: the number is used
  double a = 0, b = 0;              ///< TLOAD1: a is F where it is a number
  double t1 = 0, t2 = 0;            ///< TLOAD2, as those below: phase in phase_deg
  double frequency_hz = 0, growth = 0, power = 0;
  CardLocation at;
};

struct DynamicLoadSum {  ///< DLOAD
  int sid = 0;
  double s = 1;
  std::vector<std::pair<double, int>> terms;  ///< (scale, set)
  CardLocation at;
};

/// DAREA, DELAY, DPHASE: a value for a component; c = 0 for a scalar point.
struct DofValue {
  int sid = 0, g = 0, c = 0;
  double value = 0;
  CardLocation at;
};

struct StaticExcitation {  ///< LSEQ
  int sid = 0, excite = 0, load = 0, temperature = 0;
  CardLocation at;
};

struct InitialMotion {  ///< TIC
  int sid = 0, g = 0, c = 0;
  double u0 = 0, v0 = 0;
  CardLocation at;
};

using DynamicTable = FunctionTable;

/// PELAST, PDAMPT, PBUSHT: TABLEDi over frequency in place of values of a property. Ids; 0: the value of the property.
struct FrequencyTables {
  std::string property;  ///< PELAS, PDAMP or PBUSH
  int pid = 0;
  std::array<int, 6> k{}, b{}, ge{};  ///< of PELAS and PDAMP the first
  CardLocation at;
};

struct DampingCurve {  ///< TABDMP1
  int id = 0;
  std::string type = "G";                         ///< G, CRIT or Q
  std::vector<std::pair<double, double>> points;  ///< Hz, value
  CardLocation at;
};

/// FREQ (kind 0) and FREQ1 to FREQ5.
struct FrequencyList {
  int sid = 0, kind = 0;
  std::vector<double> values;  ///< FREQ: Hz; FREQ5: fractions of the natural frequencies
  double f1 = 0, f2 = 0;       ///< Hz; FREQ1: first, increment
  int count = 1;               ///< NDF, NF, NEF, NFM
  bool is_log = false;         ///< FREQ3
  double spread = 0.1;         ///< FREQ3: CLUSTER; FREQ4: FSPD
  CardLocation at;
};

struct TimeSteps {  ///< TSTEP
  struct Part {
    int count = 0;
    double step = 0;
    int every = 1;
  };
  int sid = 0;
  std::vector<Part> parts;
  CardLocation at;
};

/// RANDPS: S_jk(f) = (x + i y) G(f), the spectral density between the loads of subcases j and k.
struct SpectralTerm {
  int sid = 0, j = 0, k = 0;
  double x = 0, y = 0;
  int table = 0;  ///< TABRND1 or TABRNDG; 0: G = 1
  CardLocation at;
};

/// TABRNDG: spectral density of atmospheric turbulence.
struct GustSpectrum {
  int id = 0;
  bool is_dryden = false;        ///< else von Karman
  double length_over_speed = 0;  ///< L/U [T]
  double rms = 0;                ///< WG
  CardLocation at;
};

/// RANDT1: lags of the autocorrelation, first + i (last - first)/count, i = 0..count.
struct TimeLags {
  int sid = 0, count = 1;
  double first = 0, last = 0;
  CardLocation at;
};

/// RCROSS: cross-spectral density and cross-correlation of two components of grids.
struct CrossRequest {
  struct Output {
    std::string quantity;  ///< DISP, VELO, ACCE, SPCF or a word that is not computed
    int id = 0, component = 0;
  };
  int sid = 0;
  Output a, b;
  int curve = 0;  ///< CURID, 0: none
  CardLocation at;
};

/// DESVAR of SOL 200 that a relation to a property uses.
struct DesignVariable {
  int id = 0;
  std::string label;
  double value = 0;  ///< at the start
  CardLocation at;
};

/// USET and USET1 with U6, RVDOF, RVDOF1: unit forces whose residual vectors join the modes.
struct ResidualDofs {
  int first = 0, last = 0;  ///< grids; of a range those that exist
  std::string components;   ///< "13"; empty: a scalar point
  CardLocation at;
};

/// EIGC: complex eigenvalues.
struct ComplexMethod {
  /// A continuation line: the shift, or one end of a search region.
  struct Shift {
    double alpha = 0, omega = 0;  ///< [1/T] real and imaginary part
    int num_modes = 0;            ///< ND of the line; 0: blank
  };
  int sid = 0;
  std::string method;        ///< LAN, CLAN, HESS, INV, DET or ISRR
  std::string norm = "MAX";  ///< MAX, POINT
  int norm_grid = 0, norm_component = 0;
  int num_modes = 0;  ///< ND; 0: blank
  std::vector<Shift> shifts;
  CardLocation at;
};

/// TF: (B0 + B1 p + B2 p²) u_d + Σ (A0 + A1 p + A2 p²) u_i = 0, p the derivative.
struct TransferFunction {
  struct Term {
    int g = 0, c = 0;
    double a0 = 0, a1 = 0, a2 = 0;
  };
  int sid = 0;
  Term of;  ///< u_d with B0, B1, B2
  std::vector<Term> terms;
  CardLocation at;
};

struct DynamicCards {
  std::vector<DynamicLoad> loads;
  std::vector<DynamicLoadSum> sums;
  std::vector<DofValue> areas, delays, phases;
  std::vector<StaticExcitation> lseq;
  std::vector<InitialMotion> initial;
  std::vector<DynamicTable> tables;
  std::vector<FrequencyTables> frequency_tables;
  std::vector<DampingCurve> damping;
  std::vector<FrequencyList> frequencies;
  std::vector<TimeSteps> steps;
  std::vector<SpectralTerm> spectral_terms;
  std::vector<DynamicTable> spectra;  ///< TABRND1
  std::vector<GustSpectrum> gust_spectra;
  std::vector<TimeLags> lags;
  std::vector<CrossRequest> crosses;
  std::vector<DesignVariable> design_variables;  ///< by id; empty but for SOL 200
  std::vector<ResidualDofs> residual_dofs;
  std::vector<ComplexMethod> complex_methods;
  std::vector<TransferFunction> transfer_functions;
  /// EPOINT: dofs of complex modes. Normal modes have none, and loads there act on nothing.
  std::set<int> extra_points;
  RotorCards rotors;
};

/// SET of the case control: ids, or numbers such as frequencies.
struct CaseSet {
  struct Range {
    double first = 0, last = 0;  ///< equal for a single one
    bool is_excluded = false;    ///< EXCEPT
  };
  bool is_all = false;
  std::vector<Range> ranges;
  /// Returns true if the set includes the id; a range of EXCEPT takes precedence over all others.
  bool contains(int id) const {
    bool is_in = is_all;
    for (const auto& range : ranges) {
      if (id < range.first || id > range.last) continue;
      if (range.is_excluded) return false;
      is_in = true;
    }
    return is_in;
  }
};

/// DISPLACEMENT(PHASE, PUNCH) = 12 and the like.
struct OutputRequest {
  bool is_all = false, is_none = false;
  int set = 0;
  bool is_phase = false;  ///< magnitude and phase, else real and imaginary parts
  bool is_punched = false;
  bool is_printed = true;  ///< PRINT, or neither it nor PLOT and PUNCH
  bool is_fibre = false;   ///< STRAIN(FIBER): strains of plates at Z1 and Z2
  CardLocation at;
};

/// Response requests of a subcase.
struct DynamicSelection {
  int dload = 0, loadset = 0, frequency = 0, tstep = 0, ic = 0, sdamping = 0;
  int cmethod = 0, tfl = 0;    ///< of complex modes
  int ofreq = 0;               ///< a SET; 0: all
  int random = 0;              ///< set of RANDPS and RANDT1
  int rcross = 0;              ///< set of RCROSS
  int rgyro = 0, rmethod = 0;  ///< RGYRO and ROTORD cards
  int modsel = 0;              ///< MODSEL, MODESELECT: a SET of mode numbers; 0: all
  /// (scale, DMIG name) of K2PP, M2PP, B2PP. In a response they are in k2gg, m2gg and b2gg of the subcase too.
  std::vector<std::pair<double, std::string>> k2pp, m2pp, b2pp;
  std::optional<bool> resvec;  ///< RESVEC = YES, NO
  /// MEFFMASS: the grid of its GRID option (0: the origin); none where it is not asked for.
  std::optional<int> effective_mass_grid;
  /// Output requests by command: DISPLACEMENT, VELOCITY, ACCELERATION, SPCFORCES, FORCE; for print files also OLOAD,
  /// MPCFORCES, STRESS, STRAIN.
  std::map<std::string, OutputRequest> outputs;
  std::map<int, CaseSet> sets;
};

struct DynamicSubcase : Subcase {
  DynamicSubcase() = default;
  /// A subcase of a static deck with the selection of its dynamic commands.
  DynamicSubcase(const Subcase& subcase, DynamicSelection selection)
      : Subcase(subcase), dynamics(std::move(selection)) {}
  DynamicSelection dynamics;
};

/// SUBCOM, SYMCOM, REPCASE: results made of those of subcases before.
struct CaseCombination {
  Subcase control;  ///< id and titles
  DynamicSelection selection;
  std::string command;
  std::vector<std::pair<double, int>> terms;  ///< (factor, subcase)
  CardLocation at;
};

/// SURFACE or VOLUME of OUTPUT(POST): elements of which grid point stresses are wanted.
struct StressField {
  enum class System { Basic, Element, Cord };
  int id = 0, set = 0;  ///< set: of elements
  bool is_volume = false;
  std::set<std::string> fibres;  ///< SURFACE: of Z1, Z2, MID
  System system = System::Basic;
  int cid = 0;
  int axis = 1;                                  ///< SURFACE: x axis of the output, 1 to 3 of the system
  std::string normal = "R";                      ///< SURFACE: R, X1, X2, X3 of the system
  bool is_reversed = false;                      ///< SURFACE: normal with M
  bool is_geometric = false;                     ///< SURFACE: interpolation
  double tolerance = 0;                          ///< [deg] SURFACE: difference of slopes; 0: no test
  bool has_break = false;                        ///< SURFACE: BRANCH BREAK
  bool has_principal = true, has_direct = true;  ///< VOLUME
  CardLocation at;
};

/// Requests of the case control in addition to loads and constraints.
struct CaseRequests {
  std::map<int, DynamicSelection> selections;  ///< by subcase; 0: a deck without SUBCASE
  std::vector<CaseCombination> combinations;
  std::vector<StressField> stress_fields;
  std::map<int, CaseSet> post_sets;  ///< SET after OUTPUT(POST)
};

struct DynamicDeck : Deck {
  DynamicCards dynamics;
  std::map<int, DynamicSelection> selections;  ///< by subcase
};

}  // namespace bough::records
