#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "channels.hpp"
#include "console.hpp"
#include "options.hpp"
#include "text_file.hpp"

namespace bough::cli {

namespace {

struct ExportOptions : CommonOptions {
  std::string file;
  std::string format;
  std::vector<std::string> channels;
};

int run_export(const ExportOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  demand_file(o.file);
  if (!o.output.empty()) check_output(o, o.output);
  const auto results = hdf5::read_results(o.file);
  std::vector<exports::CsvColumn> columns{{"time", results.time}};
  if (o.channels.empty()) {
    for (const auto& [path, values] : results.channels) {
      if (path == "/time") continue;
      for (auto& column : choose_columns(results, o.file, path)) columns.push_back(std::move(column));
    }
  }
  for (const auto& choice : o.channels) {
    for (auto& column : choose_columns(results, o.file, choice)) columns.push_back(std::move(column));
  }
  std::ostringstream text;
  exports::write_csv(text, columns);
  if (o.output.empty()) {
    console.print_data(text.str());
  } else {
    write_text_file(o.output, text.str());
  }
  return kSuccess;
}

}  // namespace

void add_export(CLI::App& app, Action& action) {
  auto o = std::make_shared<ExportOptions>();
  auto* verb = app.add_subcommand("export", "Results in another format");
  verb->add_option("file", o->file, "Results HDF5 file")->required();
  verb->add_option("--to", o->format, "Format: csv")->required()->check(CLI::IsMember({"csv"}));
  verb->add_option(
          "--channel", o->channels,
          "Only these: a path or folder of the file, or a sensor; with :component; may be repeated (default: all)")
      ->allow_extra_args(false);
  add_common_options(*verb, *o, kOutput, "Write to this file instead of stdout");
  verb->footer(
      "Example:\n  bough export spinup.h5 --to csv -o spinup.csv\n"
      "  bough export spinup.h5 --to csv --channel tip_deflection:y --channel /bodies/boom/eta");
  verb->callback([&action, o] { action = [o] { return run_export(*o); }; });
}

}  // namespace bough::cli
