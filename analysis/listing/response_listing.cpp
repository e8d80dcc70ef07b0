#include "analysis/listing/response_listing.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <set>

#include "analysis/listing/element_columns.hpp"
#include "analysis/listing/stress_columns.hpp"
#include "base/phase.hpp"
#include "fe/cards/element_properties.hpp"

namespace bough::analysis {
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

/// Columns of the points, ascending.
std::map<int, std::vector<Index>> list_points(const std::vector<std::pair<int, int>>& dofs) {
  std::map<int, std::vector<Index>> columns;
  for (std::size_t i = 0; i < dofs.size(); ++i) columns[dofs[i].first].push_back(static_cast<Index>(i));
  return columns;
}

records::ListedVector make_vector(const records::ResponseCurves& curves, Index sample) {
  const auto columns = list_points(curves.dofs);
  const bool is_complex = curves.imag.size() > 0;
  records::ListedVector vector;
  vector.kind = find_kind(curves.quantity);
  vector.is_phase = is_complex && curves.is_phase;
  vector.is_printed = curves.is_printed;
  vector.real = Eigen::MatrixXd::Zero(static_cast<Index>(columns.size()), 6);
  if (is_complex) vector.imag = vector.real;
  for (const auto& [point, of_point] : columns) {
    const auto row = static_cast<Index>(vector.id.size());
    vector.id.push_back(point);
    vector.is_scalar.push_back(curves.dofs[static_cast<std::size_t>(of_point.front())].second == 0);
    for (const Index i : of_point) {
      const int c = std::max(curves.dofs[static_cast<std::size_t>(i)].second - 1, 0);
      const std::complex<double> z(curves.real(sample, i), is_complex ? curves.imag(sample, i) : 0.0);
      vector.real(row, c) = vector.is_phase ? std::abs(z) : z.real();
      if (is_complex) vector.imag(row, c) = vector.is_phase ? calc_phase_degrees(z, kListedPhase) : z.imag();
    }
  }
  return vector;
}

/// Element forces of one sample, in the form of a static solution.
records::ElementForces take_forces(const records::ElementCurves& curves, const Eigen::MatrixXd& values, Index sample) {
  records::ElementForces forces;
  forces.card = curves.card;
  forces.components = curves.components;
  forces.id = curves.ids;
  const auto count = static_cast<Index>(curves.components.size());
  forces.force = Eigen::MatrixXd(values.row(sample).reshaped<Eigen::RowMajor>(values.cols() / count, count));
  return forces;
}

/// Distances, in tables of stresses of plates, are no parts of anything: the writers pass over them in `imag`, and
/// phases leave them as they are.
bool is_distance(const records::ListedElements& block, Index column) {
  return (block.type == 33 || block.type == 74) && block.real.cols() == 8 && column % 4 == 0 && block.point.size() > 0;
}

void set_complex(const records::ListedElements& imag, bool is_phase, records::ListedElements& block) {
  block.imag = imag.real;
  block.is_phase = is_phase;
  for (Index c = 0; c < block.real.cols() && is_phase; ++c)
    for (Index r = 0; r < block.real.rows() && !is_distance(block, c); ++r) {
      const std::complex<double> z(block.real(r, c), block.imag(r, c));
      block.real(r, c) = std::abs(z);
      block.imag(r, c) = calc_phase_degrees(z, kListedPhase);
    }
}

/// Forces and stresses of elements of one deck's response, sample by sample.
class ResponseElements {
 public:
  ResponseElements(const records::Deck& deck, const fe::Model& model, Diagnostics& diagnostics)
      : deck_(deck),
        model_(model),
        diagnostics_(diagnostics),
        elements_(index_elements(model)),
        properties_(fe::list_element_properties(deck)),
        limits_(list_stress_limits(deck)) {}

  void add(const records::ResponseSubcase& subcase, Index sample, ListedStep& step) {
    for (const auto& curves : subcase.elements) {
      auto block = make(subcase, curves, curves.real, sample);
      if (!block) {
        const std::string what = (curves.is_stress ? "stresses of " : "forces of ") + curves.card;
        if (left_out_.insert(what).second)
          diagnostics_.note("cli.unlisted-elements", deck_.locate({}), "the listing has no " + what,
                            "the HDF5, CSV and punch files have them");
        continue;
      }
      if (curves.imag.size() > 0) {
        auto imag = make(subcase, curves, curves.imag, sample);
        if (curves.is_stress) {
          keep_linear_columns(*block);
          keep_linear_columns(*imag);
        }
        set_complex(*imag, curves.is_phase, *block);
      }
      block->is_printed = curves.is_printed;
      (curves.is_stress ? step.stresses : step.forces).push_back(std::move(*block));
    }
  }

