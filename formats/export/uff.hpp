#pragma once
/// \file Universal files in text (docs/formats/uff.md): nodes, trace lines, modes at nodes, functions.
#include <functional>
#include <string>
#include <vector>

#include "formats/export/csv.hpp"
#include "formats/records/deck_response.hpp"
#include "formats/records/flex_body.hpp"
#include "formats/records/frequency_response.hpp"
#include "formats/records/modes.hpp"

namespace bough::exports {

/// Datasets 15 (grids, basic system), 82 (edges of the elements) and 55: a normal mode each, or a buckling mode each.
std::string make_uff(const records::ModesResult& modes);
/// Shapes of a body's output nodes in its frame B, with modal mass and damping ratio.
std::string make_uff(const records::FlexBody& body);
/// Dataset 58 for every column after the first, which is the time.
std::string make_uff(const std::vector<CsvColumn>& columns);

/// Curves of a deck's response as functions (58): over frequency complex spectra, over time real.
std::string make_uff(const records::DeckResponse& response);

/// Frequency response functions (58, type 4) of a linear model: output by output, the function of each input.
std::string make_uff(const records::FrequencyResponse& response);

/// A mesh that moves: 15 and 82 of where it is at first, then 55 for each time, transient, of three translations of
/// each grid from there (grids x 3 for an index into `time`).
std::string make_uff(const records::BodyMesh& mesh, const Eigen::VectorXd& time,
                     const std::function<Eigen::MatrixXd(Eigen::Index)>& calc_displacement, const std::string& model);

}  // namespace bough::exports
