#pragma once
/// \file Geometric stiffness of a flexible body by its measured loads (NASA-CR-202063, eq. 18): K_G1 of A_I, K_G2 of
/// what acts at its nodes and of its load patterns.
#include <array>

#include "formats/records/flex_body.hpp"
#include "formats/records/system_spec.hpp"
#include "solver/motion/node_load.hpp"

namespace bough::solver {

class StiffeningTerms {
 public:
  /// Terms of body `b` with the modes of the system. Sources without locators in the file are left out.
  /// \param constraints  true to include the loads of constraints.
  static StiffeningTerms collect(const records::SystemSpec& spec, const Tree& tree, const Loops& loops,
                                 const std::vector<AppliedForce>& forces, const records::FlexBody& flex, int b,
                                 bool constraints);

  /// Number of loads: A_I (12), then 6 of each source.
  int num_loads() const { return 12 + 6 * static_cast<int>(sources_.size()); }
  /// Returns true if a source is the reaction of a hinge, which is known after calc_accelerations.
  bool has_hinges() const;
  /// A_I minus gravity (12), then of each source force and moment at its node in B, or the value of a pattern and five
  /// zeros; y: num_loads. After calc_accelerations. No allocation.
  void calc_loads(const Motion& motion, double* y) const;
  /// modal -= K_G(y) η. No allocation.
  void add_modal_force(const double* y, const ConstVectorRef& eta, Eigen::Ref<VectorXd> modal) const;
  /// K_G(y), n x n.
  MatrixXd calc_stiffness(const double* y) const;

 private:
  /// K_G2 of its six components (empty: no locator). Of a load pattern the first is that of its value.
  struct Source {
    NodeSource source;
    std::array<MatrixXd, 6> K2 = {};
  };
  int body_ = 0, n_ = 0;
  std::array<MatrixXd, records::kNumInertialLoads> K1_;  ///< empty: not computed
  std::vector<Source> sources_;
};

}  // namespace bough::solver
