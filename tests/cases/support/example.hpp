#pragma once
/// \file The whole way in memory: deck, body file, reduction, system file, run. No files are written.
#include <map>
#include <string>

#include "formats/records/body_spec.hpp"
#include "formats/records/deck.hpp"
#include "solver/simulate/memory_sink.hpp"
#include "solver/simulate/simulate.hpp"

namespace bough::test {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

struct Example {
  records::SystemSpec spec;
  std::map<std::string, records::FlexBody> flex;  ///< by file name as in spec

  solver::System build() const;
  /// Runs spec.simulation; throws what simulate throws.
  solver::SimulateOutcome run(solver::MemorySink& sink) const;
};

/// A system file of data/examples/FOLDER with its body files, decks read and reduced anew.
Example load_example(const std::string& folder, const std::string& system_file);

records::FlexBody reduce(const records::Deck& deck, const records::BodySpec& spec);

/// A computed number into the test's XML report, with all its digits.
void record(const std::string& name, double value);
/// Row of the smallest value.
int find_minimum(const VectorXd& v);
/// Index of the sample at t; BOUGH_DEMAND that there is one.
int find_sample(const VectorXd& time, double t);
/// Half of the span of v over the samples from t_from on.
double calc_amplitude(const VectorXd& time, const VectorXd& v, double t_from);
/// kinetic + strain + potential - work.
VectorXd calc_energy_balance(const solver::MemorySink& sink);
/// Largest change of the energy balance, relative to the largest kinetic energy; recorded under the name.
double record_energy_drift(const solver::MemorySink& sink, const std::string& name);

}  // namespace bough::test
