#include "cli/linearize/sweep_tables.hpp"

#include <fmt/format.h>

#include "cli/common/console.hpp"
#include "formats/records/unit_names.hpp"

namespace bough::cli {

using Eigen::Index;
using records::LinearSweep;

namespace {

std::string name_branch(const LinearSweep& sweep, Index b) {
  const auto k = static_cast<std::size_t>(b);
  const auto &first = sweep.mode.front()[k], &last = sweep.mode.back()[k];
  return first == last ? first : first + " -> " + last;
}

/// Returns true for the upper pole of a pair and for real ones, but not for poles of sampled models at z = 0.
bool is_shown(const LinearSweep& sweep, Index b) { return sweep.imag.col(b).sum() >= 0 && !records::is_gone(sweep, b); }

/// Poles of sampled models at z = 0 all along.
std::string format_gone(const LinearSweep& sweep) {
  std::size_t num_gone = 0;
  for (Index b = 0; b < sweep.real.cols(); ++b) num_gone += records::is_gone(sweep, b) ? 1 : 0;
  return num_gone > 0 ? fmt::format("and {} at z = 0: gone within a sample\n", count(num_gone, "pole")) : "";
}

}  // namespace

nlohmann::json make_json(const LinearSweep& sweep) {
  const auto to_rows = [](const Eigen::MatrixXd& m) {
    auto rows = nlohmann::json::array();
    for (Index i = 0; i < m.rows(); ++i) rows.push_back(std::vector<double>(m.row(i).begin(), m.row(i).end()));
    return rows;
  };
  nlohmann::json json{{"parameter", sweep.parameter},
                      {"value", std::vector<double>(sweep.value.begin(), sweep.value.end())},
                      {"states", sweep.models.front().states.name},
                      {"poles",
                       {{"real", to_rows(sweep.real)},
                        {"imag", to_rows(sweep.imag)},
                        {"frequency_hz", to_rows(sweep.frequency_hz)},
                        {"damping", to_rows(sweep.damping)},
                        {"correlation", to_rows(sweep.correlation)},
                        {"mode", sweep.mode}}}};
  if (sweep.whirl.size() > 0) json["poles"]["whirl"] = to_rows(sweep.whirl);
  for (std::size_t i = 0; i < sweep.grid_name.size(); ++i)
    json["grid"].push_back({{"name", sweep.grid_name[i]},
                            {"value", std::vector<double>(sweep.grid_value[i].begin(), sweep.grid_value[i].end())}});
  if (sweep.models.front().sample_time > 0)
    for (const auto& model : sweep.models) json["sample_time"].push_back(model.sample_time);
  return json;
}

std::string format_sweep(const LinearSweep& sweep) {
  const auto &first = sweep.models.front(), &last = sweep.models.back();
  std::string over;
  for (std::size_t i = 0; i < sweep.grid_name.size(); ++i) {
    const auto& values = sweep.grid_value[i];
    over += fmt::format("{}{} from {:g} to {:g} ({})", i > 0 ? ", " : "", sweep.grid_name[i], values[0],
                        values[values.size() - 1], count(static_cast<std::size_t>(values.size()), "value"));
  }
  if (over.empty())
    over = fmt::format("{} from {:g} to {:g}", sweep.parameter, sweep.value[0], sweep.value[sweep.value.size() - 1]);
  std::string text = fmt::format("{} of {}: {} states, {} inputs, {} outputs\n\n", count(sweep.models.size(), "model"),
                                 over, first.states.size(), first.inputs.size(), last.outputs.size());
  if (first.sample_time > 0)
    text += fmt::format("from sample to sample, every {:g}{}: of a pole z there is ln z over that time\n\n",
                        first.sample_time,
                        last.sample_time != first.sample_time ? fmt::format(" to {:g}", last.sample_time) : "");
  const auto unit = records::name_frequency_unit(first.units.time);
  Table table{{"branch", "from " + unit, "to " + unit, "damping from", "to", "largest real", "mode"}, {}};
  const bool has_whirl = sweep.whirl.size() > 0;
  if (has_whirl) table.headings.emplace_back("whirl");
  const Index end = sweep.value.size() - 1;
  for (Index b = 0; b < sweep.real.cols(); ++b) {
    if (!is_shown(sweep, b)) continue;
    Index worst = 0;
    const double max_real = sweep.real.col(b).maxCoeff(&worst);
    table.rows.push_back({std::to_string(b + 1), fmt::format("{:.6g}", sweep.frequency_hz(0, b)),
                          fmt::format("{:.6g}", sweep.frequency_hz(end, b)), fmt::format("{:.4g}", sweep.damping(0, b)),
                          fmt::format("{:.4g}", sweep.damping(end, b)),
                          sweep.grid_name.empty()
                              ? fmt::format("{:.3g} at {:g}", max_real, sweep.value[worst])
                              : fmt::format("{:.3g} at {}", max_real, records::describe_point(sweep, worst)),
                          name_branch(sweep, b)});
    if (has_whirl)
      table.rows.back().emplace_back(sweep.imag(end, b) > 0 ? records::name_whirl(sweep.whirl(end, b)) : "-");
  }
  return text + table.to_text() + format_gone(sweep);
}

}  // namespace bough::cli
