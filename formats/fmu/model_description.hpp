#pragma once
/// \file modelDescription.xml of FMI 2.0 and 3.0.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bough::fmu {

/// A unit as the product of powers of SI base units and a factor: a value in kg^a m^b s^c rad^d is factor times the
/// value in this unit.
struct Unit {
  std::string name;
  int kg = 0, m = 0, s = 0, rad = 0;
  double factor = 1;
};

struct Variable {
  std::string name, description;
  std::uint32_t reference = 0;
  double start = 0;  ///< of parameters and inputs
  /// References of the states, inputs and the time on which an output, derivative or event indicator depends; nullopt:
  /// all.
  std::optional<std::vector<std::uint32_t>> dependencies = std::nullopt;
  bool is_linear = false;  ///< a constant factor times the only dependency
  std::string unit = {};   ///< one of ModelDescription::units; empty: none
};

/// Reference of the independent variable, of FMI 3 only.
constexpr std::uint32_t kTimeReference = 0;

/// Represents what both versions describe: all variables are scalars of double precision.
struct ModelDescription {
  std::string model_name;  ///< any text
  std::string identifier;  ///< a C identifier: the name of the binary
  std::string token;       ///< guid, instantiation token
  std::string description, tool;
  double start = 0, stop = 1, tolerance = 1e-8, step = 0;  ///< default experiment; step 0: none
  std::vector<Variable> parameters, inputs, outputs;
  std::vector<Variable> states, derivatives;  ///< equal in number
  std::vector<Variable> event_indicators;
  std::vector<Unit> units;
  std::string time_unit;  ///< FMI 3; one of units; empty: none
};

/// Returns the text of modelDescription.xml. Equal descriptions give equal bytes: there is no date in it.
std::string format_fmi2(const ModelDescription& model);
std::string format_fmi3(const ModelDescription& model);

/// Returns a C identifier like `text`: other characters become underscores.
std::string make_identifier(const std::string& text);

}  // namespace bough::fmu
