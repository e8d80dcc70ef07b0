#include "formats/export/vtu.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "base/diagnostic.hpp"
#include "base/xml_text.hpp"

namespace bough::exports {

namespace {

static_assert(std::endian::native == std::endian::little, "the files are marked LittleEndian");

struct CellType {
  std::string_view name;
  std::uint8_t vtk;
  int num_nodes;
};
constexpr std::array cell_types{CellType{"vertex", 1, 1},    CellType{"line2", 3, 2},     CellType{"tri3", 5, 3},
                                CellType{"quad4", 9, 4},     CellType{"tetra4", 10, 4},   CellType{"hexa8", 12, 8},
                                CellType{"penta6", 13, 6},   CellType{"line3", 21, 3},    CellType{"tri6", 22, 6},
                                CellType{"quad8", 23, 8},    CellType{"tetra10", 24, 10}, CellType{"hexa20", 25, 20},
                                CellType{"penta15", 26, 15}, CellType{"pyramid5", 14, 5}};

const CellType& find_cell_type(const records::BodyMesh::Block& block) {
  for (const auto& type : cell_types) {
    if (type.name != block.type) continue;
    BOUGH_DEMAND(block.connectivity.rows() == 0 || block.connectivity.cols() == type.num_nodes);
    return type;
  }
  throw InputError("export.unknown-cell", {},
                   "the mesh holds cells of type \"" + block.type + "\", expected line2, quad4, ...",
                   "reduce or solve the deck again with this version");
}

/// Place in Nastran's order of VTK's k-th node. VTK lists the edges of the top before the upright ones; the first
/// triangle of its linear wedge, and of that alone, looks outward (vtkWedge.h, vtkQuadraticWedge.cxx).
int find_place(std::string_view type, int k) {
  constexpr std::array hexa{16, 17, 18, 19, 12, 13, 14, 15};
  constexpr std::array penta{12, 13, 14, 9, 10, 11};
  constexpr std::array linear_penta{0, 2, 1, 3, 5, 4};
  if (type == "penta6") return linear_penta[static_cast<std::size_t>(k)];
  if (type == "hexa20" && k >= 12) return hexa[static_cast<std::size_t>(k - 12)];
  if (type == "penta15" && k >= 9) return penta[static_cast<std::size_t>(k - 9)];
  return k;
}

struct Cells {
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::uint8_t> types;
  std::vector<std::int32_t> ids;
  std::vector<std::pair<std::size_t, Eigen::Index>> places;  ///< block of the mesh, row there
};

Cells collect_cells(const records::BodyMesh& mesh) {
  Cells cells;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    const auto& block = mesh.blocks[b];
    const auto& type = find_cell_type(block);
    for (Eigen::Index e = 0; e < block.connectivity.rows(); ++e) {
      if (block.connectivity.row(e).minCoeff() < 0) continue;
      BOUGH_DEMAND(block.connectivity.row(e).maxCoeff() < static_cast<int>(mesh.grid_id.size()));
      for (int k = 0; k < type.num_nodes; ++k)
        cells.connectivity.push_back(block.connectivity(e, find_place(type.name, k)));
      cells.offsets.push_back(static_cast<std::int64_t>(cells.connectivity.size()));
      cells.types.push_back(type.vtk);
      cells.ids.push_back(block.element_id[static_cast<std::size_t>(e)]);
      cells.places.emplace_back(b, e);
    }
  }
  return cells;
}

std::string encode_base64(const unsigned char* bytes, std::size_t size) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const std::size_t left = size - i;
    const std::uint32_t group = (static_cast<std::uint32_t>(bytes[i]) << 16) |
                                (left > 1 ? static_cast<std::uint32_t>(bytes[i + 1]) << 8 : 0u) |
                                (left > 2 ? static_cast<std::uint32_t>(bytes[i + 2]) : 0u);
    text += letters[(group >> 18) & 63];
    text += letters[(group >> 12) & 63];
    text += left > 1 ? letters[(group >> 6) & 63] : '=';
    text += left > 2 ? letters[group & 63] : '=';
  }
  return text;
}

class VtuText {
 public:
  explicit VtuText(VtuEncoding encoding) : encoding_(encoding) {}

  void add_line(const std::string& line) { text_ += line + "\n"; }

