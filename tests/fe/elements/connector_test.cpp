/// CFAST and CWELD on shells: K_G against the third derivative of the exact energy of springs between two fitted ends,
/// in long double, and against the nodal forces that turn.
#include <array>

#include <Eigen/SVD>

#include "element_checks.hpp"

namespace bough::fe::test {
namespace {

using Real = long double;
using Real3 = Eigen::Matrix<Real, 3, 1>;
using Real33 = Eigen::Matrix<Real, 3, 3>;
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

constexpr double kGap = 0.4, kSlope = 0.3, kDiameter = 1.9, kKt = 3, kKr = 0.2;
const double kHalf = 0.25 * std::sqrt(3.14159265358979323846) * kDiameter;

/// Grids of the model: a roof of two shells with its ridge at x = 0, and a flat shell above it.
const std::vector<Vector3d> kGrids = {{-1, -1, kSlope}, {0, -1, 0},       {1, -1, kSlope},  {-1, 1, kSlope},
                                      {0, 1, 0},        {1, 1, kSlope},   {-1.2, -1, kGap}, {1.1, -1, kGap},
                                      {1.1, 1.3, kGap}, {-1.2, 1.3, kGap}};

/// A connector of this deck on the roof (property 1) and the shell (property 2) at the middle of the ridge.
SmallModel make_model(const std::function<void(records::Deck&)>& add) {
  SmallModel m;
  const Matrix3d R = make_rotation(41);
  for (std::size_t k = 0; k < kGrids.size(); ++k) m.nodes.add_grid(static_cast<int>(k) + 1, R * kGrids[k]);
  m.nodes.add_grid(90, Vector3d::Zero());
  records::Mat1 material;
  material.id = 1, material.E = 3, material.nu = 0.3, material.G = 3 / 2.6, material.rho = 0.8;
  m.deck.mat1.push_back(material);
  for (const auto& [id, pid, grids] :
       {std::tuple(1, 1, std::vector{2, 3, 6, 5}), std::tuple(2, 1, std::vector{1, 2, 5, 4}),
        std::tuple(3, 2, std::vector{7, 8, 9, 10})}) {
    records::Pshell shell;
    shell.id = pid, shell.mid1 = 1, shell.t = 0.1;
    if (id != 2) m.deck.pshell.push_back(shell);
    records::ShellElement quad;
    quad.id = id, quad.pid = pid, quad.card = "CQUAD4", quad.grids = grids;
    m.deck.shells.push_back(quad);
  }
  add(m.deck);
  m.make();
  std::erase_if(m.elements, [](const auto& element) { return element->card() == "CQUAD4"; });
  EXPECT_EQ(m.elements.size(), 1u);
  return m;
}

void add_fastener(records::Deck& deck) {
  records::Pfast p;
  p.id = 9, p.d = kDiameter, p.kt = {kKt, kKt, kKt}, p.kr = {kKr, kKr, kKr};
  deck.special.pfast.push_back(p);
  records::Cfast e;
  e.id = 5, e.pid = 9, e.ida = 1, e.idb = 2, e.gs = 90;
  deck.special.cfast.push_back(e);
}

void add_weld(records::Deck& deck, const char* format, int a, int b) {
  records::Pweld p;
  p.id = 9, p.mid = 1, p.d = kDiameter;
  deck.special.pweld.push_back(p);
  records::Cweld e;
  e.id = 5, e.pid = 9, e.format = format, e.ida = a, e.idb = b, e.gs = 90;
  deck.special.cweld.push_back(e);
}

/// A point of the shells: weights of the grids.
using Weights = std::vector<std::pair<int, double>>;

Weights interpolate(const std::array<int, 4>& grids, double x0, double x1, double y0, double y1, double x, double y) {
  const double r = (x - x0) / (x1 - x0), s = (y - y0) / (y1 - y0);
  return {{grids[0], (1 - r) * (1 - s)}, {grids[1], r * (1 - s)}, {grids[2], r * s}, {grids[3], (1 - r) * s}};
}

/// Four points and the place of the end, on the undeformed shells before they are turned.
struct End {
  std::array<Weights, 4> points;
  Vector3d at;
};

/// Corners of the square on the roof, projected along the normals of its sides, and on the flat shell.
std::array<End, 2> list_ends() {
  std::array<End, 2> ends;
  const double x = kHalf / (1 + kSlope * kSlope);
  int k = 0;
  for (const double a : {-1, 1})
    for (const double b : {-1, 1}) {
      ends[0].points[static_cast<std::size_t>(k)] = a > 0 ? interpolate({1, 2, 5, 4}, 0, 1, -1, 1, x, b * kHalf)
                                                          : interpolate({0, 1, 4, 3}, -1, 0, -1, 1, -x, b * kHalf);
      ends[1].points[static_cast<std::size_t>(k++)] =
          interpolate({6, 7, 8, 9}, -1.2, 1.1, -1, 1.3, a * kHalf, b * kHalf);
    }
  ends[0].at = Vector3d::Zero();
  ends[1].at = Vector3d(0, 0, kGap);
  return ends;
}

/// Place of the spring on the side of an end, and the rotation of the end.
std::pair<Real3, Real33> move_end(const End& end, const SmallModel& m, const RealVector& u) {
  const Real33 Q = make_rotation(41).cast<Real>();
  std::array<Real3, 4> X, x;
  Real3 X_mean = Real3::Zero(), x_mean = X_mean;
  for (std::size_t k = 0; k < 4; ++k) {
    X[k] = x[k] = Real3::Zero();
    for (const auto& [grid, weight] : end.points[k]) {
      X[k] += weight * (Q * kGrids[static_cast<std::size_t>(grid)].cast<Real>());
      x[k] += weight * u.segment<3>(m.nodes.node(grid).first_gdof);
    }
    x[k] += X[k];
    X_mean += X[k] / 4;
    x_mean += x[k] / 4;
  }
  Real33 B = Real33::Zero();
  for (std::size_t k = 0; k < 4; ++k) B += (x[k] - x_mean) * (X[k] - X_mean).transpose();
  const Eigen::JacobiSVD<Real33> svd(B, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Real33 sign = Real33::Identity();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) sign(2, 2) = -1;
  const Real33 R = svd.matrixU() * sign * svd.matrixV().transpose();
  const Real3 middle = Q * Real3(0, 0, Real(kGap) / 2);
  return {x_mean + R * (middle - X_mean), R};
}

/// Springs alike in all directions need no axes: V = ½ k |x_b - x_a|² + ½ c |log(R_aᵀR_b)|².
Real calc_energy(const SmallModel& m, const RealVector& u) {
  const auto ends = list_ends();
  const auto [x_a, R_a] = move_end(ends[0], m, u);
  const auto [x_b, R_b] = move_end(ends[1], m, u);
  const Eigen::Quaternion<Real> turn(Real33(R_a.transpose() * R_b));
  const Real angle = 2 * std::atan2(turn.vec().norm(), std::abs(turn.w()));
  return Real(kKt) / 2 * (x_b - x_a).squaredNorm() + Real(kKr) / 2 * angle * angle;
}

/// ∂³V along v at rest: the odd part of V by its values at four points.
Real calc_third(const SmallModel& m, const VectorXd& v) {
  constexpr int n = 5;
  const Real h = 1e-3L;
  Eigen::Matrix<Real, n, n> powers;
  Eigen::Matrix<Real, n, 1> odd;
  for (int i = 0; i < n; ++i) {
    const RealVector u = Real(i + 1) * h * v.cast<Real>();
    odd[i] = (calc_energy(m, u) - calc_energy(m, -u)) / 2 / (h * h * h);
    for (int j = 0; j < n; ++j) powers(i, j) = std::pow(Real(i + 1), 2 * j + 3) * std::pow(h, 2 * j);
  }
  return 6 * powers.fullPivLu().solve(odd)[0];
}

TEST(Connector, GeometricStiffnessIsThirdDerivativeOfTheExactEnergy) {
  const SmallModel m = make_model(add_fastener);
  const int n = m.nodes.num_gdofs();
  // K itself: second derivative of the same energy.
  const VectorXd a = make_random(51, n), b = make_random(52, n), c = make_random(53, n);
  const MatrixXd K = m.calc_stiffness();
  const Real h = 1e-3L;
  const Real twice = (calc_energy(m, h * a.cast<Real>()) + calc_energy(m, -h * a.cast<Real>())) / (h * h);
  EXPECT_NEAR(static_cast<double>(twice), a.dot(K * a), 1e-4 * a.dot(K * a));
  const auto compare = [&](const VectorXd& p, const VectorXd& q, const VectorXd& r) {
    const Real third =
        (calc_third(m, p + q + r) - calc_third(m, p + q - r) - calc_third(m, p - q + r) + calc_third(m, p - q - r)) /
        24;
    const double found = q.dot(m.calc_geometric_stiffness(p) * r) + p.dot(m.calc_geometric_stiffness(q) * r) +
                         p.dot(m.calc_geometric_stiffness(r) * q);
    EXPECT_NEAR(found, static_cast<double>(third), 1e-8 * (p.norm() * q.norm() * r.norm()));
    return std::abs(found) / (p.norm() * q.norm() * r.norm());
  };
  EXPECT_GT(compare(a, b, c), 1e-5);
  // Motions without a force see K_G of the third alone.
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(K);
  const MatrixXd null = eigen.eigenvectors().leftCols(n - 6);
  EXPECT_LT((K * null).cwiseAbs().maxCoeff(), 1e-12);
  const VectorXd free_1 = null * make_random(54, n - 6), free_2 = null * make_random(55, n - 6);
  EXPECT_GT(compare(free_1, free_2, c), 1e-5);
}

TEST(Connector, GeometricStiffnessTurnsTheNodalForces) {
  for (const auto& add :
       std::vector<std::function<void(records::Deck&)>>{[](records::Deck& deck) {
                                                          add_fastener(deck);
                                                          deck.special.pfast.front().kt = {3, 2, 1};
                                                          deck.special.pfast.front().kr = {0.3, 0.2, 0.1};
                                                        },
                                                        [](records::Deck& deck) { add_weld(deck, "PARTPAT", 1, 2); },
                                                        [](records::Deck& deck) { add_weld(deck, "ELPAT", 1, 3); },
                                                        [](records::Deck& deck) { add_weld(deck, "ELEMID", 1, 3); }}) {
    const SmallModel m = make_model(add);
    const VectorXd u = make_random(61, m.nodes.num_gdofs());
    expect_sound_geometric(m, u);
    const VectorXd f = m.calc_stiffness() * u;
    const MatrixXd turned = m.calc_geometric_stiffness(u) * m.nodes.calc_rigid_modes().rightCols<3>();
    for (int axis = 0; axis < 3; ++axis) {
      const VectorXd expected = turn_forces(Vector3d::Unit(axis), f);
      EXPECT_LT((turned.col(axis) - expected).norm(), 1e-11 * expected.norm()) << axis;
    }
    expect_third_derivative_of_geometric(m);
  }
}

}  // namespace
}  // namespace bough::fe::test
