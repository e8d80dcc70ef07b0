// Reads a system file, runs it, and prints the last time and the last angle: an outside user of the libraries.
#include <cstdio>

#include "bough/formats/toml/specs.hpp"
#include "bough/solver/builder/build_system.hpp"
#include "bough/solver/simulate/simulate.hpp"

namespace {
class LastSample final : public bough::records::ResultSink {
 public:
  void begin(const bough::records::ResultsHeader& header) override {
    int first = 0;
    for (const auto& channel : header.channels) {
      if (channel.path == "/sensors/angle") index_ = first;
      first += channel.size;
    }
  }
  void write_sample(const Eigen::Ref<const Eigen::VectorXd>& sample) override {
    time = sample[0];
    angle = sample[index_];
  }
  void write_event(const bough::records::EventRecord&) override {}
  void write_checkpoint(const bough::records::Checkpoint&) override {}
  void end(bool, const std::string&) override {}
  double time = 0, angle = 0;

 private:
  int index_ = 0;
};
}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  bough::Diagnostics diagnostics;
  const auto spec = bough::toml_files::read_system_spec(argv[1], diagnostics);
  diagnostics.throw_if_errors();
  const auto system = bough::solver::build_system(spec, {}, diagnostics);
  LastSample sink;
  bough::solver::simulate(system, spec, sink, {}, diagnostics);
  std::printf("%.9f %.9f\n", sink.time, sink.angle);
  return 0;
}
