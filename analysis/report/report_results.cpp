#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "analysis/common/channels.hpp"
#include "analysis/report/report_files.hpp"
#include "analysis/report/report_scene.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/records/signal_name.hpp"
#include "report/history_chapter.hpp"

namespace bough::analysis {

namespace {

/// Channels of the file in its own order of kinds: sensors first, then hinges, bodies and the rest.
int get_rank(const std::string& path) {
  static constexpr const char* kOrder[] = {"/sensors/",  "/signals/",     "/controllers/", "/actuators/",
                                           "/hinges/",   "/constraints/", "/bodies/",      "/energy/",
                                           "/momentum/", "/system_mass/"};
  for (std::size_t i = 0; i < std::size(kOrder); ++i)
    if (path.starts_with(kOrder[i])) return static_cast<int>(i);
  return static_cast<int>(std::size(kOrder));
}

bool is_chosen(const std::string& path, const std::vector<std::string>& choices) {
  if (choices.empty()) return true;
  for (const auto& choice : choices) {
    const auto name = records::parse_signal_name(choice);
    const std::string whole = choice.starts_with('/') ? choice : "/sensors/" + choice;
    for (const auto& group : {whole, name.path})
      if (path == group || path.starts_with(group + "/")) return true;
  }
  return false;
}

}  // namespace

report::Chapter make_results_chapter(const std::string& file, const ReportRequest& request, Diagnostics&) {
  auto results = hdf5::read_results(file);
  const auto inputs = hdf5::read_run_inputs(file);
  for (const auto& choice : request.channels) choose_columns(results, file, choice);  // says what is not there
  report::History history;
  history.file = file;
  history.facts = list_facts(file);
  history.settings = list_settings(file);
  history.time = results.time;
  history.time_unit = get_unit(results, "/time");
  history.events = results.events;
  history.system_text = results.system_text;
  history.completed = results.completed;
  history.reason = results.reason;
  history.energy_error = results.energy_error;
  for (auto& [path, values] : results.channels)
    if (values.cols() > 0 && is_chosen(path, request.channels))
      history.channels.push_back(
          {path, results.descriptions[path], results.dims[path], std::move(values), get_unit(results, path), {}});
  std::stable_sort(history.channels.begin(), history.channels.end(),
                   [](const auto& a, const auto& b) { return get_rank(a.path) < get_rank(b.path); });
  add_scene(file, inputs, request, history);
  const auto n = results.time.size();
  history.facts.insert(history.facts.begin() + 1, {"system", history.name});
  history.facts.emplace_back("samples", std::to_string(n));
  if (n > 0) history.facts.emplace_back("time", fmt::format("{:g} to {:g}", results.time[0], results.time[n - 1]));
  return report::make_chapter(std::move(history));
}

}  // namespace bough::analysis
