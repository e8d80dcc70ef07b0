#pragma once
/// \file From coordinates to curves at grids and elements.
#include <array>

#include "formats/records/deck_response.hpp"
#include "modal/response/coordinates.hpp"
#include "modal/response/direct_model.hpp"
#include "modal/response/frequency_tables.hpp"

namespace bough::modal::response {

/// One quantity at chosen grids or elements.
struct OutputChoice {
  std::string quantity;  ///< displacement, velocity, acceleration, spc_force, force, stress
  std::vector<int> ids;  ///< grids, or elements
  bool is_phase = false, is_punched = false, is_printed = true;
  bool is_for_listing = false;  ///< forces that no one asked for
};

/// The outputs that the subcase requests, `with_listing` also those of its listing. Reports modal.missing-set.
/// `extra_grids`: grids with displacement, velocity and acceleration in addition; without any request the displacements
/// of the loaded or moved grids (note modal.default-output).
std::vector<OutputChoice> choose_outputs(const fe::Model& model, const records::DynamicDeck& deck,
                                         const records::DynamicSubcase& subcase, const Excitation& excitation,
                                         const std::vector<int>& extra_grids, bool with_listing,
                                         Diagnostics& diagnostics);

/// An output of recover() as a linear map of the coordinates: y = Σ_o (iω)^o motion[o] [q; d; p], p the amplitudes of
/// the forces. Rows: the columns of the curves. Empty matrices are zero.
struct CoordinateMap {
  std::array<MatrixXcd, 3> motion;
};
/// Maps of the curves, then of the elements that recover() gives.
std::vector<CoordinateMap> make_coordinate_maps(const fe::Model& model, const ResponseModel& response,
                                                const Excitation& excitation, const DampingChoice& damping,
                                                const std::vector<OutputChoice>& outputs);

/// Solved by modes. \param tables  springs and dampers over frequency; nullptr: none.
void recover(const fe::Model& model, const ResponseModel& response, const Excitation& excitation,
             const DampingChoice& damping, const std::vector<OutputChoice>& outputs, const Spectrum& spectrum,
             const FrequencyTables* tables, records::ResponseSubcase& result);
void recover(const fe::Model& model, const ResponseModel& response, const Excitation& excitation,
             const DampingChoice& damping, const std::vector<OutputChoice>& outputs, const History& history,
             records::ResponseSubcase& result);
/// Solved directly: the samples of `motion` after those that `result` has.
void recover(const fe::Model& model, const Excitation& excitation, const DampingChoice& damping,
             const std::vector<OutputChoice>& outputs, const MotionBlock<MatrixXcd>& motion,
             const FrequencyTables* tables, records::ResponseSubcase& result);
void recover(const fe::Model& model, const Excitation& excitation, const DampingChoice& damping,
             const std::vector<OutputChoice>& outputs, const MotionBlock<MatrixXd>& motion,
             records::ResponseSubcase& result);

}  // namespace bough::modal::response
