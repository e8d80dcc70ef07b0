#include "analysis/report/preview.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <numbers>

#include "analysis/common/inputs.hpp"
#include "analysis/common/system_files.hpp"
#include "analysis/linearize/operating_point.hpp"
#include "analysis/report/report_files.hpp"
#include "analysis/run/provenance_sink.hpp"
#include "base/file_roles.hpp"
#include "base/temporary_folder.hpp"
#include "formats/hdf5/files.hpp"
#include "solver/linear/linearize.hpp"
#include "solver/simulate/channel_units.hpp"
#include "solver/simulate/outputs.hpp"
#include "solver/simulate/simulate.hpp"
#include "solver/statespace/poles.hpp"

namespace bough::analysis {

namespace {

LoadedSystem load_text(const std::string& file, const std::string& text, const std::vector<std::string>& set,
                       Diagnostics& diagnostics) {
  LoadOptions load;
  load.text = text;
  load.set = set;
  auto loaded = load_system(file, diagnostics, load);
  diagnostics.throw_if_errors();
  return loaded;
}

/// Chapter of the samples that `write` writes; they pass through the folder for temporary files.
report::Chapter make_sample_chapter(const std::string& file, const LoadedSystem& loaded,
                                    const std::function<void(records::ResultSink&)>& write, Diagnostics& diagnostics) {
  const auto sources = calc_sources(collect_sources(file, loaded));
  ReportRequest request;
  for (const auto& [written, path] : loaded.flex_path) request.files.push_back(path);
  confine_files({});  // all inputs are read
  const TemporaryFolder folder("bough-studio", "the samples");
  const std::string samples = folder.path() + "/samples.h5";
  const auto writer = hdf5::make_results_writer(samples);
  ProvenanceSink sink(*writer, sources);
  write(sink);
  sink.finish();
  return make_results_chapter(samples, request, diagnostics);
}

}  // namespace

report::Chapter make_preview(const std::string& file, const std::string& text, Diagnostics& diagnostics) {
  const auto loaded = load_text(file, text, {}, diagnostics);
  const auto write = [&](records::ResultSink& sink) {
    const std::atomic<bool> stop{true};
    solver::SimulateOptions options;
    options.stop = &stop;
    solver::simulate(loaded.system, loaded.spec, sink, options, diagnostics);
  };
  return make_sample_chapter(file, loaded, write, diagnostics);
}

records::LinearModel linearize_text(const LinearizeRequest& request, const std::string& text,
                                    Diagnostics& diagnostics) {
  return linearize(request, load_text(request.file, text, request.set, diagnostics), diagnostics);
}

report::Chapter make_pole_motion(const LinearizeRequest& request, const std::string& text, int pole,
                                 Diagnostics& diagnostics) {
  const auto loaded = load_text(request.file, text, request.set, diagnostics);
  const auto model = linearize(request, loaded, diagnostics);
  if (pole < 0 || pole >= model.poles.size())
    throw InputError("linear.no-pole", {request.file},
                     fmt::format("there is no pole {}: the model has {}", pole + 1, model.poles.size()),
                     "linearize the system again");
  const std::complex<double> lambda(model.poles.real[pole], model.poles.imag[pole]);
  auto plant = make_plant(loaded, request.open);
  const auto point = find_point(request, loaded, plant, diagnostics);
  const int n = plant->num_dofs();
  Eigen::VectorXcd shape =
      statespace::calc_eigenvector(model.A, model.sample_time > 0 ? records::calc_z(model, pole) : lambda).head(n);
  double largest = 0;  // in visible displacements
  for (int i = 0; i < n; ++i) largest = std::max(largest, std::abs(shape[i]) / plant->step(i));
  if (!(largest > 0))
    throw InputError("linear.no-pole", {request.file}, fmt::format("pole {} moves no body", pole + 1),
                     "choose another pole");
  shape /= largest;

  constexpr int kSamples = 64;
  const double omega = std::abs(lambda.imag()), size = std::abs(lambda);
  const double period = omega > 1e-9 * size ? 2 * std::numbers::pi / omega : size > 0 ? 1 / size : 1;
  const auto write = [&](records::ResultSink& sink) {
    solver::Outputs outputs(loaded.system);
    Diagnostics unused;
    outputs.choose({"bodies"}, {}, unused);
    records::ResultsHeader header;
    header.system_text = loaded.spec.text;
    header.channels = outputs.chosen_channels();
    solver::label_channels(loaded.system, loaded.spec, header.channels);
    header.max_samples = kSamples + 1;
    sink.begin(header);
    for (int k = 0; k <= kSamples; ++k) {
      const double angle = 2 * std::numbers::pi * k / kSamples;
      auto moved = point;
      moved.q = plant->displace(point.q, (shape * std::polar(1.0, angle)).real());
      const Eigen::VectorXd u = plant->calc_speeds(moved);
      plant->evaluate(moved);
      outputs.calc_sample({period * k / kSamples, plant->data(), moved.q, u, 0, 0});
      sink.write_sample(outputs.keep_sample());
    }
    sink.end(true, "");
  };
  return make_sample_chapter(request.file, loaded, write, diagnostics);
}

}  // namespace bough::analysis
