#pragma once
/// \file Body files of the parts and the system file that joins them.
#include <string>
#include <vector>

#include "analysis/split/assembly.hpp"
#include "formats/records/body_spec.hpp"

namespace bough::analysis::splitting {

struct PartNames {
  std::string base;  ///< NAME of NAME-1.bdf, NAME-1.toml, NAME-1.h5, NAME-run.toml
  std::string deck;  ///< the deck that was split, in comments

  /// Returns "NAME-1" for part 0.
  std::string get_part(int part) const { return base + "-" + std::to_string(part + 1); }
};

/// The reduction of a part: Craig-Bampton on its cuts, normal modes for a part with one cut, which carries it.
/// \param max_hz  [1/T] highest frequency of its modes, with its cuts held
records::BodySpec make_part_spec(const PartNames& names, const Structure& structure, const Assembly& assembly, int part,
                                 double max_hz);

/// `spec` as a body file.
std::string write_part_file(const PartNames& names, const Assembly& assembly, int part, const records::BodySpec& spec);

/// The system of the parts under gravity along -z. Its integrator does not follow the fastest modes of the parts.
/// \param whole_hz  [1/T] elastic frequencies of the deck that are compared: 500 steps in the period of the first
std::string write_system_file(const PartNames& names, const Structure& structure, const Assembly& assembly,
                              const Eigen::VectorXd& whole_hz);

}  // namespace bough::analysis::splitting
