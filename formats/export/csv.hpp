#pragma once
/// \file Comma-separated values of a results file: one header row of channel names, one row per sample, 17 digits.
#include <ostream>
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::exports {

struct CsvColumn {
  std::string name;
  Eigen::VectorXd values;
  std::string unit{};  ///< follows the name in brackets: "time [s]"
};
/// Quoted when it needs to be (RFC 4180).
std::string write_csv_field(const std::string& name);
/// Writes a heading with units and a row per value; all columns have equal lengths.
void write_csv(std::ostream& out, const std::vector<CsvColumn>& columns);

}  // namespace bough::exports
