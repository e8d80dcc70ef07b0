#include "fe/model/coordinates.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>

namespace bough::fe {
namespace {

using records::CoordKind;
constexpr double kDegree = 3.14159265358979323846 / 180;

/// Rectangular components of coordinates given in a system of this kind.
Vector3d to_rectangular(CoordKind kind, const Vector3d& x) {
  if (kind == CoordKind::Cylindrical) {
    const double t = x[1] * kDegree;
    return {x[0] * std::cos(t), x[0] * std::sin(t), x[2]};
  }
  if (kind == CoordKind::Spherical) {
    const double t = x[1] * kDegree, p = x[2] * kDegree;
    return {x[0] * std::sin(t) * std::cos(p), x[0] * std::sin(t) * std::sin(p), x[0] * std::cos(t)};
  }
  return x;
}

/// Local axes (columns, in the system's rectangular axes) at the local rectangular point p.
Matrix3d calc_local_axes(CoordKind kind, const Vector3d& p) {
  if (kind == CoordKind::Rectangular) return Matrix3d::Identity();
  const double rho = std::hypot(p.x(), p.y());
  const double r = p.norm();
  const bool on_axis = rho <= 1e-10 * r || rho == 0;
  const double c = on_axis ? 1 : p.x() / rho, s = on_axis ? 0 : p.y() / rho;
  Matrix3d axes;
  if (kind == CoordKind::Cylindrical) {
    axes << c, -s, 0, s, c, 0, 0, 0, 1;
    return axes;
  }
  const double st = r == 0 ? 0 : (on_axis ? 0 : rho / r), ct = r == 0 ? 1 : p.z() / r;
  axes << st * c, ct * c, -s, st * s, ct * s, c, ct, -st, 0;
  return axes;
}

/// Round-off of right angles would put entries of 1e-17 all over the constraint matrix.
Matrix3d clean(Matrix3d R) {
  for (double& v : R.reshaped()) {
    if (std::abs(v) < 1e-15) v = 0;
    if (std::abs(std::abs(v) - 1) < 1e-15) v = std::copysign(1.0, v);
  }
  return R;
}

enum class State { New, Busy, Done };

const std::vector<std::string> kCoordinateCards{"CORD1R", "CORD1C", "CORD1S", "CORD2R", "CORD2C", "CORD2S"};

/// Depth-first resolution; a chain that meets itself is a cycle. Systems and grids depend on each other (CORD1x, CP).
class Resolver {
 public:
  Resolver(const records::Deck& deck, const Vector3d& origin, Diagnostics& diagnostics)
      : deck_(deck), origin_(origin), diagnostics_(diagnostics), grid_state_(deck.grids.size(), State::New) {
    for (const auto& c : deck.coord_systems) records_.emplace(c.id, &c);
    for (size_t i = 0; i < deck.grids.size(); ++i) grid_index_.emplace(deck.grids[i].id, static_cast<int>(i));
    CoordinateSystem basic;
    basic.origin = -origin;
    systems[0] = basic;
    positions.assign(deck.grids.size(), Vector3d::Zero());
  }

  void run() {
    for (const auto& c : deck_.coord_systems) resolve_system(c.id);
    for (size_t i = 0; i < deck_.grids.size(); ++i) resolve_grid(static_cast<int>(i));
  }

  std::map<int, CoordinateSystem> systems;
  std::vector<Vector3d> positions;

 private:
  void resolve_grid(int index) {
    if (grid_state_[index] != State::New) return;
    grid_state_[index] = State::Busy;
    const auto& grid = deck_.grids[index];
    const auto at = deck_.locate(grid.at);
    const bool known = require_system(grid.cp, "GRID " + std::to_string(grid.id) + " field CP", at);
    const CoordinateSystem& cp = systems.at(known ? grid.cp : 0);
    positions[index] = cp.origin + cp.R_basic * to_rectangular(cp.kind, grid.x);
    grid_state_[index] = State::Done;
  }

  /// True when system id exists and is resolved after the call.
  bool require_system(int id, const std::string& who, const SourceLocation& at) {
    if (id == 0) return true;
    if (!records_.count(id) && deck_.is_refused(id, kCoordinateCards)) return false;
    if (!records_.count(id)) {
      diagnostics_.error("fe.missing-coordinates", at,
                         who + " names coordinate system " + std::to_string(id) + ", which the deck does not define",
                         "add a CORD card or correct the field");
      return false;
    }
    resolve_system(id);
    return state_[id] == State::Done;
  }

  void resolve_system(int id) {
    if (state_[id] == State::Done) return;
    const records::CoordSystem& card = *records_.at(id);
    const auto at = deck_.locate(card.at);
    if (state_[id] == State::Busy) {
      report_cycle(id, at);
      return;
    }
    state_[id] = State::Busy;
    chain_.push_back(id);
    Vector3d p[3];
    const bool found = card.by_grids ? get_grid_points(card, at, p) : get_own_points(card, at, p);
    chain_.pop_back();
    CoordinateSystem system;
    system.kind = card.kind;
    system.origin = -origin_;
    system.is_resolved = found && set_axes(id, p, at, system);
    systems[id] = system;
    state_[id] = State::Done;
  }

