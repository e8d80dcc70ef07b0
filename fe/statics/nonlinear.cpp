#include "fe/statics/nonlinear.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/rotation.hpp"
#include "fe/model/element_loop.hpp"
#include "fe/model/load_selection.hpp"
#include "fe/statics/nonlinear_tangent.hpp"
#include "fe/statics/reactions.hpp"

namespace bough::fe {

namespace {

using Eigen::Index;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Work of the load of a step, relative to what the tangent stiffness at its start gives. On a path that softens
/// towards a limit point (a parabola) it is 2 at most; a jump to another branch is far above where the step is small.
constexpr double kMaxSoftening = 2.5;
/// Largest growth of that work, relative to the square of the step, from one step to the next: at a limit point the
/// stiffness does not predict the next step.
constexpr double kMaxRateGrowth = 10;
constexpr int kMinElementsOfThread = 50;
/// Numbers of the matrices of elements that are kept: 2 GB.
constexpr double kMaxKept = 2.5e8;

bool is_stiff(const Element& element) {
  MatrixXd K = MatrixXd::Zero(element.num_dofs(), element.num_dofs());
  element.add_stiffness(1, K);
  return !K.isZero(0);
}

/// Mass of an element on the six dofs of one grid, and its arm; 0 if it is on the grid.
double find_offset_mass(const Element& element, MassKind kind, Vector3d& arm) {
  if (element.num_dofs() != 6 || !element.offset_mass(kind)) return 0;
  MatrixXd M = MatrixXd::Zero(6, 6);
  element.add_mass(kind, 1, M);
  const double mass = M(0, 0);
  if (!(mass > 0)) return 0;
  const Matrix3d first = M.block<3, 3>(0, 3) / mass;  // -r̃
  arm = Vector3d(first(1, 2), first(2, 0), first(0, 1));
  return arm.isZero(0) ? 0 : mass;
}

std::string list_ids(const std::vector<int>& ids) {
  constexpr std::size_t kMaxListed = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(ids.size(), kMaxListed); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(ids[i]);
  return ids.size() > kMaxListed ? text + ", ... (" + std::to_string(ids.size()) + ")" : text;
}

/// Throws fe.nonlinear-load at the first card that acts on the undeformed structure alone.
void demand_nonlinear_loads(const records::Deck& deck, int load_set) {
  const auto demand = [&](const auto& cards, int sid, const std::string& what) {
    const auto found = std::find_if(cards.begin(), cards.end(), [sid](const auto& card) { return card.sid == sid; });
    if (found != cards.end())
      throw InputError("fe.nonlinear-load", deck.locate(found->at), what + " in large displacements",
                       "give forces on the grids, or --linear");
  };
  for_each_plain_set(deck, load_set, [&](int sid, double, const records::CardLocation&) {
    demand(deck.load_cards.beams, sid, "PLOAD1 loads beams between their grids, which is not done");
    demand(deck.load_cards.rotations, sid, "RFORCE loads the places of the undeformed structure, which is not done");
  });
}

}  // namespace

NonlinearStatics::NonlinearStatics(const Model& model, const records::Deck& deck)
    : model_(model), deck_(deck), ties_(deck, model) {
  Diagnostics diagnostics;
  const auto at = deck.locate({});
  if (model.omitted() || model.prestress())
    diagnostics.error("fe.nonlinear-model", at, "ASET, OMIT and preloads are linear, the statics are not",
                      "take ASET, OMIT and STATSUB away, or give --linear");
  node_of_.resize(static_cast<std::size_t>(model.num_gdofs()));
  for (std::size_t k = 0; k < model.nodes().size(); ++k)
    for (int i = 0; i < model.nodes()[k].num_dofs; ++i)
      node_of_[static_cast<std::size_t>(model.nodes()[k].first_gdof) + static_cast<std::size_t>(i)] =
          static_cast<int>(k);
  std::vector<int> fixed_in_space;
  double num_kept = 0;
  for (const auto& element : model.elements()) {
    is_stiff_.push_back(is_stiff(*element) ? 1 : 0);
    kept_.emplace_back();
    if (!is_stiff_.back()) continue;
    auto corotational = std::make_unique<const CorotationalElement>(*element, model.nodes());
    const bool follows = corotational->follows_nodes();
    num_kept += (2.0 + static_cast<double>(corotational->P().size())) * std::pow(element->num_dofs(), 2);
    if (num_kept < kMaxKept) kept_.back() = std::move(corotational);
    if (follows) continue;
    const bool turns = std::any_of(element->gdofs().begin(), element->gdofs().end(), [&](int dof) {
      const Node& node = model.nodes()[static_cast<std::size_t>(node_of_[static_cast<std::size_t>(dof)])];
      return node.num_dofs == 6 && dof - node.first_gdof >= 3;
    });
    if (turns) fixed_in_space.push_back(element->id());
  }
  if (!fixed_in_space.empty())
    diagnostics.error("fe.nonlinear-element", at,
                      "elements " + list_ids(fixed_in_space) + " act on rotations of grids in fixed directions",
                      "use CBUSH, whose axes turn with its grids, or give --linear");
  diagnostics.throw_if_errors();
  state_.u = VectorXd::Zero(model.num_gdofs());
  state_.R.assign(model.nodes().size(), Matrix3d::Identity());
  F_ = VectorXd::Zero(model.num_gdofs());
  d_ = VectorXd::Zero(static_cast<Index>(model.fixed_dofs().size()));
  load_.F = F_;
  load_.d = d_;
  deformed_.displacements.resize(model.elements().size());
  deformed_.internal_forces.resize(model.elements().size());
  deformed_.forces.resize(model.elements().size());
  find_offset_masses();
  find_linear_ties();
  energies_ = VectorXd::Zero(static_cast<Index>(model.elements().size()));
}

void NonlinearStatics::evaluate_element(int e, const Element& element, FiniteForces& forces) const {
  const auto& kept = kept_[static_cast<std::size_t>(e)];
  const auto made = kept ? nullptr : std::make_unique<const CorotationalElement>(element, model_.nodes());
  const CorotationalElement& corotational = kept ? *kept : *made;
  const VectorXd u = state_.u(element.gdofs());
  const ThermalState* heat = heat_.find(element);
  if (!corotational.follows_nodes()) {
    forces.d = u;
    forces.K = corotational.K();
    forces.f = forces.K * u;
    forces.energy = 0.5 * u.dot(forces.f);
    if (heat) forces.f -= heat->load;
    return;
  }
  std::vector<Matrix3d> rotations;
  for (const int k : corotational.grids()) rotations.push_back(state_.R[static_cast<std::size_t>(k)]);
  forces = corotational.calc_finite(u, rotations, heat);
}

/// Nodes of linear equations, and those of them whose rotations occur in the equations.
void NonlinearStatics::find_linear_ties() {
  std::vector<char> is_tied(model_.nodes().size(), 0), is_turned(model_.nodes().size(), 0);
  for (const int id : ties_.others()) {
    const int k = model_.find_node(id);
    const Node& node = model_.node(k);
    is_tied[static_cast<std::size_t>(k)] = 1;
    if (node.num_dofs == 6) is_turned[static_cast<std::size_t>(k)] = 1;
    for (int i = 0; i < node.num_dofs; ++i)
      for (SparseRows::InnerIterator it(model_.T(), node.first_gdof + i); it; ++it) {
        if (it.value() == 0) continue;
        const auto [other, component] = model_.describe_fdof(static_cast<int>(it.col()));
        const auto found = static_cast<std::size_t>(model_.find_node(other));
        is_tied[found] = 1;
        if (component > 3) is_turned[found] = 1;
      }
  }
  for (std::size_t k = 0; k < is_tied.size(); ++k) {
    if (is_tied[k]) tied_.push_back(static_cast<int>(k));
    if (is_turned[k]) turned_by_vector_.push_back(static_cast<int>(k));
  }
}

/// Forces conjugate to the unknowns: those of grids that follow others at these, and Tᵀ(θ) m where rotation vectors are
/// the unknowns. At the state of the last evaluate().
VectorXd NonlinearStatics::collect(const VectorXd& residual) const {
  return basis_.rows() > 0 ? VectorXd(basis_.transpose() * residual) : residual;
}

/// From displacements and spins of all nodes to the unknowns: those of the grids that follow none, rotation vectors of
/// the nodes in linear equations. AᵀKA, and the change of Tᵀ(θ) m.
void NonlinearStatics::move_to_unknowns(Tangent& tangent) {
  basis_ = ties_.is_empty() ? SparseRows() : ties_.calc_basis(state_);
  if (turned_by_vector_.empty() && ties_.is_empty()) return;
  SparseRows slope(model_.num_gdofs(), model_.num_gdofs());
  if (!turned_by_vector_.empty()) {
    std::vector<char> is_turned(model_.nodes().size(), 0);
    for (const int k : turned_by_vector_) is_turned[static_cast<std::size_t>(k)] = 1;
    const VectorXd moved = collect(tangent.residual);
    Triplets turns, slopes;
    for (std::size_t k = 0; k < is_turned.size(); ++k) {
      const Node& node = model_.nodes()[k];
      const int num_plain = is_turned[k] ? 3 : node.num_dofs;
      for (int i = 0; i < num_plain; ++i) turns.emplace_back(node.first_gdof + i, node.first_gdof + i, 1);
      if (!is_turned[k]) continue;
      const int first = node.first_gdof + 3;
      const Vector3d theta = state_.u.segment<3>(first);
      const Matrix3d turn = calc_rotation_tangent(theta);
      const Vector3d conjugate = turn.transpose() * moved.segment<3>(first);
      const Matrix3d of_moment = -turn.transpose() * calc_inverse_tangent_slope(theta, conjugate);  // T⁻ᵀ(Tᵀm) = m
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          turns.emplace_back(first + a, first + b, turn(a, b));
          slopes.emplace_back(first + a, first + b, of_moment(a, b));
        }
    }
    SparseRows B(model_.num_gdofs(), model_.num_gdofs());
    B.setFromTriplets(turns.begin(), turns.end());
    slope.setFromTriplets(slopes.begin(), slopes.end());
    basis_ = ties_.is_empty() ? B : SparseRows(basis_ * B);
  }
  tangent.K = (SparseRows(basis_.transpose()) * tangent.K * basis_ + slope).eval();
}

