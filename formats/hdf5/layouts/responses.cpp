#include "formats/hdf5/layouts/rows.hpp"

namespace bough::hdf5 {

namespace {

constexpr const char* kUnit = "unit: L, 1 of displacements, L/T, 1/T, L/T^2, 1/T^2, F, F L of `spc_force`";

std::vector<LayoutRow> list_response_rows() {
  using enum ArrayKind;
  constexpr const char* kModal = "if solved by modes";
  std::vector<LayoutRow> rows{
      {"/subcases/{id}@title", Text, "", "", "", "", "",
       "TITLE of the case control; id 1 where the deck has no SUBCASE"},
      {"/subcases/{id}@subtitle", Text, "", "", "", "", "", "SUBTITLE"},
      {"/subcases/{id}@label", Text, "", "", "", "", "", "LABEL"},
      {"/subcases/{id}@method", Text, "", "", "", "", "", "`modal` or `direct`"},
      {"/subcases/{id}/{quantity}/dofs", Integer, "o, 2", "1",
       "a row per column: grid and component 1..6 in its displacement (CD) axes, 0 scalar", "of requested quantities",
       "", "quantity: `displacement`, `velocity`, `acceleration`, `spc_force`"},
      {"/subcases/{id}/{quantity}@phase", Integer, "", "", "", "of requested quantities", "", "1: the deck has PHASE"},
      {"/subcases/{id}/{quantity}@punch", Integer, "", "", "", "of requested quantities", "", "1: the deck has PUNCH"},
      {"/subcases/{id}/elements/{card}/id", Integer, "e", "1", "element ids", "with FORCE"},
      {"/subcases/{id}/elements/{card}@components", Text, "c", "", "", "with FORCE", "", "names of the last index"},
      {"/subcases/{id}/elements/{card}@phase", Integer, "", "", "", "with FORCE", "", "1: the deck has PHASE"},
      {"/subcases/{id}/elements/{card}@punch", Integer, "", "", "", "with FORCE", "", "1: the deck has PUNCH"},
      {"/subcases/{id}/stresses/{card}/id", Integer, "e", "1", "element ids", "with STRESS", "",
       "elements of a card with other components: CARD-2, CARD-3, as in the [static file](static.md); over the time "
       "also `von_mises@top` and the other derived quantities of `static`"},
      {"/subcases/{id}/stresses/{card}@components", Text, "c", "", "", "with STRESS", "", "names of the last index"},
      {"/subcases/{id}/stresses/{card}@phase", Integer, "", "", "", "with STRESS", "", "1: the deck has PHASE"},
      {"/subcases/{id}/stresses/{card}@punch", Integer, "", "", "", "with STRESS", "", "1: the deck has PUNCH"},
      {"/subcases/{id}/accuracy/solution", Real, "1", "1", "{solution}", "", "",
       "= residual of the equation of motion if solved directly; else over the time the difference of a step and two "
       "halves, over the frequency the residual of the equation of the coordinates, relative to its loads"},
      {"/subcases/{id}/accuracy/basis", Real, "1", "1", "of the orthogonality of the coordinates to M and K", kModal},
      {"/subcases/{id}/modes/frequency_hz", Real, "m", "1/T",
       "of each coordinate: rigid-body motions (0), normal modes, residual vectors", kModal},
      {"/subcases/{id}/modes/damping_ratio", Real, "m", "1", "its share of the critical damping", kModal},
      {"/subcases/{id}/modes/is_residual", Integer, "m", "1", "1: a residual vector", kModal},
      {"/subcases/{id}/modes@damped_motion", Text, "", "", "", "where supports move and SDAMPING damps", "",
       "`absolute` or `relative` ([which](../theory/response.md#damping))"},
  };
  const std::vector<LayoutRow> over_time{
      {"/subcases/{id}/time", Real, "n", "T", "time of each row", "over the time"},
      {"/subcases/{id}/{quantity}/value", Real, "n, o", "{unit}", "{quantity}, a row per time", "over the time", "",
       kUnit},
      {"/subcases/{id}/elements/{card}/value", Real, "n, e, c", "F, F L",
       "forces by element and component, a row per time", "over the time, with FORCE"},
      {"/subcases/{id}/stresses/{card}/value", Real, "n, e, c", "F/L^2",
       "stresses by element and component, a row per time", "over the time, with STRESS"},
  };
  const std::vector<LayoutRow> over_frequency{
      {"/subcases/{id}/frequency_hz", Real, "n", "1/T", "frequency of each row", "over the frequency"},
      {"/subcases/{id}/{quantity}/real", Real, "n, o", "{unit}",
       "{quantity}, a row per frequency: real part of e^(i w t)", "of requested quantities", "", kUnit},
      {"/subcases/{id}/{quantity}/imag", Real, "n, o", "{unit}", "{quantity}, imaginary part",
       "of requested quantities"},
      {"/subcases/{id}/elements/{card}/real", Real, "n, e, c", "F, F L",
       "forces by element and component, a row per frequency: real part of e^(i w t)", "with FORCE"},
      {"/subcases/{id}/elements/{card}/imag", Real, "n, e, c", "F, F L",
       "forces by element and component, imaginary part", "with FORCE"},
      {"/subcases/{id}/stresses/{card}/real", Real, "n, e, c", "F/L^2",
       "stresses by element and component, a row per frequency: real part of e^(i w t)", "with STRESS"},
      {"/subcases/{id}/stresses/{card}/imag", Real, "n, e, c", "F/L^2",
       "stresses by element and component, imaginary part", "with STRESS"},
  };
  return join_rows({rows, over_time, over_frequency});
}

/// Rows of spectra below a group: of points with `dofs`, of elements with `id` and `components`.
std::vector<LayoutRow> list_random_rows() {
  using enum ArrayKind;
  constexpr const char* kSpectrum = "one-sided spectral density, a row per frequency";
  constexpr const char* kRms = "root mean square over the output frequencies";
  constexpr const char* kN0 = "N0, zero crossings with positive slope";
  constexpr const char* kModalRms = "root mean square by integration over the band";
  constexpr const char* kModalN0 = "N0 by integration over the band";
  constexpr const char* kRunning = "RMS from the first frequency to each";
  constexpr const char* kRandom = "with RANDOM";
  constexpr const char* kLags = "with RANDT1";
  constexpr const char* kModal = "with RANDOM, by modes";
  constexpr const char* kCross = "with RCROSS";
  constexpr const char* kSquare = "square: of the unit, times T ([theory](../theory/random-response.md))";
  return {
      {"/random/{set}@integration", Text, "", "", "", kRandom, "", "`linear` or `loglog` (PARAM,RMSINT)"},
      {"/random/{set}/subcases", Integer, "k", "1", "whose loads RANDPS relates", kRandom},
      {"/random/{set}/frequency_hz", Real, "n", "1/T", "frequency of each row", kRandom},
      {"/random/{set}/lag", Real, "t", "T", "of the autocorrelation", kLags},
      {"/random/{set}/integral_error", Real, "1", "1",
       "relative, of the mean squares of the coordinates by integration over the band", kModal},
      {"/random/{set}/{quantity}/dofs", Integer, "o, 2", "1",
       "a row per column: grid and component 1..6 in its displacement (CD) axes, 0 scalar", kRandom},
      {"/random/{set}/{quantity}/psd", Real, "n, o", "{square}", kSpectrum, kRandom, "", kSquare},
      {"/random/{set}/{quantity}/cumulative_rms", Real, "n, o", "{unit}", kRunning, kRandom},
      {"/random/{set}/{quantity}/autocorrelation", Real, "t, o", "square of the unit of rms", "a row per lag", kLags},
      {"/random/{set}/{quantity}/rms", Real, "o", "{unit}", kRms, kRandom},
      {"/random/{set}/{quantity}/zero_crossings_hz", Real, "o", "1/T", kN0, kRandom},
      {"/random/{set}/{quantity}/modal_rms", Real, "o", "{unit}", kModalRms, kModal},
      {"/random/{set}/{quantity}/modal_zero_crossings_hz", Real, "o", "1/T", kModalN0, kModal},
      {"/random/{set}/{group}/{card}/id", Integer, "e", "1", "element ids", kRandom, "",
       "group: `elements`, `stresses`; stresses with `von_mises` of each point"},
      {"/random/{set}/{group}/{card}@components", Text, "c", "", "", kRandom, "", "names of the last index"},
      {"/random/{set}/{group}/{card}/psd", Real, "n, e, c", "{square}", kSpectrum, kRandom},
      {"/random/{set}/{group}/{card}/cumulative_rms", Real, "n, e, c", "{unit}", kRunning, kRandom},
      {"/random/{set}/{group}/{card}/autocorrelation", Real, "t, e, c", "square of the unit of rms", "a row per lag",
       kLags},
      {"/random/{set}/{group}/{card}/rms", Real, "e, c", "{unit}", kRms, kRandom},
      {"/random/{set}/{group}/{card}/zero_crossings_hz", Real, "e, c", "1/T", kN0, kRandom},
      {"/random/{set}/{group}/{card}/modal_rms", Real, "e, c", "{unit}", kModalRms, kModal},
      {"/random/{set}/{group}/{card}/modal_zero_crossings_hz", Real, "e, c", "1/T", kModalN0, kModal},
      {"/random/{set}/cross/{k}@quantities", Text, "2", "", "", kCross, "", "of a, of b"},
      {"/random/{set}/cross/{k}/dofs", Integer, "2, 2", "1", "grid and component of a, then of b", kCross},
      {"/random/{set}/cross/{k}/curve", Integer, "1", "1", "CURID of RCROSS, 0: none", kCross},
      {"/random/{set}/cross/{k}/real", Real, "n", "unit of a times that of b times T", "of S_ab = E[A B*], one-sided",
       kCross},
      {"/random/{set}/cross/{k}/imag", Real, "n", "unit of a times that of b times T", "of S_ab", kCross},
      {"/random/{set}/cross/{k}/coherence", Real, "n", "1", "abs(S_ab)^2 / (S_aa S_bb)", kCross},
      {"/random/{set}/cross/{k}/covariance", Real, "1", "unit of a times that of b",
       "E[a(t) b(t)] over the output frequencies", kCross},
      {"/random/{set}/cross/{k}/correlation", Real, "t", "unit of a times that of b", "E[a(t + lag) b(t)]",
       "with RCROSS and RANDT1"},
  };
}

}  // namespace

Layout make_frequency_layout() {
  return {"bough-frequency", "response", join_rows({list_root_rows(), list_response_rows(), list_random_rows()})};
}

Layout make_transient_layout() {
  return {"bough-transient", "", join_rows({list_root_rows(), list_response_rows(), list_random_rows()})};
}

}  // namespace bough::hdf5