  bool get_own_points(const records::CoordSystem& card, const SourceLocation& at, Vector3d* p) {
    if (!require_system(card.rid, "coordinate system " + std::to_string(card.id), at)) return false;
    const CoordinateSystem& ref = systems.at(card.rid);
    const Vector3d x[3] = {card.a, card.b, card.c};
    for (int i = 0; i < 3; ++i) p[i] = ref.origin + ref.R_basic * to_rectangular(ref.kind, x[i]);
    return ref.is_resolved;
  }

  bool get_grid_points(const records::CoordSystem& card, const SourceLocation& at, Vector3d* p) {
    bool found = true;
    for (int i = 0; i < 3; ++i) {
      const auto it = grid_index_.find(card.grids[i]);
      if (it == grid_index_.end()) {
        found = false;
        if (deck_.is_refused(card.grids[i], {"GRID"})) continue;
        diagnostics_.error("fe.missing-grid", at,
                           "coordinate system " + std::to_string(card.id) + " names grid " +
                               std::to_string(card.grids[i]) + ", which the deck does not define",
                           "add the GRID or correct the id");
        continue;
      }
      const int cp = deck_.grids[it->second].cp;
      if (cp != 0 && records_.count(cp) && state_[cp] == State::Busy) {
        report_cycle(cp, at);
        found = false;
        continue;
      }
      resolve_grid(it->second);
      p[i] = positions[it->second];
      found = found && (!systems.count(cp) || systems.at(cp).is_resolved);
    }
    return found;
  }

  bool set_axes(int id, const Vector3d* p, const SourceLocation& at, CoordinateSystem& system) {
    const Vector3d z = p[1] - p[0], xz = p[2] - p[0];
    const Vector3d y = z.cross(xz);
    if (!(y.norm() > 1e-10 * z.norm() * xz.norm())) {
      diagnostics_.error("fe.degenerate-coordinates", at,
                         "the three points of coordinate system " + std::to_string(id) +
                             " lie on one line or coincide, expected a triangle",
                         "move the third point off the z axis");
      return false;
    }
    system.origin = p[0];
    system.R_basic.col(2) = z.normalized();
    system.R_basic.col(1) = y.normalized();
    system.R_basic.col(0) = system.R_basic.col(1).cross(system.R_basic.col(2));
    system.R_basic = clean(system.R_basic);
    return true;
  }

  void report_cycle(int id, const SourceLocation& at) {
    if (!cyclic_.insert(id).second) return;
    std::string chain;
    const auto begin = std::find(chain_.begin(), chain_.end(), id);
    for (auto it = begin; it != chain_.end(); ++it) chain += std::to_string(*it) + " -> ";
    diagnostics_.error(
        "fe.cyclic-coordinates", at,
        "coordinate system " + std::to_string(id) + " is defined by itself: " + chain + std::to_string(id),
        "define one of them in basic");
  }

  const records::Deck& deck_;
  Vector3d origin_;
  Diagnostics& diagnostics_;
  std::unordered_map<int, const records::CoordSystem*> records_;
  std::unordered_map<int, int> grid_index_;
  std::unordered_map<int, State> state_;
  std::vector<State> grid_state_;
  std::vector<int> chain_;
  std::set<int> cyclic_;
};

void report_missing(int cid, const SourceLocation& at, Diagnostics& diagnostics) {
  diagnostics.error("fe.missing-coordinates", at,
                    "coordinate system " + std::to_string(cid) + " is used but not defined",
                    "add a CORD card or correct the field");
}

}  // namespace

CoordinateSystems::CoordinateSystems(const records::Deck& deck, const Vector3d& origin, Diagnostics& diagnostics) {
  Resolver resolver(deck, origin, diagnostics);
  resolver.run();
  systems_ = std::move(resolver.systems);
  for (const auto& card : kCoordinateCards)  // refused: they stand for basic, without more words
    if (const auto refused = deck.refused.find(card); refused != deck.refused.end())
      for (const int id : refused->second) {
        CoordinateSystem basic = systems_.at(0);
        basic.is_resolved = false;
        systems_.emplace(id, basic);
      }
  grid_positions_ = std::move(resolver.positions);
}

const CoordinateSystem* CoordinateSystems::find(int cid) const {
  const auto it = systems_.find(cid);
  return it == systems_.end() ? nullptr : &it->second;
}

Vector3d CoordinateSystems::calc_point(int cid, const Vector3d& x, const SourceLocation& at,
                                       Diagnostics& diagnostics) const {
  const CoordinateSystem* system = find(cid);
  if (!system) {
    report_missing(cid, at, diagnostics);
    return x;
  }
  return system->origin + system->R_basic * to_rectangular(system->kind, x);
}

Matrix3d CoordinateSystems::calc_axes(int cid, const Vector3d& x, const SourceLocation& at,
                                      Diagnostics& diagnostics) const {
  const CoordinateSystem* system = find(cid);
  if (!system) {
    report_missing(cid, at, diagnostics);
    return Matrix3d::Identity();
  }
  if (system->kind == CoordKind::Rectangular) return system->R_basic;
  const Vector3d local = system->R_basic.transpose() * (x - system->origin);
  return clean(system->R_basic * calc_local_axes(system->kind, local));
}

}  // namespace bough::fe
