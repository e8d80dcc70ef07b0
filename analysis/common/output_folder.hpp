#pragma once
/// \file The folder that a command may write to.
#include <string>

namespace bough::analysis {

/// Returns true if writing to `path` reaches a file in `folder` or below, symbolic links followed.
bool is_inside(const std::string& path, const std::string& folder);

/// Returns true if both paths lead to one file, which need not exist.
bool is_same_output(const std::string& a, const std::string& b);

/// From now on check_place refuses files that are not in this folder or below, with InputError "cli.output-outside":
/// the steps of a campaign write in the folder of their case. Empty: anywhere.
void confine_outputs(const std::string& folder);
/// Throws InputError "cli.output-outside" for a path outside the folder of confine_outputs().
void check_place(const std::string& path);

}  // namespace bough::analysis
