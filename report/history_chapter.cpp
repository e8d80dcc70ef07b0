#include "report/history_chapter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <Eigen/Geometry>

#include "base/xml_text.hpp"
#include "formats/records/signal_name.hpp"
#include "report/deflection.hpp"
#include "report/history_data.hpp"
#include "report/html.hpp"
#include "report/label.hpp"
#include "report/shape_plot.hpp"

namespace bough::report {

namespace {

constexpr std::size_t kMaxPictures = 12;
constexpr double kNoise = 1e-9;  // of the largest channel of the same unit

const HistoryChannel* find_channel(const History& h, const std::string& path) {
  for (const auto& channel : h.channels)
    if (channel.path == path) return &channel;
  return nullptr;
}

std::string name_column(const std::string& path, const std::string& component) {
  const std::string name = path.starts_with("/sensors/") ? path.substr(9) : path;
  return component.empty() ? name : name + ":" + component;
}

/// Curves of whole channels; components that are noise are left out.
Plot make_plot(const History& h, const std::string& title, const std::string& y_label,
               const std::vector<const HistoryChannel*>& channels) {
  Plot plot{title, make_label("time", h.time_unit), y_label, {}, 0, 0};
  for (const auto* channel : channels) {
    if (!channel) continue;
    const auto names =
        records::get_component_names(channel->path, static_cast<int>(channel->values.cols()), channel->description);
    for (Eigen::Index c = 0; c < channel->values.cols(); ++c) {
      if (channel->is_noise[static_cast<std::size_t>(c)]) continue;
      const auto& component = names[static_cast<std::size_t>(c)];
      const std::string last = channel->path.substr(channel->path.rfind('/') + 1);
      plot.curves.push_back(
          {channels.size() > 1 || component.empty() ? last + (component.empty() ? "" : ":" + component) : component,
           h.time, channel->values.col(c), false});
      plot.curves.back().unit = channel->get_unit(c);
    }
  }
  label_units(plot);
  return plot;
}

/// A picture of one channel, kept in the chapter; empty if all its components are noise.
std::string add_picture(const History& h, const HistoryChannel& channel, Chapter& chapter) {
  const std::string name = name_column(channel.path, "");
  Plot plot = make_plot(h, name, name, {&channel});
  if (plot.curves.empty()) return "";
  chapter.curves.push_back(plot);
  return make_figure(plot);
}

/// Columns that are constantly zero, or whose size is below 1e-9 of the largest channel with their unit in the group.
void find_noise(History& h) {
  const auto get_group = [](const HistoryChannel& channel) {
    return channel.path.substr(0, channel.path.find('/', 1));
  };
  std::map<std::pair<std::string, std::string>, double> largest;
  const auto calc_size = [](const HistoryChannel& channel, Eigen::Index c) {
    return channel.values.rows() > 0 ? channel.values.col(c).cwiseAbs().maxCoeff() : 0;
  };
  for (const auto& channel : h.channels)
    for (Eigen::Index c = 0; c < channel.values.cols(); ++c) {
      double& size = largest[{get_group(channel), channel.get_unit(c)}];
      size = std::max(size, calc_size(channel, c));
    }
  for (auto& channel : h.channels)
    for (Eigen::Index c = 0; c < channel.values.cols(); ++c) {
      const double size = calc_size(channel, c);
      channel.is_noise.push_back(std::isfinite(size) &&
                                 size <= kNoise * largest[{get_group(channel), channel.get_unit(c)}]);
    }
}

/// Names the sensors that have no chart.
std::string list_noise(const History& h, const std::vector<const HistoryChannel*>& channels) {
  std::string list;
  for (const auto* channel : channels) {
    const auto names =
        records::get_component_names(channel->path, static_cast<int>(channel->values.cols()), channel->description);
    for (Eigen::Index c = 0; c < channel->values.cols() && h.time.size() > 0; ++c)
      if (channel->is_noise[static_cast<std::size_t>(c)])
        list += (list.empty() ? "" : ", ") + name_column(channel->path, names[static_cast<std::size_t>(c)]);
  }
  return list.empty()
             ? ""
             : make_text("Zero, or below 1e-9 of the channels with the same unit, no chart: " + list + ".", "note");
}

std::string make_statistics(const History& h) {
  HtmlTable table(
      "Every column, from all samples of the file",
      {{"channel", true}, {"unit", true}, {"min"}, {"at"}, {"max"}, {"at"}, {"mean"}, {"rms"}, {"first"}, {"last"}});
  for (const auto& channel : h.channels) {
    const auto names =
        records::get_component_names(channel.path, static_cast<int>(channel.values.cols()), channel.description);
    for (Eigen::Index c = 0; c < channel.values.cols() && h.time.size() > 0; ++c) {
      const auto values = channel.values.col(c);
      std::vector<std::string> row{name_column(channel.path, names[static_cast<std::size_t>(c)]), channel.get_unit(c)};
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

std::string make_histories(const History& h, const Strides& strides, Chapter& chapter) {
  std::string html;
  if (std::max(strides.first, strides.others) > 1)
    html += make_text(
        fmt::format("To keep the page small the curves hold {} of sensors, hinges and energies, the smallest and the "
                    "largest of each {} samples of bodies, reactions and masses, each at its time; the motion shows 1 "
                    "of {} samples. Tables are from all samples. --channel chooses fewer channels.",
                    strides.first > 1
                        ? fmt::format("the smallest and the largest of each {} samples", 2 * strides.first)
                        : "all samples",
                    2 * strides.others, strides.others),
        "note");
  html += "<div class=\"live\" data-view=\"history\">\n";
  std::vector<const HistoryChannel*> shown;
  const auto collect = [&](const auto& is_chosen) {
    for (const auto& channel : h.channels)
      if (is_chosen(channel.path)) shown.push_back(&channel);
  };
  collect([](const std::string& path) { return path.starts_with("/sensors/") || path.starts_with("/signals/"); });
  // A run without sensors: the motion of its hinges.
  if (shown.empty())
    collect([](const std::string& path) { return path.starts_with("/hinges/") && path.ends_with("/q"); });
  std::size_t drawn = 0, others = 0;
  for (const auto* channel : shown) {
    if (drawn == kMaxPictures) {
      ++others;
      continue;
    }
    const auto picture = add_picture(h, *channel, chapter);
    drawn += !picture.empty();
    html += picture;
  }
  if (others > 0) html += make_text(fmt::format("{} more channels are in the table.", others), "note");
  return html + "</div>\n" + list_noise(h, shown) + make_statistics(h);
}

/// T + V + U - W minus its first value.
HistoryChannel calc_balance(const History& h) {
  HistoryChannel balance{"/energy/balance", "kinetic + strain + potential - work, less its first value", "F L",
                         Eigen::MatrixXd::Zero(h.time.size(), 1)};
  for (const char* part : {"kinetic", "strain", "potential", "work"}) {
    const auto* channel = find_channel(h, std::string("/energy/") + part);
    if (!channel) return {};
    balance.unit = channel->unit;
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
  std::string html = make_figure(make_plot(h, "Energy", "energy", parts), "energy");
  if (const auto* balance = find_channel(h, "/energy/balance")) {
    const auto plot = make_plot(h, "Error of the energy balance", "energy error", {balance});
    html += !plot.curves.empty()
                ? make_figure(plot, "balance")
                : make_text("The error of the energy balance is below 1e-9 of the largest energy, no chart: at most " +
                                make_label(format_value(balance->values.cwiseAbs().maxCoeff(), 3), balance->unit) + ".",
                            "note");
  }
  chapter.add_panel("energy", "Energy balance", html);
}

void add_momenta(const History& h, Chapter& chapter) {
  std::string html;
  for (const char* kind : {"linear", "angular"}) {
    const auto* channel = find_channel(h, std::string("/momentum/") + kind);
    if (!channel || h.time.size() < 2) continue;
    const auto plot = make_plot(h, std::string("Momentum, ") + kind, std::string(kind) + " momentum", {channel});
    if (!plot.curves.empty()) html += make_figure(plot, std::string("momentum-") + kind);
    html += list_noise(h, {channel});
  }
  if (!html.empty()) chapter.add_panel("momenta", "Momenta", html);
}

void add_reactions(const History& h, Chapter& chapter) {
  HtmlTable table("Largest values", {{"at", true},
                                     {"quantity", true},
                                     {"largest norm"},
                                     {make_label("at time", h.time_unit)},
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
    table.add_row({channel.path.substr(1, cut - 1), make_label(channel.path.substr(cut + 10), channel.unit),
                   format_value(norms[at]), format_value(h.time[at]), format_value(channel.values(at, 0)),
                   format_value(channel.values(at, 1)), format_value(channel.values(at, 2)),
                   format_value(std::sqrt(norms.squaredNorm() / static_cast<double>(norms.size())))});
  }
  if (!table.empty()) chapter.add_panel("reactions", "Reactions", table.to_html());
}

void add_events(const History& h, Chapter& chapter) {
  if (h.events.empty()) return;
  HtmlTable table("", {{make_label("time", h.time_unit)}, {"what", true}});
  for (const auto& event : h.events) table.add_row({format_value(event.time, 10), event.what});
  chapter.add_panel("events", "Events", table.to_html(500));
}

std::string with_unit(double value, const std::string& unit) {
  return format_value(value, 4) + (unit.empty() || unit == "1" ? "" : " " + unit);
}

/// Largest deflection, reaction force and reaction moment; where a run has none, the largest sensors.
void add_highlights(const History& h, Chapter& chapter) {
  auto& highlights = chapter.highlights;
  const auto add_largest = [&](const std::string& title, const auto& is_chosen) {
    const HistoryChannel* found = nullptr;
    double largest = 0;
    Eigen::Index at = 0;
    for (const auto& channel : h.channels) {
      if (!is_chosen(channel) || channel.values.size() == 0 || !channel.values.allFinite()) continue;
      const Eigen::VectorXd norms = channel.values.rowwise().norm();
      Eigen::Index i = 0;
      if (const double norm = norms.maxCoeff(&i); norm > largest) found = &channel, largest = norm, at = i;
    }
    if (!found) return;
    const auto end = found->path.rfind('/');
    highlights.push_back({title.empty() ? "largest " + found->path.substr(end + 1) : title,
                          with_unit(largest, found->unit),
                          (title.empty() ? "" : found->path.substr(1, end - 1) + ", ") +
                              "at t = " + with_unit(h.time[at], h.time_unit)});
  };
  for (const std::string kind : {"force", "moment"})
    add_largest("largest reaction " + kind,
                [&](const auto& channel) { return channel.path.ends_with("/reaction_" + kind); });
  for (const auto& sensor : h.channels) {
    if (highlights.size() >= 3) break;
    if (sensor.path.starts_with("/sensors/") && sensor.unit.find(',') == std::string::npos && !sensor.is_noise[0])
      add_largest("", [&](const auto& channel) { return &channel == &sensor; });
  }
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
  double largest_share = 0;
  for (const auto& body : h.scene.bodies) {
    const auto* eta = find_channel(h, "/bodies/" + body.name + "/eta");
    if (body.size <= 0 || !eta || eta->values.cols() == 0) continue;
    const auto [largest, sample] =
        find_largest_deflection(body.all_shapes.empty() ? body.drawing.shapes : body.all_shapes, eta->values);
    const double when = h.time.size() > 0 ? h.time[sample] : 0;
    const auto* position = find_channel(h, "/bodies/" + body.name + "/position");
    if (largest / body.size > largest_share) {
      largest_share = largest / body.size;
      chapter.highlights = {{"largest deflection", with_unit(largest, position ? position->unit : ""),
                             fmt::format("{}, {} % of its size, at t = {}", body.name,
                                         format_value(100 * largest_share, 3), with_unit(when, h.time_unit))}};
    }
    const std::string warning = "body '" + body.name + "' deflects by";
    const auto event = std::find_if(h.events.begin(), h.events.end(),
                                    [&](const auto& e) { return e.what.compare(0, warning.size(), warning) == 0; });
    const bool is_beyond = event != h.events.end();  // run.linear-limit
    chapter.checks.push_back(
        {"deflection of body " + body.name + " to its size", format_percent(largest / body.size) + " %",
         is_beyond ? Verdict::Warning : Verdict::Good,
         fmt::format("{} of {} at t = {}; {}", format_value(largest, 4), format_value(body.size, 4),
                     format_value(when, 4), is_beyond ? event->what : "within the range of its modes")});
  }
  for (const auto& body : h.scene.bodies)
    if (body.drawing.num_dropped > 0)
      chapter.checks.push_back(
          {"drawn with fewer modes", body.name, Verdict::None,
           fmt::format("the first {}, to keep the page small; numbers are of all", body.drawing.shapes.size())});
  for (const auto& what : h.missing) chapter.checks.push_back({"not drawn", "", Verdict::None, what});
}

/// Points of a body at a sample, in the inertial frame.
Eigen::MatrixXd calc_points(const History& h, const SceneBody& body, Eigen::Index sample) {
  Eigen::MatrixXd at = body.drawing.xyz;
  const auto* position = find_channel(h, "/bodies/" + body.name + "/position");
  const auto* quaternion = find_channel(h, "/bodies/" + body.name + "/quaternion");
  const auto* eta = find_channel(h, "/bodies/" + body.name + "/eta");
  if (!position || !quaternion) return {};
  for (Eigen::Index j = 0; eta && j < std::min(eta->values.cols(), std::ssize(body.drawing.shapes)); ++j)
    at += eta->values(sample, j) * body.drawing.shapes[static_cast<std::size_t>(j)];
  const Eigen::Vector4d q = quaternion->values.row(sample);
  const Eigen::Matrix3d R = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  return (at * R.transpose()).rowwise() + position->values.row(sample);
}

/// The system at the first sample, grey, and at the last, coloured by the displacement between them.
std::string draw_start_and_end(const History& h) {
  Drawing all;
  Eigen::MatrixXd end(0, 3);
  const auto append = [](Eigen::MatrixXd& rows, const Eigen::MatrixXd& more) {
    Eigen::MatrixXd joined(rows.rows() + more.rows(), 3);
    if (rows.rows() > 0) joined.topRows(rows.rows()) = rows;
    joined.bottomRows(more.rows()) = more;
    rows = std::move(joined);
  };
  const Eigen::Index last = h.time.size() - 1;
  for (const auto& body : h.scene.bodies) {
    const auto points = last < 0 ? Eigen::MatrixXd() : calc_points(h, body, 0);
    if (points.rows() == 0 || !points.allFinite()) continue;
    const auto offset = static_cast<std::uint32_t>(all.xyz.rows());
    for (const auto& [from, to] :
         {std::pair(&body.drawing.triangles, &all.triangles), std::pair(&body.drawing.edges, &all.edges)})
      for (const auto k : *from) to->push_back(k + offset);
    append(all.xyz, points);
    append(end, calc_points(h, body, last));
  }
  if (all.xyz.rows() == 0 || !end.allFinite()) return "";
  all.shapes.push_back(end - all.xyz);
  return draw_shape(
      all, 0,
      fmt::format("t = {} (grey) and t = {}", with_unit(h.time[0], h.time_unit), with_unit(h.time[last], h.time_unit)),
      1);
}

}  // namespace

Chapter make_chapter(History history) {
  if (auto balance = calc_balance(history); balance.values.size() > 0) history.channels.push_back(std::move(balance));
  find_noise(history);
  Chapter chapter{"results", history.file, history.facts, {}, {}, {}, history.settings};
  const Strides strides = choose_strides(history);
  add_checks(history, chapter);
  add_highlights(history, chapter);
  const bool moves = std::any_of(history.scene.bodies.begin(), history.scene.bodies.end(), [&](const auto& body) {
    return find_channel(history, "/bodies/" + body.name + "/position") != nullptr;
  });
  if (moves) chapter.add_panel("motion", "Motion", make_live("motion", draw_start_and_end(history)));
  chapter.add_panel("histories", "Time histories", make_histories(history, strides, chapter));
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
