#pragma once
/// \file Drawing of a body for the viewer of the page: its surface, its lines, its shapes.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/records/flex_body.hpp"

namespace bough::report {

/// Elements that a drawing shows, for colours by what each of them has.
struct DrawnElements {
  enum class Kind { Line, Surface, Solid };
  std::vector<int> id;
  std::vector<Kind> kind;
  std::vector<std::uint32_t> of_triangle, of_edge;  ///< index into id of each; kNone for an outline
  /// Surfaces and solids at each drawn point: pairs (point, index into id), for averages at nodes.
  std::vector<std::uint32_t> at_point;
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
};

/// A number of each element and shape: a stress of the subcases, a failure index. Coloured by web/modes_view.js.
struct ElementField {
  std::string name, group, unit;        ///< "von Mises stress, top", "stress", "F/L^2"
  bool has_average = false;             ///< true if axes are common to neighbours, so that means at nodes make sense
  std::vector<std::uint32_t> element;   ///< index into DrawnElements::id of each value
  std::vector<Eigen::VectorXd> values;  ///< [shape] in the order of `element`; NaN where the file has no number
};

struct Drawing {
  std::vector<int> id;                          ///< node of each point; empty for a rigid body
  std::vector<int> interface;                   ///< interface nodes of a flexible body
  Eigen::MatrixXd xyz;                          ///< k x 3
  std::vector<std::uint32_t> triangles, edges;  ///< three and two points each; edges bound the elements
  std::vector<std::uint32_t> ghosts;            ///< edges of elements of which not every grid has a shape
  std::vector<Eigen::MatrixXd> shapes;          ///< [mode] k x 3; may be fewer than the modes (num_dropped)
  int num_dropped = 0;                          ///< modes whose shapes would make the page too large
  DrawnElements elements;
  std::vector<Eigen::VectorXd> energy;  ///< [shape] share of each element; empty where it is not known
  std::vector<ElementField> fields;
  std::vector<std::uint32_t> property;  ///< PID of each element, with fields; 0 without one
  Eigen::VectorXd measure;              ///< of each element, with energy: length, area or volume; 0 without extent
  /// Strain energy matrices of a body that moves in all its modes: ½ Σ a_i a_j k_ij of each element, a_i =
  /// coefficient i times weight[i]; element x n(n+1)/2 (records::ElementStrainEnergy). Empty if unknown or too large.
  Eigen::MatrixXd energy_matrix;
  Eigen::VectorXd weight;

  /// Index of a node among the points, -1 without.
  int find(int node) const;
};

/// Faces that two solids share are left out. phi: [node] 6 x n; grids that are no nodes have no shape.
/// Shapes that would make a page too large are dropped, unless all_shapes.
Drawing make_drawing(const records::BodyMesh& mesh, const std::vector<int>& node_id, const Eigen::MatrixXd& node_xyz,
                     const std::vector<Eigen::MatrixXd>& phi, bool all_shapes = false);
/// A body's own: of all grids, or of the output nodes of a file without their shapes.
Drawing make_drawing(const records::FlexBody& body, bool all_shapes = false);

/// Strain energy of the elements of the mesh: a row an id, a column a shape, which share `whole`.
void add_energies(const records::BodyMesh& mesh, const std::vector<int>& id, const Eigen::MatrixXd& energy,
                  const Eigen::VectorXd& whole, Drawing& drawing);

/// Adds the element energies of a flexible body that has them: of its shapes, or for a body in motion the matrices.
void add_energies(const records::FlexBody& body, Drawing& drawing);
/// False where they would make the page too large.
bool add_energy_matrices(const records::FlexBody& body, Drawing& drawing);

/// The box of uniform density with this mass and inertia about cg, and a line from cg to each node. A body whose
/// inertia no box has (a point, a line) gets what is left of one.
Drawing make_box(double mass, const Eigen::Vector3d& cg, const Eigen::Matrix3d& inertia,
                 const std::vector<Eigen::Vector3d>& nodes);

/// JSON text for the script (web/drawing.js).
std::string to_json_text(const Drawing& drawing);

}  // namespace bough::report
