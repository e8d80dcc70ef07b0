#pragma once
/// \file A deck by hand, its elements, and dense matrices: enough finite elements to test an element by.
#include <map>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "base/rotation.hpp"
#include "fe/elements/damping.hpp"
#include "fe/elements/element.hpp"
#include "fe/elements/stress_state.hpp"

namespace bough::fe::test {

/// Grids in basic, with rectangular systems given by hand.
class HandNodes final : public NodeTable {
 public:
  int add_grid(int id, const Vector3d& x, const Matrix3d& R_basic_cd = Matrix3d::Identity());
  int add_scalar_point(int id);
  void add_system(int id, const Vector3d& origin, const Matrix3d& R) { systems_[id] = {origin, R}; }

  int find_node(int id) const override;
  const Node& node(int index) const override { return nodes_[static_cast<std::size_t>(index)]; }
  Matrix3d calc_axes(int cid, const Vector3d& x, const SourceLocation& at, Diagnostics& diagnostics) const override;
  Vector3d calc_point(int cid, const Vector3d& x, const SourceLocation& at, Diagnostics& diagnostics) const override;

  int num_nodes() const { return static_cast<int>(nodes_.size()); }
  int num_gdofs() const { return num_gdofs_; }
  /// num_gdofs x 6 rigid motions about the origin; scalar points zero.
  MatrixXd calc_rigid_modes() const;

 private:
  std::vector<Node> nodes_;
  std::map<int, std::pair<Vector3d, Matrix3d>> systems_;
  int num_gdofs_ = 0;
};

struct SmallModel {
  records::Deck deck;
  HandNodes nodes;
  std::vector<std::unique_ptr<const Element>> elements;

  SmallModel();
  /// Makes the elements; fails the test when there are errors.
  void make();
  MatrixXd calc_stiffness() const;
  MatrixXd calc_mass(MassKind kind) const;
  /// K_G of the displacements u (num_gdofs).
  MatrixXd calc_geometric_stiffness(const VectorXd& u) const;
};

/// Basic position of grids 1 and 2 of add_two_grids().
inline const Vector3d kPointA(0.3, -1.2, 0.7), kPointB(1.9, 0.4, -0.6);
/// Grids 1 at kPointA and 2 at kPointB, each with its own displacement axes, and the system 7 for elements.
void add_two_grids(SmallModel& m);
/// MAT1 1 for lines between the two grids: E = 3, G = 1.1, rho = 0.8, which no NU ties.
void add_line_material(SmallModel& m);
/// CBAR or CBEAM 5 of property 9 between the two grids.
records::BeamElement make_beam(bool is_cbeam);
/// MAT1 1 with E = 3, nu = 0.3, rho = 0.8 and PSHELL 1 of it: thickness t, NSM 0.1.
void add_isotropic(SmallModel& m, double t);
/// Number of messages with this id when the elements of a copy of the deck are made.
int count_messages(const SmallModel& m, const char* id);

/// Dofs left when those of `fixed` are removed from 0..n-1.
std::vector<int> list_free(int n, const std::vector<int>& fixed);
MatrixXd pick(const MatrixXd& A, const std::vector<int>& rows);
/// Solution of K u = f with u = 0 on `fixed`.
VectorXd solve_static(const MatrixXd& K, const VectorXd& f, const std::vector<int>& fixed);
/// Lowest frequencies (rad/s) of the free dofs; massless dofs are allowed.
VectorXd calc_frequencies(const MatrixXd& K, const MatrixXd& M, const std::vector<int>& fixed);
/// Smallest positive load factor of (K + λ K_G) φ = 0 on the free dofs.
double calc_load_factor(const MatrixXd& K, const MatrixXd& K_G, const std::vector<int>& fixed);

/// A random rotation from a fixed seed.
Matrix3d make_rotation(unsigned seed);

/// MAT1, PBAR and a chain of CBARs (or CBEAMs) along R's x axis from the origin, ids 1..num+1; v is R's y axis.
struct ChainOptions {
  int num_elements = 10;
  double length = 1;
  Matrix3d R = Matrix3d::Identity();
  double E = 1, G = 1, rho = 1;
  records::Pbar section;
};
SmallModel make_bar_chain(const ChainOptions& options);

}  // namespace bough::fe::test
