#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "analysis/common/body_files.hpp"
#include "analysis/common/channels.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/text_file.hpp"
#include "base/version.hpp"
#include "cli/common/console.hpp"
#include "cli/common/options.hpp"
#include "cli/report/report_files.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

struct ReportOptions : CommonOptions {
  ReportRequest request;
  std::string title;
};

int run_report(const ReportOptions& o) {
  const Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  const auto& files = o.request.files;
  std::vector<std::string> paths;
  for (const auto& file : files) {
    analysis::demand_body_file(file);
    paths.push_back(analysis::get_body_path(file));
  }
  const std::string output = o.output.empty() ? fs::path(paths.front()).stem().string() + ".html" : o.output;
  check_output(o, output, paths);
  Diagnostics diagnostics;
  report::Page page{
      o.title.empty() ? fs::path(paths.front()).stem().string() : o.title, std::string("Bough ") + get_version(), {}};
  for (const auto& file : files) {
    if (!analysis::has_suffix(file, ".json")) analysis::warn_incomplete(file, diagnostics);
    page.chapters.push_back(make_chapter(file, o.request, diagnostics));
  }
  if (auto overlay = report::make_overlay(page.chapters); !overlay.panels.empty())
    page.chapters.insert(page.chapters.begin(), std::move(overlay));
  const std::string html = report::make_page(page);
  analysis::write_text_file(output, html);
  console.print(diagnostics);
  console.print(fmt::format("written: {} ({:.2f} MB)\n", output, static_cast<double>(html.size()) / 1e6));
  return kSuccess;
}

}  // namespace

void add_report(CLI::App& app, Action& action) {
  auto o = std::make_shared<ReportOptions>();
  auto* verb = add_verb(app, "report", "One HTML page of results, bodies, modes, linear models, for any browser");
  verb->add_option("files", o->request.files,
                   "Results, flexible bodies, modes, static solutions, responses, linear models, sweeps, comparisons, "
                   "outcomes.h5 of "
                   "a campaign, or the JSON "
                   "that `select` printed")
      ->required();
  verb->add_option("--channel", o->request.channels,
                   "Of results only this: a sensor, NAME:component, or a path such as /energy; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--title", o->title, "Title of the page (default: the name of the first file)");
  add_common_options(*verb, *o, kOutput, "The page (default: the first file's name with .html, here)");
  verb->footer(
      "The page loads nothing from anywhere. Bodies of a run are drawn from the files that it names, or from those "
      "given "
      "here.\nExample:\n  bough report spinup.h5 boom.h5 -o spinup.html");
  verb->callback([&action, o] { action = [o] { return run_report(*o); }; });
}

}  // namespace bough::cli
