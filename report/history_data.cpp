#include "report/history_data.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/records/signal_name.hpp"
#include "report/pack.hpp"

namespace bough::report {

namespace {

using nlohmann::json;

constexpr double kBudget = 4.1e6;      // characters: 20,000 samples of 50 columns, and the page stays below 5 MB
constexpr long kMinSamples = 1500;     // samples of the others, before the first ones are thinned
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

json to_json(const ScenePlace& place) {
  return {{"body", place.body}, {"point", place.point}, {"p", to_list(place.p)}};
}

json to_json(const SceneBody& body) {
  return {{"name", body.name}, {"drawing", json::parse(to_json_text(body.drawing))}};
}

json to_json(const SceneHinge& hinge) {
  json rows = json::array();
  for (int i = 0; i < 3; ++i) rows.push_back(to_list(hinge.rotation.row(i).transpose()));
  return {{"name", hinge.name},
          {"type", hinge.type},
          {"at", to_json(hinge.at)},
          {"axis", to_list(hinge.axis)},
          {"rotation", std::move(rows)}};
}

json to_json(const SceneSensor& sensor) {
  json axes = json::array();
  for (const auto& axis : sensor.axes) axes.push_back(to_list(axis));
  return {{"name", sensor.name},          {"type", sensor.type},
          {"at", to_json(sensor.at)},     {"to", sensor.to ? to_json(*sensor.to) : json()},
          {"axis", to_list(sensor.axis)}, {"axes", std::move(axes)}};
}

template <typename T>
json make_list(const std::vector<T>& things) {
  json list = json::array();
  for (const auto& thing : things) list.push_back(to_json(thing));
  return list;
}

json make_arrows(const std::vector<SceneArrow>& arrows, long stride) {
  json list = json::array();
  for (const auto& arrow : arrows) {
    json one{{"name", arrow.name},
             {"moment", arrow.is_moment},
             {"reaction", arrow.is_reaction},
             {"at", to_json(arrow.at)},
             {"towards", arrow.towards ? to_json(*arrow.towards) : json()},
             {"frame", arrow.frame},
             {"axes", {to_list(arrow.axes.row(0)), to_list(arrow.axes.row(1)), to_list(arrow.axes.row(2))}},
             {"factor", arrow.factor},
             {"channel", arrow.channel},
             {"column", arrow.column}};
    if (arrow.channel.empty()) {
      const auto packed = pack_column(take_every(arrow.values, stride));
      one["stride"] = stride;
      one["values"] = {{"low", packed.low}, {"step", packed.step}, {"data", packed.data}};
    }
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace

namespace {

/// Names of the components of /bodies/NAME/eta and eta_dot; null if the body was not found.
const std::vector<std::string>* find_mode_names(const History& history, const std::string& path) {
  for (const auto& body : history.scene.bodies)
    if (path == "/bodies/" + body.name + "/eta" || path == "/bodies/" + body.name + "/eta_dot") return &body.mode_names;
  return nullptr;
}

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
  while (!fits(strides) && history.time.size() / (strides.others + 1) >= kMinSamples) ++strides.others;
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
    const auto names =
        records::get_component_names(channel.path, static_cast<int>(channel.values.cols()), channel.description);
    const auto* modes = find_mode_names(history, channel.path);
    const bool is_labelled = modes && std::ssize(*modes) == channel.values.cols();
    json columns = json::array();
    for (Eigen::Index c = 0; c < channel.values.cols(); ++c) {
      const auto packed = pack_column(take_every(channel.values.col(c), stride));
      columns.push_back({{"name", names[static_cast<std::size_t>(c)]},
                         {"unit", channel.get_unit(c)},
                         {"noise", static_cast<bool>(channel.is_noise[static_cast<std::size_t>(c)])},
                         {"low", packed.low},
                         {"step", packed.step},
                         {"data", packed.data}});
      if (is_labelled) columns.back()["label"] = (*modes)[static_cast<std::size_t>(c)];
    }
    channels.push_back({{"path", channel.path},
                        {"description", channel.description},
                        {"unit", channel.unit},
                        {"stride", stride},
                        {"columns", std::move(columns)}});
  }
  json events = json::array();
  for (const auto& event : history.events) events.push_back({{"time", make_number(event.time)}, {"what", event.what}});
  return json{{"time", make_time(history.time)},
              {"time_unit", history.time_unit},
              {"channels", std::move(channels)},
              {"events", std::move(events)},
              {"bodies", make_list(history.scene.bodies)},
              {"hinges", make_list(history.scene.hinges)},
              {"sensors", make_list(history.scene.sensors)},
              {"arrows", make_arrows(history.scene.arrows, strides.others)}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace bough::report
