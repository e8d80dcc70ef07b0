// Controllers of the user: a shared library with the functions of bough_controller.h. Only the file that is named is
// loaded.
#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <tuple>

#include "base/foreign_call.hpp"
#include "solver/control/hosted.hpp"
#include "solver/control/makers.hpp"
#include "solver/control/user_code.hpp"
#include "solver/signals/graph.hpp"

namespace bough::solver {
namespace {

/// A vector of this length takes 8 MB, a Jacobian 800 MB to 8 GB: a larger size is a fault of the library.
constexpr int kMaxStates = 10000, kMaxValues = 1000000;

/// Functions that hosts lend, by file. Systems are built in several threads at once.
struct Hosted {
  std::mutex lock;
  std::map<std::string, ControllerFunctions> by_file;
};
Hosted& get_hosted() {
  static Hosted hosted;
  return hosted;
}

constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();

class Library final : public UserBlock {
 public:
  /// True without a sample time: the use of t by the library is not known.
  bool depends_on_time() const override { return sizes.sample_time == 0; }
  bool is_opaque() const override { return f_.is_opaque; }
  bool is_forward_only() const override { return f_.is_forward_only; }
  /// `handle` of dlopen; null where a host lends the functions.
  Library(void* handle, ControllerFunctions f) : handle_(handle), f_(std::move(f)) {}
  ~Library() override {
    if (*is_open_ && f_.close != nullptr) {
      const ForeignCall marked(at, label, f_.language, "bough_controller_close");
      f_.close(own.instance);
    }
    const std::string no_language;
    const ForeignCall marked(at, label, no_language, "unloading of its library");
    f_ = {};
    if (handle_ != nullptr) dlclose(handle_);
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  bough_controller own{};
  void note_open() { *is_open_ = true; }

  void close() const override {
    if (!*is_open_ || f_.close == nullptr) return;
    *is_open_ = false;
    call(kNoTime, "bough_controller_close", [&] {
      f_.close(own.instance);
      return 0;
    });
  }
  void start(double* z, double* d) const override {
    if (f_.start != nullptr) call(0, "bough_controller_start", [&] { return f_.start(own.instance, z, d); });
  }
  void calc_outputs(const BlockInput& in, double* y) const override {
    evaluate(in, 0, sizes.outputs, y, [this](const BlockInput& at, double* to) {
      call(at.t, "bough_controller_outputs", [&] { return f_.outputs(own.instance, at.t, at.u, at.z, at.d, to); });
    });
  }
  void calc_rates(const BlockInput& in, double* z_dot) const override {
    evaluate(in, 1, sizes.states, z_dot, [this](const BlockInput& at, double* to) {
      call(at.t, "bough_controller_derivatives",
           [&] { return f_.derivatives(own.instance, at.t, at.u, at.z, at.d, to); });
      demand_finite(at.t, "derivative", to, sizes.states);
    });
  }
  void update(const BlockInput& in, double* d) const override {
    if (f_.update == nullptr) return;
    evaluate(in, 2, sizes.memory, d, [this](const BlockInput& at, double* to) {
      std::copy_n(at.d, sizes.memory, to);
      call(at.t, "bough_controller_update", [&] { return f_.update(own.instance, at.t, at.u, at.z, at.d, to); });
      demand_finite(at.t, "memory", to, sizes.memory);
    });
  }

 private:
  std::string describe_mending() const {
    if (f_.is_opaque) return "correct the FMU or its inputs";
    return "correct the " + (f_.language.empty() ? "library" : f_.language + " law");
  }
  /// law(in, y), or its tangent by u, z and d.
  template <class Law>
  void evaluate(const BlockInput& in, int slot, int num_y, double* y, const Law& law) const {
    if (in.tangents == nullptr) return law(in, y);
    if (f_.is_opaque)
      throw InputError("linear.fmu", at, label + " is an FMU, which no linear model can be made of",
                       "put a linear controller in its place, or set active = false");
    std::vector<double> x(in.u, in.u + sizes.inputs);
    x.insert(x.end(), in.z, in.z + sizes.states);
    x.insert(x.end(), in.d, in.d + sizes.memory);
    evaluate_black_box(
        in.tangents, as_owner(), slot, x, num_y,
        [&](const double* at, double* to) {
          BlockInput moved = in;
          moved.u = at;
          moved.z = at + sizes.inputs;
          moved.d = moved.z + sizes.states;
          law(moved, to);
        },
        y);
  }
  template <class Call>
  void call(double t, const char* function, const Call& action) const {
    const ForeignCall marked(at, label, f_.language, function, t);
    const auto fail = [&](const std::string& how, const std::string& advice) -> ComputationError {
      return {"control.library-failed", at, marked.describe() + how, advice};
    };
    int result = 0;
    // Its instance is one for all threads. A host guards its own functions (the Python module by the
    // interpreter's lock, which must not be waited for under this one).
    std::unique_lock one_at_a_time(*calls_, std::defer_lock);
    if (handle_ != nullptr) one_at_a_time.lock();
    try {
      result = action();
    } catch (const std::exception& error) {
      throw fail((f_.is_opaque          ? " failed: "
                  : f_.language.empty() ? " threw: "
                                        : " raised ") +
                     std::string(error.what()),
                 describe_mending());
    } catch (...) {
      throw fail(" threw an exception", describe_mending());
    }
    if (result != 0) throw fail(" returned " + std::to_string(result), "0 stands for success");
  }
  void demand_finite(double t, const char* noun, const double* values, int n) const {
    for (int i = 0; i < n; ++i) {
      if (std::isfinite(values[i])) continue;
      std::ostringstream what;
      what << label << ": " << noun << " " << i + 1 << " is " << values[i] << " at t = " << t;
      throw ComputationError("control.not-finite", at, what.str(), describe_mending());
    }
  }

  void* handle_;
  ControllerFunctions f_;
  std::unique_ptr<std::mutex> calls_ = std::make_unique<std::mutex>();
  std::unique_ptr<bool> is_open_ = std::make_unique<bool>(false);  ///< of the instance, which is no part of the block
};

template <class F>
void find_function(void* handle, const char* name, std::function<F>& to) {
  to = reinterpret_cast<F*>(dlsym(handle, name));
}

ControllerFunctions find_functions(void* handle) {
  ControllerFunctions f;
  find_function(handle, "bough_controller_version", f.version);
  find_function(handle, "bough_controller_open", f.open);
  find_function(handle, "bough_controller_outputs", f.outputs);
  find_function(handle, "bough_controller_start", f.start);
  find_function(handle, "bough_controller_derivatives", f.derivatives);
  find_function(handle, "bough_controller_update", f.update);
  find_function(handle, "bough_controller_close", f.close);
  return f;
}

}  // namespace

bool has_user_blocks(const SignalGraph& signals) {
  return std::ranges::any_of(
      signals.places, [](const auto& place) { return dynamic_cast<const UserBlock*>(place.block.get()) != nullptr; });
}

void demand_resumable(const SignalGraph& signals) {
  for (const auto& place : signals.places) {
    const auto* block = dynamic_cast<const UserBlock*>(place.block.get());
    if (block == nullptr || !block->is_forward_only()) continue;
    throw InputError("control.cannot-resume", block->at,
                     block->label +
                         " cannot go on from an earlier run: its FMU does not save its state "
                         "(canSerializeFMUState)",
                     "run it in one part, or take an FMU that saves its state");
  }
}

void close_user_blocks(const SignalGraph& signals) {
  for (const auto& place : signals.places)
    if (const auto* block = dynamic_cast<const UserBlock*>(place.block.get())) block->close();
}

HostedController::HostedController(std::string file, ControllerFunctions functions) : file_(std::move(file)) {
  const std::lock_guard held(get_hosted().lock);
  get_hosted().by_file[file_] = std::move(functions);
}
HostedController::~HostedController() {
  const std::lock_guard held(get_hosted().lock);
  get_hosted().by_file.erase(file_);
}

std::optional<ControllerFunctions> find_hosted_controller(const std::string& file) {
  const std::lock_guard held(get_hosted().lock);
  const auto found = get_hosted().by_file.find(file);
  if (found == get_hosted().by_file.end()) return std::nullopt;
  return found->second;
}

namespace {

std::unique_ptr<Block> make_library(SettingsReader& keys, const ControllerWiring& wiring, const std::string& file) {
  const std::vector<double> parameters = keys.has("parameters") ? keys.get_list("parameters") : std::vector<double>();
  const double sample_time = keys.get("sample_time", 0);
  if (file.empty()) {
    keys.error("control.missing-key", "has no 'file'", "give the shared library");
    return nullptr;
  }
  const auto hosted = find_hosted_controller(file);
  const std::string language = hosted ? hosted->language : "";
  void* handle = nullptr;
  if (!hosted) {
    const ForeignCall marked(keys.get_place(), keys.get_owner(), language, "loading of its library");
    handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  }
  if (!hosted && handle == nullptr) {
    const char* why = dlerror();
    keys.error("control.bad-library", std::string("cannot load its library: ") + (why ? why : file),
               "check the path, and that it was linked as a shared library");
    return nullptr;
  }
  const ControllerFunctions f = hosted ? *hosted : find_functions(handle);
  auto made = std::make_unique<Library>(handle, f);
  made->label = keys.get_owner();
  made->at = keys.get_place();
  const auto refuse = [&](const std::string& what, const std::string& advice) {
    const std::string of = f.is_opaque          ? "an FMU"
                           : f.language.empty() ? "a library " + file
                                                : "a " + f.language + " law";
    keys.error("control.bad-library", "has " + of + " " + what, advice);
    return nullptr;
  };
  if (f.version == nullptr || f.open == nullptr || f.outputs == nullptr)
    return refuse("without bough_controller_version, _open or _outputs", "see bough_controller.h");
  if (const int version = f.version(); version != BOUGH_CONTROLLER_VERSION)
    return refuse("made for version " + std::to_string(version) + " of the interface, this is " +
                      std::to_string(BOUGH_CONTROLLER_VERSION),
                  "compile it again");
  bough_controller& own = made->own;
  own.inputs = wiring.size();
  own.num_parameters = static_cast<int>(parameters.size());
  own.parameters = parameters.data();
  own.outputs = own.has_feedthrough = 1;
  own.sample_time = sample_time;
  int result = 0;
  try {
    const ForeignCall marked(keys.get_place(), keys.get_owner(), language, "bough_controller_open");
    result = f.open(&own);
  } catch (const std::exception& error) {
    if (f.is_opaque)
      return refuse("that cannot be used: " + std::string(error.what()), "correct the FMU, or its keys here");
    if (!f.language.empty()) return refuse("of no use: " + std::string(error.what()), "see bough.System");
    return refuse(std::string("whose bough_controller_open threw: ") + error.what(), "correct the library");
  } catch (...) {
    return refuse("whose bough_controller_open threw an exception", "correct the library");
  }
  if (result != 0) return refuse("whose bough_controller_open returned " + std::to_string(result), "0 is success");
  made->note_open();
  if (own.outputs < 1 || own.states < 0 || own.memory < 0)
    return refuse("that set impossible sizes", "give outputs >= 1, states >= 0, memory >= 0");
  using Size = std::tuple<const char*, int, int>;
  for (const auto& [noun, size, limit] :
       {Size("outputs", own.outputs, kMaxValues), Size("states", own.states, kMaxStates),
        Size("memory", own.memory, kMaxValues)}) {
    if (size > limit)
      return refuse("that set " + std::string(noun) + " to " + std::to_string(size),
                    "the limit is " + std::to_string(limit) + "; see bough_controller_open");
  }
  if (own.states > 0 && f.derivatives == nullptr)
    return refuse("with states and without bough_controller_derivatives", "export it");
  if (own.memory > 0 && !(sample_time > 0)) return refuse("with memory and no sample_time", "give sample_time");
  if (own.memory > 0 && f.update == nullptr)
    return refuse("with memory and without bough_controller_update", "export it");
  made->sizes.outputs = own.outputs;
  made->sizes.states = own.states;
  made->sizes.memory = own.memory;
  made->sizes.has_feedthrough = own.has_feedthrough != 0;
  return made;
}

}  // namespace

std::unique_ptr<Block> make_fmu(SettingsReader& keys, const ControllerWiring& wiring) {
  keys.accept({"input_names", "output_names", "parameter_names", "string_parameters", "parameters", "file"});
  const std::string lent = keys.get_lent();
  if (!find_hosted_controller(lent)) {
    keys.error("control.no-fmu", "is an FMU, which this program does not read", "use bough run, or bough in Python");
    return nullptr;
  }
  return make_library(keys, wiring, lent);
}

std::unique_ptr<Block> make_library(SettingsReader& keys, const ControllerWiring& wiring) {
  return make_library(keys, wiring, keys.get_word("file", ""));
}

}  // namespace bough::solver
