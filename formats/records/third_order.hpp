#pragma once
/// \file Displacements of a flexible body to degree 4 in the amplitudes of its large modes
/// (docs/theory/third-order.md).
#include <array>
#include <vector>

#include <Eigen/Dense>

#include "formats/records/mass_integrals.hpp"

namespace bough::records {

/// Most modes of a body of third order: its tables of degree 2 are of all of them.
constexpr int kMaxThirdOrderModes = 64;
/// Most large modes of a body: polynomials of degree 6 in 8 amplitudes have 1716 coefficients.
constexpr int kMaxLargeModes = 8;

/// Exponents of the monomials of one degree in n variables, a row each, in ascending lexical order.
Eigen::MatrixXi list_exponents(int n, int degree);
/// C(n + degree - 1, degree), the rows of list_exponents.
int count_monomials(int n, int degree);

/// Returns true if these are mode numbers from 0, ascending.
bool are_modes(const std::vector<int>& numbers, int num_modes);

/// Returns true if these are one to kMaxLargeModes modes from 0, ascending, of at most kMaxThirdOrderModes.
bool is_valid_choice(const std::vector<int>& large, int num_modes);

/// Polynomials are packed: one coefficient per monomial of a degree, in the order of list_exponents. Those of degree 2
/// are of all n modes, those of other degrees of the N large amplitudes.
struct ThirdOrder {
  static constexpr int kMinEnergy = 3, kMaxEnergy = 6;  ///< degrees of the strain energy
  static constexpr int kMinField = 2, kMaxField = 4;    ///< degrees of displacements

  /// Displacements of all degrees; rows: monomials.
  using Tables = std::array<Eigen::MatrixXd, kMaxField - kMinField + 1>;

  std::vector<int> large;  ///< N mode numbers from 0, ascending; empty: no third order
  /// N x n: the large amplitudes are y = directions η, of the unit of η, and `large` has their numbers from 0; empty:
  /// they are those of the modes `large`.
  Eigen::MatrixXd directions;
  std::array<Eigen::VectorXd, kMaxEnergy - kMinEnergy + 1> energy;  ///< of the large modes, beyond ½ ηᵀKη
  /// Strain energy of two large modes and a third mode that is not large: monomials of degree 2 x other modes.
  Eigen::MatrixXd energy_small;
  Tables amplitudes;                    ///< columns: m fields; p_q = ψ_qᵀM u(η)
  std::vector<Eigen::MatrixXd> fields;  ///< [k] 6 x m: ψ at the output nodes, as FlexBody::phi
  Eigen::MatrixXd coupling;             ///< n x m: ΦᵀMψ; empty: zero
  MassIntegrals integrals;              ///< of [Φ ψ], n + m columns, by the method that the solver uses
  std::vector<Tables> node;             ///< [interface node] columns: translations and rotation vector
  Tables load;                          ///< columns: work of the load of each locator

  /// Sets `large` to the numbers of the directions.
  void count_directions();
  /// Returns true if the body has no displacements of third order.
  bool empty() const { return large.empty(); }
  /// Number N of large modes.
  int num_large() const { return static_cast<int>(large.size()); }
  /// Number m of displacement fields beyond the modes.
  int num_fields() const { return static_cast<int>(amplitudes[0].cols()); }
  /// Variables of the tables of displacements of this degree, of n modes.
  int num_variables(int degree, int n) const { return degree == 2 ? n : num_large(); }
};

/// Strain energy of a few soft normal modes to degree 4, packed as that of ThirdOrder. By it solvers estimate what a
/// body of second order leaves out.
struct NextOrder {
  static constexpr int kMaxModes = 4;

  std::vector<int> modes;          ///< N mode numbers from 0, ascending; empty: the energy is unknown
  Eigen::VectorXd cubic, quartic;  ///< V_3, V_4: every other dof follows as statics take it

  /// Returns true if the energy is unknown.
  bool empty() const { return modes.empty(); }
};

}  // namespace bough::records
