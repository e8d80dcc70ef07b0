#pragma once
/// \file Forces and stresses of elements of a flexible body in motion (docs/theory/recovery.md).
///
/// Rows = offset + matrix η + beyond (products of η, of a body of third order) + inertial (A_I - A_I of the preload) +
/// Σ external f: A_I is the motion of the body's origin minus gravity; f of hinges, constraints, [[force]]s without a
/// type and load patterns at the body's locators. The meaning of the rows is in the body's file; here they have names.
#include <array>

#include "formats/records/flex_body.hpp"
#include "solver/bodies/polynomial.hpp"
#include "solver/forces/applied.hpp"
#include "solver/motion/motion.hpp"

namespace bough::solver {

struct NodeSource;

class Recovery {
 public:
  struct Element {
    std::string path;  ///< "CBAR/17"
    int id = 0;
    int first = 0;  ///< row
    std::vector<std::string> components;
    bool is_recorded = false;
    /// Number of rows.
    int size() const { return static_cast<int>(components.size()); }
  };

  /// Copies the recovery matrices of all blocks; `body`: tree index. `is_third_order`: its displacements are, so are
  /// the rows.
  Recovery(const records::FlexBody& flex, int body, bool is_third_order);
  ~Recovery();

  /// All elements in the order of the rows.
  const std::vector<Element>& elements() const { return elements_; }
  /// nullptr when absent.
  const Element* find(int id) const;
  void record(int id);  ///< among the results
  /// Finds the loads on the body at its locators. Returns ids of loaded nodes without static response in the file.
  std::vector<int> connect(const Tree& tree, const Loops& loops, const std::vector<AppliedForce>& forces,
                           const records::FlexBody& flex, const std::vector<records::ForceRecord>& records);

  /// Rows first ... first + count. After calc_accelerations. No allocation.
  void calc(const Motion& motion, int first, int count, double* out) const;

 private:
  struct Loaded;
  void add_products(const records::FlexBody& flex);
  struct Pattern {
    const AppliedForce* force = nullptr;
    VectorXd rows;
  };
  int body_;
  std::vector<Element> elements_;
  /// Degree 2 to 4: the amplitudes of each product, and rows x products.
  struct Product {
    std::array<int, 4> modes{-1, -1, -1, -1};  ///< -1: none; from n on: directions
    VectorXd rows;
  };
  MatrixXd matrix_, inertial_;  ///< rows x n, rows x 12
  std::vector<Product> products_;
  LargeAmplitudes large_;
  MatrixXd external_;  ///< rows x locators
  VectorXd offset_;
  Eigen::Matrix<double, 12, 1> preload_ = Eigen::Matrix<double, 12, 1>::Zero();
  std::vector<Loaded> loaded_;
  std::vector<Pattern> patterns_;
};

}  // namespace bough::solver