 private:
  std::optional<records::ListedElements> make(const records::ResponseSubcase& subcase,
                                              const records::ElementCurves& curves, const Eigen::MatrixXd& values,
                                              Index sample) const {
    const auto all = [](int) { return true; };
    const bool is_imag = &values == &curves.imag;
    auto forces = take_forces(curves, values, sample);
    if (!curves.is_stress) return make_listed_forces(model_, elements_, forces, {}, all);
    records::ElementStresses stresses;
    stresses.card = curves.card;
    stresses.components = curves.components;
    stresses.id = curves.ids;
    stresses.stress = std::move(forces.force);
    for (const int id : curves.ids) {
      const auto found = properties_.find(id);
      stresses.property.push_back(found == properties_.end() ? 0 : found->second);
    }
    std::vector<records::ElementForces> others;
    for (const auto& other : subcase.listed_forces)
      others.push_back(take_forces(other, is_imag ? other.imag : other.real, sample));
    return make_listed_stresses(model_, elements_, deck_, stresses, others, limits_, all);
  }

  const records::Deck& deck_;
  const fe::Model& model_;
  Diagnostics& diagnostics_;
  ElementIndex elements_;
  std::unordered_map<int, int> properties_;
  std::map<int, StressLimits> limits_;
  std::set<std::string> left_out_;
};

records::ListedRandom make_random(const records::RandomResponse& random, const records::RandomCurves& curves) {
  const auto points = list_points(curves.dofs);
  records::ListedRandom listed;
  listed.kind = find_kind(curves.quantity);
  listed.hz = random.hz;
  listed.lags = random.lags;
  listed.rms = listed.crossing_hz = Eigen::MatrixXd::Zero(static_cast<Index>(points.size()), 6);
  const Eigen::MatrixXd cumulative = records::calc_cumulative_rms(random, curves);
  for (const auto& [point, columns] : points) {
    const auto row = static_cast<Index>(listed.id.size());
    const auto get_component = [&](Index i) {
      return std::max(curves.dofs[static_cast<std::size_t>(i)].second - 1, 0);
    };
    listed.id.push_back(point);
    listed.is_scalar.push_back(curves.dofs[static_cast<std::size_t>(columns.front())].second == 0);
    const auto take = [&columns = columns, &get_component](const Eigen::MatrixXd& values) {
      Eigen::MatrixXd six = Eigen::MatrixXd::Zero(values.rows(), 6);
      for (const Index i : columns) six.col(get_component(i)) = values.col(i);
      return six;
    };
    for (const Index i : columns) {
      listed.rms(row, get_component(i)) = curves.rms(i);
      listed.crossing_hz(row, get_component(i)) = curves.crossing_hz(i);
    }
    listed.psd.push_back(take(curves.psd));
    listed.cumulative_rms.push_back(take(cumulative));
    if (curves.autocorrelation.size() > 0) listed.autocorrelation.push_back(take(curves.autocorrelation));
  }
  return listed;
}

void add_random(const records::DeckResponse& response, records::Listing& listing) {
  for (const auto& random : response.random) {
    const int first = random.subcases.empty() ? 1 : random.subcases.front();
    const auto subcase = std::find_if(response.subcases.begin(), response.subcases.end(),
                                      [first](const auto& s) { return std::max(s.id, 1) == first; });
    for (const auto& curves : random.curves) {
      if (!curves.card.empty()) continue;
      auto listed = make_random(random, curves);
      listed.subcase = first;
      if (subcase != response.subcases.end()) {
        listed.title = subcase->title;
        listed.subtitle = subcase->subtitle;
        listed.label = subcase->label;
      }
      listing.random.push_back(std::move(listed));
    }
  }
}

}  // namespace

records::Listing make_response_listing(const records::DeckResponse& response, const records::Deck& deck,
                                       const fe::Model& model, Diagnostics& diagnostics) {
  records::Listing listing;
  ResponseElements elements(deck, model, diagnostics);
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
      elements.add(subcase, sample, step);
      listing.steps.push_back(std::move(step));
    }
  add_random(response, listing);
  return listing;
}

}  // namespace bough::analysis
