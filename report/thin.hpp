#pragma once
/// \file Choice of the samples of a long curve for a picture of some hundred columns.
#include <vector>

#include <Eigen/Dense>

namespace bough::report {

/// Ends of at most `parts` runs of samples, the first 0, the last the number of samples: equally wide in x where x
/// ascends, as a picture's columns are, else equally long. Where samples are sparse a run holds one; none is empty.
std::vector<Eigen::Index> split_samples(const Eigen::VectorXd& x, Eigen::Index parts);

}  // namespace bough::report
