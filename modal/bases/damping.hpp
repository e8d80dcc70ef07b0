#pragma once
/// \file The damping matrix of a basis: by ratio, by a table over frequency, Rayleigh, structural.
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace bough::modal::bases {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The values of Nastran's TABDMP1: ratio (CRIT), structural G = 2 ζ, or quality Q = 1/(2 ζ).
enum class DampingTable { Ratio, Structural, Quality };

/// Every part that is given adds to the others; of ratio, ratios and table one.
struct DampingSpec {
  double ratio = 0;                              ///< ζ of every mode
  std::vector<double> ratios;                    ///< ζ by mode
  std::vector<std::pair<double, double>> table;  ///< Hz, value; lines between, the end lines go on (TABDMP1)
  DampingTable table_kind = DampingTable::Ratio;
  double alpha = 0, beta = 0;            ///< Rayleigh: αM + βK
  double structural = 0;                 ///< g of K(1 + ig): the viscous g ω at each mode's own frequency
  std::optional<double> residual_ratio;  ///< ζ of residual and attachment vectors, instead of the others' ζ
  /// Returns true if no factor or ratio is set: the damping matrix is zero.
  bool is_zero() const;
};

/// ζ of the table at a frequency.
double calc_table_ratio(const DampingSpec& spec, double hz);

/// D, n x n, of coordinates with mass M and stiffness K. With K N = M N Ω² it is M N C NᵀM + αM + βK, where C is
/// diagonal: 2 ζ_j ω_j + g ω_j + (NᵀK_g N)_jj / ω_j. `K_g` (n x n or empty): ΦᵀΣ g_e K_e Φ of the deck's materials.
/// `is_residual` (n, or empty): which coordinates are residual vectors; used where M and K are
/// diagonal, where `ratios` are in the order of the coordinates; else in that of the frequencies.
MatrixXd calc_damping(const MatrixXd& M, const MatrixXd& K, const DampingSpec& spec, const MatrixXd& K_g,
                      const std::vector<bool>& is_residual);

}  // namespace bough::modal::bases
