#include "cli/common/system_files.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "cli/common/body_files.hpp"
#include "cli/common/control_files.hpp"
#include "cli/common/old_commands.hpp"
#include "cli/common/options.hpp"
#include "cli/common/start_state.hpp"
#include "formats/toml/specs.hpp"
#include "formats/toml/system_text.hpp"
#include "solver/integrate/simulate.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

std::string resolve_beside(const std::string& from_file, const std::string& path) {
  if (from_file.empty() || fs::path(path).is_absolute()) return path;
  return (fs::path(from_file).parent_path() / path).string();
}

namespace {

/// As seen from here, unless that climbs out of this folder.
std::string shorten(const std::string& path) {
  std::error_code failed;
  const auto near = fs::proximate(path, failed).string();
  return failed || near.rfind("..", 0) == 0 ? path : near;
}

/// What to reduce into the body file that is missing: the body file of the same name beside it, when there is one.
std::string name_reducible(const std::string& file) {
  const auto spec = fs::path(file).replace_extension(".toml");
  return fs::exists(spec) ? spec.string() : "BODY.toml";
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

void add_set_option(CLI::App& verb, std::vector<std::string>& set) {
  verb.add_option("--set", set, "NAME=VALUE: another number for a parameter of [parameters]; may be repeated")
      ->allow_extra_args(false);
}

namespace {

std::vector<std::pair<std::string, std::string>> split_settings(const std::vector<std::string>& set,
                                                                const std::string& path) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const auto& text : set) {
    const auto sign = text.find('=');
    std::string value = sign == std::string::npos ? "" : text.substr(sign + 1);
    char* end = nullptr;
    std::strtod(value.c_str(), &end);
    if (value.empty() || *end != '\0')
      throw InputError("cli.bad-setting", {path}, "--set " + text + " is not NAME=NUMBER", "write --set name=1.5");
    // TOML wants a digit on both sides of a point.
    if (value.front() == '.') value = "0" + value;
    if (value.back() == '.') value += "0";
    pairs.emplace_back(text.substr(0, sign), value);
  }
  return pairs;
}

/// cg and inertia that the bodies of a .FLX give; of several with this file they are the same.
std::optional<RigidPart> find_rigid_part(const records::SystemSpec& spec, const std::string& file,
                                         Diagnostics& diagnostics) {
  const records::BodyRecord* found = nullptr;
  for (const auto& body : spec.bodies) {
    if (body.file != file || (body.inertia.isZero(0) && body.cg.isZero(0))) continue;
    if (found && (body.inertia != found->inertia || body.cg != found->cg))
      diagnostics.error("flx.two-inertias", body.at,
                        "body \"" + body.name + "\" gives the body of " + file + " another inertia or cg than body \"" +
                            found->name + "\"",
                        "one body of a .FLX has one inertia: correct one of them");
    if (!found) found = &body;
  }
  if (!found) return std::nullopt;
  return RigidPart{found->cg, found->inertia};
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
  const auto& start_from = options.start_from;
  if (!options.text) {
    demand_file(path);
    refuse_treetops_input(path);
  }
  const auto set = split_settings(options.set, path);
  auto spec = options.text ? toml_files::read_system_spec_text(*options.text, path, set, diagnostics)
                           : toml_files::read_system_spec(path, diagnostics, set);
  if (options.change_spec && diagnostics.num_errors() == 0) options.change_spec(spec);
  if (diagnostics.num_errors() == 0) {
    read_controller_files(spec, diagnostics);
    read_function_files(spec, diagnostics);
  }
  const bool has_errors_of_text = diagnostics.num_errors() > 0;
  const auto place = [&](const std::string& name) {
    return fs::absolute(resolve_beside(path, name)).lexically_normal().string();
  };
  std::map<std::string, records::FlexBody> given, flex;
  for (auto& [name, body] : options.flex) given[place(name)] = std::move(body);
  std::map<std::string, std::string> flex_path;
  for (auto& body : spec.bodies) {
    if (body.file.empty() || flex.count(body.file)) continue;
    const auto given_rigid = find_rigid_part(spec, body.file, diagnostics);
    if (const auto found = given.find(place(body.file)); found != given.end()) {
      flex[body.file] = found->second;
      continue;
    }
    const auto file = resolve_beside(path, body.file);
    body.is_unreadable = true;
    if (!fs::exists(get_body_path(file))) {
      diagnostics.error("cli.no-body-file", body.at.file.empty() ? SourceLocation{path} : body.at,
                        "body \"" + body.name + "\": there is no file " + shorten(get_body_path(file)),
                        "make it with bough " +
                            (is_flx(file)                ? "flx BODY.h5"
                             : has_suffix(file, ".flat") ? "export BODY.h5 --to flat"
                                                         : "reduce " + name_reducible(shorten(file))) +
                            " -o " + shorten(get_body_path(file)) + ", or correct the name");
      continue;
    }
    try {
      flex[body.file] = read_moving_body(file, diagnostics, given_rigid);
      flex_path[body.file] = get_body_path(file);
      body.is_unreadable = false;
    } catch (const InputError& error) {
      for (auto item : error.items()) {
        item.advice += (item.advice.empty() ? "" : "; ") + std::string("named by body \"") + body.name + "\" at " +
                       path + (body.at.line > 0 ? ":" + std::to_string(body.at.line) : "");
        diagnostics.add(std::move(item));
      }
    }
  }
  // A file with errors of its own has no meaning to go on with; one without is taken as far as it goes, so that one
  // round shows all errors of bodies, hinges, forces, sensors, events and the run.
  if (has_errors_of_text) diagnostics.throw_if_errors();
  if (!start_from.empty()) {
    diagnostics.throw_if_errors();
    demand_file(start_from);
    set_start_state(spec, start_from, diagnostics);
  }
  auto system = solver::System::build_as_far(spec, flex, diagnostics);
  solver::check_run(system, spec, diagnostics);
  diagnostics.throw_if_errors();
  return {std::move(spec), std::move(flex), std::move(flex_path), std::move(system), start_from};
}

}  // namespace bough::cli
