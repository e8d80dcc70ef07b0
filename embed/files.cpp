#include "embed/files.hpp"

#include <array>
#include <filesystem>
#include <fstream>

#include "base/diagnostic.hpp"
#include "formats/flat/flex_body.hpp"
#include "formats/flx/flx_file.hpp"
#include "formats/flx/special_nodes.hpp"

namespace bough::embed {
namespace {

bool is_hdf5(const std::string& path) {
  std::array<char, 8> begin{};
  std::ifstream(path, std::ios::binary).read(begin.data(), begin.size());
  return std::string_view(begin.data(), 4) == "\x89HDF";
}

std::string name_flat_file(const std::string& path) {
  return std::filesystem::path(path).replace_extension(".flat").string();
}

records::FlexBody read_body(const std::string& name, Diagnostics&, const std::optional<RigidPart>& given) {
  const auto parsed = flx::parse_flx_name(name);
  const std::string path = parsed ? parsed->path : name;
  if (is_hdf5(path))
    throw InputError("embed.hdf5", {path}, "the body is an HDF5 file, which this library does not read",
                     "write it as a flat file, bough export " + path + " --to flat -o " + name_flat_file(path) +
                         ", and name that in the [[body]]");
  if (flat::is_flex_body(path)) {
    auto body = flat::read_flex_body(path);
    give_rigid_part(body, true, given, path);
    return body;
  }
  if (!parsed)
    throw InputError(
        "embed.body-format", {path}, "the body is neither a flat file nor a .FLX",
        "write it as a flat file, bough export BODY.h5 --to flat -o BODY.flat, and name that in the [[body]]");
  const auto file = flx::read_flx(path, parsed->body_id);
  std::vector<std::string> lacking;
  auto body = flx::make_flex_body(file, lacking);
  flx::add_special_nodes(file, body);
  give_rigid_part(body, file.has_rigid, given, path);
  return body;
}

/// Matrices and tables in separate files have readers of other libraries.
void refuse_matrix_files(records::SystemSpec& spec, Diagnostics& diagnostics) {
  const std::string advice = "write the numbers into the system file";
  for (const auto& r : spec.controllers)
    if ((r.type == "state_space" || r.type == "gain") && r.settings.words.count("file") > 0)
      diagnostics.error("embed.matrix-file", r.at,
                        "controller '" + r.name + "' takes matrices from a file, which this library does not read",
                        advice);
  for (const auto& r : spec.functions)
    if (r.type == "table" && !r.file.empty() && r.x.empty())
      diagnostics.error("embed.matrix-file", r.at,
                        "function '" + r.name + "' takes its points from a file that this library does not read",
                        advice);
}

}  // namespace

FileReaders get_file_readers() {
  return {read_body, refuse_matrix_files, [](const std::string&) {
            return std::string("make it with bough reduce and bough export --to flat, or correct the name");
          }};
}

}  // namespace bough::embed
