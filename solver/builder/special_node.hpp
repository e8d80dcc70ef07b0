#pragma once
/// \file Special nodes of a .FLX, to which no body attaches.
#include <string>

#include "base/diagnostic.hpp"
#include "solver/bodies/body.hpp"

namespace bough::solver {

/// Returns true if node `index` (-1: none) of a body is a special node.
inline bool is_special_node(const Body& body, int index) {
  if (index < 0) return false;
  const Node& node = body.nodes()[static_cast<size_t>(index)];
  return !node.is_material && node.id != 0;
}

/// Returns `index`, or -1 with "system.special-node" reported where a hinge or constraint attaches to a special node.
int reject_special_node(const std::string& body_name, const Body& body, int index, const SourceLocation& where,
                        const std::string& user, Diagnostics& diagnostics);

}  // namespace bough::solver