/// F: dead forces.
NonlinearStatics::Tangent NonlinearStatics::evaluate(const VectorXd& F) {
  struct Sum {
    NonlinearStatics& owner;
    Triplets entries;
    VectorXd f;
    double max_turn = 0;

    void add(int e, const Element& element) {
      if (!owner.is_stiff_[static_cast<std::size_t>(e)]) {
        owner.deformed_.displacements[static_cast<std::size_t>(e)] = VectorXd::Zero(element.num_dofs());
        return;
      }
      FiniteForces forces;
      owner.evaluate_element(e, element, forces);
      max_turn = std::max(max_turn, forces.max_turn);
      owner.deformed_.displacements[static_cast<std::size_t>(e)] = forces.d;
      owner.deformed_.internal_forces[static_cast<std::size_t>(e)] = forces.internal;
      owner.deformed_.forces[static_cast<std::size_t>(e)] = forces.f;
      owner.energies_[e] = forces.energy;
      f(element.gdofs()) += forces.f;
      add_stiffness(element.gdofs(), forces.K);
    }
    void add_stiffness(const std::vector<int>& gdofs, const MatrixXd& K) {
      for (std::size_t i = 0; i < gdofs.size(); ++i)
        for (std::size_t j = 0; j < gdofs.size(); ++j)
          if (const double value = K(static_cast<Index>(i), static_cast<Index>(j)); value != 0)
            entries.emplace_back(gdofs[i], gdofs[j], value);
    }
    void merge(Sum&& other) {
      entries.insert(entries.end(), other.entries.begin(), other.entries.end());
      f += other.f;
      max_turn = std::max(max_turn, other.max_turn);
    }
  };
  auto sum = sum_over_elements(model_, get_all_elements(model_), kMinElementsOfThread, [&] {
    return Sum{*this, {}, VectorXd::Zero(model_.num_gdofs())};
  });
  max_turn_ = sum.max_turn;
  energy_ = energies_.sum();
  Tangent tangent;
  tangent.residual = sum.f - calc_forces(F);
  visit_follower_stiffness(model_, followers_, state_.u,
                           [&](const std::vector<int>& gdofs, const MatrixXd& K) { sum.add_stiffness(gdofs, K); });
  for (const ArmLoad& load : arm_loads_) {
    const auto& R = state_.R[static_cast<std::size_t>(node_of_[static_cast<std::size_t>(load.first_rotation)])];
    const Vector3d arm = R * load.arm;
    tangent.residual.segment<3>(load.first_rotation) -= (arm - load.arm).cross(load.force);
    const Matrix3d turn = -skew(load.force) * skew(arm);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        sum.entries.emplace_back(load.first_rotation + a, load.first_rotation + b, turn(a, b));
  }
  ties_.add_slopes(state_, tangent.residual, sum.entries);
  tangent.K.resize(model_.num_gdofs(), model_.num_gdofs());
  tangent.K.setFromTriplets(sum.entries.begin(), sum.entries.end());
  move_to_unknowns(tangent);
  if (is_symmetric_)
    tangent.K = (0.5 * (tangent.K + Eigen::SparseMatrix<double, Eigen::RowMajor>(tangent.K.transpose()))).eval();
  return tangent;
}

