#include "analysis/export/export.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <utility>

#include "analysis/common/body_files.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/text_file.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/number_checks.hpp"
#include "cli/common/options.hpp"
#include "cli/common/usage_text.hpp"

namespace bough::cli {

namespace {

using ExportOptions = RequestOptions<analysis::ExportRequest>;

/// -o, --output given several times, a line each: of an FMU what is no .fmu is an output of it, as --channel.
bool take_outputs(ExportOptions& o) {
  if (o.output.find('\n') == std::string::npos) return true;
  std::istringstream lines(std::exchange(o.output, {}));
  for (std::string line; std::getline(lines, line);) {
    if (o.request.format == "fmu" && !analysis::has_suffix(line, ".fmu"))
      o.request.channels.push_back(line);
    else if (std::exchange(o.output, line) != "")
      return false;
  }
  return true;
}

/// Advice for a missing -o.
std::string describe_output(const std::string& format) {
  if (format == "pvd") return "--to pvd writes several files: give the .pvd with -o";
  if (format == "fmu") return "--to fmu writes no text: give the .fmu with -o";
  if (format == "mat") return "--to mat writes no text: give the file with -o";
  return "--to extseout writes three files: give their common name with -o";
}

std::string describe(const analysis::FmuSummary& fmu, int version) {
  return "FMI " + std::to_string(version) + ".0: " + count(fmu.parameters, "parameter") + ", " +
         count(fmu.inputs, "input") + ", " + count(fmu.outputs, "output") + ", " +
         count(fmu.states, "continuous state") + ", " + count(fmu.event_indicators, "event indicator") + "\n";
}

void print_written(const ExportOptions& o, const analysis::ExportAnswer& answer, const Console& console) {
  if (const auto* component = std::get_if<analysis::ComponentSummary>(&answer.summary)) {
    console.print(fmt::format(
        "external superelement {}: {} boundary grids, {} generalized coordinates\nwritten: {}.op4, {}.asm, {}.pch\n",
        component->id, component->num_grids, component->num_generalized, component->stem, component->stem,
        component->stem));
    return;
  }
  const auto* fmu = std::get_if<analysis::FmuSummary>(&answer.summary);
  std::string frames;
  if (o.request.format == "pvd") frames = " of " + count(static_cast<std::size_t>(answer.num_frames), "frame");
  console.print((fmu ? describe(*fmu, o.request.fmu.version) : "") + "written: " + o.output + frames + "\n");
}

int run_export(const ExportOptions& given) {
  auto o = given;
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  if (!take_outputs(o)) {
    console.print_error("cli.usage", "-o is given twice", "name one file to write");
    return kUsageError;
  }
  const auto& request = o.request;
  if (const auto foreign = analysis::list_foreign_options(request); !foreign.empty()) {
    console.print_error("cli.usage", fmt::format("--to {} does not have {}", request.format, fmt::join(foreign, ", ")),
                        "leave it out; see bough export --help");
    return kUsageError;
  }
  analysis::demand_body_file(request.file);
  if (!o.output.empty()) check_output(o, o.output, {analysis::get_body_path(request.file)});
  const bool is_written = analysis::is_written_format(request.format);
  if (is_written && o.output.empty()) {
    console.print_error("cli.usage", describe_output(request.format), "see bough export --help");
    return kUsageError;
  }
  o.request.output = o.output;
  ConsoleEvents events(console);
  const auto answer = analysis::export_file(request, events);
  console.print(events.get_messages());
  if (is_written) {
    print_written(o, answer, console);
  } else if (o.output.empty()) {
    console.print_data(answer.text);
  } else {
    analysis::write_text_file(o.output, answer.text);
    console.print("written: " + o.output + "\n");
  }
  return kSuccess;
}

void add_body_export_options(CLI::App& verb, analysis::BodyExportOptions& o) {
  verb.add_option("--inertia", o.inertia, "sid: the inertia J as 6x1 (11 22 33 12 13 23) or 3x3")
      ->check(CLI::IsMember({"6x1", "3x3"}))
      ->capture_default_str();
  verb.add_option("--ge-order", o.ge_order,
                  "sid: columns of Ge by mode (3 for each) or by component (one for each mode)")
      ->check(CLI::IsMember({"mode", "component"}))
      ->capture_default_str();
  verb.add_option("--digits", o.digits, "sid: significant digits")->check(is_within(6, 17))->capture_default_str();
}

void add_component_options(CLI::App& verb, analysis::ComponentExportOptions& options) {
  verb.add_option("--id", options.id, "extseout: id of the superelement (default: EXTID of the deck, else 1)")
      ->check(is_positive());
  verb.add_option("--unit", options.unit,
                  "extseout: unit of the .op4 file in the assembly deck (default: MATOP4 of the deck, else the id)")
      ->check(is_positive());
  verb.add_option("--vendor", options.vendor, "extseout: names and order of the matrices, nx or msc")
      ->check(CLI::IsMember({"nx", "msc"}))
      ->capture_default_str();
  verb.add_option("--first-point", options.first_point,
                  "extseout of a body: id of its first generalized coordinate (default: 1001 above its nodes)")
      ->check(is_positive());
}

void add_moving_options(CLI::App& verb, analysis::MovingOptions& o) {
  verb.add_option("--every", o.every, "pvd, gltf: one in so many samples")->check(is_positive())->capture_default_str();
  verb.add_option("--window", o.window, "pvd, gltf: only samples from T0 to T1, as T0,T1")->delimiter(',')->expected(2);
  verb.add_option("--scale", o.scale, "pvd, gltf: the deformation that many times as large")
      ->check(make_finite())
      ->capture_default_str();
  verb.add_option("--follow", o.follow, "pvd, gltf: positions from the origin of this body");
  verb.add_option("--body", o.bodies, "pvd, gltf: a body file of the run that has moved; may be repeated")
      ->allow_extra_args(false);
}

/// "csv: results ...; sid, mbdyn, flat: flexible body": formats that take the same files together.
std::string list_inputs() {
  std::vector<std::pair<std::string, std::string>> groups;  // files, formats
  for (const auto& format : analysis::list_export_formats()) {
    auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == format.takes; });
    if (group == groups.end()) group = groups.insert(groups.end(), {format.takes, ""});
    group->second += (group->second.empty() ? "" : ", ") + std::string(format.word);
  }
  std::string text;
  for (const auto& [takes, formats] : groups) text += (text.empty() ? "" : "; ") + formats + ": " + takes;
  return text;
}

}  // namespace

