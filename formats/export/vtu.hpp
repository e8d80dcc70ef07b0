#pragma once
/// \file VTK's XML file of an unstructured grid (.vtu): a mesh with values at its points, for ParaView and meshio.
#include <string>
#include <unordered_map>
#include <vector>

#include "formats/records/complex_modes.hpp"
#include "formats/records/flex_body.hpp"
#include "formats/records/modes.hpp"
#include "formats/records/static_result.hpp"

namespace bough::exports {

/// Values at the points: one row for each of the mesh's grids, 1 or 3 columns.
struct PointArray {
  std::string name;
  Eigen::MatrixXd values;
};

/// Values at the cells, by element id; 0 where an element has none. Of several bodies, whose elements may have the same
/// ids: by block of the mesh, a value each element.
struct CellArray {
  std::string name;
  std::unordered_map<int, double> by_element;
  std::vector<Eigen::VectorXd> by_block;  ///< in place of by_element, unless empty
};

enum class VtuEncoding {
  Base64,  ///< inline binary, 8 bytes a number
  Ascii    ///< text that reads back bit for bit
};

/// A mesh and what is drawn on it; num_missing grids of the body had no shape and are left out with their cells.
struct Picture {
  records::BodyMesh mesh;
  std::vector<PointArray> arrays;
  std::vector<CellArray> cells;
  int num_missing = 0;
};

/// The file's text: points in the mesh's frame, point data grid_id and the arrays, cell data element_id and `cells`.
/// Block types line2, tri3, quad4, tetra4, pyramid5, penta6, hexa8, vertex, and line3, tri6, quad8, tetra10, penta15,
/// hexa20 with the midside nodes in Nastran's order. A cell with a node that is no grid (index -1) is left out. Throws
/// InputError "export.unknown-cell" for another type of block. Layout: VTK User's Guide, "XML File Formats".
std::string make_vtu(const records::BodyMesh& mesh, const std::vector<PointArray>& arrays, VtuEncoding encoding,
                     const std::vector<CellArray>& cells = {});

/// Mode shapes as arrays mode_001_0.463Hz (translations) and mode_001_0.463Hz_rotation, basic frame; for buckling
/// buckling_001_factor_4.32 and its _rotation. With energies of elements mode_001_0.463Hz_strain_energy and
/// _kinetic_energy on the cells, as shares of the mode's, and _strain_energy_density.
Picture make_picture(const records::ModesResult& modes);
/// Real and imaginary part of each complex shape: mode_001_..._real, mode_001_..._imag.
Picture make_picture(const records::ComplexModesResult& modes);
/// Mode shapes of a body, in its frame B: of all grids (without rotations unless full_phi is there), or of the output
/// nodes if the file has no others.
Picture make_picture(const records::FlexBody& body);
/// Static solutions as arrays subcase_001_displacement and subcase_001_displacement_rotation, basic frame; on the cells
/// subcase_001_strain_energy, and subcase_001_von_mises, _failure, _max, _min where elements have them.
Picture make_picture(const records::StaticResult& result);

}  // namespace bough::exports
