#pragma once
/// \file The chapter of a run: histories, energy, momentum, reactions, events, the moving system.
#include <string>
#include <utility>
#include <vector>

#include "formats/records/results.hpp"
#include "formats/records/unit_labels.hpp"
#include "report/page.hpp"
#include "report/scene.hpp"

namespace bough::report {

struct HistoryChannel {
  std::string path, description, dims;
  Eigen::MatrixXd values;        ///< nt x size
  std::string unit{};            ///< in labels, otherwise the dimensions; of components that differ a list
  std::vector<bool> is_noise{};  ///< of each column: constant or below 1e-9 of the channels of its unit

  /// Returns the unit of a column; empty if it has none.
  std::string get_unit(Eigen::Index column) const {
    return records::pick_unit(unit, static_cast<int>(column), static_cast<int>(values.cols()));
  }
};

struct History {
  std::string file, name;
  std::vector<std::pair<std::string, std::string>> facts;     ///< of the file: versions, sources
  std::vector<std::pair<std::string, std::string>> settings;  ///< of the run
  Eigen::VectorXd time;
  std::string time_unit = "T";
  std::vector<HistoryChannel> channels;
  std::vector<records::EventRecord> events;
  std::string system_text;
  bool completed = false;
  std::string reason;
  double energy_error = 0, energy_error_limit = 1e-2;  ///< NaN where the file does not say
  Scene scene;
  std::vector<std::string> missing;  ///< what is not drawn, and why
};

/// Adds /energy/balance to the channels where the energies are there: the script could not tell it from packed ones.
Chapter make_chapter(History history);

}  // namespace bough::report
