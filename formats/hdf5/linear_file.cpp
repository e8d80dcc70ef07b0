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
  const std::string what =
      model.sample_time > 0 ? "ln z / sample_time of the eigenvalues z of A, least 1e-16" : "eigenvalues of A";
  file.write_vector("/poles/real", poles.real, {what + ", real part", "1/T"});
  file.write_vector("/poles/imag", poles.imag, {what + ", imaginary part", "1/T"});
  file.write_vector("/poles/frequency_hz", poles.frequency_hz, {"|pole| / 2 pi", "1/T"});
  file.write_vector("/poles/damping", poles.damping, {"-real / |pole|; 0 for a pole at 0", "1"});
  if (poles.error.size() > 0)
    file.write_vector("/poles/error", poles.error, {"what a pole may be off by, estimated", "1/T"});
  file.write_strings("/poles/mode", poles.mode, {"the coordinate that takes part most", "1"});
  file.write_strings("/poles/body_mode", poles.body_mode, {"the mode of a body that does; empty: none", "1"});
  file.write_strings("/poles/hinge", poles.hinge, {"the hinge coordinate that does; empty: none", "1"});
}

void write_aliased(FileWriter& file, const std::vector<records::AliasedMode>& aliased) {
  using records::AliasedMode;
  file.write_strings("/aliased/mode", collect(aliased, &AliasedMode::mode),
                     {"coordinate that takes part most in a mode above the Nyquist frequency", "1"});
  file.write_vector("/aliased/frequency_hz", to_vector(collect(aliased, &AliasedMode::frequency_hz)),
                    {"of the continuous motion, |Im| / 2 pi", "1/T"});
  file.write_vector("/aliased/appears_at_hz", to_vector(collect(aliased, &AliasedMode::appears_at_hz)),
                    {"of its pole ln z / sample_time", "1/T"});
}

void write_multipliers(FileWriter& file, const records::Multipliers& m) {
  file.write_number("/multipliers/period", m.period, {"of all samples together", "T"});
  file.write_vector("/multipliers/real", m.real, {"what a period makes of a departure, eigenvalues, real part", "1"});
  file.write_vector("/multipliers/imag", m.imag, {"likewise, imaginary part", "1"});
  file.write_vector("/multipliers/decay", m.decay.cwiseMax(-1e300), {"ln |multiplier| / period", "1/T"});
  file.write_vector("/multipliers/frequency_hz", m.frequency_hz,
                    {"|arg| / 2 pi period, up to multiples of 1 / period", "1/T"});
  file.write_strings("/multipliers/mode", m.mode, {"the coordinate or memory that takes part most", "1"});
}

void write_hankel(FileWriter& file, const records::Hankel& hankel) {
  file.write_vector("/hankel/value", hankel.value,
                    {"Hankel singular values of the part that decays, descending", "as the names' dims say"});
  file.write_matrix("/hankel/controllability", hankel.controllability,
                    {"Gramian: A X + X A^T + B B^T = 0 on the part that decays", "as the names' dims say"});
  file.write_matrix("/hankel/observability", hankel.observability,
                    {"Gramian: A^T X + X A + C^T C = 0 on the part that decays", "as the names' dims say"});
  file.write_integers("/hankel/left_out", std::vector<int>{hankel.num_left_out}, {"poles that do not decay", "1"});
}

void write_uncertainty(FileWriter& file, const std::vector<records::UncertainParameter>& parameters) {
  using records::UncertainParameter;
  const auto low = to_vector(collect(parameters, &UncertainParameter::low));
  const auto high = to_vector(collect(parameters, &UncertainParameter::high));
  file.write_strings("/uncertainty/name", collect(parameters, &UncertainParameter::name),
                     {"parameters whose inputs w and outputs z come first: w = delta z", "1"});
  file.write_vector("/uncertainty/low", low, {"value at delta = -1", "as the names' dims say"});
  file.write_vector("/uncertainty/high", high, {"value at delta = 1", "as the names' dims say"});
  file.write_integers("/uncertainty/size", collect(parameters, &UncertainParameter::size),
                      {"number of inputs, and of outputs, of the parameter", "1"});
}

void write_second_order(FileWriter& file, const LinearModel& model) {
  const auto second = records::make_second_order(model);
  if (second.M.size() == 0) return;
  const char* const dims = "as the names' dims say";
  file.write_matrix("/second_order/M", second.M,
                    {"M d'' + D d' + K d = F u + Z z, d displacements: mass matrix", dims});
  file.write_matrix("/second_order/D", second.D, {"damping, and gyroscopic terms of a motion", dims});
  file.write_matrix("/second_order/K", second.K, {"stiffness, of loads and of a motion too", dims});
  file.write_matrix("/second_order/F", second.F, {"displacement, input", dims});
  if (second.Z.cols() > 0)
    file.write_matrix("/second_order/Z", second.Z, {"displacement, state of controllers, actuators, sensors", dims});
}

}  // namespace

void write_linear_model(const LinearModel& model, const std::string& path) {
  FileWriter file(path, kFormat, kLinearFormatVersion);
  file.write_source(model.source);
  write_unit_labels(file, model.units);
  if (model.sample_time > 0)
    file.write_number("/sample_time", model.sample_time, {"x+ = A x + B u, y = C x + D u", "T"});
  const char* const dims = "as the names' dims say";
  const std::string law = model.sample_time > 0 ? "x+ = A x + B u" : "x_dot = A x + B u";
  file.write_matrix("/A", model.A, {law + ": state, state", dims});
  file.write_matrix("/B", model.B, {law + ": state, input", dims});
  file.write_matrix("/C", model.C, {"y = C x + D u: output, state", dims});
  file.write_matrix("/D", model.D, {"y = C x + D u: output, input", dims});
  write_second_order(file, model);
  write_signals(file, "/states", model.states, "states: displacements of the DOFs, then their rates");
  write_signals(file, "/inputs", model.inputs, "inputs: departures from their values at the operating point");
  write_signals(file, "/outputs", model.outputs, "outputs: departures from their values at the operating point");
  file.write_number("/operating_point/time", model.time, {"time", "T"});
  file.write_vector("/operating_point/q", model.q,
                    {"hinge coordinates (quaternions w, x, y, z), then modal coordinates, body by body", "1 or L"});
  file.write_vector("/operating_point/u", model.u, {"hinge rates, then modal rates, body by body", "1/T or L/T"});
  write_signals(file, "/operating_point/positions", model.q_names, "entries of q");
  write_signals(file, "/operating_point/speeds", model.u_names, "entries of u");
  file.write_strings("/operating_point/periodic", model.periodic,
                     {"coordinates that are angles, the same again after 2 pi", "1"});
  file.write_number("/operating_point/residual", model.residual,
                    {"norm of u_dot: 0 at rest and in a steady motion", "1/T^2 or L/T^2"});
  file.write_number("/accuracy/error", model.error,
                    {"estimated error of A and C, relative to the largest entry of the row", "1"});
  file.write_number("/accuracy/difference", model.difference,
                    {"of A and C between two step sizes, relative to the largest entry of the row", "1"});
  write_poles(file, model);
  if (!model.aliased.empty()) write_aliased(file, model.aliased);
  if (model.has_zeros) {
    file.write_vector("/zeros/real", model.zeros_real, {"finite transmission zeros, real part", "1/T"});
    file.write_vector("/zeros/imag", model.zeros_imag, {"finite transmission zeros, imaginary part", "1/T"});
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
