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
  Simulation(const embed::LoadedSystem& loaded, const embed::SimulationOptions& options);

  void set(const Name& name, double value);
  bool advance_to(double t);
  py::array outputs(const std::optional<std::vector<std::string>>& names);
  double output(const Name& name);
  std::vector<std::string> list_names(int kind) const;
  double time() const { return own_->simulator().time(); }
  std::string get_reason() const;
  py::bytes save();
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

void bind_simulations(py::module_& m);

}  // namespace bough::python
