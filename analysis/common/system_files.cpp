#include "analysis/common/system_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "analysis/common/body_files.hpp"
#include "analysis/common/control_files.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/start_state.hpp"
#include "analysis/convert/unit_system.hpp"
#include "cosim/fmu_controller.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

std::string resolve_beside(const std::string& from_file, const std::string& path) {
  return embed::resolve_beside(from_file, path);
}

namespace {

/// File to reduce for a missing body file: the TOML body file of the same name, if there is one.
std::string name_reducible(const std::string& file) {
  const auto spec = fs::path(file).replace_extension(".toml");
  return fs::exists(spec) ? spec.string() : "BODY.toml";
}

std::string advise_body(const std::string& file) {
  const auto path = embed::shorten_path(get_body_path(file));
  return "make it with bough " +
         (is_flx(file)                ? "flx BODY.h5"
          : has_suffix(file, ".flat") ? "export BODY.h5 --to flat"
                                      : "reduce " + name_reducible(embed::shorten_path(file))) +
         " -o " + path + ", or correct the name";
}

}  // namespace

std::vector<std::string> collect_sources(const std::string& path, const LoadedSystem& loaded) {
  std::vector<std::string> files{path};
  for (const auto& [name, file] : loaded.flex_path) files.push_back(file);
  for (const auto& file : list_controller_files(loaded.spec)) files.push_back(file);
  for (const auto& function : loaded.spec.functions) {
    if (!function.file.empty() && std::find(files.begin(), files.end(), function.file) == files.end())
      files.push_back(function.file);
  }
  if (!loaded.start_from.empty()) files.push_back(loaded.start_from);
  return files;
}

namespace {

void warn_of_units(const records::SystemSpec& spec, Diagnostics& diagnostics) {
  const double force = calc_unit_force(spec.units);
  if (std::abs(force - 1) < 1e-6) return;
  const auto& u = spec.units;
  diagnostics.warning("system.inconsistent-units", {spec.file},
                      fmt::format("[units]: a mass in {}, a length in {} and a time in {} make forces of {:g} {}, "
                                  "and the label is {}",
                                  u.mass, u.length, u.time, force, u.force, u.force),
                      "give all numbers in one set, as m, kg, s, N or mm, tonne, s, N; labels convert nothing");
}

}  // namespace

LoadedSystem load_system(const std::string& path, Diagnostics& diagnostics, const std::string& start_from,
                         const std::vector<std::string>& set) {
  LoadOptions options;
  options.start_from = start_from;
  options.set = set;
  return load_system(path, diagnostics, std::move(options));
}

LoadedSystem load_system(const std::string& path, Diagnostics& diagnostics, LoadOptions options) {
  if (!options.text) {
    demand_file(path);
    refuse_treetops_input(path);
    refuse_deck(path);
  }
  const std::string start_from = options.start_from;
  StartPoint start;
  if (!start_from.empty())
    options.set_start = [&](records::SystemSpec& spec, Diagnostics& found) {
      demand_file(start_from);
      start = set_start_state(spec, start_from, found);
    };
  const embed::FileReaders readers{read_moving_body,
                                   [](records::SystemSpec& spec, Diagnostics& found) {
                                     read_controller_files(spec, found);
                                     read_function_files(spec, found);
                                   },
                                   advise_body, cosim::load_fmu};
  auto loaded = embed::load_system(path, readers, std::move(options), diagnostics);
  loaded.start_from = start_from;
  warn_of_units(loaded.spec, diagnostics);
  finish_start(start, start_from, loaded.system, diagnostics);
  return loaded;
}

}  // namespace bough::analysis