void add_export(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_export, "export");
  verb->add_option("file", o->request.file, list_inputs())->required();
  std::string formats = "Format: ";
  std::vector<std::string> words;
  for (const auto& format : analysis::list_export_formats()) {
    formats += (words.empty() ? "" : ", ") + std::string(format.what);
    words.emplace_back(format.word);
  }
  verb->add_option("--to", o->request.format, formats)->required()->check(CLI::IsMember(words));
  verb->add_option("--channel", o->request.channels,
                   "csv, uff: only these: a path or folder of the file, or a sensor; with :component; may be repeated "
                   "(default: all). csv of modes or a body: modes, their table instead of the shapes. fmu: the outputs "
                   "(default: every sensor)")
      ->allow_extra_args(false);
  verb->add_flag("--ascii", o->request.is_ascii, "vtu, pvd: numbers as text instead of base64");
  verb->add_flag("--moving", o->request.is_moving,
                 "uff: the moving system of a run, places and displacements at each sample, instead of its channels");
  verb->add_option("--fields", o->request.fields,
                   "bdf: large (16 columns where 8 lose digits), small (always 8) or free (commas, every digit)")
      ->check(CLI::IsMember({"large", "small", "free"}))
      ->capture_default_str();
  verb->add_option("--fmi", o->request.fmu.version, "fmu: version of the standard, 2 or 3")
      ->check(CLI::IsMember({2, 3}))
      ->capture_default_str();
  verb->add_option("--units", o->request.fmu.units,
                   "fmu: units of the system file, as mm-N-tonne or m-kg-s, for the units of the variables");
  add_set_option(*verb, o->request.fmu.set);
  verb->add_option("--ignore", o->request.ignore_cards, "bdf, extseout: leave this card out; may be repeated")
      ->allow_extra_args(false);
  add_body_export_options(*verb, o->request.body);
  add_moving_options(*verb, o->request.moving);
  add_component_options(*verb, o->request.component);
  add_common_options(*verb, *o, kOutput,
                     "Write to this file instead of stdout; fmu: again with a signal, another output of the FMU");
  verb->get_option("--output")->multi_option_policy(CLI::MultiOptionPolicy::Join);
}

}  // namespace bough::cli
