#pragma once
/// \file Bough's HDF5 files (docs/formats): flexible body, modes, results. Written to a temporary name and renamed:
/// whole or not at all (results: readable while they grow, finished or not).
#include <chrono>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "formats/records/flex_body.hpp"
#include "formats/records/modes.hpp"
#include "formats/records/results.hpp"
#include "formats/records/static_result.hpp"

namespace bough::hdf5 {

class FileWriter;

/// Throw InputError: "hdf5.cannot-open", "hdf5.truncated", "hdf5.wrong-format", "hdf5.missing", "hdf5.shape";
/// ComputationError "hdf5.write" (disk full, no permission).
void write_flex_body(const records::FlexBody& body, const std::string& path);
/// Reads a flexible body; throws as write_flex_body().
records::FlexBody read_flex_body(const std::string& path);

/// Writes real modes or buckling load factors of a deck.
void write_modes(const records::ModesResult& modes, const std::string& path);
/// Reads the file of write_modes().
records::ModesResult read_modes(const std::string& path);

/// Writes static solutions with all their subcases at once.
void write_static(const records::StaticResult& result, const std::string& path);
/// The bytes of that file, without a file.
std::string make_static_image(const records::StaticResult& result);
/// Writes the file of write_static one subcase after the other, without keeping them. commit() makes the file appear.
class StaticWriter {
 public:
  explicit StaticWriter(const std::string& path);
  ~StaticWriter();
  StaticWriter(const StaticWriter&) = delete;
  StaticWriter& operator=(const StaticWriter&) = delete;
  /// Writes one subcase.
  void add(const records::StaticSubcase& subcase);
  /// Starts to write the subcases so far to disk, in the background.
  void start_sync();
  /// Writes the results common to all subcases: `whole` without its subcases. The file appears now.
  void commit(const records::StaticResult& whole);

 private:
  std::unique_ptr<FileWriter> file_;
};
/// All but extremes, forces on grids and strains at corners.
records::StaticResult read_static(const std::string& path);
/// Writes K, M, B and geometric stiffness matrices as sparse arrays.
void write_matrices(const records::MatricesResult& result, const std::string& path);
/// The bytes of that file, without a file.
std::string make_matrices_image(const records::MatricesResult& result);

struct ResultsWriterOptions {
  int flush_every = 100;  ///< samples after which it is looked whether a commit is due, where commit_every is zero
  /// Between commits: samples are in the file for good, and are counted, from the next commit on.
  std::chrono::milliseconds commit_every{1000};
};
/// A sink that writes `path` as it goes (docs/formats/results.md): the file is whole at every instant.
std::unique_ptr<records::ResultSink> make_results_writer(const std::string& path,
                                                         const ResultsWriterOptions& options = {});
/// A sink that continues the file from its checkpoint at `resume_time`. The file is replaced, by one with the samples
/// and events up to the checkpoint and new ones, when this has as many samples.
std::unique_ptr<records::ResultSink> make_results_appender(const std::string& path, double resume_time,
                                                           const ResultsWriterOptions& options = {});

/// A results file read back.
struct ResultsFile {
  Eigen::VectorXd time;
  std::map<std::string, Eigen::MatrixXd> channels;  ///< path -> nt x size
  std::map<std::string, std::string> descriptions;
  std::map<std::string, std::string> dims, units;  ///< by path, /time too; units are empty without [units]
  std::vector<records::EventRecord> events;
  std::string system_text;
  bool completed = false;
  std::string reason;
  double energy_error = std::numeric_limits<double>::quiet_NaN();  ///< worst of the run, relative; NaN: not given
};
/// Reads all samples and events of a results file; repeats while the file is being written.
ResultsFile read_results(const std::string& path);
/// Inputs of the run of a results file, and its outcome.
struct RunInputs {
  std::string system_text;
  std::vector<std::pair<std::string, std::string>> source;  ///< (file name, SHA-256)
  bool completed = false;
  std::string reason;
};
/// Reads the inputs and the outcome alone, without the samples. Throws as read_results().
RunInputs read_run_inputs(const std::string& path);
/// Events of a results file: time, text and source.
std::vector<records::EventRecord> read_events(const std::string& path);
/// Reads the checkpoint of a results file. Throws InputError "hdf5.missing" if the file has none.
records::Checkpoint read_checkpoint(const std::string& path);
/// Nothing where the run has come to none yet.
std::optional<records::Checkpoint> find_checkpoint(const std::string& path);

/// Progress of the run of a results file, without its samples.
struct RunState {
  bool completed = false;
  std::string reason;       ///< why it ended; "running": it goes on, or was killed
  double time = 0;          ///< of the last sample
  bool is_written = false;  ///< a process of Bough is at it now
};
/// Reads the state of a run, also while it goes on. Throws as read_results().
RunState read_run_state(const std::string& path);

/// One line per object: path, shape, type, description; for `info`.
struct ObjectInfo {
  std::string path, shape, type, description, dims;
};
struct FileInfo {
  std::map<std::string, std::string> attributes;  ///< of the root
  std::vector<ObjectInfo> objects;
};
/// Lists attributes and objects of any HDF5 file. Throws InputError "hdf5.cannot-open".
FileInfo read_info(const std::string& path);

/// SHA-256 of a file's bytes, hex.
std::string calc_sha256(const std::string& path);

}  // namespace bough::hdf5
