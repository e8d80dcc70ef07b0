#pragma once
/// \file Watches whether flexible bodies leave the range in which their modes mean something.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "solver/system/system.hpp"

namespace bough::solver {

/// Share of a body's size that a deflection of linear modes may reach before it is reported (the habit of Adams/Flex).
inline constexpr double kLinearLimit = 0.10;
/// Limit of the estimated next order of a body of second or third order, of the deflection.
inline constexpr double kNextOrderLimit = 0.01;
/// Deflection, of the size, from which the next order is estimated.
inline constexpr double kCheckedWay = 0.02;
/// Share of the first frequency that the spin of a body without stiffening may reach: at half, the centrifugal terms
/// soften the first mode by a quarter of its stiffness (docs/theory/when-stiffening-matters.md).
inline constexpr double kSpinLimit = 0.5;

/// Size of a body: the largest distance of a node from Bo, but no more than its extent where Bo is far away: the longer
/// of the diagonal of the box around its nodes (and Bo, where the body hangs by it) and that of the box of its inertia.
double calc_body_size(const System& system, int body);

/// First frequency of a body alone in its frame, rad per unit of time; 0 when it has none.
double calc_first_frequency(const System& system, int body);

class ModalRangeMonitor {
 public:
  static constexpr std::string_view spin_id = "run.unstiffened-spin";

  /// Watches every flexible body; the spin limit only of bodies without stiffening. `system` must outlive this.
  explicit ModalRangeMonitor(const System& system);
  /// Watches the bodies of a variant of the system (System::variants) from now on.
  void set_system(const System& system) { system_ = &system; }

  /// A limit that was exceeded at t for the first time, as one message.
  struct Crossing {
    int body;
    std::string_view id;
    std::string what, advice;
  };
  /// Deflections and spins. No allocation while nothing is passed.
  std::vector<Crossing> find_crossings(double t, const SystemData& data, const Eigen::Ref<const VectorXd>& q);
  /// Deflections beyond the range of the modes; t: none for a state of rest. No allocation while nothing is passed.
  std::vector<Crossing> find_deflections(const Eigen::Ref<const VectorXd>& q, std::optional<double> t);
  /// Spins of bodies without stiffening alone, from the kinematics in `data`.
  std::vector<Crossing> find_spins(double t, const SystemData& data);
  bool watches_spins() const;  ///< of at least one body

  /// Size a mode coordinate times its shape may reach on every node: |η_j| to be judged against. num_q, infinite for
  /// hinge coordinates. O(nodes · modes).
  VectorXd calc_modal_limit() const;

  /// Limits that were reported, for a checkpoint.
  int num_watched() const { return static_cast<int>(watched_.size()); }
  void get_memory(Eigen::Ref<VectorXd> memory) const;  ///< 2 num_watched
  /// Restores the limits of get_memory(), so that they are not reported again.
  void set_memory(const VectorXd& memory);

 private:
  /// Deflections reported: none, beyond the limit of the modes, beyond the size of the body.
  enum class Range { Kept, Passed, Left };
  struct Watched {
    int body = 0;
    double size = 0, frequency = 0;  ///< frequency: 0 where stiffening is on
    Range reported = Range::Kept;
    bool spin_reported = false;
  };
  const System* system_;
  std::vector<Watched> watched_;
};

}  // namespace bough::solver
