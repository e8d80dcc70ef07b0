#pragma once
/// \file Small fixed-size types of the tree: linear before angular everywhere.
#include <Eigen/Dense>

#include "base/rotation.hpp"

namespace bough::solver {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Matrix3Xd = Eigen::Matrix<double, 3, Eigen::Dynamic>;
using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;
using RowMatrixXd = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using ConstVectorRef = Eigen::Ref<const VectorXd>;

}  // namespace bough::solver
