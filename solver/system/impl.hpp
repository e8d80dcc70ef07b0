#pragma once
/// \file What stands behind System and SystemData.
#include "solver/forces/applied.hpp"
#include "solver/forces/element.hpp"
#include "solver/forces/gravity_field.hpp"
#include "solver/forces/latch.hpp"
#include "solver/loops/loops.hpp"
#include "solver/signals/graph.hpp"
#include "solver/system/recovery.hpp"
#include "solver/system/system.hpp"
#include "solver/tree/data.hpp"

namespace bough::solver {

class StiffeningTerms;

struct System::Impl {
  Tree tree;
  std::vector<std::unique_ptr<const TimeFunction>> functions;
  std::vector<AppliedForce> forces;
  std::vector<AppliedForce> driven;  ///< whose value is a signal: see signals
  Loops loops;
  VectorXd initial_q, initial_u;          ///< with closed loops; empty: as the records say
  std::vector<Closing> initial_closings;  ///< likewise
  std::vector<std::unique_ptr<const ForceElement>> elements;
  std::vector<Latch> latches;
  SignalGraph signals;
  bool signals_are_sound = true;  ///< sensors, controllers and actuators have no errors
  GravityField gravity;
  std::vector<double> breakpoints, landmarks;
  double start = 0;
  bool is_lagged = false;                             ///< bodies are stiffened by blocks of signals, not by themselves
  std::vector<bool> sound;                            ///< by body: its record and its hinge have no errors
  std::vector<std::unique_ptr<Recovery>> recoveries;  ///< by body; nullptr: nothing is recovered of it
  /// By body; what would stiffen those whose stiffening is off. nullptr: it is on, or the file has nothing.
  std::vector<std::shared_ptr<const StiffeningTerms>> left_out;
};

class SystemData {
 public:
  TreeData tree;
  LoopData loops;
  std::vector<ForceResult> elements;  ///< of add_forces; zero before it
  SignalData signals;
  VectorXd tangent;  ///< num_u, scratch
};

}  // namespace bough::solver
