/// Mass off its grids: F_I, RFORCE, exact integrals and K_G1 of bodies on arms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/rotation.hpp"
#include "fe/loads/loads.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/nastran/reader.hpp"
#include "modal/integrals.hpp"
#include "stiffening/reduce.hpp"
#include "tests/fe/model/text_model.hpp"
#include "tests/stiffening/all_kinds.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

constexpr int kWz2 = static_cast<int>(InertialLoad::wz2);

/// A hinge spring about z at (1, 0, 0), SPC 1, and what turns on it.
std::string make_hinge(const std::string& mass) {
  return "SOL 103\nCEND\nSPC = 1\nMETHOD = 3\nBEGIN BULK\nEIGRL,3,,,1\nGRID,1,,1.,0.,0.\nGRID,2,,1.,0.,0.\n"
         "CELAS2,10,100.,1,6,2,6\nSPC1,1,123456,1\nSPC1,1,12345,2\n" +
         mass;
}

struct Hinge {
  double stiffening;  ///< η² coefficient of J_zz: K_G1 and Γ4, over (φ of the hinge)²
  double exact_slope, lumped_slope;
};

Hinge reduce_hinge(const std::string& mass) {
  Diagnostics diagnostics;
  const auto deck = test::read_deck(make_hinge(mass), diagnostics);
  records::BodySpec spec;
  spec.num_modes = 1;
  spec.output_nodes = {2};
  const auto body = stiffening::reduce(deck, spec, {}, diagnostics).body;
  const double turn = body.phi[0](5, 0);
  Hinge hinge;
  // J_zz(η) = J + η (Γ3 + Γ3ᵀ)_zz + η² (Γ4 - K_G1).
  hinge.stiffening = (body.exact.gamma4[0][0](2, 2) - body.kg_inertial[kWz2](0, 0)) / (turn * turn);
  hinge.exact_slope = 2 * body.exact.gamma3[0](2, 2) / turn;
  hinge.lumped_slope = 2 * body.lumped.gamma3[0](2, 2) / turn;
  return hinge;
}

// |(1, 0) + R(θ)(1, 0)|² = 2 + 2 cos θ: -1 in θ².
TEST(CarriedBodies, MassOnAnArmStiffensUnderSpin) {
  const std::string bar =
      "GRID,3,,2.,0.,0.\nMAT1,1,7.+10,,.3,0.\nCBAR,20,1,2,3,0.,1.,0.\nPBAR,1,1,1.,1.,1.,1.\nCONM2,9,3,,1.\n"
      "SPC1,1,345,3\n";
  const std::string decks[] = {
      bar,
      "CONM2,9,2,,1.,1.,0.,0.\n",
      "GRID,3,,2.,0.,0.\nRBE2,20,2,123456,3\nCONM2,9,3,,1.\n",
      "GRID,3,,2.,0.,0.\nRBAR,20,2,3,123456,,,123456\nCONM2,9,3,,1.\n",
      "GRID,3,,2.,0.,0.\nRBE1,20,2,123456\n,UM,3,123456\nCONM2,9,3,,1.\n",
      "GRID,3,,1.5,0.,0.\nRBE2,20,2,123456,3\nCONM2,9,3,,1.,.5,0.,0.\n",
      "GRID,3,,1.5,0.,0.\nGRID,4,,2.,0.,0.\nRBE2,20,2,123456,3\nRBE2,21,3,123456,4\nCONM2,9,4,,1.\n",
  };
  for (const auto& deck : decks) {
    EXPECT_NEAR(reduce_hinge(deck).stiffening, -1, 1e-6) << deck;
  }
}

// (1, 0) + R(θ)(0, 1) = (1 - sin θ, cos θ): |.|² = 2 - 2 sin θ.
TEST(CarriedBodies, InertiaChangesAsTheArmTurns) {
  for (const std::string deck : {"CONM2,9,2,,1.,0.,1.,0.\n", "GRID,3,,1.,1.,0.\nRBE2,20,2,123456,3\nCONM2,9,3,,1.\n"}) {
    const auto hinge = reduce_hinge(deck);
    EXPECT_NEAR(hinge.exact_slope, -2, 1e-12) << deck;
    EXPECT_NEAR(hinge.lumped_slope, -2, 1e-12) << deck;
    EXPECT_NEAR(hinge.stiffening, 0, 1e-12) << deck;
  }
}

