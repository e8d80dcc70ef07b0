#pragma once
/// \file Dependencies of derivatives, outputs and event functions at one time: for modelDescription.xml of FMUs.
#include <optional>
#include <string>
#include <vector>

#include "formats/records/system_spec.hpp"
#include "solver/system/system.hpp"

namespace bough::embed {

/// Represents a set of states and inputs; may contain more than what has an effect, never less.
struct Dependencies {
  std::vector<int> states;  ///< rows of x, ascending
  std::vector<int> inputs;  ///< ascending
  bool on_time = true;
  bool is_constant = false;  ///< a constant factor times the only state
};

/// Follows signals upstream. Values that change at events only (samples, switches, modes) depend on nothing.
class DependencyGraph {
 public:
  /// Both must outlive it.
  DependencyGraph(const solver::System& system, const records::SystemSpec& spec);

  /// Dependencies of the derivative of row `row` of x.
  Dependencies find_of_derivative(int row) const;
  /// Dependencies of all components of a channel; nullopt: on everything.
  std::optional<Dependencies> find_of_channel(const std::string& path) const;
  /// \param i  of `count` event functions in the order of solver::Simulator. nullopt: of everything.
  std::optional<Dependencies> find_of_event_function(int i, int count) const;

 private:
  struct Set {
    std::vector<bool> q, u, z, inputs;
    /// Forms the union with `other`, which has equal sizes.
    void add(const Set& other);
  };
  Set make_set() const;
  Dependencies make(const Set& set) const;
  void add_source(int value, Set& set) const;
  void add_sources(const solver::BlockSlot& place, Set& set) const;
  void add_motion(const solver::BlockSlot& place, Set& set) const;
  /// Finds the dependencies of the outputs of all blocks; those of accelerations are known before.
  void follow_signals();
  /// Dependencies of the outputs of a block, after those of its sources.
  Set find_of_block(const solver::BlockSlot& place) const;
  /// Adds chains of hinges and modes from ground to a body.
  void add_chain(int body, bool with_rates, Set& set) const;

  const solver::System& system_;
  const records::SystemSpec& spec_;
  std::vector<int> block_of_;  ///< of each value of the signals
  std::vector<int> input_of_;  ///< of each block; -1: it is no input
  Set accelerations_;
  std::vector<Set> of_outputs_;  ///< of each block
};

}  // namespace bough::embed
