#pragma once
/// \file Impulses at rigid stops that are met at one moment.
#include <vector>

#include "solver/system/system.hpp"

namespace bough::solver {

/// One stop that is met.
struct Impact {
  int row = 0;             ///< of u, free
  int side = 1;            ///< 1: the upper stop, whose impulse is not positive; -1: the lower one
  double restitution = 0;  ///< speed after over speed before
  double impulse = 0;      ///< out: along the coordinate
};

/// Impulses p (n) of stops, in compression only, that make approaching bodies rebound: with rates of separation v
/// before and v + A p after,
///     p ≥ 0,   v + A p + e v ≥ 0,   one of both zero, row by row
/// (Newton's law of restitution at several places; Moreau, "Unilateral contact and dry friction in finite freedom
/// dynamics", 1988). A (n x n): symmetric, not indefinite; of what is held twice the least impulses that fit. Murty's
/// rule of the least index. O(n³) a round, allocates.
VectorXd solve_impact_lcp(const MatrixXd& A, const VectorXd& v, const VectorXd& e);

/// Rates u (num_u) after all of these blows at (t, q), by M⁻¹: momenta along all other free coordinates hold. work
/// grows by what they do, which is never positive: where different restitutions would give energy, the least holds for
/// all.
void strike(const System& system, SystemData& data, double t, const Eigen::Ref<const VectorXd>& q,
            std::vector<Impact>& blows, Eigen::Ref<VectorXd> u, double& work);

}  // namespace bough::solver
