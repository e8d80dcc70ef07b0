#pragma once
/// \file Random responses as text: names of the outputs, tables of comma-separated values.
#include <string>
#include <vector>

#include "formats/export/csv.hpp"
#include "formats/records/random_response.hpp"

namespace bough::exports {

/// One output of a random response: a dof, or a component of an element.
struct RandomOutput {
  std::string name;      ///< displacement:12:3, CBAR:7:axial, CQUAD4:stress:7:von_mises@top
  std::string quantity;  ///< displacement, ..., CBAR, CQUAD4:stress
  int id = 0;
  std::string component;
  const records::RandomCurves* curves = nullptr;
  Eigen::Index column = 0;
};
/// Lists the outputs of all curves in their order; the pointers are valid as long as `response`.
std::vector<RandomOutput> list_random_outputs(const records::RandomResponse& response);

/// Comma-separated values, a row per output: random (the set), output, rms, zero_crossings_hz, with modes modal_rms and
/// modal_zero_crossings_hz.
std::string make_rms_csv(const records::RandomResponse& response);
/// A row per frequency: random (the set), frequency_hz, psd:NAME of every output.
std::vector<CsvColumn> make_psd_columns(const records::RandomResponse& response);
/// A row per lag: random, lag, autocorrelation:NAME; empty without lags.
std::vector<CsvColumn> make_autocorrelation_columns(const records::RandomResponse& response);

/// random, frequency_hz, of each RCROSS A|B:real, :imag, :coherence.
std::vector<CsvColumn> make_cross_columns(const records::RandomResponse& response);
/// random, lag, cross_correlation:A|B.
std::vector<CsvColumn> make_correlation_columns(const records::RandomResponse& response);
/// "displacement:1:3|acceleration:5:2".
std::string name_cross(const records::RandomCross& cross);

}  // namespace bough::exports
