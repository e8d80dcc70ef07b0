#pragma once
/// \file Complex modes of a deck: SOL 107 on the full matrices, SOL 110 on real modes (docs/theory/complex-modes.md).
#include <complex>
#include <functional>
#include <memory>
#include <optional>

#include "formats/records/complex_modes.hpp"
#include "formats/records/deck_dynamics.hpp"
#include "modal/complex/rotor_case.hpp"
#include "modal/eigen.hpp"

namespace bough::modal::complex_modes {

struct ComplexModesOptions {
  bool is_by_modes = false;  ///< SOL 110
  int num_modes = 0;         ///< overrules ND of EIGC; 0: the deck's
  bool has_shapes = true;    ///< the mesh and the shapes are filled in
  std::function<EigenOptions(const records::DynamicSubcase&, Diagnostics&)> choose_eigen;  ///< of SOL 110
};

/// Oscillating modes of a subcase at one speed of its rotors, for the comparison with those at other speeds.
struct SpeedModes {
  Eigen::VectorXcd lambda;       ///< m, Im > 0
  Eigen::MatrixXcd right, left;  ///< 2n x m, m x 2n of the linearization; left · right = 1
  Eigen::VectorXd whirl;         ///< as ComplexModesResult::whirl
};

/// Lists the subcases with CMETHOD, without those whose load is the preload of another (STATSUB); the first subcase if
/// there are none.
std::vector<int> list_subcases(const records::DynamicDeck& deck);

/// EIGC of CMETHOD of the subcase; without CMETHOD the Lanczos method where `num_modes` is given. Throws InputError
/// modal.missing-complex-method, modal.no-complex-method.
const records::ComplexMethod& choose_method(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                                            int num_modes);

/// Reads what ComplexModesSolver reads of a subcase before it solves: damping, direct input, rotors. Reports the errors
/// and warnings of its constructor; throws the errors that hide others. \param model  of the subcase.
void check_selections(const fe::Model& model, const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                      bool is_by_modes, Diagnostics& diagnostics);

/// Complex modes of a subcase with its SPC, MPC, damping, K2PP, B2PP, M2PP, TFL and rotors.
class ComplexModesSolver {
 public:
  /// Errors: modal.no-complex-method (neither CMETHOD nor a number of modes), modal.missing-complex-method (CMETHOD
  /// without EIGC), those of collect_physical_input, response::choose_damping and rotors::choose_rotors. The arguments
  /// must outlive this.
  ComplexModesSolver(const records::DynamicDeck& deck, const fe::ModelOptions& model_options,
                     const records::DynamicSubcase& subcase, const ComplexModesOptions& options,
                     Diagnostics& diagnostics);
  ~ComplexModesSolver();

  /// Rotors of the subcase; nullptr without.
  const rotors::RotorCase* rotor_case() const;
  /// Grids, elements, mass and polar inertia of the rotors; empty without.
  const std::vector<fe::Rotor>& rotors() const;
  /// Modes and shapes at a speed of the reference rotor [1/T]; none: at the speed of the motion (synchronous), or
  /// without rotors. Warning: modal.fewer-complex-modes.
  records::ComplexModesResult solve(std::optional<double> speed, Diagnostics& diagnostics) const;
  /// The modes nearest to the shift of EIGC, or to `shift`. \param num_modes  0: ND of EIGC.
  SpeedModes solve_at(double speed, int num_modes, std::optional<std::complex<double>> shift = {}) const;

 private:
  struct Prepared;
  std::unique_ptr<Prepared> prepared_;
};

}  // namespace bough::modal::complex_modes
