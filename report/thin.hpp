#pragma once
/// \file Choice of the samples of a long curve for a picture of some hundred columns.
#include <vector>

#include <Eigen/Dense>

namespace bough::report {

/// Ends of at most `parts` runs of samples, the first 0, the last the number of samples: equally wide in x where x
/// ascends, as a picture's columns are, else equally long. Where samples are sparse a run holds one; none is empty.
std::vector<Eigen::Index> split_samples(const Eigen::VectorXd& x, Eigen::Index parts);

/// Selects the samples of an envelope: of each run of `length` samples the smallest, the largest and the first that is
/// not finite, and the first and the last sample of all; ascending.
std::vector<Eigen::Index> choose_extremes(const Eigen::Ref<const Eigen::VectorXd>& values, Eigen::Index length);

}  // namespace bough::report
