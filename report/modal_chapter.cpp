#include "report/modal_chapter.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include <Eigen/Eigenvalues>

#include "base/xml_text.hpp"
#include "report/effective_mass_plot.hpp"
#include "report/html.hpp"
#include "report/pack.hpp"
#include "report/shape_plot.hpp"

namespace bough::report {

namespace {

constexpr std::array<const char*, 6> kDirections{"x", "y", "z", "rx", "ry", "rz"};

std::string make_mass_panel(const ModalModel& m) {
  HtmlTable table(m.frame, {{"", true}, {"x"}, {"y"}, {"z"}});
  const auto add = [&](const std::string& name, const Eigen::Vector3d& v) {
    table.add_row({name, format_value(v.x()), format_value(v.y()), format_value(v.z())});
  };
  add("centre of mass [L]", m.cg);
  const Eigen::Vector3d d = m.cg - m.reference;
  Eigen::Matrix3d central = m.inertia - m.mass * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
  // Round-off of the shift is not shown.
  const double noise = 1e-13 * (m.inertia.cwiseAbs().maxCoeff() + m.mass * d.squaredNorm());
  central = (central.array().abs() < noise).select(0.0, central);
  const std::array<std::string, 3> rows{"x", "y", "z"};
  for (int i = 0; i < 3; ++i)
    add("inertia about the origin, row " + rows[static_cast<std::size_t>(i)] + " [M L²]", m.inertia.row(i));
  for (int i = 0; i < 3; ++i) add("about the centre of mass, row " + rows[static_cast<std::size_t>(i)], central.row(i));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(central);
  if (central.allFinite()) {
    add("principal moments", axes.eigenvalues());
    add("radii of gyration [L]", m.mass > 0 ? Eigen::Vector3d((axes.eigenvalues().cwiseMax(0) / m.mass).cwiseSqrt())
                                            : Eigen::Vector3d::Constant(std::nan("")));
  }
  return make_text("Mass " + format_value(m.mass, 8) + " [M]") + table.to_html();
}

std::string make_mode_table(const ModalModel& m) {
  std::vector<HtmlTable::Column> columns{{"mode"}, {m.is_buckling ? "load factor" : "frequency [Hz]"}};
  const bool has_kind = !m.mode_kind.empty(), has_mass = m.modal_mass.size() > 0, has_residual = m.residual.size() > 0;
  const bool has_damping = m.damping.size() > 0;
  const bool has_effective = m.effective_mass.rows() == m.frequency_hz.size() && !m.is_buckling;
  if (has_kind) columns.push_back({"kind", true});
  if (has_damping) columns.push_back({"damping %"});
  if (has_mass) columns.push_back({"modal mass"});
  if (has_residual) columns.push_back({"residual"});
  // Shares of m and of the inertia about the origin, which the effective masses are about.
  Eigen::Matrix<double, 6, 1> whole;
  whole << m.mass, m.mass, m.mass, m.inertia.diagonal();
  if (has_effective)
    for (std::size_t k = 0; k < 6; ++k) {
      columns.push_back({std::string(kDirections[k]) + " %"});
      columns.push_back({"Σ"});
    }
  HtmlTable table(has_effective ? "Effective mass in % of the whole, and its sum so far" : "", columns);
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  for (Eigen::Index j = 0; j < m.frequency_hz.size(); ++j) {
    std::vector<std::string> row{std::to_string(j + 1), format_value(m.frequency_hz[j], 7)};
    if (has_kind) row.push_back(m.mode_kind[static_cast<std::size_t>(j)]);
    if (has_damping) row.push_back(format_value(100 * m.damping[j], 4));
    if (has_mass) row.push_back(format_value(m.modal_mass[j]));
    if (has_residual) row.push_back(format_value(m.residual[j], 2));
    if (has_effective)
      for (Eigen::Index k = 0; k < 6; ++k) {
        const double share = whole[k] > 0 ? m.effective_mass(j, k) / whole[k] : std::nan("");
        sum[k] += share;
        row.push_back(format_percent(share));
        row.push_back(format_percent(sum[k]));
      }
    table.add_row(std::move(row));
  }
  return table.to_html();
}

std::string make_integrals(const ModalModel& m) {
  std::string html = make_text(
      "Norms of the mass integrals of each mode by three methods, and their difference from the exact set.", "note");
  for (std::size_t method = 0; method < 3; ++method) {
    const auto& norm = m.integrals.norm[method];
    if (norm.size() == 0) continue;
    const bool is_exact = m.integrals.method[method] == "exact";
    std::vector<HtmlTable::Column> columns{{"mode"}};
    for (int k = 0; k < 5; ++k) {
      columns.push_back({fmt::format("|Γ{}|", k)});
      if (!is_exact) columns.push_back({"diff. %"});
    }
    HtmlTable table(m.integrals.method[method], columns);
    for (Eigen::Index j = 0; j < norm.rows(); ++j) {
      std::vector<std::string> row{std::to_string(j + 1)};
      for (Eigen::Index k = 0; k < 5; ++k) {
        row.push_back(format_value(norm(j, k), 5));
        if (!is_exact) row.push_back(format_percent(m.integrals.difference[method](j, k)));
      }
      table.add_row(std::move(row));
    }
    html += table.to_html(200);
  }
  if (m.integrals.captured.size() > 0) {
    HtmlTable table("Captured by the modes so far, % (exact set)",
                    {{"modes"}, {"m x"}, {"m y"}, {"m z"}, {"Jxx"}, {"Jyy"}, {"Jzz"}});
    for (Eigen::Index j = 0; j < m.integrals.captured.rows(); ++j) {
      std::vector<std::string> row{std::to_string(j + 1)};
      for (Eigen::Index k = 0; k < 6; ++k) row.push_back(format_percent(m.integrals.captured(j, k)));
      table.add_row(std::move(row));
    }
    html += table.to_html(200);
  }
  return html;
}

std::string make_spin(const ModalModel& m) {
  std::string html = make_text(
      "Frequencies in a frame that spins about an axis through the body's origin: geometric stiffness K_G1, spin "
      "softening "
      "and Coriolis terms of the integrals, about the undeformed body. The first modes; beside them once per turn.",
      "note");
  html += "<div class=\"live\" data-view=\"spin\">\n";
  for (const auto& curves : m.spin) {
    Plot plot{"Spin about " + curves.axis + (curves.has_stiffness ? "" : " (K_G1 not computed)"),
              "spin rate [1/T, radians]",
              "frequency [Hz]",
              {},
              0,
              0};
    const Eigen::Index max_shown = std::min<Eigen::Index>(curves.frequency_hz.cols(), 5);
    for (Eigen::Index k = 0; k < max_shown; ++k)
      plot.curves.push_back({fmt::format("mode {}", k + 1), curves.rate, curves.frequency_hz.col(k), false});
    if (max_shown > 0) plot.curves.push_back({"mode 1 without K_G", curves.rate, curves.without_hz.col(0), false});
    // Once a turn is Ω / 2π cycles; beyond the highest mode it would only squeeze the others.
    plot.curves.push_back({"1 per turn", curves.rate, curves.rate / 6.283185307179586, false});
    html += make_figure(plot);
    std::vector<HtmlTable::Column> columns{{"spin rate"}};
    for (Eigen::Index k = 0; k < max_shown; ++k) columns.push_back({fmt::format("mode {}", k + 1)});
    HtmlTable table("Frequencies [Hz], spin about " + curves.axis, columns);
    for (Eigen::Index r = 0; r < curves.rate.size(); r += 4) {
      std::vector<std::string> row{format_value(curves.rate[r])};
      for (Eigen::Index k = 0; k < max_shown; ++k) row.push_back(format_value(curves.frequency_hz(r, k), 7));
      table.add_row(std::move(row));
    }
    html += table.to_html();
  }
  html += "</div>\n";
  for (const auto& curves : m.spin) {
    const double step = curves.rate.size() > 1 ? curves.rate[1] - curves.rate[0] : 0;
    for (const auto& [from, to] : curves.diverges) {
      const bool is_open = to >= curves.rate[curves.rate.size() - 1];
      html +=
          make_text(fmt::format("About {} the body buckles or flutters at rates from {} {} {}{}.", curves.axis,
                                format_value(from, 5), is_open ? "up to the last one here," : "to", format_value(to, 5),
                                step > 0 ? fmt::format(" (looked at in steps of {})", format_value(step, 3)) : ""));
    }
  }
  return html;
}

/// Curves of the interactive view: a column for each mode.
nlohmann::json list_spin(const ModalModel& m) {
  auto list = nlohmann::json::array();
  for (const auto& curves : m.spin) {
    auto frequency = nlohmann::json::array(), without = nlohmann::json::array();
    for (Eigen::Index k = 0; k < curves.frequency_hz.cols(); ++k) {
      frequency.push_back(pack_doubles(curves.frequency_hz.col(k)));
      without.push_back(pack_doubles(curves.without_hz.col(k)));
    }
    list.push_back({{"axis", curves.axis},
                    {"has_stiffness", curves.has_stiffness},
                    {"rate", pack_doubles(curves.rate)},
                    {"frequency", std::move(frequency)},
                    {"without", std::move(without)}});
  }
  return list;
}

}  // namespace

std::string draw_heat_map(const std::string& title, const Eigen::MatrixXd& values, const std::string& row_label,
                          const std::string& column_label) {
  const Eigen::Index max_shown = 40, rows = std::min(max_shown, values.rows()),
                     cols = std::min(max_shown, values.cols());
  const double cell = std::max(10.0, std::min(34.0, 620.0 / static_cast<double>(std::max<Eigen::Index>(cols, 1))));
  const double left = 64, top = 44;
  const double heading = 8 + 7.2 * static_cast<double>(row_label.size() + column_label.size() + 25);
  const double width = std::max({300.0, heading, left + cell * static_cast<double>(cols) + 20}),
               height = top + cell * static_cast<double>(rows) + 34;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "role=\"img\" "
      "font-family=\"Helvetica, Arial, sans-serif\" font-size=\"12\"><title>{2}</title>\n<rect width=\"100%\" "
      "height=\"100%\" fill=\"#ffffff\"/>\n",
      width, height, escape_xml(title));
  svg += fmt::format("<text x=\"{}\" y=\"16\" fill=\"#111111\" font-size=\"13\">{} (across) against {} (down)</text>\n",
                     8, escape_xml(column_label), escape_xml(row_label));
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < cols; ++j) {
      const double v = values(i, j);
      const double shade = std::isfinite(v) ? std::min(1.0, std::max(0.0, v)) : 0;
      // White to dark blue, monotone in lightness: read without colour too.
      const auto mix = [&](double end) { return static_cast<int>(std::lround(255 + shade * (end - 255))); };
      svg += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#{:02x}{:02x}{:02x}\" "
          "stroke=\"#bbbbbb\" stroke-width=\"0.5\"><title>{} {}, {} {}: {}</title></rect>\n",
          left + cell * static_cast<double>(j), top + cell * static_cast<double>(i), cell, cell, mix(0), mix(50),
          mix(110), escape_xml(row_label), i + 1, escape_xml(column_label), j + 1, format_value(v, 4));
      if (cell >= 30 && std::isfinite(v))
        svg += fmt::format(
            "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" font-size=\"10\" fill=\"{}\">{:.2f}</text>\n",
            left + cell * (static_cast<double>(j) + 0.5), top + cell * (static_cast<double>(i) + 0.5) + 3.5,
            shade > 0.5 ? "#ffffff" : "#333333", v);
    }
  }
  const auto label = [&](double x, double y, const char* anchor, Eigen::Index k) {
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"#333333\">{}</text>\n", x, y, anchor,
                       k + 1);
  };
  const Eigen::Index every = cell < 16 ? 5 : 1;
  for (Eigen::Index i = 0; i < rows; ++i)
    if (every == 1 || (i + 1) % every == 0) label(left - 6, top + cell * (static_cast<double>(i) + 0.5) + 4, "end", i);
  for (Eigen::Index j = 0; j < cols; ++j)
    if (every == 1 || (j + 1) % every == 0) label(left + cell * (static_cast<double>(j) + 0.5), top - 8, "middle", j);
  svg += "</svg>\n";
  std::string html = "<figure>" + svg + "</figure>\n";
  if (rows < values.rows() || cols < values.cols())
    html += make_text(fmt::format("The first {} by {} of {} by {}.", rows, cols, values.rows(), values.cols()), "note");
  return html;
}

