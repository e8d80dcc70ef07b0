#pragma once
/// \file Print file of complex modes, as Nastran prints them (docs/formats/f06.md).
#include <string>
#include <vector>

#include "formats/records/listing.hpp"

namespace bough::listing {

/// Complex modes of a subcase; shapes at points in displacement (CD) axes, mode after mode, none if not requested.
struct ListedComplexModes {
  int subcase = 0;
  std::string title, subtitle, label;
  Eigen::VectorXcd eigenvalue;
  Eigen::VectorXd damping;  ///< g = -2 Re λ / Im λ
  std::vector<records::ListedVector> shapes;
};

/// Summary of the eigenvalues of each subcase, then its shapes.
std::string make_complex_f06(const std::vector<ListedComplexModes>& subcases);

}  // namespace bough::listing
