#pragma once
/// \file Commands of the case control about responses: loads, frequencies, times, output requests and their sets.
#include <optional>
#include <string>
#include <string_view>

#include "formats/records/deck_dynamics.hpp"

namespace bough::nastran::detail {

enum class DynamicCommand { Read, BadValue, Other };

struct CommandText {
  const std::string& word;     ///< upper case
  const std::string& options;  ///< in brackets, upper case
  std::string_view value;
  records::CardLocation at;
};

/// Reads a command into `selected`, its location into `subcase`. Returns Other for other commands, and for requests
/// with an invalid value.
DynamicCommand read_dynamic_command(const CommandText& command, records::Subcase& subcase,
                                    records::DynamicSelection& selected);

/// "1, 3, 5 THRU 9 EXCEPT 7, 20.5", "ALL"; empty for anything else.
std::optional<records::CaseSet> read_case_set(std::string_view text);

}  // namespace bough::nastran::detail
