#include "embed/load.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <filesystem>

#include "base/platform.hpp"
#include "formats/flx/flx_file.hpp"
#include "formats/toml/specs.hpp"
#include "formats/toml/system_text.hpp"
#include "solver/builder/build_system.hpp"
#include "solver/simulate/simulate.hpp"

namespace bough::embed {

namespace fs = std::filesystem;

std::string resolve_beside(const std::string& from_file, const std::string& path) {
  if (from_file.empty() || fs::path(path).is_absolute()) return path;
  return (fs::path(from_file).parent_path() / path).string();
}

std::string shorten_path(const std::string& path) {
  std::error_code failed;
  const auto near = fs::proximate(path, failed).string();
  return failed || near.rfind("..", 0) == 0 ? path : near;
}

std::string get_body_path(const std::string& name) {
  const auto parsed = flx::parse_flx_name(name);
  return parsed ? parsed->path : name;
}

void give_rigid_part(records::FlexBody& body, bool has_rigid, const std::optional<RigidPart>& given,
                     const std::string& path) {
  if (!has_rigid && !given)
    throw InputError("flx.no-inertia", {path},
                     "the file contains no centre of mass and no inertia of body \"" + body.name + "\"",
                     "give cg and inertia in the [[body]] of the system, or write the file with bough flx from a body "
                     "that has them");
  if (has_rigid && given)
    throw InputError("flx.two-inertias", {path},
                     "the file contains the centre of mass and the inertia of body \"" + body.name + "\" itself",
                     "take cg and inertia out of the [[body]]");
  if (!given) return;
  body.cg = given->cg;
  const Eigen::Matrix3d apart =
      given->cg.squaredNorm() * Eigen::Matrix3d::Identity() - given->cg * given->cg.transpose();
  body.inertia = given->inertia + body.mass * apart;
}

namespace {

std::vector<std::pair<std::string, std::string>> split_settings(const std::vector<std::string>& set,
                                                                const std::string& path) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const auto& text : set) {
    const auto sign = text.find('=');
    std::string value = sign == std::string::npos ? "" : text.substr(sign + 1);
    double number = 0;
    const auto [end, failed] = platform::read_number(value.data(), value.data() + value.size(), number);
    if (value.empty() || failed != std::errc() || end != value.data() + value.size())
      throw InputError("cli.bad-setting", {path}, "the setting " + text + " is not NAME=NUMBER", "write name=1.5");
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

/// Lends each FMU under a unique name, stored in `lent` of its record: two controllers may have one file.
std::vector<std::unique_ptr<solver::HostedController>> lend_fmus(records::SystemSpec& spec, const FileReaders& readers,
                                                                 Diagnostics& diagnostics) {
  static std::atomic<long> number = 0;
  std::vector<std::unique_ptr<solver::HostedController>> lent;
  for (auto& controller : spec.controllers) {
    if (controller.type != "fmu") continue;
    try {
      auto functions = readers.fmu(controller);
      const std::string name = "fmu " + std::to_string(++number);
      controller.settings.words[solver::kLentKey] = {name};
      lent.push_back(std::make_unique<solver::HostedController>(name, std::move(functions)));
    } catch (const InputError& error) {
      for (const auto& item : error.items()) diagnostics.add(item);
    }
  }
  diagnostics.throw_if_errors();
  return lent;
}

}  // namespace

LoadedSystem load_system(const std::string& path, const FileReaders& readers, LoadOptions options,
                         Diagnostics& diagnostics) {
  const auto set = split_settings(options.set, path);
  auto spec = options.text ? toml_files::read_system_spec_text(*options.text, path, set, diagnostics)
                           : toml_files::read_system_spec(path, diagnostics, set);
  if (options.change_spec && diagnostics.num_errors() == 0) options.change_spec(spec);
  if (diagnostics.num_errors() == 0 && readers.matrices) readers.matrices(spec, diagnostics);
  const bool has_errors_of_text = diagnostics.num_errors() > 0;
  auto lent = readers.fmu && !has_errors_of_text ? lend_fmus(spec, readers, diagnostics)
                                                 : std::vector<std::unique_ptr<solver::HostedController>>();
  const auto place = [&](const std::string& name) {
    std::error_code none;  // without a working directory names stay as they are
    const fs::path whole = resolve_beside(path, name);
    const auto absolute = fs::absolute(whole, none);
    return (none ? whole : absolute).lexically_normal().string();
  };
  std::map<std::string, records::FlexBody> given, flex;
  for (auto& [name, body] : options.flex) given[place(name)] = std::move(body);
  std::map<std::string, std::string> flex_path;
  const auto load = [&](records::BodyRecord& body) {
    if (body.file.empty() || flex.count(body.file)) return;
    const auto given_rigid = find_rigid_part(spec, body.file, diagnostics);
    if (const auto found = given.find(place(body.file)); found != given.end()) {
      flex[body.file] = found->second;
      return;
    }
    const auto file = resolve_beside(path, body.file);
    body.is_unreadable = true;
    std::error_code failed;
    if (!fs::exists(get_body_path(file), failed)) {
      diagnostics.error("cli.no-body-file", body.at.file.empty() ? SourceLocation{path} : body.at,
                        "body \"" + body.name + "\": there is no file " + shorten_path(get_body_path(file)),
                        readers.advise_body ? readers.advise_body(file) : "correct the name");
      return;
    }
    try {
      flex[body.file] = readers.body(file, diagnostics, given_rigid);
      flex_path[body.file] = get_body_path(file);
      body.is_unreadable = false;
    } catch (const InputError& error) {
      for (auto item : error.items()) {
        item.advice += (item.advice.empty() ? "" : "; ") + std::string("named by body \"") + body.name + "\" at " +
                       path + (body.at.line > 0 ? ":" + std::to_string(body.at.line) : "");
        diagnostics.add(std::move(item));
      }
    }
  };
  for (auto& body : spec.bodies) {
    load(body);
    for (const auto& level : body.levels) {
      auto of_level = body;
      of_level.file = level;
      load(of_level);
    }
  }
  // A file with errors in its text ends the load here. Else loading continues, to report all errors of bodies, hinges,
  // forces, sensors, events and the run at once.
  if (has_errors_of_text) diagnostics.throw_if_errors();
  if (options.set_start) {
    diagnostics.throw_if_errors();
    options.set_start(spec, diagnostics);
  }
  auto system = solver::draft_system(spec, flex, diagnostics);
  solver::check_run(system, spec, diagnostics);
  diagnostics.throw_if_errors();
  return {std::move(spec), std::move(flex), std::move(flex_path), std::move(system), std::move(lent), {}};
}

}  // namespace bough::embed
