#pragma once
/// \file Ranges of the numbers that options take, with messages that name the number found.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

namespace bough::cli {

/// A number from `min` to `max`.
template <class Number>
CLI::Validator is_within(Number min, Number max) {
  CLI::Validator check = CLI::Range(min, max);  // its text for --help
  check.operation([min, max](std::string& text) {
    Number value{};
    if (CLI::detail::lexical_cast(text, value) && value >= min && value <= max) return std::string{};
    return fmt::format("expected a number from {} to {}, found {}", min, max, text);
  });
  return check;
}

/// A number above 0.
inline CLI::Validator is_positive() {
  CLI::Validator check = CLI::PositiveNumber;
  check.operation([](std::string& text) {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && value > 0) return std::string{};
    return fmt::format("expected a number above 0, found {}", text);
  });
  return check;
}

/// 0 or a number above it.
inline CLI::Validator is_not_negative() {
  CLI::Validator check = CLI::NonNegativeNumber;
  check.operation([](std::string& text) {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && value >= 0) return std::string{};
    return fmt::format("expected 0 or a number above it, found {}", text);
  });
  return check;
}

}  // namespace bough::cli
