#pragma once
/// \file Frequency and transient response of a deck, by subcases: by modes (SOL 111, 112) or directly (108, 109).
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "fe/statics/statics.hpp"
#include "modal/response/random/modal_source.hpp"
#include "modal/response/recovery.hpp"

namespace bough::modal::response {

struct ResponseOptions {
  bool is_over_time = false;
  bool is_direct = false;                ///< without modes
  std::optional<bool> residual_vectors;  ///< overrules RESVEC of the deck (default: yes)
  std::vector<int> grids;                ///< displacement, velocity, acceleration of these besides
  bool with_listing = false;             ///< recovers the data of a listing too
  bool with_random = false;              ///< keeps what modal integrals of a random response need
  /// EIGRL or EIGR of the subcase, with the command line.
  std::function<EigenOptions(const records::DynamicSubcase&, Diagnostics&)> choose_eigen;
  /// Prestress of the subcase's STATSUB; may be empty.
  std::function<std::shared_ptr<const fe::Prestress>(const fe::ModelOptions&, const records::DynamicSubcase&,
                                                     Diagnostics&)>
      choose_prestress;
};

/// The subcases with DLOAD, over time also those with IC; the one asked for in any case. Throws InputError
/// modal.no-dynamic-load.
std::vector<records::DynamicSubcase> choose_response_subcases(const records::DynamicDeck& deck, int requested,
                                                              bool is_over_time = false);

/// Modes of EIGRL in unit generalized mass, and the modes below its V1, whose static part residual vectors do not
/// restore.
ModeBasis calc_mode_basis(const fe::System& system, const EigenOptions& options, const records::DynamicDeck& deck,
                          int& num_massless, Diagnostics& diagnostics);
/// Static solver for residual vectors: with rigid-body or massless modes on a determinate support.
std::unique_ptr<fe::StaticSolver> make_residual_solver(const fe::System& system, const ModeBasis& modes,
                                                       int num_massless);
/// PARAM G, W3, W4, ALPHA1, ALPHA2, KDAMP and SDAMPING of the subcase. Reports modal.direct-input,
/// modal.missing-table, modal.no-w3. The result refers to `model`, `deck`.
DampingChoice choose_damping(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                             const ResponseOptions& options, const fe::Model& model, Diagnostics& diagnostics);

/// Reports what is wrong with the rotors of RGYRO of the subcase, as the solver does before it solves. Throws the
/// errors that hide others.
void check_rotors(const fe::Model& model, const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                  const ResponseOptions& options, Diagnostics& diagnostics);

/// Model and modes are kept while constraints and METHOD stay the same.
class DeckResponseSolver {
 public:
  DeckResponseSolver(const records::DynamicDeck& deck, fe::ModelOptions model_options, ResponseOptions options);
  ~DeckResponseSolver();

  /// Throws what is wrong with this subcase. Notes modal.no-w3 (PARAM,G or GE over time without W3 or W4), warnings
  /// modal.response-range (driven above the highest mode), modal.no-modes (SDAMPING without modes).
  records::ResponseSubcase solve(const records::DynamicSubcase& subcase, Diagnostics& diagnostics);

  /// Sources of modal integrals, by the id of each subcase that is solved by modes.
  const std::map<int, ModalSource>& sources() const { return sources_; }

 private:
  struct Prepared;
  void prepare(const records::DynamicSubcase& subcase, Diagnostics& diagnostics);
  struct Task;
  void solve_by_modes(const Task& task, const records::DynamicSubcase& subcase, records::ResponseSubcase& result,
                      Diagnostics& diagnostics);
  void solve_directly(const Task& task, const records::DynamicSubcase& subcase, records::ResponseSubcase& result,
                      Diagnostics& diagnostics) const;

  const records::DynamicDeck& deck_;
  fe::ModelOptions model_options_;
  ResponseOptions options_;
  std::optional<std::array<int, 7>> held_;
  std::unique_ptr<Prepared> prepared_;
  std::map<int, ModalSource> sources_;
};

}  // namespace bough::modal::response
