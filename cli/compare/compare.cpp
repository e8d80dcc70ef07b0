#include "analysis/compare/compare.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "analysis/common/body_files.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/number_checks.hpp"
#include "cli/common/options.hpp"
#include "cli/compare/compare_report.hpp"
#include "formats/hdf5/comparison_file.hpp"

namespace bough::cli {

namespace {

using CompareOptions = RequestOptions<analysis::CompareRequest>;

template <class Report>
void print_report(const Report& report, const CompareOptions& o, const Console& console) {
  if (o.json)
    console.print_data(make_json(report).dump(2) + "\n");
  else
    console.print(format_report(report) + (o.output.empty() ? "" : "\nwritten: " + o.output + "\n"));
}

int run_compare(const CompareOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  if (const auto advice = analysis::find_wrong_number(o.request); !advice.empty()) {
    console.print_error("cli.usage", fmt::format("{} files given", o.request.files.size()), advice);
    return kUsageError;
  }
  if (o.request.tam != "serep" && o.request.deck.empty()) {
    console.print_error("cli.usage", "--tam " + o.request.tam + " needs the deck of the model", "give it by --deck");
    return kUsageError;
  }
  if (!o.output.empty()) {
    std::vector<std::string> inputs{o.request.mass, o.request.test, o.request.deck};
    for (const auto& name : o.request.files) inputs.push_back(analysis::get_body_path(name));
    check_output(o, o.output, inputs);
  }
  ConsoleEvents events(console);
  const auto answer = analysis::compare_files(o.request, events);
  if (!o.output.empty()) hdf5::write_comparison(analysis::make_comparison(o.request, answer), o.output);
  std::visit([&](const auto& report) { print_report(report, o, console); }, answer);
  console.print(events.get_messages());
  return kSuccess;
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_compare, "compare");
  verb->add_option("files", o->request.files,
                   "Two flexible bodies or modes files; or one body: its integrals by method; or three with "
                   "--refinement")
      ->required();
  verb->add_option("--mass", o->request.mass, "Matrices file of A's deck: the MAC weighted with its mass matrix, too");
  verb->add_flag("--refinement", o->request.refinement,
                 "Three bodies of refined meshes, coarse to fine: observed orders");
  auto* test = verb->add_option("--test", o->request.test,
                                "Universal file of a test of the one model: its shapes (dataset 55) for MAC, "
                                "cross-orthogonality, COMAC; its functions (58) for FRAC against a frequency response");
  verb->add_option("--tam", o->request.tam, "Test-analysis model: serep (from the modes), guyan or irs (from --deck)")
      ->check(CLI::IsMember({"serep", "guyan", "irs"}))
      ->capture_default_str()
      ->needs(test);
  verb->add_option("--deck", o->request.deck, "Nastran deck of the model, for --tam guyan and irs")->needs(test);
  verb->add_option("--sensors", o->request.sensors,
                   "Places for this many sensors on the one model, by effective independence of its modes")
      ->check(is_positive())
      ->excludes(test);
  add_common_options(*verb, *o, kOutput | kJson, "HDF5 file with the numbers");
}

}  // namespace bough::cli
