#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <thread>

#include "analysis/common/ranks.hpp"
#include "analysis/common/text_file.hpp"
#include "base/version.hpp"
#include "cli/batch/batch_outcome.hpp"
#include "cli/batch/worker.hpp"
#include "cli/batch/worker_pool.hpp"
#include "cli/common/console.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/options.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/verbs.hpp"
#include "fe/linear/petsc.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::cli {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

struct BatchOptions : CommonOptions {
  std::string campaign, shard;
  std::vector<std::string> merged;
  bool merges = false;
  int jobs = 0;
  double time_limit = 0;
  bool dry_run = false, retry = false, restart = false, force_outside = false;
  int worker_fd = -1;
};

/// Share of the cases of this call: those with (number - 1) % count == index.
struct Shard {
  int index = 0, count = 1;
  bool holds(int number) const { return (number - 1) % count == index; }
};

/// Set by SIGINT, SIGTERM and SIGHUP; a handler can reach nothing but static storage.
volatile int& get_stop() {
  static volatile int stop = 0;
  return stop;
}
void on_signal(int) { get_stop() = 1; }

/// This process among those that mpirun or srun started for one call.
struct Rank {
  int index = 0, count = 1;
  bool takes(std::size_t position) const {
    return position % static_cast<std::size_t>(count) == static_cast<std::size_t>(index);
  }
};

Shard parse_shard(const std::string& text) {
  Shard shard;
  if (text.empty()) return shard;
  char slash = 0, rest = 0;
  const int found = std::sscanf(text.c_str(), "%d%c%d%c", &shard.index, &slash, &shard.count, &rest);
  if (found != 3 || slash != '/' || shard.index < 1 || shard.index > shard.count)
    throw InputError("batch.bad-shard", {}, "--shard is \"" + text + "\", expected i/n with i from 1 to n",
                     "write --shard 1/4 to --shard 4/4");
  --shard.index;
  return shard;
}

