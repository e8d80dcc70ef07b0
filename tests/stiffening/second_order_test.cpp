/// K_G of assembled models with links, arms and carried masses: what a turn of the whole does to it, supports, exact
/// rotations.
#include <gtest/gtest.h>

#include <Eigen/SVD>

#include "base/rotation.hpp"
#include "fe/linear/factor.hpp"
#include "fe/loads/loads.hpp"
#include "fe/loads/second_order.hpp"
#include "fe/statics/statics.hpp"
#include "stiffening/reduce.hpp"
#include "tests/stiffening/all_kinds.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

/// Loads of all kinds on a free model, balanced by a force and a moment at grid 5.
struct BalancedLoad {
  fe::AppliedLoad load;
  VectorXd at_grids;  ///< the part that acts on grids
};

BalancedLoad make_load(const fe::Model& model, bool has_alpha, const fe::AppliedLoad& along_beams = {}) {
  std::srand(3);
  BalancedLoad result;
  result.load.A_I = fe::calc_load_factors(
      Vector3d::Random(), has_alpha ? Vector3d(Vector3d::Random()) : Vector3d(0, 0, 0), 2 * Vector3d::Random());
  const VectorXd body = fe::calc_inertial_loads(model, model.mass_kind(), result.load.A_I);
  VectorXd& f = result.at_grids;
  f = VectorXd::Zero(model.num_gdofs());
  for (const int id : {2, 4, 13, 23, 41, 42, 43, 44, 45, 46, 48, 49, 50, 51}) {
    const int first = model.node(model.find_node(id)).first_gdof;
    f.segment<3>(first) = 20 * Vector3d::Random();
    if (id != 23) f.segment<3>(first + 3) = 3 * Vector3d::Random();
  }
  result.load.arms = along_beams.arms;
  if (along_beams.F.size() > 0) f += along_beams.F;
  const auto& last = model.node(model.find_node(5));
  const Eigen::Matrix<double, 6, 1> open = model.calc_rigid_modes(last.x).transpose() * (body + f);
  f.segment<6>(last.first_gdof) -= open;
  result.load.F = body + f;
  return result;
}

/// Forces θ×f and moments ½ θ×m of nodal loads.
VectorXd turn_nodes(const fe::Model& model, const VectorXd& F, const Vector3d& theta) {
  VectorXd turned = VectorXd::Zero(model.num_gdofs());
  for (const auto& node : model.nodes()) {
    const int i = node.first_gdof;
    turned.segment<3>(i) = theta.cross(Vector3d(F.segment<3>(i)));
    turned.segment<3>(i + 3) = 0.5 * theta.cross(Vector3d(F.segment<3>(i + 3)));
  }
  return turned;
}

/// The load turned by θ with the body: forces θ×f, moments in terms of rotation vectors ½ θ×m.
VectorXd turn_load(const fe::Model& model, const BalancedLoad& load, const Vector3d& theta) {
  VectorXd turned = turn_nodes(model, load.at_grids, theta), field = VectorXd::Zero(model.num_gdofs());
  auto a = fe::calc_acceleration_field(load.load.A_I);
  a.a_o = theta.cross(a.a_o).eval();
  a.A = skew(theta) * a.A;
  for (const auto& [first, arm, force] : load.load.arms)  // moments arm×(θ×f)
    turned.segment<3>(first) += arm.cross(theta.cross(force)) - 0.5 * theta.cross(arm.cross(force));
  for (const auto& node : model.nodes()) field.segment<3>(node.first_gdof) = a.a_o + a.A * node.x;
  turned -= linear::multiply(fe::assemble_grid_mass(model, model.mass_kind()), field);
  for (const auto& element : model.elements()) {
    fe::CarriedMass carried(element->num_dofs());
    if (!element->offset_mass(model.mass_kind()) || !fe::calc_carried(model, *element, model.mass_kind(), carried))
      continue;
    const VectorXd at =
        fe::stack_motions(carried).transpose() * fe::AccelerationFields(std::vector{a}).calc_point_loads(carried);
    for (int i = 0; i < element->num_dofs(); ++i) turned[element->gdofs()[static_cast<std::size_t>(i)]] += at[i];
  }
  return turned;
}

