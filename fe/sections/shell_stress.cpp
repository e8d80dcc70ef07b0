#include "fe/sections/shell_stress.hpp"

#include <cmath>

#include <Eigen/QR>

namespace bough::fe {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Matrix3x6d = Eigen::Matrix<double, 3, 6>;

/// Strains in axes at `angle` from those given (Jones, eq. 2.75).
Matrix3d calc_turn(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Matrix3d t;
  t << c * c, s * s, c * s, s * s, c * c, -c * s, -2 * c * s, 2 * c * s, c * c - s * s;
  return t;
}

/// [ε; κ] per [N; M]; a laminate without bending (LAM = MEM) or membrane has no strain of that kind.
Matrix6d calc_compliance(const ShellSection& section) {
  Matrix6d law;
  law << section.A, section.B, section.B.transpose(), section.D;
  // Membrane and bending scaled to one size, so that the rank is found.
  const double a = std::sqrt(section.A.norm()), d = std::sqrt(section.D.norm());
  Eigen::Matrix<double, 6, 1> scale;
  scale << Vector3d::Constant(a > 0 ? 1 / a : 1), Vector3d::Constant(d > 0 ? 1 / d : 1);
  const Matrix6d scaled = scale.asDiagonal() * law * scale.asDiagonal();
  return scale.asDiagonal() * Matrix6d(scaled.completeOrthogonalDecomposition().pseudoInverse()) * scale.asDiagonal();
}

Matrix3x6d calc_strain_at(double z, double angle) {
  const Matrix3d turn = calc_turn(angle);
  Matrix3x6d strain;
  strain << turn, z * turn;
  return strain;
}

Matrix3x6d calc_layer_strain(const ShellStress::Layer& layer) { return calc_strain_at(layer.z, layer.angle); }

/// Between the layers; none above the last.
std::size_t count_bonds(const ShellStress& stress) { return stress.has_shear ? stress.layers.size() - 1 : 0; }

/// Strains at the points of list_strain_points() per [ε; κ].
Eigen::Matrix<double, Eigen::Dynamic, 6> list_strains(const ShellStress& stress) {
  std::vector<Matrix3x6d> rows;
  for (const auto& layer : stress.layers) rows.push_back(calc_layer_strain(layer));
  if (stress.layers.empty())
    for (const double z : {stress.z1, stress.z2}) rows.push_back(calc_strain_at(z, 0));
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::Matrix<double, Eigen::Dynamic, 6> all(3 * count + 6, 6);
  for (Eigen::Index k = 0; k < count; ++k) all.middleRows<3>(3 * k) = rows[static_cast<std::size_t>(k)];
  all.bottomRows<6>().setIdentity();
  return all;
}

}  // namespace

std::vector<StressPoint> list_stress_points(const ShellSection& section) {
  std::vector<StressPoint> points;
  if (!section.stress) return points;
  if (section.stress->layers.empty()) {
    points.resize(2);
    points[0].name = "bottom";
    points[1].name = "top";
    return points;
  }
  for (const auto& layer : section.stress->layers) {
    auto& point = points.emplace_back();
    point.name = "ply" + std::to_string(points.size());
    point.kind = StressKind::Ply;
    point.theory = layer.theory;
    point.strength = layer.strength;
    if (layer.theory == FailureTheory::Strain) point.compliance = layer.Q.inverse();
  }
  for (std::size_t k = 1; k <= count_bonds(*section.stress); ++k) {
    auto& point = points.emplace_back();
    point.name = "bond" + std::to_string(k);
    point.kind = StressKind::Bond;
    point.theory = section.stress->layers.front().theory;
    point.bond = section.stress->bond;
  }
  return points;
}

Eigen::Matrix<double, Eigen::Dynamic, 8> calc_stress_map(const ShellSection& section) {
  Eigen::Matrix<double, Eigen::Dynamic, 8> map(0, 8);
  if (!section.stress) return map;
  const ShellStress& stress = *section.stress;
  if (stress.layers.empty()) {
    map.setZero(6, 8);
    for (int k = 0; k < 2; ++k) {
      if (stress.t > 0) map.block<3, 3>(3 * k, 0) = Matrix3d::Identity() / stress.t;
      const double z = k == 0 ? stress.z1 : stress.z2;
      if (stress.inertia > 0) map.block<3, 3>(3 * k, 3) = z / stress.inertia * Matrix3d::Identity();
    }
    return map;
  }
  const Matrix6d compliance = calc_compliance(section);
  const auto num_plies = static_cast<Eigen::Index>(stress.layers.size());
  const auto num_bonds = static_cast<Eigen::Index>(count_bonds(stress));
  map.setZero(3 * num_plies + 2 * num_bonds, 8);
  for (Eigen::Index k = 0; k < num_plies; ++k) {
    const auto& layer = stress.layers[static_cast<std::size_t>(k)];
    map.block<3, 6>(3 * k, 0) = layer.Q * calc_layer_strain(layer) * compliance;
    if (k < num_bonds) map.block<2, 2>(3 * num_plies + 2 * k, 6) = layer.shear;
  }
  return map;
}

Eigen::VectorXd calc_ply_expansion(const ShellSection& section, double t, double g) {
  if (!section.stress || section.stress->layers.empty() || !section.expansion) return {};
  const auto& layers = section.stress->layers;
  Eigen::Matrix<double, 6, 1> held;
  held << section.expansion->calc_N(t, g), section.expansion->calc_M(t, g);
  const Eigen::Matrix<double, 6, 1> free = calc_compliance(section) * held;
  Eigen::VectorXd result =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * layers.size() + 2 * count_bonds(*section.stress)));
  for (std::size_t k = 0; k < layers.size(); ++k)
    result.segment<3>(3 * static_cast<Eigen::Index>(k)) =
        layers[k].Q * (calc_layer_strain(layers[k]) * free - (t + layers[k].z * g) * layers[k].alpha);
  return result;
}

std::vector<StressPoint> list_strain_points(const ShellSection& section) {
  auto points = list_stress_points(section);
  if (points.empty()) return points;
  std::erase_if(points, [](const StressPoint& point) { return point.kind == StressKind::Bond; });
  for (auto& point : points) point.theory = FailureTheory::None;
  points.emplace_back().name = "mid";
  points.back().kind = StressKind::Mid;
  return points;
}

Eigen::Matrix<double, Eigen::Dynamic, 6> calc_strain_map(const ShellSection& section) {
  if (!section.stress) return Eigen::Matrix<double, Eigen::Dynamic, 6>(0, 6);
  return list_strains(*section.stress) * calc_compliance(section);
}

Eigen::VectorXd calc_section_expansion(const ShellSection& section, double t, double g) {
  if (!section.stress || !section.expansion) return {};
  Eigen::Matrix<double, 6, 1> held;
  held << section.expansion->calc_N(t, g), section.expansion->calc_M(t, g);
  return calc_strain_map(section) * held;
}

}  // namespace bough::fe
