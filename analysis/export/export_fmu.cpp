#include "analysis/export/export_fmu.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/common/system_files.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/export/fmu_units.hpp"
#include "base/platform.hpp"
#include "base/version.hpp"
#include "embed/bough.h"
#include "embed/dependencies.hpp"
#include "embed/fmi_variables.hpp"
#include "embed/model.hpp"
#include "formats/flat/flex_body.hpp"
#include "formats/flx/flx_file.hpp"
#include "formats/fmu/archive.hpp"
#include "formats/fmu/model_description.hpp"
#include "formats/records/signal_name.hpp"
#include "formats/toml/key_editor.hpp"
#include "formats/toml/system_editor.hpp"
#include "solver/builder/signal_units.hpp"
#include "solver/control/hosted.hpp"
#include "solver/simulate/channel_units.hpp"
#include "solver/tree/coordinates.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

namespace {

std::string read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  if (!file || !(bytes << file.rdbuf()))
    throw InputError("cli.no-file", {path}, "the file cannot be read", "check its path and permissions");
  return std::move(bytes).str();
}

/// A TOML number that reads back to the same bits.
std::string format_number(double value) {
  char buffer[32];
  std::string text(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string format_list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + format_number(value);
  return "[" + text + "]";
}

std::string format_matrix(const Eigen::MatrixXd& matrix) {
  std::string text;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const Eigen::VectorXd row = matrix.row(i);
    text += (text.empty() ? "" : ", ") + format_list({row.begin(), row.end()});
  }
  return "[" + text + "]";
}

/// Rewrites a system so that everything it needs is in one folder.
class Packing {
 public:
  explicit Packing(const LoadedSystem& loaded) : loaded_(loaded), text_(loaded.spec.text) {}

  /// \return the resources in the order of their names, without the manifest.
  std::vector<fmi::Resource> pack() {
    // Edits change lines, not numbers of items: the list stays valid.
    for (const auto& item : toml_files::list_items(text_)) {
      const auto at = static_cast<std::size_t>(std::max(item.number, 1)) - 1;
      if (std::find(item.keys.begin(), item.keys.end(), "file") == item.keys.end()) continue;
      if (item.kind == "body") add_body(item, loaded_.spec.bodies.at(at));
      if (item.kind == "function") add_table(item, loaded_.spec.functions.at(at));
      if (item.kind == "controller") add_controller(item, loaded_.spec.controllers.at(at));
    }
    add(fmi::kSystemFile, text_);
    std::vector<fmi::Resource> resources;
    for (auto& [name, bytes] : files_) resources.push_back({name, std::move(bytes)});
    return resources;
  }

 private:
  [[noreturn]] void fail(const toml_files::TableItem& item, const std::string& why, const std::string& advice) const {
    throw InputError("fmu.cannot-pack", {loaded_.spec.file, item.line},
                     "[[" + item.kind + "]] '" + item.name + "' cannot be packed into an FMU: " + why, advice);
  }
  void set(const toml_files::TableItem& item, const std::string& key, const std::string& value) {
    const auto problem = toml_files::set_value(text_, item.path() + "." + key, value);
    if (!problem.empty()) fail(item, problem, "write it as [[" + item.kind + "]], with one key per line");
  }
  void remove(const toml_files::TableItem& item, const std::string& key) {
    if (std::find(item.keys.begin(), item.keys.end(), key) == item.keys.end()) return;
    const auto problem = toml_files::remove_path(text_, item.path() + "." + key);
    if (!problem.empty()) fail(item, problem, "write it as [[" + item.kind + "]], with one key per line");
  }

  void add(const std::string& name, std::string bytes) { files_[name] = std::move(bytes); }

  /// A name for the bytes of `source`: that of its file; a second file of this name gets a number.
  std::string choose_name(const std::string& source, const std::string& stem, const std::string& ending) {
    if (const auto known = names_.find(source); known != names_.end()) return known->second;
    std::string safe;
    for (const char c : stem)
      safe += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.' ? c : '_';
    std::string name = safe + ending;
    for (int i = 2; files_.count(name) > 0 || name == fmi::kSystemFile || name == fmi::kManifest; ++i)
      name = safe + "-" + std::to_string(i) + ending;
    return names_[source] = name;
  }

