#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "analysis/common/failures.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/equilibrium/equilibrium.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/options.hpp"
#include "cli/verbs.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::cli {

namespace {

using EquilibriumOptions = RequestOptions<analysis::EquilibriumRequest>;

/// A results file of one sample: plot, export and --start-from take it as any other.
void write_equilibrium(const analysis::EquilibriumAnswer& answer, const std::string& path) {
  const auto writer = hdf5::make_results_writer(path);
  writer->begin(answer.header);
  writer->write_sample(answer.sample);
  writer->write_checkpoint(answer.checkpoint);
  writer->end(true, "");
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

int run_equilibrium(const EquilibriumOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  ConsoleEvents events(console);
  const auto check = [&](const std::vector<std::string>& files) {
    if (!o.output.empty()) check_output(o, o.output, files);
  };
  const auto answer = analysis::find_equilibrium(o.request, check, events);
  const auto& found = answer.found;
  console.print(events.get_messages());
  nlohmann::json unstable = nlohmann::json::array();
  for (const auto& growth : found.unstable) unstable.push_back({{"mode", growth.mode}, {"rate", growth.rate}});
  const auto& q = answer.q;
  if (o.json) {
    console.print_data(nlohmann::json{{"time", found.point.t},
                                      {"q", std::vector<double>(q.begin(), q.end())},
                                      {"u", std::vector<double>(found.point.u.begin(), found.point.u.end())},
                                      {"residual", found.residual},
                                      {"iterations", found.num_iterations},
                                      {"stable", found.unstable.empty()},
                                      {"unstable", unstable},
                                      {"indifferent", found.neutral},
                                      {"kept", found.kept},
                                      {"spinning", found.spinning}}
                           .dump(2) +
                       "\n");
  } else {
    std::string text =
        fmt::format("{} equilibrium after {} iterations: |u_dot| {:.1e}\n",
                    found.unstable.empty() ? "stable" : "unstable", found.num_iterations, found.residual);
    Table table{{"hinge", "coordinates"}, {}};
    for (const auto& [hinge, values] : answer.hinges) {
      std::vector<std::string> words;
      for (const double value : values) words.push_back(fmt::format("{:.8g}", value));
      table.rows.push_back({hinge, join(words)});
    }
    if (!table.rows.empty()) text += table.to_text();
    if (!found.spinning.empty()) text += "at a given rate: " + join(found.spinning) + "\n";
    if (!found.neutral.empty()) text += "indifferent, left where they were: " + join(found.neutral) + "\n";
    if (!found.kept.empty()) text += "as they start, nothing changes them: " + join(found.kept) + "\n";
    console.print(text);
  }
  if (!o.output.empty())
    analysis::write_whole(o.output, [&](const std::string& part) { write_equilibrium(answer, part); });
  return print_written_files(o, console, {o.output});
}

}  // namespace

void add_equilibrium(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_equilibrium, "equilibrium", &analysis::EquilibriumRequest::file);
  verb->add_option("file", o->request.file, "System file (.toml); hinge rates given there are kept")->required();
  add_set_option(*verb, o->request.set);
  add_common_options(*verb, *o, kOutput | kJson, "Write the state to this HDF5 file, for --start-from");
}

}  // namespace bough::cli
