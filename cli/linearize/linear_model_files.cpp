#include "cli/linearize/linear_model_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "cli/common/console.hpp"
#include "formats/records/unit_names.hpp"
#include "solver/statespace/hankel.hpp"

namespace bough::cli {

using records::LinearModel;

namespace {

/// Rounding of a value that is zero reads as zero.
std::string format_number(double value, double scale) {
  return value == 0 || std::abs(value) < 1e-12 * scale ? "0" : fmt::format("{:.6g}", value);
}

/// Heading of a column of frequencies.
std::string name_frequency(const LinearModel& model) {
  return "frequency " + records::name_frequency_unit(model.units.time);
}

std::vector<double> to_list(const Eigen::VectorXd& v) { return {v.begin(), v.end()}; }

nlohmann::json to_rows(const Eigen::MatrixXd& m) {
  auto rows = nlohmann::json::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i) rows.push_back(m.cols() > 0 ? to_list(m.row(i)) : std::vector<double>());
  return rows;
}

}  // namespace

std::string format_hankel(const records::Hankel& hankel) {
  if (hankel.value.size() == 0) return "";
  std::string text = "\nHankel singular values:";
  const Eigen::Index shown = std::min<Eigen::Index>(hankel.value.size(), 12);
  for (Eigen::Index i = 0; i < shown; ++i) text += fmt::format(" {:.4g}", hankel.value[i]);
  if (shown < hankel.value.size()) text += fmt::format(" ... ({})", hankel.value.size());
  text += "\n";
  if (hankel.num_left_out > 0)
    text += fmt::format("of the stable part; left out: {} that {}\n",
                        count(static_cast<std::size_t>(hankel.num_left_out), "pole"),
                        hankel.num_left_out == 1 ? "does not" : "do not");
  return text;
}

