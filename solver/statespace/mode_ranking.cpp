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
    rows.row(static_cast<Index>(i)) = body.phi[static_cast<std::size_t>(node)].row(places[i].direction - 1);
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
  C.leftCols(n) = c;
  return {std::move(A), std::move(B), std::move(C)};
}

ModeRanking rank_modes(const records::FlexBody& body, const std::vector<NodeDirection>& inputs,
                       const std::vector<NodeDirection>& outputs, double otherwise_damping) {
  const Index n = body.num_modes();
  const MatrixXd b = make_rows(body, inputs).transpose(), c = make_rows(body, outputs);
  const MatrixXd D = make_damping(body, otherwise_damping), &M = body.modal_mass, &K = body.modal_stiffness;
  const auto [A, B, C] = make_state_space(body, inputs, outputs, otherwise_damping);
  const ComponentCost cost = calc_component_cost(A, B, C);
  ModeRanking ranking;
  ranking.total = cost.total;
  for (Index i = 0; i < n; ++i) {
    ModeCost mode{cost.state[i] + cost.state[n + i], 0};
    const double m = M(i, i), omega = std::sqrt(std::max(0.0, K(i, i) / m));
    const double zeta = omega > 0 ? D(i, i) / (2 * m * omega) : 0;
    if (zeta > 0)
      mode.closed_form = calc_modal_cost(omega, zeta, b.row(i).squaredNorm() / (m * m), c.col(i).squaredNorm(), 0);
    ranking.modes.push_back(mode);
  }
  ranking.other = 0;
  return ranking;
}

std::vector<Choice> choose_modes(const records::FlexBody& body, const ModeRanking& ranking,
                                 const SelectionRules& rules) {
  const int n = body.num_modes();
  BOUGH_DEMAND(static_cast<int>(ranking.modes.size()) == n);
  std::vector<Choice> choices(static_cast<std::size_t>(n));
  const auto at = [&](int i) -> Choice& { return choices[static_cast<std::size_t>(i)]; };
  const auto size = [&](int i) { return std::abs(ranking.modes[static_cast<std::size_t>(i)].cost); };
  std::vector<int> open;  // to be decided by cost
  int num_kept = 0;
  for (int i = 0; i < n; ++i) {
    const auto kind = body.kind[static_cast<std::size_t>(i)];
    if (kind != records::ModeKind::Normal) {
      at(i).reason = kind == records::ModeKind::Constraint   ? "constraint shape"
                     : kind == records::ModeKind::Attachment ? "attachment shape"
                                                             : "residual shape";
      ++num_kept;
    } else if (body.eigenvalue[i] <= 1e-12 * body.eigenvalue.cwiseAbs().maxCoeff()) {
      at(i).reason = "rigid";
      ++num_kept;
    } else if (rules.below_hz > 0 && body.frequency_hz[i] > rules.below_hz) {
      at(i) = {false, "above the frequency"};
    } else if (!rules.by_cost) {
      at(i).reason = "below the frequency";
      ++num_kept;
    } else {
      open.push_back(i);
    }
  }
  std::stable_sort(open.begin(), open.end(), [&](int a, int b) { return size(a) < size(b); });
  const double sum = std::abs(ranking.total);
  double dropped = 0;
  int left = static_cast<int>(open.size());
  for (const int i : open) {
    const bool too_many = rules.number > 0 && num_kept + left > rules.number;
    const bool is_small = rules.number == 0 && dropped + size(i) <= rules.tolerance * sum;
    if (too_many || is_small) {
      dropped += size(i);
      at(i) = {false, too_many ? "beyond the number" : "within the tolerance: " + percent(dropped / sum) + " gone",
               !too_many};
      --left;
    } else {
      at(i).reason = "cost";
    }
  }
  return choices;
}

void keep_dearest(const ModeRanking& ranking, std::size_t num_dropped, std::vector<Choice>& choices) {
  std::vector<std::size_t> gone;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (choices[i].within_tolerance) gone.push_back(i);
  std::stable_sort(gone.begin(), gone.end(),
                   [&](auto a, auto b) { return std::abs(ranking.modes[a].cost) < std::abs(ranking.modes[b].cost); });
  for (std::size_t k = num_dropped; k < gone.size(); ++k) choices[gone[k]] = {true, "cost, with others"};
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
