#include "tests/cases/support/example.hpp"
#include "solver/builder/build_system.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "formats/nastran/reader.hpp"
#include "formats/toml/specs.hpp"
#include "stiffening/reduce.hpp"
#include "tests/support/paths.hpp"

namespace bough::test {

namespace fs = std::filesystem;

records::FlexBody reduce(const records::Deck& deck, const records::BodySpec& spec) {
  Diagnostics diagnostics;
  auto body = stiffening::reduce(deck, spec, {}, diagnostics).body;
  diagnostics.throw_if_errors();
  return body;
}

Example load_example(const std::string& folder, const std::string& system_file) {
  const fs::path dir = fs::path(BOUGH_SOURCE_DIR) / "data/examples" / folder;
  Diagnostics diagnostics;
  Example example;
  example.spec = toml_files::read_system_spec((dir / system_file).string(), diagnostics);
  for (const auto& entry : fs::directory_iterator(dir)) {
    if (entry.path().extension() != ".toml" || toml_files::detect_kind(entry.path().string()) != "body") continue;
    const auto body = toml_files::read_body_spec(entry.path().string(), diagnostics);
    const auto deck = nastran::read_deck((dir / fs::path(body.deck).filename()).string(), {}, diagnostics);
    diagnostics.throw_if_errors();
    const fs::path output = body.output_file.empty() ? body.name + ".h5" : body.output_file;
    const auto flex = reduce(deck, body);
    for (const auto& record : example.spec.bodies)
      if (fs::path(record.file).filename() == output.filename()) example.flex[record.file] = flex;
  }
  diagnostics.throw_if_errors();
  return example;
}

solver::System Example::build() const {
  Diagnostics diagnostics;
  return solver::build_system(spec, flex, diagnostics);
}

solver::SimulateOutcome Example::run(solver::MemorySink& sink) const {
  Diagnostics diagnostics;
  const solver::System system = build();
  return solver::simulate(system, spec, sink, {}, diagnostics);
}

void record(const std::string& name, double value) {
  std::ostringstream text;
  text.precision(10);
  text << value;
  ::testing::Test::RecordProperty(name, text.str());
}

int find_minimum(const VectorXd& v) {
  int row = 0;
  v.minCoeff(&row);
  return row;
}

int find_sample(const VectorXd& time, double t) {
  for (int i = 0; i < time.size(); ++i) {
    if (std::abs(time[i] - t) < 1e-9) return i;
  }
  BOUGH_DEMAND(!"no sample at this time");
  return -1;
}

double calc_amplitude(const VectorXd& time, const VectorXd& v, double t_from) {
  const auto tail = v.tail(time.size() - find_sample(time, t_from));
  return (tail.maxCoeff() - tail.minCoeff()) / 2;
}

VectorXd calc_energy_balance(const solver::MemorySink& sink) {
  return sink.get("/energy/kinetic") + sink.get("/energy/strain") + sink.get("/energy/potential") -
         sink.get("/energy/work");
}

double record_energy_drift(const solver::MemorySink& sink, const std::string& name) {
  const VectorXd balance = calc_energy_balance(sink);
  const double drift = (balance.array() - balance[0]).abs().maxCoeff() / sink.get("/energy/kinetic").maxCoeff();
  record(name, drift);
  return drift;
}

}  // namespace bough::test
