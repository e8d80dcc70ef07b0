#include "analysis/common/spectrum_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "analysis/common/inputs.hpp"
#include "base/diagnostic.hpp"

namespace bough::analysis {

statespace::Spectrum read_spectrum(const std::string& path, const std::vector<std::string>& inputs,
                                   const std::string& id) {
  demand_file(path);
  std::ifstream in(path);
  std::string line, word;
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
  const auto fail = [&](int number, const std::string& what) {
    return InputError(id, {path, number}, what,
                      "give rows of frequency_hz and a density for all inputs, or for each that the header names");
  };
  for (int number = 1; std::getline(in, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> words;
    std::stringstream fields(line);
    while (std::getline(fields, word, ',')) words.push_back(word);
    if (names.empty() && rows.empty() && std::isalpha(static_cast<unsigned char>(line[0]))) {
      names = words;
      continue;
    }
    std::vector<double> row;
    for (const auto& text : words) {
      char* end = nullptr;
      row.push_back(std::strtod(text.c_str(), &end));
      if (text.empty() || *end != '\0' || !std::isfinite(row.back())) throw fail(number, "'" + text + "' is no number");
    }
    const std::size_t size = names.empty() ? 2 : names.size();
    if (row.size() != size || size < 2) throw fail(number, fmt::format("{} numbers, {} are wanted", row.size(), size));
    if (!rows.empty() && !(row[0] > rows.back()[0])) throw fail(number, "the frequencies do not rise");
    if (row[0] < 0 || *std::min_element(row.begin() + 1, row.end()) < 0) throw fail(number, "a number is negative");
    rows.push_back(row);
  }
  if (rows.size() < 2) throw fail(0, "a spectrum has two frequencies at least");
  statespace::Spectrum spectrum;
  const auto count = static_cast<Eigen::Index>(rows.size()), num_columns = static_cast<Eigen::Index>(rows[0].size());
  const bool is_for_all =
      num_columns == 2 && (names.empty() || std::find(inputs.begin(), inputs.end(), names[1]) == inputs.end());
  spectrum.frequency_hz.resize(count);
  spectrum.density.setZero(count, is_for_all ? 1 : static_cast<Eigen::Index>(inputs.size()));
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto& row = rows[static_cast<std::size_t>(k)];
    spectrum.frequency_hz[k] = row[0];
    for (std::size_t c = 1; c < row.size(); ++c) {
      const auto at = is_for_all ? inputs.begin() : std::find(inputs.begin(), inputs.end(), names[c]);
      if (!is_for_all && at == inputs.end()) throw fail(1, "there is no input '" + names[c] + "'");
      spectrum.density(k, is_for_all ? 0 : at - inputs.begin()) = row[c];
    }
  }
  return spectrum;
}

}  // namespace bough::analysis
