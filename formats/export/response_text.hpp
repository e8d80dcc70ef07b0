#pragma once
/// \file Curves of a deck's response as text: columns of CSV, and Nastran's punch file.
#include <string>
#include <vector>

#include "formats/export/csv.hpp"
#include "formats/records/deck_response.hpp"

namespace bough::exports {

/// One curve of a subcase: a dof, or a component of an element.
struct NamedCurve {
  std::string name;      ///< displacement:12:3, CBAR:7:axial
  std::string quantity;  ///< displacement, ..., or the card of the element
  int id = 0;
  std::string component;
  bool is_phase = false;
  Eigen::VectorXd real, imag;  ///< imag: empty over time
};
/// Lists the curves of displacements, velocities, accelerations, forces and elements of a subcase, each with its values
/// at all frequencies or times.
std::vector<NamedCurve> list_curves(const records::ResponseSubcase& subcase);

/// The columns below of every subcase as text, then those of the random responses.
std::string make_response_csv(const records::DeckResponse& response);

/// frequency_hz or time, then a column per curve and part: real and imag, or magnitude and phase (degrees, -180 to 180)
/// as the deck requests; over time one. Of several subcases the curves of each stand below each other, with the column
/// `subcase` first; all have the columns of the first.
std::vector<CsvColumn> make_response_columns(const records::ResponseSubcase& subcase);

/// Magnitude and phase in degrees.
std::pair<double, double> to_polar(double real, double imag);

/// Largest magnitude of a curve, which must outlive it, its frequency or time, and its phase in degrees.
struct CurvePeak {
  const NamedCurve* curve = nullptr;
  double size = 0, at = 0, phase_deg = 0;
};
/// \param x  frequencies or times, one per value; empty: size is -1
CurvePeak find_peak(const NamedCurve& curve, const Eigen::VectorXd& x);

/// Nastran's punch file, by point and by element (SORT2), 80 columns: the results with PUNCH in the deck, or all
/// results if there are none.
std::string make_punch_text(const records::DeckResponse& response);

}  // namespace bough::exports
