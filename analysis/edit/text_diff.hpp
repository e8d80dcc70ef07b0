#pragma once
#include <string>

namespace bough::analysis {

/// The lines that differ, as `diff -u` prints them; empty when none does.
std::string make_diff(const std::string& before, const std::string& after, const std::string& name);

}  // namespace bough::analysis
