#include "analysis/common/output_folder.hpp"

#include <filesystem>
#include <system_error>

#include "base/diagnostic.hpp"
#include "base/part_file.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

namespace {

/// Where this process may write: a property of the process, as its working folder is.
std::string& get_output_folder() {
  static std::string folder;
  return folder;
}

fs::path find_real_path(const std::string& path) {
  std::error_code failed;
  const auto target = find_target(path, failed);
  const auto real = fs::weakly_canonical(fs::absolute(target, failed), failed);
  return real.empty() ? fs::path(target) : real;
}

}  // namespace

bool is_inside(const std::string& path, const std::string& folder) {
  const auto real = find_real_path(path).lexically_relative(find_real_path(folder.empty() ? "." : folder));
  return !real.empty() && *real.begin() != "..";
}

void confine_outputs(const std::string& folder) { get_output_folder() = folder; }

bool is_same_output(const std::string& a, const std::string& b) { return find_real_path(a) == find_real_path(b); }

void check_place(const std::string& path) {
  if (get_output_folder().empty() || is_inside(path, get_output_folder())) return;
  throw InputError("cli.output-outside", {path}, "the file does not lie in " + get_output_folder(),
                   "let the steps of a campaign write into the case's own folder, or give --force-outside");
}

}  // namespace bough::analysis
