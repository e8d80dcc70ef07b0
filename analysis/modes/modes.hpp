#pragma once
/// \file Normal modes (SOL 103), complex modes (SOL 107, 110) and buckling load factors (SOL 105) of a deck.
#include <optional>
#include <string>
#include <vector>

#include "analysis/common/events.hpp"
#include "analysis/common/model_choice.hpp"
#include "analysis/common/subcase_failures.hpp"
#include "analysis/modes/eigen_choices.hpp"
#include "analysis/modes/sensitivities.hpp"
#include "formats/listing/complex_f06.hpp"
#include "formats/records/complex_modes.hpp"
#include "formats/records/listing.hpp"
#include "formats/records/modes.hpp"
#include "modal/solver_use.hpp"

namespace bough::analysis {

struct ModesRequest {
  std::string deck;  ///< file
  ModelChoice model;
  EigenChoice eigen;
  bool energies = false;       ///< strain and kinetic energies of elements and properties
  bool sensitivities = false;  ///< derivatives of the eigenvalues with respect to DESVAR of SOL 200
  int about_grid = 0;          ///< effective masses about this grid too; 0: as the case control
  bool has_shapes = true;      ///< else the records have no shapes and no mesh
  bool has_listing = false;    ///< print file of the output requests
};

/// Modes of one subcase.
struct SubcaseModes {
  records::ModesResult result;
  std::string norm;  ///< of the shapes: MASS, MAX or POINT
  std::string load;  ///< description of the static load of load factors
  std::vector<modal::SolverUse> solvers;
  std::vector<std::string> residual_loads, unused_loads;  ///< of the residual vectors; loads without one
  std::optional<ModeSensitivities> sensitivities;
};

/// Takes the modes of one subcase after the other. Messages about them go to `diagnostics`.
class ModesReceiver {
 public:
  virtual ~ModesReceiver() = default;
  /// Before the work on `num_subcases`.
  virtual void begin(std::size_t /*num_subcases*/, bool /*is_complex*/) {}
  /// Receives the normal or buckling modes of a subcase, which it may move from.
  virtual void take(SubcaseModes& modes, Diagnostics& diagnostics) = 0;
  /// Receives the complex modes of a subcase, which it may move from.
  virtual void take(records::ComplexModesResult& modes, Diagnostics& diagnostics) = 0;
};

struct ModesAnswer {
  SubcaseFailures failures;  ///< of the subcases without modes
  std::optional<records::Listing> listing;
  std::vector<listing::ListedComplexModes> complex_listing;
};

/// Solves every subcase whose modes differ, or the requested one; complex modes if SOL asks for them. Collective.
/// \throws InputError "cli.complex-option" for choices that complex modes do not have; the failures of all subcases if
/// none has modes; what reading and modal throw.
ModesAnswer solve_modes(const ModesRequest& request, ModesReceiver& receiver, Events& events);

}  // namespace bough::analysis
