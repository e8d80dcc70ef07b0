#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "analysis/campaign/campaign.hpp"
#include "analysis/campaign/worker.hpp"
#include "analysis/common/ranks.hpp"
#include "cli/common/console.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/options.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/verbs.hpp"
#include "fe/linear/petsc.hpp"

namespace bough::cli {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

struct BatchOptions : CommonOptions {
  analysis::CampaignRequest request;
  bool merges = false, dry_run = false;
  int worker_fd = -1;
};

/// Set by SIGINT, SIGTERM and SIGHUP; a handler can reach nothing but static storage.
volatile int& get_stop() {
  static volatile int stop = 0;
  return stop;
}
void on_signal(int) { get_stop() = 1; }

/// Prints messages during the campaign, and a line of progress.
class ConsoleCampaign final : public analysis::CampaignEvents {
 public:
  explicit ConsoleCampaign(Console& console) : console_(console) {}

  void add_message(const Diagnostic& message) override { console_.print(message); }
  void show_progress(const std::string& stage) override { console_.show_stage(stage); }
  void start() override {
    signals_.emplace(on_signal);
    shown_ = Clock::now() - std::chrono::seconds(1);
  }
  void show(const analysis::CampaignAnswer& so_far, std::size_t num_open) override {
    if (Clock::now() - shown_ < std::chrono::milliseconds(100)) return;
    shown_ = Clock::now();
    const double each = so_far.seconds / so_far.num_done;
    console_.show_progress(
        fmt::format("batch: {}/{} done, {} failed, {:.3g} s a case, {:.0f} s left", so_far.num_before + so_far.num_done,
                    so_far.num_selected, so_far.failed.size(), each,
                    each * static_cast<double>(num_open - static_cast<std::size_t>(so_far.num_done))));
  }

