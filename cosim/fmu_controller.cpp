#include "cosim/fmu_controller.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>

#include "cosim/slave.hpp"
#include "formats/fmu/archive.hpp"

namespace bough::cosim {
namespace {

namespace fs = std::filesystem;
using fmu::ForeignModel;
using fmu::ForeignVariable;

/// Bytes of the state of the FMU in one number of the memory: an integer that a double holds.
constexpr std::size_t kPacked = 6;

/// Private folder in TMPDIR.
class Folder {
 public:
  Folder() {
    std::error_code failed;
    std::string name = (fs::temp_directory_path(failed) / "bough-fmu-XXXXXX").string();
    if (failed || mkdtemp(name.data()) == nullptr)
      throw ComputationError("fmu.unpack", {}, "no folder for the FMU can be made in TMPDIR",
                             "choose a folder by TMPDIR that can be written");
    path_ = name;
  }
  ~Folder() {
    std::error_code failed;
    fs::remove_all(path_, failed);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

int count(const std::vector<ForeignVariable>& variables) {
  return std::accumulate(variables.begin(), variables.end(), 0, [](int n, const auto& v) { return n + v.size; });
}

std::vector<double> pack(const std::string& bytes) {
  std::vector<double> numbers((bytes.size() + kPacked - 1) / kPacked);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto byte = static_cast<double>(static_cast<unsigned char>(bytes[i]));
    numbers[i / kPacked] += std::ldexp(byte, static_cast<int>(8 * (i % kPacked)));
  }
  return numbers;
}

std::string unpack(const double* numbers, std::size_t size) {
  std::string bytes(size, '\0');
  for (std::size_t i = 0; i < size; ++i)
    bytes[i] = static_cast<char>((static_cast<unsigned long long>(numbers[i / kPacked]) >> (8 * (i % kPacked))) & 0xff);
  return bytes;
}

/// The slave with the law of its memory.
class FmuLaw {
 public:
  FmuLaw(const ForeignModel& model, SlaveVariables variables, std::vector<double> parameters,
         std::shared_ptr<Folder> folder, double step)
      : folder_(std::move(folder)),
        model_(model),
        num_inputs_(count(variables.inputs)),
        num_outputs_(count(variables.outputs)),
        parameters_(std::move(parameters)),
        step_(step),
        slave_(load_slave(model, folder_->path(), std::move(variables))) {
    slave_->start(0, parameters_.data(), nullptr);
    first_ = last_out_ = make_memory(0, 0, 0);
  }

  int num_inputs() const { return num_inputs_; }
  int num_outputs() const { return num_outputs_; }
  int num_memory() const { return static_cast<int>(first_.size()); }

  void start(double* d) const { std::copy(first_.begin(), first_.end(), d); }
  void outputs(const double* d, double* y) const { std::copy_n(d + 2, num_outputs_, y); }

  void update(double t, const double* u, const double* d, double* next) {
    const std::lock_guard one_at_a_time(lock_);
    const std::size_t n = first_.size();
    const std::vector<double> in(d, d + n), inputs(u, u + num_inputs_);
    if (t != last_time_ || in != last_in_ || inputs != last_inputs_) {
      last_time_ = std::numeric_limits<double>::quiet_NaN();
      const std::vector<double> out = advance(t, inputs, in);
      last_time_ = t;
      last_in_ = in;
      last_inputs_ = inputs;
      last_out_ = out;
    }
    std::copy(last_out_.begin(), last_out_.end(), next);
  }

 private:
  std::vector<double> advance(double t, const std::vector<double>& inputs, const std::vector<double>& in) {
    const double num_steps = in[0], begin = num_steps == 0 ? t : in[1];
    if (num_steps == 0) {
      slave_->start(begin, parameters_.data(), inputs.data());
    } else if (in != last_out_) {
      if (!model_.can_save_state)
        throw std::runtime_error(
            "it would have to go on from an earlier state, which it does not save (canSerializeFMUState)");
      const std::size_t at = 2 + static_cast<std::size_t>(num_outputs_);
      slave_->restore(unpack(in.data() + at + 1, static_cast<std::size_t>(in[at])));
    }
    // A failure leaves the slave in an unknown state.
    last_out_.clear();
    slave_->set_inputs(inputs.data());
    slave_->step(begin + num_steps * step_, step_);
    return make_memory(num_steps + 1, begin, first_.size());
  }

