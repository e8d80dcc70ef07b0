#pragma once
/// \file Positions and rates that close the loops, near those that were given; constraints that say what others say.
#include "solver/loops/loops.hpp"

namespace bough::solver {

/// Priority of a coordinate's initial value. Assembly moves those of a lower priority first, Fixed ones never.
enum class AssemblyPriority : unsigned char { Free, Given, Modal, Fixed };

struct Assembly {
  bool is_closed = false;
  double gap = 0;  ///< largest, relative (calc_gap); of rates: G u over the size of u
  int worst = -1;  ///< the constraint that has it
};

/// Gauss-Newton steps of least size, with as few priorities let go as do; q: in and out. priority: num_u, by row of u.
/// The closing hinges' coordinates in `data` follow. Leaves tree_data at (t, q). Allocates.
Assembly assemble_positions(const Loops& loops, const Tree& tree, double t,
                            const std::vector<AssemblyPriority>& priority, Eigen::Ref<VectorXd> q, TreeData& tree_data,
                            LoopData& data);
/// Finds rates u with G u = 0 near those given. u: num_u x k, in and out, each column one set of rates.
/// After assemble_positions.
Assembly assemble_rates(const Loops& loops, const Tree& tree, const std::vector<AssemblyPriority>& priority,
                        Eigen::Ref<MatrixXd> u, TreeData& tree_data, LoopData& data);

/// For each closed constraint what of its wrench the constraints before it can take as well: 6 x k in Hp (coupler: the
/// first row is 1), reduced to few components. Of coordinates that are not Fixed. After assemble_positions.
struct Redundancy {
  int constraint = 0;
  Matrix6Xd wrenches;
};
/// Finds the dependent rows of the closed constraints by orthogonalization, constraint after constraint, and an SVD of
/// the rest of each.
std::vector<Redundancy> find_redundancies(const Loops& loops, const Tree& tree,
                                          const std::vector<AssemblyPriority>& priority, const TreeData& tree_data,
                                          const LoopData& data);

}  // namespace bough::solver
