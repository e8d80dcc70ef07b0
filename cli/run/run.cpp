#include "analysis/run/run.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <optional>

#include "analysis/common/output_folder.hpp"
#include "cli/common/console.hpp"
#include "cli/common/event_list.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/options.hpp"

namespace bough::cli {

namespace {

using RunOptions = RequestOptions<analysis::RunRequest>;

/// Set by SIGINT, SIGTERM and SIGHUP; a handler can reach nothing but static storage.
std::atomic<bool>& get_stop_flag() {
  static std::atomic<bool> stop{false};
  return stop;
}
void on_signal(int) { get_stop_flag().store(true); }

/// Prints messages during the run, and a line of progress.
class ConsoleRun final : public analysis::RunEvents {
 public:
  ConsoleRun(const RunOptions& options, Console& console) : options_(options), console_(console) {}

  void add_message(const Diagnostic& message) override {
    console_.end_progress();
    console_.print_unless_quiet(message);
  }
  void show_progress(const std::string& stage) override { console_.show_stage(stage); }
  void check_output(const std::string& path, bool resumes) override {
    resumes ? analysis::check_place(path) : cli::check_output(options_, path);
  }
  void start() override {
    begin_ = shown_ = Clock::now();
    get_stop_flag().store(false);  // a worker of a campaign comes here once a case
    signals_.emplace(on_signal);
  }
  void show(const solver::Progress& p) override {
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

 private:
  using Clock = std::chrono::steady_clock;
  const RunOptions& options_;
  Console& console_;
  std::optional<SignalScope> signals_;
  Clock::time_point begin_, shown_;
};

nlohmann::json make_events_json(const std::vector<records::EventRecord>& events) {
  auto list = nlohmann::json::array();
  for (const auto& e : events) list.push_back({{"time", e.time}, {"what", e.what}, {"source", e.source}});
  return list;
}

int report(const RunOptions& o, const Console& console, const analysis::RunAnswer& answer) {
  const auto& outcome = answer.outcome;
  const auto& last = outcome.last;
  const auto& resumed = answer.resumed;
  if (o.json) {
    console.print_data(nlohmann::json{{"resumed_from", resumed ? nlohmann::json(*resumed) : nlohmann::json()},
                                      {"output", answer.output},
                                      {"completed", outcome.completed},
                                      {"time", outcome.time},
                                      {"reason", outcome.reason},
                                      {"steps", last.num_steps},
                                      {"rejected", last.num_rejected},
                                      {"evaluations", last.num_evaluations},
                                      {"energy_error", outcome.energy_error},
                                      {"events", make_events_json(answer.events)},
                                      {"seconds", answer.seconds}}
                           .dump(2) +
                       "\n");
  } else {
    console.print(format_events(answer.events));
    console.print(fmt::format(
        "{}{} at t = {:g} after {} steps ({} rejected, {} evaluations), worst energy error {:.1e}, {:.2f} s\nwritten: "
        "{}\n",
        resumed ? fmt::format("resumed at t = {:g}, ", *resumed) : "",
        !outcome.completed       ? "stopped"
        : outcome.reason.empty() ? "completed"
                                 : outcome.reason.substr(0, outcome.reason.rfind(" at t =")),
        outcome.time, last.num_steps, last.num_rejected, last.num_evaluations, outcome.energy_error, answer.seconds,
        answer.output));
  }
  if (!outcome.energy_is_kept) return kComputationFailed;
  if (outcome.completed) return kSuccess;
  console.print_error("cli.interrupted", outcome.reason,
                      fmt::format("continue it with bough run {} -o {} --resume", o.request.file, answer.output));
  return kComputationFailed;
}

int run_run(const RunOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;  // one process integrates; the others have nothing to do
  auto request = o.request;
  request.output = o.output;
  request.stop = &get_stop_flag();
  ConsoleRun events(o, console);
  const auto answer = analysis::run_system(request, events);
  if (answer.was_complete) {
    const auto& reason = answer.outcome.reason;
    console.print(fmt::format("{} is complete already{}\n", answer.output, reason.empty() ? "" : ": " + reason));
    return kSuccess;
  }
  for (const auto& item : answer.errors) console.print(item);
  return report(o, console, answer);
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_run, "run");
  verb->add_option("file", o->request.file, "System file (.toml)")->required();
  verb->add_flag("--resume", o->request.resume, "Continue the results file from its last checkpoint");
  verb->add_option("--start-from", o->request.start_from,
                   "Start from the last state of this results file, of run or equilibrium")
      ->excludes("--resume");
  add_set_option(*verb, o->request.set);
  add_common_options(*verb, *o, kOutput | kJson, "Results HDF5 file (default: the system file's name with .h5, here)");
}

}  // namespace bough::cli
