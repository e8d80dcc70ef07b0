#include "cli/select/selection_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "analysis/common/inputs.hpp"
#include "analysis/common/text_file.hpp"
#include "cli/common/console.hpp"
#include "cli/common/json_rows.hpp"
#include "formats/export/csv.hpp"
#include "report/svg_plot.hpp"

namespace bough::cli {

namespace {

bool has_effective_mass(const records::FlexBody& body) { return body.effective_mass.rows() == body.num_modes(); }

/// A mode of one of the bodies.
struct Row {
  const RankedBody* of = nullptr;
  int mode = 0;  ///< from 0
};

std::vector<Row> list_rows(const std::vector<RankedBody>& bodies) {
  std::vector<Row> rows;
  for (const auto& one : bodies)
    for (int mode = 0; mode < one.body->num_modes(); ++mode) rows.push_back({&one, mode});
  return rows;
}

}  // namespace

nlohmann::json make_json(const std::vector<RankedBody>& bodies, const analysis::Selection& s) {
  auto modes = nlohmann::json::array(), of_bodies = nlohmann::json::array();
  const auto rows = list_rows(bodies);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto& body = *rows[k].of->body;
    const int i = rows[k].mode;
    const auto& mode = s.ranking.modes[k];
    nlohmann::json one{{"mode", i + 1},
                       {"frequency_hz", body.frequency_hz[i]},
                       {"cost", mode.cost},
                       {"share", s.ranking.total > 0 ? mode.cost / s.ranking.total : 0},
                       {"closed_form", mode.closed_form},
                       {"kept", s.choices[k].kept},
                       {"reason", s.choices[k].reason}};
    if (!rows[k].of->name.empty()) one["body"] = rows[k].of->name;
    if (s.modal_hankel.size() > 0) one["hankel"] = s.modal_hankel[i];
    if (has_effective_mass(body)) {
      const Eigen::VectorXd row = body.effective_mass.row(i);
      one["effective_mass"] = std::vector<double>(row.begin(), row.end());
    }
    modes.push_back(std::move(one));
  }
  for (const auto& one : bodies) {
    auto kept = nlohmann::json::array();
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (rows[k].of == &one && s.choices[k].kept) kept.push_back(rows[k].mode + 1);
    of_bodies.push_back({{"name", one.name}, {"file", one.file}, {"modes", one.body->num_modes()}, {"kept", kept}});
  }
  using Loss = analysis::Loss;
  const auto losses = make_rows(s.losses, "name", &Loss::name, "total_cost", &Loss::total, "lost_share", &Loss::lost,
                                "peak_gain", &Loss::peak, "peak_error", &Loss::error, "peak_error_hz", &Loss::error_hz,
                                "balanced_bound", &Loss::balanced_bound, "steady_error", &Loss::steady_error);
  nlohmann::json json{{"modes", modes},
                      {"total_cost", s.ranking.total},
                      {"other_cost", s.ranking.other},
                      {"dropped_share", s.dropped},
                      {"lost_share", s.lost},
                      {"configurations", losses}};
  if (s.static_error >= 0) json["static_error"] = s.static_error;
  if (bodies.size() != 1 || !bodies.front().name.empty()) json["bodies"] = std::move(of_bodies);
  return json;
}

