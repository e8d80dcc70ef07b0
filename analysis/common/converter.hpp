#pragma once
/// \file Pictures by another program: rsvg-convert, dot.
#include <functional>
#include <string>
#include <vector>

namespace bough::analysis {

struct Converter {
  std::string program, package;
  std::string otherwise;  ///< what to do without it: "write .svg"
  /// Arguments for a source file and the file to write.
  std::function<std::vector<std::string>(const std::string& source, const std::string& output)> make_arguments;
};

/// Writes `source` to a temporary file, runs the converter, and renames: `path` appears whole or not at all.
/// Throws ComputationError "cli.write" or "cli.no-converter".
void write_converted(const std::string& path, const std::string& source, const Converter& converter);

}  // namespace bough::analysis