void NonlinearStatics::find_offset_masses() {
  for (const auto& element : model_.elements()) {
    ArmLoad load;
    const double mass = find_offset_mass(*element, model_.mass_kind(), load.arm);
    if (mass == 0) continue;
    load.first_rotation = element->gdofs()[3];
    load.force[0] = mass * model_.wtmass();
    offset_masses_.push_back(load);
  }
}

/// Moments about fixed axes, beyond those of forces on arms: they have no potential where a grid turns about other
/// axes.
bool NonlinearStatics::has_fixed_moments(const PathLoad& load) {
  set_loads(load, load, 1);
  VectorXd moments = calc_dead_forces(load);
  for (const ArmLoad& arm : arm_loads_) moments.segment<3>(arm.first_rotation) -= arm.arm.cross(arm.force);
  const double size = moments.cwiseAbs().maxCoeff();
  return std::any_of(model_.nodes().begin(), model_.nodes().end(), [&](const Node& node) {
    return node.num_dofs == 6 && moments.segment<3>(node.first_gdof + 3).cwiseAbs().maxCoeff() > 1e-12 * size;
  });
}

/// Forces that keep their direction and their grids: the load without temperatures and followers.
VectorXd NonlinearStatics::calc_dead_forces(const PathLoad& load) const {
  VectorXd F = load.F - sum_loads(model_, load.initial);
  add_follower_forces(model_, load.moving, -1, VectorXd::Zero(F.size()), F);
  return F;
}

