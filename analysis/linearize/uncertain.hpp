#pragma once
/// \file Linear fractional models of systems with uncertain parameters, out of system files.
#include <string>
#include <vector>

#include "analysis/linearize/linearize.hpp"

namespace bough::analysis {

/// "NAME=LOW:HIGH": a number of [parameters], or a factor on a modal coordinate of a body, "BODY:eta3:stiffness" of its
/// modal stiffness, "BODY:eta3:frequency" of its square root, "BODY:eta3:damping" of its modal damping.
struct UncertainRange {
  std::string name;
  double low = 0, high = 0;
  std::string body, kind;  ///< of a factor; empty: a parameter
  int mode = 0;            ///< of a factor, from 1
};

/// \throws InputError "cli.bad-uncertain" for a text that is no range, or a factor that is negative
UncertainRange parse_uncertain(const std::string& text);
/// \throws InputError "cli.bad-uncertain" as of one text, or for a name given twice
std::vector<UncertainRange> parse_uncertain(const std::vector<std::string>& texts);

/// The model with all parameters of request.uncertain in the middle of their ranges, and inputs and outputs through
/// which they act (statespace::make_uncertain_model). The middle of a frequency is that of its square.
/// `load`: how the system is read, with the values of the request's parameters in `set`.
records::LinearModel linearize_uncertain(const LinearizeRequest& request, const LoadOptions& load,
                                         Diagnostics& diagnostics);

}  // namespace bough::analysis
