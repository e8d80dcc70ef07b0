#pragma once
/// \file [[controller]] and [[actuator]] of a system file, and the options common to all sensors.
#include <map>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "base/diagnostic.hpp"

namespace bough::records {

/// Keys of a table that depend on its type, unchanged; the type decides which are used.
struct Settings {
  std::map<std::string, std::vector<double>> numbers;     ///< a number or a list of numbers
  std::map<std::string, Eigen::MatrixXd> matrices;        ///< a list of rows, or out of `file`
  std::map<std::string, std::vector<std::string>> words;  ///< a text or a list of texts

  /// Returns true if a number, matrix or word has this key.
  bool has(const std::string& key) const { return numbers.count(key) + matrices.count(key) + words.count(key) > 0; }
  /// Returns the number of a key; `otherwise` if it is absent or a list.
  double get(const std::string& key, double otherwise) const {
    const auto it = numbers.find(key);
    return it == numbers.end() || it->second.size() != 1 ? otherwise : it->second[0];
  }
};

struct ControllerRecord {
  std::string name, type;
  std::vector<std::string> inputs;  ///< signals: "name", "name:component"
  std::string reference, rate;      ///< pid: signals; empty: none
  bool active = true;               ///< from the start, until an event disables it
  Settings settings;
  SourceLocation at;
};

struct ActuatorRecord {
  std::string name, type;
  std::string input;  ///< a signal, its command
  std::string body, hinge;
  int node = 0, coordinate = 1;
  std::string frame = "body";
  Settings settings;
  SourceLocation at;
};

enum class InputHold { Zero, Linear };

/// [[input]]: a signal that is set from outside.
struct InputRecord {
  std::string name;
  std::string dims;  ///< empty: not said
  double start = 0;
  InputHold hold = InputHold::Zero;  ///< linear: a new value is reached at the end of the next advance
  SourceLocation at;
};

/// [[connect]]: a signal into an input that does not name one.
struct ConnectRecord {
  std::string from;  ///< a signal: "name", "name:component"
  std::string to;    ///< a controller, actuator or force; "law:2", "law:reference", "law:rate": which input
  double gain = 1;
  SourceLocation at;
};

}  // namespace bough::records