fe::Model make_model_of_all_kinds(MassKind kind) {
  Diagnostics diagnostics;
  return test::build_model(test::read_deck(test::make_all_kinds(), diagnostics), kind);
}

// Carried masses alone: what their second order adds to turned nodal loads makes the load of turned pieces.
TEST(SecondOrder, CarriedMassesTurnWithTheBody) {
  for (const auto kind : {MassKind::Lumped, MassKind::Consistent}) {
    Diagnostics diagnostics;
    const auto model =
        test::build_model(test::read_deck(test::make_all_masses(kind == MassKind::Lumped), diagnostics), kind);
    BalancedLoad load;
    std::srand(2);
    load.load.A_I = fe::calc_load_factors(
        Vector3d::Random(), kind == MassKind::Consistent ? Vector3d(Vector3d::Random()) : Vector3d(0, 0, 0),
        Vector3d::Random());
    load.load.F = fe::calc_inertial_loads(model, kind, load.load.A_I);
    load.at_grids = VectorXd::Zero(model.num_gdofs());
    MatrixXd K_theta = MatrixXd::Zero(model.num_gdofs(), 6);
    const MatrixXd Phi_R = model.calc_rigid_modes();
    for (const auto& form :
         fe::calc_second_order(model, fe::make_loads(load.load), VectorXd::Zero(model.num_gdofs()))) {
      const MatrixXd part = fe::calc_form(form, 0) * Phi_R(form.gdofs, Eigen::all);
      for (std::size_t i = 0; i < form.gdofs.size(); ++i)
        K_theta.row(form.gdofs[i]) += part.row(static_cast<Eigen::Index>(i));
    }
    ASSERT_GT(K_theta.norm(), 1e-3);
    EXPECT_LT(K_theta.leftCols<3>().norm(), 1e-12 * K_theta.norm());
    for (int a = 0; a < 3; ++a) {
      const Vector3d axis = Vector3d::Unit(a);
      const VectorXd expected = turn_load(model, load, axis) - turn_nodes(model, load.load.F, axis);
      EXPECT_LT((K_theta.col(3 + a) - expected).norm(), 1e-11 * K_theta.norm()) << a;
    }
  }
}

// The energy does not see a rigid rotation: K_G θ = the turned load, of elements, arms, carried masses and links. (That
// of shells lacks the drilling penalties, docs/elements/shell.md: rings of beams are in their place.)
TEST(SecondOrder, TurnsTheLoadWithTheBody) {
  for (const auto kind : {MassKind::Lumped, MassKind::Consistent}) {
    Diagnostics diagnostics;
    const auto deck = test::read_deck(test::make_all_kinds(kind == MassKind::Lumped, false) +
                                          "PLOAD1,9,1,FYE,FR,.1,30.,.8,50.\nPLOAD1,9,3,FX,FR,.4,-70.\n",
                                      diagnostics);
    const auto model = test::build_model(deck, kind);
    const auto along_beams = calc_applied_load(model, deck, 9, diagnostics);
    ASSERT_EQ(along_beams.arms.size(), 4u);
    const auto load = make_load(model, kind == MassKind::Consistent, along_beams);
    const fe::StaticSolver solver(model, fe::assemble_stiffness(model, fe::DofSet::Free),
                                  fe::choose_determinate_support(model, 5));
    const VectorXd u = solver.solve(load.load.F);
    const auto K_G = fe::assemble_geometric_stiffness(model, fe::DofSet::Global, load.load, u);
    const MatrixXd Phi_R = model.calc_rigid_modes();
    const MatrixXd seen = model.T().transpose() * linear::multiply(K_G, Phi_R);
    EXPECT_LT(seen.leftCols<3>().norm(), 1e-7 * seen.norm());
    for (int a = 0; a < 3; ++a) {
      const VectorXd expected = model.T().transpose() * turn_load(model, load, Vector3d::Unit(a));
      const VectorXd error = seen.col(3 + a) - expected;
      Eigen::Index at = 0;
      const double worst = error.cwiseAbs().maxCoeff(&at);
      const auto [node, component] = model.describe_fdof(static_cast<int>(at));
      EXPECT_LT(worst, 1e-7 * expected.cwiseAbs().maxCoeff()) << "grid " << node << " component " << component;
    }
  }
}

