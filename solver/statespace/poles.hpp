#pragma once
/// \file Eigenvalues of a linear model, each with its frequency, damping and the state that takes part most.
#include "formats/records/linear_model.hpp"

namespace bough::statespace {

/// A: n x n; names: of the states, n. Block by block (blocks.hpp), each balanced. A state takes part in a pole by
/// |v_k w_k|, v and w its right and left eigenvectors (Perez-Arriaga, Verghese & Schweppe, IEEE Trans. PAS 101 (1982)
/// 3117); "boom:eta3" and "boom:eta3_dot" count together.
records::Poles calc_poles(const Eigen::MatrixXd& A, const std::vector<std::string>& names);

}  // namespace bough::statespace
