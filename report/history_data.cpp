#include "report/history_data.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "formats/records/signal_name.hpp"
#include "report/pack.hpp"
#include "report/thin.hpp"

namespace bough::report {

namespace {

using nlohmann::json;

constexpr double kBudget = 4.1e6;       // characters: 20,000 samples of 50 columns, and the page stays below 5 MB
constexpr long kMinSamples = 1500;      // samples of the others, before the first ones are thinned
constexpr double kCharactersEach = 4;   // of a packed sample
constexpr double kIndexCharacters = 2;  // of its index, where samples are left out

bool is_of_the_others(const std::string& path) {
  return path.starts_with("/bodies/") || path.starts_with("/system_mass/") ||
         path.find("/reaction_") != std::string::npos;
}

/// Channels of which the motion is drawn: all their columns are needed at the same times.
std::set<std::string> list_moving(const History& history) {
  std::set<std::string> paths;
  for (const auto& body : history.scene.bodies)
    for (const char* part : {"position", "quaternion", "eta"}) paths.insert("/bodies/" + body.name + "/" + part);
  for (const auto& arrow : history.scene.arrows)
    if (!arrow.channel.empty()) paths.insert(arrow.channel);
  return paths;
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

json to_json(const PackedColumn& packed) { return {{"low", packed.low}, {"step", packed.step}, {"data", packed.data}}; }

/// The smallest and the largest of each 2 `stride` samples, where they are, and means of all samples.
json make_extremes(const Eigen::Ref<const Eigen::VectorXd>& values, long stride) {
  const auto chosen = choose_extremes(values, 2 * stride);
  const auto at = pack_ascending(chosen);
  json extremes = to_json(pack_column(values(chosen)));
  extremes.update({{"at", at.data}, {"digits", at.digits}});
  double sum = 0, squares = 0, count = 0;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    sum += v;
    squares += v * v;
    ++count;
  }
  extremes.update({{"mean", make_number(sum / count)}, {"rms", make_number(std::sqrt(squares / count))}});
  extremes["count"] = count;
  return extremes;
}

/// The largest size of the arrow of all samples, and its time.
json find_largest(const SceneArrow& arrow, const History& history) {
  const auto channel = std::find_if(history.channels.begin(), history.channels.end(),
                                    [&](const auto& one) { return one.path == arrow.channel; });
  Eigen::VectorXd sizes;
  if (arrow.channel.empty())
    sizes = arrow.values.cwiseAbs();
  else if (channel != history.channels.end() && arrow.column < channel->values.cols())
    sizes = arrow.column < 0 ? Eigen::VectorXd(channel->values.rowwise().norm())
                             : Eigen::VectorXd(channel->values.col(arrow.column).cwiseAbs());
  if (arrow.column >= 0 && !arrow.towards) sizes *= arrow.axes.col(0).norm();
  double value = 0, time = 0;
  for (Eigen::Index i = 0; i < std::min(sizes.size(), history.time.size()); ++i)
    if (sizes[i] > value) value = sizes[i], time = history.time[i];
  return {{"value", make_number(value)}, {"time", time}};
}

json make_arrows(const History& history, long stride) {
  json list = json::array();
  for (const auto& arrow : history.scene.arrows) {
    json one{{"name", arrow.name},
             {"moment", arrow.is_moment},
             {"reaction", arrow.is_reaction},
             {"at", to_json(arrow.at)},
             {"towards", arrow.towards ? to_json(*arrow.towards) : json()},
             {"frame", arrow.frame},
             {"axes", {to_list(arrow.axes.row(0)), to_list(arrow.axes.row(1)), to_list(arrow.axes.row(2))}},
             {"factor", arrow.factor},
             {"channel", arrow.channel},
             {"column", arrow.column},
             {"largest", find_largest(arrow, history)}};
    if (arrow.channel.empty()) {
      one["stride"] = stride;
      one["values"] = to_json(pack_column(take_every(arrow.values, stride)));
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
  double first = 0, others = 0, moving = 0;
  const auto paths = list_moving(history);
  for (const auto& channel : history.channels) {
    (is_of_the_others(channel.path) ? others : first) += static_cast<double>(channel.values.cols());
    if (paths.contains(channel.path)) moving += static_cast<double>(channel.values.cols());
  }
  const auto samples = static_cast<double>(history.time.size());
  const auto calc_characters = [&](double columns, long stride) {
    return columns * samples / static_cast<double>(stride) * (kCharactersEach + (stride > 1 ? kIndexCharacters : 0));
  };
  const auto fits = [&](const Strides& s) {
    return calc_characters(first, s.first) + calc_characters(others, s.others) +
               (s.others > 1 ? moving * samples * kCharactersEach / static_cast<double>(s.others) : 0) <=
           kBudget;
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
  const auto moving = list_moving(history);
  for (const auto& channel : history.channels) {
    const long stride = is_of_the_others(channel.path) ? strides.others : strides.first;
    const auto names =
        records::get_component_names(channel.path, static_cast<int>(channel.values.cols()), channel.description);
    const auto* modes = find_mode_names(history, channel.path);
    const bool is_labelled = modes && std::ssize(*modes) == channel.values.cols();
    json columns = json::array();
    for (Eigen::Index c = 0; c < channel.values.cols(); ++c) {
      json column{{"name", names[static_cast<std::size_t>(c)]},
                  {"unit", channel.get_unit(c)},
                  {"noise", static_cast<bool>(channel.is_noise[static_cast<std::size_t>(c)])}};
      if (stride == 1 || moving.contains(channel.path))
        column.update(to_json(pack_column(take_every(channel.values.col(c), stride))));
      if (stride > 1) column["extremes"] = make_extremes(channel.values.col(c), stride);
      columns.push_back(std::move(column));
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
              {"arrows", make_arrows(history, strides.others)}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace bough::report
