#pragma once
/// \file Whatever may be named as an input, for the builder of the signal graph.
#include <string>
#include <vector>

#include "solver/builder/connects.hpp"

namespace bough::solver {

struct Source {
  std::string name, path;
  int size = 0;  ///< 0: not known yet
  int place = -1;
  SourceLocation at{};  ///< of its table
};

/// One component of a source, or all of it.
struct Wire {
  size_t source = 0;
  int component = -1;  ///< -1: all
  std::string text;    ///< the component as written
  double gain = 1;
  SourceLocation at;
};

class Sources {
 public:
  std::vector<Source> list;

  /// The wire of a use. Reports "control.unknown-signal" and returns false; user: "controller 'pid'".
  bool find(const SignalUse& use, const std::string& user, Wire& wire, Diagnostics& diagnostics) const;
  /// Number of components that a wire carries.
  int size_of(const Wire& wire) const { return wire.component >= 0 ? 1 : list[wire.source].size; }
  /// Source by its path. \pre The path is in the list.
  Source& at_path(const std::string& path);
};

}  // namespace bough::solver
