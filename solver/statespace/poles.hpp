#pragma once
/// \file Eigenvalues of a linear model, each with its frequency, damping and the state that takes part most.
#include <complex>

#include "formats/records/linear_model.hpp"

namespace bough::statespace {

/// A: n x n; names: of the states, n. Block by block (blocks.hpp), each balanced. A state takes part in a pole by
/// |v_k w_k|, v and w its right and left eigenvectors (Perez-Arriaga, Verghese & Schweppe, IEEE Trans. PAS 101 (1982)
/// 3117); "boom:eta3" and "boom:eta3_dot" count together.
/// `error`, n x n or empty: what the entries of A may be off by. A pole is then off by |w|ᵀ error |v| for wᵀv = 1, to
/// first order, and by what rounding does to A in the solution, ε |A| |w| |v| (Wilkinson, The Algebraic Eigenvalue
/// Problem, 1965, ch. 2): soft poles of a stiff system have fewer digits than A.
records::Poles calc_poles(const Eigen::MatrixXd& A, const std::vector<std::string>& names,
                          const Eigen::MatrixXd& error = {});

/// Right eigenvector of A next to the eigenvalue `value`, of length 1, by inverse iteration on the balanced matrix.
/// Where several eigenvalues are one, some vector of their space. \pre value is an eigenvalue up to rounding.
Eigen::VectorXcd calc_eigenvector(const Eigen::MatrixXd& A, std::complex<double> value);

}  // namespace bough::statespace
