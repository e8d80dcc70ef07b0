#include "analysis/compare/frf_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <set>

#include "analysis/common/inputs.hpp"
#include "formats/export/response_text.hpp"
#include "formats/hdf5/response_file.hpp"
#include "formats/matrices/test_functions.hpp"

namespace bough::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using matrices::TestFunction;

/// Quantity of the computed curves; empty: one that they do not have.
std::string name_quantity(int type) {
  constexpr int kDisplacement = 8, kForce = 9, kVelocity = 11, kAcceleration = 12;
  if (type == kDisplacement) return "displacement";
  if (type == kForce) return "spc_force";
  if (type == kVelocity) return "velocity";
  return type == kAcceleration ? "acceleration" : std::string();
}

/// The curve at a frequency between its first and last.
std::complex<double> interpolate(const VectorXd& hz, const exports::NamedCurve& curve, double f) {
  const auto* end = std::upper_bound(hz.data(), hz.data() + hz.size(), f);
  const Index i = std::clamp<Index>(end - hz.data(), 1, std::max<Index>(hz.size() - 1, 1));
  if (hz.size() == 1) return {curve.real[0], curve.imag[0]};
  const double s = (f - hz[i - 1]) / (hz[i] - hz[i - 1]);
  return {(1 - s) * curve.real[i - 1] + s * curve.real[i], (1 - s) * curve.imag[i - 1] + s * curve.imag[i]};
}

double calc_frac(std::complex<double> product, double a, double b) {
  return a > 0 && b > 0 ? std::norm(product) / (a * b) : 0;
}

}  // namespace

FrfReport compare_responses(const std::string& response, const std::string& functions, Events& events) {
  const auto computed = hdf5::read_response(response);
  demand_file(functions);
  const auto measured = matrices::read_test_functions(functions);
  Diagnostics diagnostics;
  if (computed.is_over_time)
    throw InputError("cli.not-comparable", {response}, "the file has curves over time",
                     "give a file that bough frequency wrote");
  if (measured.empty())
    throw InputError("cli.no-test-functions", {functions},
                     "the file has no complex function over frequency (dataset 58 of type 4 or 12)",
                     "export the frequency response functions of the test as dataset 58");
  std::set<std::pair<int, int>> references;
  for (const auto& f : measured) references.emplace(f.reference, std::abs(f.reference_direction));
  if (references.size() > 1 || computed.subcases.size() > 1)
    throw InputError("cli.test-reference", {functions},
                     fmt::format("{} reference points and {} subcases, expected one of each", references.size(),
                                 computed.subcases.size()),
                     "compute one subcase with a unit load at the reference, and give the functions of this reference");
  const auto& subcase = computed.subcases.front();
  const auto curves = exports::list_curves(subcase);
  FrfReport report;
  report.file_a = response;
  report.file_b = functions;
  report.subcase = subcase.id;
  std::complex<double> product = 0;
  double square_a = 0, square_b = 0;
  std::string first;
  for (const auto& f : measured) {
    const auto quantity = name_quantity(f.quantity);
    const auto component = std::to_string(std::abs(f.direction));
    const auto curve = std::find_if(curves.begin(), curves.end(), [&](const auto& one) {
      return one.quantity == quantity && one.id == f.node &&
             (one.component == component || (one.component == "0" && f.direction == 0));
    });
    FrfPair pair;
    std::complex<double> own_product = 0;
    double own_a = 0, own_b = 0, peak = -1, test_peak = -1;
    const double sign = (f.direction < 0 ? -1.0 : 1.0) * (f.reference_direction < 0 ? -1.0 : 1.0);
    for (Index i = 0; curve != curves.end() && i < f.hz.size(); ++i) {
      if (f.hz[i] < subcase.x[0] || f.hz[i] > subcase.x[subcase.x.size() - 1]) continue;
      const auto a = sign * interpolate(subcase.x, *curve, f.hz[i]);
      own_product += std::conj(a) * f.value[i];
      own_a += std::norm(a);
      own_b += std::norm(f.value[i]);
      if (std::abs(a) > peak) peak = std::abs(a), pair.peak_hz = f.hz[i];
      if (std::abs(f.value[i]) > test_peak) test_peak = std::abs(f.value[i]), pair.test_peak_hz = f.hz[i];
      ++pair.num_points;
    }
    if (pair.num_points == 0) {
      ++report.num_unmatched;
      if (first.empty())
        first = fmt::format("{} of node {}, direction {}",
                            quantity.empty() ? "a quantity that is not computed" : quantity, f.node, f.direction);
      continue;
    }
    pair.name = curve->name;
    pair.test = f.name;
    pair.reference = f.reference;
    pair.reference_direction = f.reference_direction;
    pair.frac = calc_frac(own_product, own_a, own_b);
    pair.level_db = own_a > 0 && own_b > 0 ? 10 * std::log10(own_a / own_b) : 0;
    product += own_product;
    square_a += own_a;
    square_b += own_b;
    report.pairs.push_back(std::move(pair));
  }
  if (report.pairs.empty())
    throw InputError("cli.no-test-functions", {functions},
                     fmt::format("no function has a curve in {}: {} first", response, first),
                     "request the measured quantities and grids in the deck, in the same range of frequency");
  if (report.num_unmatched > 0)
    diagnostics.warning("cli.test-functions", {functions},
                        fmt::format("{} of {} functions have no curve in the response: {} first", report.num_unmatched,
                                    measured.size(), first),
                        "request these quantities and grids in the deck");
  report.frac = calc_frac(product, square_a, square_b);
  add_messages(diagnostics, events);
  return report;
}

}  // namespace bough::analysis
