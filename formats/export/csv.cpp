#include "formats/export/csv.hpp"

#include <charconv>

#include "base/diagnostic.hpp"

namespace bough::exports {

std::string write_csv_field(const std::string& name) {
  if (name.find_first_of(",\"\r\n") == std::string::npos) return name;
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

void write_csv(std::ostream& out, const std::vector<CsvColumn>& columns) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    BOUGH_DEMAND(columns[i].values.size() == columns[0].values.size());
    out << (i > 0 ? "," : "")
        << write_csv_field(columns[i].unit.empty() ? columns[i].name : columns[i].name + " [" + columns[i].unit + "]");
  }
  out << '\n';
  std::string row;
  for (Eigen::Index r = 0; !columns.empty() && r < columns[0].values.size(); ++r) {
    row.clear();
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (i > 0) row += ',';
      char buffer[40];
      // Independent of the locale, as a data file has to be; + 0.0 makes -0 a 0.
      const auto end =
          std::to_chars(buffer, buffer + sizeof buffer, columns[i].values[r] + 0.0, std::chars_format::general, 17);
      row.append(buffer, end.ptr);
    }
    row += '\n';
    out << row;
  }
}

}  // namespace bough::exports
