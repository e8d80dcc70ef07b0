#pragma once
/// \file Poles followed along a sweep by their eigenvectors.
#include <vector>

#include "formats/records/linear_sweep.hpp"

namespace bough::statespace {

struct EigenSystem {
  Eigen::VectorXcd value;
  Eigen::MatrixXcd right, left;  ///< columns; rows, left · right = 1
};

/// Eigenvalues and eigenvectors of A, balanced.
EigenSystem calc_eigen_system(const Eigen::MatrixXd& A);

/// order[i]: which of `next` is what `before` i has become; -1 if `next` has fewer and none is left. The correlation of
/// i and j is |w_i v'_j w'_j v_i| over
/// (|λ_i| + |λ'_j|)² / (4 |λ_i| |λ'_j|), w and v the left and right eigenvectors with w_i v_i = 1: 1 where they are the
/// same motion, whatever the units of the states and however its frequency has changed; pairs are taken from the
/// largest down, of equal ones the nearer poles first. correlation: of each pair, at most 1.
std::vector<int> follow(const EigenSystem& before, const EigenSystem& next, Eigen::VectorXd& correlation);

/// Fills real to mode of a sweep from its models. \param spin_axis  [1] unit vector in the frame of the outputs: fills
/// the whirl too, of the output NAME:x, NAME:y, NAME:z with the largest orbit across it; zero: no whirl.
/// \throws InputError "linear.no-orbit" if no output has three components that are lengths.
void track_poles(records::LinearSweep& sweep, const Eigen::Vector3d& spin_axis = Eigen::Vector3d::Zero());

}  // namespace bough::statespace
