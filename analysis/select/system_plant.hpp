#pragma once
/// \file The linear model of a whole system with all modes of its bodies, or with some of them.
#include <optional>
#include <string>
#include <vector>

#include "analysis/common/system_files.hpp"
#include "formats/records/linear_model.hpp"

namespace bough::analysis {

struct OperatingChoice {
  std::optional<double> at;
  bool equilibrium = false, open = false;
  std::vector<std::string> inputs, outputs, set;
};

/// A mode of a flexible body of a system: state NAME:etaM, M = mode + 1.
struct BodyMode {
  std::string body;
  int mode = 0;
};

class SystemPlant {
 public:
  /// Loads the system; the path is relative to the working directory.
  SystemPlant(const std::string& system, OperatingChoice choice, Diagnostics& diagnostics);

  /// Modes, per mode of this file, of the bodies that have the file. Throws InputError "select.body-not-in-system" if
  /// there is none.
  std::vector<std::vector<BodyMode>> list_uses(const std::string& body_file) const;
  /// Forces (or hinges) to sensors, by all modes. Throws InputError "select.sampled" if loops are sampled.
  records::LinearModel linearize(Diagnostics& diagnostics) const;
  /// Linear model with these modes only of every body of which `all` has a mode. A body without any is rigid.
  records::LinearModel linearize_with(const std::vector<BodyMode>& all, const std::vector<BodyMode>& kept) const;

 private:
  records::LinearModel linearize(const LoadedSystem& loaded, Diagnostics& diagnostics) const;

  std::string file_;  ///< of the system
  OperatingChoice choice_;
  LoadedSystem loaded_;
};

/// Throws InputError "select.levels" if the body of the system file has fill levels.
void demand_one_level(const records::BodyRecord& body, const std::string& system);
/// Cuts the values of a body's record, one per mode of its file, to the modes kept, ascending, and sets their number.
void keep_values(records::BodyRecord& body, const std::vector<int>& kept);

}  // namespace bough::analysis
