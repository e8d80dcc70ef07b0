#include "formats/records/random_response.hpp"

namespace bough::records {

Eigen::MatrixXd calc_cumulative_rms(const RandomResponse& response, const RandomCurves& curves) {
  const auto& hz = response.hz;
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(curves.psd.rows(), curves.psd.cols());
  for (Eigen::Index i = 1; i < hz.size(); ++i)
    sums.row(i) = sums.row(i - 1) + (hz(i) - hz(i - 1)) / 2 * (curves.psd.row(i - 1) + curves.psd.row(i));
  return sums.cwiseSqrt();
}

}  // namespace bough::records