 private:
  using Clock = std::chrono::steady_clock;
  Console& console_;
  std::optional<SignalScope> signals_;
  Clock::time_point shown_;
};

std::string join_words(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

void list_cases(const analysis::BatchPlan& plan, const analysis::Shard& shard, bool as_json, const Console& console) {
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

std::string format_failed(const analysis::BatchPlan& plan, const std::vector<analysis::BatchOutcome>& failed) {
  constexpr std::size_t max_shown = 20;
  std::string text;
  for (std::size_t i = 0; i < failed.size() && i < max_shown; ++i)
    text += fmt::format("  {}: {}\n", plan.get_folder(failed[i].number), failed[i].error);
  if (failed.size() > max_shown) text += fmt::format("  and {} more: see the table\n", failed.size() - max_shown);
  return text;
}

std::string format_statistics(const std::vector<analysis::Statistics>& statistics) {
  Table table{{"output", "cases", "mean", "deviation", "min", "5 %", "median", "95 %", "max"}, {}};
  for (const auto& s : statistics) {
    table.rows.push_back({s.name, std::to_string(s.count)});
    for (const double x : {s.mean, s.deviation, s.min, s.p5, s.median, s.p95, s.max})
      table.rows.back().push_back(fmt::format("{:.6g}", x));
  }
  return statistics.empty() ? "" : table.to_text();
}

std::string format_percentiles(const std::vector<analysis::Statistics>& statistics, double confidence) {
  Table table{{"output", "%", "value", "lower", "upper"}, {}};
  const auto format = [](double x) { return std::isfinite(x) ? fmt::format("{:.6g}", x) : std::string("-"); };
  for (const auto& s : statistics)
    for (const auto& one : s.percentiles)
      table.rows.push_back(
          {s.name, fmt::format("{:g}", one.percent), format(one.value), format(one.lower), format(one.upper)});
  if (table.rows.empty()) return "";
  return fmt::format("\npercentiles, bounds of {:g} % confidence (-: too few cases)\n", confidence) + table.to_text();
}

json to_json(const std::vector<analysis::Statistics>& statistics) {
  json all = json::object();
  const auto to_bound = [](double x) { return std::isfinite(x) ? json(x) : json(nullptr); };
  for (const auto& s : statistics) {
    all[s.name] = {{"count", s.count}, {"mean", s.mean}, {"deviation", s.deviation},
                   {"min", s.min},     {"p5", s.p5},     {"median", s.median},
                   {"p95", s.p95},     {"max", s.max}};
    for (const auto& one : s.percentiles)
      all[s.name]["percentiles"].push_back({{"percent", one.percent},
                                            {"value", one.value},
                                            {"lower", to_bound(one.lower)},
                                            {"upper", to_bound(one.upper)}});
  }
  return all;
}

int report(const BatchOptions& o, const analysis::BatchPlan& plan, const analysis::CampaignAnswer& answer,
           const Console& console) {
  const auto table = (fs::path(answer.folder) / "outcomes.csv").string();
  if (o.json) {
    json failed = json::array();
    for (const auto& f : answer.failed)
      failed.push_back({{"case", f.number}, {"exit_code", f.exit_code}, {"error", f.error}});
    console.print_data(json{{"name", plan.get_spec().name},
                            {"folder", answer.folder},
                            {"cases", answer.num_selected},
                            {"done_before", answer.num_before},
                            {"done", answer.num_done},
                            {"failed", failed},
                            {"completed", answer.completed},
                            {"seconds", answer.seconds},
                            {"statistics", to_json(answer.statistics)},
                            {"table", table}}
                           .dump(2) +
                       "\n");
  } else {
    constexpr std::size_t max_shown = 40;
    if (answer.num_in_table > 1 && answer.statistics.size() <= max_shown)
      console.print(format_statistics(answer.statistics) +
                    format_percentiles(answer.statistics, plan.get_spec().confidence));
    console.print(fmt::format("{}: {} of {} cases done{}, {} failed, {:.2f} s\nwritten: {} and .h5, {} cases\n",
                              plan.get_spec().name, answer.num_before + answer.num_done, answer.num_selected,
                              answer.num_before > 0 ? fmt::format(" ({} before)", answer.num_before) : "",
                              answer.failed.size(), answer.seconds, table, answer.num_in_table));
  }
  if (!answer.failed.empty()) {
    console.print_error("batch.failed-cases",
                        fmt::format("{} of {} cases failed", answer.failed.size(), answer.num_selected),
                        "their folders hold what they printed; --retry does them again");
    if (!o.json) console.print_data("failed:\n" + format_failed(plan, answer.failed));
  }
  if (!answer.completed)
    console.print_error(
        "cli.interrupted",
        fmt::format("stopped after {} of {} cases", answer.num_before + answer.num_done, answer.num_selected),
        "the same command goes on with the others");
  return answer.failed.empty() && answer.completed ? kSuccess : kComputationFailed;
}

int run_merge(const BatchOptions& o, const analysis::CampaignRequest& request, const analysis::BatchPlan& plan,
              const Console& console) {
  const auto answer = analysis::merge_campaign(request, plan);
  const int code = report(o, plan, answer, console);
  if (answer.missing.empty()) return code;
  console.print_error("batch.missing-shard", answer.missing,
                      "the table has the others; run what is missing, then merge again");
  return kComputationFailed;
}

int run_batch(const BatchOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (analysis::is_one_of_many() && o.worker_fd < 0 && !o.dry_run && !o.merges)
    console.set_rank(linear::initialize_petsc().rank);
  else if (!console.is_root())
    return kSuccess;  // one says it for all
  auto request = o.request;
  request.output = o.output;
  request.stop = &get_stop();
  const auto shard = analysis::parse_shard(request.shard);
  const analysis::BatchPlan plan(request.campaign, list_verbs(), request.may_leave);
  const auto folder = analysis::find_campaign_folder(request, plan);
  if (o.worker_fd >= 0) return analysis::serve_cases(plan, folder, o.worker_fd, request.may_leave, run_command);
  if (o.dry_run) {
    list_cases(plan, shard, o.json, console);
    return kSuccess;
  }
  if (o.merges) return run_merge(o, request, plan, console);
  ConsoleCampaign events(console);
  const auto answer = analysis::run_campaign(request, plan, events);
  int code = answer.failed.empty() && answer.completed ? kSuccess : kComputationFailed;
  analysis::do_once([&] { code = report(o, plan, answer, console); });
  return code;
}

}  // namespace

void add_batch(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb<BatchOptions>(app, "batch");
  verb->add_option("campaign", o->request.campaign, "Campaign file (.toml)")->required();
  verb->add_option("-j,--jobs", o->request.jobs, "Worker processes (default: one a core)")->check(make_positive());
  verb->add_option("-o,--output", o->output, "Folder of the cases and the table (default: the campaign's name, here)");
  verb->add_option("--shard", o->request.shard, "i/n: only every n-th case from the i-th on, for job arrays");
  auto* merge = verb->add_option("--merge", o->request.merged,
                                 "Do no case: make one table of these folders of shards, or of the campaign's own")
                    ->expected(0, -1)
                    ->type_name("FOLDER ...");
  verb->add_option("--time-limit", o->request.time_limit, "Seconds a case may take (default: the campaign's)")
      ->check(make_positive());
  verb->add_flag("--retry", o->request.retry, "Do failed cases again");
  verb->add_flag("--restart", o->request.restart, "Do every case again, also after the campaign has changed");
  verb->add_flag("--force-outside", o->request.may_leave, "Let the steps write outside the folder of their case");
  verb->add_flag("--dry-run", o->dry_run, "Check the campaign and list its cases");
  verb->add_option("--worker", o->worker_fd, "Socket of a worker process")->group("");
  add_common_options(*verb, *o, kJson);
  verb->callback([&action, o = o, merge = merge] {
    o->merges = merge->count() > 0;
    std::erase(o->request.merged, "");  // what stands for no folder
    action = [o] { return run_batch(*o); };
  });
}

}  // namespace bough::cli
