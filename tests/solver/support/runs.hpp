#pragma once
/// \file One body on one hinge, and whole runs in memory.
#include <gtest/gtest.h>

#include "solver/builder/build_system.hpp"
#include "solver/simulate/memory_sink.hpp"
#include "solver/simulate/simulate.hpp"
#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {

/// 2 mass, inertia (1, 2, 3), on a hinge "hinge" to ground; a second in steps of 0.1.
inline records::SystemSpec make_one_body(records::HingeType type) {
  records::SystemSpec spec;
  records::BodyRecord b;
  b.name = "body";
  b.mass = 2;
  b.inertia = Vector3d(1, 2, 3).asDiagonal();
  spec.bodies = {b};
  spec.hinges = {make_hinge_record("hinge", type, "ground", "body")};
  spec.simulation.duration = 1;
  spec.simulation.output_step = 0.1;
  spec.simulation.at = {"system.toml", 20, 1};
  return spec;
}

struct RunResult {
  MemorySink sink;
  SimulateOutcome outcome;
  Diagnostics diagnostics;
};

inline RunResult run(const records::SystemSpec& spec, const std::map<std::string, records::FlexBody>& flex = {},
                     const SimulateOptions& options = {}) {
  RunResult r;
  const System system = build_system(spec, flex, r.diagnostics);
  r.outcome = simulate(system, spec, r.sink, options, r.diagnostics);
  return r;
}

/// The samples of a run to its end whose energy balance holds.
inline MemorySink run_kept(const records::SystemSpec& spec, double energy_error = 1e-9) {
  const RunResult r = run(spec);
  EXPECT_TRUE(r.outcome.completed);
  EXPECT_LT(r.sink.energy_error(), energy_error);
  return r.sink;
}

inline double get_last(const MemorySink& sink, const std::string& path, int component = 0) {
  return sink.get(path)(sink.num_samples() - 1, component);
}

}  // namespace bough::solver::testing
