// Computes the modes of a deck by the installed bough::analysis and prints the first frequency.
#include <cstdio>

#include "bough/analysis/modes/modes.hpp"

namespace {
struct First final : bough::analysis::ModesReceiver {
  void take(bough::analysis::SubcaseModes& modes, bough::Diagnostics&) override { hz = modes.result.frequency_hz[0]; }
  void take(bough::records::ComplexModesResult&, bough::Diagnostics&) override {}
  double hz = 0;
};
}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  bough::analysis::ModesRequest request;
  request.deck = argv[1];
  First first;
  bough::analysis::Events events;
  bough::analysis::solve_modes(request, first, events);
  std::printf("%.9f\n", first.hz);
}
