#pragma once
/// \file Products of a model's matrices with many vectors, some columns at a time.
#include "fe/matrices/assembly.hpp"

namespace bough::fe {

/// Columns that products of many vectors take at a time: their memory counts next to that of the vectors.
constexpr Eigen::Index kColumnsAtOnce = 128;

/// T X, num_gdofs x k.
MatrixXd expand(const Model& model, const Eigen::Ref<const MatrixXd>& X);
/// XᵀMX of fields X on the g-set.
MatrixXd calc_mass_gram(const Model& model, MassKind kind, const MatrixXd& X);
/// Diagonal of XᵀMX.
VectorXd calc_modal_mass(const Model& model, MassKind kind, const MatrixXd& X);

}  // namespace bough::fe
