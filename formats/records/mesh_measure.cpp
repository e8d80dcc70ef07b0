#include "formats/records/mesh_measure.hpp"

#include <cmath>

namespace bough::records {

namespace {

double calc_measure(const BodyMesh& mesh, const BodyMesh::Block& block, Eigen::Index e) {
  const auto at = [&](int k) -> Eigen::Vector3d { return mesh.grid_xyz.row(block.connectivity(e, k)).transpose(); };
  const auto tetra = [&](int a, int b, int c, int d) {
    return std::abs((at(b) - at(a)).cross(at(c) - at(a)).dot(at(d) - at(a))) / 6;
  };
  const auto& type = block.type;
  const Eigen::Index corners = type.starts_with("hexa")                                ? 8
                               : type.starts_with("penta")                             ? 6
                               : type.starts_with("pyramid")                           ? 5
                               : type.starts_with("quad") || type.starts_with("tetra") ? 4
                               : type.starts_with("tri")                               ? 3
                                                                                       : 2;
  if (block.connectivity.cols() < corners) return 0;
  if (type.starts_with("line")) return (at(1) - at(0)).norm();
  if (type.starts_with("tri")) return 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  if (type.starts_with("quad")) return 0.5 * (at(2) - at(0)).cross(at(3) - at(1)).norm();
  if (type.starts_with("tetra")) return tetra(0, 1, 2, 3);
  if (type.starts_with("pyramid")) return tetra(0, 1, 2, 4) + tetra(0, 2, 3, 4);
  if (type.starts_with("penta")) return tetra(0, 1, 2, 3) + tetra(1, 2, 3, 4) + tetra(2, 3, 4, 5);
  if (!type.starts_with("hexa")) return 0;
  return tetra(0, 1, 2, 6) + tetra(0, 2, 3, 6) + tetra(0, 3, 7, 6) + tetra(0, 7, 4, 6) + tetra(0, 4, 5, 6) +
         tetra(0, 5, 1, 6);
}

}  // namespace

std::unordered_map<int, double> calc_measures(const BodyMesh& mesh) {
  std::unordered_map<int, double> measures;
  const auto grids = static_cast<int>(mesh.grid_id.size());
  for (const auto& block : mesh.blocks)
    for (Eigen::Index e = 0; e < block.connectivity.rows(); ++e)
      if (block.connectivity.cols() > 0 && block.connectivity.row(e).minCoeff() >= 0 &&
          block.connectivity.row(e).maxCoeff() < grids)
        measures[block.element_id[static_cast<std::size_t>(e)]] = calc_measure(mesh, block, e);
  return measures;
}

}  // namespace bough::records
