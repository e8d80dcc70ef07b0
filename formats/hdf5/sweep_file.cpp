#include "formats/hdf5/sweep_file.hpp"

#include <cmath>
#include <limits>

#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/detail/signals.hpp"
#include "formats/hdf5/detail/unit_attributes.hpp"
#include "formats/hdf5/detail/writer.hpp"

namespace bough::hdf5 {
namespace {

constexpr const char* kSweepFormat = "bough-sweep";
constexpr const char* kResponseFormat = "bough-response";
constexpr const char* kBudgetFormat = "bough-budget";
constexpr const char* kVersion = "1.0";

using Eigen::Index;
using Eigen::MatrixXd;
using records::LinearModel;

/// One matrix per point, one after the other in C order.
void write_stack(FileWriter& file, const std::string& path, const std::vector<LinearModel>& models,
                 MatrixXd LinearModel::*part) {
  const MatrixXd& first = models.front().*part;
  std::vector<double> data;
  for (const auto& model : models) {
    const MatrixXd& m = model.*part;
    for (Index i = 0; i < m.rows(); ++i) data.insert(data.end(), m.row(i).begin(), m.row(i).end());
  }
  file.write_numbers(path, {models.size(), static_cast<hsize_t>(first.rows()), static_cast<hsize_t>(first.cols())},
                     data.data());
}

void read_stack(FileReader& file, const std::string& path, std::vector<LinearModel>& models,
                MatrixXd LinearModel::*part, long rows, long cols) {
  const auto count = static_cast<long>(models.size());
  const NumberArray array = file.read_array(path, {count, rows, cols});
  const auto size = static_cast<std::size_t>(rows * cols);
  for (std::size_t k = 0; k < models.size(); ++k) {
    MatrixXd& m = models[k].*part;
    m.setZero(rows, cols);
    if (array.data.size() < size * models.size()) continue;
    for (Index i = 0; i < rows; ++i)
      for (Index j = 0; j < cols; ++j) m(i, j) = array.data[k * size + static_cast<std::size_t>(i * cols + j)];
  }
}

/// Infinite values are -1 in the file.
void write_random_outputs(FileWriter& file, const records::RandomOutputs& random) {
  const auto write = [&](const char* name, Eigen::VectorXd values) {
    for (double& value : values)
      if (!std::isfinite(value)) value = -1;
    if (values.size() > 0) file.write_vector(std::string("/random/") + name, values);
  };
  file.write_matrix("/random/psd", random.psd);
  file.write_matrix("/random/cumulative_rms", random.cumulative_rms);
  write("rms", random.rms);
  write("zero_crossings_hz", random.crossing_hz);
  write("band_rms", random.band_rms);
  write("band_zero_crossings_hz", random.band_crossing_hz);
  write("total_rms", random.total_rms);
  write("total_zero_crossings_hz", random.total_crossing_hz);
}

records::RandomOutputs read_random_outputs(FileReader& file, const records::FrequencyResponse& response) {
  records::RandomOutputs random;
  random.outputs = response.outputs;
  random.frequency_hz = response.frequency_hz;
  const Index count = response.frequency_hz.size(), ny = response.outputs.size();
  random.psd = file.read_matrix("/random/psd", count, ny);
  random.cumulative_rms = file.read_matrix("/random/cumulative_rms", count, ny);
  const auto read = [&](const char* name) {
    const std::string path = std::string("/random/") + name;
    if (!file.has(path)) return Eigen::VectorXd();
    Eigen::VectorXd values = file.read_vector(path, ny);
    for (double& value : values)
      if (value < 0) value = std::numeric_limits<double>::infinity();
    return values;
  };
  random.rms = read("rms");
  random.crossing_hz = read("zero_crossings_hz");
  random.band_rms = read("band_rms");
  random.band_crossing_hz = read("band_zero_crossings_hz");
  random.total_rms = read("total_rms");
  random.total_crossing_hz = read("total_zero_crossings_hz");
  return random;
}

}  // namespace

void write_sweep(const records::LinearSweep& sweep, const std::string& path) {
  FileWriter file(path, kSweepFormat, kVersion);
  file.write_source(sweep.source);
  write_unit_labels(file, sweep.models.front().units);
  file.write_strings("/parameter/name", {sweep.parameter});
  file.write_vector("/parameter/value", sweep.value);
  if (!sweep.grid_name.empty()) {
    const auto axes = sweep.grid_name.size();
    MatrixXd points(sweep.value.size(), static_cast<Index>(axes));
    for (Index k = 0; k < points.rows(); ++k)
      for (std::size_t i = 0; i < axes; ++i) points(k, static_cast<Index>(i)) = records::get_grid_value(sweep, k, i);
    file.write_strings("/grid/name", sweep.grid_name);
    for (std::size_t i = 0; i < axes; ++i) file.write_vector("/grid/axis" + std::to_string(i + 1), sweep.grid_value[i]);
    file.write_matrix("/grid/points", points);
  }
  const auto& first = sweep.models.front();
  write_signals(file, "/states", first.states);
  write_signals(file, "/inputs", first.inputs);
  write_signals(file, "/outputs", first.outputs);
  const bool is_sampled = first.sample_time > 0;
  file.set_text("equation", is_sampled ? "x+ = A x + B u" : "x_dot = A x + B u");
  write_stack(file, "/A", sweep.models, &LinearModel::A);
  write_stack(file, "/B", sweep.models, &LinearModel::B);
  write_stack(file, "/C", sweep.models, &LinearModel::C);
  write_stack(file, "/D", sweep.models, &LinearModel::D);
  const auto np = static_cast<Index>(sweep.models.size());
  MatrixXd q(np, first.q.size()), u(np, first.u.size());
  Eigen::VectorXd time(np), residual(np), sample_time(np);
  for (Index k = 0; k < np; ++k) {
    const auto& model = sweep.models[static_cast<std::size_t>(k)];
    q.row(k) = model.q.transpose();
    u.row(k) = model.u.transpose();
    time[k] = model.time;
    residual[k] = model.residual;
    sample_time[k] = model.sample_time;
  }
  if (is_sampled) file.write_vector("/sample_time", sample_time);
  file.write_vector("/operating_point/time", time);
  file.write_matrix("/operating_point/q", q);
  file.write_matrix("/operating_point/u", u);
  file.write_vector("/operating_point/residual", residual);
  write_signals(file, "/operating_point/positions", first.q_names);
  write_signals(file, "/operating_point/speeds", first.u_names);
  file.write_matrix("/poles/real", sweep.real);
  file.write_matrix("/poles/imag", sweep.imag);
  file.write_matrix("/poles/frequency_hz", sweep.frequency_hz);
  file.write_matrix("/poles/damping", sweep.damping);
  file.write_matrix("/poles/correlation", sweep.correlation);
  std::vector<std::string> over_parameter{"/A",
                                          "/B",
                                          "/C",
                                          "/D",
                                          "/operating_point/time",
                                          "/operating_point/q",
                                          "/operating_point/u",
                                          "/operating_point/residual",
                                          "/poles/real",
                                          "/poles/imag",
                                          "/poles/frequency_hz",
                                          "/poles/damping",
                                          "/poles/correlation"};
  if (sweep.whirl.size() > 0) {
    file.write_matrix("/poles/whirl", sweep.whirl);
    over_parameter.emplace_back("/poles/whirl");
  }
  file.attach_scale("/parameter/value", over_parameter);
  std::vector<std::string> start, end;
  if (!sweep.mode.empty()) start = sweep.mode.front(), end = sweep.mode.back();
  file.write_strings("/poles/mode_first", start);
  file.write_strings("/poles/mode_last", end);
  file.commit();
}

records::LinearSweep read_sweep(const std::string& path) {
  FileReader file(path, kSweepFormat, kVersion);
  records::LinearSweep sweep;
  sweep.source = file.read_source();
  const auto names = file.read_strings("/parameter/name", 1);
  sweep.parameter = names.empty() ? "" : names.front();
  sweep.value = file.read_vector("/parameter/value", -1);
  const long np = sweep.value.size();
  if (file.has("/grid")) {
    sweep.grid_name = file.read_strings("/grid/name", -1);
    long count = 1;
    for (std::size_t i = 0; i < sweep.grid_name.size(); ++i) {
      sweep.grid_value.push_back(file.read_vector("/grid/axis" + std::to_string(i + 1), -1));
      count *= std::max<long>(1, sweep.grid_value.back().size());
    }
    if (count != np) sweep.grid_name.clear(), sweep.grid_value.clear();
  }
  LinearModel first;
  first.units = read_unit_labels(file);
  first.states = read_signals(file, "/states");
  first.inputs = read_signals(file, "/inputs");
  first.outputs = read_signals(file, "/outputs");
  const long nx = first.states.size(), nu = first.inputs.size(), ny = first.outputs.size();
  sweep.models.assign(static_cast<std::size_t>(np), first);
  read_stack(file, "/A", sweep.models, &LinearModel::A, nx, nx);
  read_stack(file, "/B", sweep.models, &LinearModel::B, nx, nu);
  read_stack(file, "/C", sweep.models, &LinearModel::C, ny, nx);
  read_stack(file, "/D", sweep.models, &LinearModel::D, ny, nu);
  sweep.real = file.read_matrix("/poles/real", np, nx);
  sweep.imag = file.read_matrix("/poles/imag", np, nx);
  sweep.frequency_hz = file.read_matrix("/poles/frequency_hz", np, nx);
  sweep.damping = file.read_matrix("/poles/damping", np, nx);
  sweep.correlation = file.read_matrix("/poles/correlation", np, nx);
  if (file.has("/poles/whirl")) sweep.whirl = file.read_matrix("/poles/whirl", np, nx);
  const auto start = file.read_strings("/poles/mode_first", nx), end = file.read_strings("/poles/mode_last", nx);
  if (file.has("/sample_time")) {
    const auto sample_time = file.read_vector("/sample_time", np);
    for (long k = 0; k < sample_time.size(); ++k)
      sweep.models[static_cast<std::size_t>(k)].sample_time = sample_time[k];
  }
  file.throw_if_errors();
  sweep.mode.assign(static_cast<std::size_t>(np), start);
  if (np > 1) sweep.mode.back() = end;
  return sweep;
}

void write_response(const records::FrequencyResponse& response, const records::PeakGain& peak,
                    const records::Margins* margins, const records::RandomOutputs* random, const std::string& path) {
  FileWriter file(path, kResponseFormat, kVersion);
  file.write_source(response.source);
  write_unit_labels(file, response.units);
  write_signals(file, "/inputs", response.inputs);
  write_signals(file, "/outputs", response.outputs);
  file.write_vector("/frequency_hz", response.frequency_hz);
  std::vector<double> real, imag;
  for (const auto& value : response.value)
    for (Index i = 0; i < value.rows(); ++i)
      for (Index j = 0; j < value.cols(); ++j) {
        real.push_back(value(i, j).real());
        imag.push_back(value(i, j).imag());
      }
  const Dims shape{response.value.size(), static_cast<hsize_t>(response.outputs.size()),
                   static_cast<hsize_t>(response.inputs.size())};
  file.write_numbers("/real", shape, real.data());
  file.write_numbers("/imag", shape, imag.data());
  file.write_matrix("/singular_values", response.singular_values);
  file.write_number("/peak/value", peak.is_finite ? peak.value : -1);
  file.write_number("/peak/frequency_hz", std::isfinite(peak.frequency_hz) ? peak.frequency_hz : -1);
  if (margins) {
    const auto write = [&](const std::string& group, const std::vector<records::Crossing>& crossings, bool is_phase) {
      Eigen::VectorXd frequency(static_cast<Index>(crossings.size())), margin = frequency, delay = frequency;
      for (Index k = 0; k < frequency.size(); ++k) {
        const auto& c = crossings[static_cast<std::size_t>(k)];
        frequency[k] = c.frequency_hz, margin[k] = c.margin, delay[k] = c.delay;
      }
      file.write_vector(group + "/frequency_hz", frequency);
      file.write_vector(group + "/margin", margin);
      if (is_phase) file.write_vector(group + "/delay", delay);
    };
    write("/margins/gain", margins->gain, false);
    write("/margins/phase", margins->phase, true);
    file.write_number("/margins/distance", margins->distance);
    file.write_number("/margins/distance_hz", margins->distance_hz);
    file.write_number("/margins/largest_real", margins->largest_real);
  }
  std::vector<std::string> over_frequency{"/real", "/imag", "/singular_values"};
  if (random) {
    write_random_outputs(file, *random);
    over_frequency.insert(over_frequency.end(), {"/random/psd", "/random/cumulative_rms"});
  }
  file.attach_scale("/frequency_hz", over_frequency);
  file.commit();
}

ResponseOfModel read_model_response(const std::string& path) {
  FileReader file(path, kResponseFormat, kVersion);
  ResponseOfModel found;
  auto& response = found.response;
  response.source = file.read_source();
  response.units = read_unit_labels(file);
  response.inputs = read_signals(file, "/inputs");
  response.outputs = read_signals(file, "/outputs");
  response.frequency_hz = file.read_vector("/frequency_hz", -1);
  const Index count = response.frequency_hz.size(), ny = response.outputs.size(), nu = response.inputs.size();
  const auto real = file.read_array("/real", {count, ny, nu}), imag = file.read_array("/imag", {count, ny, nu});
  response.singular_values = file.read_matrix("/singular_values", count, std::min(ny, nu));
  found.peak.value = file.read_number("/peak/value");
  found.peak.frequency_hz = file.read_number("/peak/frequency_hz");
  found.peak.is_finite = found.peak.value >= 0;
  if (file.has("/margins")) {
    found.has_margins = true;
    const auto read = [&](const std::string& group, std::vector<records::Crossing>& crossings, bool is_phase) {
      const auto frequency = file.read_vector(group + "/frequency_hz", -1);
      const auto margin = file.read_vector(group + "/margin", frequency.size());
      const Eigen::VectorXd delay = is_phase ? file.read_vector(group + "/delay", frequency.size())
                                             : Eigen::VectorXd(Eigen::VectorXd::Zero(frequency.size()));
      for (Index k = 0; k < frequency.size(); ++k) crossings.push_back({frequency[k], margin[k], delay[k]});
    };
    read("/margins/gain", found.margins.gain, false);
    read("/margins/phase", found.margins.phase, true);
    found.margins.distance = file.read_number("/margins/distance");
    found.margins.distance_hz = file.read_number("/margins/distance_hz");
    found.margins.largest_real = file.read_number("/margins/largest_real");
    found.margins.is_stable = found.margins.largest_real <= 0;
  }
  if (file.has("/random")) {
    found.has_random = true;
    found.random = read_random_outputs(file, response);
  }
  file.throw_if_errors();
  const auto size = static_cast<std::size_t>(ny * nu);
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    Eigen::MatrixXcd value(ny, nu);
    for (Index i = 0; i < ny; ++i)
      for (Index j = 0; j < nu; ++j) {
        const auto at = k * size + static_cast<std::size_t>(i * nu + j);
        value(i, j) = {real.data[at], imag.data[at]};
      }
    response.value.push_back(std::move(value));
  }
  return found;
}

