#include "cosim/slave.hpp"

#include <dlfcn.h>

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "base/platform.hpp"
#include "embed/fmi2_types.h"
#include "embed/fmi3_types.h"

namespace bough::cosim {
namespace {

constexpr const char* kName = "controller";
constexpr int kWarning = 1, kDiscard = 2, kFatal = 4;

const char* name_status(int status) {
  static const char* names[] = {"ok", "warning", "discard", "error", "fatal", "pending"};
  return status >= 0 && status < 6 ? names[status] : "unknown";
}

/// Closed after everything that was taken from it.
class Library {
 public:
  explicit Library(const std::string& path) : handle_(dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) {
      const char* why = dlerror();
      throw std::runtime_error("cannot load its binary: " + std::string(why ? why : path));
    }
  }
  ~Library() { dlclose(handle_); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  /// Null if the binary lacks the function.
  template <class F>
  void find_optional(const char* name, F*& to) const {
    to = reinterpret_cast<F*>(dlsym(handle_, name));
  }
  template <class F>
  void find(const char* name, F*& to) const {
    find_optional(name, to);
    if (to == nullptr) throw std::runtime_error("its binary lacks the function " + std::string(name));
  }

 private:
  void* handle_;
};

/// Status, message, variables and state, alike in both versions.
class SlaveBase : public Slave {
 public:
  SlaveBase(const fmu::ForeignModel& model, const std::string& folder, SlaveVariables variables)
      : model_(model), folder_(folder), variables_(std::move(variables)), library_(get_binary_path(model, folder)) {}

  void set_inputs(const double* values) override { set(variables_.inputs, values); }
  void get_outputs(double* values) override {
    for (const auto& v : variables_.outputs) {
      get_one(v, values);
      for (int i = 0; i < v.size; ++i)
        if (!std::isfinite(values[i]))
          throw std::runtime_error("its output '" + v.name + "' is " + std::to_string(values[i]));
      values += v.size;
    }
  }

  std::string save() override {
    check(get_state_(own_, &state_), "GetFMUState");
    std::size_t size = 0;
    check(get_size_(own_, state_, &size), "SerializedFMUStateSize");
    std::string bytes(size, '\0');
    check(serialize_(own_, state_, bytes.data(), size), "SerializeFMUState");
    return bytes;
  }
  void restore(const std::string& bytes) override {
    check(deserialize_(own_, bytes.data(), bytes.size(), &state_), "DeserializeFMUState");
    check(set_state_(own_, state_), "SetFMUState");
  }

 protected:
  virtual void set_one(const fmu::ForeignVariable& v, const double* values) = 0;
  virtual void get_one(const fmu::ForeignVariable& v, double* values) = 0;

  void set(const std::vector<fmu::ForeignVariable>& variables, const double* values) {
    for (const auto& v : variables) {
      set_one(v, values);
      values += v.size;
    }
  }
  void check(int status, const char* function) {
    if (status == kFatal) is_lost_ = true;
    if (status <= kWarning) return;
    std::string what = std::string(function) + " returned " + std::to_string(status) + " (" + name_status(status) + ")";
    if (!message_.empty()) what += ": " + message_;
    message_.clear();
    throw std::runtime_error(what);
  }
  /// Sets the string parameters; the function is looked up only if there are any.
  template <class Function, class... More>
  void set_texts(const char* name, More... more) {
    for (const auto& [v, text] : variables_.texts) {
      Function* function = nullptr;
      library_.find(name, function);
      const char* value = text.c_str();
      check(function(own_, &v.reference, 1, &value, more...), name);
    }
  }
  /// Functions with the same arguments in both versions, but for the kind of their pointers.
  void find_shared(const std::string& prefix, const std::string& state, const std::string& deserialize) {
    library_.find((prefix + "FreeInstance").c_str(), free_);
    library_.find((prefix + "ExitInitializationMode").c_str(), exit_);
    library_.find((prefix + "Terminate").c_str(), terminate_);
    if (!model_.can_save_state) return;
    library_.find((prefix + "Get" + state).c_str(), get_state_);
    library_.find((prefix + "Set" + state).c_str(), set_state_);
    library_.find((prefix + "Free" + state).c_str(), free_state_);
    library_.find((prefix + "Serialized" + state + "Size").c_str(), get_size_);
    library_.find((prefix + "Serialize" + state).c_str(), serialize_);
    library_.find((prefix + deserialize + state).c_str(), deserialize_);
  }
  void end() {
    if (own_ != nullptr && !is_lost_) {
      if (state_ != nullptr) free_state_(own_, &state_);
      if (is_running_) terminate_(own_);
      free_(own_);
    }
    own_ = state_ = nullptr;
    is_running_ = false;
  }
  [[noreturn]] static void fail_terminated() { throw std::runtime_error("the FMU requests the end of the simulation"); }

