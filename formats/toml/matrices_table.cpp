#include "formats/toml/detail/matrices_table.hpp"

#include <algorithm>

#include "formats/toml/specs.hpp"

namespace bough::toml_files {

records::MatrixSource parse_matrix_source(const std::string& text, const std::string& common) {
  // A drive letter is no file: the name is after the last colon.
  const auto colon = text.rfind(':');
  if (colon == std::string::npos || colon == 1) return {text, {}};
  return {colon == 0 ? common : text.substr(0, colon), text.substr(colon + 1)};
}

namespace {

constexpr const char* kInertialNames[records::kNumInertialLoads] = {"ax",  "ay",  "az",  "alx",  "aly",  "alz",
                                                                    "wx2", "wy2", "wz2", "wxwy", "wxwz", "wywz"};

class MatricesTable {
 public:
  MatricesTable(const Fields& table, const std::string& path, Diagnostics& diagnostics)
      : table_(table), path_(path), diagnostics_(diagnostics) {}

  records::MatricesSpec read() {
    spec_.at = table_.locate();
    spec_.file = resolve_path(path_, table_.get_string("file"));
    spec_.stiffness = read_source(table_, "stiffness");
    spec_.mass = read_source(table_, "mass");
    spec_.damping = read_source(table_, "damping");
    spec_.modes = read_source(table_, "modes");
    spec_.check_modes = read_source(table_, "check_modes");
    spec_.dofs = resolve_path(path_, table_.get_string("dofs"));
    spec_.grids = resolve_path(path_, table_.get_string("grids"));
    const std::string axes = table_.get_string("axes");
    if (axes == "displacement") spec_.axes = records::MatrixAxes::Displacement;
    if (axes == "basic") spec_.axes = records::MatrixAxes::Basic;
    spec_.mass_scale = table_.get_number("mass_scale", 1);
    spec_.clamped = table_.get_ints("clamped");
    const Fields inertial = table_.get_table("inertial");
    for (std::size_t i = 0; i < spec_.inertial.size(); ++i)
      spec_.inertial[i] = read_source(inertial, kInertialNames[i]);
    for (const Fields& g : table_.get_tables("geometric")) read_geometric(g);
    return std::move(spec_);
  }

 private:
  records::MatrixSource read_source(const Fields& table, const std::string& key) {
    const std::string text = table.get_string(key);
    if (text.empty()) return {};
    auto source = parse_matrix_source(text, table_.get_string("file"));
    if (source.file.empty())
      diagnostics_.error("toml.bad-value", table.locate(key),
                         key + " is '" + text + "', which names no file, and the table has no 'file'",
                         "write FILE or FILE:NAME, or give file = \"FILE\"");
    source.file = resolve_path(path_, source.file);
    return source;
  }

  void read_geometric(const Fields& table) {
    records::GeometricSource g;
    g.at = table.locate();
    g.name = table.get_string("name");
    g.matrix = read_source(table, "matrix");
    g.load = read_source(table, "load");
    g.load_column = table.get_int("column", 1);
    g.node = table.get_int("node", 0);
    g.direction = table.get_int("direction", g.node > 0 ? 1 : 0);
    g.load_set = table.get_int("load_set", 0);
    if (table.has("node") && !table.has("direction"))
      diagnostics_.error("toml.missing-key", table.locate("node"), "'node' stands without 'direction'",
                         "give the direction of the unit load, 1 to 6");
    const auto same = [&](const auto& other) { return other.name == g.name; };
    if (std::any_of(spec_.geometric.begin(), spec_.geometric.end(), same))
      diagnostics_.error("toml.duplicate-name", table.locate("name"), "'" + g.name + "' was already given",
                         "rename one of them");
    spec_.geometric.push_back(std::move(g));
  }

  const Fields& table_;
  const std::string& path_;
  Diagnostics& diagnostics_;
  records::MatricesSpec spec_;
};

}  // namespace

std::optional<records::MatricesSpec> read_matrices_spec(const Fields& body, const std::string& path,
                                                        Diagnostics& diagnostics) {
  if (!body.has("matrices")) return {};
  const Fields table = body.get_table("matrices");
  return MatricesTable(table, path, diagnostics).read();
}

}  // namespace bough::toml_files
