#include "cli/linearize/linear_model_files.hpp"

#include <fmt/format.h>

#include "cli/common/console.hpp"
#include "formats/matrices/mat_file.hpp"

namespace bough::cli {

using records::LinearModel;

namespace {

matrices::MatCells make_cells(const std::vector<std::string>& words) { return {words.begin(), words.end()}; }

/// Rounding of a value that is zero reads as zero.
std::string format_number(double value, double scale) {
  return std::abs(value) < 1e-12 * scale ? "0" : fmt::format("{:.6g}", value);
}

std::vector<double> to_list(const Eigen::VectorXd& v) { return {v.begin(), v.end()}; }

nlohmann::json to_rows(const Eigen::MatrixXd& m) {
  auto rows = nlohmann::json::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i) rows.push_back(to_list(m.row(i)));
  return rows;
}

}  // namespace

void write_linear_mat(const LinearModel& model, const std::string& path) {
  matrices::write_mat(path, {{"A", model.A},
                             {"B", model.B},
                             {"C", model.C},
                             {"D", model.D},
                             {"state_name", make_cells(model.states.name)},
                             {"input_name", make_cells(model.inputs.name)},
                             {"output_name", make_cells(model.outputs.name)}});
}

std::string format_linear_model(const LinearModel& model) {
  std::string text = fmt::format(
      "{} states, {} inputs, {} outputs at t = {:g}, |u_dot| {:.1e}\n"
      "A, C by differences: error {:.1e}, another step differs by {:.1e}; B, D exact\n\n",
      model.states.size(), model.inputs.size(), model.outputs.size(), model.time, model.residual, model.error,
      model.difference);
  Table table{{"pole", "real", "imag", "frequency Hz", "damping", "mode"}, {}};
  const auto& poles = model.poles;
  const double scale = poles.size() > 0 ? poles.frequency_hz.maxCoeff() * 6.28 : 0;
  for (int i = 0; i < poles.size(); ++i) {
    if (poles.imag[i] < 0) continue;  // told by its partner
    table.rows.push_back({std::to_string(i + 1), format_number(poles.real[i], scale),
                          poles.imag[i] > 0 ? "±" + format_number(poles.imag[i], scale) : "0",
                          format_number(poles.frequency_hz[i], scale), format_number(poles.damping[i], 1),
                          poles.mode[static_cast<std::size_t>(i)]});
  }
  if (!table.rows.empty()) text += table.to_text();
  if (!model.has_zeros) return text;
  text += model.zeros_real.size() == 0 ? "\nno finite zeros\n" : "\nzeros\n";
  for (Eigen::Index i = 0; i < model.zeros_real.size(); ++i) {
    if (model.zeros_imag[i] < 0) continue;
    text += fmt::format("  {:.6g}{}\n", model.zeros_real[i],
                        model.zeros_imag[i] > 0 ? fmt::format(" ± {:.6g} i", model.zeros_imag[i]) : "");
  }
  return text;
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
        {"mode", model.poles.mode}}}};
  if (model.has_zeros) json["zeros"] = {{"real", to_list(model.zeros_real)}, {"imag", to_list(model.zeros_imag)}};
  return json;
}

}  // namespace bough::cli
