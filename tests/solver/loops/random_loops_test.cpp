// Constraints of every type between random bodies of random trees, caught as they are found: the multipliers against
// the dense [M Gᵀ; G 0], rates along the motion, Newton and Euler of every body.
#include <gtest/gtest.h>

#include "solver/system/derivative.hpp"
#include "tests/solver/support/malloc_count.hpp"
#include "tests/solver/support/records.hpp"

namespace bough::solver::testing {
namespace {

using records::ConstraintRecord;
using records::ConstraintType;
using records::HingeType;

struct Looped {
  RandomTree tree;
  System system;
  std::unique_ptr<SystemData> data;
  VectorXd q, u;
};

/// Closed where the bodies happen to be, with rates that allow it.
Looped make_looped(unsigned seed) {
  Random random(seed + 500);
  // Rates that are prescribed and rows that do not allow them cannot be reconciled: a distance always can be.
  RandomTreeOptions options;
  options.prescribed = seed % 3 == 0;
  RandomTree tree = make_random_tree(seed, options);
  for (int i = 0; i < (options.prescribed ? 1 : 3); ++i)
    tree.spec.constraints.push_back(make_random_constraint(random, i, random.integer(0, 4), 8));
  if (options.prescribed) tree.spec.constraints[0].type = ConstraintType::Distance;
  // A gear between two plain coordinates.
  ConstraintRecord gear;
  gear.name = "gear";
  gear.type = ConstraintType::Coupler;
  gear.active = false;
  for (const auto& h : tree.spec.hinges) {
    if (h.type == HingeType::Revolute || h.type == HingeType::Prismatic || h.type == HingeType::Planar)
      gear.terms.push_back({h.name, 1, 1 + random()});
  }
  if (gear.terms.size() > 1 && !options.prescribed) tree.spec.constraints.push_back(gear);
  System system = build(tree.spec, tree.flex);
  auto data = system.make_data();
  VectorXd q, u;
  make_random_state(system, seed + 1000, q, u);
  calc_kinematics(system, *data, 0.3, q, u);
  DiscreteState discrete = get_discrete(*data);
  for (int c = 0; c < system.num_constraints(); ++c)
    discrete.constraints[static_cast<size_t>(c)] = find_as_closed(system.loops, system.tree, data->tree, c);
  set_modes(system, *data, discrete);
  project(system, *data, 0.3, q, u);
  return {std::move(tree), std::move(system), std::move(data), q, u};
}

VectorXd calc_rates(const System& system, SystemData& data, double t, const VectorXd& q, const VectorXd& u) {
  const Loops& loops = system.loops;
  calc_kinematics(system, data, t, q, u);
  calc_closure_positions(loops, system.tree, data.tree, data.loops);
  calc_closure_velocities(loops, system.tree, data.tree, data.loops);
  VectorXd rates = get_gaps(loops, data.loops);
  int at = 0;
  for (const LoopBlock& block : data.loops.blocks) {
    for (const int i : block.constraints) {
      const ConstraintData& d = data.loops[i];
      if (loops[i].closure) {
        for (int k = 0; k < loops[i].num_rows(); ++k) rates[at + k] = d.own.W.col(k).dot(d.relative.V);
      } else {
        rates[at] = 0;
        for (const CouplerTerm& term : loops[i].terms) rates[at] += term.ratio * data.tree.u[term.u_row];
      }
      at += loops[i].num_rows();
    }
  }
  return rates;
}

/// Rates of the constraints at unit speeds, column by column; zero for coordinates that are not free.
MatrixXd calc_rows_by_speeds(const System& system, const SystemData& data) {
  const Tree& tree = system.tree;
  MatrixXd G = MatrixXd::Zero(get_gaps(system.loops, data.loops).size(), tree.num_u);
  Sweep sweep = data.tree.response;
  for (int column = 0; column < tree.num_u; ++column) {
    run_rates(tree, data.tree, VectorXd::Unit(tree.num_u, column), sweep);
    int at = 0;
    for (const LoopBlock& block : data.loops.blocks)
      for (const int i : block.constraints) {
        const Constraint& c = system.loops[i];
        const ConstraintData& d = data.loops[i];
        if (c.closure)
          G.col(column).segment(at, c.num_rows()) =
              d.own.W.leftCols(c.num_rows()).transpose() *
              calc_relative_response(tree, data.tree, c.parent_marker, c.child_marker, d.relative, sweep);
        for (const CouplerTerm& term : c.terms) G(at, column) += term.ratio * sweep.u_dot[term.u_row];
        at += c.num_rows();
      }
  }
  return G;
}

class RandomLoops : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomLoops, StartClosed) {
  Looped s = make_looped(GetParam());
  EXPECT_LT(calc_largest_position_error(s.system.loops, s.data->loops), 1e-11);
  EXPECT_LT(calc_rates(s.system, *s.data, 0.3, s.q, s.u).cwiseAbs().maxCoeff(),
            1e-10 * (1 + s.u.cwiseAbs().maxCoeff()));
}

TEST_P(RandomLoops, MultipliersAgreeWithTheDenseEquations) {
  Looped s = make_looped(GetParam());
  const VectorXd u_dot = calc_u_dot(s.system, *s.data, 0.3, s.q, s.u);
  VectorXd dense(s.system.num_u());
  calc_accelerations_dense(s.system, *s.data, 0.3, dense);
  EXPECT_LT((u_dot - dense).norm(), 1e-9 * (1 + dense.norm()));
  // Again, by the page's own chain, and without a memory of the first time.
  const StateLayout layout = s.system.layout();
  VectorXd x = VectorXd::Zero(layout.size()), x_dot = x;
  get_q(layout, x) = s.q;
  get_u(layout, x) = s.u;
  calc_derivative(s.system, *s.data, 0.3, x, x_dot);
  EXPECT_LT((u_dot - get_u(layout, x_dot)).norm(), 1e-11 * (1 + dense.norm()));
}

TEST_P(RandomLoops, RowsAreRatesAtUnitSpeeds) {
  Looped s = make_looped(GetParam());
  calc_u_dot(s.system, *s.data, 0.3, s.q, s.u);
  const MatrixXd G = calc_dense_rows(s.system.loops, s.system.tree, s.data->tree, s.data->loops);
  const MatrixXd expected = calc_rows_by_speeds(s.system, *s.data);
  ASSERT_EQ(G.rows(), expected.rows());
  ASSERT_GT(G.rows(), 0);
  for (int row = 0; row < s.system.tree.num_u; ++row) {
    if (s.data->tree.mode[static_cast<size_t>(row)] == HingeMode::Free)
      EXPECT_LT((G.col(row) - expected.col(row)).norm(), 1e-12 * (1 + expected.norm())) << row;
  }
}

// The responses of the factored tree are M⁻¹Gᵀ of the rows by unit speeds.
TEST_P(RandomLoops, BlocksAreGMGt) {
  Looped s = make_looped(GetParam());
  calc_u_dot(s.system, *s.data, 0.3, s.q, s.u);
  MatrixXd mass;
  VectorXd force;
  calc_dense_equations(s.system.tree, s.data->tree, mass, force);
  const MatrixXd G = calc_rows_by_speeds(s.system, *s.data);
  std::vector<int> free;
  for (int row = 0; row < s.system.tree.num_u; ++row) {
    if (s.data->tree.mode[static_cast<size_t>(row)] == HingeMode::Free) free.push_back(row);
  }
  const MatrixXd own = G(Eigen::all, free), M = mass(free, free);
  const MatrixXd A = own * M.llt().solve(own.transpose());
  Eigen::Index at = 0;
  for (const LoopBlock& block : s.data->loops.blocks) {
    const auto n = block.rows.size();
    MatrixXd own_A = MatrixXd::Zero(n, n);
    for (const auto& pair : block.factor.pairs)
      own_A.block(block.first[static_cast<size_t>(pair.i)], block.first[static_cast<size_t>(pair.j)], pair.A.rows(),
                  pair.A.cols()) = pair.A;
    const MatrixXd lower = own_A.triangularView<Eigen::Lower>();
    const MatrixXd expected = A.block(at, at, n, n).triangularView<Eigen::Lower>();
    EXPECT_LT((lower - expected).norm(), 1e-10 * (1 + expected.norm()));
    at += n;
  }
}

TEST_P(RandomLoops, RatesStayClosedAlongTheMotion) {
  Looped s = make_looped(GetParam());
  const VectorXd u_dot = calc_u_dot(s.system, *s.data, 0.3, s.q, s.u);
  auto other = s.system.make_data();
  set_modes(s.system, *other, get_discrete(*s.data));
  // The rows' basis may turn, their length may not.
  const auto calc_size = [&](double dt) {
    return calc_rates(s.system, *other, 0.3 + dt, advance_q(s.system, *other, 0.3, dt, s.q, s.u, u_dot),
                      s.u + dt * u_dot)
        .norm();
  };
  const double scale = 1 + u_dot.norm() + s.u.squaredNorm();
  EXPECT_LT(calc_size(1e-4), 1e-6 * scale * scale);  // second order: a wrong term would leave 1e-4
}

TEST_P(RandomLoops, ReactionsCloseNewtonAndEulerOfEveryBody) {
  Looped s = make_looped(GetParam());
  const System& system = s.system;
  const double t = 0.3;
  const VectorXd u_dot = calc_u_dot(system, *s.data, t, s.q, s.u);
  const SystemData& data = *s.data;
  const Matrix6Xd rate = calc_momentum_rates(system, t, s.q, s.u, u_dot);
  Matrix6Xd loads = Matrix6Xd::Zero(6, system.num_bodies());
  for (int b = 0; b < system.num_bodies(); ++b) {
    const TreeBody& tb = system.tree[b];
    const BodyState& own = data.tree[b].state;
    loads.col(b) += calc_applied_loads(system, data, b);
    const HingeReaction r = get_hinge_reaction(system, data, b);
    const MarkerMotion& c = data.tree.markers[static_cast<size_t>(tb.child_marker)];
    const Matrix3d R_WHp = data.tree[tb.parent].state.R_WB * data.tree.markers[static_cast<size_t>(tb.parent_marker)].R;
    const Vector3d force = R_WHp * r.force;
    Vector6d wrench;
    wrench << force, R_WHp * r.moment + (own.p_WBo + own.R_WB * c.r).cross(force);
    loads.col(b) += wrench;
    if (tb.parent >= 0) loads.col(tb.parent) -= wrench;
  }
  for (int i = 0; i < system.num_constraints(); ++i) {
    const Constraint& c = system.loops[i];
    const ConstraintReaction r = get_constraint_reaction(system, data, i);
    if (!c.closure) {  // a motor across each hinge: in the hinges' reactions already
      continue;
    }
    const RelativeMotion& X = data.loops[i].relative;
    const Marker& parent = system.tree.markers[static_cast<size_t>(c.parent_marker)];
    const Marker& child = system.tree.markers[static_cast<size_t>(c.child_marker)];
    const BodyState& state = data.tree[child.body].state;
    const Vector3d at = state.p_WBo + state.R_WB * data.tree.markers[static_cast<size_t>(c.child_marker)].r + X.o_W;
    const Vector3d f = X.R_WHp * r.force;
    Vector6d wrench;
    wrench << f, X.R_WHp * r.moment + at.cross(f);
    loads.col(child.body) += wrench;
    if (parent.body >= 0) loads.col(parent.body) -= wrench;
  }
  const double scale = 1 + loads.cwiseAbs().maxCoeff() + rate.cwiseAbs().maxCoeff();
  EXPECT_LT((rate - loads).cwiseAbs().maxCoeff(), 1e-10 * scale);
}

// Every second hinge locked: what holds a coordinate is its row of M u_dot - f - G'lambda by the dense equations,
// gears, springs and dampers of that coordinate included; rows of free coordinates vanish.
TEST_P(RandomLoops, ForcesThatHoldCoordinatesAreThoseOfTheDenseEquations) {
  Looped s = make_looped(GetParam());
  const Tree& tree = s.system.tree;
  const Loops& loops = s.system.loops;
  DiscreteState discrete = get_discrete(*s.data);
  std::vector<int> locked;
  for (int b = 0; b < tree.size(); b += 2) {
    for (int i = 0; i < tree[b].num_hinge_u(); ++i) {
      HingeMode& mode = discrete.mode[static_cast<size_t>(tree[b].u_offset + i)];
      if (mode == HingeMode::Prescribed) continue;
      mode = HingeMode::Locked;
      locked.push_back(tree[b].u_offset + i);
    }
  }
  set_modes(s.system, *s.data, discrete);
  const VectorXd u_dot = calc_u_dot(s.system, *s.data, 0.3, s.q, s.u);
  MatrixXd M;
  VectorXd f;
  calc_dense_equations(tree, s.data->tree, M, f);
  const MatrixXd G = calc_dense_rows(loops, tree, s.data->tree, s.data->loops);
  VectorXd lambda(G.rows());
  int at = 0;
  for (const LoopBlock& block : s.data->loops.blocks) {
    lambda.segment(at, block.rows.size()) = block.rows;
    at += static_cast<int>(block.rows.size());
  }
  // Accelerations of prescribed coordinates are in the bias already.
  VectorXd moving = u_dot;
  for (int row = 0; row < tree.num_u; ++row)
    if (discrete.mode[static_cast<size_t>(row)] == HingeMode::Prescribed) moving[row] = 0;
  const VectorXd left = M * moving - f - G.transpose() * lambda;
  const double scale = 1 + f.norm() + (G.transpose() * lambda).norm() + left.norm();
  ASSERT_FALSE(locked.empty());
  for (const int row : locked) EXPECT_NEAR(s.data->tree.calc_constraint_force(row), left[row], 1e-9 * scale) << row;
  for (int row = 0; row < tree.num_u; ++row) {
    if (discrete.mode[static_cast<size_t>(row)] != HingeMode::Free) continue;
    EXPECT_LT(std::abs(left[row]), 1e-9 * scale) << row;
  }
}

TEST_P(RandomLoops, AllocateNothing) {
  Looped s = make_looped(GetParam());
  const StateLayout layout = s.system.layout();
  VectorXd x = VectorXd::Zero(layout.size()), x_dot = x;
  get_q(layout, x) = s.q;
  get_u(layout, x) = s.u;
  calc_derivative(s.system, *s.data, 0.3, x, x_dot);
  get_q(layout, x) += 1e-7 * get_q(layout, x_dot);  // off the constraints
  const long before = get_malloc_count();
  if (before < 0) GTEST_SKIP() << "this build cannot count";
  calc_derivative(s.system, *s.data, 0.3, x, x_dot);
  project(s.system, *s.data, 0.3, get_q(layout, x), get_u(layout, x));
  EXPECT_EQ(get_malloc_count(), before);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomLoops, ::testing::Range(1u, 25u));

// Least-norm solution of a singular semidefinite system, against the pseudo-inverse of the scaled one.
TEST(Semidefinite, SolvesByLeastNorm) {
  Random random(3);
  for (const int rank : {1, 4, 7, 9}) {
    const MatrixXd B = MatrixXd::NullaryExpr(9, rank, [&] { return random(); });
    const MatrixXd A = B * B.transpose();
    const VectorXd b = A * random.vector_n(9);
    SemidefiniteFactor factor;
    factor.arrange(9);
    factor.pairs[0].A = A;
    factor.compute();
    EXPECT_EQ(factor.rank(), rank);
    VectorXd x = b;
    factor.solve(x);
    EXPECT_LT((A * x - b).norm(), 1e-9 * b.norm());
    const VectorXd s = A.diagonal().cwiseSqrt();
    const MatrixXd scaled = s.cwiseInverse().asDiagonal() * A * s.cwiseInverse().asDiagonal();
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> cod;
    cod.setThreshold(1e-8);
    cod.compute(scaled);
    const VectorXd expected =
        s.cwiseInverse().asDiagonal() * VectorXd(cod.solve(VectorXd(s.cwiseInverse().asDiagonal() * b)));
    EXPECT_LT((x - expected).norm(), 1e-8 * expected.norm());
  }
}

}  // namespace
}  // namespace bough::solver::testing