  void add_body(const toml_files::TableItem& item, const records::BodyRecord& body) {
    const auto flx_name = flx::parse_flx_name(body.file);
    const bool gives_rigid_part = !body.inertia.isZero(0) || !body.cg.isZero(0);
    if (flx_name && gives_rigid_part) {
      // The file lacks mass properties that the system gives, maybe by parameters.
      const auto path = loaded_.flex_path.at(body.file);
      const auto name = choose_name(path, fs::path(path).stem().string(), ".FLX");
      if (files_.count(name) == 0) add(name, read_bytes(path));
      set(item, "file",
          toml_files::quote_text(name + (flx_name->body_id > 0 ? ":" + std::to_string(flx_name->body_id) : "")));
      return;
    }
    const auto add_flat = [&](const std::string& file) {
      const auto name = choose_name(file, fs::path(embed::get_body_path(file)).stem().string(), ".flat");
      if (files_.count(name) == 0) add(name, flat::format_flex_body(loaded_.flex.at(file)));
      return toml_files::quote_text(name);
    };
    set(item, "file", add_flat(body.file));
    std::string levels;
    for (const auto& level : body.levels) levels += (levels.empty() ? "" : ", ") + add_flat(level);
    if (!levels.empty()) set(item, "levels", "[" + levels + "]");
  }

  void add_table(const toml_files::TableItem& item, const records::FunctionRecord& function) {
    for (const char* key : {"file", "time_column", "column"}) remove(item, key);
    set(item, "x", format_list(function.x));
    set(item, "y", format_list(function.y));
  }

  void add_controller(const toml_files::TableItem& item, const records::ControllerRecord& controller) {
    if (controller.type == "state_space" || controller.type == "gain") {
      remove(item, "file");
      for (const auto& [key, matrix] : controller.settings.matrices) {
        const bool is_there = std::find(item.keys.begin(), item.keys.end(), key) != item.keys.end();
        if (!is_there && matrix.size() > 0) set(item, key, format_matrix(matrix));
      }
      return;
    }
    const auto found = controller.settings.words.find("file");
    const std::string file =
        found == controller.settings.words.end() || found->second.empty() ? "" : found->second.front();
    const bool is_hosted = solver::find_hosted_controller(file).has_value();
    if (controller.type != "library" || is_hosted)
      fail(item, is_hosted ? "it is a function of the program that exports" : "its type is \"" + controller.type + "\"",
           "use a shared library (type \"library\"), or take its signal from an [[input]]");
    const auto path = fs::path(file);
    const auto name = choose_name(file, path.stem().string(), path.extension().string());
    if (files_.count(name) == 0) add(name, read_bytes(file));
    set(item, "file", toml_files::quote_text(name));
  }

  const LoadedSystem& loaded_;
  std::string text_;
  std::map<std::string, std::string> names_;  ///< by source
  std::map<std::string, std::string> files_;  ///< by name
};

/// Files of the loaded libraries whose names start with one of the prefixes, by name.
std::map<std::string, std::string> list_loaded(std::initializer_list<std::string_view> prefixes) {
  std::map<std::string, std::string> paths;
  for (const auto& path : platform::list_libraries()) {
    const std::string name = fs::path(path).filename().string();
    for (const auto prefix : prefixes)
      if (name.starts_with(prefix)) paths[name] = path;
  }
  return paths;
}

/// The binary of FMUs in the build tree or where it is installed: below a folder above the Python module if this code
/// is part of it, or above the program.
std::string find_binary() {
  std::error_code failed;
  const auto program = platform::find_executable(failed);
  std::vector<fs::path> starts;
  for (const auto& [name, path] : list_loaded({"_bough."})) starts.push_back(fs::canonical(path, failed));
  starts.push_back(program);
  for (const auto& start : starts)
    for (auto folder = start.parent_path(); folder != folder.parent_path(); folder = folder.parent_path())
      for (const char* place : {"lib/bough_fmu.so", "lib/bough/bough_fmu.so"})
        if (fs::is_regular_file(folder / place, failed)) return (folder / place).string();
  const auto folder = program.parent_path().parent_path();
  const auto built = folder / "lib/bough_fmu.so", installed = folder / "lib/bough/bough_fmu.so";
  throw ComputationError(
      "fmu.no-binary", {},
      "the binary of FMUs is missing: " + built.string() + " and " + installed.string() + " do not exist",
      "install the whole package bough, or build the target bough_fmi");
}

