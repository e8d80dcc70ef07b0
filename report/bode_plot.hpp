#pragma once
/// \file Bode and Nichols diagrams of a transfer matrix, with the margins of a loop.
#include <string>
#include <vector>

#include "formats/records/frequency_response.hpp"
#include "report/svg_plot.hpp"

namespace bough::report {

/// One entry of the transfer matrix. NaN where |H| is below calc_response_floor(): round-off.
struct BodePair {
  Eigen::Index output = 0, input = 0;
  std::string name;         ///< "gyro:z / wheel_z"
  Eigen::VectorXd decibel;  ///< 20 log10 |H|, of the units of output over input
  Eigen::VectorXd degrees;  ///< arg H without jumps of 360
};

constexpr double kResponseFloor = 1e-12;
/// Part of the logarithmic axis that peaks of undamped poles may take: they reach any height.
constexpr double kPeakShare = 0.01;

/// Computes the magnitude below which nothing is drawn: kResponseFloor times the largest one outside narrow peaks.
/// \param frequency_hz  increasing; Hz or the cycles per unit of time
/// \param largest       the largest magnitude at each frequency
double calc_response_floor(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXd& largest);

/// Entries column by column, at most `max_pairs`.
std::vector<BodePair> make_bode_pairs(const records::FrequencyResponse& response, std::size_t max_pairs);

/// Magnitude and phase over frequency, without curves. \param time_unit  label of the unit of time, empty: none
std::vector<Plot> make_bode_axes(const std::string& time_unit);
/// Phase against magnitude, without curves.
Plot make_nichols_axes();
/// Adds contours of constant |L/(1+L)|, and the point -1 at each odd multiple of 180 degrees, over the phases of the
/// curves.
void add_nichols_grid(Plot& plot);
/// Adds one curve to each diagram of make_bode_axes.
void add_bode_curve(const BodePair& pair, const Eigen::VectorXd& frequency_hz, const std::string& label,
                    std::vector<Plot>& plots);
/// Marks the margins of `response` on the diagrams: lines at 0 dB and at odd multiples of 180 degrees, and the distance
/// to them.
void add_margins(const records::Margins& margins, const BodePair& pair, const records::FrequencyResponse& response,
                 std::vector<Plot>& plots);
/// Singular values over frequency.
Plot make_sigma_plot(const records::FrequencyResponse& response, const std::string& prefix);

}  // namespace bough::report
