#pragma once
/// \file Rotors of a subcase: RGYRO with ROTORG and RSPINR, or RMETHOD with ROTORD (docs/theory/rotors.md).
#include <optional>
#include <vector>

#include "fe/matrices/rotor_matrices.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::modal::rotors {

using Eigen::VectorXd;

/// Spin rate of a rotor over that of the reference rotor, [1/T] rad per unit of time: linear between the values of the
/// cards and beyond them; of a single pair in proportion.
class SpeedRelation {
 public:
  /// Ω = factor Ω_ref.
  explicit SpeedRelation(double factor = 1) : factor_(factor) {}
  /// \param reference, own  [1/T] of equal length, 2 or more, ascending `reference`.
  SpeedRelation(std::vector<double> reference, std::vector<double> own)
      : reference_(std::move(reference)), own_(std::move(own)) {}
  /// Spin rate [1/T] at a rate of the reference rotor [1/T].
  double evaluate(double reference) const;
  /// Offset a and factor b of Ω = a + b Ω_ref; none if the values are not on a line.
  std::optional<std::pair<double, double>> find_line() const;

 private:
  double factor_ = 1;
  std::vector<double> reference_, own_;
};

struct RotorCase {
  bool is_synchronous = false;  ///< the reference rotor turns at the frequency of the motion
  int reference = 0;            ///< rotor id; 0: the speeds of ROTORD
  std::vector<double> speeds;   ///< [1/T] of the reference, ascending; of asynchronous analyses
  double low = 0, high = 0;     ///< [1/T] range of synchronous analyses
  bool is_rotating = false;     ///< displacements in the frame of the only rotor
  double shapes_at = -1;        ///< [1/T] speed of the shapes that are kept; negative: the last
  std::vector<fe::RotorAxis> axes;
  std::vector<fe::RotorDamping> damping;  ///< of each axis
  std::vector<SpeedRelation> relations;   ///< of each axis
};

/// Purpose of the rotors: structural damping without WR3 and WR4 acts at each frequency of a response, and not on
/// complex eigenvalues.
enum class RotorUse { Eigenvalues, Frequency };

/// Reads the rotors that RGYRO or RMETHOD of the subcase selects; nothing without. Reports modal.missing-rotor,
/// modal.rotor-line, modal.rotor-shared, modal.rotor-speeds, modal.rotor-damping (warning).
std::optional<RotorCase> choose_rotors(const fe::Model& model, const records::DynamicDeck& deck,
                                       const records::DynamicSubcase& subcase, RotorUse use, Diagnostics& diagnostics);

/// Returns true if ROTORD of the subcase names the centrifugal stress of its rotors (RFORCE): that of RotorTerms, at
/// each speed, is in place of the preload of STATSUB.
bool has_own_stress(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase);

/// Matrices of all rotors of a case on the g-set.
class RotorTerms {
 public:
  /// Reports what fe::find_rotors does, and modal.rotor-unsupported. Throws them, and fe.mechanism if K cannot hold the
  /// centrifugal load of a rotor.
  RotorTerms(const fe::Model& model, const RotorCase& rotor_case, double g, Diagnostics& diagnostics);

  /// Rotors in the order of the axes of the case.
  const std::vector<fe::Rotor>& rotors() const { return rotors_; }
  /// Part of B: Σ Ω_j G_j + C_j. \param reference  [1/T] speed of the reference rotor.
  fe::SparseColumns calc_damping(double reference) const;
  /// Part of K, unsymmetric: Σ Ω_j R_j.
  fe::SparseColumns calc_circulation(double reference) const;
  /// Part of K: Σ Ω_j² S_j, of the centrifugal force and its stress.
  fe::SparseColumns calc_centrifugal(double reference) const;
  /// Terms with the frequency as speed, of relations that are lines Ω_j = a_j + b_j ω: those with a_j, and Σ b_j G_j,
  /// Σ b_j R_j.
  struct Synchronous {
    fe::SparseColumns damping, circulation;                               ///< at ω = 0
    fe::SparseColumns gyroscopic_rate, circulation_rate;                  ///< derivatives with respect to ω
    fe::SparseColumns centrifugal, centrifugal_rate, centrifugal_square;  ///< Σ a_j² S_j, Σ 2 a_j b_j S_j, Σ b_j² S_j
  };
  /// Matrices of analyses at the speed of the motion. \pre all relations are lines.
  Synchronous calc_synchronous() const;
  /// Σ H_j, an imaginary part of K.
  fe::SparseColumns calc_structural() const;
  /// Σ Ω_j/ω (-H_j ẽ), an addition to K. \param omega  [1/T] of the motion; 0: no addition.
  fe::SparseColumns calc_structural_circulation(double reference, double omega) const;
  /// Part of the model's structural damping, with PARAM,G, that belongs to the rotors and is in `calc_structural` or
  /// in the viscous terms.
  const fe::SparseColumns& model_structural() const { return model_structural_; }

 private:
  fe::SparseColumns sum(const std::function<double(std::size_t)>& factor,
                        fe::SparseColumns fe::RotorMatrices::*member) const;
  fe::SparseColumns sum_centrifugal(const std::function<double(std::size_t)>& factor) const;

  const RotorCase case_;
  Eigen::Index num_gdofs_;
  std::vector<fe::Rotor> rotors_;
  std::vector<fe::RotorMatrices> matrices_;
  std::vector<fe::SparseColumns> centrifugal_;  ///< S_j, with the stress
  fe::SparseColumns model_structural_;
};

}  // namespace bough::modal::rotors
