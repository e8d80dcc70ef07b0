/// \file The .vtu text itself; tests/cli/meshio_test.py has it read by meshio.
#include "formats/export/vtu.hpp"

#include <gtest/gtest.h>

#include "base/diagnostic.hpp"

namespace bough::exports {
namespace {

using Eigen::MatrixXd;
using records::BodyMesh;

BodyMesh make_mesh(int num_grids, const std::string& type) {
  BodyMesh mesh;
  mesh.grid_xyz = MatrixXd::Zero(num_grids, 3);
  for (int k = 0; k < num_grids; ++k) {
    mesh.grid_id.push_back(k + 1);
    mesh.grid_xyz(k, 0) = 0.1 * k;
  }
  BodyMesh::Block block{type, Eigen::MatrixXi(1, num_grids), {77}};
  for (int k = 0; k < num_grids; ++k) block.connectivity(0, k) = k;
  mesh.blocks.push_back(block);
  return mesh;
}

/// Contents of the data array `name`.
std::string find_array(const std::string& text, const std::string& name) {
  const auto at = text.find("Name=\"" + name + "\"");
  if (at == std::string::npos) return "absent";
  const auto from = text.find(">\n", at) + 2;
  return text.substr(from, text.find("\n</DataArray>", from) - from);
}

std::string replace_breaks(std::string text) {
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text;
}

TEST(Vtu, TypesAndOrderOfVtk) {
  const std::vector<std::tuple<std::string, int, std::string>> types{
      {"vertex", 1, "1"},    {"line2", 2, "3"},    {"tri3", 3, "5"},     {"quad4", 4, "9"}, {"tetra4", 4, "10"},
      {"hexa8", 8, "12"},    {"penta6", 6, "13"},  {"line3", 3, "21"},   {"tri6", 6, "22"}, {"quad8", 8, "23"},
      {"tetra10", 10, "24"}, {"hexa20", 20, "25"}, {"penta15", 15, "26"}};
  for (const auto& [type, num_nodes, number] : types) {
    const auto text = make_vtu(make_mesh(num_nodes, type), {}, VtuEncoding::Ascii);
    EXPECT_EQ(find_array(text, "types"), number) << type;
    EXPECT_EQ(find_array(text, "offsets"), std::to_string(num_nodes)) << type;
    EXPECT_EQ(find_array(text, "element_id"), "77") << type;
  }
  // vtkQuadraticHexahedron: edges of the bottom, of the top, then upright; CHEXA: bottom, upright, top. Same for
  // wedges.
  EXPECT_EQ(replace_breaks(find_array(make_vtu(make_mesh(20, "hexa20"), {}, VtuEncoding::Ascii), "connectivity")),
            "0 1 2 3 4 5 6 7 8 9 10 11 16 17 18 19 12 13 14 15");
  EXPECT_EQ(replace_breaks(find_array(make_vtu(make_mesh(15, "penta15"), {}, VtuEncoding::Ascii), "connectivity")),
            "0 1 2 3 4 5 6 7 8 12 13 14 9 10 11");
  EXPECT_EQ(replace_breaks(find_array(make_vtu(make_mesh(6, "penta6"), {}, VtuEncoding::Ascii), "connectivity")),
            "0 2 1 3 5 4");
}

TEST(Vtu, AsciiKeepsEveryDigitAndBase64IsRfc4648) {
  auto mesh = make_mesh(2, "line2");
  mesh.grid_xyz(1, 2) = 1.0 / 3;
  const auto ascii = make_vtu(mesh, {{"a<b&\"c\"", MatrixXd::Constant(2, 1, -0.5)}}, VtuEncoding::Ascii);
  EXPECT_EQ(find_array(ascii, "Points"), "0 0 0\n0.1 0 0.3333333333333333");
  EXPECT_EQ(replace_breaks(find_array(ascii, "a&lt;b&amp;&quot;c&quot;")), "-0.5 -0.5");
  const auto binary = make_vtu(mesh, {}, VtuEncoding::Base64);
  // 1 byte of data behind 8 of length: 01 00 .. 00, 03.
  EXPECT_EQ(find_array(binary, "types"), "AQAAAAAAAAAD");
  // 4 + 8 bytes: 04 00 .. 00, 4d 00 00 00.
  EXPECT_EQ(find_array(binary, "element_id"), "BAAAAAAAAABNAAAA");
  EXPECT_EQ(find_array(binary, "grid_id"), "CAAAAAAAAAABAAAAAgAAAA==");
}

TEST(Vtu, CellsWithoutAllTheirNodesAreLeftOut) {
  auto mesh = make_mesh(2, "line2");
  mesh.blocks[0].connectivity(0, 1) = -1;
  EXPECT_NE(make_vtu(mesh, {}, VtuEncoding::Ascii).find("NumberOfCells=\"0\""), std::string::npos);
}

TEST(Vtu, UnknownTypeOfCell) {
  try {
    make_vtu(make_mesh(5, "pyra5"), {}, VtuEncoding::Ascii);
    FAIL() << "expected export.unknown-cell";
  } catch (const InputError& e) {
    EXPECT_EQ(e.items().at(0).id, "export.unknown-cell");
  }
}

TEST(Picture, NodesWithoutAMeshBecomeVertices) {
  records::ModesResult modes;
  modes.node_id = {4, 9};
  modes.node_xyz = MatrixXd::Identity(2, 3);
  modes.frequency_hz = Eigen::VectorXd::Constant(1, 0.46312);
  modes.phi.assign(2, MatrixXd::Constant(6, 1, 1.0));
  modes.phi[1].setConstant(2.0);
  const auto picture = make_picture(modes);
  EXPECT_EQ(picture.num_missing, 0);
  ASSERT_EQ(picture.mesh.blocks.size(), 1u);
  EXPECT_EQ(picture.mesh.blocks[0].type, "vertex");
  EXPECT_EQ(picture.mesh.blocks[0].connectivity.rows(), 2);
  ASSERT_EQ(picture.arrays.size(), 2u);
  EXPECT_EQ(picture.arrays[0].name, "mode_001_0.4631Hz");
  EXPECT_EQ(picture.arrays[1].name, "mode_001_0.4631Hz_rotation");
  EXPECT_EQ(picture.arrays[1].values(1, 2), 2.0);
}

TEST(Picture, FullShapesOfABodyGoByTheDofMap) {
  records::FlexBody body;
  body.mesh = make_mesh(2, "line2");
  body.node_id = {1};
  body.node_xyz = MatrixXd::Zero(1, 3);
  body.frequency_hz = body.eigenvalue = Eigen::VectorXd::Constant(1, 2.5);
  body.phi.assign(1, MatrixXd::Zero(6, 1));
  EXPECT_EQ(make_picture(body).num_missing, 1);
  body.dof_map.resize(3, 2);
  body.dof_map << 1, 2, 2, 6, 40, 0;
  body.full_phi = Eigen::Vector3d(10, 20, 30);
  const auto picture = make_picture(body);
  EXPECT_EQ(picture.num_missing, 0);
  EXPECT_EQ(picture.arrays[0].values, (MatrixXd(2, 3) << 0, 10, 0, 0, 0, 0).finished());
  EXPECT_EQ(picture.arrays[1].values, (MatrixXd(2, 3) << 0, 0, 0, 0, 0, 20).finished());
}

}  // namespace
}  // namespace bough::exports
