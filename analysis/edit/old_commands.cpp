#include "analysis/edit/old_commands.hpp"

#include <algorithm>
#include <cctype>
#include <map>

namespace bough::analysis {

std::string find_successor(std::string_view word) {
  static const std::map<std::string, std::string, std::less<>> successors{
      {"treeset", "bough edit SYSTEM.toml edits a system file; bough init starts one"},
      {"treetops", "bough run SYSTEM.toml simulates"},
      {"treeflx", "bough reduce DECK makes a flexible body, bough flx BODY.h5 writes its .FLX"},
      {"treesel", "bough select BODY.h5 SYSTEM.toml ranks modes"},
      {"treeplot", "bough plot RESULTS.h5 draws, bough report RESULTS.h5 makes a page"},
      {"massint", "bough integrals MODEL.inp MATRICES.mat does that"},
      {"modify", "in bough edit SYSTEM.toml: set NAME.key=value"},
      {"print", "in bough edit SYSTEM.toml: show NAME, or list; of results: bough export RESULTS.h5 --to csv"},
      {"helps", "bough help; in bough edit: help"},
      {"stop", "in bough edit SYSTEM.toml: quit, after save"},
      {"convrt", "bough convert FILE --units FROM:TO changes units"}};
  std::string lower(word);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto found = successors.find(lower);
  return found == successors.end() ? "" : found->second;
}

}  // namespace bough::analysis
