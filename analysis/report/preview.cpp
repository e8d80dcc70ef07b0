#include "analysis/report/preview.hpp"

#include <atomic>

#include "analysis/common/inputs.hpp"
#include "analysis/common/system_files.hpp"
#include "analysis/report/report_files.hpp"
#include "analysis/run/provenance_sink.hpp"
#include "base/file_roles.hpp"
#include "base/temporary_folder.hpp"
#include "formats/hdf5/files.hpp"
#include "solver/simulate/simulate.hpp"

namespace bough::analysis {

report::Chapter make_preview(const std::string& file, const std::string& text, Diagnostics& diagnostics) {
  LoadOptions load;
  load.text = text;
  const auto loaded = load_system(file, diagnostics, load);
  diagnostics.throw_if_errors();
  const auto sources = calc_sources(collect_sources(file, loaded));
  ReportRequest request;
  for (const auto& [written, path] : loaded.flex_path) request.files.push_back(path);
  confine_files({});  // all inputs are read; the samples pass through the folder for temporary files
  const TemporaryFolder folder("bough-studio", "the samples");
  const std::string samples = folder.path() + "/samples.h5";
  const auto writer = hdf5::make_results_writer(samples);
  ProvenanceSink sink(*writer, sources);
  const std::atomic<bool> stop{true};
  solver::SimulateOptions options;
  options.stop = &stop;
  solver::simulate(loaded.system, loaded.spec, sink, options, diagnostics);
  sink.finish();
  return make_results_chapter(samples, request, diagnostics);
}

}  // namespace bough::analysis
