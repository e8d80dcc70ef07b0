#include "solver/simulate/energy_monitor.hpp"

#include <gtest/gtest.h>

namespace bough::solver::testing {
namespace {

Energies make_energies(double kinetic, double strain) {
  Energies e;
  e.kinetic = kinetic;
  e.strain = strain;
  return e;
}

TEST(EnergyMonitor, AWorstErrorOutlivesALastOneOfZero) {
  EnergyMonitor monitor;
  monitor.start(make_energies(2, 2), 0);
  monitor.add(1, make_energies(4, 0.5), 0, 0);
  EXPECT_NEAR(monitor.latest(), 0.5 / 4, 1e-15);
  monitor.add(2, make_energies(1, 3), 0, 0);
  EXPECT_EQ(monitor.latest(), 0);
  EXPECT_NEAR(monitor.worst(), 0.5 / 4, 1e-14);
  EXPECT_EQ(monitor.time_of_worst(), 1);
  VectorXd memory(EnergyMonitor::kMemory);
  monitor.get_memory(memory);
  EnergyMonitor resumed;
  resumed.set_memory(memory);
  EXPECT_EQ(resumed.worst(), monitor.worst());
}

// Work of forces along a rounding of the system's size is no error, however small all energies are.
TEST(EnergyMonitor, ForcesThatNothingGivesWayToAreRounding) {
  EnergyMonitor monitor;
  monitor.start(make_energies(0, 0), 1e-17);
  monitor.add(1, make_energies(0, 0), 2e-16, 100);
  EXPECT_EQ(monitor.worst(), 0);
  monitor.add(2, make_energies(0, 0), 2e-10, 100);
  EXPECT_NEAR(monitor.worst(), 1, 1e-3);
}

}  // namespace
}  // namespace bough::solver::testing
