#pragma once
/// \file Spectral densities between the loads of the subcases of a random response. Source: MSC Nastran Quick Reference
/// Guide, RANDPS, TABRND1, TABRNDG.
#include <complex>
#include <vector>

#include <Eigen/Dense>

#include "formats/records/deck_dynamics.hpp"

namespace bough::modal::response {

/// Represents the Hermitian matrix S_jk(f) of a set of RANDPS. Several cards of one pair of subcases add up.
class InputSpectrum {
 public:
  /// Reports modal.missing-random, modal.missing-table, modal.bad-spectrum, modal.random-subcase.
  InputSpectrum(const records::DynamicDeck& deck, int set, const SourceLocation& at, Diagnostics& diagnostics);

  /// Id of the RANDPS set.
  int set() const { return set_; }
  const std::vector<int>& subcases() const { return subcases_; }  ///< ascending; rows of S

  /// S at a frequency [n x n], n subcases: each card's factor times its table or gust spectrum.
  Eigen::MatrixXcd calc(double hz) const;
  /// L [n x n] with S = L Lᴴ of the rows `members`.
  Eigen::MatrixXcd factor(double hz, const std::vector<int>& members) const;
  /// Rows that cross terms couple, group by group.
  std::vector<std::vector<int>> list_groups() const;
  /// Frequencies at which S has corners [Hz].
  std::vector<double> list_corners() const;

  /// Reports modal.bad-spectrum where S is not positive semi-definite, and the warning modal.random-range beyond the
  /// ends of the tables.
  void check(const Eigen::VectorXd& hz, Diagnostics& diagnostics) const;

 private:
  struct Term {
    const records::SpectralTerm* card = nullptr;
    const records::DynamicTable* table = nullptr;
    const records::GustSpectrum* gust = nullptr;
    int row = 0, column = 0;
  };
  static double calc_table(const Term& term, double hz);
  void add_term(const records::SpectralTerm& card, Diagnostics& diagnostics);
  void check_subcases(Diagnostics& diagnostics) const;

  const records::DynamicDeck& deck_;
  int set_;
  std::vector<int> subcases_;
  std::vector<Term> terms_;
};

/// The corners of a table that a term takes at frequencies [Hz].
void add_corners(const records::DynamicTable& table, std::vector<double>& corners);

}  // namespace bough::modal::response
