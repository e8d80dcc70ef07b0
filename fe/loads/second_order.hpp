#pragma once
/// \file Terms of K_G in addition to internal forces: offset masses, loads on arms, rigid links.
#include "fe/loads/inertial_loads.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/model/links.hpp"

namespace bough::fe {

struct InitialForces;

/// Loads as columns, as AppliedLoad.
struct AppliedLoads {
  MatrixXd F;                                              ///< num_gdofs x m
  MatrixXd A_I;                                            ///< 12 x m
  std::vector<std::vector<ArmLoad>> arms;                  ///< per load; may be shorter than m
  std::vector<std::vector<QuadraticForm>> followers = {};  ///< the same
};
/// The loads with one column, m = 1.
AppliedLoads make_loads(const AppliedLoad& load);

/// Second order of carried masses, of loads on arms and of links under the loads, with U their static solutions
/// (num_gdofs x m): K_G of load c is that of the internal forces plus the sum of all forms. Every rank has all of them.
/// O(elements).
std::vector<QuadraticForm> calc_second_order(const Model& model, const AppliedLoads& loads,
                                             const Eigen::Ref<const MatrixXd>& U);

/// calc_second_order() with the forces that links carry, F - f of the internal forces f at the grids: num_gdofs x m.
std::vector<QuadraticForm> calc_second_order_of_forces(const Model& model, const AppliedLoads& loads,
                                                       const Eigen::Ref<const MatrixXd>& forces);

/// K_G of a load with its static displacements u (num_gdofs) and the forces of heated elements
/// (fe/loads/temperatures.hpp), f-set or g-set: of internal forces, carried masses, loads on arms and links.
linear::SymmetricMatrix assemble_geometric_stiffness(const Model& model, DofSet set, const AppliedLoad& load,
                                                     const VectorXd& u_g, const InitialForces* initial = nullptr);

}  // namespace bough::fe
