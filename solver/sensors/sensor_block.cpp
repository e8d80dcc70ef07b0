#include "solver/sensors/sensor_block.hpp"

#include <algorithm>
#include <cmath>

#include "solver/sensors/noise.hpp"

namespace bough::solver {
namespace {

using records::SensorType;

class SensorBlock final : public Block {
 public:
  Sensor entry;
  VectorXd scale, bias, low, high, quantum;  ///< as many as outputs, or empty
  Matrix3d misalignment = Matrix3d::Identity();
  bool is_misaligned = false;
  VectorXd initial;                     ///< of the lag
  bool is_steady = false;               ///< it starts at what is measured first
  double lag = 0, noise = 0, walk = 0;  ///< noise, walk: deviation of a sample, of a step
  std::uint64_t seed = 0, stream = 0;

  // States: those of the lag, after the integral of an integrating gyro. Memory: the random walk.
  void calc_outputs(const BlockInput& in, double* y) const override { calc_sample(in, true, y); }
  void calc_ideal(const BlockInput& in, double* y) const override { calc_sample(in, false, y); }
  void start(double* z, double*) const override {
    if (lag > 0) Eigen::Map<VectorXd>(z + num_integrals(), sizes.outputs) = initial;
  }
  bool settle(const BlockInput& in, double* z) const override {
    if (!is_steady || lag <= 0) return false;
    if (is_integrating())
      std::copy_n(in.z, 3, z + 3);
    else
      measure(*in.motion, entry, z);
    return true;
  }
  void calc_sample(const BlockInput& in, bool is_real, double* y) const {
    const int n = sizes.outputs;
    Eigen::Map<VectorXd> value(y, n);
    if (lag > 0)
      value = Eigen::Map<const VectorXd>(in.z + (is_integrating() ? 3 : 0), n);
    else if (is_integrating())
      value = Eigen::Map<const VectorXd>(in.z, n);
    else
      measure(*in.motion, entry, y);
    if (is_misaligned) value.head<3>() = (misalignment.transpose() * value.head<3>()).eval();
    for (int i = 0; i < n; ++i) {
      if (scale.size() > 0) value[i] *= scale[i];
      if (bias.size() > 0) value[i] += bias[i];
      if (walk > 0) value[i] += in.d[i];
      if (noise > 0 && is_real) value[i] += noise * draw(in.sample, i);
      if (low.size() > 0) value[i] = limit(in, i, value[i]);
      if (is_real && quantum.size() > 0 && quantum[i] > 0) value[i] = quantum[i] * std::round(value[i] / quantum[i]);
    }
  }
  void calc_rates(const BlockInput& in, double* z_dot) const override {
    double raw[9];
    double* now = sizes.outputs <= 9 ? raw : z_dot + (is_integrating() ? 3 : 0);
    measure(*in.motion, entry, now);
    if (is_integrating()) {
      std::copy_n(now, 3, z_dot);
      if (lag <= 0) return;
      for (int i = 0; i < 3; ++i) z_dot[3 + i] = (in.z[i] - in.z[3 + i]) / lag;
      return;
    }
    for (int i = 0; i < sizes.outputs; ++i) z_dot[i] = (now[i] - in.z[i]) / lag;
  }
  void mark_motion(const Tree& tree, std::vector<bool>& q, std::vector<bool>& u) const override {
    solver::mark_motion(tree, entry, q, u);
  }
  void update(const BlockInput& in, double* d) const override {
    for (int i = 0; i < sizes.memory; ++i) d[i] += walk * draw(in.sample, sizes.outputs + i);
  }

  int num_integrals() const { return is_integrating() ? 3 : 0; }
  bool is_integrating() const { return entry.type == SensorType::IntegratingGyro; }

 private:
  double limit(const BlockInput& in, int i, double value) const {
    return evaluate_scalar_law(in.tangents, as_owner(), i, value,
                               [&]<class T>(T x) { return std::clamp(x, T(low[i]), T(high[i])); });
  }
  double draw(long sample, int component) const {
    return calc_normal(seed, stream + static_cast<std::uint64_t>(component), static_cast<std::uint64_t>(sample));
  }
};

class Reader {
 public:
  Reader(const records::SensorRecord& record, Diagnostics& diagnostics) : r_(record), diagnostics_(diagnostics) {}

  VectorXd get_list(const char* key, int size) {
    const auto found = r_.chain.numbers.find(key);
    if (found == r_.chain.numbers.end()) return {};
    const auto& list = found->second;
    if (list.size() == 1) return VectorXd::Constant(size, list[0]);
    if (static_cast<int>(list.size()) == size) return Eigen::Map<const VectorXd>(list.data(), size);
    error("sensor.bad-value",
          std::string("has ") + std::to_string(list.size()) + " numbers in " + key + ", and " + std::to_string(size) +
              " components",
          "give one number, or one a component");
    return {};
  }
  double get_positive(const char* key) {
    const double value = r_.chain.get(key, 0);
    if (!(value >= 0)) error("sensor.bad-value", std::string("has a negative ") + key, "give a positive number");
    return value;
  }
  void error(const char* id, const std::string& what, const std::string& advice) {
    diagnostics_.error(id, r_.at, "sensor '" + r_.name + "' " + what, advice);
  }

