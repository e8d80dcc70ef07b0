#pragma once
/// \file Checks of the numbers and words of a request, the same from the command line, C++ and Python.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/diagnostic.hpp"

namespace bough::analysis {

/// Throws InputError "cli.bad-range" unless `is_valid`: "--points is 0, expected a number from 1 to 100000".
/// \param option  as on the command line: "--points".
/// \param expected  noun phrase for the message.
template <class Number>
void demand_number(bool is_valid, const std::string& option, Number value, const std::string& expected) {
  if (!is_valid)
    throw InputError("cli.bad-range", {}, fmt::format("{} is {}, expected {}", option, value, expected),
                     fmt::format("give {} another value", option));
}

/// Throws InputError "cli.bad-range" unless the number is finite and above 0, or 0 if `takes_zero`.
inline void demand_positive(const std::string& option, double value, bool takes_zero = false) {
  demand_number(std::isfinite(value) && (value > 0 || (takes_zero && value == 0)), option, value,
                takes_zero ? "0 or a finite number above it" : "a finite number above 0");
}

/// Throws InputError "cli.bad-range" unless the number is finite.
inline void demand_finite(const std::string& option, double value) {
  demand_number(std::isfinite(value), option, value, "a finite number");
}

/// Throws InputError "cli.bad-range" unless min <= value <= max.
template <class Number>
void demand_range(const std::string& option, Number value, Number min, Number max) {
  demand_number(value >= min && value <= max, option, value, fmt::format("a number from {} to {}", min, max));
}

/// Throws InputError "cli.bad-option" unless the word is one of `words`; the advice lists them.
inline void demand_word(const std::string& option, const std::string& word, const std::vector<std::string>& words) {
  if (std::find(words.begin(), words.end(), word) == words.end())
    throw InputError("cli.bad-option", {}, fmt::format("{} is \"{}\"", option, word),
                     fmt::format("give one of {}", fmt::join(words, ", ")));
}

/// Throws InputError "cli.bad-option" for an empty list of files.
inline void demand_files(const std::vector<std::string>& files) {
  if (files.empty()) throw InputError("cli.bad-option", {}, "no file is given", "name at least one file");
}

}  // namespace bough::analysis
