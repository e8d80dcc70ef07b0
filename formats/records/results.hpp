#pragma once
/// \file The seam through which a running solver hands out its results (docs/formats/results.md).
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::records {

/// One channel: its HDF5 path, components per sample, and what it is.
struct Channel {
  std::string path;  ///< "/bodies/boom/eta"
  int size = 1;
  std::string description;  ///< with its frame
  std::string dims;         ///< "L", "L/T", "1", ...
};

struct ResultsHeader {
  std::string system_text;                                    ///< the TOML it ran from
  std::vector<std::pair<std::string, std::string>> source;    ///< (file name, SHA-256)
  std::vector<std::pair<std::string, std::string>> settings;  ///< effective values, as text
  std::vector<Channel> channels;                              ///< "/time" first
};

struct EventRecord {
  double time = 0;
  std::string what;
};

struct Checkpoint {
  double time = 0;
  Eigen::VectorXd state;
};

/// Implemented in formats/hdf5 and passed in by cli: results stream out without the solver knowing HDF5.
class ResultSink {
 public:
  virtual ~ResultSink() = default;
  virtual void begin(const ResultsHeader& header) = 0;
  /// One sample: the channels' components one after another, in the header's order (time first).
  virtual void write_sample(const Eigen::Ref<const Eigen::VectorXd>& sample) = 0;
  virtual void write_event(const EventRecord& event) = 0;
  virtual void write_checkpoint(const Checkpoint& checkpoint) = 0;
  /// Flush and close; `completed` tells a whole run from one that stopped early.
  virtual void end(bool completed, const std::string& reason) = 0;
};

}  // namespace bough::records
