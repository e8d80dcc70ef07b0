#include "solver/statespace/mode_ranking.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>

#include "base/diagnostic.hpp"
#include "solver/statespace/cost.hpp"

namespace bough::statespace {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A row per direction: the shapes there.
MatrixXd make_rows(const records::FlexBody& body, const std::vector<NodeDirection>& places) {
  MatrixXd rows(static_cast<Index>(places.size()), body.num_modes());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const int node = body.find_node(places[i].node);
    BOUGH_DEMAND(node >= 0 && places[i].direction >= 1 && places[i].direction <= 6);
    rows.row(static_cast<Index>(i)) =
        places[i].weight * body.phi[static_cast<std::size_t>(node)].row(places[i].direction - 1);
  }
  return rows;
}

MatrixXd make_damping(const records::FlexBody& body, double otherwise) {
  MatrixXd D = body.modal_damping;
  if (D.size() == 0) D = MatrixXd::Zero(body.num_modes(), body.num_modes());
  for (Index i = 0; i < D.rows(); ++i) {
    const double product = body.modal_stiffness(i, i) * body.modal_mass(i, i);
    if (D(i, i) == 0) D(i, i) = 2 * otherwise * std::sqrt(std::max(0.0, product));
  }
  return D;
}

std::string percent(double part) {
  std::ostringstream text;
  text.precision(3);
  text << 100 * part << " %";
  return text.str();
}

}  // namespace

StateSpace make_state_space(const records::FlexBody& body, const std::vector<NodeDirection>& inputs,
                            const std::vector<NodeDirection>& outputs, double otherwise_damping) {
  const Index n = body.num_modes();
  const MatrixXd b = make_rows(body, inputs).transpose(), c = make_rows(body, outputs);
  const MatrixXd D = make_damping(body, otherwise_damping), &M = body.modal_mass, &K = body.modal_stiffness;
  const Eigen::LDLT<MatrixXd> factor(M);
  MatrixXd A = MatrixXd::Zero(2 * n, 2 * n), B = MatrixXd::Zero(2 * n, b.cols()), C = MatrixXd::Zero(c.rows(), 2 * n);
  A.topRightCorner(n, n).setIdentity();
  A.bottomLeftCorner(n, n) = -factor.solve(K);
  A.bottomRightCorner(n, n) = -factor.solve(D);
  B.bottomRows(n) = factor.solve(b);
  for (Index i = 0; i < c.rows(); ++i)
    C.row(i).segment(outputs[static_cast<std::size_t>(i)].is_rate ? n : 0, n) = c.row(i);
  return {std::move(A), std::move(B), std::move(C)};
}

namespace {

/// A mode by itself.
struct Alone {
  double omega = 0, zeta = 0, b_squared = 0, c_d_squared = 0, c_r_squared = 0;
};

std::vector<Alone> list_alone(const records::FlexBody& body, const std::vector<NodeDirection>& inputs,
                              const std::vector<NodeDirection>& outputs, double otherwise_damping) {
  const MatrixXd b = make_rows(body, inputs).transpose(), c = make_rows(body, outputs);
  const MatrixXd D = make_damping(body, otherwise_damping), &M = body.modal_mass, &K = body.modal_stiffness;
  std::vector<Alone> all;
  for (Index i = 0; i < body.num_modes(); ++i) {
    Alone alone;
    const double m = M(i, i);
    alone.omega = std::sqrt(std::max(0.0, K(i, i) / m));
    if (alone.omega > 0) alone.zeta = D(i, i) / (2 * m * alone.omega);
    alone.b_squared = b.row(i).squaredNorm() / (m * m);
    for (Index o = 0; o < c.rows(); ++o)
      (outputs[static_cast<std::size_t>(o)].is_rate ? alone.c_r_squared : alone.c_d_squared) += c(o, i) * c(o, i);
    all.push_back(alone);
  }
  return all;
}

}  // namespace

ModeRanking rank_modes(const records::FlexBody& body, const std::vector<NodeDirection>& inputs,
                       const std::vector<NodeDirection>& outputs, double otherwise_damping, const Spectrum* spectrum) {
  const Index n = body.num_modes();
  const StateSpace s = make_state_space(body, inputs, outputs, otherwise_damping);
  const ComponentCost cost = spectrum ? calc_component_cost(s, *spectrum) : calc_component_cost(s.A, s.B, s.C);
  ModeRanking ranking;
  ranking.total = cost.total;
  for (const Alone& alone : list_alone(body, inputs, outputs, otherwise_damping)) {
    const Index i = static_cast<Index>(ranking.modes.size());
    ModeCost mode{cost.state[i] + cost.state[n + i], 0};
    if (alone.zeta > 0 && !spectrum)
      mode.closed_form =
          calc_modal_cost(alone.omega, alone.zeta, alone.b_squared, alone.c_d_squared, alone.c_r_squared);
    ranking.modes.push_back(mode);
  }
  ranking.other = 0;
  return ranking;
}