/// Libraries that the binary needs and a plain system lacks, as this program has loaded them. The OpenMP runtime of
/// muParser gets another name, so that a program with its own is not disturbed.
std::vector<fmu::ArchiveEntry> collect_libraries(const std::string& folder) {
  const auto paths = list_loaded({"libmuparser.so", "libgomp.so"});
  std::vector<fmu::ArchiveEntry> entries;
  const std::string shared = "libgomp.so", own = "libbgmp.so";
  for (const auto& [name, path] : paths) {
    std::string bytes = read_bytes(path);
    const std::string of = '\0' + shared;
    for (auto at = bytes.find(of); at != std::string::npos; at = bytes.find(of, at + of.size()))
      bytes.replace(at + 1, own.size(), own);
    entries.push_back(
        {folder + (name.starts_with(shared) ? own + name.substr(shared.size()) : name), std::move(bytes), true});
  }
  return entries;
}

std::vector<fmu::Variable> list_variables(const embed::Model& model, bough_kind kind, fmi::VariableKind as) {
  std::vector<fmu::Variable> variables;
  for (const auto& port : *model.list(kind))
    variables.push_back({port.name, port.dims.empty() ? "" : "dimension " + port.dims,
                         fmi::make_reference(as, variables.size()), port.start});
  return variables;
}

/// Dependencies as value references.
void set_dependencies(const std::optional<embed::Dependencies>& found, fmu::Variable& variable) {
  if (!found) return;
  std::vector<std::uint32_t> references;
  if (found->on_time) references.push_back(fmu::kTimeReference);
  for (const int i : found->inputs)
    references.push_back(fmi::make_reference(fmi::VariableKind::Input, static_cast<std::size_t>(i)));
  for (const int i : found->states)
    references.push_back(fmi::make_reference(fmi::VariableKind::State, static_cast<std::size_t>(i)));
  variable.dependencies = std::move(references);
  variable.is_linear = found->is_constant;
}

/// Sensors, or the components of the channels that are named, in the order of the names.
std::vector<fmu::Variable> choose_outputs(const embed::Model& model, const std::vector<std::string>& chosen,
                                          const std::string& file) {
  const auto all = list_variables(model, BOUGH_OUTPUTS, fmi::VariableKind::Output);
  std::vector<fmu::Variable> outputs;
  std::set<std::uint32_t> taken;
  const auto add = [&](const fmu::Variable& variable) {
    if (taken.insert(variable.reference).second) outputs.push_back(variable);
  };
  if (chosen.empty())
    for (const auto& variable : all)
      if (!variable.name.starts_with("/")) add(variable);
  for (const auto& name : chosen) {
    if (const int at = model.find(BOUGH_OUTPUTS, name); at >= 0) {
      add(all[static_cast<std::size_t>(at)]);
      continue;
    }
    bool has_any = false;
    std::vector<std::string> names;
    const auto path = records::parse_signal_name(name).path;
    const std::string sensor = path.starts_with("/sensors/") ? path.substr(9) : path;
    for (const auto& variable : all) {
      names.push_back(variable.name);
      const bool is_part = name.find(':') == std::string::npos &&
                           (variable.name.starts_with(sensor + ":") || variable.name.starts_with(path + ":") ||
                            variable.name.starts_with(path + "/"));
      if (!is_part) continue;
      add(variable);
      has_any = true;
    }
    if (has_any) continue;
    const std::string near = find_nearest(name, names);
    throw InputError("fmu.output", {file}, "the system has no output '" + name + "'",
                     near.empty() ? "give a sensor, or a channel of the results with :component, as /hinges/root/q:1"
                                  : "did you mean '" + near + "'?");
  }
  return outputs;
}

/// Dimensions of a state, and whether "1" and "1/T" in them are those of an angle; of modes and blocks empty.
std::pair<std::string, bool> find_state_dims(const solver::System& system, int row) {
  const auto layout = system.layout();
  if (row == layout.work() || row == layout.dissipated()) return {"F L", false};
  if (const int out = layout.work() - system.num_momentum_out(); row >= out)
    return {row < out + 3 ? "M L/T" : "M L^2/T", false};
  for (const auto& tb : system.tree.bodies) {
    const int q = row - tb.q_offset, u = row - layout.num_q - tb.u_offset;
    std::string dims;
    bool is_quaternion = false;
    if (q >= 0 && q < tb.num_hinge_q() && row < layout.num_q) {
      dims = list_hinge_dims(tb, solver::HingeQuantity::Position, q, 1);
      is_quaternion = tb.num_hinge_q() != tb.num_hinge_u();
    } else if (u >= 0 && u < tb.num_hinge_u() && row < layout.num_q + layout.num_u) {
      dims = list_hinge_dims(tb, solver::HingeQuantity::Rate, u, 1);
    }
    if (!dims.empty()) return {dims, dims.front() == '1' && !is_quaternion};
  }
  return {};
}

