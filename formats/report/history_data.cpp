#include "formats/report/history_data.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/records/signal_name.hpp"
#include "formats/report/pack.hpp"

namespace bough::report {

namespace {

using nlohmann::json;

constexpr double kBudget = 4.1e6;      // characters: 20,000 samples of 50 columns, and the page stays below 5 MB
constexpr long kFewest = 1500;         // samples of the others, before the first ones are thinned
constexpr double kCharactersEach = 4;  // of a packed sample

bool is_of_the_others(const std::string& path) {
  return path.starts_with("/bodies/") || path.starts_with("/system_mass/") ||
         path.find("/reaction_") != std::string::npos;
}

Eigen::VectorXd take_every(const Eigen::Ref<const Eigen::VectorXd>& values, long stride) {
  return stride <= 1 || values.size() == 0 ? Eigen::VectorXd(values)
                                           : Eigen::VectorXd(values(Eigen::seq(0, values.size() - 1, stride)));
}

json make_time(const Eigen::VectorXd& time) {
  const Eigen::Index n = time.size();
  const double step = n > 1 ? (time[n - 1] - time[0]) / static_cast<double>(n - 1) : 0;
  bool is_even = n > 1 && step > 0;
  for (Eigen::Index i = 0; i < n && is_even; ++i)
    is_even = std::abs(time[i] - (time[0] + step * static_cast<double>(i))) <= 1e-9 * std::abs(step);
  if (is_even) return {{"first", time[0]}, {"step", step}, {"count", n}};
  return {{"data", pack_doubles(time)}};
}

/// JSON knows no infinity.
json make_number(double value) { return std::isfinite(value) ? json(value) : json(); }

json to_list(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

Strides choose_strides(const History& history) {
  double first = 0, others = 0;
  for (const auto& channel : history.channels)
    (is_of_the_others(channel.path) ? others : first) += static_cast<double>(channel.values.cols());
  const double samples = static_cast<double>(history.time.size()) * kCharactersEach;
  const auto fits = [&](const Strides& s) {
    return samples * (first / static_cast<double>(s.first) + others / static_cast<double>(s.others)) <= kBudget;
  };
  Strides strides;
  while (!fits(strides) && history.time.size() / (strides.others + 1) >= kFewest) ++strides.others;
  while (!fits(strides)) {
    ++strides.first;
    strides.others = std::max(strides.others, strides.first);
    if (strides.first > history.time.size()) break;
  }
  return strides;
}

std::string make_data(const History& history, const Strides& strides) {
  json channels = json::array();
  for (const auto& channel : history.channels) {
    const long stride = is_of_the_others(channel.path) ? strides.others : strides.first;
    const auto names = records::get_component_names(channel.path, static_cast<int>(channel.values.cols()));
    json columns = json::array();
    for (Eigen::Index c = 0; c < channel.values.cols(); ++c) {
      const auto packed = pack_column(take_every(channel.values.col(c), stride));
      columns.push_back({{"name", names[static_cast<std::size_t>(c)]},
                         {"low", packed.low},
                         {"step", packed.step},
                         {"data", packed.data}});
    }
    channels.push_back({{"path", channel.path},
                        {"description", channel.description},
                        {"dims", channel.dims},
                        {"stride", stride},
                        {"columns", std::move(columns)}});
  }
  json events = json::array();
  for (const auto& event : history.events) events.push_back({{"time", make_number(event.time)}, {"what", event.what}});
  json bodies = json::array(), hinges = json::array();
  for (const auto& body : history.bodies)
    bodies.push_back({{"name", body.name}, {"drawing", json::parse(to_json_text(body.drawing))}});
  for (const auto& hinge : history.hinges)
    hinges.push_back({{"name", hinge.name},
                      {"type", hinge.type},
                      {"parent", hinge.parent},
                      {"point", hinge.point},
                      {"p", to_list(hinge.p)},
                      {"axis", to_list(hinge.axis)}});
  return json{{"time", make_time(history.time)},
              {"channels", std::move(channels)},
              {"events", std::move(events)},
              {"bodies", std::move(bodies)},
              {"hinges", std::move(hinges)}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace bough::report