Eigen::VectorXd calc_modal_hankel(const records::FlexBody& body, const std::vector<NodeDirection>& inputs,
                                  const std::vector<NodeDirection>& outputs, double otherwise_damping) {
  VectorXd values = VectorXd::Zero(body.num_modes());
  Index i = 0;
  for (const Alone& a : list_alone(body, inputs, outputs, otherwise_damping)) {
    const double squared = a.b_squared * (a.c_d_squared + a.omega * a.omega * a.c_r_squared);
    if (a.zeta > 0) values[i] = std::sqrt(squared) / (4 * a.zeta * a.omega * a.omega);
    ++i;
  }
  return values;
}

void add_traits(const records::FlexBody& body, int number, std::vector<ModeTraits>& traits) {
  const double min_eigenvalue = 1e-12 * (body.num_modes() > 0 ? body.eigenvalue.cwiseAbs().maxCoeff() : 0);
  for (int i = 0; i < body.num_modes(); ++i)
    traits.push_back(
        {body.kind[static_cast<std::size_t>(i)], body.eigenvalue[i] <= min_eigenvalue, body.frequency_hz[i], number});
}

std::vector<int> group_modes(const std::vector<ModeTraits>& traits, const ModeRanking& ranking, double closeness) {
  const int n = static_cast<int>(traits.size());
  std::vector<int> groups(static_cast<std::size_t>(n));
  const auto at = [&](int i) -> const ModeTraits& { return traits[static_cast<std::size_t>(i)]; };
  const auto is_normal = [&](int i) { return at(i).kind == records::ModeKind::Normal; };
  const auto cost = [&](int i) { return std::abs(ranking.modes[static_cast<std::size_t>(i)].cost); };
  for (int first = 0, last = 0; first < n; first = last) {
    double largest = cost(first);
    for (last = first + 1;
         last < n && is_normal(last) && is_normal(last - 1) && at(last).body == at(last - 1).body &&
         std::abs(at(last).frequency_hz - at(last - 1).frequency_hz) <= closeness * at(last).frequency_hz;
         ++last)
      largest = std::max(largest, cost(last));
    int group = -1;
    for (int i = first; i < last; ++i) {
      const bool is_coupled = cost(i) > 1e-3 * largest;
      if (is_coupled && group < 0) group = i;
      groups[static_cast<std::size_t>(i)] = is_coupled ? group : i;
    }
  }
  return groups;
}

std::vector<double> calc_modified_costs(const ModeRanking& ranking, const std::vector<int>& groups) {
  std::vector<double> sum(groups.size(), 0), costs;
  std::vector<int> count(groups.size(), 0);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    sum[static_cast<std::size_t>(groups[i])] += ranking.modes[i].cost;
    ++count[static_cast<std::size_t>(groups[i])];
  }
  for (const int group : groups)
    costs.push_back(sum[static_cast<std::size_t>(group)] / count[static_cast<std::size_t>(group)]);
  return costs;
}

ModeRanking combine_worst(const std::vector<ModeRanking>& rankings) {
  BOUGH_DEMAND(!rankings.empty());
  if (rankings.size() == 1) return rankings.front();
  ModeRanking worst;
  worst.total = 1;
  worst.modes.resize(rankings.front().modes.size());
  for (const auto& ranking : rankings) {
    if (!(std::abs(ranking.total) > 0)) continue;
    for (std::size_t i = 0; i < worst.modes.size(); ++i) {
      const double share = ranking.modes[i].cost / ranking.total;
      if (std::abs(share) > std::abs(worst.modes[i].cost)) worst.modes[i].cost = share;
    }
  }
  return worst;
}

namespace {

/// Makes costs equal that differ by rounding, as those of equal bodies do: their order is then that of the modes.
std::vector<double> equalize(std::vector<double> costs) {
  constexpr double kCloseness = 1e-7;
  std::vector<std::size_t> order(costs.size());
  std::iota(order.begin(), order.end(), 0U);
  for (double& cost : costs) cost = std::abs(cost);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
  double before = 0, first = 0;
  for (const std::size_t i : order) {
    const double cost = costs[i];
    if (cost - before > kCloseness * cost) first = cost;
    costs[i] = first;
    before = cost;
  }
  return costs;
}

/// The cheapest first; of equal ones (of one frequency) by their own.
void sort_by_cost(const ModeRanking& ranking, const std::vector<double>& modified, std::vector<int>& modes) {
  std::vector<double> single;
  for (const auto& mode : ranking.modes) single.push_back(mode.cost);
  const auto costs = equalize(modified);
  single = equalize(std::move(single));
  const auto key = [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    return std::pair(costs[k], single[k]);
  };
  std::stable_sort(modes.begin(), modes.end(), [&](int a, int b) { return key(a) < key(b); });
}

}  // namespace

