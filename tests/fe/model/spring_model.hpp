#pragma once
/// \file Small decks and test elements, so that the model is tested apart from the real elements.
#include <memory>
#include <random>
#include <vector>

#include "fe/model/model.hpp"

namespace bough::fe::test {

/// A 12-dof element between two grids from given matrices in basic; stiffness that a rigid motion does not feel:
/// K = Gᵀ S G with G the relative motion of B as carried by A.
class LinkElement final : public Element {
 public:
  LinkElement(int id, int a, int b, const NodeTable& nodes, const Eigen::Matrix<double, 6, 6>& S, double mass)
      : Element(id, "LINK", {a, b}, make_gdofs(nodes.node(a), nodes.node(b))), mass_(mass) {
    const Vector3d r = nodes.node(b).x - nodes.node(a).x;
    Eigen::Matrix<double, 6, 12> G = Eigen::Matrix<double, 6, 12>::Zero();
    G.rightCols<6>().setIdentity();
    G.leftCols<6>().setIdentity();
    G.block<3, 3>(0, 3) << 0, r.z(), -r.y(), -r.z(), 0, r.x(), r.y(), -r.x(), 0;
    G.leftCols<6>() *= -1;
    K_ = G.transpose() * S * G;
  }
  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override { K += scale * K_; }
  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override {
    // Consistent: linear shape functions for the translations.
    for (int i = 0; i < 3; ++i) {
      const double own = kind == MassKind::Lumped ? mass_ / 2 : mass_ / 3;
      M(i, i) += scale * own;
      M(6 + i, 6 + i) += scale * own;
      M(i, 6 + i) += scale * (mass_ / 2 - own);
      M(6 + i, i) += scale * (mass_ / 2 - own);
    }
  }
  ElementShape shape() const override { return {"line2", nodes()}; }

 private:
  static std::vector<int> make_gdofs(const Node& a, const Node& b) {
    std::vector<int> gdofs;
    for (int i = 0; i < 6; ++i) gdofs.push_back(a.first_gdof + i);
    for (int i = 0; i < 6; ++i) gdofs.push_back(b.first_gdof + i);
    return gdofs;
  }
  Eigen::Matrix<double, 12, 12> K_;
  double mass_;
};

/// A full symmetric positive definite 6 x 6, fixed by the seed.
inline Eigen::Matrix<double, 6, 6> make_spd(unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::NullaryExpr([&] { return uniform(generator); });
  return 1000 * (A * A.transpose() + Eigen::Matrix<double, 6, 6>::Identity());
}

inline MatrixXd make_random(Eigen::Index rows, Eigen::Index cols, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return MatrixXd::NullaryExpr(rows, cols, [&] { return uniform(generator); });
}

/// Grids 1..n at the given points, no case control.
inline records::Deck make_deck(const std::vector<Vector3d>& points) {
  records::Deck deck;
  deck.files = {"test.bdf"};
  deck.sol = "103";
  deck.subcases.resize(1);
  for (size_t i = 0; i < points.size(); ++i) {
    records::Grid grid;
    grid.id = static_cast<int>(i) + 1;
    grid.x = points[i];
    grid.at.line = static_cast<int>(i) + 1;
    deck.grids.push_back(grid);
  }
  return deck;
}

/// Links between the listed grid ids, each of unlike stiffness and mass 2 + index.
inline ElementFactory make_links(std::vector<std::pair<int, int>> pairs) {
  return [pairs](const records::Deck&, const NodeTable& nodes, Diagnostics&) {
    ElementList list;
    for (size_t e = 0; e < pairs.size(); ++e) {
      const int a = nodes.find_node(pairs[e].first), b = nodes.find_node(pairs[e].second);
      if (a < 0 || b < 0) continue;
      list.elements.push_back(std::make_unique<LinkElement>(
          static_cast<int>(e) + 1, a, b, nodes, make_spd(static_cast<unsigned>(e) + 1), 2.0 + static_cast<double>(e)));
    }
    return list;
  };
}

/// Six points in general position.
inline std::vector<Vector3d> make_points() {
  return {{0, 0, 0}, {1, 0.2, 0}, {2, -0.1, 0.3}, {2.5, 1, 0.5}, {3.1, 1.5, -0.4}, {1.2, 2, 1}};
}

/// Cylindrical system about basic z from basic x.
inline records::CoordSystem make_cylinder(int id) {
  records::CoordSystem system;
  system.id = id, system.kind = records::CoordKind::Cylindrical;
  system.b = {0, 0, 1}, system.c = {1, 0, 0};
  return system;
}

inline records::Spc make_spc(int sid, int grid, unsigned mask) {
  records::Spc spc;
  spc.sid = sid;
  spc.g = grid;
  spc.c = mask;
  return spc;
}

/// Dense Σ of element matrices on the g-set, apart from assembly.
inline MatrixXd sum_stiffness(const Model& model) {
  MatrixXd K = MatrixXd::Zero(model.num_gdofs(), model.num_gdofs());
  for (const auto& e : model.elements()) {
    MatrixXd K_e = MatrixXd::Zero(e->num_dofs(), e->num_dofs());
    e->add_stiffness(1, K_e);
    K(e->gdofs(), e->gdofs()) += K_e;
  }
  return K;
}

}  // namespace bough::fe::test
