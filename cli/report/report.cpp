#include "analysis/report/report.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "analysis/common/body_files.hpp"
#include "analysis/common/text_file.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/options.hpp"

namespace bough::cli {

namespace {

int run_report(const RequestOptions<analysis::ReportRequest>& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  std::vector<std::string> paths;
  for (const auto& file : o.request.files) {
    analysis::demand_body_file(file);
    paths.push_back(analysis::get_body_path(file));
  }
  const std::string output = o.output.empty() ? analysis::choose_report_name(o.request) + ".html" : o.output;
  check_output(o, output, paths);
  ConsoleEvents events(console);
  const std::string html = analysis::make_report(o.request, events);
  analysis::write_text_file(output, html);
  console.print(events.get_messages());
  console.print(fmt::format("written: {} ({:.2f} MB)\n", output, static_cast<double>(html.size()) / 1e6));
  return kSuccess;
}

}  // namespace

void add_report(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_report, "report");
  verb->add_option("files", o->request.files,
                   "Results, flexible bodies, modes, static solutions, responses, linear models, sweeps, comparisons, "
                   "outcomes.h5 of "
                   "a campaign, or the JSON "
                   "that `select` printed")
      ->required();
  verb->add_option("--channel", o->request.channels,
                   "Of results only this: a sensor, NAME:component, or a path such as /energy; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--title", o->request.title, "Title of the page (default: the name of the first file)");
  add_common_options(*verb, *o, kOutput, "The page (default: the first file's name with .html, here)");
}

}  // namespace bough::cli