/// The folder belongs to one campaign with certain inputs; campaign.json says which. Nothing else in it is touched.
class Folder {
 public:
  /// Locked for as long as it lives: a second call for the same cases is kept away, and with `restart` any other call.
  Folder(const fs::path& path, const BatchPlan& plan, const Shard& shard, bool restart) : path_(path), plan_(plan) {
    std::error_code failed;
    fs::create_directories(path, failed);
    if (failed)
      throw ComputationError("cli.write", {path.string()}, "the folder could not be made: " + failed.message(),
                             "choose another with -o");
    const json now = describe(plan);
    const auto state = (path / "campaign.json").string();
    std::ifstream in(state);
    const auto before = in ? json::parse(in, nullptr, false) : json();
    const bool is_own = before.is_object() && before.value("format", "") == "bough-campaign";
    check_foreign(in ? is_own : !fs::exists(state), is_own);
    if (is_own && before != now && !restart) throw describe_change(before, now);
    const auto own = fmt::format(".lock-{}-of-{}", shard.index + 1, shard.count);
    lock(own);
    if (restart) remove_cases(own);
    analysis::write_text_file(state, now.dump(2) + "\n");
    fingerprint_ = hdf5::calc_sha256(state);
  }
  ~Folder() {
    for (const int lock : locks_) close(lock);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::string& get_fingerprint() const { return fingerprint_; }

  /// Contents of campaign.json.
  static json describe(const BatchPlan& plan) {
    json now{{"format", "bough-campaign"}, {"name", plan.get_spec().name}, {"bough", get_version()}};
    now["cases"] = plan.num_cases();
    for (const auto& [file, hash] : plan.get_inputs())
      now["inputs"].push_back({fs::path(file).filename().string(), hash});
    return now;
  }

 private:
  fs::path get_case(int number) const { return path_ / plan_.get_folder(number); }

  InputError describe_change(const json& before, const json& now) const {
    std::string what;
    if (before.is_object() && before.contains("inputs") && before.value("bough", "") == now["bough"]) {
      std::set<json> known(before["inputs"].begin(), before["inputs"].end());
      for (const auto& input : now["inputs"])
        if (known.count(input) == 0) what += (what.empty() ? "" : ", ") + input[0].get<std::string>();
    }
    return {"batch.changed-campaign",
            {path_.string()},
            "the folder holds cases of another campaign" + (what.empty() ? "" : " (changed: " + what + ")"),
            "choose another folder with -o, or --restart to do every case again"};
  }

  /// Reports files of another origin where the campaign would write or clear.
  void check_foreign(bool may_write_state, bool is_own) const {
    Diagnostics found;
    const auto report = [&](const fs::path& path) {
      found.error("batch.foreign-folder", {path.string()}, "is there already, and not the work of a campaign",
                  "choose another folder with -o, or move it away");
    };
    if (!may_write_state) report(path_ / "campaign.json");
    for (const char* table : {"outcomes.csv", "outcomes.h5", "statistics.csv"})
      if (!is_own && fs::exists(path_ / table)) report(path_ / table);
    for (const auto& one : plan_.get_cases())
      if (!is_case_folder(get_case(one.number))) report(get_case(one.number));
    found.throw_if_errors();
  }

  void lock(const std::string& name) {
    const int descriptor = open((path_ / name).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) return;
    locks_.push_back(descriptor);
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      throw InputError("batch.busy", {path_.string()}, "another bough batch works on these cases",
                       "wait until it ends");
  }

  void remove_cases(const std::string& own_lock) {
    std::vector<fs::path> cases;
    for (const auto& entry : fs::directory_iterator(path_)) {
      const auto name = entry.path().filename().string();
      if (name.starts_with(".lock-") && name != own_lock) lock(name);
      const bool is_case = name.starts_with("case-") && name.find_first_not_of("0123456789", 5) == std::string::npos;
      if (is_case && is_case_folder(entry.path()) && !fs::is_empty(entry.path())) cases.push_back(entry.path());
    }
    for (const auto& folder : cases) {
      clear_case_folder(folder);
      fs::remove_all(folder);
    }
  }

  fs::path path_;
  const BatchPlan& plan_;
  std::string fingerprint_;
  std::vector<int> locks_;
};

/// While it lives, no other call reads the outcomes for a table or writes it: of two shards that end together the
/// second sees the cases of both.
class TableLock {
 public:
  explicit TableLock(const fs::path& folder)
      : descriptor_(open((folder / ".table-lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
    while (descriptor_ >= 0 && flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) continue;
  }
  ~TableLock() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  TableLock(const TableLock&) = delete;
  TableLock& operator=(const TableLock&) = delete;

 private:
  int descriptor_;
};

/// Lines after the head of a table; line ends within quotes do not count.
std::size_t count_rows(const fs::path& table) {
  std::ifstream in(table);
  std::size_t lines = 0;
  bool is_quoted = false;
  for (std::istreambuf_iterator<char> at(in), end; at != end; ++at) {
    if (*at == '"') is_quoted = !is_quoted;
    if (*at == '\n' && !is_quoted) ++lines;
  }
  return lines > 0 ? lines - 1 : 0;
}

/// n of the shards i/n that have written to these folders; 0 when none has, or of different n.
int find_shard_count(const std::vector<fs::path>& folders) {
  std::set<int> counts;
  std::error_code ignored;
  for (const auto& folder : folders)
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
      int index = 0, count = 0;
      char rest = 0;
      if (std::sscanf(entry.path().filename().c_str(), ".lock-%d-of-%d%c", &index, &count, &rest) == 2 && count > 1)
        counts.insert(count);
    }
  return counts.size() == 1 ? *counts.begin() : 0;
}

/// "1 to 3, 7, 9 to 12".
std::string format_numbers(const std::vector<int>& numbers) {
  constexpr std::size_t max_shown = 10;
  std::string text;
  std::size_t count = 0;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t end = i + 1;
    while (end < numbers.size() && numbers[end] == numbers[end - 1] + 1) ++end;
    if (count++ == max_shown) return text + ", ...";
    text += (text.empty() ? "" : ", ") + std::to_string(numbers[i]);
    if (end > i + 1) text += (end > i + 2 ? " to " : ", ") + std::to_string(numbers[end - 1]);
    i = end;
  }
  return text;
}

/// Empty when every case is there; else what lacks, by shards where whole ones do.
std::string describe_missing(const BatchPlan& plan, const std::vector<int>& missing,
                             const std::vector<fs::path>& folders) {
  std::map<int, int> of_shard;
  const int count = find_shard_count(folders);
  std::string shards;
  if (count > 0)
    for (const int number : missing) ++of_shard[(number - 1) % count];
  for (const auto& [index, lacking] : of_shard) {
    const int whole = (plan.num_cases() - 1 - index) / count + 1;
    shards += fmt::format("{}shard {}/{} ({})", shards.empty() ? "" : ", ", index + 1, count,
                          lacking == whole ? "all of it" : fmt::format("{} of {}", lacking, whole));
  }
  return fmt::format("{} of {} cases are not done: {}{}", missing.size(), plan.num_cases(), format_numbers(missing),
                     shards.empty() ? "" : "; " + shards);
}

std::string join_words(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

void list_cases(const BatchPlan& plan, const Shard& shard, bool as_json, const Console& console) {
  const auto& spec = plan.get_spec();
  json all = json::array();
  Table table{{"case"}, {}};
  for (const auto& p : spec.parameters) table.headings.push_back(p.name);
  int count = 0;
  for (const auto& one : plan.get_cases()) {
    if (!shard.holds(one.number)) continue;
    ++count;
    std::vector<std::string> row{std::to_string(one.number)};
    json entry{{"case", one.number}};
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      const auto& value = one.values[i];
      row.push_back(value.text);
      if (value.kind == toml_files::Setting::Kind::Word)
        entry["parameters"][spec.parameters[i].name] = value.text;
      else
        entry["parameters"][spec.parameters[i].name] = value.number;
    }
    for (std::size_t i = 0; i < spec.steps.size(); ++i) entry["steps"].push_back(join_words(plan.make_words(one, i)));
    table.rows.push_back(std::move(row));
    all.push_back(std::move(entry));
  }
  if (as_json) return console.print_data(all.dump(2) + "\n");
  console.print_data(table.to_text());
  console.print(fmt::format("{} cases, each:\n", count));
  for (const auto& step : spec.steps) console.print("  bough " + join_words(step.words) + "\n");
}

/// Counts of the outcomes of the cases of this call.
struct Tally {
  int num_before = 0, num_done = 0;
  std::vector<BatchOutcome> failed;
  double seconds = 0;
  bool completed = true;
};

std::string format_failed(const BatchPlan& plan, const std::vector<BatchOutcome>& failed) {
  constexpr std::size_t max_shown = 20;
  std::string text;
  for (std::size_t i = 0; i < failed.size() && i < max_shown; ++i)
    text += fmt::format("  {}: {}\n", plan.get_folder(failed[i].number), failed[i].error);
  if (failed.size() > max_shown) text += fmt::format("  and {} more: see the table\n", failed.size() - max_shown);
  return text;
}

std::string format_statistics(const std::vector<Statistics>& statistics) {
  Table table{{"output", "cases", "mean", "deviation", "min", "5 %", "median", "95 %", "max"}, {}};
  for (const auto& s : statistics) {
    table.rows.push_back({s.name, std::to_string(s.count)});
    for (const double x : {s.mean, s.deviation, s.min, s.p5, s.median, s.p95, s.max})
      table.rows.back().push_back(fmt::format("{:.6g}", x));
  }
  return statistics.empty() ? "" : table.to_text();
}

json to_json(const std::vector<Statistics>& statistics) {
  json all = json::object();
  for (const auto& s : statistics)
    all[s.name] = {{"count", s.count}, {"mean", s.mean}, {"deviation", s.deviation},
                   {"min", s.min},     {"p5", s.p5},     {"median", s.median},
                   {"p95", s.p95},     {"max", s.max}};
  return all;
}

/// Counts the outcomes of all ranks together.
void count_again(const BatchPlan& plan, const std::vector<int>& selected, const fs::path& folder, Tally& tally) {
  tally.failed.clear();
  int num_over = 0;
  for (const int number : selected) {
    auto outcome = read_outcome(folder / plan.get_folder(number));
    if (!outcome) continue;
    ++num_over;
    if (!outcome->error.empty()) tally.failed.push_back(std::move(*outcome));
  }
  tally.num_done = num_over - tally.num_before;
}

int report(const BatchOptions& o, const BatchPlan& plan, const Tally& tally, int num_selected, int num_in_table,
           const std::vector<Statistics>& statistics, const fs::path& folder, const Console& console) {
  const auto table = (folder / "outcomes.csv").string();
  if (o.json) {
    json failed = json::array();
    for (const auto& f : tally.failed)
      failed.push_back({{"case", f.number}, {"exit_code", f.exit_code}, {"error", f.error}});
    console.print_data(json{{"name", plan.get_spec().name},
                            {"folder", folder.string()},
                            {"cases", num_selected},
                            {"done_before", tally.num_before},
                            {"done", tally.num_done},
                            {"failed", failed},
                            {"completed", tally.completed},
                            {"seconds", tally.seconds},
                            {"statistics", to_json(statistics)},
                            {"table", table}}
                           .dump(2) +
                       "\n");
  } else {
    constexpr std::size_t max_shown = 40;
    if (num_in_table > 1 && statistics.size() <= max_shown) console.print(format_statistics(statistics));
    console.print(fmt::format("{}: {} of {} cases done{}, {} failed, {:.2f} s\nwritten: {} and .h5, {} cases\n",
                              plan.get_spec().name, tally.num_before + tally.num_done, num_selected,
                              tally.num_before > 0 ? fmt::format(" ({} before)", tally.num_before) : "",
                              tally.failed.size(), tally.seconds, table, num_in_table));
  }
  if (!tally.failed.empty()) {
    console.print_error("batch.failed-cases", fmt::format("{} of {} cases failed", tally.failed.size(), num_selected),
                        "their folders hold what they printed; --retry does them again");
    if (!o.json) console.print_data("failed:\n" + format_failed(plan, tally.failed));
  }
  if (!tally.completed)
    console.print_error("cli.interrupted",
                        fmt::format("stopped after {} of {} cases", tally.num_before + tally.num_done, num_selected),
                        "the same command goes on with the others");
  return tally.failed.empty() && tally.completed ? kSuccess : kComputationFailed;
}

/// One table of what several folders hold, or of the campaign's own: after shards that had a folder each.
int run_merge(const BatchOptions& o, const BatchPlan& plan, const fs::path& folder, const Console& console) {
  std::vector<fs::path> parts;
  for (const auto& part : o.merged) parts.push_back(fs::absolute(part).lexically_normal());
  if (parts.empty()) parts.push_back(folder);
  Diagnostics found;
  const json expected = Folder::describe(plan);
  for (const auto& part : parts) {
    std::ifstream in(part / "campaign.json");
    const auto before = in ? json::parse(in, nullptr, false) : json();
    if (before == expected) continue;
    if (before.is_object() && before.value("format", "") == "bough-campaign")
      found.error("batch.changed-campaign", {part.string()}, "the folder holds cases of another campaign",
                  "merge what was made from these inputs, by this version");
    else
      found.error("batch.missing-shard", {part.string()}, "holds no cases of a campaign",
                  "run its shard first, or correct the name");
  }
  found.throw_if_errors();
  const Folder state(folder, plan, {}, false);
  const TableLock lock(folder);
  std::vector<BatchOutcome> outcomes;
  std::vector<int> missing;
  Tally tally;
  for (const auto& one : plan.get_cases()) {
    std::optional<BatchOutcome> outcome;
    for (std::size_t i = 0; i < parts.size() && !outcome; ++i)
      outcome = read_outcome(parts[i] / plan.get_folder(one.number));
    if (!outcome) {
      missing.push_back(one.number);
      continue;
    }
    ++tally.num_before;
    if (!outcome->error.empty()) tally.failed.push_back(*outcome);
    outcomes.push_back(std::move(*outcome));
  }
  const auto statistics = write_tables(plan, outcomes, state.get_fingerprint(), folder);
  const int code =
      report(o, plan, tally, plan.num_cases(), static_cast<int>(outcomes.size()), statistics, folder, console);
  if (missing.empty()) return code;
  console.print_error("batch.missing-shard", describe_missing(plan, missing, parts),
                      "the table has the others; run what is missing, then merge again");
  return kComputationFailed;
}

int run_batch(const BatchOptions& o) {
  Console console(o.quiet, o.verbosity);
  Rank rank;
  if (analysis::is_one_of_many() && o.worker_fd < 0 && !o.dry_run && !o.merges) {
    const auto& petsc = linear::initialize_petsc();
    rank = {petsc.rank, petsc.size};
    console.set_rank(petsc.rank);
  } else if (!console.is_root()) {
    return kSuccess;  // one says it for all
  }
  const auto shard = parse_shard(o.shard);
  const BatchPlan plan(o.campaign, list_verbs(), o.force_outside);
  const auto folder = fs::absolute(o.output.empty() ? plan.get_spec().name : o.output).lexically_normal();
  if (o.worker_fd >= 0) return serve_cases(plan, folder, o.worker_fd, o.force_outside);
  if (o.dry_run) {
    list_cases(plan, shard, o.json, console);
    return kSuccess;
  }
  if (o.merges) return run_merge(o, plan, folder, console);
  std::optional<Folder> state;  // of the first rank
  analysis::do_once([&] { state.emplace(folder, plan, shard, o.restart); });

  Tally tally;
  std::vector<int> selected, open;
  const auto get_case = [&](int number) { return folder / plan.get_folder(number); };
  for (const auto& one : plan.get_cases())
    if (shard.holds(one.number)) selected.push_back(one.number);
  for (std::size_t i = 0; i < selected.size(); ++i) {
    const auto outcome = read_outcome(get_case(selected[i]));
    if (!outcome || (o.retry && !outcome->error.empty())) {
      if (rank.takes(i)) open.push_back(selected[i]);
      continue;
    }
    ++tally.num_before;
    if (!outcome->error.empty()) tally.failed.push_back(*outcome);
  }
  analysis::wait_for_all(true);  // the count before is right only while no rank works

  PoolOptions pool;
  pool.command = {"bough", "batch", o.campaign, "-o", folder.string()};
  if (o.force_outside) pool.command.emplace_back("--force-outside");
  pool.command.emplace_back("--worker");
  const int all_cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  pool.num_workers = o.jobs > 0 ? o.jobs : rank.count > 1 ? 1 : all_cores;
  pool.time_limit = o.time_limit > 0 ? o.time_limit : plan.get_spec().time_limit;
  pool.stop = &get_stop();
  pool.find_error = [&](int number) { return find_printed_error(plan, get_case(number)); };
  const SignalScope signals(on_signal);
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  auto shown = begin - std::chrono::seconds(1);
  const auto count_seconds = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  tally.completed = run_pool(pool, open, [&](const BatchOutcome& outcome) {
    write_outcome(outcome, get_case(outcome.number));
    ++tally.num_done;
    if (!outcome.error.empty()) tally.failed.push_back(outcome);
    if (Clock::now() - shown < std::chrono::milliseconds(100)) return;
    shown = Clock::now();
    const double each = count_seconds() / tally.num_done;
    console.show_progress(
        fmt::format("batch: {}/{} done, {} failed, {:.3g} s a case, {:.0f} s left", tally.num_before + tally.num_done,
                    selected.size(), tally.failed.size(), each,
                    each * static_cast<double>(open.size() - static_cast<std::size_t>(tally.num_done))));
  });
  tally.completed = analysis::wait_for_all(tally.completed);
  tally.seconds = count_seconds();
  console.end_progress();
  if (rank.count > 1) count_again(plan, selected, folder, tally);
  std::sort(tally.failed.begin(), tally.failed.end(), [](const auto& a, const auto& b) { return a.number < b.number; });

  int code = tally.failed.empty() && tally.completed ? kSuccess : kComputationFailed;
  analysis::do_once([&] {
    const TableLock lock(folder);
    std::vector<BatchOutcome> outcomes;  // of all shards, as far as they are
    for (const auto& one : plan.get_cases())
      if (auto outcome = read_outcome(get_case(one.number))) outcomes.push_back(std::move(*outcome));
    if (const auto before = count_rows(folder / "outcomes.csv"); before > outcomes.size())
      console.print(Diagnostic{Severity::Warning,
                               "batch.smaller-table",
                               {(folder / "outcomes.csv").string()},
                               fmt::format("it had {} cases and has {} now: the others were merged from other folders",
                                           before, outcomes.size()),
                               "merge them again when all shards are done"});
    const auto statistics = write_tables(plan, outcomes, state->get_fingerprint(), folder);
    code = report(o, plan, tally, static_cast<int>(selected.size()), static_cast<int>(outcomes.size()), statistics,
                  folder, console);
  });
  return code;
}

}  // namespace

