#pragma once
/// \file Output of `frequency` and `transient`: curves over frequency or time at chosen grids and elements.
#include "formats/records/flex_body.hpp"
#include "formats/records/random_response.hpp"

namespace bough::records {

/// Samples x dofs, in the displacement (CD) axes of each grid. Over time `imag` is empty.
struct ResponseCurves {
  std::string quantity;                   ///< displacement, velocity, acceleration, spc_force
  std::vector<std::pair<int, int>> dofs;  ///< grid and component 1..6, 0 for a scalar point
  MatrixXd real, imag;
  bool is_phase = false, is_punched = false;  ///< as requested in the deck
  bool is_printed = true;                     ///< in the listing
};

/// Samples x (elements x components), element after element.
struct ElementCurves {
  std::string card;
  std::vector<std::string> components;
  std::vector<int> ids;
  MatrixXd real, imag;
  bool is_phase = false, is_punched = false, is_printed = true;
  bool is_stress = false;  ///< else forces
};

struct ResponseSubcase {
  int id = 0;
  std::string title, subtitle, label;
  VectorXd x;  ///< Hz, or time
  std::vector<ResponseCurves> curves;
  std::vector<ElementCurves> elements;
  std::vector<ElementCurves> listed_forces;  ///< what the stresses of a listing need of bars and solids; not written
  bool is_direct = false;                    ///< solved without modes
  VectorXd mode_hz, damping_ratio;           ///< of the coordinates
  std::vector<ModeKind> kind;
  int num_rigid = 0;
  /// Where supports move and SDAMPING damps: "absolute" (PARAM,ENFMOTN,ABS) or "relative" (REL), else empty.
  std::string damped_motion;
  double basis_error = 0;     ///< of the orthogonality of the coordinates to M and K
  double solution_error = 0;  ///< of the equation of the coordinates
};

struct DeckResponse {
  std::vector<std::pair<std::string, std::string>> source;
  bool is_over_time = false;
  std::vector<ResponseSubcase> subcases;
  std::vector<RandomResponse> random;
};

}  // namespace bough::records
