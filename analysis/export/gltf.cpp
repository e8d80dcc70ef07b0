#include <fmt/format.h>

#include "analysis/common/body_files.hpp"
#include "analysis/export/export_matrices.hpp"
#include "analysis/export/moving_system.hpp"
#include "report/gltf.hpp"

namespace bough::analysis {

namespace {

/// Shapes at the size that is seen: the largest displacement a tenth of the body's extent.
report::GltfScene make_mode_scene(const std::string& name, report::Drawing drawing, const Eigen::VectorXd& values,
                                  const std::string& unit, double scale) {
  report::GltfScene scene;
  scene.name = name;
  const double size =
      drawing.xyz.rows() == 0 ? 0 : (drawing.xyz.colwise().maxCoeff() - drawing.xyz.colwise().minCoeff()).norm();
  for (std::size_t j = 0; j < drawing.shapes.size(); ++j) {
    auto& shape = drawing.shapes[j];
    const double largest = shape.rowwise().norm().maxCoeff();
    if (largest > 0) shape *= scale * 0.1 * (size > 0 ? size : 1) / largest;
    scene.shape_names.push_back(fmt::format("mode {}, {:.4g} {}", j + 1, values[static_cast<Eigen::Index>(j)], unit));
  }
  scene.bodies.push_back({name, std::move(drawing), {}, {}, {}});
  return scene;
}

report::GltfScene make_run_scene(const std::string& file, const MovingOptions& o, Diagnostics& diagnostics) {
  auto system = read_moving_system(file, o, diagnostics);
  report::GltfScene scene;
  scene.time = system.time;
  for (auto& body : system.bodies) {
    report::GltfBody drawn{body.name, std::move(body.drawing), body.position, body.quaternion, {}};
    // A run may keep fewer modes than the file has.
    const auto n = std::min(body.eta.cols(), static_cast<Eigen::Index>(drawn.drawing.shapes.size()));
    drawn.drawing.shapes.resize(static_cast<std::size_t>(n));
    drawn.weights = o.scale * body.eta.leftCols(n);
    scene.bodies.push_back(std::move(drawn));
  }
  return scene;
}

}  // namespace

std::string make_glb(const std::string& file, const MovingOptions& o, Diagnostics& diagnostics) {
  const auto format = read_file_format(file);
  if (format == "bough-results") return report::make_glb(make_run_scene(file, o, diagnostics));
  if (format == "bough-modes") {
    const auto modes = hdf5::read_modes(file);
    const bool is_buckling = modes.load_factor.size() > 0;
    auto drawing = report::make_drawing(modes.mesh, modes.node_id, modes.node_xyz, modes.phi, true);
    return report::make_glb(make_mode_scene("modes", std::move(drawing),
                                            is_buckling ? modes.load_factor : modes.frequency_hz,
                                            is_buckling ? "times the load" : "Hz", o.scale));
  }
  if (format != "bough-flexbody") refuse_export(file, "gltf", "what bough run, modes or reduce wrote");
  const auto body = read_body(file, diagnostics);
  auto drawing = report::make_drawing(body, true);
  return report::make_glb(make_mode_scene(body.name, std::move(drawing), body.frequency_hz, "Hz", o.scale));
}

}  // namespace bough::analysis
