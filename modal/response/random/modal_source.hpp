#pragma once
/// \file A subcase solved by modes, for integrals over frequency without the finite element model.
#include <vector>

#include "modal/response/recovery.hpp"

namespace bough::modal::response {

struct ModalSource {
  ModalSource() = default;
  /// Copies the modal coordinates without their shapes, which are not needed after the output maps are made.
  ModalSource(const ResponseModel& model, const Excitation& loads, std::vector<CoordinateMap> output_maps);

  /// [q; d; p] (n + k + m) per frequency.
  MatrixXcd calc_coordinates(const VectorXd& hz) const;
  /// Number of coordinates n + k + m.
  Eigen::Index num_coordinates() const { return coordinates.lambda.size() + num_motions + num_forces; }

  ResponseModel coordinates;  ///< without shapes
  Excitation excitation;      ///< without patterns
  Eigen::Index num_motions = 0, num_forces = 0;
  std::vector<CoordinateMap> maps;
};

}  // namespace bough::modal::response
