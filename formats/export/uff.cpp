#include "formats/export/uff.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>

#include "base/diagnostic.hpp"
#include "formats/export/response_text.hpp"

namespace bough::exports {
namespace {

/// A trace line has at most 250 numbers.
constexpr std::size_t kLongestTrace = 250;

class UffText {
 public:
  template <class... T>
  void print(const char* format, T... values) {
    char line[256];
    if constexpr (sizeof...(values) == 0)
      std::snprintf(line, sizeof line, "%s", format);
    else
      std::snprintf(line, sizeof line, format, values...);
    text_ += line;
  }
  void begin(int dataset) { print("%6d\n%6d%74s\n", -1, dataset, ""); }
  void end() { print("%6d\n", -1); }
  /// An identification line may not be blank; 80 columns.
  void put_id(std::string id) {
    for (auto& c : id)
      if (c < ' ' || c > '~') c = '?';
    print("%-80.80s\n", id.empty() ? "NONE" : id.c_str());
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// Edges between corners, by the first letters of the block's type.
const std::vector<std::pair<int, int>>& get_edges(const std::string& type) {
  static const std::vector<std::pair<std::string, std::vector<std::pair<int, int>>>> table{
      {"line", {{0, 1}}},
      {"tri", {{0, 1}, {1, 2}, {2, 0}}},
      {"quad", {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},
      {"tetra", {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}},
      {"pyramid", {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}},
      {"penta", {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}},
      {"hexa", {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}}};
  static const std::vector<std::pair<int, int>> none;
  for (const auto& [name, edges] : table)
    if (type.rfind(name, 0) == 0) return edges;
  return none;
}

void put_nodes(UffText& out, const std::vector<int>& id, const Eigen::MatrixXd& xyz) {
  out.begin(15);
  for (std::size_t k = 0; k < id.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    out.print("%10d%10d%10d%10d%13.5E%13.5E%13.5E\n", id[k], 0, 0, 1, xyz(i, 0), xyz(i, 1), xyz(i, 2));
  }
  out.end();
}

void put_lines(UffText& out, const records::BodyMesh& mesh) {
  std::set<std::pair<int, int>> edges;
  for (const auto& block : mesh.blocks)
    for (const auto& [a, b] : get_edges(block.type))
      for (Eigen::Index e = 0; e < block.connectivity.rows(); ++e) {
        if (std::max(a, b) >= block.connectivity.cols()) continue;
        const int first = block.connectivity(e, a), second = block.connectivity(e, b);
        if (first >= 0 && second >= 0 && first != second) edges.insert(std::minmax(first, second));
      }
  std::vector<std::vector<int>> traces;
  int last = -1;
  for (const auto& [first, second] : edges) {
    if (traces.empty() || traces.back().size() + 3 > kLongestTrace) {
      traces.emplace_back();
      last = -1;
    }
    auto& trace = traces.back();
    // A zero lifts the pen.
    if (last != first) {
      trace.push_back(0);
      trace.push_back(mesh.grid_id[static_cast<std::size_t>(first)]);
    }
    trace.push_back(mesh.grid_id[static_cast<std::size_t>(second)]);
    last = second;
  }
  for (std::size_t t = 0; t < traces.size(); ++t) {
    out.begin(82);
    out.print("%10d%10d%10d\n", static_cast<int>(t) + 1, static_cast<int>(traces[t].size()), 0);
    out.put_id("edges of the elements");
    for (std::size_t i = 0; i < traces[t].size(); ++i)
      out.print("%10d%s", traces[t][i], (i + 1) % 8 == 0 || i + 1 == traces[t].size() ? "\n" : "");
    out.end();
  }
}

struct UffMode {
  int number = 0;
  bool is_buckling = false;
  double value = 0;  ///< frequency, or load factor
  double mass = 0, damping_ratio = 0;
};

/// Six displacements per node, real.
void put_mode(UffText& out, const std::string& model, int load_case, const UffMode& mode, const std::vector<int>& id,
              const std::vector<Eigen::MatrixXd>& phi) {
  out.begin(55);
  out.put_id(model);
  out.put_id(mode.is_buckling ? "Buckling mode" : "Normal mode");
  out.put_id("");
  out.put_id("");
  out.put_id("");
  out.print("%10d%10d%10d%10d%10d%10d\n", 1, mode.is_buckling ? 6 : 2, 3, 8, 2, 6);
  if (mode.is_buckling) {
    out.print("%10d%10d%10d\n%13.5E\n", 1, 1, load_case, mode.value);
  } else {
    out.print("%10d%10d%10d%10d\n%13.5E%13.5E%13.5E%13.5E\n", 2, 4, load_case, mode.number, mode.value, mode.mass,
              mode.damping_ratio, 0.0);
  }
  for (std::size_t k = 0; k < id.size(); ++k) {
    const auto& u = phi[k].col(mode.number - 1);
    out.print("%10d\n%13.5E%13.5E%13.5E%13.5E%13.5E%13.5E\n", id[k], u(0), u(1), u(2), u(3), u(4), u(5));
  }
  out.end();
}

/// All grids of the drawing, or the nodes alone.
void put_geometry(UffText& out, const records::BodyMesh& mesh, const std::vector<int>& id, const Eigen::MatrixXd& xyz) {
  if (mesh.grid_id.empty()) {
    put_nodes(out, id, xyz);
    return;
  }
  put_nodes(out, mesh.grid_id, mesh.grid_xyz);
  put_lines(out, mesh);
}

std::string name_source(const std::vector<std::pair<std::string, std::string>>& source) {
  return source.empty() ? "" : source.front().first;
}

/// Rounds a value as 13 columns hold it.
double round_to_five(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%13.5E", value);
  return std::atof(text);
}

/// Equal steps that 13 columns hold.
bool is_even(const Eigen::VectorXd& time, double step) {
  if (time.size() < 2 || step <= 0 || round_to_five(step) != step || round_to_five(time(0)) != time(0)) return false;
  for (Eigen::Index i = 0; i < time.size(); ++i)
    if (std::abs(time(i) - time(0) - static_cast<double>(i) * step) > 1e-9 * step) return false;
  return true;
}

/// A function over x: real, or complex where `imag` has values.
struct UffFunction {
  std::string name;
  const Eigen::VectorXd& x;
  Eigen::VectorXd real, imag;
  bool is_over_time = true;
  int load_case = 0;
  int node = 0, direction = 0;  ///< 1 to 6: along and about x, y, z; 0: none, a scalar
  std::pair<int, const char*> ordinate{0, "NONE"};
  bool is_transfer = false;  ///< over frequency: a frequency response function, else a spectrum
};

constexpr int kTimeResponse = 1, kTransfer = 4, kSpectrum = 12;

/// The format's code of a quantity, and its name.
std::pair<int, const char*> find_ordinate(const std::string& quantity) {
  if (quantity == "displacement") return {8, "Displacement"};
  if (quantity == "velocity") return {11, "Velocity"};
  if (quantity == "acceleration") return {12, "Acceleration"};
  if (quantity == "spc_force") return {9, "Reaction force"};
  return {0, "NONE"};
}

void put_function(UffText& out, int number, const UffFunction& f) {
  const auto n = f.x.size();
  const bool is_complex = f.imag.size() > 0;
  // The mean step, with the digits that would be written.
  const double step = n > 1 ? round_to_five((f.x(n - 1) - f.x(0)) / static_cast<double>(n - 1)) : 0;
  const bool even = is_even(f.x, step);
  const int type = f.is_over_time ? kTimeResponse : f.is_transfer ? kTransfer : kSpectrum;
  out.begin(58);
  out.put_id(f.name);
  for (int i = 0; i < 4; ++i) out.put_id("");
  out.print("%5d%10d%5d%10d %-10s%10d%4d %-10s%10d%4d\n", type, number, 0, f.load_case, "NONE", f.node, f.direction,
            "NONE", 0, 0);
  out.print("%10d%10d%10d%13.5E%13.5E%13.5E\n", is_complex ? 6 : 4, static_cast<int>(n), even ? 1 : 0,
            even ? f.x(0) : 0.0, even ? step : 0.0, 0.0);
  const std::pair<int, const char*> abscissa{f.is_over_time ? 17 : 18, f.is_over_time ? "Time" : "Frequency"};
  for (const auto& [type, label] : {abscissa, f.ordinate, {0, "NONE"}, {0, "NONE"}})
    out.print("%10d%5d%5d%5d %-20s %-20s\n", type, 0, 0, 0, label, "NONE");
  const Eigen::Index per_line = is_complex ? (even ? 2 : 1) : (even ? 4 : 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!even) out.print("%13.5E", f.x(i));
    out.print("%20.12E", f.real(i));
    if (is_complex) out.print("%20.12E", f.imag(i));
    if ((i + 1) % per_line == 0 || i + 1 == n) out.print("\n");
  }
  out.end();
}

}  // namespace

std::string make_uff(const records::ModesResult& modes) {
  UffText out;
  put_geometry(out, modes.mesh, modes.node_id, modes.node_xyz);
  const bool is_buckling = modes.load_factor.size() > 0;
  const auto& values = is_buckling ? modes.load_factor : modes.frequency_hz;
  for (Eigen::Index j = 0; j < values.size(); ++j) {
    const double mass = modes.modal_mass.size() > j ? modes.modal_mass(j) : 0;
    put_mode(out, name_source(modes.source), modes.subcase, {static_cast<int>(j) + 1, is_buckling, values(j), mass, 0},
             modes.node_id, modes.phi);
  }
  return out.take();
}

std::string make_uff(const records::FlexBody& body) {
  UffText out;
  put_geometry(out, body.mesh, body.node_id, body.node_xyz);
  for (Eigen::Index j = 0; j < body.num_modes(); ++j) {
    const double mass = body.modal_mass(j, j), critical = 2 * std::sqrt(std::abs(body.modal_stiffness(j, j) * mass));
    put_mode(out, body.name, 1,
             {static_cast<int>(j) + 1, false, body.frequency_hz(j), mass,
              critical > 0 ? body.modal_damping(j, j) / critical : 0},
             body.node_id, body.phi);
  }
  return out.take();
}

std::string make_uff(const std::vector<CsvColumn>& columns) {
  BOUGH_DEMAND(!columns.empty());
  UffText out;
  for (std::size_t c = 1; c < columns.size(); ++c)
    put_function(out, static_cast<int>(c), {columns[c].name, columns.front().values, columns[c].values, {}, true, 0});
  return out.take();
}

std::string make_uff(const records::BodyMesh& mesh, const Eigen::VectorXd& time,
                     const std::function<Eigen::MatrixXd(Eigen::Index)>& calc_displacement, const std::string& model) {
  UffText out;
  put_geometry(out, mesh, {}, {});
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    const Eigen::MatrixXd u = calc_displacement(i);
    BOUGH_DEMAND(u.rows() == static_cast<Eigen::Index>(mesh.grid_id.size()) && u.cols() == 3);
    out.begin(55);
    out.put_id(model);
    out.put_id("Displacement from the first place");
    for (int k = 0; k < 3; ++k) out.put_id("");
    // Structural, transient, three translations, displacement, real, three values a node; load case 1, time step.
    out.print("%10d%10d%10d%10d%10d%10d\n", 1, 4, 2, 8, 2, 3);
    out.print("%10d%10d%10d%10d\n%13.5E\n", 2, 1, 1, static_cast<int>(i) + 1, time(i));
    for (std::size_t k = 0; k < mesh.grid_id.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      out.print("%10d\n%13.5E%13.5E%13.5E\n", mesh.grid_id[k], u(row, 0), u(row, 1), u(row, 2));
    }
    out.end();
  }
  return out.take();
}

std::string make_uff(const records::DeckResponse& response) {
  UffText out;
  int number = 0;
  for (const auto& subcase : response.subcases)
    for (const auto& curve : list_curves(subcase)) {
      const auto ordinate = find_ordinate(curve.quantity);
      const bool is_of_grid = ordinate.first != 0;
      put_function(out, ++number,
                   {curve.name, subcase.x, curve.real, curve.imag, response.is_over_time, std::max(subcase.id, 0),
                    is_of_grid ? curve.id : 0, is_of_grid ? std::atoi(curve.component.c_str()) : 0, ordinate});
    }
  return out.take();
}

std::string make_uff(const records::FrequencyResponse& response) {
  UffText out;
  int number = 0;
  const auto n = static_cast<Eigen::Index>(response.value.size());
  for (int y = 0; y < response.outputs.size(); ++y)
    for (int u = 0; u < response.inputs.size(); ++u) {
      UffFunction f{response.outputs.name[static_cast<std::size_t>(y)] + " / " +
                        response.inputs.name[static_cast<std::size_t>(u)],
                    response.frequency_hz, Eigen::VectorXd(n), Eigen::VectorXd(n), false};
      f.is_transfer = true;
      for (Eigen::Index i = 0; i < n; ++i) {
        const auto value = response.value[static_cast<std::size_t>(i)](y, u);
        f.real(i) = value.real();
        f.imag(i) = value.imag();
      }
      put_function(out, ++number, f);
    }
  return out.take();
}

}  // namespace bough::exports