  const fmu::ForeignModel model_;
  const std::string folder_;
  const SlaveVariables variables_;
  Library library_;
  std::string message_;   ///< the last that the FMU gave
  bool is_lost_ = false;  ///< after a fatal error nothing may be called
  void* own_ = nullptr;
  void* state_ = nullptr;
  bool is_running_ = false;
  void (*free_)(void*) = nullptr;
  int (*exit_)(void*) = nullptr;
  int (*terminate_)(void*) = nullptr;
  int (*get_state_)(void*, void**) = nullptr;
  int (*set_state_)(void*, void*) = nullptr;
  int (*free_state_)(void*, void**) = nullptr;
  int (*get_size_)(void*, void*, std::size_t*) = nullptr;
  int (*serialize_)(void*, void*, void*, std::size_t) = nullptr;
  int (*deserialize_)(void*, const void*, std::size_t, void**) = nullptr;
};

/// Values rounded to integers of type T. \throws std::runtime_error if one is out of the range of T.
template <class T>
std::vector<T> convert(const double* values, const fmu::ForeignVariable& v) {
  using Limits = std::numeric_limits<T>;
  std::vector<T> converted(static_cast<std::size_t>(v.size));
  for (int i = 0; i < v.size; ++i) {
    const double rounded = std::nearbyint(values[i]);
    // max() of 64 bits is no double, the power of two above it is.
    if (!(rounded >= static_cast<double>(Limits::lowest()) && rounded < std::ldexp(1.0, Limits::digits))) {
      std::ostringstream message;
      message << "its variable '" << v.name << "' takes integers from " << +Limits::lowest() << " to " << +Limits::max()
              << ", not " << values[i];
      throw std::runtime_error(message.str());
    }
    converted[static_cast<std::size_t>(i)] = static_cast<T>(rounded);
  }
  return converted;
}

void log2(fmi2ComponentEnvironment environment, fmi2String, fmi2Status, fmi2String, fmi2String message, ...) {
  char text[2000];
  va_list list;
  va_start(list, message);
  std::vsnprintf(text, sizeof text, message != nullptr ? message : "", list);
  va_end(list);
  *static_cast<std::string*>(environment) = text;
}

class Slave2 final : public SlaveBase {
 public:
  Slave2(const fmu::ForeignModel& model, const std::string& folder, SlaveVariables variables)
      : SlaveBase(model, folder, std::move(variables)) {
    library_.find("fmi2Instantiate", instantiate_);
    library_.find("fmi2SetupExperiment", setup_);
    library_.find("fmi2EnterInitializationMode", enter_);
    library_.find("fmi2DoStep", do_step_);
    library_.find_optional("fmi2GetBooleanStatus", get_status_);  // needed after Discard only
    library_.find("fmi2SetReal", set_real_);
    library_.find("fmi2GetReal", get_real_);
    library_.find("fmi2SetInteger", set_integer_);
    library_.find("fmi2GetInteger", get_integer_);
    library_.find("fmi2SetBoolean", set_boolean_);
    library_.find("fmi2GetBoolean", get_boolean_);
    find_shared("fmi2", "FMUstate", "DeSerialize");
  }
  ~Slave2() override { end(); }

  void start(double t, const double* parameters, const double* inputs) override {
    end();
    message_.clear();
    const std::string uri = "file://" + folder_ + "/resources";
    own_ = instantiate_(kName, fmi2CoSimulation, model_.token.c_str(), uri.c_str(), &callbacks_, 0, 1);
    if (own_ == nullptr)
      throw std::runtime_error("fmi2Instantiate gave no instance" +
                               (message_.empty() ? std::string() : ": " + message_));
    set(variables_.parameters, parameters);
    set_texts<int(fmi2Component, const fmi2ValueReference*, std::size_t, const fmi2String*)>("fmi2SetString");
    check(setup_(own_, 0, 0, t, 0, 0), "fmi2SetupExperiment");
    check(enter_(own_), "fmi2EnterInitializationMode");
    if (inputs != nullptr) set_inputs(inputs);
    check(exit_(own_), "fmi2ExitInitializationMode");
    is_running_ = true;
  }
  void step(double t, double step) override {
    const int status = do_step_(own_, t, step, !model_.can_save_state);
    fmi2Boolean is_terminated = 0;
    if (status == kDiscard && get_status_ != nullptr && get_status_(own_, fmi2Terminated, &is_terminated) == fmi2OK &&
        is_terminated)
      fail_terminated();
    check(status, "fmi2DoStep");
  }

