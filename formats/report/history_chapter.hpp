#pragma once
/// \file The chapter of a run: histories, energy, momentum, reactions, events, the moving system.
#include <string>
#include <utility>
#include <vector>

#include "formats/records/results.hpp"
#include "formats/report/drawing.hpp"
#include "formats/report/page.hpp"

namespace bough::report {

struct HistoryChannel {
  std::string path, description, dims;
  Eigen::MatrixXd values;  ///< nt x size
};

/// A body of the moving system; its channels are /bodies/NAME/... .
struct SceneBody {
  std::string name;
  Drawing drawing;
  double size = 0;  ///< of the flexible body, against which deflections are held; 0: rigid or not known
};

/// Drawn at a point of the parent: p in its frame (ground: inertial), which goes with its point `point` when >= 0.
struct SceneHinge {
  std::string name, type;
  int parent = -1;  ///< index of a body; -1: ground
  int point = -1;
  Eigen::Vector3d p = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::Zero();  ///< axis zero: none
};

struct History {
  std::string file, name;
  std::vector<std::pair<std::string, std::string>> facts;     ///< of the file: versions, sources
  std::vector<std::pair<std::string, std::string>> settings;  ///< of the run
  Eigen::VectorXd time;
  std::vector<HistoryChannel> channels;
  std::vector<records::EventRecord> events;
  std::string system_text;
  bool completed = false;
  std::string reason;
  double energy_error = 0, energy_error_limit = 1e-2;  ///< NaN where the file does not say
  std::vector<SceneBody> bodies;
  std::vector<SceneHinge> hinges;
  std::vector<std::string> missing;  ///< why bodies are not drawn
};

/// Adds /energy/balance to the channels where the energies are there: the script could not tell it from packed ones.
Chapter make_chapter(History history);

}  // namespace bough::report
