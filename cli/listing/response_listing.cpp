#include "cli/listing/response_listing.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>

namespace bough::cli {
namespace {

using Eigen::Index;
using records::ListedKind;
using records::ListedStep;

ListedKind find_kind(const std::string& quantity) {
  static const std::map<std::string, ListedKind> kinds{{"displacement", ListedKind::Displacement},
                                                       {"velocity", ListedKind::Velocity},
                                                       {"acceleration", ListedKind::Acceleration},
                                                       {"spc_force", ListedKind::SpcForce}};
  return kinds.at(quantity);
}

records::ListedVector make_vector(const records::ResponseCurves& curves, Index sample) {
  std::map<int, std::vector<Index>> columns;  // of each point
  for (std::size_t i = 0; i < curves.dofs.size(); ++i) columns[curves.dofs[i].first].push_back(static_cast<Index>(i));
  const bool is_complex = curves.imag.size() > 0;
  records::ListedVector vector;
  vector.kind = find_kind(curves.quantity);
  vector.is_phase = is_complex && curves.is_phase;
  vector.real = Eigen::MatrixXd::Zero(static_cast<Index>(columns.size()), 6);
  if (is_complex) vector.imag = vector.real;
  for (const auto& [point, of_point] : columns) {
    const auto row = static_cast<Index>(vector.id.size());
    vector.id.push_back(point);
    vector.is_scalar.push_back(curves.dofs[static_cast<std::size_t>(of_point.front())].second == 0);
    for (const Index i : of_point) {
      const int c = std::max(curves.dofs[static_cast<std::size_t>(i)].second - 1, 0);
      const std::complex<double> z(curves.real(sample, i), is_complex ? curves.imag(sample, i) : 0.0);
      const double degrees = std::arg(z) * 180 / std::numbers::pi;
      vector.real(row, c) = vector.is_phase ? std::abs(z) : z.real();
      if (is_complex) vector.imag(row, c) = !vector.is_phase ? z.imag() : degrees < 0 ? degrees + 360 : degrees;
    }
  }
  return vector;
}

}  // namespace

records::Listing make_response_listing(const records::DeckResponse& response) {
  records::Listing listing;
  for (const auto& subcase : response.subcases)
    for (Index sample = 0; sample < subcase.x.size(); ++sample) {
      ListedStep step;
      step.kind = response.is_over_time ? ListedStep::Kind::Time : ListedStep::Kind::Frequency;
      step.subcase = std::max(subcase.id, 1);
      step.title = subcase.title;
      step.subtitle = subcase.subtitle;
      step.label = subcase.label;
      step.at = subcase.x(sample);
      for (const auto& curves : subcase.curves) step.vectors.push_back(make_vector(curves, sample));
      listing.steps.push_back(std::move(step));
    }
  return listing;
}

}  // namespace bough::cli
