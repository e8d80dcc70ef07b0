/// F_I against the report's lumped formulas node by node, and against d'Alembert by the full mass matrix.
#include <gtest/gtest.h>

#include "base/rotation.hpp"
#include "stiffening/reduce.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

using Vector12d = Eigen::Matrix<double, 12, 1>;

DeckMaker make_frame() {
  DeckMaker maker;
  maker.add_section(1, {70e9, 27e9, 2700, 1e-4, 1e-9, 3e-9, 2e-9});
  maker.add_line(1, 1, {0.3, 0.1, -0.2}, {1.3, 0.4, 0}, 4, Vector3d::UnitY());
  maker.add_line(1, 101, {1.3, 0.4, 0}, {1.5, 1.4, 0.7}, 4, Vector3d::UnitX(), 5);
  maker.fix(1, 123456);
  return maker;
}

/// A_I of an acceleration state (docs/theory/flexible-body.md §2).
Vector12d make_A_I(const Vector3d& a, const Vector3d& alpha, const Vector3d& w) {
  Vector12d A;
  A << a, alpha, w.cwiseAbs2(), w.x() * w.y(), w.x() * w.z(), w.y() * w.z();
  return A;
}

// NASA-CR-202063, eqs. 5 and 6: -m [1 | -p̃ | ...] and -(I α + ω × I ω).
TEST(InertialLoads, LumpedFormulaNodeByNode) {
  auto maker = make_frame();
  records::Conm2 mass;
  mass.id = 900;
  mass.g = 103;
  mass.m = 0.2;
  mass.inertia = {0.011, 0.002, 0.013, -0.001, 0.003, 0.017};
  maker.deck.conm2.push_back(mass);
  Matrix3d I_mass;  // the deck's products of inertia are positive integrals
  I_mass << 0.011, -0.002, 0.001, -0.002, 0.013, -0.003, 0.001, -0.003, 0.017;
  Diagnostics diagnostics;
  const auto model = fe::build_model(maker.deck, {}, diagnostics);
  const MatrixXd F_I = stiffening::calc_inertial_loads(model, MassKind::Lumped);
  const MatrixXd uniform = fe::calc_mass_times(model, MassKind::Lumped, model.calc_rigid_modes().leftCols(1));
  for (const auto& node : model.nodes()) {
    const double m = uniform(node.first_gdof, 0);
    const Vector3d p = node.x;
    Eigen::Matrix<double, 3, 12> translation;
    translation.leftCols(3).setIdentity();
    translation.middleCols(3, 3) = -skew(p);
    translation.col(6) << 0, -p.y(), -p.z();
    translation.col(7) << -p.x(), 0, -p.z();
    translation.col(8) << -p.x(), -p.y(), 0;
    translation.col(9) << p.y(), p.x(), 0;
    translation.col(10) << p.z(), 0, p.x();
    translation.col(11) << 0, p.z(), p.y();
    EXPECT_LT((F_I.middleRows(node.first_gdof, 3) + m * translation).cwiseAbs().maxCoeff(), 1e-14) << node.id;

    const Matrix3d I = node.id == 103 ? I_mass : Matrix3d::Zero();
    const Vector3d alpha(0.3, -0.7, 1.1), w(0.5, 0.9, -1.3);
    const Vector3d moment = F_I.middleRows(node.first_gdof + 3, 3) * make_A_I(Vector3d::Zero(), alpha, w);
    EXPECT_LT((moment + I * alpha + w.cross(I * w)).norm(), 1e-14) << node.id;
  }
}

// Any mass: the resultant force and moment of F_I A_I are those of the rigid body, -m a_cg and -d(Jω)/dt about Bo.
TEST(InertialLoads, ResultantIsNewtonEuler) {
  Diagnostics diagnostics;
  const auto model = fe::build_model(make_frame().deck, {}, diagnostics);
  for (const auto kind : {MassKind::Lumped, MassKind::Consistent}) {
    const MatrixXd F_I = stiffening::calc_inertial_loads(model, kind);
    const auto properties = fe::calc_mass_properties(model, kind, Vector3d::Zero());
    const Vector3d a(0.2, 0.4, -0.9), alpha(0.3, -0.7, 1.1), w(0.5, 0.9, -1.3), c = properties.cg;
    const VectorXd resultant = model.calc_rigid_modes().transpose() * F_I * make_A_I(a, alpha, w);
    const Vector3d force = -properties.mass * (a + alpha.cross(c) + w.cross(w.cross(c)));
    const Matrix3d& J = properties.inertia;
    const Vector3d moment = -(properties.mass * c.cross(a) + J * alpha + w.cross(J * w));
    EXPECT_LT((resultant.head<3>() - force).norm(), 1e-12);
    EXPECT_LT((resultant.tail<3>() - moment).norm(), 1e-12);
  }
}