void write_budget(const records::PointingBudget& budget, const std::string& path) {
  FileWriter file(path, kBudgetFormat, kVersion);
  file.write_source(budget.source);
  write_signals(file, "/outputs", budget.outputs);
  file.write_strings("/sources/name", budget.sources);
  file.write_vector("/band_hz", Eigen::Vector2d(budget.from_hz, budget.to_hz));
  const auto nt = static_cast<Index>(budget.tables.size()), ns = static_cast<Index>(budget.sources.size());
  const Index ny = budget.outputs.size();
  std::vector<std::string> weighting;
  Eigen::VectorXd exposure(nt);
  MatrixXd total(nt, ny);
  std::vector<double> rms, speed;
  for (Index k = 0; k < nt; ++k) {
    const auto& table = budget.tables[static_cast<std::size_t>(k)];
    weighting.push_back(table.weighting);
    exposure[k] = table.exposure;
    total.row(k) = table.total.transpose();
    for (Index s = 0; s < ns; ++s) {
      rms.insert(rms.end(), table.rms.row(s).begin(), table.rms.row(s).end());
      speed.insert(speed.end(), table.speed.row(s).begin(), table.speed.row(s).end());
    }
  }
  const Dims shape{static_cast<hsize_t>(nt), static_cast<hsize_t>(ns), static_cast<hsize_t>(ny)};
  file.write_strings("/tables/weighting", weighting);
  file.write_vector("/tables/exposure", exposure);
  file.write_numbers("/tables/rms", shape, rms.data());
  file.write_numbers("/tables/speed", shape, speed.data());
  file.write_matrix("/tables/total", total);
  for (Index s = 0; s < ns; ++s) {
    const auto number = static_cast<std::size_t>(s);
    const std::string of = "/" + std::to_string(s + 1);
    const auto& curve = budget.curves[number];
    if (curve.rms.rows() > 0) {
      file.write_matrix("/curves" + of + "/frequency_hz", curve.frequency_hz);
      file.write_matrix("/curves" + of + "/rms", curve.rms);
    }
    const auto& speeds = budget.speed[number];
    if (speeds.size() == 0) continue;
    file.write_vector("/wheels" + of + "/speed", speeds);
    std::vector<double> over_speed;
    for (const auto& table : budget.tables)
      for (const auto& row : table.over_speed[number].rowwise())
        over_speed.insert(over_speed.end(), row.begin(), row.end());
    file.write_numbers("/wheels" + of + "/rms",
                       {static_cast<hsize_t>(nt), static_cast<hsize_t>(speeds.size()), static_cast<hsize_t>(ny)},
                       over_speed.data());
  }
  file.commit();
}