/// All forces at the present places.
VectorXd NonlinearStatics::calc_forces(const VectorXd& dead) const {
  VectorXd F = dead;
  add_follower_forces(model_, followers_, 1, state_.u, F);
  return F;
}

/// Loads that depend on the state, at a share of the way from one load to the next: on the arms of offset beams,
/// weights of masses off their grids, followers, temperatures.
void NonlinearStatics::set_loads(const PathLoad& from, const PathLoad& to, double share) {
  arm_loads_.clear();
  followers_ = {};
  heat_ = {};
  for (const auto& [load, part] : {std::pair(&from, 1 - share), std::pair(&to, share)}) {
    if (part == 0) continue;
    for (ArmLoad arm : load->arms) {
      arm.force *= part;
      arm_loads_.push_back(arm);
    }
    for (ArmLoad mass : offset_masses_) {
      mass.force = -part * mass.force[0] * load->A_I.head<3>();
      arm_loads_.push_back(mass);
    }
    for (FollowerPressure pressure : load->moving.pressures) {
      for (double& p : pressure.p) p *= part;
      followers_.pressures.push_back(std::move(pressure));
    }
    for (FollowerForce force : load->moving.forces) {
      force.size *= part;
      followers_.forces.push_back(force);
    }
    for (const auto& [element, state] : load->initial.of) {
      auto& heat =
          heat_.of.try_emplace(element, static_cast<int>(state.load.size()), static_cast<int>(state.force.size()))
              .first->second;
      heat.load += part * state.load;
      heat.force += part * state.force;
    }
  }
}

/// `step`: displacements and spins, or changes of rotation vectors, num_gdofs; rows of grids that follow others are not
/// read.
void NonlinearStatics::advance(const VectorXd& step) {
  for (std::size_t k = 0; k < model_.nodes().size(); ++k) {
    const Node& node = model_.nodes()[k];
    const int size = std::min(node.num_dofs, 3);
    state_.u.segment(node.first_gdof, size) += step.segment(node.first_gdof, size);
    if (node.num_dofs == 6) {
      const Matrix3d R = calc_rotation_exp(step.segment<3>(node.first_gdof + 3)) * state_.R[k];
      state_.R[k] = Eigen::Quaterniond(R).normalized().toRotationMatrix();
    }
  }
  for (const int k : turned_by_vector_) {
    const int first = model_.node(k).first_gdof + 3;
    state_.u.segment<3>(first) += step.segment<3>(first);
    state_.R[static_cast<std::size_t>(k)] = calc_rotation_exp(state_.u.segment<3>(first));
  }
  ties_.follow(state_);
}

/// TᵀKT.
Eigen::SparseMatrix<double, Eigen::RowMajor> NonlinearStatics::reduce(
    const Eigen::SparseMatrix<double, Eigen::RowMajor>& K) const {
  return SparseRows(model_.T().transpose()) * K * model_.T();
}

