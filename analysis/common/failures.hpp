#pragma once
/// \file Failures with the file that they concern and the messages before them.
#include <functional>
#include <string>

#include "base/diagnostic.hpp"

namespace bough::analysis {

/// A mechanism and a model without mass count as wrong input (docs/adr/0006).
int choose_exit_code(const Failure& failure);
/// Returns the message with location `file` if it has none and does not concern the command line.
Diagnostic locate(Diagnostic diagnostic, const std::string& file);

/// Runs `act`; its failure is thrown again after the `prior` messages, so that none of them is lost.
void with_prior_messages(const Diagnostics& prior, const std::function<void()>& act);

/// Runs `act`; its failures without location get the location `file`, and so do those of fe and modal with the location
/// `excluded_file`, a file whose numbers were not used.
int with_file(const std::string& file, const std::function<int()>& act, const std::string& excluded_file = "");

}  // namespace bough::analysis
