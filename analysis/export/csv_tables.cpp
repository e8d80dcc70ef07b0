#include "analysis/export/csv_tables.hpp"

#include <fmt/format.h>

#include <sstream>

#include "formats/export/csv.hpp"

namespace bough::analysis {

using records::LinearModel;
using records::LinearSweep;

namespace {

std::string quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::string make_response_csv(const records::FrequencyResponse& response) {
  std::vector<exports::CsvColumn> columns{{"frequency_hz", response.frequency_hz}};
  const Eigen::Index count = response.frequency_hz.size();
  for (int j = 0; j < response.inputs.size(); ++j)
    for (int i = 0; i < response.outputs.size(); ++i) {
      const std::string name =
          response.outputs.name[static_cast<std::size_t>(i)] + "/" + response.inputs.name[static_cast<std::size_t>(j)];
      Eigen::VectorXd real(count), imag(count);
      for (Eigen::Index k = 0; k < count; ++k) {
        const auto h = response.value[static_cast<std::size_t>(k)](i, j);
        real[k] = h.real(), imag[k] = h.imag();
      }
      columns.push_back({name + ":real", std::move(real)});
      columns.push_back({name + ":imag", std::move(imag)});
    }
  for (Eigen::Index s = 0; s < response.singular_values.cols(); ++s)
    columns.push_back({"sigma" + std::to_string(s + 1), response.singular_values.col(s)});
  std::ostringstream text;
  exports::write_csv(text, columns);
  return text.str();
}

std::string make_random_csv(const records::RandomOutputs& random) {
  std::vector<exports::CsvColumn> columns{{"frequency_hz", random.frequency_hz}};
  for (int i = 0; i < random.outputs.size(); ++i) {
    const auto& name = random.outputs.name[static_cast<std::size_t>(i)];
    columns.push_back({name + ":psd", random.psd.col(i)});
    columns.push_back({name + ":cumulative_rms", random.cumulative_rms.col(i)});
  }
  std::ostringstream text;
  exports::write_csv(text, columns);
  return text.str();
}

std::string make_linear_csv(const LinearModel& model) {
  const auto quote = [](const std::string& name) {
    return name.find_first_of(",\"") == std::string::npos ? name : "\"" + name + "\"";
  };
  std::string text = "row";
  for (const auto* signals : {&model.states, &model.inputs})
    for (const auto& name : signals->name) text += "," + quote(name);
  text += "\n";
  const auto add = [&](const std::string& name, const Eigen::RowVectorXd& left, const Eigen::RowVectorXd& right) {
    text += name;
    for (const double v : left) text += fmt::format(",{:.17g}", v);
    for (const double v : right) text += fmt::format(",{:.17g}", v);
    text += "\n";
  };
  for (int i = 0; i < model.states.size(); ++i)
    add((model.sample_time > 0 ? "next " : "d/dt ") + quote(model.states.name[static_cast<std::size_t>(i)]),
        model.A.row(i), model.B.row(i));
  for (int i = 0; i < model.outputs.size(); ++i)
    add(quote(model.outputs.name[static_cast<std::size_t>(i)]), model.C.row(i), model.D.row(i));
  return text;
}

std::string make_sweep_csv(const LinearSweep& sweep) {
  std::vector<exports::CsvColumn> columns{{sweep.parameter, sweep.value}};
  for (std::size_t i = 0; i < sweep.grid_name.size(); ++i) {
    Eigen::VectorXd values(sweep.value.size());
    for (Eigen::Index k = 0; k < values.size(); ++k) values[k] = records::get_grid_value(sweep, k, i);
    columns.push_back({sweep.grid_name[i], values});
  }
  for (Eigen::Index b = 0; b < sweep.real.cols(); ++b) {
    const std::string name = std::to_string(b + 1) + " " + sweep.mode.front()[static_cast<std::size_t>(b)];
    columns.push_back({name + ":real", sweep.real.col(b)});
    columns.push_back({name + ":imag", sweep.imag.col(b)});
    columns.push_back({name + ":frequency_hz", sweep.frequency_hz.col(b)});
    columns.push_back({name + ":damping", sweep.damping.col(b)});
  }
  std::ostringstream text;
  exports::write_csv(text, columns);
  return text.str();
}

std::string make_events_csv(const std::vector<records::EventRecord>& events) {
  std::string text = "time,what,source\n";
  for (const auto& e : events) text += fmt::format("{:.17g},{},{}\n", e.time, quote(e.what), quote(e.source));
  return text;
}

}  // namespace bough::analysis