/// Newton's method from the state; F: dead forces, dF: change of all forces; `enforced`: steps of the fixed dofs;
/// `share`: of the load. False if it does not come to an end, or ends on another branch of the path.
bool NonlinearStatics::find_equilibrium(const VectorXd& F, const VectorXd& dF, const VectorXd& enforced, double share,
                                        int max_iterations) {
  const auto& T = model_.T();
  VectorXd moved = enforced.isZero(0) ? VectorXd() : VectorXd(model_.T_fixed() * enforced);
  double reference = 0, first_work = 0, work = 0, last = 0;
  int num_stuck = 0;
  for (int iteration = 0; iteration <= max_iterations; ++iteration) {
    const Tangent tangent = evaluate(F);
    residual_ = tangent.residual;
    if (!residual_.allFinite() || max_turn_ > kMaxTurn) return false;
    VectorXd right = collect(residual_);
    if (moved.size() > 0) right += tangent.K * moved;
    const VectorXd r = T.transpose() * right;
    VectorXd q = VectorXd::Zero(T.cols());
    if (T.cols() > 0) {
      const TangentFactor factor(reduce(tangent.K), is_symmetric_);
      // Where the step begins K is definite. On the way to its end it need not be: stiff parts stretch for a while.
      if (!(iteration == 0 ? factor.is_stable() : factor.is_made())) return false;
      q = -factor.solve(r);
    }
    if (!q.allFinite()) return false;
    ++num_iterations_;
    VectorXd step = T * q;
    if (moved.size() > 0) step += moved;
    const bool is_enforced = moved.size() > 0;
    moved.resize(0);
    residual_work_ = std::abs(q.dot(r));
    advance(step);
    work += dF.dot(step);
    if (iteration == 0) first_work = work;
    reference = std::max({reference, energy_, std::abs(step.dot(calc_forces(F)))});
    num_stuck = residual_work_ > 0.8 * last ? num_stuck + 1 : 0;
    const bool stagnates = num_stuck >= 3 && residual_work_ <= kStagnation * reference;
    last = residual_work_;
    if (!is_enforced && (stagnates || residual_work_ <= kWorkTolerance * reference)) {
      const bool jumps = first_work > 0 && work > kMaxSoftening * first_work;
      const double rate = work / (share * share);
      if (jumps || (last_rate_ > 0 && first_work > kMaxRateGrowth * last_rate_ * share * share)) return false;
      const Tangent end = evaluate(F);
      residual_ = end.residual;
      if (T.cols() > 0 && !TangentFactor(reduce(end.K), is_symmetric_).is_stable()) return false;
      last_rate_ = rate;
      return true;
    }
    if (iteration > 5 && residual_work_ > 1e6 * reference) return false;
  }
  return false;
}

void NonlinearStatics::go_to(const StaticLoad& to, const FollowerLoads& moving, const NonlinearOptions& options,
                             Diagnostics& diagnostics) {
  const PathLoad load{to, moving};
  if (!load.A_I.tail<9>().isZero(0))
    throw InputError("fe.nonlinear-load", {}, "RFORCE loads the places of the undeformed structure",
                     "give its forces as FORCE cards, or --linear");
  const PathLoad start = load_;
  const VectorXd F_start = F_, d_start = d_, dF = calc_dead_forces(load) - F_, dd = load.d - d_;
  const double full = 1.0 / std::max(options.num_increments, 1);
  double reached = 0, step = full;
  last_rate_ = 0;
  is_symmetric_ = start.moving.empty() && load.moving.empty() && !has_fixed_moments(start) && !has_fixed_moments(load);
  set_loads(start, load, 0);
  if (options.has_arc_length && model_.T().cols() > 0) {
    follow_arc(load, options, diagnostics);
    return report_turned_ties(diagnostics);
  }
  while (reached < 1) {
    const DeformedState before = state_;
    const double next = reached + step > 1 - 1e-12 ? 1 : reached + step;
    const VectorXd F = F_start + next * dF, before_step = calc_forces(F_);
    set_loads(start, load, next);
    if (find_equilibrium(F, calc_forces(F) - before_step, (next - reached) * dd, next - reached,
                         options.max_iterations)) {
      reached = next;
      F_ = F;
      d_ = d_start + reached * dd;
      ++num_steps_;
      if (reached == 1) load_ = load;
      step = std::min(2 * step, full);
      continue;
    }
    state_ = before;
    set_loads(start, load, reached);
    step /= 2;
    if (step < full / (1 << kMaxHalvings)) {
      residual_ = evaluate(F_).residual;
      char share[32];
      std::snprintf(share, sizeof share, "%.4g", 100 * reached);
      throw ComputationError("fe.no-equilibrium", options.at,
                             "no stable static equilibrium is found beyond " + std::string(share) + " % of the load",
                             options.advice);
    }
  }
  report_turned_ties(diagnostics);
}

