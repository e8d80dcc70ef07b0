#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "analysis/common/inputs.hpp"
#include "analysis/common/start_state.hpp"
#include "analysis/common/system_files.hpp"
#include "base/file_roles.hpp"
#include "base/part_file.hpp"
#include "cli/common/console.hpp"
#include "cli/common/event_list.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/options.hpp"
#include "cli/run/provenance_sink.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/toml/specs.hpp"
#include "solver/control/user_code.hpp"
#include "solver/simulate/simulate.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

struct RunOptions : CommonOptions {
  std::string file, start_from;
  std::vector<std::string> set;
  bool resume = false;
};

/// Set by SIGINT, SIGTERM and SIGHUP; a handler can reach nothing but static storage.
std::atomic<bool>& get_stop_flag() {
  static std::atomic<bool> stop{false};
  return stop;
}
void on_signal(int) { get_stop_flag().store(true); }

std::string choose_output(const RunOptions& o) {
  return o.output.empty() ? fs::path(o.file).stem().string() + ".h5" : o.output;
}

void demand_other_file(const std::string& output, const analysis::LoadedSystem& loaded,
                       const std::string& system_file) {
  for (const auto& input : analysis::collect_sources(system_file, loaded)) {
    std::error_code ignored;
    if (fs::equivalent(output, input, ignored)) {
      throw InputError("cli.output-is-input", {output}, "the results would overwrite the input file " + input,
                       "choose another file with -o");
    }
  }
}

/// Prints warnings during the run, not at its end.
class MessageFeed {
 public:
  MessageFeed(Console& console, const Diagnostics& diagnostics) : console_(console), diagnostics_(diagnostics) {}
  /// Errors are left to the failure that carries them.
  void print_new() {
    for (; printed_ < diagnostics_.items().size(); ++printed_) {
      if (diagnostics_.items()[printed_].severity == Severity::Error) continue;
      console_.end_progress();
      console_.print_unless_quiet(diagnostics_.items()[printed_]);
    }
  }

 private:
  Console& console_;
  const Diagnostics& diagnostics_;
  std::size_t printed_ = 0;
};

/// Throws InputError unless the results were begun with this system file and these bodies and tables, but for what may
/// change. Returns whether the file is marked as completed, and nothing, with a message, when an event has ended the
/// run.
std::optional<bool> check_resume(const Console& console, const std::string& output, const std::string& file,
                                 const records::SystemSpec& spec,
                                 const std::vector<std::pair<std::string, std::string>>& sources) {
  const auto inputs = hdf5::read_run_inputs(output);
  Diagnostics diagnostics;
  toml_files::check_same_system(inputs.system_text, spec.text, file, diagnostics);
  for (const auto& [name, hash] : sources) {
    if (name == sources.front().first) continue;  // compared above, key by key
    const auto has_name = [&name = name](const auto& s) { return s.first == name; };
    const auto is_same = [&name = name, &hash = hash](const auto& s) { return s.first == name && s.second == hash; };
    const auto& begun = inputs.source;
    if (std::any_of(begun.begin(), begun.end(), has_name) && std::none_of(begun.begin(), begun.end(), is_same))
      diagnostics.error("cli.changed-input", {name}, "the file is not the one that the run was started with",
                        "put that one back, or start the run again");
  }
  diagnostics.throw_if_errors();
  if (!inputs.completed || inputs.reason.empty()) return inputs.completed;
  console.print(fmt::format("{} is complete already: {}\n", output, inputs.reason));
  return std::nullopt;
}

class ProgressLine {
 public:
  explicit ProgressLine(Console& console) : console_(console), begin_(Clock::now()), shown_(begin_) {}
  void show(const solver::Progress& p) {
    const auto now = Clock::now();
    if (!console_.shows_progress() || now - shown_ < std::chrono::milliseconds(100)) return;
    shown_ = now;
    const double done = p.end > p.start ? (p.time - p.start) / (p.end - p.start) : 1.0;
    const double spent = std::chrono::duration<double>(now - begin_).count();
    console_.show_progress(fmt::format(
        "run: {:5.1f} %  t {:.4g}  step {:.2e}  order {}  steps {}  rejected {}  energy error {:.1e}  {:.0f} s left",
        100 * done, p.time, p.step, p.order, p.num_steps, p.num_rejected, p.energy_error,
        done > 0 ? spent * (1 - done) / done : 0.0));
  }
  double get_seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Console& console_;
  Clock::time_point begin_, shown_;
};

nlohmann::json make_events_json(const std::vector<records::EventRecord>& events) {
  auto list = nlohmann::json::array();
  for (const auto& e : events) list.push_back({{"time", e.time}, {"what", e.what}, {"source", e.source}});
  return list;
}

