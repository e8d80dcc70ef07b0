#include "modal/response/random/modal_integral.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace bough::modal::response {
namespace {

using namespace std::complex_literals;
using Eigen::Index;

constexpr double kIntegralTolerance = 1e-7;
/// Halvings of an interval.
constexpr int kMaxHalvings = 12;
/// Distances from a natural frequency, in half bandwidths, grow by this factor.
constexpr double kGrading = 4;
/// Below this damping ratio a mode has none.
constexpr double kUndamped = 1e-9;
/// Points that are held at a time.
constexpr std::size_t kHeldIntervals = 128;

/// Gauss-Kronrod, 7 and 15 points on [-1, 1] (Piessens et al., QUADPACK, Springer 1983), x >= 0.
constexpr std::array kNodes{0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                            0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                            0.586087235467691130294144691838259, 0.405845151377397166906606412076961,
                            0.207784955007898467600689403773245, 0.0};
constexpr std::array kWeights{0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                              0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                              0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                              0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
constexpr std::array kGaussWeights{0.0, 0.129484966168869693270611432679082, 0.0, 0.279705391489276667901467771423780,
                                   0.0, 0.381830050505118944950369775488975, 0.0, 0.417959183673469387755102040816327};
constexpr Index kNumNodes = 15;

struct Interval {
  double a = 0, b = 0;
  int depth = 0;
};

struct Rule {
  VectorXd x, weight, gauss;
};
const Rule& get_rule() {
  static const Rule rule = [] {
    Rule r{VectorXd(kNumNodes), VectorXd(kNumNodes), VectorXd(kNumNodes)};
    for (Index i = 0; i < kNumNodes; ++i) {
      const auto at = static_cast<std::size_t>(i < 8 ? i : kNumNodes - 1 - i);
      r.x(i) = i < 8 ? -kNodes[at] : kNodes[at];
      r.weight(i) = kWeights[at];
      r.gauss(i) = kGaussWeights[at];
    }
    return r;
  }();
  return rule;
}

VectorXd place_nodes(const Interval* intervals, std::size_t num) {
  VectorXd hz(kNumNodes * static_cast<Index>(num));
  for (std::size_t i = 0; i < num; ++i) {
    const double half = (intervals[i].b - intervals[i].a) / 2, centre = (intervals[i].b + intervals[i].a) / 2;
    hz.segment(kNumNodes * static_cast<Index>(i), kNumNodes) = (centre + half * get_rule().x.array()).matrix();
  }
  return hz;
}

/// Natural frequencies with the distances around them, corners of the loads, ends of the band.
std::vector<Interval> make_intervals(const std::vector<const ModalSource*>& sources, std::vector<double> corners,
                                     double min_hz, double max_hz) {
  for (const auto* source : sources) {
    const auto& model = source->coordinates;
    for (Index j = 0; j < model.num_dynamic(); ++j) {
      if (!(model.lambda(j) > 0)) continue;
      const double hz = std::sqrt(model.lambda(j)) / (2 * std::numbers::pi), ratio = model.damping_ratio(j);
      const bool is_driven = model.P.row(j).norm() > 1e-9 * model.P.norm();
      if (ratio < kUndamped && hz > min_hz && hz < max_hz && is_driven)
        throw ComputationError("modal.unbounded-response", {}, "a mode within the band is not damped", "give damping");
      corners.push_back(hz);
      for (double step = std::max(ratio, 1e-6) * hz; step < hz; step *= kGrading)
        for (const double f : {hz - step, hz + step}) corners.push_back(f);
    }
    for (const auto* terms : {&source->excitation.forces, &source->excitation.motions})
      for (const auto& term : *terms)
        for (const auto* table : {term.table_a, term.table_b})
          if (table) add_corners(*table, corners);
  }
  std::erase_if(corners, [&](double f) { return !(f > min_hz && f < max_hz); });
  corners.push_back(min_hz);
  corners.push_back(max_hz);
  std::sort(corners.begin(), corners.end());
  std::vector<Interval> intervals;
  double last = min_hz;
  for (const double f : corners) {
    if (f - last <= 1e-12 * max_hz) continue;
    intervals.push_back({last, f, 0});
    last = f;
  }
  return intervals;
}

}  // namespace

ModalIntegral::ModalIntegral(const InputSpectrum& input, const std::vector<const ModalSource*>& sources, double min_hz,
                             double max_hz) {
  for (const auto& members : input.list_groups()) {
    Group group;
    group.members = members;
    for (const int row : members) group.sources.push_back(sources[static_cast<std::size_t>(row)]);
    integrate(input, min_hz, max_hz, group);
    groups_.push_back(std::move(group));
  }
}

void ModalIntegral::integrate(const InputSpectrum& input, double min_hz, double max_hz, Group& group) {
  const auto& members = group.members;
  Index n = 0;
  std::array<bool, 9> is_needed{};
  for (const auto* source : group.sources) {
    n += source->num_coordinates();
    for (const auto& map : source->maps)
      for (std::size_t o = 0; o < 3; ++o)
        for (std::size_t k = 0; k < 3; ++k)
          if (map.motion[o].size() > 0 && map.motion[k].size() > 0) is_needed[o + k] = is_needed[o + k + 2] = true;
  }
  // A column per frequency and factor of S, blocks of rows by subcase.
  const auto rank = static_cast<Index>(members.size());
  const auto calc_columns = [&](const VectorXd& hz) {
    MatrixXcd columns(n, rank * hz.size());
    std::vector<MatrixXcd> factors;
    for (const double f : hz) factors.push_back(input.factor(f, members));
    Index first = 0;
    for (Index j = 0; j < rank; ++j) {
      const auto z = group.sources[static_cast<std::size_t>(j)]->calc_coordinates(hz);
      for (Index i = 0; i < hz.size(); ++i)
        columns.block(first, rank * i, z.rows(), rank) = z.col(i) * factors[static_cast<std::size_t>(i)].row(j);
      first += z.rows();
    }
    return columns;
  };

  auto pending = make_intervals(group.sources, input.list_corners(), min_hz, max_hz);
  std::vector<Interval> accepted;
  // Mean squares of each coordinate, and those of its second derivative.
  VectorXd totals = VectorXd::Zero(2 * n), errors = VectorXd::Zero(2 * n);
  while (!pending.empty()) {
    MatrixXd fine(2 * n, static_cast<Index>(pending.size())), coarse = fine;
    for (std::size_t first = 0; first < pending.size(); first += kHeldIntervals) {
      const auto num = std::min(kHeldIntervals, pending.size() - first);
      const VectorXd hz = place_nodes(&pending[first], num);
      const MatrixXd power = calc_columns(hz).cwiseAbs2();
      for (std::size_t i = 0; i < num; ++i) {
        const double half = (pending[first + i].b - pending[first + i].a) / 2;
        const auto column = static_cast<Index>(first + i);
        VectorXd sums = VectorXd::Zero(2 * n), gauss = sums;
        for (Index k = 0; k < kNumNodes; ++k) {
          const auto node = kNumNodes * static_cast<Index>(i) + k;
          const VectorXd at = power.middleCols(rank * node, rank).rowwise().sum();
          VectorXd both(2 * n);
          both << at, at * std::pow(hz(node) / max_hz, 4);
          sums += half * get_rule().weight(k) * both;
          gauss += half * get_rule().gauss(k) * both;
        }
        fine.col(column) = sums;
        coarse.col(column) = gauss;
      }
    }
    const VectorXd scale = totals + fine.rowwise().sum();
    std::vector<Interval> next;
    for (std::size_t i = 0; i < pending.size(); ++i) {
      const auto& interval = pending[i];
      const VectorXd error = (fine - coarse).col(static_cast<Index>(i)).cwiseAbs();
      const bool has_converged = (error.array() <= kIntegralTolerance * scale.array()).all();
      if (has_converged || interval.depth >= kMaxHalvings) {
        accepted.push_back(interval);
        totals += fine.col(static_cast<Index>(i));
        errors += error;
        continue;
      }
      const double middle = (interval.a + interval.b) / 2;
      next.push_back({interval.a, middle, interval.depth + 1});
      next.push_back({middle, interval.b, interval.depth + 1});
    }
    pending = std::move(next);
  }
  for (Index i = 0; i < 2 * n; ++i)
    if (totals(i) > 0) error_ = std::max(error_, errors(i) / totals(i));

  group.covariance.resize(is_needed.size());
  for (std::size_t r = 0; r < is_needed.size(); ++r)
    if (is_needed[r]) group.covariance[r].setZero(n, n);
  for (std::size_t first = 0; first < accepted.size(); first += kHeldIntervals) {
    const auto num = std::min(kHeldIntervals, accepted.size() - first);
    const VectorXd hz = place_nodes(&accepted[first], num);
    const MatrixXcd columns = calc_columns(hz);
    for (std::size_t r = 0; r < is_needed.size(); ++r) {
      if (!is_needed[r]) continue;
      VectorXd weights(columns.cols());
      for (Index node = 0; node < hz.size(); ++node) {
        const auto& interval = accepted[first + static_cast<std::size_t>(node / kNumNodes)];
        const double weight = (interval.b - interval.a) / 2 * get_rule().weight(node % kNumNodes) *
                              std::pow(2 * std::numbers::pi * hz(node), static_cast<double>(r));
        weights.segment(rank * node, rank).setConstant(std::sqrt(weight));
      }
      group.covariance[r].selfadjointView<Eigen::Lower>().rankUpdate(MatrixXcd(columns * weights.asDiagonal()));
    }
  }
  for (auto& covariance : group.covariance)
    if (covariance.size() > 0) covariance = MatrixXcd(covariance.selfadjointView<Eigen::Lower>());
}

SpectralMoments ModalIntegral::calc_moments(const std::vector<std::size_t>& indices,
                                            const std::vector<OutputForm>& forms, Index num_components) const {
  SpectralMoments moments;
  const double per_hz2 = 1 / (4 * std::numbers::pi * std::numbers::pi);
  for (const auto& group : groups_) {
    // Side by side, the coordinates of the subcases.
    std::array<MatrixXcd, 3> G;
    Index n = 0, rows = 0;
    const auto get_motion = [&](std::size_t j) -> const auto& {
      return group.sources[j]->maps[indices[static_cast<std::size_t>(group.members[j])]].motion;
    };
    for (std::size_t j = 0; j < group.sources.size(); ++j) {
      n += group.sources[j]->num_coordinates();
      for (const auto& block : get_motion(j)) rows = std::max(rows, block.rows());
    }
    for (std::size_t o = 0; o < 3; ++o) {
      Index first = 0;
      for (std::size_t j = 0; j < group.sources.size(); ++j) {
        const auto& block = get_motion(j)[o];
        if (block.size() > 0 && G[o].size() == 0) G[o].setZero(rows, n);
        if (block.size() > 0) G[o].middleCols(first, block.cols()) = block;
        first += group.sources[j]->num_coordinates();
      }
    }
    const Index num_entities = rows / num_components, num_forms = static_cast<Index>(forms.size());
    if (moments.m0.size() == 0) moments.m0 = moments.m2 = VectorXd::Zero(num_entities * num_forms);
    for (Index entity = 0; entity < num_entities; ++entity)
      for (std::size_t o = 0; o < 3; ++o)
        for (std::size_t k = 0; k < 3; ++k) {
          if (G[o].size() == 0 || G[k].size() == 0) continue;
          // y_o = (iω)^o G_o z: i^(o - k) of the product of y_o and the conjugate of y_k.
          static constexpr std::array<std::complex<double>, 5> kTurns{-1.0, -1i, 1.0, 1i, -1.0};
          const auto turn = kTurns[o + 2 - k];
          const auto left = G[o].middleRows(entity * num_components, num_components);
          const auto right = G[k].middleRows(entity * num_components, num_components);
          for (const std::size_t more : {std::size_t{0}, std::size_t{2}}) {
            const MatrixXd products = (turn * (left * group.covariance[o + k + more] * right.adjoint())).real();
            for (Index f = 0; f < num_forms; ++f) {
              const auto& F = forms[static_cast<std::size_t>(f)].F;
              const double value = (F * products).cwiseProduct(F).sum();
              (more == 0 ? moments.m0 : moments.m2)(entity * num_forms + f) += more == 0 ? value : value * per_hz2;
            }
          }
        }
  }
  return moments;
}

}  // namespace bough::modal::response
