#pragma once
/// \file The block diagram of a system file (docs/theory/control.md, "The block diagram").
#include <string>
#include <vector>

#include "formats/records/system_spec.hpp"

namespace bough::analysis {

/// Functions, sensors, controllers, actuators, forces, events and bodies, and their connections.
struct Diagram {
  struct Node {
    std::string kind;   ///< function, sensor, input, controller, actuator, force, body, event or ground
    std::string name;   ///< as in the system file
    std::string label;  ///< lines: name, type, sample time

    /// Name in edges: the ground is a body of that name.
    std::string id() const { return (kind == "ground" ? "body" : kind) + " " + name; }
  };
  enum class Link { Signal, Push, Measurement, Hinge, Constraint, Element, Event };
  struct Edge {
    std::string from, to;  ///< ids of nodes
    std::string label;
    Link link = Link::Signal;
    /// Signals alone: the name in the file, the key that does, `from` in a [[connect]], and the line of
    /// its table.
    std::string signal, key;
    int line = 0;
  };
  std::string name;  ///< of the system
  std::vector<Node> nodes;
  std::vector<Edge> edges;
};

/// Makes the diagram of a system file that has no errors; what is wrong is reported where the system is built.
Diagram make_diagram(const records::SystemSpec& spec);
/// The text of a diagram in the language of graphviz.
std::string write_dot(const Diagram& diagram);
/// Writes that text where `path` ends in .dot, else SVG, PNG or PDF by graphviz. Throws ComputationError "cli.write",
/// "cli.no-converter", InputError "cli.bad-diagram" for another ending.
void write_diagram(const records::SystemSpec& spec, const std::string& path);

}  // namespace bough::analysis