std::string format(const std::vector<RankedBody>& bodies, const analysis::Selection& s, int inertial_load) {
  Table table{{"mode", "frequency Hz", "cost", "share %"}, {}};
  const auto rows = list_rows(bodies);
  const bool is_system = !bodies.front().name.empty();
  const bool has_hankel = s.modal_hankel.size() > 0;
  const bool has_mass =
      std::all_of(bodies.begin(), bodies.end(), [](const auto& one) { return has_effective_mass(*one.body); });
  if (is_system) table.headings.insert(table.headings.begin(), "body");
  if (has_hankel) table.headings.push_back("Hankel");
  if (has_mass) table.headings.push_back("eff. mass %");
  if (inertial_load > 0) table.headings.push_back("K_G");
  for (const char* heading : {"kept", "reason"}) table.headings.push_back(heading);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto& body = *rows[k].of->body;
    const int i = rows[k].mode;
    const double cost = s.ranking.modes[k].cost;
    std::vector<std::string> row{std::to_string(i + 1), fmt::format("{:.6g}", body.frequency_hz[i]),
                                 fmt::format("{:.4g}", cost),
                                 fmt::format("{:.3g}", s.ranking.total > 0 ? 100 * cost / s.ranking.total : 0)};
    if (is_system) row.insert(row.begin(), rows[k].of->name);
    if (has_hankel) row.push_back(fmt::format("{:.3g}", s.modal_hankel[i]));
    if (has_mass)
      row.push_back(fmt::format("{:.3g}", 100 * body.effective_mass.row(i).head<3>().maxCoeff() / body.mass));
    if (inertial_load > 0) {
      const auto& kg = body.kg_inertial[static_cast<std::size_t>(inertial_load - 1)];
      const double stiffness = body.modal_stiffness(i, i);
      row.push_back(kg.size() > 0 && stiffness > 0 ? fmt::format("{:.3g}", kg(i, i) / stiffness) : "-");
    }
    row.push_back(s.choices[k].kept ? "yes" : "no");
    row.push_back(s.choices[k].reason);
    table.rows.push_back(std::move(row));
  }
  auto text = table.to_text();
  if (is_system) {
    text += '\n';
    for (const auto& one : bodies) {
      std::string kept;
      int num_kept = 0;
      for (std::size_t k = 0; k < rows.size(); ++k)
        if (rows[k].of == &one && s.choices[k].kept)
          kept += (num_kept++ == 0 ? ": " : ", ") + std::to_string(rows[k].mode + 1);
      text += fmt::format("{} keeps {} of {}{}\n", one.name, num_kept, count(one.body->num_modes(), "mode"), kept);
    }
  }
  if (s.losses.size() == 1) {
    text += fmt::format("\ntotal cost {:.6g}", s.ranking.total);
    if (s.ranking.other != 0) text += fmt::format(", of it {:.4g} by the rest of the system", s.ranking.other);
  } else {
    text += fmt::format("\nshares are the largest of {}", count(s.losses.size(), "configuration"));
  }
  text += fmt::format("\n{} kept, {} dropped with {:.3g} % of the cost", count(s.kept.size(), "mode"),
                      rows.size() - s.kept.size(), 100 * s.dropped);
  text += fmt::format("; the outputs lose {:.3g} % (mean square)", 100 * s.lost);
  if (s.static_error >= 0) text += fmt::format(", static response off by {:.3g} %", 100 * s.static_error);
  text += "\n";
  for (const auto& loss : s.losses) {
    if (s.losses.size() > 1)
      text += fmt::format("{}: total cost {:.6g}, loses {:.3g} %\n", loss.name, loss.total, 100 * loss.lost);
    text += fmt::format(
        "largest gain {:.4g}, of what is lost {:.4g} at {:.4g} Hz (a balanced model of as many states: at most "
        "{:.4g}), "
        "steady gain off by {:.3g} %\n",
        loss.peak, loss.error, loss.error_hz, loss.balanced_bound, 100 * loss.steady_error);
  }
  return text;
}

void write_response(const analysis::Selection& s, const std::string& path) {
  if (s.losses.empty() || s.losses.front().frequency_hz.size() == 0) return;
  const analysis::Loss& loss = s.losses.front();
  if (analysis::has_suffix(path, ".svg")) {
    const auto decibel = [](const Eigen::VectorXd& gain) {
      return Eigen::VectorXd(20 * gain.array().max(1e-300).log10());
    };
    report::Plot plot;
    plot.title = loss.name;
    plot.x_label = "frequency [1/T]";
    plot.y_label = "largest singular value [dB]";
    plot.has_log_x = true;
    plot.curves = {{"all modes", loss.frequency_hz, decibel(loss.before)},
                   {"modes kept", loss.frequency_hz, decibel(loss.after)},
                   {"difference", loss.frequency_hz, decibel(loss.difference)}};
    analysis::write_text_file(path, report::draw_svg(plot));
    return;
  }
  std::ostringstream text;
  exports::write_csv(text, {{"frequency_hz", loss.frequency_hz},
                            {"before", loss.before},
                            {"after", loss.after},
                            {"difference", loss.difference}});
  analysis::write_text_file(path, text.str());
}

}  // namespace bough::cli