TEST(SecondOrder, DoesNotFeelTheSupport) {
  for (const auto kind : {MassKind::Lumped, MassKind::Consistent}) {
    const auto model = make_model_of_all_kinds(kind);
    const auto load = make_load(model, true);
    const auto K = fe::assemble_stiffness(model, fe::DofSet::Free);
    std::srand(5);
    const MatrixXd Phi = model.T() * MatrixXd::Random(model.num_fdofs(), 4);
    std::vector<MatrixXd> all;
    for (const int node : {1, 6, 0}) {
      const fe::StaticSolver solver(model, K, fe::choose_determinate_support(model, node));
      all.push_back(stiffening::calc_generalized_geometric_stiffness(model, fe::make_loads(load.load),
                                                                     solver.solve(load.load.F), Phi)[0]);
    }
    for (int i = 1; i < 3; ++i)
      EXPECT_LT((all[static_cast<std::size_t>(i)] - all[0]).norm(), 1e-8 * all[0].norm()) << i;
  }
}

// Many modes are taken by rows of K_G, few by their products, element by element: both are the projection of the
// assembled matrix, of elements, carried masses, loads on arms and links.
TEST(SecondOrder, RowsAndProductsGiveTheSameProjection) {
  for (const auto kind : {MassKind::Lumped, MassKind::Consistent}) {
    const auto model = make_model_of_all_kinds(kind);
    const auto load = make_load(model, true);
    std::srand(7);
    const MatrixXd Phi = model.T() * MatrixXd::Random(model.num_fdofs(), 50);
    for (const int num_loads : {1, 30}) {
      const MatrixXd mix = MatrixXd::Random(1, num_loads),
                     U = model.T() * MatrixXd::Random(model.num_fdofs(), num_loads);
      const fe::AppliedLoads loads{load.load.F * mix, load.load.A_I * mix, {}};
      const auto by_rows = stiffening::calc_generalized_geometric_stiffness(model, loads, U, Phi);
      const auto by_products = stiffening::calc_generalized_geometric_stiffness(model, loads, U, Phi.leftCols(7));
      ASSERT_EQ(by_rows.size(), static_cast<std::size_t>(num_loads));
      for (int c = 0; c < num_loads; c += 29) {
        const auto K_G = fe::assemble_geometric_stiffness(model, fe::DofSet::Global,
                                                          {loads.F.col(c), loads.A_I.col(c), {}}, U.col(c));
        const MatrixXd expected = Phi.transpose() * linear::multiply(K_G, Phi);
        const auto& found = by_rows[static_cast<std::size_t>(c)];
        ASSERT_GT(expected.norm(), 0);
        EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm()) << c << " of " << num_loads;
        EXPECT_LT((by_products[static_cast<std::size_t>(c)] - expected.topLeftCorner(7, 7)).norm(),
                  1e-12 * expected.norm());
      }
    }
  }
}