/// `resumed`: the time at which it went on; none: from the start. `events`: of this part of the run.
int report(const RunOptions& o, const Console& console, const solver::SimulateOutcome& outcome,
           const std::string& output, double seconds, const std::optional<double>& resumed,
           const std::vector<records::EventRecord>& events) {
  const auto& last = outcome.last;
  if (o.json) {
    console.print_data(nlohmann::json{{"resumed_from", resumed ? nlohmann::json(*resumed) : nlohmann::json()},
                                      {"output", output},
                                      {"completed", outcome.completed},
                                      {"time", outcome.time},
                                      {"reason", outcome.reason},
                                      {"steps", last.num_steps},
                                      {"rejected", last.num_rejected},
                                      {"evaluations", last.num_evaluations},
                                      {"energy_error", outcome.energy_error},
                                      {"events", make_events_json(events)},
                                      {"seconds", seconds}}
                           .dump(2) +
                       "\n");
  } else {
    console.print(format_events(events));
    console.print(fmt::format(
        "{}{} at t = {:g} after {} steps ({} rejected, {} evaluations), worst energy error {:.1e}, {:.2f} s\nwritten: "
        "{}\n",
        resumed ? fmt::format("resumed at t = {:g}, ", *resumed) : "",
        !outcome.completed       ? "stopped"
        : outcome.reason.empty() ? "completed"
                                 : outcome.reason.substr(0, outcome.reason.rfind(" at t =")),
        outcome.time, last.num_steps, last.num_rejected, last.num_evaluations, outcome.energy_error, seconds, output));
  }
  if (!outcome.energy_is_kept) return kComputationFailed;
  if (outcome.completed) return kSuccess;
  console.print_error("cli.interrupted", outcome.reason,
                      fmt::format("continue it with bough run {} -o {} --resume", o.file, output));
  return kComputationFailed;
}

int run_run(const RunOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;  // one process integrates; the others have nothing to do
  analysis::demand_file(o.file);
  if (analysis::has_suffix(o.file, ".toml")) analysis::demand_kind(o.file, toml_files::detect_kind(o.file), "system");
  Diagnostics diagnostics;
  const auto loaded = analysis::load_system(o.file, diagnostics, o.start_from, o.set);
  const auto output = choose_output(o);
  demand_other_file(output, loaded, o.file);

  const auto sources = analysis::calc_sources(analysis::collect_sources(o.file, loaded));
  solver::SimulateOptions options;
  std::unique_ptr<records::ResultSink> writer;
  if (o.resume) {
    analysis::demand_file(output);
    check_place(output);
    if (is_file_locked(output))  // before it is read: it changes all the time
      throw InputError("hdf5.busy", {output}, "another process writes this file",
                       "wait until it ends, or choose another");
    FileRoles::allow_both(output);
    const auto is_completed = check_resume(console, output, o.file, loaded.spec, sources);
    if (!is_completed) return kSuccess;
    options.resume = hdf5::find_checkpoint(output);
    const double end = loaded.spec.simulation.start + loaded.spec.simulation.duration;
    if (*is_completed && options.resume && options.resume->time >= end * (1 - 1e-12)) {
      console.print(fmt::format("{} is complete already\n", output));
      return kSuccess;
    }
  }
  if (options.resume) {
    solver::demand_resumable(loaded.system.signals);
    writer = hdf5::make_results_appender(output, options.resume->time);
  } else {  // also where a run was killed before its first checkpoint: there is nothing to keep
    check_output(o, output);
    options.resume =
        analysis::find_start_control(o.start_from, loaded.system, loaded.spec.simulation.start, diagnostics);
    if (options.resume) solver::demand_resumable(loaded.system.signals);
    writer = hdf5::make_results_writer(output);
  }
  ProvenanceSink sink(*writer, sources);
  MessageFeed messages(console, diagnostics);
  messages.print_new();
  ProgressLine progress(console);
  options.progress = [&](const solver::Progress& p) {
    messages.print_new();
    progress.show(p);
  };
  options.stop = &get_stop_flag();
  get_stop_flag().store(false);  // a worker of a campaign comes here once a case
  const SignalScope signals(on_signal);
  solver::SimulateOutcome outcome;
  try {
    outcome = solver::simulate(loaded.system, loaded.spec, sink, options, diagnostics);
    // A run whose library fails at its end is not completed: the file is marked as completed after that.
    if (solver::has_user_blocks(loaded.system.signals)) sink.flush();
    solver::close_user_blocks(loaded.system.signals);
    sink.finish();
  } catch (...) {
    sink.finish_failed();
    messages.print_new();
    console.end_progress();
    throw;
  }
  messages.print_new();
  console.end_progress();
  if (!outcome.energy_is_kept) {
    // The last item is the judgement, an error that the feed leaves to its failure.
    for (const auto& item : diagnostics.items()) {
      if (item.severity == Severity::Error) console.print(item);
    }
  }
  std::optional<double> resumed;
  if (options.resume) resumed = options.resume->time;
  return report(o, console, outcome, output, progress.get_seconds(), resumed, sink.events());
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto o = std::make_shared<RunOptions>();
  auto* verb = add_verb(app, "run", "Time history of a multibody system");
  verb->add_option("file", o->file, "System file (.toml)")->required();
  verb->add_flag("--resume", o->resume, "Continue the results file from its last checkpoint");
  verb->add_option("--start-from", o->start_from,
                   "Start from the last state of this results file, of run or equilibrium")
      ->excludes("--resume");
  add_set_option(*verb, o->set);
  add_common_options(*verb, *o, kOutput | kJson, "Results HDF5 file (default: the system file's name with .h5, here)");
  verb->footer(
      "Example:\n  bough run spinup.toml -o spinup.h5\n  bough run spinup.toml -o spinup.h5 --resume\n"
      "SIGINT (Ctrl-C), SIGTERM and SIGHUP write a checkpoint and end the file cleanly, exit code 3; a second Ctrl-C "
      "ends the program at once. --resume "
      "takes the system file of the run with another duration, other samples or limits; it refuses other changes. A "
      "worst relative energy error above energy_error_limit ends with exit code 3 too, the results are written.");
  verb->callback([&action, o] { action = [o] { return run_run(*o); }; });
}

}  // namespace bough::cli