void NonlinearStatics::go_to_load_set(const StaticLoad& to, int set, const NonlinearOptions& options,
                                      Diagnostics& diagnostics) {
  demand_nonlinear_loads(deck_, set);
  const auto* param = deck_.find_param("LGDISP");
  const bool has_followers = !param || param->value != "2";  // 2: large displacements without follower forces (QRG)
  go_to(to, has_followers ? find_follower_loads(model_, deck_, set) : FollowerLoads(), options, diagnostics);
}

/// Equations of MPC and single components are those of small rotations.
void NonlinearStatics::report_turned_ties(Diagnostics& diagnostics) const {
  constexpr double kSmall = 0.1;  // rad: 0.5 % of the arms
  double largest = 0;
  std::vector<int> ids;
  for (const int k : tied_) {
    const Node& node = model_.node(k);
    if (node.num_dofs != 6) continue;
    ids.push_back(node.id);
    largest = std::max(largest, calc_rotation_log(state_.R[static_cast<std::size_t>(k)]).norm());
  }
  if (largest <= kSmall) return;
  char angle[32];
  std::snprintf(angle, sizeof angle, "%.3g", largest);
  diagnostics.warning("fe.nonlinear-link", {},
                      "MPC, RBE3 or rigid elements of single components tie grids " + list_ids(ids) +
                          ", which turn by up to " + angle +
                          " rad; the equations are linear in displacements, as in "
                          "Nastran, and hold for small rotations",
                      "tie the grids by RBE2, RBAR or RBE3 with 123456 if the error matters");
}

VectorXd NonlinearStatics::make_displacement() const {
  VectorXd u = state_.u;
  for (std::size_t k = 0; k < model_.nodes().size(); ++k)
    if (model_.nodes()[k].num_dofs == 6)
      u.segment<3>(model_.nodes()[k].first_gdof + 3) = calc_rotation_log(state_.R[k]);
  for (const int k : turned_by_vector_) {  // may exceed half a turn
    const int first = model_.node(k).first_gdof + 3;
    u.segment<3>(first) = state_.u.segment<3>(first);
  }
  return u;
}

records::StaticSubcase NonlinearStatics::make_result() const {
  records::StaticSubcase result;
  result.displacement = make_displacement();
  result.load = calc_forces(F_);
  result.reaction = calc_reactions(model_, collect(residual_));
  result.mpc_force = residual_ - result.reaction;
  std::vector<bool> is_tied(model_.nodes().size(), false);
  for (const int k : ties_.list_nodes()) is_tied[static_cast<std::size_t>(k)] = true;
  for (const int k : tied_) is_tied[static_cast<std::size_t>(k)] = true;
  for (std::size_t k = 0; k < is_tied.size(); ++k)  // else it is the error of the solution
    if (const Node& node = model_.nodes()[k]; !is_tied[k])
      result.mpc_force.segment(node.first_gdof, node.num_dofs).setZero();
  result.strain_energy = energy_;
  for (std::size_t e = 0; e < model_.elements().size(); ++e)
    if (const ThermalState* heat = load_.initial.find(*model_.elements()[e]))
      result.strain_energy += heat->energy - heat->load.dot(deformed_.displacements[e]);
  result.epsilon = energy_ > 0 ? residual_work_ / energy_ : 0;
  const auto sum = [&](const VectorXd& forces) {
    Eigen::Matrix<double, 6, 1> total = Eigen::Matrix<double, 6, 1>::Zero();
    for (const Node& node : model_.nodes()) {
      if (node.num_dofs != 6) continue;
      const Vector3d force = forces.segment<3>(node.first_gdof);
      total.head<3>() += force;
      total.tail<3>() +=
          (node.x + state_.u.segment<3>(node.first_gdof)).cross(force) + forces.segment<3>(node.first_gdof + 3);
    }
    return total;
  };
  result.load_resultant = sum(result.load);
  result.reaction_resultant = sum(result.reaction);
  result.mpc_resultant = sum(result.mpc_force);
  return result;
}

}  // namespace bough::fe
