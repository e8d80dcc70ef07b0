#pragma once
/// \file The block diagram of a system file (docs/theory/control.md, "The block diagram").
#include <string>

#include "formats/records/system_spec.hpp"

namespace bough::analysis {

/// Graph of functions, sensors, controllers, actuators, forces and bodies in the language of graphviz.
std::string make_diagram(const records::SystemSpec& spec);
/// The text itself where `path` ends in .dot, else SVG, PNG or PDF by graphviz. Throws ComputationError "cli.write",
/// "cli.no-converter", InputError "cli.bad-diagram" for another ending.
void write_diagram(const records::SystemSpec& spec, const std::string& path);

}  // namespace bough::analysis
