#include "formats/hdf5/layouts/rows.hpp"

namespace bough::hdf5 {

namespace {

constexpr const char* kAsNames = "as the names' dims say";
constexpr const char* kOfOutput = "the output's dims";
constexpr const char* kNameDims = "their dimensions in M L T F";

std::vector<LayoutRow> list_unit_rows() {
  using enum ArrayKind;
  constexpr const char* kGiven = "if `[units]` has it";
  return {
      {"/@length_unit", Text, "", "", "", kGiven, "", "label of [`[units]`](system-toml.md#units); converts nothing"},
      {"/@mass_unit", Text, "", "", "", kGiven, "", "likewise"},
      {"/@time_unit", Text, "", "", "", kGiven, "", "likewise"},
      {"/@force_unit", Text, "", "", "", kGiven, "", "likewise"},
  };
}

std::vector<LayoutRow> list_model_rows() {
  using enum ArrayKind;
  constexpr const char* kContinuous = "without `/sample_time`";
  return {
      {"/states/name", Text, "nx", "1", "names of the states: displacements of the DOFs, then their rates"},
      {"/states/dims", Text, "nx", "1", kNameDims},
      {"/inputs/name", Text, "nu", "1", "names of the inputs: departures from their values at the operating point", "",
       "", "forces by name, or coordinates of hinges"},
      {"/inputs/dims", Text, "nu", "1", kNameDims},
      {"/outputs/name", Text, "ny", "1", "names of the outputs: departures from their values at the operating point",
       "", "", "`sensor:component`, or the sensor when it is a scalar"},
      {"/outputs/dims", Text, "ny", "1", kNameDims},
      {"/sample_time", Real, "1", "T", "x+ = A x + B u, y = C x + D u",
       "of a [sampled loop](../theory/linear.md#sampled-loops)", "",
       "poles are λ = ln z / sample_time, z = exp(λ sample_time); a loop of several rates has N inputs `NAME@1` to "
       "`NAME@N` and outputs `NAME@1:return`"},
      {"/A", Real, "nx, nx", kAsNames, "{equation}: state, state", "", "",
       "equation: x_dot = A x + B u; with `/sample_time` x+ = A x + B u"},
      {"/B", Real, "nx, nu", kAsNames, "{equation}: state, input"},
      {"/C", Real, "ny, nx", kAsNames, "y = C x + D u: output, state"},
      {"/D", Real, "ny, nu", kAsNames, "y = C x + D u: output, input"},
      {"/second_order/M", Real, "n, n", kAsNames, "M d'' + D d' + K d = F u + Z z, d displacements: mass matrix",
       kContinuous, "",
       "z: states after the rates, of controllers, actuators and sensors ([how](../theory/linear.md#second-order))"},
      {"/second_order/D", Real, "n, n", kAsNames, "damping, and gyroscopic terms of a motion", kContinuous},
      {"/second_order/K", Real, "n, n", kAsNames, "stiffness, of loads and of a motion too", kContinuous},
      {"/second_order/F", Real, "n, nu", kAsNames, "displacement, input", kContinuous},
      {"/second_order/Z", Real, "n, nz", kAsNames, "displacement, state of controllers, actuators, sensors",
       "where there are such states"},
      {"/operating_point/time", Real, "1", "T", "time"},
      {"/operating_point/q", Real, "nq", "1 or L",
       "hinge coordinates (quaternions w, x, y, z), then modal coordinates, body by body"},
      {"/operating_point/u", Real, "nv", "1/T or L/T", "hinge rates, then modal rates, body by body"},
      {"/operating_point/positions/name", Text, "nq", "1", "names of the entries of q"},
      {"/operating_point/positions/dims", Text, "nq", "1", kNameDims},
      {"/operating_point/speeds/name", Text, "nv", "1", "names of the entries of u"},
      {"/operating_point/speeds/dims", Text, "nv", "1", kNameDims},
      {"/operating_point/periodic", Text, "np", "1", "coordinates that are angles, the same again after 2 pi"},
      {"/operating_point/residual", Real, "1", "1/T^2 or L/T^2", "norm of u_dot: 0 at rest and in a steady motion"},
      {"/accuracy/error", Real, "1", "1", "estimated error of A and C, relative to the largest entry of the row", "",
       "",
       "of a thousandth of that of the rows with the same dimensions, where that is more; or half the difference of "
       "two "
       "slopes at a kink, with the columns of commands and the samples"},
      {"/accuracy/difference", Real, "1", "1",
       "of A and C between two step sizes, relative to the largest entry of the row"},
  };
}

std::vector<LayoutRow> list_pole_rows() {
  using enum ArrayKind;
  constexpr const char* kSampled = "of a sampled loop";
  constexpr const char* kAliased = "of a sampled loop with modes faster than half the sample rate";
  constexpr const char* kHankel = "with [Hankel singular values](../theory/linear.md#hankel-singular-values)";
  constexpr const char* kUncertain = "with [uncertain parameters](../theory/linear.md#uncertain-parameters)";
  constexpr const char* kZeros = "where nu = ny";
  return {
      {"/poles/real", Real, "nx", "1/T", "{poles}, real part", "", "",
       "poles: eigenvalues of A; of a sampled loop ln z / sample_time of the eigenvalues z of A, least 1e-16"},
      {"/poles/imag", Real, "nx", "1/T", "{poles}, imaginary part"},
      {"/poles/frequency_hz", Real, "nx", "1/T", "|pole| / 2 pi"},
      {"/poles/damping", Real, "nx", "1", "-real / |pole|; 0 for a pole at 0"},
      {"/poles/error", Real, "nx", "1/T", "what a pole may be off by, estimated", "without `/sample_time`", "",
       "[how](../theory/linear.md#poles-and-zeros)"},
      {"/poles/mode", Text, "nx", "1", "the coordinate that takes part most"},
      {"/poles/body_mode", Text, "nx", "1", "the mode of a body that does; empty: none"},
      {"/poles/hinge", Text, "nx", "1", "the hinge coordinate that does; empty: none"},
      {"/aliased/mode", Text, "na", "1", "coordinate that takes part most in a mode above the Nyquist frequency",
       kAliased},
      {"/aliased/frequency_hz", Real, "na", "1/T", "of the continuous motion, |Im| / 2 pi", kAliased},
      {"/aliased/appears_at_hz", Real, "na", "1/T", "of its pole ln z / sample_time", kAliased},
      {"/multipliers/period", Real, "1", "T", "of all samples together", kSampled},
      {"/multipliers/real", Real, "nm", "1", "what a period makes of a departure, eigenvalues, real part", kSampled, "",
       "= eigenvalues of the map of departures over a period, real part"},
      {"/multipliers/imag", Real, "nm", "1", "likewise, imaginary part", kSampled},
      {"/multipliers/decay", Real, "nm", "1/T", "ln |multiplier| / period", kSampled},
      {"/multipliers/frequency_hz", Real, "nm", "1/T", "|arg| / 2 pi period, up to multiples of 1 / period", kSampled},
      {"/multipliers/mode", Text, "nm", "1", "the coordinate or memory that takes part most", kSampled},
      {"/hankel/value", Real, "ns", kAsNames, "Hankel singular values of the part that decays, descending", kHankel},
      {"/hankel/controllability", Real, "nx, nx", kAsNames, "Gramian: A X + X A^T + B B^T = 0 on the part that decays",
       kHankel},
      {"/hankel/observability", Real, "nx, nx", kAsNames, "Gramian: A^T X + X A + C^T C = 0 on the part that decays",
       kHankel},
      {"/hankel/left_out", Integer, "1", "1", "poles that do not decay", kHankel},
      {"/uncertainty/name", Text, "nd", "1", "parameters whose inputs w and outputs z come first: w = delta z",
       kUncertain, "", "`NAME:w1`, `NAME:z1` first in B, C, D; poles and zeros are those of δ = 0"},
      {"/uncertainty/low", Real, "nd", kAsNames, "value at delta = -1", kUncertain},
      {"/uncertainty/high", Real, "nd", kAsNames, "value at delta = 1", kUncertain},
      {"/uncertainty/size", Integer, "nd", "1", "number of inputs, and of outputs, of the parameter", kUncertain},
      {"/zeros/real", Real, "nf", "1/T", "finite transmission zeros, real part", kZeros},
      {"/zeros/imag", Real, "nf", "1/T", "finite transmission zeros, imaginary part", kZeros},
  };
}

std::vector<LayoutRow> list_sweep_rows() {
  using enum ArrayKind;
  constexpr const char* kGrid = "with several parameters";
  return {
      {"/parameter/name", Text, "1", "1", "of the system file, or time"},
      {"/parameter/value", Real, "k", "as the parameter's", "one a point"},
      {"/grid/name", Text, "g", "1", "parameters of the system file, the last one fastest", kGrid},
      {"/grid/axis{i}", Real, "v", "as the parameter's", "values of parameter {i}", kGrid},
      {"/grid/points", Real, "k, g", "as the parameters'", "point, parameter", kGrid},
      {"/states/name", Text, "nx", "1", "names of the states: displacements of the DOFs, then their rates"},
      {"/states/dims", Text, "nx", "1", kNameDims},
      {"/inputs/name", Text, "nu", "1", "names of the inputs"},
      {"/inputs/dims", Text, "nu", "1", kNameDims},
      {"/outputs/name", Text, "ny", "1", "names of the outputs"},
      {"/outputs/dims", Text, "ny", "1", kNameDims},
      {"/A", Real, "k, nx, nx", kAsNames, "{equation} of each point"},
      {"/B", Real, "k, nx, nu", kAsNames, "{equation} of each point"},
      {"/C", Real, "k, ny, nx", kAsNames, "y = C x + D u of each point"},
      {"/D", Real, "k, ny, nu", kAsNames, "y = C x + D u of each point"},
      {"/sample_time", Real, "k", "T", "x+ = A x + B u, y = C x + D u; poles are ln z over it", "of sampled loops"},
      {"/operating_point/time", Real, "k", "T", "time of each point"},
      {"/operating_point/q", Real, "k, nq", "1 or L", "point, position (quaternions w, x, y, z)"},
      {"/operating_point/u", Real, "k, nv", "1/T or L/T", "point, speed"},
      {"/operating_point/residual", Real, "k", "1/T^2 or L/T^2", "norm of u_dot"},
      {"/operating_point/positions/name", Text, "nq", "1", "names of the columns of q"},
      {"/operating_point/positions/dims", Text, "nq", "1", kNameDims},
      {"/operating_point/speeds/name", Text, "nv", "1", "names of the columns of u"},
      {"/operating_point/speeds/dims", Text, "nv", "1", kNameDims},
      {"/poles/real", Real, "k, nx", "1/T", "point, branch: a column is one motion all along"},
      {"/poles/imag", Real, "k, nx", "1/T", "point, branch"},
      {"/poles/frequency_hz", Real, "k, nx", "1/T", "|pole| / 2 pi"},
      {"/poles/damping", Real, "k, nx", "1", "-real / |pole|; 0 for a pole at 0"},
      {"/poles/correlation", Real, "k, nx", "1", "with the motion at the point before"},
      {"/poles/whirl", Real, "k, nx", "1", "1: forward circle, -1: backward circle, 0: line", "with `--spin-axis`"},
      {"/poles/mode_first", Text, "nx", "1", "branch: the coordinate that takes part most at the first point"},
      {"/poles/mode_last", Text, "nx", "1", "branch: at the last point"},
  };
}

std::vector<LayoutRow> list_response_rows() {
  using enum ArrayKind;
  constexpr const char* kMargins = "with margins of a loop";
  constexpr const char* kRandom = "with `--psd`";
  constexpr const char* kWhite = "with `--psd` of white inputs";
  return {
      {"/inputs/name", Text, "nu", "1", "names of the inputs"},
      {"/inputs/dims", Text, "nu", "1", kNameDims},
      {"/outputs/name", Text, "ny", "1", "names of the outputs"},
      {"/outputs/dims", Text, "ny", "1", kNameDims},
      {"/frequency_hz", Real, "n", "1/T", "frequencies"},
      {"/real", Real, "n, ny, nu", kAsNames, "C (jw - A)^-1 B + D: frequency, output, input; real part"},
      {"/imag", Real, "n, ny, nu", kAsNames, "likewise, imaginary part"},
      {"/singular_values", Real, "n, min(ny, nu)", kAsNames, "frequency, descending"},
      {"/peak/value", Real, "1", kAsNames, "largest singular value of all frequencies; -1: it is infinite"},
      {"/peak/frequency_hz", Real, "1", "1/T", "where; -1: beyond all poles"},
      {"/margins/gain/frequency_hz", Real, "cg", "1/T", "of the crossing", kMargins},
      {"/margins/gain/margin", Real, "cg", "1", "factor that brings L to -1", kMargins},
      {"/margins/phase/frequency_hz", Real, "cp", "1/T", "of the crossing", kMargins},
      {"/margins/phase/margin", Real, "cp", "1", "lag that brings L to -1, rad", kMargins},
      {"/margins/phase/delay", Real, "cp", "T", "delay that does", kMargins},
      {"/margins/distance", Real, "1", "1", "least |1 + L|", kMargins},
      {"/margins/distance_hz", Real, "1", "1/T", "where", kMargins},
      {"/margins/largest_real", Real, "1", "1/T", "of the poles with the loop closed", kMargins},
      {"/random/psd", Real, "n, ny", "square of the output's dims times T",
       "one-sided spectral density, frequency x output", kRandom},
      {"/random/cumulative_rms", Real, "n, ny", kOfOutput, "RMS from the first frequency to each", kRandom},
      {"/random/rms", Real, "ny", kOfOutput, "over the frequencies, by straight lines of the density", kRandom},
      {"/random/zero_crossings_hz", Real, "ny", "1/T", "N0, zero crossings with positive slope, likewise", kRandom},
      {"/random/band_rms", Real, "ny", kOfOutput, "by integration from the first to the last frequency", kRandom},
      {"/random/band_zero_crossings_hz", Real, "ny", "1/T", "N0 by integration over the band", kRandom},
      {"/random/total_rms", Real, "ny", kOfOutput,
       "white inputs, all frequencies, by Lyapunov's equation; -1: no bound", kWhite},
      {"/random/total_zero_crossings_hz", Real, "ny", "1/T", "N0 of white inputs; -1: no bound", kWhite},
  };
}

std::vector<LayoutRow> list_budget_rows() {
  using enum ArrayKind;
  constexpr const char* kCurves = "of sources with a curve";
  constexpr const char* kWheels = "of wheels";
  return {
      {"/outputs/name", Text, "o", "1", "names of the outputs"},
      {"/outputs/dims", Text, "o", "1", kNameDims},
      {"/sources/name", Text, "s", "1", "names of the sources"},
      {"/band_hz", Real, "2", "1/T", "ends of the spectral densities; 0: there is none"},
      {"/tables/weighting", Text, "t", "1", "total, jitter, smear, residual, mean, drift"},
      {"/tables/exposure", Real, "t", "T", "window; 0: total"},
      {"/tables/rms", Real, "t, s, o", kOfOutput, "table, source, output; wheels at their worst speed"},
      {"/tables/speed", Real, "t, s, o", "1/T", "that speed; NaN: the source is no wheel", "", "",
       "radians per unit of time"},
      {"/tables/total", Real, "t, o", kOfOutput, "root of the sum of squares: table, output"},
      {"/curves/{k}/frequency_hz", Real, "n, o", "1/T", "of each output", kCurves, "",
       "k: number of the source, from 1"},
      {"/curves/{k}/rms", Real, "n, o", kOfOutput, "total RMS up to that frequency", kCurves},
      {"/wheels/{k}/speed", Real, "w", "1/T", "speeds of the wheel", kWheels},
      {"/wheels/{k}/rms", Real, "t, w, o", kOfOutput, "table, speed, output", kWheels},
  };
}

}  // namespace

Layout make_linear_layout() {
  return {"bough-linear", "linear",
          join_rows({list_root_rows(), list_unit_rows(), list_model_rows(), list_pole_rows()})};
}

Layout make_sweep_layout() {
  return {"bough-sweep", "linear", join_rows({list_root_rows(), list_unit_rows(), list_sweep_rows()})};
}

Layout make_response_layout() {
  return {"bough-response", "linear", join_rows({list_root_rows(), list_unit_rows(), list_response_rows()})};
}

Layout make_budget_layout() { return {"bough-budget", "linear", join_rows({list_root_rows(), list_budget_rows()})}; }

}  // namespace bough::hdf5