 private:
  void set_one(const fmu::ForeignVariable& v, const double* values) override {
    switch (v.type) {
      case fmu::ValueType::Int32:
        return check(set_integer_(own_, &v.reference, 1, convert<int>(values, v).data()), "fmi2SetInteger");
      case fmu::ValueType::Boolean: {
        const fmi2Boolean value = *values != 0;
        return check(set_boolean_(own_, &v.reference, 1, &value), "fmi2SetBoolean");
      }
      default:
        return check(set_real_(own_, &v.reference, 1, values), "fmi2SetReal");
    }
  }
  void get_one(const fmu::ForeignVariable& v, double* values) override {
    int value = 0;
    switch (v.type) {
      case fmu::ValueType::Int32:
        check(get_integer_(own_, &v.reference, 1, &value), "fmi2GetInteger");
        *values = value;
        return;
      case fmu::ValueType::Boolean:
        check(get_boolean_(own_, &v.reference, 1, &value), "fmi2GetBoolean");
        *values = value;
        return;
      default:
        check(get_real_(own_, &v.reference, 1, values), "fmi2GetReal");
    }
  }

  using Get = int(fmi2Component, const fmi2ValueReference*, std::size_t, int*);
  using Set = int(fmi2Component, const fmi2ValueReference*, std::size_t, const int*);
  fmi2Component (*instantiate_)(fmi2String, fmi2Type, fmi2String, fmi2String, const fmi2CallbackFunctions*, fmi2Boolean,
                                fmi2Boolean) = nullptr;
  int (*enter_)(fmi2Component) = nullptr;
  int (*setup_)(fmi2Component, fmi2Boolean, fmi2Real, fmi2Real, fmi2Boolean, fmi2Real) = nullptr;
  int (*do_step_)(fmi2Component, fmi2Real, fmi2Real, fmi2Boolean) = nullptr;
  int (*get_status_)(fmi2Component, fmi2StatusKind, fmi2Boolean*) = nullptr;
  int (*set_real_)(fmi2Component, const fmi2ValueReference*, std::size_t, const fmi2Real*) = nullptr;
  int (*get_real_)(fmi2Component, const fmi2ValueReference*, std::size_t, fmi2Real*) = nullptr;
  Set *set_integer_ = nullptr, *set_boolean_ = nullptr;
  Get *get_integer_ = nullptr, *get_boolean_ = nullptr;

  fmi2CallbackFunctions callbacks_{log2, std::calloc, std::free, nullptr, &message_};
};

void log3(fmi3InstanceEnvironment environment, fmi3Status, fmi3String, fmi3String message) {
  *static_cast<std::string*>(environment) = message != nullptr ? message : "";
}

class Slave3 final : public SlaveBase {
 public:
  Slave3(const fmu::ForeignModel& model, const std::string& folder, SlaveVariables variables)
      : SlaveBase(model, folder, std::move(variables)) {
    library_.find("fmi3InstantiateCoSimulation", instantiate_);
    library_.find("fmi3EnterInitializationMode", enter_);
    library_.find("fmi3DoStep", do_step_);
    find_shared("fmi3", "FMUState", "Deserialize");
  }
  ~Slave3() override { end(); }

  void start(double t, const double* parameters, const double* inputs) override {
    end();
    message_.clear();
    const std::string resources = folder_ + "/resources/";
    own_ = instantiate_(kName, model_.token.c_str(), resources.c_str(), false, true, false, false, nullptr, 0,
                        &message_, log3, nullptr);
    if (own_ == nullptr)
      throw std::runtime_error("fmi3InstantiateCoSimulation gave no instance" +
                               (message_.empty() ? std::string() : ": " + message_));
    set(variables_.parameters, parameters);
    set_texts<int(fmi3Instance, const fmi3ValueReference*, std::size_t, const fmi3String*, std::size_t)>(
        "fmi3SetString", std::size_t{1});
    check(enter_(own_, false, 0, t, false, 0), "fmi3EnterInitializationMode");
    if (inputs != nullptr) set_inputs(inputs);
    check(exit_(own_), "fmi3ExitInitializationMode");
    is_running_ = true;
  }
  void step(double t, double step) override {
    bool needs_event = false, is_terminated = false, is_early = false;
    double reached = t;
    const int status =
        do_step_(own_, t, step, !model_.can_save_state, &needs_event, &is_terminated, &is_early, &reached);
    if (status <= kDiscard && is_terminated) fail_terminated();
    check(status, "fmi3DoStep");
    if (is_early)
      throw std::runtime_error("an early return at t = " + std::to_string(reached) + ", which is not allowed");
  }

