#include "analysis/common/body_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "analysis/common/inputs.hpp"
#include "base/diagnostic.hpp"
#include "formats/flat/flex_body.hpp"
#include "formats/flx/flx_file.hpp"
#include "formats/flx/special_nodes.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

bool is_flat(const std::string& name) { return flat::is_flex_body(name); }

bool is_flx(const std::string& name) { return !is_flat(name) && flx::parse_flx_name(name).has_value(); }

std::string get_body_path(const std::string& name) { return embed::get_body_path(name); }

std::string read_file_format(const std::string& file) {
  if (is_flat(file) || is_flx(file)) return "bough-flexbody";
  const auto attributes = hdf5::read_info(file).attributes;
  const auto found = attributes.find("format");
  return found == attributes.end() ? std::string{} : found->second;
}

bool is_same_body(const std::string& a, const std::string& b) {
  std::error_code ignored;
  if (!fs::equivalent(get_body_path(a), get_body_path(b), ignored)) return false;
  const auto first = flx::parse_flx_name(a), second = flx::parse_flx_name(b);
  if (!first || !second || first->body_id == second->body_id) return true;
  // A file with one body needs no id.
  return (first->body_id == 0 || second->body_id == 0) && flx::read_flx_bodies(first->path).size() == 1;
}

void demand_body_file(const std::string& name) { demand_file(get_body_path(name)); }

namespace {

void add_note(const flx::FlxFile& file, const std::string& path, std::vector<std::string> lacking,
              Diagnostics& diagnostics) {
  if (!file.has_rigid) lacking.insert(lacking.begin(), "centre of mass and inertia");
  std::string what =
      fmt::format("the file does not hold {}; its values have {} digits", fmt::join(lacking, ", "), file.digits);
  if (!file.special_id.empty()) what += "; its special nodes take forces, actuators and sensors";
  for (const auto& item : diagnostics.items())
    if (item.id == "flx.not-carried" && item.what == what) return;
  diagnostics.note("flx.not-carried", {path}, what,
                   "the HDF5 file of bough reduce holds all of it; flx --digits 17 keeps every bit");
}

struct Read {
  records::FlexBody body;
  bool has_rigid = true;
};

Read read_any(const std::string& name, bool is_moving, Diagnostics& diagnostics) {
  if (is_flat(name)) return {flat::read_flex_body(name), true};
  const auto parsed = flx::parse_flx_name(name);
  if (!parsed) return {hdf5::read_flex_body(name), true};
  const auto file = flx::read_flx(parsed->path, parsed->body_id);
  std::vector<std::string> lacking;
  Read read{flx::make_flex_body(file, lacking), file.has_rigid};
  if (is_moving) flx::add_special_nodes(file, read.body);
  read.body.source = calc_sources({parsed->path});
  add_note(file, parsed->path, std::move(lacking), diagnostics);
  return read;
}

}  // namespace

records::FlexBody read_body(const std::string& name, Diagnostics& diagnostics) {
  return read_any(name, false, diagnostics).body;
}

records::FlexBody read_moving_body(const std::string& name, Diagnostics& diagnostics,
                                   const std::optional<RigidPart>& given) {
  auto [body, has_rigid] = read_any(name, true, diagnostics);
  const std::string path = get_body_path(name);
  embed::give_rigid_part(body, has_rigid, given, path);
  return std::move(body);
}

void warn_of_third_order(const records::FlexBody& body, const std::string& file, const std::string& format,
                         Diagnostics& diagnostics) {
  if (body.third_order.empty()) return;
  diagnostics.warning("export.third-order", {file},
                      format + " contains no third order: the body written there has second order",
                      "keep the HDF5 or the flat file where deflections are large");
}

}  // namespace bough::analysis
