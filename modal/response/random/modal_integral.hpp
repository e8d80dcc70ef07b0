#pragma once
/// \file Moments of the spectral densities of a random response by integration over the band, not over the output
/// frequencies.
#include <vector>

#include "modal/response/random/input_spectrum.hpp"
#include "modal/response/random/modal_source.hpp"
#include "modal/response/random/output_forms.hpp"
#include "modal/response/random/spectral_moments.hpp"

namespace bough::modal::response {

/// Represents the covariances ∫ ω^r z S zᴴ df of the coordinates z of all subcases.
///
/// Gauss-Kronrod rules of 15 points on intervals that shrink geometrically towards each natural frequency, halved until
/// the rules of 7 and 15 points agree to kIntegralTolerance in every coordinate.
class ModalIntegral {
 public:
  /// \throws ComputationError modal.unbounded-response with a mode without damping within the band.
  ModalIntegral(const InputSpectrum& input, const std::vector<const ModalSource*>& sources, double min_hz,
                double max_hz);

  /// m0 and m2 of the forms of a map: `indices` its positions among the maps of each subcase, `num_components` columns
  /// of the map per entity, all forms of an entity after each other.
  SpectralMoments calc_moments(const std::vector<std::size_t>& indices, const std::vector<OutputForm>& forms,
                               Eigen::Index num_components) const;
  /// Relative error of the mean squares of the coordinates.
  double error() const { return error_; }

 private:
  struct Group {
    std::vector<int> members;  ///< rows of S
    std::vector<const ModalSource*> sources;
    std::vector<MatrixXcd> covariance;  ///< by the power r of ω; empty: not needed
  };
  void integrate(const InputSpectrum& input, double min_hz, double max_hz, Group& group);

  std::vector<Group> groups_;
  double error_ = 0;
};

}  // namespace bough::modal::response
