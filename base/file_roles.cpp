#include "base/file_roles.hpp"

#include <sys/stat.h>

#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "base/diagnostic.hpp"
#include "base/input_bytes.hpp"
#include "base/part_file.hpp"

namespace bough {

namespace {

using FileNumber = std::pair<dev_t, ino_t>;

/// False for what is not there, or is no regular file: a terminal may be read and written.
bool find_number(const std::string& path, FileNumber& number) {
  struct stat state {};
  if (::stat(path.c_str(), &state) != 0 || !S_ISREG(state.st_mode)) return false;
  number = {state.st_dev, state.st_ino};
  return true;
}

[[noreturn]] void refuse(const std::string& output, const std::string& input) {
  throw InputError("cli.output-is-input", {output}, "the output would overwrite the input file " + input,
                   "choose another file with -o");
}

/// Real path of the folder that confines all files; empty: none.
std::string& get_folder() {
  static std::string folder;
  return folder;
}

std::filesystem::path find_real_path(const std::string& path) {
  std::error_code failed;
  const auto target = find_target(path, failed);
  return std::filesystem::weakly_canonical(std::filesystem::absolute(target, failed), failed);
}

void demand_inside(const std::string& path) {
  const auto& folder = get_folder();
  if (folder.empty()) return;
  const auto relative = find_real_path(path).lexically_relative(folder);
  if (relative.empty() || *relative.begin() == "..")
    throw InputError("cli.outside-folder", {path}, "the file does not lie in " + folder + ", the folder of the studio",
                     "start bough studio in a folder that contains all files");
}

std::mutex& get_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

struct FileRoles::Files {
  std::map<FileNumber, std::string> inputs, outputs;  ///< as they were first called
  std::set<FileNumber> both;

  static Files*& get_current() {
    static Files* current = nullptr;
    return current;
  }
};

FileRoles::FileRoles() : files_(new Files) {
  const std::lock_guard lock(get_mutex());
  outer_ = std::exchange(Files::get_current(), files_);
  detail::begin_keeping_inputs();
}

FileRoles::~FileRoles() {
  const std::lock_guard lock(get_mutex());
  Files::get_current() = outer_;
  detail::end_keeping_inputs();
  delete files_;
}

void FileRoles::allow_both(const std::string& path) {
  const std::lock_guard lock(get_mutex());
  FileNumber number;
  if (auto* files = Files::get_current(); files && find_number(path, number)) files->both.insert(number);
}

void FileRoles::note(const std::string& path, bool is_input) {
  const std::lock_guard lock(get_mutex());
  auto* files = Files::get_current();
  FileNumber number;
  if (!files || !find_number(path, number) || files->both.count(number) > 0) return;
  const auto& others = is_input ? files->outputs : files->inputs;
  if (const auto other = others.find(number); other != others.end())
    refuse(is_input ? other->second : path, is_input ? path : other->second);
  (is_input ? files->inputs : files->outputs).emplace(number, path);
}

void confine_files(const std::string& folder) {
  get_folder() = folder.empty() ? std::string() : find_real_path(folder).string();
}

void note_input(const std::string& path) {
  demand_inside(path);
  FileRoles::note(path, true);
}

void note_output(const std::string& path) {
  demand_inside(path);
  FileRoles::note(path, false);
}

}  // namespace bough
