#pragma once
/// \file One body on one hinge, and whole runs in memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/builder/build_system.hpp"
#include "solver/simulate/memory_sink.hpp"
#include "solver/simulate/simulate.hpp"
#include "tests/solver/support/records.hpp"

namespace bough::solver::testing {

using records::HingeType;
using ::testing::HasSubstr;

/// 2 mass, inertia (1, 2, 3), on a hinge "hinge" to ground; a second in steps of 0.1.
inline records::SystemSpec make_one_body(HingeType type) {
  records::SystemSpec spec;
  spec.bodies = {make_body_record("body", 2, {1, 2, 3})};
  spec.hinges = {make_hinge_record("hinge", type, "ground", "body")};
  spec.simulation.duration = 1;
  spec.simulation.output_step = 0.1;
  spec.simulation.at = {"system.toml", 20, 1};
  return spec;
}

/// make_one_body on a slide with a spring: 2 ẍ = -18 x, x = cos(3t) / 2.
inline records::SystemSpec make_spring_mass() {
  auto spec = make_one_body(HingeType::Prismatic);
  spec.hinges[0].stiffness = {18};
  spec.hinges[0].position = {0.5};
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

/// A run with samples every `output_step` whose tolerances are `tolerance`.
inline RunResult run_closely(records::SystemSpec spec, double duration, double output_step, double tolerance,
                             const std::map<std::string, records::FlexBody>& flex = {}) {
  spec.simulation.duration = duration;
  spec.simulation.output_step = output_step;
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = tolerance;
  return run(spec, flex);
}

/// The messages of the failure that a run of a valid system ends with, and the samples before it.
template <class Expected = Failure>
std::vector<Diagnostic> run_to_failure(const records::SystemSpec& spec, MemorySink& sink) {
  const System system = build(spec);
  Diagnostics diagnostics;
  try {
    simulate(system, spec, sink, {}, diagnostics);
  } catch (const Expected& failure) {
    return failure.items();
  }
  ADD_FAILURE() << "no failure";
  return {Diagnostic{}};
}
template <class Expected = Failure>
std::vector<Diagnostic> run_to_failure(const records::SystemSpec& spec) {
  MemorySink sink;
  return run_to_failure<Expected>(spec, sink);
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
