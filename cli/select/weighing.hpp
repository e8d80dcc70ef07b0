#pragma once
/// \file Models by which modes are ranked: a body alone or a system in one or several configurations.
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/common/options.hpp"
#include "formats/records/flex_body.hpp"
#include "solver/statespace/mode_ranking.hpp"

namespace bough::cli {

struct SelectOptions : CommonOptions {
  std::vector<std::string> set;
  std::string body, spectrum, response;
  std::vector<std::string> systems;
  std::vector<std::string> inputs, outputs, weights;
  std::vector<int> pinned;
  int number = 0, inertial_load = 0;
  std::optional<double> tolerance;
  double below_hz = 0, damping = 0.01;
  std::vector<double> at;
  bool equilibrium = false, open = false;
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

Weighing weigh_alone(const SelectOptions& o, const records::FlexBody& body,
                     const std::vector<statespace::NodeDirection>& inputs,
                     const std::vector<statespace::NodeDirection>& outputs);

/// Every system file at every time asked for.
std::vector<Weighing> weigh_in_systems(const SelectOptions& o, const records::FlexBody& body, Diagnostics& diagnostics);

}  // namespace bough::cli
