#include "analysis/report/preview.hpp"

#include <atomic>
#include <filesystem>

#include <unistd.h>

#include "analysis/common/inputs.hpp"
#include "analysis/common/system_files.hpp"
#include "analysis/report/report_files.hpp"
#include "analysis/run/provenance_sink.hpp"
#include "base/file_roles.hpp"
#include "formats/hdf5/files.hpp"
#include "solver/simulate/simulate.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

namespace {

/// A name in the folder for temporary files, removed at the end.
class TemporaryFile {
 public:
  TemporaryFile()
      : path_((fs::temp_directory_path() / ("bough-studio-" + std::to_string(::getpid()) + ".h5")).string()) {}
  ~TemporaryFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& get_path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

report::Chapter make_preview(const std::string& file, const std::string& text, Diagnostics& diagnostics) {
  LoadOptions load;
  load.text = text;
  const auto loaded = load_system(file, diagnostics, load);
  diagnostics.throw_if_errors();
  const auto sources = calc_sources(collect_sources(file, loaded));
  ReportRequest request;
  for (const auto& [written, path] : loaded.flex_path) request.files.push_back(path);
  confine_files({});  // all inputs are read; the samples pass through the folder for temporary files
  const TemporaryFile samples;
  const auto writer = hdf5::make_results_writer(samples.get_path());
  ProvenanceSink sink(*writer, sources);
  const std::atomic<bool> stop{true};
  solver::SimulateOptions options;
  options.stop = &stop;
  solver::simulate(loaded.system, loaded.spec, sink, options, diagnostics);
  sink.finish();
  return make_results_chapter(samples.get_path(), request, diagnostics);
}

}  // namespace bough::analysis
