// Steps an arm from outside: a PD controller at 1 kHz. host_cpp [SYSTEM.toml]
#include <bough.hpp>
#include <cstdio>

int main(int argc, char** argv) {
  try {
    const auto model = bough::Model::load(argc > 1 ? argv[1] : "system.toml");
    const int torque = model.find_input("torque"), angle = model.find_output("angle"), rate = model.find_output("rate");
    bough::Simulation simulation(model);
    for (int k = 0; k <= 1000; ++k) {
      const double phi = simulation.output(angle), omega = simulation.output(rate);
      if (k % 200 == 0) std::printf("%6.3f%15.10f%15.10f\n", simulation.time(), phi, omega);
      simulation.set_input(torque, 60.0 * (0.5 - phi) - 12.0 * omega);
      if (simulation.advance_to(0.001 * (k + 1)) == bough::Reached::Terminated) {
        std::fprintf(stderr, "%s\n", simulation.reason().c_str());
        return 1;
      }
    }
  } catch (const bough::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
