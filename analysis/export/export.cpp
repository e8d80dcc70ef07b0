#include "analysis/export/export.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <sstream>

#include "analysis/common/body_files.hpp"
#include "analysis/common/channels.hpp"
#include "analysis/common/choices.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/vtu_file.hpp"
#include "analysis/export/csv_tables.hpp"
#include "analysis/export/export_matrices.hpp"
#include "formats/export/response_text.hpp"
#include "formats/export/uff.hpp"
#include "formats/export/vtu.hpp"
#include "formats/hdf5/complex_modes_file.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/hdf5/response_file.hpp"
#include "formats/hdf5/sweep_file.hpp"
#include "formats/nastran/whole_deck.hpp"
#include "formats/toml/specs.hpp"

namespace bough::analysis {

namespace {

bool is_response(const std::string& format) { return format == "bough-frequency" || format == "bough-transient"; }

/// The time and the channels chosen, all by default.
std::vector<exports::CsvColumn> read_columns(const ExportRequest& request) {
  const auto results = hdf5::read_results(request.file);
  std::vector<exports::CsvColumn> columns{{"time", results.time}};
  if (request.channels.empty()) {
    for (const auto& [path, values] : results.channels) {
      if (path == "/time") continue;
      for (auto& column : choose_columns(results, request.file, path)) columns.push_back(std::move(column));
    }
  }
  for (const auto& choice : request.channels) {
    for (auto& column : choose_columns(results, request.file, choice)) columns.push_back(std::move(column));
  }
  columns.front().unit = get_unit(results, "/time");
  if (!has_unit_labels(results))
    for (auto& column : columns) column.unit.clear();
  return columns;
}

std::string make_csv(const ExportRequest& request, Diagnostics& diagnostics) {
  std::ostringstream text;
  if (!request.channels.empty()) {
    if (const auto own = read_file_format(request.file); has_shapes(own)) {
      if (request.channels != std::vector<std::string>{"modes"})
        throw InputError("cli.unknown-channel", {request.file},
                         "a file of modes or a body has no channel '" + request.channels[0] + "'",
                         "--channel modes is the table of modes; without --channel come the shapes");
      exports::write_csv(text, read_mode_columns(request.file, own, diagnostics));
      return text.str();
    }
  }
  if (std::any_of(request.channels.begin(), request.channels.end(),
                  [](const auto& name) { return name == "events" || name == "/events"; })) {
    if (request.channels.size() > 1)
      throw InputError("cli.unknown-channel", {request.file},
                       "events have other times than samples and are no column next to a channel",
                       "export them alone: --channel events");
    return make_events_csv(hdf5::read_results(request.file).events);
  }
  const auto format = request.channels.empty() ? read_file_format(request.file) : "";
  if (format == "bough-linear") return make_linear_csv(hdf5::read_linear_model(request.file));
  if (format == "bough-sweep") return make_sweep_csv(hdf5::read_sweep(request.file));
  if (format == "bough-response") return make_response_csv(hdf5::read_model_response(request.file).response);
  if (is_response(format)) return exports::make_response_csv(hdf5::read_response(request.file));
  exports::write_csv(
      text, has_shapes(format) ? read_shape_columns(request.file, format, diagnostics) : read_columns(request));
  return text.str();
}

std::string make_universal(const ExportRequest& request, Diagnostics& diagnostics) {
  if (request.is_moving)
    return make_moving_uff(read_moving_system(request.file, request.moving, diagnostics), request.moving.scale,
                           request.file, diagnostics);
  const auto format = read_file_format(request.file);
  if (format == "bough-modes") return exports::make_uff(hdf5::read_modes(request.file));
  if (format == "bough-flexbody") return exports::make_uff(read_body(request.file, diagnostics));
  if (format == "bough-results") return exports::make_uff(read_columns(request));
  if (is_response(format)) return exports::make_uff(hdf5::read_response(request.file));
  if (format == "bough-response") return exports::make_uff(hdf5::read_model_response(request.file).response);
  refuse_export(request.file, "uff",
                "a flexible body, or what bough modes, run, frequency, transient or response wrote");
}

/// The mode shapes of a modes file or a flexible body.
std::string make_shapes(const ExportRequest& request, Diagnostics& diagnostics) {
  const std::string format = read_file_format(request.file);
  const auto encoding = request.is_ascii ? exports::VtuEncoding::Ascii : exports::VtuEncoding::Base64;
  if (format == "bough-modes")
    return make_vtu_text(exports::make_picture(hdf5::read_modes(request.file)), encoding, request.file, diagnostics);
  if (format == "bough-complex-modes")
    return make_vtu_text(exports::make_picture(hdf5::read_complex_modes(request.file)), encoding, request.file,
                         diagnostics);
  if (format == "bough-flexbody")
    return make_vtu_text(exports::make_picture(read_body(request.file, diagnostics)), encoding, request.file,
                         diagnostics);
  throw InputError("cli.no-shapes", {request.file}, "the file holds no mode shapes, found format \"" + format + "\"",
                   "give a file that bough modes or bough reduce wrote");
}

/// Relative names of ASSIGN begin in the folder of the deck: makes them begin in the folder of the new one.
void move_assigned_files(records::Deck& deck, const ExportRequest& request) {
  namespace fs = std::filesystem;
  const auto get_folder = [](const std::string& file) { return fs::absolute(file).lexically_normal().parent_path(); };
  const auto from = get_folder(request.file), to = request.output.empty() ? from : get_folder(request.output);
  if (from == to) return;
  for (auto& [unit, file] : deck.super.input4)
    if (!file.path.empty() && fs::path(file.path).is_relative())
      file.path = (from / file.path).lexically_normal().lexically_relative(to).string();
}

std::string make_bdf(const ExportRequest& request, Diagnostics& diagnostics) {
  demand_deck(request.file);
  auto deck = nastran::read_whole_deck(request.file, {request.ignore_cards}, diagnostics);
  diagnostics.throw_if_errors();
  move_assigned_files(deck, request);
  nastran::WriteOptions options;
  if (request.fields == "small") options.fields = nastran::FieldFormat::Small;
  if (request.fields == "free") options.fields = nastran::FieldFormat::Free;
  auto text = nastran::write_deck(deck, options, diagnostics);
  diagnostics.throw_if_errors();
  return text;
}

using MakeText = std::string (*)(const ExportRequest&, Diagnostics&);

/// A format whose writer gives a text or one block of bytes.
template <MakeText make>
void set_text(const ExportRequest& request, ExportAnswer& answer, Diagnostics& diagnostics) {
  answer.text = make(request, diagnostics);
}

std::string make_gltf(const ExportRequest& request, Diagnostics& diagnostics) {
  return make_glb(request.file, request.moving, diagnostics);
}
std::string make_output4(const ExportRequest& request, Diagnostics& diagnostics) {
  return make_op4(request.file, diagnostics);
}
std::string make_body(const ExportRequest& request, Diagnostics& diagnostics) {
  return make_body_text(request.file, request.format, request.body, diagnostics);
}

void write_mat(const ExportRequest& request, ExportAnswer&, Diagnostics& diagnostics) {
  export_mat(request.file, request.output, diagnostics);
}
void write_frames(const ExportRequest& request, ExportAnswer& answer, Diagnostics& diagnostics) {
  const auto system = read_moving_system(request.file, request.moving, diagnostics);
  answer.num_frames = write_pvd(system, request.moving.scale, request.is_ascii, request.output, diagnostics);
}
void write_component(const ExportRequest& request, ExportAnswer& answer, Diagnostics& diagnostics) {
  answer.summary = export_component(request.file, request.output, request.component, request.ignore_cards, diagnostics);
}
void write_fmu(const ExportRequest& request, ExportAnswer& answer, Diagnostics& diagnostics) {
  demand_kind(request.file, toml_files::detect_kind(request.file), "system");
  auto options = request.fmu;
  options.outputs = request.channels;
  answer.summary = export_fmu(request.file, request.output, options, diagnostics);
}

}  // namespace

const std::vector<ExportFormat>& list_export_formats() {
  static const std::vector<ExportFormat> formats{
      {"csv",
       "csv",
       "results, modes, flexible body, linear model, sweep or response of a deck",
       false,
       {"--channel"},
       set_text<make_csv>},
      {"vtu",
       "vtu (mode shapes for ParaView)",
       "modes file or flexible body",
       false,
       {"--ascii"},
       set_text<make_shapes>},
      {"pvd",
       "pvd (the moving system for ParaView)",
       "results",
       true,
       {"--ascii", "--every", "--window", "--scale", "--follow", "--body"},
       write_frames},
      {"gltf",
       "gltf (.glb: the moving system or modes)",
       "results, modes file or flexible body",
       false,
       {"--every", "--window", "--scale", "--follow", "--body"},
       set_text<make_gltf>},
      {"bdf", "bdf (the deck as Bough reads it)", "Nastran deck", false, {"--fields", "--ignore"}, set_text<make_bdf>},
      {"mat", "mat (MATLAB)", "any HDF5 file of Bough that has such arrays", true, {}, write_mat},
      {"op4",
       "op4 (Nastran OUTPUT4)",
       "any HDF5 file of Bough that has such arrays",
       false,
       {},
       set_text<make_output4>},
      {"uff",
       "uff (universal file)",
       "any HDF5 file of Bough that has such arrays",
       false,
       {"--channel", "--moving", "--every", "--window", "--scale", "--follow", "--body"},
       set_text<make_universal>},
      {"sid",
       "sid (Standard Input Data)",
       "flexible body",
       false,
       {"--inertia", "--ge-order", "--digits"},
       set_text<make_body>},
      {"mbdyn", "mbdyn (.fem)", "flexible body", false, {}, set_text<make_body>},
      {"flat", "flat (a body for hosts without HDF5)", "flexible body", false, {}, set_text<make_body>},
      {"extseout",
       "extseout (external superelement of Nastran: .op4, .asm, .pch)",
       "Nastran deck with BSET1 or flexible body",
       true,
       {"--ignore", "--id", "--unit", "--vendor", "--first-point"},
       write_component},
      {"fmu",
       "fmu (the system for other simulators)",
       "system file",
       true,
       {"--channel", "--fmi", "--units", "--set"},
       write_fmu}};
  return formats;
}

namespace {

const ExportFormat* find_export_format(const std::string& word) {
  for (const auto& format : list_export_formats())
    if (word == format.word) return &format;
  return nullptr;
}

/// Formats of inputs other than the HDF5 files of Bough, of which nothing can be incomplete.
void check_values(const ExportRequest& request) {
  demand_word("--fields", request.fields, {"large", "small", "free"});
  const auto& moving = request.moving;
  demand_range("--every", moving.every, 1, std::numeric_limits<int>::max());
  demand_finite("--scale", moving.scale);
  if (!moving.window.empty() && (moving.window.size() != 2 || !(moving.window[0] <= moving.window[1])))
    throw InputError("cli.bad-range", {}, fmt::format("the window {:g} is empty", fmt::join(moving.window, " to ")),
                     "give --window T0,T1 with T1 above T0");
  if (request.fmu.version != 2 && request.fmu.version != 3)
    demand_word("--fmi", std::to_string(request.fmu.version), {"2", "3"});
  demand_word("--inertia", request.body.inertia, {"6x1", "3x3"});
  demand_word("--ge-order", request.body.ge_order, {"mode", "component"});
  demand_range("--digits", request.body.digits, 6, 17);
  const auto& component = request.component;
  demand_range("--id", component.id, 0, std::numeric_limits<int>::max());
  demand_range("--unit", component.unit, 0, std::numeric_limits<int>::max());
  demand_range("--first-point", component.first_point, 0, std::numeric_limits<int>::max());
  demand_word("--vendor", component.vendor, {"nx", "msc"});
}

bool takes_text(const std::string& format) { return format == "bdf" || format == "fmu" || format == "extseout"; }

}  // namespace

std::vector<std::string> list_foreign_options(const ExportRequest& request) {
  const ExportRequest none;
  const auto &m = request.moving, &m0 = none.moving;
  const auto &b = request.body, &b0 = none.body;
  const auto &c = request.component, &c0 = none.component;
  const std::vector<std::pair<std::string, bool>> of_motion{{"--every", m.every != m0.every},
                                                            {"--window", !m.window.empty()},
                                                            {"--scale", m.scale != m0.scale},
                                                            {"--follow", !m.follow.empty()},
                                                            {"--body", !m.bodies.empty()}};
  std::vector<std::pair<std::string, bool>> all{{"--channel", !request.channels.empty()},
                                                {"--ascii", request.is_ascii},
                                                {"--moving", request.is_moving},
                                                {"--fields", request.fields != none.fields},
                                                {"--fmi", request.fmu.version != none.fmu.version},
                                                {"--units", !request.fmu.units.empty()},
                                                {"--set", !request.fmu.set.empty()},
                                                {"--ignore", !request.ignore_cards.empty()},
                                                {"--inertia", b.inertia != b0.inertia},
                                                {"--ge-order", b.ge_order != b0.ge_order},
                                                {"--digits", b.digits != b0.digits},
                                                {"--id", c.id != c0.id},
                                                {"--unit", c.unit != c0.unit},
                                                {"--vendor", c.vendor != c0.vendor},
                                                {"--first-point", c.first_point != c0.first_point}};
  all.insert(all.end(), of_motion.begin(), of_motion.end());
  std::vector<std::string> foreign;
  const auto* format = find_export_format(request.format);
  if (format == nullptr) return foreign;
  for (const auto& [name, is_given] : all)
    if (is_given && std::find(format->options.begin(), format->options.end(), name) == format->options.end())
      foreign.push_back(name);
  if (request.format == "uff" && !request.is_moving)  // its channels have no motion
    for (const auto& [name, is_given] : of_motion)
      if (is_given) foreign.push_back(name + " without --moving");
  return foreign;
}

bool is_written_format(const std::string& format) {
  const auto* row = find_export_format(format);
  return row != nullptr && row->is_written;
}

ExportAnswer export_file(const ExportRequest& request, Events& events) {
  const auto* format = find_export_format(request.format);
  if (format == nullptr)
    throw InputError("cli.no-export", {request.file}, "there is no format \"" + request.format + "\"",
                     "bough export --help lists the formats");
  if (const auto foreign = list_foreign_options(request); !foreign.empty())
    throw InputError("cli.bad-option", {},
                     fmt::format("--to {} does not have {}", request.format, fmt::join(foreign, ", ")), "leave it out");
  check_values(request);
  Diagnostics diagnostics;
  if (!takes_text(request.format)) warn_incomplete(request.file, diagnostics);
  ExportAnswer answer;
  format->make(request, answer, diagnostics);
  add_messages(diagnostics, events);
  return answer;
}

}  // namespace bough::analysis