// m = 1 at (1, 1, 0) on a grid at (1, 0, 0): the pull of ω = z is (1, 1, 0), its moment about the grid -1.
TEST(CarriedBodies, SpinTurnsTheGridOfAnOffsetMass) {
  fe::test::TextModel m(
      "SOL 101\nCEND\nSPC = 1\nLOAD = 4\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\n"
      "PBAR,1,1,1.-4,1.-8,1.-8,2.-8\nMAT1,1,70.+9,,.3,0.\nCONM2,9,2,,1.,0.,1.,0.\nSPC1,1,123456,1\n"
      "RFORCE,4,0,0,.159154943091895,0.,0.,1.\n");
  const VectorXd f = fe::calc_inertial_loads(m.model, m.model.mass_kind()).col(kWz2).segment<6>(6);
  VectorXd expected(6);
  expected << 1, 1, 0, 0, 0, -1;
  EXPECT_LT((f - expected).norm(), 1e-14);
  EXPECT_LT((calc_load(m.model, m.deck, 4, m.diagnostics).segment<6>(6) - expected).norm(), 1e-12);
}

// Twice the mass along y: no body has it. Its nodal momenta are taken, and both the deck and the body say so.
TEST(CarriedBodies, MassesThatAreNotOfBodiesAreNamed) {
  Diagnostics diagnostics;
  const auto deck = test::read_deck(make_hinge("CONM1,9,2,,1.,,2.,,\n,1.,,,,.3,,,\n,,.4,,,,,,.5\n"), diagnostics);
  records::BodySpec spec;
  spec.num_modes = 1;
  const auto body = stiffening::reduce(deck, spec, {}, diagnostics).body;
  EXPECT_EQ(body.masses, "nodal momenta");
  for (const std::string id : {"fe.mass-not-rigid", "reduce.inertia-approximated"})
    EXPECT_TRUE(std::any_of(diagnostics.items().begin(), diagnostics.items().end(), [&](const auto& item) {
      return item.id == id;
    })) << id;
}

// RFORCE and GRAV are F_I A_I, whatever elements there are.
TEST(CarriedBodies, BodyLoadsAreInertialLoads) {
  for (const auto kind : {MassKind::Lumped, MassKind::Consistent}) {
    Diagnostics diagnostics;
    const auto deck = test::read_deck(test::make_all_kinds() +
                                          "RFORCE,4,0,0,.3,.7,-.4,1.1\nGRAV,5,,9.,1.,2.,3.\n"
                                          "LOAD,6,1.,1.,4,2.,5\n",
                                      diagnostics);
    fe::ModelOptions options;
    options.mass_kind = kind;
    const auto model = fe::build_model(deck, options, diagnostics);
    const MatrixXd F_I = fe::calc_inertial_loads(model, kind);
    const Vector3d omega = 2 * std::numbers::pi * 0.3 * Vector3d(0.7, -0.4, 1.1), g = 9 * Vector3d(1, 2, 3);
    const VectorXd spin = F_I * fe::calc_load_factors(Vector3d::Zero(), Vector3d::Zero(), omega);
    const VectorXd both = spin + 2 * F_I * fe::calc_load_factors(-g, Vector3d::Zero(), Vector3d::Zero());
    EXPECT_LT((calc_load(model, deck, 4, diagnostics) - spin).norm(), 1e-12 * spin.norm());
    EXPECT_LT((calc_load(model, deck, 6, diagnostics) - both).norm(), 1e-12 * both.norm());
    // The whole: Newton and Euler.
    const auto properties = fe::calc_mass_properties(model, kind, Vector3d::Zero());
    const VectorXd resultant = model.calc_rigid_modes().transpose() * spin;
    const Vector3d force = -properties.mass * omega.cross(omega.cross(properties.cg));
    EXPECT_LT((resultant.head<3>() - force).norm(), 1e-12 * force.norm());
    const Vector3d moment = -omega.cross(properties.inertia * omega);
    if (kind == MassKind::Consistent) {
      EXPECT_LT((resultant.tail<3>() - moment).norm(), 1e-12 * moment.norm());
    }
  }
}

