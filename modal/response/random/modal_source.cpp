#include "modal/response/random/modal_source.hpp"

namespace bough::modal::response {

ModalSource::ModalSource(const ResponseModel& model, const Excitation& loads, std::vector<CoordinateMap> output_maps)
    : coordinates(model),
      excitation(loads),
      num_motions(loads.D.cols()),
      num_forces(loads.F.cols()),
      maps(std::move(output_maps)) {
  coordinates.Phi.resize(0, 0);
  coordinates.Psi.resize(0, 0);
  excitation.F.resize(0, num_forces);
  excitation.D.resize(0, num_motions);
  excitation.residual.resize(0, 0);
}

MatrixXcd ModalSource::calc_coordinates(const VectorXd& hz) const {
  Diagnostics unreported;
  const auto spectrum = calc_spectrum(coordinates, excitation, hz, unreported);
  if (spectrum.hz.size() != hz.size())
    throw ComputationError("modal.unbounded-response", {}, "the response has no bound within the band", "give damping");
  MatrixXcd z(num_coordinates(), hz.size());
  z << spectrum.q, spectrum.d, spectrum.a.topRows(num_forces);
  return z;
}

}  // namespace bough::modal::response