/// K_link of unit forces (basic axes of the deck's grids) on the dependent dofs of a small deck, on the g-set.
MatrixXd calc_link_stiffness(const fe::Model& model, const VectorXd& force) {
  MatrixXd K = MatrixXd::Zero(model.num_gdofs(), model.num_gdofs());
  for (const auto& form : model.links().calc_forms(force)) {
    const MatrixXd part = fe::calc_form(form, 0);
    for (std::size_t i = 0; i < form.gdofs.size(); ++i)
      for (std::size_t j = 0; j < form.gdofs.size(); ++j)
        K(form.gdofs[i], form.gdofs[j]) += part(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  return K;
}

template <class Energy>
double calc_second_difference(const Energy& energy, const VectorXd& p) {
  const double h = 2e-3;
  return (-energy(2 * h * p) + 16 * energy(h * p) - 30 * energy(0 * p) + 16 * energy(-h * p) - energy(-2 * h * p)) /
         (12 * h * h);
}

Vector3d calc_rotation_vector(const Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

// The rotation of best fit of the connected grids, by singular values.
TEST(SecondOrder, MeanLinkIsThatOfTheBestFit) {
  Diagnostics diagnostics;
  const auto deck = test::read_deck(
      "SOL 101\nCEND\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,.2,.1\nGRID,3,,.8,1.3,-.2\nGRID,4,,-.2,.9,.4\n"
      "GRID,5,,.3,.4,1.1\nGRID,9,,1.1,.7,1.9\nRBE3,1,,9,123456,1.,123,1\n,2,2.,123,3,4,.7,123\n,5\n"
      "CONM2,1,1,,1.\n",
      diagnostics);
  const auto model = fe::build_model(deck, {}, diagnostics);
  ASSERT_EQ(model.links().dependents().size(), 6u);
  const double weight[] = {1, 1, 2, 2, 0.7};
  std::srand(11);
  const VectorXd force = VectorXd::Random(6);
  const auto calc_energy = [&](const VectorXd& u) {
    Vector3d centre = Vector3d::Zero(), moved = centre;
    double total = 0;
    for (int i = 0; i < 5; ++i) {
      centre += weight[i] * model.node(i).x;
      moved += weight[i] * (model.node(i).x + u.segment<3>(6 * i));
      total += weight[i];
    }
    centre /= total, moved /= total;
    Matrix3d B = Matrix3d::Zero();
    for (int i = 0; i < 5; ++i)
      B += weight[i] * (model.node(i).x + u.segment<3>(6 * i) - moved) * (model.node(i).x - centre).transpose();
    const Eigen::JacobiSVD<Matrix3d> svd(B, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Matrix3d R = svd.matrixU() * svd.matrixV().transpose();
    return -force.head<3>().dot(moved + R * (model.node(5).x - centre)) - force.tail<3>().dot(calc_rotation_vector(R));
  };
  const MatrixXd K = calc_link_stiffness(model, force);
  for (int i = 0; i < 6; ++i) {
    const VectorXd p = VectorXd::Random(36);
    const double expected = calc_second_difference(calc_energy, p);
    EXPECT_NEAR(p.dot(K * p), expected, 1e-6 * std::abs(expected) + 1e-8);
  }
}

// Rigid chains in skew displacement axes: x = x_n + R s.
TEST(SecondOrder, RigidLinkIsThatOfExactRotations) {
  Diagnostics diagnostics;
  const auto deck = test::read_deck(
      "SOL 101\nCEND\nBEGIN BULK\nCORD2R,3,,0.,0.,0.,.3,.2,1.\n,1.,.1,.2\n"
      "GRID,1,,0.,0.,0.,3\nGRID,2,,1.,.2,.1,3\nGRID,3,,.8,1.3,-.2\nGRID,4,,1.8,1.,.7,3\n"
      "RBE2,1,1,123456,2\nRBAR,2,2,3,123456,,,123456\nRBE1,3,3,123456\n,UM,4,123456\nCONM2,1,1,,1.\n",
      diagnostics);
  fe::ModelOptions options;
  options.autospc = false;
  const auto model = fe::build_model(deck, options, diagnostics);
  ASSERT_EQ(model.links().dependents().size(), 18u);
  std::srand(11);
  const VectorXd force = VectorXd::Random(18);
  const MatrixXd K = model.T().transpose() * calc_link_stiffness(model, force) * model.T();
  ASSERT_EQ(K.rows(), 6);
  const auto calc_energy = [&](const VectorXd& q) {
    const VectorXd u = model.T() * q;  // of grid 1, in basic
    double W = 0;
    for (int k = 1; k < 4; ++k) {
      const Vector3d f = model.node(k).R_basic_cd * force.segment<3>(6 * (k - 1));
      W -= f.dot(calc_rotation_exp(u.segment<3>(3)) * (model.node(k).x - model.node(0).x));
    }
    return W;
  };
  for (int i = 0; i < 6; ++i) {
    const VectorXd p = VectorXd::Random(6);
    const double expected = calc_second_difference(calc_energy, p);
    EXPECT_NEAR(p.dot(K * p), expected, 1e-6 * std::abs(expected) + 1e-8);
  }
}

}  // namespace
}  // namespace bough
