#pragma once
/// \file Random responses: spectral densities, running RMS and a table of RMS values and zero crossings.
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::report {

/// One output; `psd` and `running` are values at the frequencies of the panel.
struct RandomRow {
  std::string name;
  Eigen::VectorXd psd;      ///< one-sided [unit² T]
  Eigen::VectorXd running;  ///< RMS from the first frequency to each [unit]
  double rms = 0;           ///< of the legend, and by which rows are sorted
  /// Cells of the table, as many as there are columns; infinite: no bound, NaN: none.
  std::vector<double> numbers;
};

struct RandomTable {
  std::string title;    ///< of the figures
  std::string caption;  ///< of the table
  std::vector<std::string> columns;
  Eigen::VectorXd frequency_hz;
  std::vector<RandomRow> rows;
  std::string frequency_unit = "Hz";
};

/// HTML of two figures of the outputs with the largest RMS, and the table of all. Outputs that are zero are left out;
/// a sentence where all are.
std::string make_random_panel(RandomTable random);

}  // namespace bough::report
