#pragma once
/// \file Commands after OUTPUT(POST): surfaces and volumes of grid point stresses.
#include "formats/nastran/detail/control_lines.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::nastran::detail {

/// Reads SET, SURFACE and VOLUME into `requests`; other commands are left out. Reports deck.case-control-value.
/// \param at  location of the command. \param place  its file and line, for messages.
void read_post_command(const Command& command, records::CardLocation at, const SourceLocation& place,
                       records::CaseRequests& requests, Diagnostics& diagnostics);

}  // namespace bough::nastran::detail
