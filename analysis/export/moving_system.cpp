#include "analysis/export/moving_system.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/common/body_files.hpp"
#include "analysis/common/run_bodies.hpp"
#include "formats/toml/specs.hpp"

namespace bough::analysis {

namespace {

std::vector<Eigen::Index> choose_samples(const Eigen::VectorXd& time, const MovingOptions& o, const std::string& file) {
  std::vector<Eigen::Index> chosen;
  Eigen::Index inside = 0;
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    if (!o.window.empty() && (time[i] < o.window[0] || time[i] > o.window[1])) continue;
    if (inside++ % o.every == 0) chosen.push_back(i);
  }
  if (chosen.empty())
    throw InputError("cli.bad-range", {file},
                     time.size() == 0 ? "the file holds no sample"
                                      : fmt::format("no sample lies in the window; they go from {:g} to {:g}", time[0],
                                                    time[time.size() - 1]),
                     "give another --window");
  return chosen;
}

/// The channel at the samples; empty where the file lacks it.
Eigen::MatrixXd take(const hdf5::ResultsFile& results, const std::string& path,
                     const std::vector<Eigen::Index>& samples) {
  const auto found = results.channels.find(path);
  if (found == results.channels.end()) return {};
  return found->second(samples, Eigen::all);
}

}  // namespace

Eigen::Matrix3d to_rotation(const Eigen::Ref<const Eigen::RowVectorXd>& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

MovingSystem read_moving_system(const std::string& file, const MovingOptions& o, Diagnostics& diagnostics) {
  const auto results = hdf5::read_results(file);
  const auto inputs = hdf5::read_run_inputs(file);
  Diagnostics unused;  // the text was run: its errors were reported then
  const auto spec = toml_files::read_system_spec_text(inputs.system_text, file, unused);
  const auto samples = choose_samples(results.time, o, file);
  MovingSystem system;
  system.time = results.time(samples);
  std::string known;
  for (const auto& body : spec.bodies) {
    const std::string path = "/bodies/" + body.name + "/";
    MovingBody moving{body.name,
                      take(results, path + "position", samples),
                      take(results, path + "quaternion", samples),
                      take(results, path + "velocity", samples),
                      take(results, path + "angular_velocity", samples),
                      take(results, path + "eta", samples),
                      take(results, path + "eta_dot", samples),
                      {},
                      {}};
    if (moving.position.cols() != 3 || moving.quaternion.cols() != 4) {
      diagnostics.warning("export.no-body", {file},
                          "body " + body.name + " is not drawn: the file has no position and quaternion of it",
                          "run with \"bodies\" among `record`");
      continue;
    }
    known += (known.empty() ? "" : ", ") + body.name;
    if (body.file.empty()) {
      moving.drawing = report::make_box(body.mass, body.cg, body.inertia, list_rigid_points(spec, body));
    } else {
      std::string why;
      const auto written = get_body_path(body.file);
      const auto place = find_body_file(written, file, o.bodies, inputs.source, why);
      if (place.empty()) {
        diagnostics.warning("export.no-body", {file}, "body " + body.name + " is not drawn: " + why,
                            "name its file with --body");
        continue;
      }
      moving.flex = read_body(place + body.file.substr(written.size()), unused);
      moving.drawing = report::make_drawing(*moving.flex, true);
    }
    system.bodies.push_back(std::move(moving));
  }
  if (system.bodies.empty())
    throw InputError("cli.no-motion", {file}, "the file holds no body that can be drawn",
                     "give a results file with the channels of /bodies, next to the files of its bodies");
  if (o.follow.empty()) return system;
  const auto leader = std::find_if(system.bodies.begin(), system.bodies.end(),
                                   [&](const MovingBody& body) { return body.name == o.follow; });
  if (leader == system.bodies.end())
    throw InputError("cli.unknown-body", {file}, "no body \"" + o.follow + "\" to follow", "the bodies are " + known);
  const Eigen::MatrixXd origin = leader->position;
  for (auto& body : system.bodies) body.position -= origin;
  return system;
}

}  // namespace bough::analysis