std::vector<Choice> choose_modes(const std::vector<ModeTraits>& traits, const ModeRanking& ranking,
                                 const SelectionRules& rules) {
  const int n = static_cast<int>(traits.size());
  BOUGH_DEMAND(static_cast<int>(ranking.modes.size()) == n);
  std::vector<Choice> choices(static_cast<std::size_t>(n));
  const auto at = [&](int i) -> Choice& { return choices[static_cast<std::size_t>(i)]; };
  const auto groups = group_modes(traits, ranking);
  const auto costs = calc_modified_costs(ranking, groups);
  const auto size = [&](int i) { return std::abs(costs[static_cast<std::size_t>(i)]); };
  const auto is_pinned = [&](int i) {
    return std::find(rules.pinned.begin(), rules.pinned.end(), i) != rules.pinned.end();
  };
  std::vector<int> open;  // to be decided by cost
  int num_kept = 0;
  for (int i = 0; i < n; ++i) {
    const auto& [kind, is_rigid, frequency_hz, body] = traits[static_cast<std::size_t>(i)];
    if (kind != records::ModeKind::Normal) {
      at(i).reason = kind == records::ModeKind::Constraint   ? "constraint shape"
                     : kind == records::ModeKind::Attachment ? "attachment shape"
                                                             : "residual shape";
      ++num_kept;
    } else if (is_rigid) {
      at(i).reason = "rigid";
      ++num_kept;
    } else if (is_pinned(i)) {
      at(i).reason = "pinned";
      ++num_kept;
    } else if (rules.below_hz > 0 && frequency_hz > rules.below_hz) {
      at(i) = {false, "above the frequency"};
    } else if (!rules.by_cost) {
      at(i).reason = "below the frequency";
      ++num_kept;
    } else {
      open.push_back(i);
    }
  }
  sort_by_cost(ranking, costs, open);
  const double sum = std::abs(ranking.total);
  double dropped = 0;
  int left = static_cast<int>(open.size());
  int last_kept = -1;  // its group
  for (std::size_t k = 0; k < open.size(); ++k) {
    const int i = open[k], group = groups[static_cast<std::size_t>(i)];
    double together = size(i);  // with those of one frequency that come next
    for (std::size_t next = k + 1; next < open.size() && groups[static_cast<std::size_t>(open[next])] == group; ++next)
      together += size(open[next]);
    const bool too_many = rules.number > 0 && num_kept + left > rules.number;
    const bool is_small =
        rules.number == 0 && group != last_kept && dropped + together <= rules.tolerance * sum * (1 + 1e-12);
    if (!too_many && !is_small) last_kept = group;
    if (too_many || is_small) {
      dropped += size(i);
      at(i) = {false, too_many ? "beyond the number" : "within the tolerance: " + percent(dropped / sum) + " gone",
               !too_many, true};
      --left;
    } else {
      at(i) = {true, "cost", false, true};
    }
  }
  return choices;
}

void keep_dearest(const std::vector<ModeTraits>& traits, const ModeRanking& ranking, std::size_t num_dropped,
                  std::vector<Choice>& choices) {
  std::vector<int> gone;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (choices[i].within_tolerance) gone.push_back(static_cast<int>(i));
  const auto groups = group_modes(traits, ranking);
  sort_by_cost(ranking, calc_modified_costs(ranking, groups), gone);
  std::vector<int> back;  // groups
  for (std::size_t k = num_dropped; k < gone.size(); ++k) back.push_back(groups[static_cast<std::size_t>(gone[k])]);
  for (const int i : gone) {
    const int group = groups[static_cast<std::size_t>(i)];
    if (std::find(back.begin(), back.end(), group) != back.end())
      choices[static_cast<std::size_t>(i)] = {true, "cost, with others", false, true};
  }
}

double calc_static_error(const records::FlexBody& body, const std::vector<int>& kept,
                         const std::vector<NodeDirection>& inputs, const std::vector<NodeDirection>& outputs) {
  const MatrixXd b = make_rows(body, inputs).transpose(), c = make_rows(body, outputs);
  const MatrixXd& K = body.modal_stiffness;
  const MatrixXd all = c * K.completeOrthogonalDecomposition().solve(b);
  const MatrixXd K_r = K(kept, kept);
  const MatrixXd some =
      c(Eigen::all, kept) * K_r.completeOrthogonalDecomposition().solve(MatrixXd(b(kept, Eigen::all)));
  const double size = all.norm();
  return size > 0 ? (all - some).norm() / size : 0;
}

}  // namespace bough::statespace
