#include "analysis/run/run.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>

#include "analysis/common/inputs.hpp"
#include "analysis/common/start_state.hpp"
#include "analysis/common/system_files.hpp"
#include "analysis/run/provenance_sink.hpp"
#include "base/file_roles.hpp"
#include "base/part_file.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/toml/specs.hpp"
#include "solver/control/user_code.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

namespace {

using Sources = std::vector<std::pair<std::string, std::string>>;

void demand_other_file(const std::string& output, const LoadedSystem& loaded, const std::string& system_file) {
  for (const auto& input : collect_sources(system_file, loaded)) {
    std::error_code ignored;
    if (fs::equivalent(output, input, ignored)) {
      throw InputError("cli.output-is-input", {output}, "the results would overwrite the input file " + input,
                       "choose another file with -o");
    }
  }
}

/// Passes on messages during the run, not at its end.
class MessageFeed {
 public:
  MessageFeed(Events& events, const Diagnostics& diagnostics) : events_(events), diagnostics_(diagnostics) {}
  /// Passes new warnings; errors are reported with the failure that contains them.
  void pass_new() {
    for (; passed_ < diagnostics_.items().size(); ++passed_)
      if (diagnostics_.items()[passed_].severity != Severity::Error) events_.add_message(diagnostics_.items()[passed_]);
  }

 private:
  Events& events_;
  const Diagnostics& diagnostics_;
  std::size_t passed_ = 0;
};

/// Throws InputError unless the results were begun with this system file and these bodies and tables, but for what may
/// change.
hdf5::RunInputs check_resume(const std::string& output, const std::string& file, const records::SystemSpec& spec,
                             const Sources& sources) {
  auto inputs = hdf5::read_run_inputs(output);
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
  return inputs;
}

/// Sets the checkpoint to resume from, if the results have one; sets `was_complete` if nothing is left to do.
void find_resumed_state(const LoadedSystem& loaded, const RunRequest& request, const Sources& sources,
                        RunEvents& events, solver::SimulateOptions& options, RunAnswer& answer) {
  demand_file(answer.output);
  events.check_output(answer.output, true);
  if (is_file_locked(answer.output))  // before it is read: it changes all the time
    throw InputError("hdf5.busy", {answer.output}, "another process writes this file",
                     "wait until it ends, or choose another");
  FileRoles::allow_both(answer.output);
  const auto inputs = check_resume(answer.output, request.file, loaded.spec, sources);
  answer.was_complete = inputs.completed && !inputs.reason.empty();
  if (answer.was_complete) {
    answer.outcome.reason = inputs.reason;
    return;
  }
  options.resume = hdf5::find_checkpoint(answer.output);
  const double end = loaded.spec.simulation.start + loaded.spec.simulation.duration;
  answer.was_complete = inputs.completed && options.resume && options.resume->time >= end * (1 - 1e-12);
}

/// Integrates into the sink; passes messages and progress on while it does.
void integrate(const LoadedSystem& loaded, ProvenanceSink& sink, solver::SimulateOptions& options,
               Diagnostics& diagnostics, RunEvents& events, RunAnswer& answer) {
  MessageFeed messages(events, diagnostics);
  messages.pass_new();
  const auto begin = std::chrono::steady_clock::now();
  options.progress = [&](const solver::Progress& progress) {
    messages.pass_new();
    events.show(progress);
  };
  events.start();
  try {
    answer.outcome = solver::simulate(loaded.system, loaded.spec, sink, options, diagnostics);
    // A run whose library fails at its end is not completed: the file is marked as completed after that.
    if (solver::has_user_blocks(loaded.system.signals)) sink.flush();
    solver::close_user_blocks(loaded.system.signals);
    sink.finish();
  } catch (...) {
    sink.finish_failed();
    messages.pass_new();
    events.show_progress("");
    throw;
  }
  messages.pass_new();
  events.show_progress("");
  answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

std::string choose_run_output(const std::string& file) { return fs::path(file).stem().string() + ".h5"; }

RunAnswer run_system(const RunRequest& request, RunEvents& events) {
  demand_file(request.file);
  if (has_suffix(request.file, ".toml")) demand_kind(request.file, toml_files::detect_kind(request.file), "system");
  Diagnostics diagnostics;
  const auto loaded = load_system(request.file, diagnostics, request.start_from, request.set);
  RunAnswer answer;
  answer.output = request.output.empty() ? choose_run_output(request.file) : request.output;
  demand_other_file(answer.output, loaded, request.file);

  const auto sources = calc_sources(collect_sources(request.file, loaded));
  solver::SimulateOptions options;
  options.stop = request.stop;
  std::unique_ptr<records::ResultSink> writer;
  if (request.resume) {
    find_resumed_state(loaded, request, sources, events, options, answer);
    if (answer.was_complete) return answer;
  }
  if (options.resume) {
    answer.resumed = options.resume->time;
    solver::demand_resumable(loaded.system.signals);
    writer = hdf5::make_results_appender(answer.output, options.resume->time);
  } else {  // also where a run was killed before its first checkpoint: there is nothing to keep
    events.check_output(answer.output, false);
    options.resume = find_start_control(request.start_from, loaded.system, loaded.spec.simulation.start, diagnostics);
    if (options.resume) solver::demand_resumable(loaded.system.signals);
    writer = hdf5::make_results_writer(answer.output);
  }
  ProvenanceSink sink(*writer, sources);
  integrate(loaded, sink, options, diagnostics, events, answer);
  if (!answer.outcome.energy_is_kept)
    std::copy_if(diagnostics.items().begin(), diagnostics.items().end(), std::back_inserter(answer.errors),
                 [](const Diagnostic& item) { return item.severity == Severity::Error; });
  answer.events = sink.events();
  return answer;
}

}  // namespace bough::analysis
