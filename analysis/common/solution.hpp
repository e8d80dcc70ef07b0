#pragma once
/// \file Requests of the deck's SOL other than linear statics, modes and buckling.
#include <cstddef>
#include <string>
#include <vector>

#include "formats/records/deck.hpp"

namespace bough::analysis {

/// One note where SOL is not linear: cli.other-solution.
void note_solution(const records::Deck& deck, Diagnostics& diagnostics);

/// Static solutions of a SOL that is nonlinear in its statics only when asked for: throws
/// InputError("cli.nonlinear-static") unless `is_linear`, else notes as note_solution.
/// Returns true if the statics of a deck are to be solved with large displacements: on request, or where a nonlinear
/// SOL has PARAM,LGDISP,1 or 2. Throws cli.nonlinear-static for a nonlinear SOL without any of these, and for cards of
/// nonlinear material and contact; notes what a linear solution leaves out.
bool choose_static_solution(const records::Deck& deck, bool is_linear, bool is_nonlinear, Diagnostics& diagnostics);
/// SOL 106 and its like: a subcase starts where the one before it ended.
bool is_nonlinear_sequence(const records::Deck& deck);

/// Domain and method of a SOL of frequency or transient response.
struct ResponseSolution {
  bool is_over_time;
  bool is_direct;  ///< without modes
};
/// Adds cli.nonlinear-transient if a SOL of nonlinear transient response (129 and its kin) has cards of nonlinear
/// materials, contact or large displacements, or several subcases, which continue one another.
/// \param num_subcases  those to be solved.
void check_nonlinear_transient(const records::Deck& deck, std::size_t num_subcases, Diagnostics& diagnostics);

/// nullptr for another SOL; by number and by name of the MSC, NX and COSMIC sequences. Nonlinear transient response
/// is direct transient response.
const ResponseSolution* find_response_solution(const std::string& sol);

/// Returns true for SOL 107, 110 and their kin unless CMETHOD (or EIGC) is among the names of --ignore.
bool asks_complex_modes(const records::Deck& deck, const std::vector<std::string>& ignored);
/// Returns true for SOL 110 and its kin, whose complex modes are those of real modes.
bool has_modal_complex_modes(const std::string& sol);

}  // namespace bough::analysis
