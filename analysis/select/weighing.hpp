#pragma once
/// \file Models by which modes are ranked, and the model of a body alone.
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/flex_body.hpp"
#include "solver/statespace/mode_ranking.hpp"

namespace bough::analysis {

struct SelectRequest {
  std::string body;                  ///< file, for messages; empty: all flexible bodies of the systems
  std::vector<std::string> systems;  ///< files; none: the body alone
  std::vector<std::string> set;      ///< "name=value" of [parameters]
  std::vector<std::string> inputs, outputs, weights;
  std::string spectrum;             ///< file of the spectrum of the inputs; empty: white noise
  std::vector<std::string> pinned;  ///< modes that are kept, from 1: "3"; of all bodies of a system "boom:3"
  int number = 0;                   ///< of modes kept; 0: by tolerance or frequency
  std::optional<double> tolerance;
  double below_hz = 0, damping = 0.01;
  std::vector<double> at;
  bool equilibrium = false, open = false;
  bool exchange = false;  ///< retained and dropped modes are exchanged as long as the outputs lose less
};

/// One configuration: full model and costs; how the modes kept do instead.
struct Weighing {
  std::string name;
  statespace::ModeRanking ranking;
  statespace::StateSpace full;
  std::function<statespace::StateSpace(const std::vector<int>&)> reduce;
  std::optional<statespace::Spectrum> spectrum;

  /// Mean square of what the outputs lose by keeping these modes only, to V.
  double calc_lost(const std::vector<int>& kept) const;
};

/// The places of a body alone: named ("12", "12:z", outputs also "12:vz" and "12:wz" for rates), else the translations
/// of the interface nodes that move, else of all nodes. `weights`: "12:z=3". InputError "select.unknown-node",
/// "select.unknown-direction", "select.bad-weight".
std::vector<statespace::NodeDirection> choose_places(const records::FlexBody& body,
                                                     const std::vector<std::string>& words,
                                                     const std::vector<std::string>& weights, bool may_be_rates,
                                                     const std::string& file);

/// Ranks the modes of a body without a system: costs of the paths from `inputs` to `outputs` with the modal damping of
/// `o`, weighted by its spectrum of inputs if it has one.
Weighing weigh_alone(const SelectRequest& o, const records::FlexBody& body,
                     const std::vector<statespace::NodeDirection>& inputs,
                     const std::vector<statespace::NodeDirection>& outputs);

}  // namespace bough::analysis
