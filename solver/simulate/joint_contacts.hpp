#pragma once
/// \file Dry friction and rigid stops in a run: what rests, what slides and which way, what strikes a stop.
///
/// A coordinate at rest is locked, and held by what it takes to keep it there (friction up to its static value either
/// way, a stop as far as it pushes). Guards, positive where something changes:
///     resting    holding force past what can be held
///     moving     a stop is passed; the rate has turned against the direction of sliding
#include <string>
#include <vector>

#include "solver/forces/latch.hpp"
#include "solver/simulate/hybrid_system.hpp"

namespace bough::solver {

class Latches {
 public:
  explicit Latches(const System& system);
  bool empty() const { return latches_.empty(); }
  static constexpr int kGuards = 3;  ///< of each latch
  VectorXd make_guards() const { return VectorXd::Zero(kGuards * static_cast<Eigen::Index>(latches_.size())); }
  /// At the state of the last SystemOde::calc_derivative.
  void calc_guards(const SystemData& data, VectorXd& guards) const;

  /// At (t, y), where y may have reached or passed what the guards watch: strikes, comes to rest, comes loose, as long
  /// as anything changes. A bounce shorter than `shortest` comes to rest. What happened, in words; y and what is locked
  /// change with it. Allocates.
  std::vector<std::string> settle(SystemOde& ode, double t, double shortest, VectorXd& y);

  /// After a change from outside: a free coordinate beyond its stop is a ComputationError "run.beyond-stop". `slack`:
  /// of the time.
  void demand_inside(const SystemOde& ode, double t, double slack, const VectorXd& y) const;

  VectorXd make_memory() const { return VectorXd::Zero(kMemory * static_cast<Eigen::Index>(latches_.size())); }
  void get_memory(VectorXd& memory) const;
  void set_memory(const VectorXd& memory, SystemOde& ode);

 private:
  struct Watched {
    Latch latch;
    bool rests = false;
    int stop = 0;         ///< -1, 1: at the lower, upper stop
    int slide = 0;        ///< with friction and moving: which way
    double hardest = 0;   ///< the fastest that it came at its stops
    double farthest = 0;  ///< from zero, where it was looked at
    double low() const { return stop > 0 ? -kFree : -latch.static_friction; }
    double high() const { return stop < 0 ? kFree : latch.static_friction; }
  };
  static constexpr int kMemory = 4;  ///< numbers of each latch in a checkpoint
  static constexpr double kFree = std::numeric_limits<double>::infinity();

  void find_stops(const SystemOde& ode, double resolution, const VectorXd& y);
  bool strike_stops(SystemOde& ode, double t, double shortest, VectorXd& y, std::vector<std::string>& what);
  bool can_strike(const SystemOde& ode, const Watched& w) const;
  /// A rate below which it comes to rest at what may hold it.
  double calc_slowest(const Watched& w, int u, double shortest) const;
  [[noreturn]] void fail_endless(const std::vector<std::string>& what) const;
  void find_rest(SystemOde& ode, double t, double shortest, VectorXd& y, std::vector<std::string>& what);
  void lock(SystemOde& ode, double t, const std::vector<bool>& rests, VectorXd& y) const;

  const System& system_;
  /// Rows of find_rest(), one for each latch.
  struct Scratch {
    std::vector<bool> rests, before;
    std::vector<int> slide;
  };
  std::vector<Watched> latches_;
  Scratch scratch_;
  VectorXd y_dot_;
  double shortest_ = 0;
};

}  // namespace bough::solver
