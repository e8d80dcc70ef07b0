#pragma once
/// \file Reads the parameters of a [[function]] by name. For the makers of functions of time.
#include <cmath>
#include <set>

#include "solver/functions/function.hpp"
#include "solver/text/names.hpp"

namespace bough::solver {

/// Reads parameters by name and reports what is missing, unknown or not finite.
class FunctionParameters {
 public:
  FunctionParameters(const records::FunctionRecord& record, Diagnostics& diagnostics)
      : record_(record), diagnostics_(diagnostics) {}

  /// Returns true if the function has the parameter.
  bool has(const std::string& key) const { return record_.values.count(key) > 0; }
  /// Returns a required parameter. Reports "function.missing-parameter", and "function.bad-value" if it is not finite.
  double get(const std::string& key) {
    known_.insert(key);
    const auto it = record_.values.find(key);
    if (it == record_.values.end()) {
      error("function.missing-parameter", "has no '" + key + "'", "give " + key + " = NUMBER");
      return 0;
    }
    return check(key, it->second);
  }
  /// Returns a parameter, or `otherwise` if it is absent.
  double get(const std::string& key, double otherwise) {
    known_.insert(key);
    const auto it = record_.values.find(key);
    return it == record_.values.end() ? otherwise : check(key, it->second);
  }
  /// Reports "function.unknown-parameter" for each parameter that was not read.
  void refuse_others() {
    for (const auto& [key, value] : record_.values) {
      if (known_.count(key)) continue;
      const std::vector<std::string> names(known_.begin(), known_.end());
      std::string list;
      for (const auto& name : names) list += (list.empty() ? "" : ", ") + name;
      error("function.unknown-parameter", "has the parameter '" + key + "', which " + record_.type + " does not take",
            suggest_name(key, names, "it takes: " + (list.empty() ? "none" : list)));
    }
  }
  /// Reports "function.bad-value" unless the condition holds or an error was reported before.
  void demand(bool condition, const std::string& what, const std::string& advice) {
    if (!condition && !failed_) error("function.bad-value", what, advice);
  }
  /// Reports an error of this function; `what` follows its name and type.
  void error(const char* id, const std::string& what, const std::string& advice) {
    failed_ = true;
    diagnostics_.error(id, record_.at, "function '" + record_.name + "' of type " + record_.type + " " + what, advice);
  }
  /// Returns true after an error.
  bool failed() const { return failed_; }

 private:
  double check(const std::string& key, double value) {
    if (!std::isfinite(value))
      error("function.nan", "has a " + key + " that is not a finite number", "give a finite value");
    return value;
  }

  const records::FunctionRecord& record_;
  Diagnostics& diagnostics_;
  std::set<std::string> known_;
  bool failed_ = false;
};

/// sawtooth, doublet, chirp, sweep, harmonics, random; nullptr for another type. Errors are in `p`.
std::unique_ptr<const TimeFunction> make_wave(const records::FunctionRecord& record, const TimeSpan& run,
                                              FunctionParameters& p);
/// A formula of t by muParser, its rate and its acceleration where they are given.
std::unique_ptr<const TimeFunction> make_time_expression(const records::FunctionRecord& record, const TimeSpan& run,
                                                         FunctionParameters& p);
/// sum, product of functions already made.
std::unique_ptr<const TimeFunction> make_combination(const records::FunctionRecord& record, const FunctionMap& others,
                                                     FunctionParameters& p);

}  // namespace bough::solver
