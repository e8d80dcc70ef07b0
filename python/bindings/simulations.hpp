#pragma once
/// \file A system that is advanced from Python.
#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "embed/ports.hpp"
#include "embed/simulation.hpp"
#include "python/bindings/bindings.hpp"

namespace bough::python {

/// Other Python threads go on while it computes; it belongs to one thread at a time, a second one is an error.
class Simulation {
 public:
  using Name = std::variant<int, std::string>;

  /// \param loaded  must outlive it.
  /// \param start  memory and states of controllers and actuators to start from; none: those of the system file.
  Simulation(const embed::LoadedSystem& loaded, const embed::SimulationOptions& options,
             std::optional<records::Checkpoint> start);

  /// Sets an input from the present time on. Raises ValueError for a value that is not finite.
  void set(const Name& name, double value);
  /// Advances to t [T] without the interpreter lock. Returns False if the run has ended; raises ValueError for a time
  /// that has passed, KeyboardInterrupt after Ctrl-C.
  bool advance_to(double t);
  /// Returns the outputs of these names, in their order, at the present time; None: all outputs.
  py::array outputs(const std::optional<std::vector<std::string>>& names);
  /// Returns one output at the present time.
  double output(const Name& name);
  /// Names of all ports of a bough_kind, in the order of their indices.
  std::vector<std::string> list_names(int kind) const;
  /// Time [T] reached.
  double time() const { return own_->simulator().time(); }
  /// Describes the end of the run; empty if the run goes on.
  std::string get_reason() const;
  /// Returns the state as bytes; raises the error of a failed advance.
  py::bytes save();
  /// Continues from the bytes of save(), also after a failed advance.
  void restore(const std::string& bytes);

  std::vector<Diagnostic> messages;

 private:
  int find(int kind, const Name& name) const;
  Eigen::VectorXd calc_outputs(const std::vector<int>& indices);
  /// Runs `action` where no other call is within.
  template <class Action>
  auto run(const Action& action);

  std::atomic<bool> stop_{false};
  bool is_busy_ = false, is_interrupted_ = false;
  std::exception_ptr failure_;  ///< of an advance; until restore()
  std::unique_ptr<embed::Simulation> own_;
  std::unique_ptr<embed::Ports> ports_;
};

/// Defines Simulation.
void bind_simulations(py::module_& m);

}  // namespace bough::python
