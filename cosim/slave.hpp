#pragma once
/// \file Co-Simulation slave of an FMU, FMI 2.0 and 3.0, with one interface.
///
/// Source: FMI 2.0.4 chapter 4, FMI 3.0.1 chapter 4.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "formats/fmu/description_reader.hpp"

namespace bough::cosim {

/// A slave whose binary is loaded. One thread at a time. All functions throw std::runtime_error with the function of
/// FMI, its status and the last message of the FMU.
class Slave {
 public:
  virtual ~Slave() = default;
  Slave(const Slave&) = delete;
  Slave& operator=(const Slave&) = delete;

  /// Creates a new instance and initializes it. The values belong to `variables`, one after the
  /// other; inputs may be null: the start values of the FMU stay.
  virtual void start(double t, const double* parameters, const double* inputs) = 0;
  /// Sets all inputs, in the order of `variables`.
  virtual void set_inputs(const double* values) = 0;
  /// Reads all outputs, in the order of `variables`.
  virtual void get_outputs(double* values) = 0;
  /// Advances from t by `step` [T].
  virtual void step(double t, double step) = 0;
  /// Serialized state; both need can_save_state.
  virtual std::string save() = 0;
  virtual void restore(const std::string& bytes) = 0;

 protected:
  Slave() = default;
};

struct SlaveVariables {
  std::vector<fmu::ForeignVariable> parameters, inputs, outputs;
  std::vector<std::pair<fmu::ForeignVariable, std::string>> texts;  ///< values of string parameters
};

/// Loads the binary from the folder of the unpacked FMU.
///
/// \throws std::runtime_error where it cannot be loaded or lacks functions.
std::unique_ptr<Slave> load_slave(const fmu::ForeignModel& model, const std::string& folder, SlaveVariables variables);

/// Path of the binary for this machine in the folder of an unpacked FMU.
std::string get_binary_path(const fmu::ForeignModel& model, const std::string& folder);

}  // namespace bough::cosim
