#pragma once
/// \file Text and numbers as Nastran writes them.
#include <optional>
#include <string>
#include <string_view>

#include "formats/records/params.hpp"

namespace bough::nastran::detail {

/// Without blanks, tabs and carriage returns at both ends.
std::string_view trim(std::string_view text);
/// Letters of ASCII in upper case.
std::string make_upper(std::string_view text);
/// Equal without regard to case.
bool is_word(std::string_view text, std::string_view upper_case_word);
/// The first word of `text` (letters and digits after blanks), as written.
std::string_view find_first_word(std::string_view text);

/// An integer with an optional sign and nothing else; nothing if it is not one or does not fit an int.
std::optional<int> parse_int(std::string_view text);
using records::parse_real;
/// Component list "126" as a mask with bit c-1 set for component c; "0" is mask 0.
std::optional<unsigned> parse_components(std::string_view text);

}  // namespace bough::nastran::detail
