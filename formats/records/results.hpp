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
  std::string units{};      ///< the same in the labels of [units]: "m/s"; empty: not given
};

struct ResultsHeader {
  std::string system_text;                                    ///< the TOML it ran from
  std::vector<std::pair<std::string, std::string>> source;    ///< (file name, SHA-256)
  std::vector<std::pair<std::string, std::string>> settings;  ///< effective values, as text
  std::vector<Channel> channels;                              ///< "/time" first
  long max_samples = 0;                                       ///< upper bound of their number; 0: not known
};

struct EventRecord {
  double time = 0;
  std::string what;
  std::string source{};  ///< what it happened to, kind and name: "event low", "hinge pivot"; empty: the run
};

struct Checkpoint {
  double time = 0;
  Eigen::VectorXd state;
  /// Other state of the run, by name: energy so far, warnings given, the current step.
  std::vector<std::pair<std::string, Eigen::VectorXd>> memory;
  /// Number of samples and events before the checkpoint in its file; -1: not known.
  long num_samples = -1, num_events = -1;

  /// The part of that name, nullptr when it holds none.
  const Eigen::VectorXd* find(const std::string& name) const {
    for (const auto& [key, values] : memory) {
      if (key == name) return &values;
    }
    return nullptr;
  }
};

/// Implemented in formats/hdf5 and passed in by cli: results stream out without the solver knowing HDF5.
class ResultSink {
 public:
  virtual ~ResultSink() = default;
  /// Starts the results; called once, before all samples.
  virtual void begin(const ResultsHeader& header) = 0;
  /// One sample: the channels' components one after another, in the header's order (time first).
  virtual void write_sample(const Eigen::Ref<const Eigen::VectorXd>& sample) = 0;
  /// Receives an event, in the order of time.
  virtual void write_event(const EventRecord& event) = 0;
  /// Receives a state to continue from; it replaces the one before.
  virtual void write_checkpoint(const Checkpoint& checkpoint) = 0;
  /// The worst relative energy error so far: with each checkpoint, and before the end.
  virtual void write_energy_error(double) {}
  /// Makes everything written so far safe on the disk: before anything that may end the program.
  virtual void flush() {}
  /// Flush and close; `completed` tells a whole run from one that stopped early.
  virtual void end(bool completed, const std::string& reason) = 0;
};

}  // namespace bough::records