records::PointingBudget read_budget(const std::string& path) {
  FileReader file(path, kBudgetFormat, kVersion);
  records::PointingBudget budget;
  budget.source = file.read_source();
  budget.outputs = read_signals(file, "/outputs");
  budget.sources = file.read_strings("/sources/name", -1);
  const auto band = file.read_vector("/band_hz", 2);
  const auto weighting = file.read_strings("/tables/weighting", -1);
  const long nt = std::ssize(weighting), ns = std::ssize(budget.sources), ny = budget.outputs.size();
  const auto exposure = file.read_vector("/tables/exposure", nt);
  const auto rms = file.read_array("/tables/rms", {nt, ns, ny});
  const auto speed = file.read_array("/tables/speed", {nt, ns, ny}, true);
  const auto total = file.read_matrix("/tables/total", nt, ny);
  file.throw_if_errors();
  budget.from_hz = band[0];
  budget.to_hz = band[1];
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto slice = [](const NumberArray& array, long k, long rows, long cols) {
    return MatrixXd(Eigen::Map<const Rows>(array.data.data() + k * rows * cols, rows, cols));
  };
  for (long k = 0; k < nt; ++k) {
    records::BudgetTable table;
    table.weighting = weighting[static_cast<std::size_t>(k)];
    table.exposure = exposure[k];
    table.rms = slice(rms, k, ns, ny);
    table.speed = slice(speed, k, ns, ny);
    table.total = total.row(k).transpose();
    table.over_speed.resize(budget.sources.size());
    budget.tables.push_back(std::move(table));
  }
  budget.curves.resize(budget.sources.size());
  budget.speed.resize(budget.sources.size());
  for (long s = 0; s < ns; ++s) {
    const auto number = static_cast<std::size_t>(s);
    const std::string of = "/" + std::to_string(s + 1);
    if (file.has("/curves" + of)) {
      auto& curve = budget.curves[number];
      curve.frequency_hz = file.read_matrix("/curves" + of + "/frequency_hz", -1, ny);
      curve.rms = file.read_matrix("/curves" + of + "/rms", curve.frequency_hz.rows(), ny);
    }
    if (!file.has("/wheels" + of)) continue;
    budget.speed[number] = file.read_vector("/wheels" + of + "/speed", -1);
    const long num_speeds = budget.speed[number].size();
    const auto over_speed = file.read_array("/wheels" + of + "/rms", {nt, num_speeds, ny});
    file.throw_if_errors();
    for (long k = 0; k < nt; ++k)
      budget.tables[static_cast<std::size_t>(k)].over_speed[number] = slice(over_speed, k, num_speeds, ny);
  }
  file.throw_if_errors();
  return budget;
}

}  // namespace bough::hdf5
