#include "cosim/fmu_controller.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <set>
#include <sstream>
#include <stdexcept>

#include "base/temporary_folder.hpp"
#include "cosim/slave.hpp"
#include "formats/fmu/archive.hpp"

namespace bough::cosim {
namespace {

namespace fs = std::filesystem;
using fmu::ForeignModel;
using fmu::ForeignVariable;

/// Bytes of the state of the FMU in one number of the memory: an integer that a double holds.
constexpr std::size_t kPacked = 6;

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

/// Variables, and for each number that goes in or out its place among all their values, one after the other.
struct Choice {
  std::vector<ForeignVariable> variables;
  std::vector<std::size_t> places;
  std::vector<std::string> labels;  ///< of each number: the name as it was given, of an element with its indices

  /// Values of all variables: `numbers` at their places, elsewhere the start values, or zero.
  std::vector<double> spread(const std::vector<double>& numbers) const {
    std::vector<double> values;
    for (const auto& v : variables) {
      if (v.start.empty())
        values.resize(values.size() + static_cast<std::size_t>(v.size), 0.0);
      else
        values.insert(values.end(), v.start.begin(), v.start.end());
    }
    for (std::size_t i = 0; i < numbers.size(); ++i) values[places[i]] = numbers[i];
    return values;
  }
};

/// Variables that a [[controller]] chooses of its FMU.
struct Choices {
  Choice parameters, inputs, outputs;
  std::vector<std::pair<ForeignVariable, std::string>> texts;
};

/// The slave with the law of its memory.
class FmuLaw {
 public:
  FmuLaw(const ForeignModel& model, const Choices& choices, const std::vector<double>& parameters,
         std::shared_ptr<const TemporaryFolder> folder, double step)
      : folder_(std::move(folder)),
        model_(model),
        inputs_(choices.inputs),
        outputs_(choices.outputs),
        all_outputs_(static_cast<std::size_t>(count(choices.outputs.variables))),
        parameters_(choices.parameters.spread(parameters)),
        step_(step),
        slave_(load_slave(
            model, folder_->path(),
            {choices.parameters.variables, choices.inputs.variables, choices.outputs.variables, choices.texts})) {
    slave_->start(0, parameters_.data(), nullptr);
    first_ = last_out_ = make_memory(0, 0, 0);
  }

  int num_inputs() const { return static_cast<int>(inputs_.places.size()); }
  int num_outputs() const { return static_cast<int>(outputs_.places.size()); }
  int num_memory() const { return static_cast<int>(first_.size()); }

  void start(double* d) const { std::copy(first_.begin(), first_.end(), d); }
  void outputs(const double* d, double* y) const { std::copy_n(d + 2, num_outputs(), y); }

  void update(double t, const double* u, const double* d, double* next) {
    const std::lock_guard one_at_a_time(lock_);
    const std::size_t n = first_.size();
    const std::vector<double> in(d, d + n), inputs(u, u + num_inputs());
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
    const std::vector<double> values = inputs_.spread(inputs);
    if (num_steps == 0) {
      slave_->start(begin, parameters_.data(), values.data());
    } else if (in != last_out_) {
      if (!model_.can_save_state)
        throw std::runtime_error(
            "it would have to go on from a state that is not its last one (restore, --resume, a second simulation of "
            "one system), and it saves none (canSerializeFMUState)");
      const std::size_t at = 2 + outputs_.places.size();
      slave_->restore(unpack(in.data() + at + 1, static_cast<std::size_t>(in[at])));
    }
    // A failure leaves the slave in an unknown state.
    last_out_.clear();
    slave_->set_inputs(values.data());
    slave_->step(begin + num_steps * step_, step_);
    return make_memory(num_steps + 1, begin, first_.size());
  }

  /// size: 0 if it is to be found, with room for a state that grows.
  std::vector<double> make_memory(double num_steps, double begin, std::size_t size) {
    std::vector<double> d{num_steps, begin};
    slave_->get_outputs(all_outputs_.data());
    for (const std::size_t place : outputs_.places) d.push_back(all_outputs_[place]);
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

  std::shared_ptr<const TemporaryFolder> folder_;  // goes after the binary is closed
  ForeignModel model_;
  Choice inputs_, outputs_;
  std::vector<double> all_outputs_, parameters_;
  double step_;
  std::unique_ptr<Slave> slave_;
  std::mutex lock_;
  std::vector<double> first_;
  double last_time_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> last_in_, last_inputs_, last_out_;
};

/// Reads and checks the keys of a [[controller]] of type fmu.
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

  /// Variables of `key` and elements of arrays, or all with that causality in the order of the FMU.
  Choice choose(const ForeignModel& model, const char* key, const std::string& causality) const {
    Choice choice;
    std::map<std::string, std::size_t> first;  // place of each variable that is chosen
    std::set<std::size_t> used;
    std::size_t end = 0;
    const auto add = [&](const ForeignVariable& v, int element, const std::string& given) {
      check_type(v, key);
      const auto [found, is_new] = first.emplace(v.name, end);
      if (is_new) {
        choice.variables.push_back(v);
        end += static_cast<std::size_t>(v.size);
      }
      const int from = std::max(element, 0), to = element < 0 ? v.size : element + 1;
      for (int i = from; i < to; ++i) {
        const std::size_t place = found->second + static_cast<std::size_t>(i);
        if (!used.insert(place).second) fail(quote(key) + " names '" + v.name + "' twice", "name each once");
        choice.places.push_back(place);
        choice.labels.push_back(element < 0 && !v.dimensions.empty() ? given + format_element(v, i) : given);
      }
    };
    const auto words = record_.settings.words.find(key);
    if (words != record_.settings.words.end()) {
      for (const auto& name : words->second) {
        const auto [variable, element] = find(model, name, causality, key);
        add(*variable, element, name);
      }
    } else if (causality != "parameter") {
      for (const auto& v : model.variables)
        if (v.causality == causality) add(v, -1, v.name);
    }
    return choice;
  }

