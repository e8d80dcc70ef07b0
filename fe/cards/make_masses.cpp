#include "fe/cards/maker.hpp"
#include "fe/elements/point_mass.hpp"

namespace bough::fe {
namespace {

using records::Conm1;
using records::Conm2;

void make_conm1(Maker& maker, const Conm1& card) {
  const std::string who = "CONM1 " + std::to_string(card.id);
  const int node = maker.find_grid(card.g, who, card.at);
  if (node < 0) return;
  const Matrix3d R =
      maker.nodes().calc_axes(card.cid, maker.nodes().node(node).x, maker.deck().locate(card.at), maker.diagnostics());
  Eigen::Matrix<double, 6, 6> T = Eigen::Matrix<double, 6, 6>::Zero();
  T.topLeftCorner<3, 3>() = T.bottomRightCorner<3, 3>() = R;
  auto mass = std::make_unique<PointMass>(card.id, "CONM1", std::vector{node}, maker.list_gdofs({node}),
                                          T * card.m * T.transpose());
  if (!mass->is_rigid())
    maker.diagnostics().warning("fe.mass-not-rigid", maker.deck().locate(card.at),
                                who +
                                    " is not the mass of a rigid body (one mass in all directions, coupled to "
                                    "rotations by m s): what spin does to it is an approximation",
                                "give a CONM2, or accept the approximation");
  // Scaled by the square roots of its diagonal, so that masses and inertias are of one size.
  const Eigen::Matrix<double, 6, 1> root =
      card.m.diagonal().cwiseAbs().cwiseSqrt().unaryExpr([](double r) { return r > 0 ? r : 1.0; });
  const Eigen::Matrix<double, 6, 6> scaled =
      root.cwiseInverse().asDiagonal() * card.m * root.cwiseInverse().asDiagonal();
  const double min_eigenvalue = Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(scaled).eigenvalues()[0];
  if (min_eigenvalue < -1e-9)
    maker.diagnostics().warning("fe.indefinite-mass", maker.deck().locate(card.at),
                                who + " has negative energy in some motion of its grid, which no mass has",
                                "give the diagonal terms too; no M_ij is larger than the root of M_ii M_jj");
  maker.add(std::move(mass));
}

void make_conm2(Maker& maker, const Conm2& card) {
  const std::string who = "CONM2 " + std::to_string(card.id);
  const int node = maker.find_grid(card.g, who, card.at);
  if (node < 0) return;
  const Vector3d x = maker.nodes().node(node).x;
  const auto at = maker.deck().locate(card.at);
  Matrix3d R = Matrix3d::Identity();
  Vector3d offset = card.x - x;
  if (card.cid >= 0) {
    R = maker.nodes().calc_axes(card.cid, x, at, maker.diagnostics());
    offset = R * card.x;
  }
  const auto& [i11, i21, i22, i31, i32, i33] = card.inertia;
  Matrix3d I;
  I << i11, -i21, -i31, -i21, i22, -i32, -i31, -i32, i33;
  if (card.m < 0 || i11 < 0 || i22 < 0 || i33 < 0) {
    maker.error("fe.negative-mass", card.at, who + " has a negative mass or moment of inertia",
                "a mass is positive; check the fields M and I11, I22, I33");
    return;
  }
  maker.add(std::make_unique<PointMass>(card.id, "CONM2", std::vector{node}, maker.list_gdofs({node}),
                                        calc_rigid_mass(card.m, offset, R * I * R.transpose())));
}

}  // namespace

void make_masses(Maker& maker) {
  for (const Conm1& card : maker.deck().conm1) make_conm1(maker, card);
  for (const Conm2& card : maker.deck().conm2) make_conm2(maker, card);
}

}  // namespace bough::fe
