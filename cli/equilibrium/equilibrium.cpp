#include "solver/linear/equilibrium.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/system_files.hpp"
#include "analysis/linearize/operating_point.hpp"
#include "cli/common/console.hpp"
#include "cli/common/options.hpp"
#include "cli/common/text_file.hpp"
#include "cli/run/provenance_sink.hpp"
#include "cli/verbs.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/toml/specs.hpp"
#include "solver/linear/linearize.hpp"
#include "solver/simulate/channel_units.hpp"
#include "solver/simulate/outputs.hpp"

namespace bough::cli {

namespace {

struct EquilibriumOptions : CommonOptions {
  std::string file;
  std::vector<std::string> set;
};

/// A results file of one sample: plot, export and --start-from take it as any other.
void write_equilibrium(const analysis::LoadedSystem& loaded, solver::Plant& plant, const solver::Equilibrium& found,
                       const std::vector<std::string>& sources, const std::string& path) {
  const auto& point = found.point;
  const Eigen::VectorXd u = plant.calc_speeds(point);
  plant.evaluate(point);
  solver::Outputs recorder(loaded.system);
  records::ResultsHeader header;
  header.system_text = loaded.spec.text;
  header.channels = recorder.channels();
  solver::label_channels(loaded.system, loaded.spec, header.channels);
  header.max_samples = 1;
  header.settings = {{"equilibrium_residual", fmt::format("{:.17g}", found.residual)}};
  const auto writer = hdf5::make_results_writer(path);
  ProvenanceSink sink(*writer, analysis::calc_sources(sources));
  sink.begin(header);
  sink.write_sample(recorder.calc_sample(point.t, plant.data(), point.q, u, 0, 0));
  Eigen::VectorXd state = Eigen::VectorXd::Zero(point.q.size() + u.size() + point.z.size() + 2);
  state.head(state.size() - 2) << point.q, u, point.z;
  records::Checkpoint checkpoint;
  checkpoint.time = point.t;
  checkpoint.state = state;
  // Control memory as a run writes it: the time of the last samples, before any, then the memory.
  Eigen::VectorXd control(1 + point.memory.size());
  control << std::numeric_limits<double>::lowest(), point.memory;
  checkpoint.memory = {{"control", control}};
  sink.write_checkpoint(checkpoint);
  sink.end(true, "");
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

int run_equilibrium(const EquilibriumOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  analysis::demand_file(o.file);
  if (analysis::has_suffix(o.file, ".toml")) analysis::demand_kind(o.file, toml_files::detect_kind(o.file), "system");
  Diagnostics diagnostics;
  const auto loaded = analysis::load_system(o.file, diagnostics, {}, o.set);
  const auto sources = analysis::collect_sources(o.file, loaded);
  if (!o.output.empty()) check_output(o, o.output, sources);
  solver::warn_of_latches(loaded.system, {o.file}, diagnostics);
  auto plant = analysis::make_plant(loaded);
  const auto start = plant.make_initial_point();
  const auto found = solver::find_equilibrium(plant, start, {o.file});
  if (!found.unstable.empty())
    diagnostics.warning("equilibrium.unstable", {o.file},
                        fmt::format("the state found is unstable: {} leaves it, growing by e in {:.3g}",
                                    found.unstable.front().mode, 1 / found.unstable.front().rate),
                        "start nearer to the state wanted, by position and eta; bough linearize --equilibrium has the "
                        "poles");
  console.print(diagnostics);
  nlohmann::json unstable = nlohmann::json::array();
  for (const auto& growth : found.unstable) unstable.push_back({{"mode", growth.mode}, {"rate", growth.rate}});
  const auto q = plant.get_for_file(found.point.q);
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
    for (int b = 0; b < loaded.system.num_bodies(); ++b) {
      std::vector<std::string> values;
      for (int i = 0; i < loaded.system.num_hinge_q(b); ++i)
        values.push_back(fmt::format("{:.8g}", q[loaded.system.q_offset(b) + i]));
      if (!values.empty()) table.rows.push_back({loaded.system.hinge_name(b), join(values)});
    }
    if (!table.rows.empty()) text += table.to_text();
    if (!found.spinning.empty()) text += "at a given rate: " + join(found.spinning) + "\n";
    if (!found.neutral.empty()) text += "indifferent, left where they were: " + join(found.neutral) + "\n";
    if (!found.kept.empty()) text += "as they start, nothing changes them: " + join(found.kept) + "\n";
    console.print(text);
  }
  if (!o.output.empty()) {
    write_whole(o.output, [&](const std::string& part) { write_equilibrium(loaded, plant, found, sources, part); });
    if (!o.json) console.print("written: " + o.output + "\n");
  }
  return kSuccess;
}

}  // namespace

void add_equilibrium(CLI::App& app, Action& action) {
  auto o = std::make_shared<EquilibriumOptions>();
  auto* verb = add_verb(app, "equilibrium", "A state of rest, or of steady spin, of a multibody system");
  verb->add_option("file", o->file, "System file (.toml); hinge rates given there are kept")->required();
  add_set_option(*verb, o->set);
  add_common_options(*verb, *o, kOutput | kJson, "Write the state to this HDF5 file, for --start-from");
  verb->footer(
      "Example:\n  bough equilibrium arm.toml -o rest.h5\n"
      "  bough linearize arm.toml --start-from rest.h5 -o arm-linear.h5\n"
      "Hinge rates of the system file are kept: other than zero they give a steady spin.");
  verb->callback(
      [&action, o] { action = [o] { return analysis::with_file(o->file, [&] { return run_equilibrium(*o); }); }; });
}

}  // namespace bough::cli
