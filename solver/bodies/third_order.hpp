#pragma once
/// \file A body whose displacements have degree 4 in its amplitudes: a linear body of n + m modes, of which the last m
/// are moved by polynomials of the first n (docs/theory/third-order.md, ADR 0031).
///
///     ξ = (η, p(η))     M(η) = JᵀM(ξ)J, J = [1; ∂p/∂η]     h = Jᵀ(h(ξ, ξ̇) + M(ξ) J̇η̇)
/// with the elastic forces ∂V/∂η of degree 5 in place of those of ξ.
#include <memory>

#include "solver/bodies/body.hpp"
#include "solver/bodies/polynomial.hpp"

namespace bough::solver {

class ThirdOrderBody {
 public:
  /// Makes the linear body of n + m modes and the polynomials of its tables. \pre flex.third_order is not empty.
  explicit ThirdOrderBody(const records::FlexBody& flex);

  /// Results and scratch arrays, zero. Allocates.
  ThirdOrderData make_data() const;
  /// Returns true if the file has the node's own polynomials.
  static bool is_exact(const records::FlexBody& flex, int node_id);
  /// The motion of output node k beyond φη: translations and rotation vector.
  Polynomials make_node_motion(const records::FlexBody& flex, std::size_t k) const;
  /// Work of the load of a locator beyond that on φη.
  Potential make_load(const records::FlexBody& flex, int locator) const;

  /// M(η) and S in `inertia`, of the n modes. No allocation.
  void calc_mass(const ConstVectorRef& eta, ThirdOrderData& data, BodyInertia& inertia) const;
  /// h without the modal stiffness and damping of η.
  void calc_bias(const Vector3d& w_B, const ConstVectorRef& eta, const ConstVectorRef& eta_dot, ThirdOrderData& data,
                 BodyInertia& inertia) const;
  /// Linear field T r on the linear body with n + m modes (Body::make_linear_field()).
  LinearField make_linear_field(const Matrix3d& T, const ThirdOrderData& data) const;
  /// Effect of the acceleration T r on mode j of the n (Body::calc_modal_force()).
  double calc_modal_force(const LinearField& field, const ThirdOrderData& data, int j) const;
  /// Strain energy beyond ½ ηᵀKη.
  double calc_energy(const ConstVectorRef& eta) const;
  /// ζᵀKζ of the other modes, or of the complement of the directions. K: modal stiffness.
  double calc_twice_small_energy(const MatrixXd& K, const ConstVectorRef& eta) const;
  /// Number N of large modes or directions.
  Eigen::Index num_large() const { return large_.size(); }
  /// Amplitudes of the large modes or directions, n x N: a column each. K: modal stiffness. No allocation.
  void calc_large_shapes(const MatrixXd& K, Eigen::Ref<MatrixXd> shapes) const;

 private:
  int n_ = 0, m_ = 0;
  LargeAmplitudes large_;
  VectorXd of_directions_;  ///< stiffness of each direction
  Polynomials amplitudes_, on_small_;
  Potential energy_;
  std::vector<int> small_;
  Body linear_;
};

}  // namespace bough::solver