// A rotation rate that no list of products was made for: quadratic, symmetric, and the consistent load converges to the
// lumped one in its work on a smooth field.
TEST(InertialLoads, ConsistentAndLumpedDoTheSameWork) {
  double difference[2];
  for (int i = 0; i < 2; ++i) {
    Diagnostics diagnostics;
    const auto maker = test::make_cantilever({70e9, 27e9, 2700, 1e-4, 1e-9, 3e-9, 2e-9}, 1, 8 << i);
    const auto model = fe::build_model(maker.deck, {}, diagnostics);
    MatrixXd smooth = MatrixXd::Zero(model.num_gdofs(), 1);
    for (const auto& node : model.nodes()) {
      const double x = node.x.x();
      smooth.block<3, 1>(node.first_gdof, 0) << x, x * x * x, x * x;
      smooth.block<3, 1>(node.first_gdof + 3, 0) << 0, -2 * x, 3 * x * x;
    }
    const Vector12d A = make_A_I({0.2, 0.4, -0.9}, {0.3, -0.7, 1.1}, {0.5, 0.9, -1.3});
    const VectorXd lumped = smooth.transpose() * stiffening::calc_inertial_loads(model, MassKind::Lumped) * A;
    const VectorXd consistent = smooth.transpose() * stiffening::calc_inertial_loads(model, MassKind::Consistent) * A;
    difference[i] = std::abs(lumped(0) - consistent(0));
  }
  EXPECT_NEAR(std::log2(difference[0] / difference[1]), 2, 0.1);
}

// fimake5's input: a dof map in any order, here backwards, and one dof missing: its row goes, the others stay.
TEST(InertialLoads, AnyDofMap) {
  Diagnostics diagnostics;
  const auto model = fe::build_model(make_frame().deck, {}, diagnostics);
  const int ndof = model.num_gdofs(), missing = 3 * 6 + 1;
  MatrixXd M = fe::calc_mass_times(model, MassKind::Lumped, MatrixXd::Identity(ndof, ndof));
  const MatrixXd expected = stiffening::calc_inertial_loads(model, MassKind::Lumped);
  Eigen::MatrixXi dof_map(ndof - 1, 2);
  Eigen::VectorXi row(ndof - 1);
  for (int g = ndof - 1, i = 0; g >= 0; --g) {
    if (g == missing) continue;
    row[i] = g;
    dof_map.row(i++) << g / 6 + 1, g % 6 + 1;
  }
  MatrixXd xyz(ndof / 6, 3), cut(ndof - 1, ndof - 1);
  for (const auto& node : model.nodes()) xyz.row(node.first_gdof / 6) = node.x;
  for (int i = 0; i < ndof - 1; ++i)
    for (int j = 0; j < ndof - 1; ++j) cut(i, j) = M(row[i], row[j]);
  const auto dofs = modal::NodalDofs::from_map(dof_map, xyz);
  const MatrixXd F_I = stiffening::calc_inertial_loads(dofs, cut * dofs.calc_rigid_modes());
  for (int i = 0; i < ndof - 1; ++i) {
    // A spin turns the momentum of the missing y of node 4 into loads on its x and z, which are missing with it.
    if (row[i] / 6 == missing / 6 && row[i] % 6 < 3) {
      EXPECT_LT((F_I.row(i).head(6) - expected.row(row[i]).head(6)).norm(), 1e-15);
      continue;
    }
    EXPECT_LT((F_I.row(i) - expected.row(row[i])).norm(), 1e-15) << i;
  }
}

}  // namespace
}  // namespace bough
