#pragma once
/// \file Springs and dampers with tables over frequency (PELAST, PDAMPT, PBUSHT; docs/theory/response.md).
#include <complex>
#include <vector>

#include "fe/linear/complex_lu.hpp"
#include "fe/model/model.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::modal::response {

/// Reports PELAST, PDAMPT and PBUSHT in sections with elements, which are condensed with the values of the properties
/// (modal.part-tables).
void report_part_tables(const records::DynamicDeck& deck, Diagnostics& diagnostics);

/// Differences between the tables and the values of the properties, of which the model is made:
///   Z(f) = (1 + i g) (K(f) - K) + i (K_GE(f) - K_GE) + i ω (B(f) - B), ω = 2 π f.
class FrequencyTables {
 public:
  /// \param g  PARAM,G. Reports modal.missing-table. `deck` must outlive this.
  FrequencyTables(const fe::Model& model, const records::DynamicDeck& deck, double g, Diagnostics& diagnostics);

  /// Returns true if no element of the model has a table.
  bool is_empty() const { return springs_.empty(); }
  /// Unit forces of the springs and dampers, num_gdofs x springs; basic axes.
  const Eigen::SparseMatrix<double>& directions() const { return directions_; }
  /// Z(f) of each spring. \param hz  f [1/T].
  Eigen::VectorXcd calc_stiffness(double hz) const;
  /// Z(f), num_gdofs x num_gdofs.
  linear::ComplexSparse calc_matrix(double hz) const;
  /// Part of K of complex modes at x of the tables [1/T], structural damping included.
  linear::ComplexSparse calc_stiffness_matrix(double x) const;
  /// Part of B of complex modes at x of the tables [1/T].
  linear::ComplexSparse calc_damping_matrix(double x) const;
  /// k(f) - k of spring c of an element, which its printed force lacks; 0 without a table. In the order of
  /// fe::SpringRows.
  Eigen::VectorXd calc_force_change(const fe::Element& element, double hz) const;

 private:
  struct Spring {
    const fe::Element* element = nullptr;
    int row = 0;                  ///< of fe::SpringRows
    double k = 0, b = 0, ge = 0;  ///< values of the property
    const records::DynamicTable *k_table = nullptr, *b_table = nullptr, *ge_table = nullptr;
  };
  std::complex<double> calc_static(const Spring& spring, double x) const;
  static double calc_damping(const Spring& spring, double x);
  linear::ComplexSparse sum(const Eigen::VectorXcd& factors) const;

  double g_;
  std::vector<Spring> springs_;
  Eigen::SparseMatrix<double> directions_;
};

}  // namespace bough::modal::response