  template <class Number>
  void add_array(const char* type, const std::string& name, int num_components, const std::vector<Number>& values) {
    text_ += std::string("<DataArray type=\"") + type + "\" Name=\"" + escape_xml(name) + "\"";
    if (num_components > 1) text_ += " NumberOfComponents=\"" + std::to_string(num_components) + "\"";
    text_ += encoding_ == VtuEncoding::Ascii ? " format=\"ascii\">\n" : " format=\"binary\">\n";
    if (encoding_ == VtuEncoding::Ascii)
      add_numbers(num_components, values);
    else
      add_bytes(values);
    text_ += "\n</DataArray>\n";
  }

  /// Rows of a matrix one after another.
  void add_matrix(const std::string& name, const Eigen::MatrixXd& m) {
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(m.size()));
    for (Eigen::Index i = 0; i < m.rows(); ++i)
      for (Eigen::Index j = 0; j < m.cols(); ++j) values.push_back(m(i, j));
    add_array("Float64", name, static_cast<int>(m.cols()), values);
  }

  std::string take() { return std::move(text_); }

 private:
  template <class Number>
  void add_numbers(int per_line, const std::vector<Number>& values) {
    char buffer[40];
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (i > 0) text_ += i % static_cast<std::size_t>(per_line) == 0 ? '\n' : ' ';
      const auto end = std::to_chars(buffer, buffer + sizeof buffer, values[i]);
      text_.append(buffer, end.ptr);
    }
  }

  /// The number of bytes as UInt64, then the bytes.
  template <class Number>
  void add_bytes(const std::vector<Number>& values) {
    const std::uint64_t size = values.size() * sizeof(Number);
    std::vector<unsigned char> bytes(sizeof size + size);
    std::memcpy(bytes.data(), &size, sizeof size);
    if (size > 0) std::memcpy(bytes.data() + sizeof size, values.data(), size);
    text_ += encode_base64(bytes.data(), bytes.size());
  }

  VtuEncoding encoding_;
  std::string text_;
};

}  // namespace

std::string make_vtu(const records::BodyMesh& mesh, const std::vector<PointArray>& arrays, VtuEncoding encoding,
                     const std::vector<CellArray>& cell_arrays) {
  const auto num_points = static_cast<Eigen::Index>(mesh.grid_id.size());
  BOUGH_DEMAND(mesh.grid_xyz.rows() == num_points);
  const auto cells = collect_cells(mesh);
  VtuText text(encoding);
  text.add_line("<?xml version=\"1.0\"?>");
  text.add_line(
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">");
  text.add_line("<UnstructuredGrid>");
  text.add_line("<Piece NumberOfPoints=\"" + std::to_string(num_points) + "\" NumberOfCells=\"" +
                std::to_string(cells.ids.size()) + "\">");
  text.add_line("<Points>");
  text.add_matrix("Points", num_points == 0 ? Eigen::MatrixXd::Zero(0, 3) : mesh.grid_xyz);
  text.add_line("</Points>\n<Cells>");
  text.add_array("Int64", "connectivity", 1, cells.connectivity);
  text.add_array("Int64", "offsets", 1, cells.offsets);
  text.add_array("UInt8", "types", 1, cells.types);
  text.add_line("</Cells>\n<PointData>");
  text.add_array("Int32", "grid_id", 1, std::vector<std::int32_t>(mesh.grid_id.begin(), mesh.grid_id.end()));
  for (const auto& array : arrays) {
    BOUGH_DEMAND(array.values.rows() == num_points);
    text.add_matrix(array.name, array.values);
  }
  text.add_line("</PointData>\n<CellData>");
  text.add_array("Int32", "element_id", 1, cells.ids);
  for (const auto& array : cell_arrays) {
    std::vector<double> values;
    for (std::size_t k = 0; k < cells.ids.size(); ++k) {
      if (!array.by_block.empty()) {
        const auto [block, row] = cells.places[k];
        values.push_back(array.by_block[block][row]);
        continue;
      }
      const auto found = array.by_element.find(cells.ids[k]);
      values.push_back(found == array.by_element.end() ? 0 : found->second);
    }
    text.add_array("Float64", array.name, 1, values);
  }
  text.add_line("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>");
  return text.take();
}

}  // namespace bough::exports
