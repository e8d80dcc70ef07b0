#pragma once
/// \file Advice about names that do not exist.
#include <string>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::solver {

/// "did you mean 'root'?" where a known name is near the one that was wanted, else `otherwise`.
inline std::string suggest_name(const std::string& requested, const std::vector<std::string>& known,
                                const std::string& otherwise) {
  const std::string near = find_nearest(requested, known);
  return near.empty() ? otherwise : "did you mean '" + near + "'?";
}

/// Suggests a similar name; without one, lists all: "the hinges are: root, elbow" for plural = "hinges".
inline std::string suggest_among(const std::string& requested, const std::vector<std::string>& known,
                                 const std::string& plural) {
  std::string list;
  for (const auto& name : known) list += (list.empty() ? "" : ", ") + name;
  return suggest_name(requested, known, "the " + plural + " are: " + list);
}

}  // namespace bough::solver