namespace {

std::string format_operating_point(const LinearModel& model) {
  if (model.q_names.size() == 0) return "";
  Table table{{"coordinate", "position", "speed", model.units.empty() ? "dims" : "unit", ""}, {}};
  const auto is_in = [](const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  std::size_t num_zero = 0;
  for (int i = 0; i < model.q_names.size(); ++i) {
    const auto& name = model.q_names.name[static_cast<std::size_t>(i)];
    const auto& speeds = model.u_names.name;
    const auto speed = std::find(speeds.begin(), speeds.end(), name);
    const double rate = speed == speeds.end() ? 0 : model.u[speed - speeds.begin()];
    if (model.q[i] == 0 && rate == 0 && name.find(":eta") != std::string::npos) {
      ++num_zero;
      continue;
    }
    table.rows.push_back({name, fmt::format("{:.6g}", model.q[i]),
                          speed == speeds.end() ? "-" : fmt::format("{:.6g}", rate),
                          records::label_dims(model.q_names.dims[static_cast<std::size_t>(i)], model.units),
                          !is_in(model.periodic, name) ? ""
                          : std::abs(rate) > 1e-8      ? "periodic, turns"
                                                       : "periodic"});
  }
  for (int i = 0; i < model.u_names.size(); ++i) {  // rates that are no coordinate's
    const auto& name = model.u_names.name[static_cast<std::size_t>(i)];
    if (!is_in(model.q_names.name, name))
      table.rows.push_back({name, "-", fmt::format("{:.6g}", model.u[i]),
                            records::label_dims(model.u_names.dims[static_cast<std::size_t>(i)], model.units), ""});
  }
  std::string text = table.rows.empty() ? "" : table.to_text();
  if (num_zero > 0) text += fmt::format("{} at rest at 0\n", count(num_zero, "modal coordinate"));
  return text + "\n";
}

/// Beside the coordinate that takes part most: the mode of a body or the hinge that does.
std::string name_partner(const records::Poles& poles, std::size_t i) {
  if (i >= poles.hinge.size()) return "";
  const auto& mode = poles.mode[i];
  if (mode == poles.hinge[i]) return poles.body_mode[i];
  if (mode == poles.body_mode[i]) return poles.hinge[i];
  return poles.hinge[i] + (poles.hinge[i].empty() || poles.body_mode[i].empty() ? "" : ", ") + poles.body_mode[i];
}

std::string format_multipliers(const LinearModel& model) {
  const auto& m = model.multipliers;
  if (m.period == 0) return "";
  std::string text = fmt::format("\nmultipliers of a period of the samples, {:g} ({})\n", m.period,
                                 count(static_cast<std::size_t>(m.num_samples), "instant"));
  Table table{
      {"real", "imag", "size", "decay " + records::label_dims("1/T", model.units), name_frequency(model), "mode"}, {}};
  std::size_t num_small = 0;
  for (Eigen::Index i = 0; i < m.real.size(); ++i) {
    const double size = std::hypot(m.real[i], m.imag[i]);
    if (size < 1e-9) ++num_small;
    if (size < 1e-9 || m.imag[i] < 0) continue;
    table.rows.push_back({format_number(m.real[i], 1), m.imag[i] > 0 ? "±" + format_number(m.imag[i], 1) : "0",
                          fmt::format("{:.6g}", size), fmt::format("{:.5g}", m.decay[i]),
                          fmt::format("{:.5g}", m.frequency_hz[i]), m.mode[static_cast<std::size_t>(i)]});
  }
  text += table.to_text();
  if (num_small > 0) text += fmt::format("and {} at 0: gone within a period\n", num_small);
  return text + "frequencies up to multiples of 1 over the period\n";
}

}  // namespace

/// Poles that the errors of A hide: those of free motion, or soft ones of a very stiff system.
static std::string format_lost_poles(const records::Poles& poles) {
  std::string numbers;
  double max_error = 0;
  for (int i = 0; i < static_cast<int>(poles.error.size()); ++i) {
    const double size = std::hypot(poles.real[i], poles.imag[i]);
    if (poles.error[i] == 0 || size > poles.error[i]) continue;
    numbers += " " + std::to_string(i + 1);
    max_error = std::max(max_error, poles.error[i]);
  }
  return numbers.empty() ? "" : fmt::format("\nzero within what A is known to ({:.1e}): pole{}\n", max_error, numbers);
}

/// Poles at z = 0, and modes that the samples show at another frequency.
static std::string format_sampling(const LinearModel& model) {
  std::size_t num_gone = 0;
  for (int i = 0; i < model.poles.size(); ++i) num_gone += records::is_gone(model, i) ? 1 : 0;
  std::string text =
      num_gone > 0 ? fmt::format("and {} at z = 0: gone within a sample\n", count(num_gone, "pole")) : "";
  if (model.aliased.empty()) return text;
  const auto unit = records::name_frequency_unit(model.units.time);
  text += fmt::format("\naliased, above the Nyquist frequency {:.6g} {}\n", 0.5 / model.sample_time, unit);
  Table table{{"mode", name_frequency(model), "appears at " + unit}, {}};
  for (const auto& one : model.aliased)
    table.rows.push_back({one.mode, fmt::format("{:.6g}", one.frequency_hz), fmt::format("{:.6g}", one.appears_at_hz)});
  return text + table.to_text();
}

static std::string format_uncertainty(const LinearModel& model) {
  if (model.uncertainty.empty()) return "";
  Table table{{"uncertain parameter", "delta = -1", "delta = 1", "inputs w, outputs z"}, {}};
  for (const auto& one : model.uncertainty)
    table.rows.push_back(
        {one.name, fmt::format("{:g}", one.low), fmt::format("{:g}", one.high), std::to_string(one.size)});
  return "\nw = delta z, the poles are those of delta = 0\n" + table.to_text();
}

std::string format_linear_model(const LinearModel& model) {
  std::string text = fmt::format(
      "{} states, {} inputs, {} outputs at t = {:g}, |u_dot| {:.1e}\n"
      "by differences: error {:.1e}, another step differs by {:.1e}; columns of forces in B and D are exact\n\n",
      model.states.size(), model.inputs.size(), model.outputs.size(), model.time, model.residual, model.error,
      model.difference);
  if (model.sample_time > 0)
    text += fmt::format("from sample to sample, every {:g}: x+ = A x + B u; of a pole z there is ln z / {:g}\n\n",
                        model.sample_time, model.sample_time);
  if (model.sample_time > 0 && model.inputs.size() > 1)
    text += fmt::format("lifted: {} values at the cut in that time, {} to {}\n\n", model.inputs.size(),
                        model.inputs.name.front(), model.inputs.name.back());
  text += format_operating_point(model);
  Table table{{"pole", "real", "imag", name_frequency(model), "damping", "mode", "with"}, {}};
  const auto& poles = model.poles;
  const double scale = poles.size() > 0 ? poles.frequency_hz.maxCoeff() * 6.28 : 0;
  for (int i = 0; i < poles.size(); ++i) {
    if (poles.imag[i] < 0 || records::is_gone(model, i)) continue;  // its conjugate is listed; gone ones are counted
    table.rows.push_back({std::to_string(i + 1), format_number(poles.real[i], scale),
                          poles.imag[i] > 0 ? "±" + format_number(poles.imag[i], scale) : "0",
                          format_number(poles.frequency_hz[i], scale), format_number(poles.damping[i], 1),
                          poles.mode[static_cast<std::size_t>(i)], name_partner(poles, static_cast<std::size_t>(i))});
  }
  if (!table.rows.empty()) text += table.to_text() + format_lost_poles(poles);
  text += format_sampling(model);
  const std::string tail = format_uncertainty(model) + format_multipliers(model) + format_hankel(model.hankel);
  if (!model.has_zeros) return text + tail;
  text += model.zeros_real.size() == 0 ? "\nno finite zeros\n" : "\nzeros\n";
  for (Eigen::Index i = 0; i < model.zeros_real.size(); ++i) {
    if (model.zeros_imag[i] < 0) continue;
    text += fmt::format("  {:.6g}{}\n", model.zeros_real[i],
                        model.zeros_imag[i] > 0 ? fmt::format(" ± {:.6g} i", model.zeros_imag[i]) : "");
  }
  return text + tail;
}

nlohmann::json make_json(const LinearModel& model) {
  nlohmann::json json{
      {"states", model.states.name},
      {"inputs", model.inputs.name},
      {"outputs", model.outputs.name},
      {"A", to_rows(model.A)},
      {"B", to_rows(model.B)},
      {"C", to_rows(model.C)},
      {"D", to_rows(model.D)},
      {"operating_point",
       {{"time", model.time}, {"q", to_list(model.q)}, {"u", to_list(model.u)}, {"residual", model.residual}}},
      {"error", model.error},
      {"difference", model.difference},
      {"poles",
       {{"real", to_list(model.poles.real)},
        {"imag", to_list(model.poles.imag)},
        {"frequency_hz", to_list(model.poles.frequency_hz)},
        {"damping", to_list(model.poles.damping)},
        {"error", to_list(model.poles.error)},
        {"mode", model.poles.mode},
        {"body_mode", model.poles.body_mode},
        {"hinge", model.poles.hinge}}}};
  if (model.sample_time > 0) {
    json["sample_time"] = model.sample_time;
    json["aliased"] = nlohmann::json::array();
    for (const auto& one : model.aliased)
      json["aliased"].push_back(
          {{"mode", one.mode}, {"frequency_hz", one.frequency_hz}, {"appears_at_hz", one.appears_at_hz}});
  }
  if (const auto second = records::make_second_order(model); second.M.size() > 0)
    json["second_order"] = {
        {"M", to_rows(second.M)}, {"D", to_rows(second.D)}, {"K", to_rows(second.K)}, {"F", to_rows(second.F)}};
  if (json.contains("second_order") && model.A.rows() > 2 * model.mass.rows())
    json["second_order"]["Z"] = to_rows(records::make_second_order(model).Z);
  json["operating_point"]["q_name"] = model.q_names.name;
  json["operating_point"]["q_dims"] = model.q_names.dims;
  json["operating_point"]["u_name"] = model.u_names.name;
  json["operating_point"]["u_dims"] = model.u_names.dims;
  json["operating_point"]["periodic"] = model.periodic;
  if (model.multipliers.period > 0)
    json["multipliers"] = {{"period", model.multipliers.period},
                           {"real", to_list(model.multipliers.real)},
                           {"imag", to_list(model.multipliers.imag)},
                           {"mode", model.multipliers.mode}};
  for (const auto& one : model.uncertainty)
    json["uncertainty"].push_back({{"name", one.name}, {"low", one.low}, {"high", one.high}, {"size", one.size}});
  json["hankel"] = {{"value", to_list(model.hankel.value)}, {"left_out", model.hankel.num_left_out}};
  if (model.has_zeros) json["zeros"] = {{"real", to_list(model.zeros_real)}, {"imag", to_list(model.zeros_imag)}};
  return json;
}

}  // namespace bough::cli
