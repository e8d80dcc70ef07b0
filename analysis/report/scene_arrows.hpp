#pragma once
/// \file Arrows of forces and moments on the moving system.
#include <map>
#include <string>

#include "formats/records/system_spec.hpp"
#include "report/history_chapter.hpp"

namespace bough::analysis {

/// Where nodes are on the bodies of the scene; both live longer than this.
class ScenePlaces {
 public:
  ScenePlaces(const records::SystemSpec& spec, const report::Scene& scene);
  /// -1: ground, or a body that is not there.
  int find_body(const std::string& name) const;
  /// `offset` from the node, in the body's frame; of ground: the place itself.
  report::ScenePlace find(const std::string& body, int node,
                          const Eigen::Vector3d& offset = Eigen::Vector3d::Zero()) const;

 private:
  const records::SystemSpec& spec_;
  const report::Scene& scene_;
  std::map<std::string, int> index_;
};

/// [[force]]s, actuators that push, reactions of hinges and constraints; loads without arrow are in
/// history.missing.
void add_arrows(const records::SystemSpec& spec, const ScenePlaces& places, report::History& history);

}  // namespace bough::analysis
