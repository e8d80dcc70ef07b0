#pragma once
/// \file Where loads over time change between the steps, and what the steps do not show of them.
#include "modal/response/excitation.hpp"
#include "modal/response/frequency_list.hpp"

namespace bough::modal::response {

/// The grid with steps at the corners and jumps of the forces besides (none of them shown), and within pulses of TLOAD2
/// that are shorter than some steps; at most `max_corners` of them, those first that a line between the steps misses by
/// most. Warnings: modal.load-between-steps where there are more, modal.coarse-steps (TLOAD2 of few steps in a period),
/// modal.motion-corners (displacements of supports with many corners), modal.before-table (a table followed before its
/// first point).
TimeGrid refine_times(const records::DynamicDeck& deck, const Excitation& excitation, TimeGrid grid, int max_corners,
                      Diagnostics& diagnostics);

}  // namespace bough::modal::response
