#include "analysis/campaign/campaign.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <thread>

#include "analysis/campaign/batch_steps.hpp"
#include "analysis/campaign/worker.hpp"
#include "analysis/campaign/worker_pool.hpp"
#include "analysis/common/choices.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/text_file.hpp"
#include "base/version.hpp"
#include "fe/linear/petsc.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// This process among those that mpirun or srun started for one call.
struct Rank {
  int index = 0, count = 1;
  bool takes(std::size_t position) const {
    return position % static_cast<std::size_t>(count) == static_cast<std::size_t>(index);
  }
};

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
    write_text_file(state, now.dump(2) + "\n");
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
    for (const char* table : {"outcomes.csv", "outcomes.h5", "statistics.csv", "percentiles.csv"})
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

/// Lists the missing cases, or shards if all cases of a shard are missing; empty if none is missing.
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

/// Counts the outcomes of all ranks together.
void count_again(const BatchPlan& plan, const std::vector<int>& selected, const fs::path& folder,
                 CampaignAnswer& answer) {
  answer.failed.clear();
  int num_over = 0;
  for (const int number : selected) {
    auto outcome = read_outcome(folder / plan.get_folder(number));
    if (!outcome) continue;
    ++num_over;
    if (!outcome->error.empty()) answer.failed.push_back(std::move(*outcome));
  }
  answer.num_done = num_over - answer.num_before;
}

}  // namespace

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

fs::path find_campaign_folder(const CampaignRequest& request, const BatchPlan& plan) {
  return fs::absolute(request.output.empty() ? plan.get_spec().name : request.output).lexically_normal();
}

CampaignAnswer run_campaign(const CampaignRequest& request, const BatchPlan& plan, CampaignEvents& events) {
  Rank rank;
  if (is_one_of_many()) {
    const auto& petsc = linear::initialize_petsc();
    rank = {petsc.rank, petsc.size};
  }
  demand_range("--jobs", request.jobs, 0, std::numeric_limits<int>::max());
  demand_positive("--time-limit", request.time_limit, true);
  const auto shard = parse_shard(request.shard);
  const auto folder = find_campaign_folder(request, plan);
  CampaignAnswer answer;
  answer.folder = folder.string();
  std::optional<Folder> state;  // of the first rank
  do_once([&] {
    Diagnostics unused;
    warn_of_unused(plan.get_spec(), unused);
    for (const auto& item : unused.items()) events.add_message(item);
    state.emplace(folder, plan, shard, request.restart);
  });

  std::vector<int> selected, open;
  const auto get_case = [&](int number) { return folder / plan.get_folder(number); };
  for (const auto& one : plan.get_cases())
    if (shard.holds(one.number)) selected.push_back(one.number);
  answer.num_selected = static_cast<int>(selected.size());
  for (std::size_t i = 0; i < selected.size(); ++i) {
    const auto outcome = read_outcome(get_case(selected[i]));
    if (!outcome || (request.retry && !outcome->error.empty())) {
      if (rank.takes(i)) open.push_back(selected[i]);
      continue;
    }
    ++answer.num_before;
    if (!outcome->error.empty()) answer.failed.push_back(*outcome);
  }
  wait_for_all(true);  // the count before is right only while no rank works

  PoolOptions pool;
  pool.command = {"bough", "batch", request.campaign, "-o", folder.string()};
  if (request.may_leave) pool.command.emplace_back("--force-outside");
  pool.command.emplace_back("--worker");
  const int all_cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  pool.num_workers = request.jobs > 0 ? request.jobs : rank.count > 1 ? 1 : all_cores;
  pool.time_limit = request.time_limit > 0 ? request.time_limit : plan.get_spec().time_limit;
  pool.stop = request.stop;
  pool.find_error = [&](int number) { return find_printed_error(plan, get_case(number)); };
  events.start();
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const auto count_seconds = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  answer.completed = run_pool(pool, open, [&](const BatchOutcome& outcome) {
    write_outcome(outcome, get_case(outcome.number));
    ++answer.num_done;
    if (!outcome.error.empty()) answer.failed.push_back(outcome);
    answer.seconds = count_seconds();
    events.show(answer, open.size());
  });
  answer.completed = wait_for_all(answer.completed);
  answer.seconds = count_seconds();
  events.show_progress("");
  if (rank.count > 1) count_again(plan, selected, folder, answer);
  std::sort(answer.failed.begin(), answer.failed.end(),
            [](const auto& a, const auto& b) { return a.number < b.number; });

  do_once([&] {
    const TableLock lock(folder);
    std::vector<BatchOutcome> outcomes;  // of all shards, as far as they are
    for (const auto& one : plan.get_cases())
      if (auto outcome = read_outcome(get_case(one.number))) outcomes.push_back(std::move(*outcome));
    if (const auto before = count_rows(folder / "outcomes.csv"); before > outcomes.size())
      events.add_message({Severity::Warning,
                          "batch.smaller-table",
                          {(folder / "outcomes.csv").string()},
                          fmt::format("it had {} cases and has {} now: the others were merged from other folders",
                                      before, outcomes.size()),
                          "merge them again when all shards are done"});
    answer.statistics = write_tables(plan, outcomes, state->get_fingerprint(), folder);
    answer.num_in_table = static_cast<int>(outcomes.size());
  });
  return answer;
}

/// One table of what several folders hold, or of the campaign's own: after shards that had a folder each.
CampaignAnswer merge_campaign(const CampaignRequest& request, const BatchPlan& plan) {
  const auto folder = find_campaign_folder(request, plan);
  std::vector<fs::path> parts;
  for (const auto& part : request.merged) parts.push_back(fs::absolute(part).lexically_normal());
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
  CampaignAnswer answer;
  answer.folder = folder.string();
  answer.num_selected = plan.num_cases();
  for (const auto& one : plan.get_cases()) {
    std::optional<BatchOutcome> outcome;
    for (std::size_t i = 0; i < parts.size() && !outcome; ++i)
      outcome = read_outcome(parts[i] / plan.get_folder(one.number));
    if (!outcome) {
      missing.push_back(one.number);
      continue;
    }
    ++answer.num_before;
    if (!outcome->error.empty()) answer.failed.push_back(*outcome);
    outcomes.push_back(std::move(*outcome));
  }
  answer.statistics = write_tables(plan, outcomes, state.get_fingerprint(), folder);
  answer.num_in_table = static_cast<int>(outcomes.size());
  if (!missing.empty()) answer.missing = describe_missing(plan, missing, parts);
  return answer;
}

}  // namespace bough::analysis