void add_batch(CLI::App& app, Action& action) {
  auto o = std::make_shared<BatchOptions>();
  auto* verb = add_verb(app, "batch", "One job over a grid, a list or a sample of parameters; resumable");
  verb->add_option("campaign", o->campaign, "Campaign file (.toml)")->required();
  verb->add_option("-j,--jobs", o->jobs, "Worker processes (default: one a core)")->check(make_positive());
  verb->add_option("-o,--output", o->output, "Folder of the cases and the table (default: the campaign's name, here)");
  verb->add_option("--shard", o->shard, "i/n: only every n-th case from the i-th on, for job arrays");
  auto* merge = verb->add_option("--merge", o->merged,
                                 "Do no case: make one table of these folders of shards, or of the campaign's own")
                    ->expected(0, -1)
                    ->type_name("FOLDER ...");
  verb->add_option("--time-limit", o->time_limit, "Seconds a case may take (default: the campaign's)")
      ->check(make_positive());
  verb->add_flag("--retry", o->retry, "Do failed cases again");
  verb->add_flag("--restart", o->restart, "Do every case again, also after the campaign has changed");
  verb->add_flag("--force-outside", o->force_outside, "Let the steps write outside the folder of their case");
  verb->add_flag("--dry-run", o->dry_run, "Check the campaign and list its cases");
  verb->add_option("--worker", o->worker_fd, "Socket of a worker process")->group("");
  add_common_options(*verb, *o, kJson);
  verb->footer(
      "Example:\n  bough batch study.toml --dry-run\n  bough batch study.toml -j 8 -o study\n"
      "  bough batch study.toml --shard 3/10 -o /scratch/study\n"
      "  bough batch study.toml --merge part-1 part-2 part-3 -o study\n"
      "  mpirun -n 4 bough batch study.toml -o study\n"
      "Finished cases are skipped: the same command goes on after Ctrl-C or a kill. Exit code 3 when a case failed.");
  verb->callback([&action, o, merge] {
    o->merges = merge->count() > 0;
    std::erase(o->merged, "");  // what stands for no folder
    action = [o] { return run_batch(*o); };
  });
}

}  // namespace bough::cli
