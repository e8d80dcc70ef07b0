#pragma once
/// \file Messages about errors of the command line.
#include <memory>
#include <string>
#include <utility>

namespace CLI {
class App;
class Formatter;
class Option;
class ParseError;
class Validator;
}  // namespace CLI

namespace bough::cli {

/// Message and advice: unknown options with the nearest one, the rest in the words of CLI11.
std::pair<std::string, std::string> describe_parse_error(const CLI::App& app, const CLI::ParseError& error);

/// Help in lines of eighty columns; the indented examples of a footer stay as they are.
std::shared_ptr<CLI::Formatter> make_formatter();

/// "csv vtu" of an option whose type reads "TEXT:{csv,vtu}"; empty for any other.
std::string list_choices(const CLI::Option& option);

/// Above 0; at least 0. CLI11's own name the largest double in their message.
CLI::Validator make_positive();
CLI::Validator make_not_negative();
/// Rejects nan and inf.
CLI::Validator make_finite();

}  // namespace bough::cli
