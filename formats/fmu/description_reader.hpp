#pragma once
/// \file Reads modelDescription.xml of FMI 2.0 and 3.0: what an importer for Co-Simulation needs.
#include <cstdint>
#include <string>
#include <vector>

namespace bough::fmu {

enum class ValueType {
  Float64,
  Float32,
  Int8,
  UInt8,
  Int16,
  UInt16,
  Int32,
  UInt32,
  Int64,
  UInt64,
  Boolean,
  String,
  Other
};

struct ForeignVariable {
  std::string name, causality;       ///< "input", "output", "parameter", ...
  std::vector<std::string> aliases;  ///< other names of it (FMI 3)
  std::uint32_t reference = 0;
  ValueType type = ValueType::Float64;  ///< Integer and Enumeration of FMI 2.0: Int32; Enumeration of 3.0: Int64
  int size = 1;                         ///< of an array the product of its dimensions; 0: they are not constant
  std::vector<int> dimensions;          ///< of an array; its elements are in the order of rows
  std::vector<double> start;            ///< `size` numbers; empty: none are given
};

/// Content of a modelDescription.xml with Co-Simulation.
struct ForeignModel {
  int version = 3;  ///< of FMI, 2 or 3
  std::string model_name, identifier, token;
  bool needs_tool = false;      ///< needsExecutionTool
  bool can_save_state = false;  ///< canGetAndSetFMUState and canSerializeFMUState
  double default_step = 0;      ///< stepSize of the default experiment; 0: none
  std::vector<ForeignVariable> variables;
};

/// \param text  content of modelDescription.xml
/// \param path  of the FMU, for messages
/// \throws InputError "fmu.bad-description", "fmu.version", "fmu.no-cosimulation".
ForeignModel read_model_description(const std::string& text, const std::string& path);

}  // namespace bough::fmu