  /// size: 0 where it is to be found, with room for a state that grows.
  std::vector<double> make_memory(double num_steps, double begin, std::size_t size) {
    std::vector<double> d{num_steps, begin};
    d.resize(2 + static_cast<std::size_t>(num_outputs_));
    slave_->get_outputs(d.data() + 2);
    if (model_.can_save_state) {
      const std::string bytes = slave_->save();
      const auto packed = pack(bytes);
      d.push_back(static_cast<double>(bytes.size()));
      d.insert(d.end(), packed.begin(), packed.end());
      if (size == 0) size = d.size() + packed.size() / 2 + 200;
      if (d.size() > size)
        throw std::runtime_error("its state has grown to " + std::to_string(bytes.size()) +
                                 " bytes, more than 1.5 times of what it began with");
    }
    d.resize(std::max(size, d.size()));
    return d;
  }

  std::shared_ptr<Folder> folder_;  // goes after the binary is closed
  ForeignModel model_;
  int num_inputs_, num_outputs_;
  std::vector<double> parameters_;
  double step_;
  std::unique_ptr<Slave> slave_;
  std::mutex lock_;
  std::vector<double> first_;
  double last_time_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> last_in_, last_inputs_, last_out_;
};

/// Reads and checks what a [[controller]] says of its FMU.
class Reader {
 public:
  explicit Reader(records::ControllerRecord& record) : record_(record) {}

  ForeignModel read(const std::string& path, const std::string& folder) const {
    fmu::extract_archive(path, folder);
    std::ifstream file(folder + "/modelDescription.xml", std::ios::binary);
    if (!file) throw InputError("fmu.bad-archive", {path}, "the file is no FMU: it has no modelDescription.xml", "");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    ForeignModel model = fmu::read_model_description(text, path);
    if (std::error_code failed; !fs::is_regular_file(get_binary_path(model, folder), failed)) {
      std::string found;
      std::set<std::string> others;
      for (const auto& entry : fs::recursive_directory_iterator(folder + "/binaries", failed))
        if (entry.is_regular_file(failed))
          others.insert(entry.path().lexically_relative(folder + "/binaries").string());
      for (const auto& other : others) found += (found.empty() ? "" : ", ") + other;
      throw InputError("fmu.no-platform", {path},
                       "the FMU has no binary for this machine, binaries/" +
                           fs::path(get_binary_path(model, "")).lexically_relative("/binaries").string() +
                           (found.empty() ? "" : "; it has " + found),
                       "compile it for Linux");
    }
    return model;
  }

  /// Variables of `key`, or all with that causality in the order of the FMU.
  std::vector<ForeignVariable> choose(const ForeignModel& model, const char* key, const std::string& causality) {
    std::vector<ForeignVariable> chosen;
    const auto words = record_.settings.words.find(key);
    if (words == record_.settings.words.end()) {
      if (causality == "parameter") return chosen;
      for (const auto& v : model.variables)
        if (v.causality == causality) chosen.push_back(v);
    } else {
      for (const auto& name : words->second) chosen.push_back(find(model, name, causality, key));
    }
    for (const auto& v : chosen) {
      if (v.type == fmu::ValueType::Other)
        fail("'" + v.name + "' of its FMU is no number", "choose others by " + quote(key));
      if (v.size == 0)
        fail("the size of '" + v.name + "' of its FMU is not constant", "choose others by " + quote(key));
    }
    return chosen;
  }

  double find_step(const ForeignModel& model) {
    auto& numbers = record_.settings.numbers;
    if (numbers.count("sample_time") == 0) {
      if (!(model.default_step > 0))
        throw InputError("fmu.no-step", record_.at,
                         label() + " has no sample_time, and its FMU recommends none (stepSize)", "give sample_time");
      numbers["sample_time"] = {model.default_step};
    }
    const double step = record_.settings.get("sample_time", 0);
    if (!(step > 0)) fail("the sample_time of its FMU is not positive", "give sample_time");
    return step;
  }

