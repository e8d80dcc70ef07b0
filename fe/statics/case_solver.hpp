#pragma once
/// \file The subcases of SOL 101, one after the other.
#include <array>
#include <exception>
#include <optional>
#include <span>

#include "fe/statics/element_recovery.hpp"
#include "fe/statics/nonlinear.hpp"
#include "fe/statics/static_case.hpp"

namespace bough::fe {

/// The subcases with a load, temperatures, or displacements enforced by their SPC set; the requested one in any case
/// (0: all; empty if the deck does not contain it). Throws InputError cli.no-static-load.
std::vector<records::Subcase> choose_static_subcases(const records::Deck& deck, int requested);

/// Solves subcases one after the other; model and factor are kept while the constraints stay the same.
class CaseSolver {
 public:
  CaseSolver(const records::Deck& deck, ModelOptions options);
  /// The forces on these grids are listed one by one; empty: on all.
  void ask_grid_forces(std::vector<int> grids) { grids_ = std::move(grids); }

  /// Strains of elements next to their stresses.
  void ask_strains() { has_strains_ = true; }

  /// Large displacements and rotations (nonlinear.hpp). `continues`: a subcase starts from the end of the previous one,
  /// as in SOL 106, if both have the same constraints; otherwise undeformed.
  void ask_nonlinear(const NonlinearOptions& options, bool continues) {
    nonlinear_ = options;
    continues_ = continues;
  }

  /// The result of a subcase, or the error of this subcase.
  struct Solved {
    std::optional<records::StaticSubcase> result;
    std::exception_ptr failure;
    Diagnostics diagnostics;
  };
  /// Solves the first of `left` (not empty) and those after it that are constrained alike, at most kMaxTogether, with
  /// one model whose elements are formed once. A subcase's result does not depend on the others.
  std::vector<Solved> solve_next(std::span<const records::Subcase> left);
  static constexpr std::size_t kMaxTogether = 40;  ///< eights for the factor; a dozen copies on the g-set

  const Model& model() const { return *model_; }  ///< of the last subcase that had one

 private:
  void prepare(const records::Subcase& subcase, Diagnostics& diagnostics);
  bool is_prepared_for(const records::Subcase& subcase) const;
  /// Solves without the fields of elements. Subcases are solved together if none has an error.
  /// \return strain energies of this rank's elements, elements x solved subcases; empty if each was solved separately.
  MatrixXd solve_displacements(std::span<const StaticLoad> loads, std::span<Solved> solved) const;
  void solve_nonlinear(const StaticLoad& load, Solved& solved);
  void add_element_results(std::span<const StaticLoad> loads, const MatrixXd& energy, std::span<Solved> solved);

  const records::Deck& deck_;
  ModelOptions options_;
  std::optional<std::vector<int>> grids_;
  bool has_strains_ = false;
  /// SPC, MPC, SUPORT1, preload, TEMPERATURE(INITIAL), TEMPERATURE(MATERIAL) of what is kept
  std::optional<std::array<int, 6>> held_;
  std::exception_ptr failure_;  ///< what came of them
  std::optional<Model> model_;
  std::unique_ptr<StaticSolver> solver_;
  std::optional<RecoveryLayout> layout_;
  Suport suport_;
  std::optional<NonlinearOptions> nonlinear_;
  bool continues_ = false;
  std::unique_ptr<NonlinearStatics> path_;  ///< of the last subcase
};

}  // namespace bough::fe
