#pragma once
/// \file Two decks of one structure, written in two ways: the second is the oracle of the first.
#include <string>
#include <vector>

namespace bough::fe::test {

/// Static displacements of the grids and scalar points that both decks have, for every subcase (LOAD) of the first; the
/// largest six eigenvalues of K⁻¹M on the free dofs; the rigid mass matrix. Fails where they differ by more than
/// `tolerance` of the largest.
void expect_same(const std::string& a, const std::string& b, double tolerance = 1e-9);

/// Displacement of the grid in basic (6 entries) in subcase `subcase` (0: the only one).
std::vector<double> solve_at(const std::string& text, int grid, int subcase = 0);

}  // namespace bough::fe::test
