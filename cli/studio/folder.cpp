#include "cli/studio/folder.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "analysis/common/body_files.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/output_folder.hpp"
#include "analysis/common/text_file.hpp"
#include "base/diagnostic.hpp"
#include "base/file_roles.hpp"
#include "cli/common/options.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/toml/specs.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kMaxText = std::uintmax_t{4} << 20;

std::string find_kind(const std::string& name) {
  for (const char* ending : {".bdf", ".dat", ".nas", ".fem", ".blk", ".pch"})
    if (analysis::has_suffix(name, ending)) return "deck";
  if (analysis::has_suffix(name, ".html")) return "report";
  try {
    if (analysis::has_suffix(name, ".toml")) {
      const auto kind = toml_files::detect_kind(name);
      return kind.empty() ? "toml" : kind;
    }
    if (analysis::has_suffix(name, ".h5") || analysis::has_suffix(name, ".hdf5"))
      return analysis::read_file_format(name);
  } catch (const Failure&) {  // opened, it reports why
    return "unreadable";
  }
  return {};
}

bool is_there(const std::string& name) {
  std::error_code failed;
  return fs::exists(name, failed);
}

}  // namespace

std::vector<FolderEntry> list_folder() {
  std::vector<FolderEntry> entries;
  std::error_code failed;
  fs::recursive_directory_iterator at(".", fs::directory_options::skip_permission_denied, failed), end;
  for (; !failed && at != end && entries.size() < kMaxEntries; at.increment(failed)) {
    const auto name = at->path().lexically_normal().generic_string();
    std::error_code ignored;
    if (at->is_directory(ignored)) {
      if (at->path().filename().string().starts_with('.') || at.depth() + 1 >= kMaxDepth)
        at.disable_recursion_pending();
      continue;
    }
    if (at->path().filename().string().starts_with('.') || !at->is_regular_file(ignored) ||
        !analysis::is_inside(name, "."))
      continue;
    FolderEntry entry{name, find_kind(name), static_cast<double>(at->file_size(ignored)), 0};
    entry.time = std::chrono::duration<double>(at->last_write_time(ignored).time_since_epoch()).count();
    if (!entry.kind.empty()) entries.push_back(std::move(entry));
  }
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return entries;
}

FileText read_file_text(const std::string& name) {
  note_input(name);
  analysis::demand_file(name);
  std::error_code failed;
  if (fs::file_size(name, failed) > kMaxText)
    throw InputError("studio.too-large", {name}, "the file has more than 4 MB of text", "open it in an editor");
  FileText file;
  std::ifstream in(name, std::ios::binary);
  file.text.assign(std::istreambuf_iterator<char>(in), {});
  file.hash = hdf5::calc_sha256(name);
  return file;
}

std::string save_file_text(const std::string& name, const std::string& text, const std::string& hash) {
  if (!analysis::has_suffix(name, ".toml"))
    throw InputError("cli.wrong-file", {name}, "the studio writes body and system files in TOML", "name a .toml file");
  check_output({}, name);
  if (is_there(name)) {
    if (hash.empty())
      throw InputError("cli.output-exists", {name}, "the file exists", "choose another name, or open the file");
    if (hdf5::calc_sha256(name) != hash)
      throw InputError("studio.changed-file", {name}, "the file has changed since it was read; nothing was written",
                       "compare both texts, then take the file as it is now or overwrite it");
  } else if (!hash.empty()) {
    throw InputError("studio.changed-file", {name}, "the file was removed since it was read; nothing was written",
                     "save the text as a new file");
  }
  analysis::write_text_file(name, text);
  return hdf5::calc_sha256(name);
}

}  // namespace bough::cli