 private:
  const records::SensorRecord& r_;
  Diagnostics& diagnostics_;
};

}  // namespace

std::unique_ptr<Block> make_sensor_block(const Sensor& entry, const records::SensorRecord& r,
                                         Diagnostics& diagnostics) {
  auto made = std::make_unique<SensorBlock>();
  SensorBlock& s = *made;
  Reader reader(r, diagnostics);
  s.entry = entry;
  s.set_name(BlockKind::Sensor, r.name);
  s.label = "sensor '" + r.name + "'";
  s.description = entry.description;
  s.dims = entry.dims;
  s.at = r.at;
  const int n = s.sizes.outputs = entry.size;
  s.sizes.reads_acceleration = records::get_kind(r.type).reads_acceleration;
  s.scale = reader.get_list("scale", n);
  s.bias = reader.get_list("bias", n);
  s.quantum = reader.get_list("quantization", n);
  s.lag = reader.get_positive("lag");
  s.initial = reader.get_list("initial", n);
  if (s.initial.size() == 0) s.initial = VectorXd::Zero(n);
  if (const auto word = r.chain.words.find("initial"); word != r.chain.words.end()) {
    s.is_steady = word->second == std::vector<std::string>{"steady"};
    if (!s.is_steady)
      reader.error("sensor.bad-value", "has an initial that is neither numbers nor steady",
                   "give numbers, or initial = \"steady\"");
  }
  if (r.chain.has("initial") && s.lag <= 0)
    reader.error("sensor.bad-value", "has an initial and no lag", "give lag = TIME, or leave it out");
  const bool is_attitude =
      r.type == SensorType::Quaternion || r.type == SensorType::Euler || r.type == SensorType::DirectionCosines;
  if (s.lag > 0 && (is_attitude || r.type == SensorType::Resolver))
    reader.error("sensor.bad-value", "has a lag, which would run across the jumps of what it measures",
                 "give the lag to a sensor of the rate, or to a hinge_angle, or leave it out");
  if (is_attitude && r.type != SensorType::Euler && (r.chain.has("scale") || r.chain.has("bias")))
    reader.error("sensor.bad-value", "has a scale or a bias, after which it is no attitude any more",
                 "leave it out, or measure angles (euler)");
  s.sizes.sample_time = reader.get_positive("sample_time");
  s.sizes.delay = reader.get_positive("delay");
  const double density = reader.get_positive("noise_density"), walk = reader.get_positive("random_walk");
  s.seed = static_cast<std::uint64_t>(r.chain.get("seed", 1));
  s.stream = calc_stream(r.name);
  if (const auto range = r.chain.numbers.find("range"); range != r.chain.numbers.end()) {
    const auto& limits = range->second;
    const double high = limits.back(), low = limits.size() == 1 ? -high : limits.front();
    if (limits.size() > 2 || !(low < high))
      reader.error("sensor.bad-value", "has a range without extent", "give range = LARGEST or [LEAST, LARGEST]");
    s.low = VectorXd::Constant(n, low);
    s.high = VectorXd::Constant(n, high);
  }
  if (const auto turn = r.chain.numbers.find("misalignment"); turn != r.chain.numbers.end()) {
    s.is_misaligned = true;
    if (turn->second.size() == 3 && n == 3)
      s.misalignment = calc_rotation_exp(Vector3d(turn->second[0], turn->second[1], turn->second[2]));
    else
      reader.error("sensor.bad-value", "has a misalignment that is not a turn of a vector",
                   "give three angles, of a sensor with x, y and z");
  }
  for (const char* key : {"noise_density", "random_walk", "quantization", "delay"}) {
    if (s.sizes.sample_time > 0 || !r.chain.has(key)) continue;
    reader.error("sensor.needs-sample-time", std::string("has ") + key + " and no sample_time",
                 "give sample_time: between samples it holds its value");
  }
  if (s.sizes.sample_time > 0) {
    s.noise = density / std::sqrt(s.sizes.sample_time);
    s.walk = walk * std::sqrt(s.sizes.sample_time);
  }
  s.sizes.memory = s.walk > 0 ? n : 0;
  s.sizes.states = (s.is_integrating() ? 3 : 0) + (s.lag > 0 ? n : 0);
  s.sizes.has_feedthrough = s.sizes.states == 0;
  return made;
}

}  // namespace bough::solver
