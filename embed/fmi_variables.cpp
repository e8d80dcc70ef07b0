#include "embed/fmi_variables.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/diagnostic.hpp"
#include "base/version.hpp"
#include "embed/state_bytes.hpp"

namespace bough::fmi {
namespace {

class TokenHash {
 public:
  void add(const std::string& bytes) {
    const auto view = std::as_bytes(std::span(bytes));
    const std::uint64_t size = bytes.size();
    for (auto* hash : {&first_, &second_}) *hash = embed::calc_hash(std::as_bytes(std::span(&size, 1)), *hash);
    first_ = embed::calc_hash(view, first_);
    second_ = embed::calc_hash(view, second_);
  }
  std::string get() const {
    char text[48];
    const auto u = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
    std::snprintf(text, sizeof text, "{%08llx-%04llx-%04llx-%04llx-%012llx}", u(first_ >> 32), u(first_ >> 16 & 0xffff),
                  u(first_ & 0xffff), u(second_ >> 48), u(second_ & 0xffffffffffffull));
    return text;
  }

 private:
  std::uint64_t first_ = 14695981039346656037u, second_ = 0x9e3779b97f4a7c15u;
};

std::string read_file(const std::filesystem::path& path) {
  std::error_code failed;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!std::filesystem::is_regular_file(path, failed) || !file || !(text << file.rdbuf()))
    throw InputError("fmu.resources", {path.string()}, "the file of the FMU cannot be read",
                     "unpack the whole FMU, and give the folder resources in it");
  return std::move(text).str();
}

}  // namespace

std::string make_manifest(const std::vector<Resource>& resources, const std::string& version) {
  std::string text = std::string(kManifestHead) + "\nversion " + version + "\n";
  for (const auto& resource : resources) text += "file " + resource.name + "\n";
  return text;
}

std::string calc_token(const std::string& manifest, const std::vector<Resource>& resources) {
  TokenHash hash;
  hash.add(manifest);
  for (const auto& resource : resources) hash.add(resource.bytes);
  return hash.get();
}

std::string calc_token(const std::string& folder) {
  const std::filesystem::path root(folder);
  const std::string manifest = read_file(root / kManifest);
  std::istringstream lines(manifest);
  std::string line;
  const auto fail = [&](const std::string& what, const std::string& advice) {
    throw InputError("fmu.resources", {(root / kManifest).string()}, what, advice);
  };
  std::getline(lines, line);
  if (line != kManifestHead)
    fail("the first line is not \"" + std::string(kManifestHead) + "\"", "export the FMU again");
  std::getline(lines, line);
  if (line != "version " + std::string(get_version()))
    fail("the resources are of another version than the binary, " + std::string(get_version()), "export the FMU again");
  TokenHash hash;
  hash.add(manifest);
  while (std::getline(lines, line)) {
    const std::string name = line.starts_with("file ") ? line.substr(5) : "";
    if (name.empty() || name.find('/') != std::string::npos || name == "..")
      fail("a line names no file", "export the FMU again");
    hash.add(read_file(root / name));
  }
  return hash.get();
}

}  // namespace bough::fmi
