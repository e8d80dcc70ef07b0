#pragma once
/// \file Joint contacts: dry friction (stick-slip) and rigid stops of hinge coordinates.
///
/// A sticking coordinate is locked. Static friction limits its constraint force in both directions; a stop limits it to
/// compression. Event functions, positive when the contact changes its mode:
///     sticking   excess of the constraint force over its limit
///     free       penetration of a stop; sliding rate after a change of sign, or that of a coordinate that its loops
///     held
#include <string>
#include <vector>

#include "solver/forces/joint_contact.hpp"
#include "solver/simulate/hybrid_system.hpp"

namespace bough::solver {

class JointContacts {
 public:
  /// `system` must outlive this; no contact sticks until settle().
  explicit JointContacts(const System& system);
  /// Watches the joints of a variant of the system (System::variants) from now on.
  void set_system(const System& system) { system_ = &system; }
  /// Returns true if no hinge has dry friction or rigid stops.
  bool empty() const { return joint_contacts_.empty(); }
  static constexpr int kNumEventFunctions = 3;  ///< of each joint contact
  /// Storage for calc_event_functions(), zero.
  VectorXd make_guards() const {
    return VectorXd::Zero(kNumEventFunctions * static_cast<Eigen::Index>(joint_contacts_.size()));
  }
  /// At the state of the last HybridSystem::calc_derivative.
  void calc_event_functions(const SystemData& data, VectorXd& event_functions) const;

  /// Event iteration at (t, y): applies impacts, sticks and releases contacts until no contact changes its mode.
  /// \param shortest  [T] a rebound shorter than this sticks.
  /// \param[in,out] y  u jumps at impacts; the locked rows of `ode` change.
  /// \return one line of text for each impact, stick and release.
  /// \note Allocates.
  std::vector<std::string> settle(HybridSystem& ode, double t, double shortest, VectorXd& y);

  /// After a change from outside: a free coordinate beyond its stop is a ComputationError "run.beyond-stop". `slack`:
  /// of the time.
  void demand_inside(const HybridSystem& ode, double t, double slack, const VectorXd& y) const;

  /// Storage for get_memory(), zero.
  VectorXd make_memory() const { return VectorXd::Zero(kMemory * static_cast<Eigen::Index>(joint_contacts_.size())); }
  /// Writes the numbers of a checkpoint: mode, stop, largest impact speed and excursion of each contact.
  void get_memory(VectorXd& memory) const;
  /// Restores the numbers of get_memory(), and the directions of sliding in `ode`.
  void set_memory(const VectorXd& memory, HybridSystem& ode);

 private:
  struct Watched {
    JointContact contact;
    bool rests = false;
    int stop = 0;         ///< -1, 1: at the lower, upper stop
    int slide = 0;        ///< with friction and moving: which way
    double hardest = 0;   ///< the fastest that it came at its stops
    double farthest = 0;  ///< largest abs(q) of the coordinate at event checks
    /// Lower limit of the constraint force of a sticking contact; -infinity at the upper stop.
    double low(const TreeData& data) const { return stop > 0 ? -kFree : -calc_limit(data); }
    /// Upper limit of the constraint force of a sticking contact; infinity at the lower stop.
    double high(const TreeData& data) const { return stop < 0 ? kFree : calc_limit(data); }

   private:
    double calc_limit(const TreeData& data) const {
      return contact.static_friction + (contact.is_loaded ? data.friction_limit[contact.u_row] : 0);
    }
  };
  static constexpr int kMemory = 4;  ///< numbers of each joint contact in a checkpoint
  static constexpr double kFree = std::numeric_limits<double>::infinity();

  void find_stops(const HybridSystem& ode, double resolution, const VectorXd& y);
  bool strike_stops(HybridSystem& ode, double t, double shortest, VectorXd& y, std::vector<std::string>& what);
  bool can_strike(const HybridSystem& ode, const Watched& w) const;
  /// Rate below which the coordinate may stick.
  double calc_slowest(const Watched& w, int u, double shortest) const;
  [[noreturn]] void fail_endless(const std::vector<std::string>& what) const;
  void find_rest(HybridSystem& ode, double t, double shortest, VectorXd& y, std::vector<std::string>& what);
  void lock(HybridSystem& ode, double t, const std::vector<bool>& rests, VectorXd& y) const;

  const System* system_;
  /// Rows of find_rest(), one for each joint contact.
  struct Scratch {
    std::vector<bool> rests, before;
    std::vector<int> slide;
    std::vector<double> slowest;
  };
  std::vector<Watched> joint_contacts_;
  Scratch scratch_;
  VectorXd y_dot_;
  double shortest_ = 0;
};

}  // namespace bough::solver
