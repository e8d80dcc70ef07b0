#pragma once
/// \file The subcases of SOL 101, one after the other.
#include <array>
#include <exception>
#include <optional>

#include "fe/statics/static_case.hpp"

namespace bough::fe {

/// The subcases with a load, temperatures, or with displacements that their SPC set enforces; the one asked for in any
/// case (0: all; none where the deck has not the one asked for). Throws InputError cli.no-static-load.
std::vector<records::Subcase> choose_static_subcases(const records::Deck& deck, int asked);

/// Solves subcases one after the other; model and factor are kept while the constraints stay the same.
class CaseSolver {
 public:
  CaseSolver(const records::Deck& deck, ModelOptions options);
  /// The forces on these grids are listed one by one; empty: on all.
  void ask_grid_forces(std::vector<int> grids) { grids_ = std::move(grids); }

  /// Strains of elements beside their stresses.
  void ask_strains() { has_strains_ = true; }

  /// Throws what is wrong with this subcase alone.
  records::StaticSubcase solve(const records::Subcase& subcase, Diagnostics& diagnostics);
  const Model& model() const { return *model_; }  ///< of the last subcase that had one

 private:
  void prepare(const records::Subcase& subcase, Diagnostics& diagnostics);

  const records::Deck& deck_;
  ModelOptions options_;
  std::optional<std::vector<int>> grids_;
  bool has_strains_ = false;
  std::optional<std::array<int, 5>> held_;  ///< SPC, MPC, SUPORT1, preload, TEMPERATURE(INITIAL) of what is kept
  std::exception_ptr failure_;              ///< what came of them
  std::optional<Model> model_;
  std::unique_ptr<StaticSolver> solver_;
  Suport suport_;
};

}  // namespace bough::fe
