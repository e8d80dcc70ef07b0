#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <utility>

#include "analysis/common/body_files.hpp"
#include "analysis/common/channels.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/system_files.hpp"
#include "cli/common/console.hpp"
#include "cli/common/event_list.hpp"
#include "cli/common/options.hpp"
#include "cli/common/text_file.hpp"
#include "cli/common/vtu_file.hpp"
#include "cli/export/export_bodies.hpp"
#include "cli/export/export_component.hpp"
#include "cli/export/export_fmu.hpp"
#include "cli/export/export_matrices.hpp"
#include "cli/export/moving_system.hpp"
#include "cli/linearize/linear_model_files.hpp"
#include "cli/linearize/sweep_tables.hpp"
#include "cli/response/response_csv.hpp"
#include "formats/export/response_text.hpp"
#include "formats/export/uff.hpp"
#include "formats/export/vtu.hpp"
#include "formats/hdf5/complex_modes_file.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/hdf5/response_file.hpp"
#include "formats/hdf5/sweep_file.hpp"
#include "formats/nastran/reader.hpp"
#include "formats/nastran/writer.hpp"
#include "formats/toml/specs.hpp"

namespace bough::cli {

namespace {

struct ExportOptions : CommonOptions {
  std::string file;
  std::string format;
  std::vector<std::string> channels;
  bool ascii = false, is_moving = false;
  std::string fields = "large";
  BodyExportOptions body;
  MovingOptions moving;
  std::vector<std::string> ignore_cards;
  FmuOptions fmu;
  ComponentExportOptions component;
};

bool is_response(const std::string& format) { return format == "bough-frequency" || format == "bough-transient"; }

/// The time and the channels chosen, all by default.
std::vector<exports::CsvColumn> read_columns(const ExportOptions& o) {
  const auto results = hdf5::read_results(o.file);
  std::vector<exports::CsvColumn> columns{{"time", results.time}};
  if (o.channels.empty()) {
    for (const auto& [path, values] : results.channels) {
      if (path == "/time") continue;
      for (auto& column : analysis::choose_columns(results, o.file, path)) columns.push_back(std::move(column));
    }
  }
  for (const auto& choice : o.channels) {
    for (auto& column : analysis::choose_columns(results, o.file, choice)) columns.push_back(std::move(column));
  }
  columns.front().unit = analysis::get_unit(results, "/time");
  if (!analysis::has_unit_labels(results))
    for (auto& column : columns) column.unit.clear();
  return columns;
}

std::string make_csv(const ExportOptions& o, Diagnostics& diagnostics) {
  std::ostringstream text;
  if (!o.channels.empty()) {
    if (const auto own = analysis::read_file_format(o.file); has_shapes(own)) {
      if (o.channels != std::vector<std::string>{"modes"})
        throw InputError("cli.unknown-channel", {o.file},
                         "a file of modes or a body has no channel '" + o.channels[0] + "'",
                         "--channel modes is the table of modes; without --channel come the shapes");
      exports::write_csv(text, read_mode_columns(o.file, own, diagnostics));
      return text.str();
    }
  }
  if (o.channels == std::vector<std::string>{"events"} || o.channels == std::vector<std::string>{"/events"})
    return make_events_csv(hdf5::read_results(o.file).events);
  const auto format = o.channels.empty() ? analysis::read_file_format(o.file) : "";
  if (format == "bough-linear") return make_linear_csv(hdf5::read_linear_model(o.file));
  if (format == "bough-sweep") return make_sweep_csv(hdf5::read_sweep(o.file));
  if (format == "bough-response") return make_response_csv(hdf5::read_model_response(o.file).response);
  if (is_response(format)) return exports::make_response_csv(hdf5::read_response(o.file));
  exports::write_csv(text, has_shapes(format) ? read_shape_columns(o.file, format, diagnostics) : read_columns(o));
  return text.str();
}

std::string make_universal(const ExportOptions& o, Diagnostics& diagnostics) {
  if (o.is_moving)
    return make_moving_uff(read_moving_system(o.file, o.moving, diagnostics), o.moving.scale, o.file, diagnostics);
  const auto format = analysis::read_file_format(o.file);
  if (format == "bough-modes") return exports::make_uff(hdf5::read_modes(o.file));
  if (format == "bough-flexbody") return exports::make_uff(analysis::read_body(o.file, diagnostics));
  if (format == "bough-results") return exports::make_uff(read_columns(o));
  if (is_response(format)) return exports::make_uff(hdf5::read_response(o.file));
  refuse_export(o.file, "uff", "a flexible body, or what bough modes, run, frequency or transient wrote");
}

/// The mode shapes of a modes file or a flexible body.
std::string make_shapes(const ExportOptions& o, Diagnostics& diagnostics) {
  const std::string format = analysis::read_file_format(o.file);
  const auto encoding = o.ascii ? exports::VtuEncoding::Ascii : exports::VtuEncoding::Base64;
  if (format == "bough-modes")
    return make_vtu_text(exports::make_picture(hdf5::read_modes(o.file)), encoding, o.file, diagnostics);
  if (format == "bough-complex-modes")
    return make_vtu_text(exports::make_picture(hdf5::read_complex_modes(o.file)), encoding, o.file, diagnostics);
  if (format == "bough-flexbody")
    return make_vtu_text(exports::make_picture(analysis::read_body(o.file, diagnostics)), encoding, o.file,
                         diagnostics);
  throw InputError("cli.no-shapes", {o.file}, "the file holds no mode shapes, found format \"" + format + "\"",
                   "give a file that bough modes or bough reduce wrote");
}

std::string make_bdf(const ExportOptions& o, Diagnostics& diagnostics) {
  analysis::demand_deck(o.file);
  const auto deck = nastran::read_deck(o.file, {o.ignore_cards}, diagnostics);
  diagnostics.throw_if_errors();
  nastran::WriteOptions options;
  if (o.fields == "small") options.fields = nastran::FieldFormat::Small;
  if (o.fields == "free") options.fields = nastran::FieldFormat::Free;
  auto text = nastran::write_deck(deck, options, diagnostics);
  diagnostics.throw_if_errors();
  return text;
}

int export_pvd(const ExportOptions& o, const Console& console, Diagnostics& diagnostics) {
  if (o.output.empty()) {
    console.print_error("cli.usage", "--to pvd writes several files: give the .pvd with -o", "see bough export --help");
    return kUsageError;
  }
  const auto system = read_moving_system(o.file, o.moving, diagnostics);
  const int frames = write_pvd(system, o.moving.scale, o.ascii, o.output, diagnostics);
  console.print(diagnostics);
  console.print("written: " + o.output + " of " + count(static_cast<std::size_t>(frames), "frame") + "\n");
  return kSuccess;
}

int export_system(const ExportOptions& o, const Console& console, Diagnostics& diagnostics) {
  if (o.output.empty()) {
    console.print_error("cli.usage", "--to fmu writes no text: give the .fmu with -o", "see bough export --help");
    return kUsageError;
  }
  analysis::demand_kind(o.file, toml_files::detect_kind(o.file), "system");
  auto options = o.fmu;
  options.outputs = o.channels;
  const auto summary = export_fmu(o.file, o.output, options, diagnostics);
  console.print(diagnostics);
  console.print(summary + "written: " + o.output + "\n");
  return kSuccess;
}

/// -o, --output given several times, a line each: of an FMU what is no .fmu is an output of it, as --channel.
bool take_outputs(ExportOptions& o) {
  if (o.output.find('\n') == std::string::npos) return true;
  std::istringstream lines(std::exchange(o.output, {}));
  for (std::string line; std::getline(lines, line);) {
    if (o.format == "fmu" && !analysis::has_suffix(line, ".fmu"))
      o.channels.push_back(line);
    else if (std::exchange(o.output, line) != "")
      return false;
  }
  return true;
}

int run_export(ExportOptions o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  if (!take_outputs(o)) {
    console.print_error("cli.usage", "-o is given twice", "name one file to write");
    return kUsageError;
  }
  analysis::demand_body_file(o.file);
  if (!o.output.empty()) check_output(o, o.output, {analysis::get_body_path(o.file)});
  Diagnostics diagnostics;
  if (o.format == "fmu") return export_system(o, console, diagnostics);
  if (o.format == "extseout") {
    if (o.output.empty()) {
      console.print_error("cli.usage", "--to extseout writes three files: give their common name with -o",
                          "see bough export --help");
      return kUsageError;
    }
    const auto summary = export_component(o.file, o.output, o.component, o.ignore_cards, diagnostics);
    console.print(diagnostics);
    console.print(summary);
    return kSuccess;
  }
  if (o.format != "bdf") analysis::warn_incomplete(o.file, diagnostics);
  if (o.format == "mat") {
    if (o.output.empty()) {
      console.print_error("cli.usage", "--to mat writes no text: give the file with -o", "see bough export --help");
      return kUsageError;
    }
    export_mat(o.file, o.output, diagnostics);
    console.print(diagnostics);
    console.print("written: " + o.output + "\n");
    return kSuccess;
  }
  if (o.format == "pvd") return export_pvd(o, console, diagnostics);
  const auto text = o.format == "vtu"          ? make_shapes(o, diagnostics)
                    : o.format == "gltf"       ? make_glb(o.file, o.moving, diagnostics)
                    : o.format == "bdf"        ? make_bdf(o, diagnostics)
                    : o.format == "op4"        ? make_op4(o.file, diagnostics)
                    : o.format == "uff"        ? make_universal(o, diagnostics)
                    : is_body_format(o.format) ? make_body_text(o.file, o.format, o.body, diagnostics)
                                               : make_csv(o, diagnostics);
  console.print(diagnostics);
  if (o.output.empty()) {
    console.print_data(text);
  } else {
    write_text_file(o.output, text);
    console.print("written: " + o.output + "\n");
  }
  return kSuccess;
}

}  // namespace

void add_export(CLI::App& app, Action& action) {
  auto o = std::make_shared<ExportOptions>();
  auto* verb = add_verb(app, "export", "Bodies, modes, matrices, results or a deck in the format of another program");
  verb->add_option(
          "file", o->file,
          "csv: results, modes, flexible body, linear model, sweep or response of a deck; vtu: modes file or flexible "
          "body; pvd: results; gltf: results, modes file or flexible body; bdf: Nastran deck; sid, mbdyn, flat: "
          "flexible body; extseout: Nastran deck with BSET1 or flexible body; fmu: system file; mat, op4, uff: any "
          "HDF5 file of Bough that has such arrays")
      ->required();
  verb->add_option("--to", o->format,
                   "Format: csv, vtu (mode shapes for ParaView), pvd (the moving system for ParaView), gltf "
                   "(.glb: the moving system or modes), bdf (the deck as Bough reads it), mat (MATLAB), "
                   "op4 (Nastran OUTPUT4), uff (universal file), sid (Standard Input Data), mbdyn (.fem), flat (a "
                   "body for hosts without HDF5), extseout (external superelement of Nastran: .op4, .asm, .pch), fmu "
                   "(the system for other simulators)")
      ->required()
      ->check(CLI::IsMember(
          {"csv", "vtu", "pvd", "gltf", "bdf", "mat", "op4", "uff", "sid", "mbdyn", "flat", "extseout", "fmu"}));
  verb->add_option("--channel", o->channels,
                   "csv, uff: only these: a path or folder of the file, or a sensor; with :component; may be repeated "
                   "(default: all). csv of modes or a body: modes, their table instead of the shapes. fmu: the outputs "
                   "(default: every sensor)")
      ->allow_extra_args(false);
  verb->add_flag("--ascii", o->ascii, "vtu, pvd: numbers as text instead of base64");
  verb->add_flag("--moving", o->is_moving,
                 "uff: the moving system of a run, places and displacements at each sample, instead of its channels");
  verb->add_option("--fields", o->fields,
                   "bdf: large (16 columns where 8 lose digits), small (always 8) or free (commas, every digit)")
      ->check(CLI::IsMember({"large", "small", "free"}))
      ->capture_default_str();
  verb->add_option("--fmi", o->fmu.version, "fmu: version of the standard, 2 or 3")
      ->check(CLI::IsMember({2, 3}))
      ->capture_default_str();
  verb->add_option("--units", o->fmu.units,
                   "fmu: units of the system file, as mm-N-tonne or m-kg-s, for the units of the variables");
  add_set_option(*verb, o->fmu.set);
  verb->add_option("--ignore", o->ignore_cards, "bdf, extseout: leave this card out; may be repeated")
      ->allow_extra_args(false);
  add_body_export_options(*verb, o->body);
  add_moving_options(*verb, o->moving);
  add_component_options(*verb, o->component);
  add_common_options(*verb, *o, kOutput,
                     "Write to this file instead of stdout; fmu: again with a signal, another output of the FMU");
  verb->get_option("--output")->multi_option_policy(CLI::MultiOptionPolicy::Join);
  verb->footer(
      "Example:\n  bough export spinup.h5 --to csv -o spinup.csv\n"
      "  bough export spinup.h5 --to csv --channel tip_deflection:y --channel /bodies/boom/eta\n"
      "  bough export spinup.h5 --to csv --channel events\n"
      "  bough export boom-modes.h5 --to vtu -o boom.vtu\n  bough export boom-modes.h5 --to csv --channel modes\n"
      "  bough export spinup.h5 --to pvd --every 10 -o spinup.pvd\n  bough export spinup.h5 --to gltf -o spinup.glb\n"
      "  bough export spinup.h5 --to uff --moving --every 10 -o spinup.uff\n"
      "  bough export boom.h5 --to mat -o boom.mat\n"
      "  bough export boom-modes.h5 --to uff -o boom.uff\n  bough export boom.h5 --to sid -o boom.SID_FEM\n"
      "  bough export boom.h5 --to mbdyn -o boom.fem\n  bough export boom.h5 --to flat -o boom.flat\n  bough export "
      "spinup.toml --to fmu --fmi 2 --channel tip_deflection:y -o spinup.fmu\n  bough export boom.bdf --to bdf -o "
      "plain.bdf\n  bough export panel.bdf --to extseout -o panel");
  verb->callback([&action, o] { action = [o] { return run_export(*o); }; });
}

}  // namespace bough::cli
