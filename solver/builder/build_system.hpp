#pragma once
/// \file Records of a system file to a System.
#include <map>
#include <string>

#include "formats/records/flex_body.hpp"
#include "formats/records/system_spec.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

/// Records of flexible bodies by their file, as the spec writes it.
using FlexMap = std::map<std::string, records::FlexBody>;

/// Checks everything that concerns the solver (names, nodes, tree without loops, locators of stiffened attachments) and
/// reports all errors with their place in the TOML file; throws InputError when there are any. A body without an
/// inboard hinge gets a free one (a note says so).
System build_system(const records::SystemSpec& spec, const FlexMap& flex, Diagnostics& diagnostics);
/// Builds the system as build_system does but throws nothing, so that the next checks can report their errors too; with
/// errors the system must not be moved. A body that cannot be built is a rigid one here, with is_valid false.
System draft_system(const records::SystemSpec& spec, const FlexMap& flex, Diagnostics& diagnostics);

}  // namespace bough::solver
