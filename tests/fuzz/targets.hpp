#pragma once
/// \file The readers that are fuzzed, each as a function of a file: what it throws for bad input is caught, anything
/// else (another exception, a breach of a contract, a finding of a sanitizer) ends the process.
#include <string>
#include <vector>

namespace bough::fuzz {

struct Target {
  const char* name;
  void (*read)(const std::string& path);
};

const std::vector<Target>& get_targets();
/// Null where there is none of that name.
const Target* find_target(const std::string& name);

}  // namespace bough::fuzz
