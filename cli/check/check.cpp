#include "analysis/check/check.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "analysis/check/diagram.hpp"
#include "analysis/common/body_files.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/ranks.hpp"
#include "cli/check/check_tables.hpp"
#include "cli/common/console.hpp"
#include "cli/common/model_options.hpp"
#include "cli/common/number_checks.hpp"
#include "cli/common/options.hpp"
#include "formats/toml/specs.hpp"

namespace bough::cli {

namespace {

struct CheckOptions : CommonOptions {
  analysis::CheckRequest request;
  std::string diagram;
};

class ConsoleCheck final : public analysis::CheckEvents {
 public:
  explicit ConsoleCheck(Console& console) : console_(console) {}
  void set_rank(int rank) override { console_.set_rank(rank); }

 private:
  Console& console_;
};

/// Prints the summary and what was found, as text or JSON, and throws when an error is among it.
int finish(const CheckOptions& options, const Console& console, const std::string& text, nlohmann::json json,
           const Diagnostics& diagnostics) {
  if (options.json) {
    auto messages = nlohmann::json::array();
    for (const auto& item : diagnostics.items()) messages.push_back(format(item));
    json["messages"] = messages;
    json["errors"] = diagnostics.num_errors();
    json["warnings"] = diagnostics.num_warnings();
    write_report(options, console, json.dump(2) + "\n");
    console.print(diagnostics);
  } else {
    const auto sum = count(static_cast<std::size_t>(diagnostics.num_errors()), "error") + ", " +
                     count(static_cast<std::size_t>(diagnostics.num_warnings()), "warning") + "\n";
    // On the screen the messages precede their sum.
    if (options.output.empty()) console.print(text);
    console.print(diagnostics);
    write_report(options, console, options.output.empty() ? sum : text + sum);
  }
  return diagnostics.num_errors() > 0 ? kInputError : kSuccess;
}

void demand_system(const std::string& file) {
  const bool is_toml = analysis::has_suffix(file, ".toml");
  analysis::demand_kind(file, is_toml ? toml_files::detect_kind(file) : "", "system");
  if (!is_toml)
    throw InputError("cli.bad-diagram", {file}, "--diagram draws the blocks of a system file", "name a system.toml");
}

int check_file(const CheckOptions& options, Console& console) {
  const auto& file = options.request.file;
  analysis::do_once([&] { analysis::demand_body_file(file); });
  if (!options.diagram.empty()) demand_system(file);
  ConsoleCheck events(console);
  const auto answer = analysis::check_file(options.request, events);
  std::string text;
  nlohmann::json json;
  describe(answer, text, json);
  if (const auto* system = std::get_if<analysis::SystemCheck>(&answer.content);
      system != nullptr && !options.diagram.empty() && console.is_root())
    analysis::write_diagram(system->loaded.spec, options.diagram);
  return finish(options, console, text, json, answer.messages);
}

int run_check(const CheckOptions& options) {
  Console console(options.quiet, options.verbosity);
  analysis::do_once([&] {
    check_outputs(options, {options.output, options.diagram}, {analysis::get_body_path(options.request.file)});
  });
  try {
    return check_file(options, console);
  } catch (const InputError& failure) {
    if (!options.json) throw;
    Diagnostics diagnostics;
    for (const auto& item : failure.items()) diagnostics.add(item);
    return finish(options, console, {}, {{"kind", nullptr}}, diagnostics);
  }
}

}  // namespace

void add_check(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_check, "check");
  verb->add_option("file", o->request.file, "Nastran deck, body.toml, system.toml, .h5 or .FLX")->required();
  verb->add_option("--gpwg", o->request.weight_grid,
                   "Weights about this grid (0: the origin) as the grid point weight generator of Nastran prints them "
                   "(default: PARAM,GRDPNT)")
      ->check(is_not_negative())
      ->type_name("GRID");
  verb->add_option("--diagram", o->diagram,
                   "System file: draw its sensors, controllers, actuators, functions and bodies to FILE.dot, or by "
                   "graphviz to FILE.svg, .png or .pdf")
      ->type_name("FILE");
  add_model_options(*verb, o->request.model);
  add_set_option(*verb, o->request.set);
  add_common_options(*verb, *o, kOutput | kJson, "Write the report to this file instead of stdout");
}

}  // namespace bough::cli