void set_units(const embed::Model& model, const std::string& text, fmu::ModelDescription& d) {
  FmuUnits units(text);
  const auto& ports = *model.list(BOUGH_OUTPUTS);
  for (std::size_t i = 0; i < d.inputs.size(); ++i)
    d.inputs[i].unit = units.add((*model.list(BOUGH_INPUTS))[i].dims, false);
  for (auto& output : d.outputs) {
    const auto& port = ports[output.reference & fmi::kMaxIndex];
    output.unit = units.add(port.dims, port.dims.starts_with('1') &&
                                           solver::is_angle(model.loaded().system, model.loaded().spec, port.channel));
  }
  for (std::size_t i = 0; i < d.states.size(); ++i) {
    const auto [dims, has_angle] = find_state_dims(model.loaded().system, static_cast<int>(i));
    d.states[i].unit = units.add(dims, has_angle);
    d.derivatives[i].unit = units.add(solver::make_rate_dims(dims), has_angle);
  }
  d.time_unit = units.add("T", false);
  d.units = units.list();
}

}  // namespace

FmuSummary export_fmu(const std::string& file, const std::string& output, const FmuOptions& options,
                      Diagnostics& diagnostics) {
  const auto binary = find_binary();
  const embed::Model model(load_system(file, diagnostics, "", options.set));
  const auto& spec = model.loaded().spec;
  const auto resources = Packing(model.loaded()).pack();
  const auto manifest = fmi::make_manifest(resources, std::string(get_version()));

  fmu::ModelDescription d;
  const auto stem = fs::path(output).stem().string();
  d.identifier = fmu::make_identifier(stem);
  d.model_name = spec.name.empty() ? stem : spec.name;
  d.token = fmi::calc_token(manifest, resources);
  d.tool = "Bough " + std::string(get_version());
  const auto& s = spec.simulation;
  d.start = s.start;
  d.stop = s.start + s.duration;
  d.tolerance = s.relative_tolerance;
  d.step = s.output_step > 0 ? s.output_step : s.duration / 1000;
  d.parameters = list_variables(model, BOUGH_PARAMETERS, fmi::VariableKind::Parameter);
  d.inputs = list_variables(model, BOUGH_INPUTS, fmi::VariableKind::Input);
  d.outputs = choose_outputs(model, options.outputs, file);
  d.states = list_variables(model, BOUGH_STATES, fmi::VariableKind::State);
  d.derivatives = list_variables(model, BOUGH_STATES, fmi::VariableKind::Derivative);
  for (auto& variable : d.derivatives) variable.name = "der(" + variable.name + ")";
  d.event_indicators = list_variables(model, BOUGH_EVENTS, fmi::VariableKind::EventIndicator);
  const embed::DependencyGraph graph(model.loaded().system, spec);
  for (auto& output : d.outputs)
    set_dependencies(graph.find_of_channel((*model.list(BOUGH_OUTPUTS))[output.reference & fmi::kMaxIndex].channel),
                     output);
  for (std::size_t i = 0; i < d.derivatives.size(); ++i)
    set_dependencies(graph.find_of_derivative(static_cast<int>(i)), d.derivatives[i]);
  for (std::size_t i = 0; i < d.event_indicators.size(); ++i)
    set_dependencies(graph.find_of_event_function(static_cast<int>(i), static_cast<int>(d.event_indicators.size())),
                     d.event_indicators[i]);

  if (!options.units.empty()) demand_labels(options.units, spec.units, {file});
  set_units(model, options.units.empty() ? name_labelled_set(spec.units) : options.units, d);
  const std::string folder =
      std::string("binaries/") + (options.version == 2 ? platform::kFmi2Platform : platform::kFmi3Platform) + "/";
  std::vector<fmu::ArchiveEntry> entries{
      {"modelDescription.xml", options.version == 2 ? format_fmi2(d) : format_fmi3(d)},
      {folder + d.identifier + platform::kLibrarySuffix, read_bytes(binary), true}};
  for (auto& entry : collect_libraries(folder)) entries.push_back(std::move(entry));
  entries.push_back({std::string("resources/") + fmi::kManifest, manifest});
  for (const auto& resource : resources) entries.push_back({"resources/" + resource.name, resource.bytes});
  write_whole(output, [&](const std::string& part) { fmu::write_archive(part, entries); });
  return {d.parameters.size(), d.inputs.size(), d.outputs.size(), d.states.size(), d.event_indicators.size()};
}

}  // namespace bough::analysis