// The bodies of every element give its mass matrix. Lumped CBEAMs and BARMASS, whose M has no bending inertia of the
// section, have ∫(y² - z²) beside it: no motion of M has less energy than its bodies.
TEST(CarriedBodies, AreTheMassMatrix) {
  const std::string more =  // a polar inertia; a round section, for which nothing is beside M
      "PBEAM,12,1,4.-4,8.-8,2.-8,1.-8,3.-8,.7\n,,,,,,,,\n,.8,.8,,,.02,.03\n,.01,.02,-.01,.02,.005,-.01,.01,.01\n"
      "CBEAM,71,12,1,2,0.,0.,1.\n,,,.01,.05,-.03,.02,-.04,.06\n"
      "PBAR,13,1,4.-4,5.-8,5.-8,6.-8,1.5\nCBAR,72,13,1,2,0.,0.,1.\n,,,.01,.05,-.03,.02,-.04,.06\n";
  int count = 0;
  for (const std::string barmass : {"", "NASTRAN BARMASS=1\n"}) {
    Diagnostics diagnostics;
    const auto deck = test::read_deck(barmass + test::make_all_kinds() + more, diagnostics);
    const auto model = fe::build_model(deck, {}, diagnostics);
    for (const auto kind : {MassKind::Lumped, MassKind::Consistent})
      for (const auto& element : model.elements()) {
        fe::CarriedMass carried(element->num_dofs());
        if (!element->offset_mass(kind) || !calc_carried(model, *element, kind, carried)) continue;
        MatrixXd M = MatrixXd::Zero(element->num_dofs(), element->num_dofs());
        element->add_mass(kind, model.wtmass(), M);
        const MatrixXd rest = M - carried.calc_mass();
        const double size = M.cwiseAbs().maxCoeff();
        const bool has_rest = element->id() != 72 && ((kind == MassKind::Lumped && element->card() == "CBEAM") ||
                                                      (!barmass.empty() && element->card() == "CBAR"));
        if (has_rest) {
          const VectorXd energies = Eigen::SelfAdjointEigenSolver<MatrixXd>(rest).eigenvalues();
          EXPECT_GT(energies.minCoeff(), -1e-12 * size) << element->card() << " " << element->id();
          EXPECT_LT(energies.maxCoeff(), 1e-2 * size) << element->card() << " " << element->id();
        } else {
          EXPECT_LT(rest.cwiseAbs().maxCoeff(), 1e-13 * size) << element->card() << " " << element->id();
        }
        ++count;
      }
  }
  EXPECT_GT(count, 40);
}

// Carried moments against exact rotations: W(θ) = -Σ f·exp(θ̃) s over random points of a body.
TEST(CarriedBodies, SecondOrderIsThatOfExactRotations) {
  std::srand(7);
  Vector3d S = Vector3d::Zero();
  Matrix3d E = Matrix3d::Zero();
  std::vector<std::pair<double, Vector3d>> points;
  for (int i = 0; i < 9; ++i) {
    points.emplace_back(1 + 0.5 * Vector3d::Random().x(), Vector3d::Random());
    S += points.back().first * points.back().second;
    E += points.back().first * points.back().second * points.back().second.transpose();
  }
  fe::CarriedMass carried(6);
  const Vector3d x = Vector3d::Random();
  carried.add_grid_body(x, 3, S, E, 0);
  Eigen::Matrix<double, 12, 1> A_I = Eigen::Matrix<double, 12, 1>::Random();
  const auto field = fe::calc_acceleration_field(A_I);
  const auto num_points = static_cast<Eigen::Index>(carried.points.size());
  const fe::Matrix3Xd f =  // rows: along x of every point first
      fe::AccelerationFields(std::vector{field}).calc_point_loads(carried).reshaped(num_points, 3).transpose();
  Matrix3d K = Matrix3d::Zero();
  for (const auto& turn : carried.turns)
    for (const auto& part : turn.parts) K += fe::calc_arm_stiffness(part.B.transpose() * f.col(part.point), part.arm);
  const auto calc_energy = [&](const Vector3d& theta) {
    double W = 0;
    for (const auto& [m, s] : points) W += m * (field.a_o + field.A * (x + s)).dot(calc_rotation_exp(theta) * s);
    return W;
  };
  // Second derivatives of fourth order along directions: d²W(p) = pᵀ K p.
  const double h = 1e-2;
  for (int i = 0; i < 6; ++i) {
    const Vector3d p = Vector3d::Random();
    const double second = (-calc_energy(2 * h * p) + 16 * calc_energy(h * p) - 30 * calc_energy(0 * p) +
                           16 * calc_energy(-h * p) - calc_energy(-2 * h * p)) /
                          (12 * h * h);
    EXPECT_NEAR(p.dot(K * p), second, 1e-6 * std::max(std::abs(second), K.norm() * p.squaredNorm()));
  }
  // The closed form ½ (C + Cᵀ) - tr(C) 1 with C = S a_0ᵀ + E Aᵀ.
  const Matrix3d C = S * (field.a_o + field.A * x).transpose() + E * field.A.transpose();
  EXPECT_LT((K - (0.5 * (C + C.transpose()) - C.trace() * Matrix3d::Identity())).norm(), 1e-13);
}

}  // namespace
}  // namespace bough
