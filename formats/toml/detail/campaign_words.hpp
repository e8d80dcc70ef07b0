#pragma once
/// \file Words of a campaign: cells of its table of cases, words of its commands.
#include <string>
#include <vector>

#include "formats/toml/campaign.hpp"

namespace bough::toml_files {

/// Removes blanks, tabs and carriage returns from both ends.
std::string trim(const std::string& text);

/// Cells between commas, without the blanks around them; double quotes keep commas.
std::vector<std::string> split_cells(const std::string& line);
/// A cell of a CSV file: an integer, a real, true or false, else a word.
Setting read_cell(const std::string& cell);

/// Words between blanks; quotes, single or double, keep blanks.
std::vector<std::string> split_words(const std::string& text);

}  // namespace bough::toml_files