namespace {

std::string make_nodes(const ModalModel& m) {
  HtmlTable table("Undeformed, in the body frame", {{"node"}, {"x [L]"}, {"y [L]"}, {"z [L]"}, {"", true}});
  for (const auto& node : m.nodes)
    table.add_row({std::to_string(node.id), format_value(node.position.x()), format_value(node.position.y()),
                   format_value(node.position.z()), node.is_interface ? "interface" : ""});
  std::string loads;
  for (const auto& name : m.loads) loads += (loads.empty() ? "" : ", ") + name;
  return (loads.empty() ? "" : make_text("Load patterns: " + loads + ".")) +
         fmt::format("<details><summary>Output nodes ({})</summary>\n", m.nodes.size()) + table.to_html(200) +
         "</details>\n";
}

}  // namespace

Chapter make_chapter(const ModalModel& m) {
  Chapter chapter{m.kind, m.file, m.facts, m.checks, {}, {}, {}};
  if (!m.drawing.shapes.empty()) {
    std::vector<std::string> titles;
    for (Eigen::Index j = 0; j < m.frequency_hz.size(); ++j)
      titles.push_back(
          fmt::format("mode {}: {}{}", j + 1, format_value(m.frequency_hz[j], 5), m.is_buckling ? "" : " Hz"));
    std::string html = make_live("modes", draw_shapes(m.drawing, titles));
    if (m.drawing.energy.empty())
      html += make_text(m.kind == "modes" ? "Colours by strain energy come with bough modes --ese."
                                          : "Colours by strain energy come with bough reduce --strain-energy.",
                        "note");
    if (m.drawing.num_dropped > 0)
      html += make_text(fmt::format("To keep the page small it has the shapes of the first {} of {} modes.",
                                    m.drawing.shapes.size(), m.frequency_hz.size()),
                        "note");
    chapter.add_panel("shapes", "Mode shapes", html);
  }
  chapter.add_panel("mass", "Mass properties", make_mass_panel(m) + (m.nodes.empty() ? "" : make_nodes(m)));
  if (m.frequency_hz.size() > 0)
    chapter.add_panel("table", m.is_buckling ? "Load factors" : "Modes and effective mass",
                      (m.is_buckling ? "" : draw_effective_mass(m)) + make_mode_table(m));
  if (m.integrals.norm[0].size() + m.integrals.norm[1].size() + m.integrals.norm[2].size() > 0)
    chapter.add_panel("integrals", "Mass integrals by three methods", make_integrals(m));
  if (!m.spin.empty()) chapter.add_panel("spin", "Frequency against spin rate", make_spin(m));
  if (m.mac.size() > 0)
    chapter.add_panel("mac", "MAC",
                      make_text("Modal assurance criterion of the modes among themselves: what is dark beside the "
                                "diagonal, these nodes do not tell apart.",
                                "note") +
                          draw_heat_map("MAC", m.mac, "mode", "mode"));
  auto modes = nlohmann::json::array();
  for (Eigen::Index j = 0; j < m.frequency_hz.size(); ++j)
    modes.push_back(std::isfinite(m.frequency_hz[j]) ? nlohmann::json(m.frequency_hz[j]) : nlohmann::json());
  if (!m.drawing.shapes.empty())
    chapter.data = nlohmann::json{{"frequency", modes},
                                  {"kinds", m.mode_kind},
                                  {"buckling", m.is_buckling},
                                  {"spin", list_spin(m)},
                                  {"drawing", nlohmann::json::parse(to_json_text(m.drawing))}}
                       .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return chapter;
}

}  // namespace bough::report
