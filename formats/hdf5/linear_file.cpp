#include "formats/hdf5/linear_file.hpp"

#include "formats/hdf5/detail/columns.hpp"
#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/detail/signals.hpp"
#include "formats/hdf5/detail/unit_attributes.hpp"
#include "formats/hdf5/detail/writer.hpp"

namespace bough::hdf5 {
namespace {

constexpr const char* kFormat = "bough-linear";
using records::LinearModel;

void write_poles(FileWriter& file, const LinearModel& model) {
  const auto& poles = model.poles;
  file.set_text("poles", model.sample_time > 0 ? "ln z / sample_time of the eigenvalues z of A, least 1e-16"
                                               : "eigenvalues of A");
  file.write_vector("/poles/real", poles.real);
  file.write_vector("/poles/imag", poles.imag);
  file.write_vector("/poles/frequency_hz", poles.frequency_hz);
  file.write_vector("/poles/damping", poles.damping);
  if (poles.error.size() > 0) file.write_vector("/poles/error", poles.error);
  file.write_strings("/poles/mode", poles.mode);
  file.write_strings("/poles/body_mode", poles.body_mode);
  file.write_strings("/poles/hinge", poles.hinge);
}

void write_aliased(FileWriter& file, const std::vector<records::AliasedMode>& aliased) {
  using records::AliasedMode;
  file.write_strings("/aliased/mode", collect(aliased, &AliasedMode::mode));
  file.write_vector("/aliased/frequency_hz", to_vector(collect(aliased, &AliasedMode::frequency_hz)));
  file.write_vector("/aliased/appears_at_hz", to_vector(collect(aliased, &AliasedMode::appears_at_hz)));
}

void write_multipliers(FileWriter& file, const records::Multipliers& m) {
  file.write_number("/multipliers/period", m.period);
  file.write_vector("/multipliers/real", m.real);
  file.write_vector("/multipliers/imag", m.imag);
  file.write_vector("/multipliers/decay", m.decay.cwiseMax(-1e300));
  file.write_vector("/multipliers/frequency_hz", m.frequency_hz);
  file.write_strings("/multipliers/mode", m.mode);
}

void write_hankel(FileWriter& file, const records::Hankel& hankel) {
  file.write_vector("/hankel/value", hankel.value);
  file.write_matrix("/hankel/controllability", hankel.controllability);
  file.write_matrix("/hankel/observability", hankel.observability);
  file.write_integers("/hankel/left_out", std::vector<int>{hankel.num_left_out});
}

void write_uncertainty(FileWriter& file, const std::vector<records::UncertainParameter>& parameters) {
  using records::UncertainParameter;
  const auto low = to_vector(collect(parameters, &UncertainParameter::low));
  const auto high = to_vector(collect(parameters, &UncertainParameter::high));
  file.write_strings("/uncertainty/name", collect(parameters, &UncertainParameter::name));
  file.write_vector("/uncertainty/low", low);
  file.write_vector("/uncertainty/high", high);
  file.write_integers("/uncertainty/size", collect(parameters, &UncertainParameter::size));
}

void write_second_order(FileWriter& file, const LinearModel& model) {
  const auto second = records::make_second_order(model);
  if (second.M.size() == 0) return;
  file.write_matrix("/second_order/M", second.M);
  file.write_matrix("/second_order/D", second.D);
  file.write_matrix("/second_order/K", second.K);
  file.write_matrix("/second_order/F", second.F);
  if (second.Z.cols() > 0) file.write_matrix("/second_order/Z", second.Z);
}

}  // namespace

void write_linear_model(const LinearModel& model, const std::string& path) {
  FileWriter file(path, kFormat, kLinearFormatVersion);
  file.write_source(model.source);
  write_unit_labels(file, model.units);
  if (model.sample_time > 0) file.write_number("/sample_time", model.sample_time);
  file.set_text("equation", model.sample_time > 0 ? "x+ = A x + B u" : "x_dot = A x + B u");
  file.write_matrix("/A", model.A);
  file.write_matrix("/B", model.B);
  file.write_matrix("/C", model.C);
  file.write_matrix("/D", model.D);
  write_second_order(file, model);
  write_signals(file, "/states", model.states);
  write_signals(file, "/inputs", model.inputs);
  write_signals(file, "/outputs", model.outputs);
  file.write_number("/operating_point/time", model.time);
  file.write_vector("/operating_point/q", model.q);
  file.write_vector("/operating_point/u", model.u);
  write_signals(file, "/operating_point/positions", model.q_names);
  write_signals(file, "/operating_point/speeds", model.u_names);
  file.write_strings("/operating_point/periodic", model.periodic);
  file.write_number("/operating_point/residual", model.residual);
  file.write_number("/accuracy/error", model.error);
  file.write_number("/accuracy/difference", model.difference);
  write_poles(file, model);
  if (!model.aliased.empty()) write_aliased(file, model.aliased);
  if (model.has_zeros) {
    file.write_vector("/zeros/real", model.zeros_real);
    file.write_vector("/zeros/imag", model.zeros_imag);
  }
  if (model.multipliers.period > 0) write_multipliers(file, model.multipliers);
  if (model.hankel.value.size() > 0) write_hankel(file, model.hankel);
  if (!model.uncertainty.empty()) write_uncertainty(file, model.uncertainty);
  file.commit();
}

LinearModel read_linear_model(const std::string& path) {
  FileReader file(path, kFormat, kLinearFormatVersion);
  LinearModel model;
  model.source = file.read_source();
  model.units = read_unit_labels(file);
  if (file.has("/sample_time")) model.sample_time = file.read_number("/sample_time");
  model.states = read_signals(file, "/states");
  model.inputs = read_signals(file, "/inputs");
  model.outputs = read_signals(file, "/outputs");
  const long nx = model.states.size(), nu = model.inputs.size(), ny = model.outputs.size();
  model.A = file.read_matrix("/A", nx, nx);
  model.B = file.read_matrix("/B", nx, nu);
  model.C = file.read_matrix("/C", ny, nx);
  model.D = file.read_matrix("/D", ny, nu);
  if (file.has("/second_order/M")) model.mass = file.read_matrix("/second_order/M", -1, -1);
  model.time = file.read_number("/operating_point/time");
  model.q = file.read_vector("/operating_point/q", -1);
  model.u = file.read_vector("/operating_point/u", -1);
  model.residual = file.read_number("/operating_point/residual");
  if (file.has("/accuracy")) {
    model.error = file.read_number("/accuracy/error");
    model.difference = file.read_number("/accuracy/difference");
  }
  model.poles.real = file.read_vector("/poles/real", nx);
  model.poles.imag = file.read_vector("/poles/imag", nx);
  model.poles.frequency_hz = file.read_vector("/poles/frequency_hz", nx);
  model.poles.damping = file.read_vector("/poles/damping", nx);
  if (file.has("/poles/error")) model.poles.error = file.read_vector("/poles/error", nx);
  model.poles.mode = file.read_strings("/poles/mode", nx);
  if (file.has("/poles/hinge")) {
    model.poles.body_mode = file.read_strings("/poles/body_mode", nx);
    model.poles.hinge = file.read_strings("/poles/hinge", nx);
  }
  if (file.has("/operating_point/positions/name")) {
    model.q_names = read_signals(file, "/operating_point/positions");
    model.u_names = read_signals(file, "/operating_point/speeds");
    model.periodic = file.read_strings("/operating_point/periodic", -1);
  }
  if (file.has("/aliased/mode")) {
    const auto frequency = file.read_vector("/aliased/frequency_hz", -1);
    const auto appears_at = file.read_vector("/aliased/appears_at_hz", frequency.size());
    const auto mode = file.read_strings("/aliased/mode", frequency.size());
    for (std::size_t i = 0; i < mode.size(); ++i)
      model.aliased.push_back({mode[i], frequency[static_cast<long>(i)], appears_at[static_cast<long>(i)]});
  }
  if (file.has("/multipliers/period")) {
    auto& m = model.multipliers;
    m.period = file.read_number("/multipliers/period");
    m.real = file.read_vector("/multipliers/real", -1);
    m.imag = file.read_vector("/multipliers/imag", m.real.size());
    m.decay = file.read_vector("/multipliers/decay", m.real.size());
    m.frequency_hz = file.read_vector("/multipliers/frequency_hz", m.real.size());
    m.mode = file.read_strings("/multipliers/mode", m.real.size());
  }
  if (file.has("/hankel/value")) {
    model.hankel.value = file.read_vector("/hankel/value", -1);
    model.hankel.controllability = file.read_matrix("/hankel/controllability", nx, nx);
    model.hankel.observability = file.read_matrix("/hankel/observability", nx, nx);
    model.hankel.num_left_out = file.read_integers("/hankel/left_out", 1).front();
  }
  if (file.has("/uncertainty/name")) {
    const auto name = file.read_strings("/uncertainty/name", -1);
    const auto count = static_cast<long>(name.size());
    const auto low = file.read_vector("/uncertainty/low", count), high = file.read_vector("/uncertainty/high", count);
    const auto size = file.read_integers("/uncertainty/size", count);
    for (std::size_t i = 0; i < name.size(); ++i)
      model.uncertainty.push_back({name[i], low[static_cast<long>(i)], high[static_cast<long>(i)], size[i]});
  }
  model.has_zeros = file.has("/zeros/real");
  if (model.has_zeros) {
    model.zeros_real = file.read_vector("/zeros/real", -1);
    model.zeros_imag = file.read_vector("/zeros/imag", model.zeros_real.size());
  }
  file.throw_if_errors();
  return model;
}

}  // namespace bough::hdf5