  std::vector<double> find_parameters(int size) {
    const auto found = record_.settings.numbers.find("parameters");
    const auto values = found == record_.settings.numbers.end() ? std::vector<double>() : found->second;
    if (static_cast<int>(values.size()) != size)
      fail(std::to_string(values.size()) + " parameters for " + std::to_string(size) + " of parameter_names",
           "give parameters = [...] and parameter_names = [...], one for each");
    return values;
  }

  std::string label() const { return "controller '" + record_.name + "'"; }
  [[noreturn]] void fail(const std::string& what, const std::string& advice) const {
    throw InputError("fmu.bad-variable", record_.at, label() + ": " + what, advice);
  }

 private:
  static std::string quote(const char* key) { return "'" + std::string(key) + "'"; }

  const ForeignVariable& find(const ForeignModel& model, const std::string& name, const std::string& causality,
                              const char* key) const {
    std::vector<std::string> names;
    for (const auto& v : model.variables) {
      const bool is_right = v.causality == causality ||
                            (causality == "parameter" && v.causality == "structuralParameter") ||
                            (causality == "output" && v.causality == "local");
      if (is_right) names.push_back(v.name);
      if (is_right && v.name == name) return v;
    }
    std::string list;
    for (const auto& each : names) list += (list.empty() ? "" : ", ") + each;
    const auto near = find_nearest(name, names);
    throw InputError("fmu.unknown-variable", record_.at,
                     label() + ": its FMU has no " + causality + " '" + name + "', which " + key + " names",
                     !near.empty()  ? "did you mean '" + near + "'?"
                     : list.empty() ? "leave it out"
                                    : "it has " + list);
  }

  records::ControllerRecord& record_;
};

}  // namespace

solver::ControllerFunctions load_fmu(records::ControllerRecord& record) {
  Reader reader(record);
  const auto file = record.settings.words.find("file");
  const std::string path = file == record.settings.words.end() ? "" : file->second.front();
  if (path.empty())
    throw InputError("fmu.no-file", record.at, reader.label() + " has no 'file'", "give file = \"NAME.fmu\"");
  if (std::error_code failed; !fs::is_regular_file(path, failed))
    throw InputError("fmu.no-file", record.at, reader.label() + ": there is no FMU " + path,
                     "give file = \"NAME.fmu\"");
  const auto folder = std::make_shared<Folder>();
  const ForeignModel model = reader.read(path, folder->path());
  SlaveVariables variables{reader.choose(model, "parameter_names", "parameter"),
                           reader.choose(model, "input_names", "input"),
                           reader.choose(model, "output_names", "output")};
  const double step = reader.find_step(model);
  const auto parameters = reader.find_parameters(count(variables.parameters));
  const int num_outputs = count(variables.outputs);
  if (num_outputs == 0) reader.fail("its FMU has no outputs", "choose some by output_names");
  record.settings.numbers.try_emplace("outputs", std::vector<double>{static_cast<double>(num_outputs)});

  solver::ControllerFunctions f;
  f.language = "FMU";
  f.is_opaque = true;
  f.is_forward_only = !model.can_save_state;
  f.version = [] { return BOUGH_CONTROLLER_VERSION; };
  f.open = [=](bough_controller* own) {
    auto made = std::make_unique<FmuLaw>(model, variables, parameters, folder, step);
    if (made->num_inputs() != own->inputs)
      throw std::runtime_error("it has " + std::to_string(made->num_inputs()) + " inputs, and " +
                               std::to_string(own->inputs) + " signals are wired to it; choose by input_names");
    own->outputs = made->num_outputs();
    own->memory = made->num_memory();
    own->has_feedthrough = 0;
    own->instance = made.release();
    return 0;
  };
  const auto get_law = [](void* instance) -> FmuLaw& { return *static_cast<FmuLaw*>(instance); };
  f.outputs = [get_law](void* own, double, const double*, const double*, const double* d, double* y) {
    get_law(own).outputs(d, y);
    return 0;
  };
  f.start = [get_law](void* own, double*, double* d) {
    get_law(own).start(d);
    return 0;
  };
  f.update = [get_law](void* own, double t, const double* u, const double*, const double* d, double* next) {
    get_law(own).update(t, u, d, next);
    return 0;
  };
  f.close = [](void* own) { delete static_cast<FmuLaw*>(own); };
  return f;
}

}  // namespace bough::cosim