 private:
  /// Functions of a type are looked up when a variable has it.
  template <class T>
  void set_values(const char* name, const fmu::ForeignVariable& v, const std::vector<T>& values) {
    int (*function)(fmi3Instance, const fmi3ValueReference*, std::size_t, const T*, std::size_t) = nullptr;
    library_.find(name, function);
    check(function(own_, &v.reference, 1, values.data(), values.size()), name);
  }
  template <class T>
  void get_values(const char* name, const fmu::ForeignVariable& v, double* to) {
    int (*function)(fmi3Instance, const fmi3ValueReference*, std::size_t, T*, std::size_t) = nullptr;
    library_.find(name, function);
    const std::unique_ptr<T[]> values(new T[static_cast<std::size_t>(v.size)]());
    check(function(own_, &v.reference, 1, values.get(), static_cast<std::size_t>(v.size)), name);
    for (int i = 0; i < v.size; ++i) to[i] = static_cast<double>(values[static_cast<std::size_t>(i)]);
  }
  void set_boolean(const fmu::ForeignVariable& v, const double* x) {
    int (*function)(fmi3Instance, const fmi3ValueReference*, std::size_t, const bool*, std::size_t) = nullptr;
    library_.find("fmi3SetBoolean", function);
    const auto n = static_cast<std::size_t>(v.size);
    const std::unique_ptr<bool[]> values(new bool[n]);
    for (std::size_t i = 0; i < n; ++i) values[i] = x[i] != 0;
    check(function(own_, &v.reference, 1, values.get(), n), "fmi3SetBoolean");
  }
  /// Calls use(T{}, name) for the C type T of a value and the end of the names of the functions that get and set it.
  template <class Use>
  static void visit_type(fmu::ValueType type, const Use& use) {
    using enum fmu::ValueType;
    if (type == Float32) return use(float{}, "Float32");
    if (type == Int8) return use(std::int8_t{}, "Int8");
    if (type == UInt8) return use(std::uint8_t{}, "UInt8");
    if (type == Int16) return use(std::int16_t{}, "Int16");
    if (type == UInt16) return use(std::uint16_t{}, "UInt16");
    if (type == Int32) return use(std::int32_t{}, "Int32");
    if (type == UInt32) return use(std::uint32_t{}, "UInt32");
    if (type == Int64) return use(std::int64_t{}, "Int64");
    if (type == UInt64) return use(std::uint64_t{}, "UInt64");
    if (type == Boolean) return use(bool{}, "Boolean");
    use(double{}, "Float64");
  }
  void set_one(const fmu::ForeignVariable& v, const double* x) override {
    visit_type(v.type, [&](auto kind, const std::string& type) {
      using T = decltype(kind);
      if constexpr (std::is_same_v<T, bool>)
        set_boolean(v, x);
      else if constexpr (std::is_integral_v<T>)
        set_values(("fmi3Set" + type).c_str(), v, convert<T>(x, v));
      else
        set_values(("fmi3Set" + type).c_str(), v, std::vector<T>(x, x + v.size));
    });
  }
  void get_one(const fmu::ForeignVariable& v, double* y) override {
    visit_type(v.type, [&](auto kind, const std::string& type) {
      get_values<decltype(kind)>(("fmi3Get" + type).c_str(), v, y);
    });
  }

  fmi3Instance (*instantiate_)(fmi3String, fmi3String, fmi3String, fmi3Boolean, fmi3Boolean, fmi3Boolean, fmi3Boolean,
                               const fmi3ValueReference*, std::size_t, fmi3InstanceEnvironment, fmi3LogMessageCallback,
                               fmi3IntermediateUpdateCallback) = nullptr;
  int (*enter_)(fmi3Instance, fmi3Boolean, fmi3Float64, fmi3Float64, fmi3Boolean, fmi3Float64) = nullptr;
  int (*do_step_)(fmi3Instance, fmi3Float64, fmi3Float64, fmi3Boolean, fmi3Boolean*, fmi3Boolean*, fmi3Boolean*,
                  fmi3Float64*) = nullptr;
};

}  // namespace

std::string get_binary_path(const fmu::ForeignModel& model, const std::string& folder) {
  return folder + "/binaries/" + (model.version == 2 ? platform::kFmi2Platform : platform::kFmi3Platform) + "/" +
         model.identifier + platform::kLibrarySuffix;
}

std::unique_ptr<Slave> load_slave(const fmu::ForeignModel& model, const std::string& folder, SlaveVariables variables) {
  if (model.version == 2) return std::make_unique<Slave2>(model, folder, std::move(variables));
  return std::make_unique<Slave3>(model, folder, std::move(variables));
}

}  // namespace bough::cosim
