#pragma once
/// \file Objects of the handles of bough.h, for the other interfaces of the library.
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <unordered_set>

#include "embed/bough.h"
#include "embed/model.hpp"
#include "embed/simulation.hpp"

struct bough_model {
  std::shared_ptr<const bough::embed::Model> model;
};

struct bough_simulation {
  std::shared_ptr<const bough::embed::Model> model;
  std::unique_ptr<bough::embed::Simulation> own;
  std::string message;
  bool has_failed = false;

  /// Returns the simulator that the handle steps.
  bough::solver::Simulator& simulator() const { return own->simulator(); }
};

namespace bough::embed {

/// Represents the set of live handles: a released or foreign pointer is reported, not dereferenced. Thread-safe.
class Handles {
 public:
  /// Registers a handle.
  void add(const void* handle) {
    const std::unique_lock held(mutex_);
    alive_.insert(handle);
  }
  /// Removes a handle. Returns false if it was not registered.
  bool remove(const void* handle) {
    const std::unique_lock held(mutex_);
    return alive_.erase(handle) > 0;
  }
  /// Returns true if the handle is registered.
  bool has(const void* handle) {
    const std::shared_lock held(mutex_);
    return alive_.count(handle) > 0;
  }

 private:
  std::shared_mutex mutex_;
  std::unordered_set<const void*> alive_;
};
/// Returns the registered models of the process.
Handles& get_model_handles();
/// Returns the registered simulations of the process.
Handles& get_simulation_handles();

/// Starts a simulation and registers its handle; bough_stop() releases it.
///
/// \param spec  that of the model, with another [simulation] if needed.
/// \throws as solver::Simulator.
std::unique_ptr<bough_simulation> make_simulation(std::shared_ptr<const Model> model, records::SystemSpec spec);

}  // namespace bough::embed