  /// String parameters, given as NAME=VALUE.
  std::vector<std::pair<ForeignVariable, std::string>> choose_texts(const ForeignModel& model) const {
    std::vector<std::pair<ForeignVariable, std::string>> texts;
    const auto words = record_.settings.words.find(kTexts);
    if (words == record_.settings.words.end()) return texts;
    for (const auto& word : words->second) {
      const auto equal = word.find('=');
      if (equal == std::string::npos)
        fail(quote(kTexts) + " has '" + word + "', expected NAME=VALUE", "write NAME=VALUE for each");
      const auto [variable, element] = find(model, word.substr(0, equal), "parameter", kTexts);
      if (variable->type != fmu::ValueType::String || variable->size != 1)
        fail("'" + variable->name + "' of its FMU is no single string", "give its value in 'parameters'");
      texts.emplace_back(*variable, word.substr(equal + 1));
    }
    return texts;
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
  static constexpr const char* kTexts = "string_parameters";
  static std::string quote(const char* key) { return "'" + std::string(key) + "'"; }

  void check_type(const ForeignVariable& v, const char* key) const {
    if (v.type == fmu::ValueType::String && v.causality == "parameter")
      fail("'" + v.name + "' of its FMU is a string", "give its value in " + quote(kTexts));
    if (v.type == fmu::ValueType::Other || v.type == fmu::ValueType::String)
      fail("'" + v.name + "' of its FMU is no number", "choose others by " + quote(key));
    if (v.size == 0) fail("the size of '" + v.name + "' of its FMU is not constant", "choose others by " + quote(key));
  }

  /// "[2]" or "[1,3]": the element of an array that is counted from 0.
  static std::string format_element(const ForeignVariable& v, int place) {
    std::string indices;
    for (auto d = v.dimensions.rbegin(); d != v.dimensions.rend(); place /= *d++)
      indices = std::to_string(place % *d + 1) + (indices.empty() ? "" : ",") + indices;
    return "[" + indices + "]";
  }

  /// Place of the element that "[2]" or "[1,3]" of a name means in an array of this name or alias, counted from 0; -1:
  /// no element of it.
  static int find_element(const ForeignVariable& v, const std::string& array, const std::string& name) {
    if (v.dimensions.empty() || !name.starts_with(array + "[") || !name.ends_with("]")) return -1;
    std::istringstream indices(name.substr(array.size() + 1));
    long place = 0;
    for (std::size_t d = 0; d < v.dimensions.size(); ++d) {
      long index = 0;
      char end = 0;
      if (!(indices >> index >> end) || index < 1 || index > v.dimensions[d]) return -1;
      if (end != (d + 1 == v.dimensions.size() ? ']' : ',')) return -1;
      place = place * v.dimensions[d] + index - 1;
    }
    return static_cast<int>(place);
  }

  /// The variable of a name or an alias, and the element, -1: all of it.
  std::pair<const ForeignVariable*, int> find(const ForeignModel& model, const std::string& name,
                                              const std::string& causality, const char* key) const {
    std::vector<std::string> names;
    for (const auto& v : model.variables) {
      const bool is_right = v.causality == causality ||
                            (causality == "parameter" && v.causality == "structuralParameter") ||
                            (causality == "output" && v.causality == "local");
      if (!is_right) continue;
      names.push_back(v.name);
      if (v.name == name || std::find(v.aliases.begin(), v.aliases.end(), name) != v.aliases.end()) return {&v, -1};
      if (const int element = find_element(v, v.name, name); element >= 0) return {&v, element};
      for (const auto& alias : v.aliases)
        if (const int element = find_element(v, alias, name); element >= 0) return {&v, element};
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
  const auto folder = std::make_shared<const TemporaryFolder>("bough-fmu", "the FMU");
  const ForeignModel model = reader.read(path, folder->path());
  const Choices choices{reader.choose(model, "parameter_names", "parameter"),
                        reader.choose(model, "input_names", "input"), reader.choose(model, "output_names", "output"),
                        reader.choose_texts(model)};
  const double step = reader.find_step(model);
  const auto parameters = reader.find_parameters(static_cast<int>(choices.parameters.places.size()));
  const auto num_outputs = static_cast<int>(choices.outputs.places.size());
  if (num_outputs == 0) reader.fail("its FMU has no outputs", "choose some by output_names");
  record.settings.numbers.try_emplace("outputs", std::vector<double>{static_cast<double>(num_outputs)});
  record.settings.words["output_names"] = choices.outputs.labels;

  solver::ControllerFunctions f;
  f.language = "FMU";
  f.is_opaque = true;
  f.is_forward_only = !model.can_save_state;
  f.version = [] { return BOUGH_CONTROLLER_VERSION; };
  f.open = [=](bough_controller* own) {
    auto made = std::make_unique<FmuLaw>(model, choices, parameters, folder, step);
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
