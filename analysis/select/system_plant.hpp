#pragma once
/// \file The linear model of a whole system with all modes of one of its body files, or with some of them.
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

class SystemPlant {
 public:
  /// Throws InputError "select.body-not-in-system" when no body of the system has the file `body`.
  SystemPlant(const std::string& system, const std::string& body, OperatingChoice choice, Diagnostics& diagnostics);

  /// Names of the bodies with that file.
  const std::vector<std::string>& users() const { return users_; }
  /// Forces (or hinges) to sensors, by all modes. Throws InputError "select.sampled" if loops are sampled.
  records::LinearModel linearize(Diagnostics& diagnostics) const;
  /// Linear model with these modes of the file only.
  records::LinearModel linearize_with(const std::vector<int>& kept) const;

 private:
  records::LinearModel linearize(const LoadedSystem& loaded, Diagnostics& diagnostics) const;

  std::string file_, key_;  ///< of the system; of the body as the system names it
  OperatingChoice choice_;
  LoadedSystem loaded_;
  std::vector<std::string> users_;
};

}  // namespace bough::analysis
