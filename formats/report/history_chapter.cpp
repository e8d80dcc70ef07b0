#include "formats/report/history_chapter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/xml_text.hpp"
#include "formats/records/signal_name.hpp"
#include "formats/report/history_data.hpp"
#include "formats/report/html.hpp"

namespace bough::report {

namespace {

constexpr double kLinearLimit = 0.10;  // of a body's size, as the solver warns
constexpr std::size_t kMaxPictures = 12;

const HistoryChannel* find_channel(const History& h, const std::string& path) {
  for (const auto& channel : h.channels)
    if (channel.path == path) return &channel;
  return nullptr;
}

std::string make_label(const std::string& what, const std::string& dims) {
  return dims.empty() || dims == "1" ? what : what + " [" + dims + "]";
}

std::string name_column(const std::string& path, const std::string& component) {
  const std::string name = path.starts_with("/sensors/") ? path.substr(9) : path;
  return component.empty() ? name : name + ":" + component;
}

Plot make_plot(const History& h, const std::string& title, const std::string& y_label,
               const std::vector<const HistoryChannel*>& channels) {
  Plot plot{title, "time [T]", y_label, {}, 0, 0};
  for (const auto* channel : channels) {
    if (!channel) continue;
    const auto names =
        records::get_component_names(channel->path, static_cast<int>(channel->values.cols()), channel->description);
    for (Eigen::Index c = 0; c < channel->values.cols(); ++c) {
      const auto& component = names[static_cast<std::size_t>(c)];
      const std::string last = channel->path.substr(channel->path.rfind('/') + 1);
      plot.curves.push_back(
          {channels.size() > 1 || component.empty() ? last + (component.empty() ? "" : ":" + component) : component,
           h.time, channel->values.col(c), false});
    }
  }
  return plot;
}

std::string make_statistics(const History& h) {
  HtmlTable table(
      "Every column, from all samples of the file",
      {{"channel", true}, {"dims", true}, {"min"}, {"at"}, {"max"}, {"at"}, {"mean"}, {"rms"}, {"first"}, {"last"}});
  for (const auto& channel : h.channels) {
    const auto names =
        records::get_component_names(channel.path, static_cast<int>(channel.values.cols()), channel.description);
    for (Eigen::Index c = 0; c < channel.values.cols() && h.time.size() > 0; ++c) {
      const auto values = channel.values.col(c);
      std::vector<std::string> row{name_column(channel.path, names[static_cast<std::size_t>(c)]), channel.dims};
      if (values.allFinite()) {
        Eigen::Index low = 0, high = 0;
        const double min_value = values.minCoeff(&low), max_value = values.maxCoeff(&high);
        for (const double v : {min_value, h.time[low], max_value, h.time[high], values.mean(),
                               std::sqrt(values.squaredNorm() / static_cast<double>(values.size()))})
          row.push_back(format_value(v));
      } else {
        row.insert(row.end(), {"not finite", "", "", "", "", ""});
      }
      row.push_back(format_value(values[0]));
      row.push_back(format_value(values[values.size() - 1]));
      table.add_row(std::move(row));
    }
  }
  return "<details><summary>Statistics of every channel</summary>\n" + table.to_html() + "</details>\n";
}

std::string make_histories(const History& h, const Strides& strides) {
  std::string html;
  if (std::max(strides.first, strides.others) > 1)
    html += make_text(fmt::format("To keep the page small the curves hold 1 of {} samples of sensors, hinges and "
                                  "energies and 1 of {} of the others; tables are from all of them. --channel chooses "
                                  "fewer channels.",
                                  strides.first, strides.others),
                      "note");
  html += "<div class=\"live\" data-view=\"history\">\n";
  std::size_t drawn = 0, sensors = 0;
  for (const auto& channel : h.channels) {
    if (!channel.path.starts_with("/sensors/") && !channel.path.starts_with("/signals/")) continue;
    ++sensors;
    if (drawn == kMaxPictures) continue;
    ++drawn;
    html += make_figure(make_plot(h, name_column(channel.path, ""), make_label("value", channel.dims), {&channel}));
  }
  if (sensors == 0) {
    // A run without sensors: what the hinges do.
    for (const auto& channel : h.channels)
      if (channel.path.starts_with("/hinges/") && channel.path.ends_with("/q") && drawn++ < kMaxPictures)
        html += make_figure(make_plot(h, channel.path, make_label("value", channel.dims), {&channel}));
  }
  if (sensors > drawn) html += make_text(fmt::format("{} sensors more are in the table.", sensors - drawn), "note");
  return html + "</div>\n" + make_statistics(h);
}

/// T + V + U - W minus its first value.
HistoryChannel calc_balance(const History& h) {
  HistoryChannel balance{"/energy/balance", "kinetic + strain + potential - work, less its first value", "F L",
                         Eigen::MatrixXd::Zero(h.time.size(), 1)};
  for (const char* part : {"kinetic", "strain", "potential", "work"}) {
    const auto* channel = find_channel(h, std::string("/energy/") + part);
    if (!channel) return {};
    balance.values += (std::string(part) == "work" ? -1 : 1) * channel->values;
  }
  if (balance.values.rows() > 0) balance.values.array() -= balance.values(0, 0);
  return balance;
}

void add_energy(const History& h, Chapter& chapter) {
  std::vector<const HistoryChannel*> parts;
  for (const char* part : {"kinetic", "strain", "potential", "work", "dissipated"})
    if (const auto* channel = find_channel(h, std::string("/energy/") + part)) parts.push_back(channel);
  if (parts.empty() || h.time.size() < 2) return;
  std::string html = make_figure(make_plot(h, "Energy", "energy [F L]", parts), "energy");
  if (const auto* balance = find_channel(h, "/energy/balance"))
    html += make_figure(make_plot(h, "What the balance lacks", "energy [F L]", {balance}), "balance");
  chapter.add_panel("energy", "Energy balance", html);
}

void add_momenta(const History& h, Chapter& chapter) {
  std::string html;
  for (const char* kind : {"linear", "angular"})
    if (const auto* channel = find_channel(h, std::string("/momentum/") + kind); channel && h.time.size() > 1)
      html +=
          make_figure(make_plot(h, std::string("Momentum, ") + kind, make_label("momentum", channel->dims), {channel}),
                      std::string("momentum-") + kind);
  if (!html.empty()) chapter.add_panel("momenta", "Momenta", html);
}

void add_reactions(const History& h, Chapter& chapter) {
  HtmlTable table("Largest values", {{"at", true},
                                     {"quantity", true},
                                     {"largest norm"},
                                     {"at time"},
                                     {"x there"},
                                     {"y there"},
                                     {"z there"},
                                     {"rms"}});
  for (const auto& channel : h.channels) {
    const auto cut = channel.path.find("/reaction_");
    if (cut == std::string::npos || channel.values.cols() != 3 || channel.values.rows() == 0) continue;
    const Eigen::VectorXd norms = channel.values.rowwise().norm();
    Eigen::Index at = 0;
    for (Eigen::Index i = 0; i < norms.size(); ++i)
      if (norms[i] > norms[at]) at = i;
    table.add_row({channel.path.substr(1, cut - 1), channel.path.substr(cut + 10) + " [" + channel.dims + "]",
                   format_value(norms[at]), format_value(h.time[at]), format_value(channel.values(at, 0)),
                   format_value(channel.values(at, 1)), format_value(channel.values(at, 2)),
                   format_value(std::sqrt(norms.squaredNorm() / static_cast<double>(norms.size())))});
  }
  if (!table.empty()) chapter.add_panel("reactions", "Reactions", table.to_html());
}

void add_events(const History& h, Chapter& chapter) {
  if (h.events.empty()) return;
  HtmlTable table("", {{"time"}, {"what", true}});
  for (const auto& event : h.events) table.add_row({format_value(event.time, 10), event.what});
  chapter.add_panel("events", "Events", table.to_html(500));
}

/// Largest displacement of a point of the body over some 400 samples, and its time.
std::pair<double, double> find_deflection(const SceneBody& body, const HistoryChannel& eta,
                                          const Eigen::VectorXd& time) {
  std::pair<double, double> largest{0, 0};
  const Eigen::Index n =
      std::min<Eigen::Index>(eta.values.cols(), static_cast<Eigen::Index>(body.drawing.shapes.size()));
  const Eigen::Index step = std::max<Eigen::Index>(1, time.size() / 400);
  for (Eigen::Index i = 0; i < time.size(); i += step) {
    Eigen::MatrixXd u = Eigen::MatrixXd::Zero(body.drawing.xyz.rows(), 3);
    for (Eigen::Index j = 0; j < n; ++j) u += eta.values(i, j) * body.drawing.shapes[static_cast<std::size_t>(j)];
    const double norm = u.rows() > 0 ? u.rowwise().norm().maxCoeff() : 0;
    if (norm > largest.first) largest = {norm, time[i]};
  }
  return largest;
}

void add_checks(const History& h, Chapter& chapter) {
  chapter.checks.push_back({"run completed", h.completed ? "yes" : "no", h.completed ? Verdict::Good : Verdict::Bad,
                            h.completed                                 ? ""
                            : h.reason.empty() || h.reason == "running" ? "it still goes on, or was killed"
                                                                        : h.reason});
  std::string bad;
  double last_finite = std::numeric_limits<double>::quiet_NaN();
  for (const auto& channel : h.channels) {
    if (channel.values.allFinite()) continue;
    bad = channel.path;
    for (Eigen::Index i = 0; i < h.time.size() && channel.values.row(i).allFinite(); ++i) last_finite = h.time[i];
    break;
  }
  chapter.checks.push_back({"all samples are numbers", bad.empty() ? "yes" : "no",
                            bad.empty() ? Verdict::Good : Verdict::Bad,
                            bad.empty() ? "" : bad + " is not finite after t = " + format_value(last_finite)});
  if (std::isfinite(h.energy_error))
    chapter.checks.push_back({"worst relative error of the energy balance", format_value(h.energy_error, 3),
                              h.energy_error > h.energy_error_limit ? Verdict::Bad
                              : h.energy_error > 1e-4               ? Verdict::Warning
                                                                    : Verdict::Good,
                              "limit of the run " + format_value(h.energy_error_limit, 3)});
  for (const auto& body : h.scene.bodies) {
    const auto* eta = find_channel(h, "/bodies/" + body.name + "/eta");
    if (body.size <= 0 || !eta || eta->values.cols() == 0) continue;
    const auto [largest, when] = find_deflection(body, *eta, h.time);
    chapter.checks.push_back(
        {"deflection of body " + body.name + " to its size", format_percent(largest / body.size) + " %",
         largest > kLinearLimit * body.size ? Verdict::Warning : Verdict::Good,
         fmt::format("{} of {} at t = {}; linear modes lose their meaning past 10 %", format_value(largest, 4),
                     format_value(body.size, 4), format_value(when, 4))});
  }
  for (const auto& body : h.scene.bodies)
    if (body.drawing.num_dropped > 0)
      chapter.checks.push_back(
          {"drawn with fewer modes", body.name, Verdict::None,
           fmt::format("the first {}, to keep the page small; numbers are of all", body.drawing.shapes.size())});
  for (const auto& what : h.missing) chapter.checks.push_back({"not drawn", "", Verdict::None, what});
}

}  // namespace

Chapter make_chapter(History history) {
  if (auto balance = calc_balance(history); balance.values.size() > 0) history.channels.push_back(std::move(balance));
  Chapter chapter{"results", history.file, history.facts, {}, {}, {}, history.settings};
  const Strides strides = choose_strides(history);
  add_checks(history, chapter);
  const bool moves = std::any_of(history.scene.bodies.begin(), history.scene.bodies.end(), [&](const auto& body) {
    return find_channel(history, "/bodies/" + body.name + "/position") != nullptr;
  });
  if (moves)
    chapter.add_panel(
        "motion", "Motion",
        make_place("motion", "The moving system is drawn by a script with WebGL 2; this reader runs none."));
  chapter.add_panel("histories", "Time histories", make_histories(history, strides));
  add_energy(history, chapter);
  add_momenta(history, chapter);
  add_reactions(history, chapter);
  add_events(history, chapter);
  if (!history.system_text.empty())
    chapter.add_panel("system", "System file",
                      "<details><summary>As the run was started</summary><pre>" + escape_xml(history.system_text) +
                          "</pre></details>\n");
  chapter.data = make_data(history, strides);
  return chapter;
}

}  // namespace bough::report
