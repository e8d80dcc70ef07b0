#pragma once
/// \file Statistics of the outcomes of a campaign.
#include <string>
#include <vector>

#include "formats/hdf5/table_file.hpp"

namespace bough::analysis {

/// A percentile and the bounds between which that of the population lies with the confidence of the campaign.
struct Percentile {
  double percent = 0, value = 0;
  double lower = 0, upper = 0;  ///< NaN: the sample is too small for a bound
};

/// Statistics of one column of outputs, over the cases that have a number there.
struct Statistics {
  std::string name;  ///< "peak", "peak.2"
  int count = 0;
  double mean = 0, deviation = 0;  ///< of a sample: divided by count - 1; NaN of a single one
  double min = 0, p5 = 0, median = 0, p95 = 0, max = 0;
  std::vector<Percentile> percentiles;
};

/// Value below which the share p of the sorted numbers lies, linear between them (Hyndman and Fan, type 7).
double calc_quantile(const std::vector<double>& sorted, double p);
/// One for each column of /outputs/NAME; columns without a number are left out.
/// \param percentiles  [%], with bounds of that confidence [%].
std::vector<Statistics> calc_statistics(const hdf5::OutcomeTable& table, const std::vector<double>& percentiles,
                                        double confidence);

}  // namespace bough::analysis
