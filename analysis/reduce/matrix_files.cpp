#include "analysis/reduce/matrix_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "analysis/common/inputs.hpp"
#include "analysis/reduce/point_files.hpp"
#include "formats/hdf5/grids_file.hpp"
#include "formats/matrices/matrix_reader.hpp"
#include "formats/matrices/mode_table.hpp"
#include "formats/toml/specs.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

using records::MatricesSpec;
using records::MatrixSource;
using stiffening::GivenMatrix;

namespace {

constexpr const char* kInertialNames[records::kNumInertialLoads] = {"ax",  "ay",  "az",  "alx",  "aly",  "alz",
                                                                    "wx2", "wy2", "wz2", "wxwy", "wxwz", "wywz"};
const std::vector<std::string> kStiffnessNames = {"K", "KGG", "KAA", "KFF", "KLL", "KAAX", "KXX"};
const std::vector<std::string> kMassNames = {"M", "MGG", "MAA", "MFF", "MLL", "MAAX", "MXX"};

Eigen::SparseMatrix<double, Eigen::RowMajor> to_eigen(const records::SparseMatrix& a) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(a.data.size());
  for (int i = 0; i < a.num_rows; ++i)
    for (int e = a.indptr[static_cast<std::size_t>(i)]; e < a.indptr[static_cast<std::size_t>(i) + 1]; ++e)
      entries.emplace_back(i, a.indices[static_cast<std::size_t>(e)], a.data[static_cast<std::size_t>(e)]);
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(a.num_rows, a.num_cols);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Reads each file once, though it may hold many of the matrices.
class MatrixFiles {
 public:
  MatrixFiles(const MatricesSpec& spec, const records::Deck& deck, Diagnostics& diagnostics)
      : spec_(spec), deck_(deck), diagnostics_(diagnostics) {}

  GivenMatrix read(const MatrixSource& source, bool is_square, const std::vector<std::string>& usual = {}) {
    demand_file(source.file);
    GivenMatrix given;
    const auto name = choose_name(source, usual);
    const auto matrix = is_square ? matrices::read_real_square_matrix(source.file, name, diagnostics_)
                                  : matrices::read_matrix(source.file, name, diagnostics_);
    if (matrix.is_complex)
      throw InputError("matrices.complex", {source.file}, "matrix " + matrix.name + " is complex, expected real values",
                       "give real mode shapes or loads");
    given.values = to_eigen(matrix.values);
    given.row_dofs = matrix.row_dofs;
    complete(source, matrix.name, given);
    return given;
  }

  /// Label, place, dofs from elsewhere, axes.
  void complete(const MatrixSource& source, const std::string& name, GivenMatrix& given) {
    given.label = fs::path(source.file).filename().string() + (name.empty() ? "" : ":" + name);
    given.at = {source.file};
    const std::string beside = given.row_dofs.rows() == 0 ? find_dof_table(source.file) : "";
    if (!spec_.dofs.empty())
      given.row_dofs = get_dofs(spec_.dofs);
    else if (!beside.empty())
      given.row_dofs = get_dofs(beside);
    const bool is_ours =
        !beside.empty() || (is_hdf5(source.file) && hdf5::read_format(source.file) == "bough-matrices");
    given.is_basic = spec_.axes == records::MatrixAxes::Basic || (spec_.axes == records::MatrixAxes::Auto && is_ours);
    if (spec_.axes == records::MatrixAxes::Auto && !is_ours) note_axes(given);
  }

 private:
  std::string choose_name(const MatrixSource& source, const std::vector<std::string>& usual) {
    if (!source.name.empty() || usual.empty()) return source.name;
    auto& names = names_[source.file];
    if (names.empty())
      for (const auto& matrix : matrices::read_matrices(source.file, diagnostics_)) names.push_back(matrix.name);
    for (const auto& name : usual)
      if (std::find(names.begin(), names.end(), name) != names.end()) return name;
    return {};
  }

  const Eigen::MatrixXi& get_dofs(const std::string& path) {
    const auto [it, is_new] = dofs_.try_emplace(path);
    if (is_new) it->second = read_dof_table(path);
    return it->second;
  }

  void note_axes(const GivenMatrix& given) {
    if (has_note_) return;
    if (std::all_of(deck_.grids.begin(), deck_.grids.end(), [](const auto& g) { return g.cd == 0; })) return;
    has_note_ = true;
    diagnostics_.note("reduce.matrix-axes", given.at, "taken in the displacement systems (CD) of the deck's grids",
                      "axes = \"basic\" for matrices in basic axes");
  }

  const MatricesSpec& spec_;
  const records::Deck& deck_;
  Diagnostics& diagnostics_;
  std::map<std::string, std::vector<std::string>> names_;
  std::map<std::string, Eigen::MatrixXi> dofs_;
  bool has_note_ = false;
};

MatrixSource choose(const MatrixSource& source, const std::string& common) {
  return source.empty() ? MatrixSource{common, {}} : source;
}

const matrices::ModeTable& choose_table(const std::vector<matrices::ModeTable>& tables, const MatrixSource& source) {
  std::set<int> subcases;
  for (const auto& table : tables) subcases.insert(table.subcase);
  if (source.name.empty() && subcases.size() == 1) return tables.front();
  for (const auto& table : tables)
    if (std::to_string(table.subcase) == source.name) return table;
  throw InputError("cli.which-subcase", {source.file},
                   fmt::format("the file has modes of the subcases {}{}", fmt::join(subcases, ", "),
                               source.name.empty() ? "" : ", not of " + source.name),
                   "write FILE:SUBCASE");
}

/// A row per node and component; scalar points have one.
stiffening::GivenModes convert(const matrices::ModeTable& table) {
  stiffening::GivenModes modes;
  std::vector<std::pair<int, int>> dofs;
  for (std::size_t k = 0; k < table.node_id.size(); ++k)
    for (int c = 1; c <= (table.is_scalar[k] ? 1 : 6); ++c)
      dofs.emplace_back(table.node_id[k], table.is_scalar[k] ? 0 : c);
  const auto n = static_cast<Eigen::Index>(table.mode.size());
  Eigen::MatrixXd Phi(static_cast<Eigen::Index>(dofs.size()), n);
  modes.Phi.row_dofs.resize(Phi.rows(), 2);
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < table.node_id.size(); ++k)
    for (int c = 0; c < (table.is_scalar[k] ? 1 : 6); ++c, ++row) {
      Phi.row(row) = table.phi[k].row(c);
      modes.Phi.row_dofs.row(row) << dofs[static_cast<std::size_t>(row)].first,
          dofs[static_cast<std::size_t>(row)].second;
    }
  modes.Phi.values = Phi.sparseView();
  modes.eigenvalue = table.eigenvalue;
  return modes;
}

bool is_matrix_file(const std::string& path) {
  try {
    matrices::detect_format(path);
    return true;
  } catch (const InputError& error) {
    if (error.items().front().id == "matrices.unknown-format") return false;
    throw;
  }
}

}  // namespace

void add_matrices_option(const std::string& text, MatricesSpec& spec) {
  const auto equals = text.find('=');
  if (equals == std::string::npos) {
    spec.file = text;
    return;
  }
  const std::string key = text.substr(0, equals), value = text.substr(equals + 1);
  const auto source = toml_files::parse_matrix_source(value, spec.file);
  const auto inertial = std::find(std::begin(kInertialNames), std::end(kInertialNames), key);
  const auto fail = [&](const std::string& advice) -> InputError {
    return {"cli.bad-matrices", {}, "cannot read --matrices \"" + text + "\"", advice};
  };
  if (value.empty()) throw fail("write KEY=FILE or KEY=FILE:NAME");
  if (key == "K" || key == "stiffness")
    spec.stiffness = source;
  else if (key == "M" || key == "mass")
    spec.mass = source;
  else if (key == "B" || key == "damping")
    spec.damping = source;
  else if (key == "phi" || key == "modes")
    spec.modes = source;
  else if (key == "check" || key == "check_modes")
    spec.check_modes = source;
  else if (key == "dofs")
    spec.dofs = value;
  else if (key == "grids")
    spec.grids = value;
  else if (key == "axes" && (value == "basic" || value == "displacement"))
    spec.axes = value == "basic" ? records::MatrixAxes::Basic : records::MatrixAxes::Displacement;
  else if (key == "clamped" && value.find_first_not_of("0123456789") == std::string::npos && value.size() < 10)
    spec.clamped.push_back(std::stoi(value));
  else if (inertial != std::end(kInertialNames))
    spec.inertial[static_cast<std::size_t>(inertial - std::begin(kInertialNames))] = source;
  else
    throw fail("keys are K, M, B, phi, check, dofs, grids, axes=basic, axes=displacement, clamped=ID, and ax to wywz");
}

stiffening::GivenModes read_given_modes(const MatrixSource& source, const MatricesSpec& spec, const records::Deck& deck,
                                        Diagnostics& diagnostics) {
  demand_file(source.file);
  MatrixFiles files(spec, deck, diagnostics);
  if (is_matrix_file(source.file)) return {files.read(source, false), {}};
  const auto tables = matrices::read_mode_tables(source.file);
  const auto& table = choose_table(tables, source);
  auto modes = convert(table);
  modes.Phi.label = fs::path(source.file).filename().string();
  modes.Phi.at = {source.file};
  modes.Phi.is_basic = table.is_basic;
  return modes;
}

stiffening::GivenMatrices read_given_matrices(const MatricesSpec& spec, const records::Deck& deck,
                                              std::vector<std::string>& used, Diagnostics& diagnostics) {
  const auto add_file = [&](const MatrixSource& source) {
    if (!source.empty() && std::find(used.begin(), used.end(), source.file) == used.end()) used.push_back(source.file);
    return source;
  };
  MatrixFiles files(spec, deck, diagnostics);
  stiffening::GivenMatrices given;
  const auto K = choose(spec.stiffness, spec.file), M = choose(spec.mass, spec.file);
  for (const auto& [source, name] : {std::pair(K, "stiffness"), std::pair(M, "mass")})
    if (source.empty())
      throw InputError("cli.no-matrix", spec.at, std::string("the ") + name + " matrix is not given",
                       "give " + std::string(name) + " = \"FILE:NAME\", or file");
  given.K = files.read(add_file(K), true, kStiffnessNames);
  given.M = files.read(add_file(M), true, kMassNames);
  if (!spec.damping.empty()) given.B = files.read(add_file(spec.damping), true);
  if (!spec.modes.empty()) given.modes = read_given_modes(add_file(spec.modes), spec, deck, diagnostics);
  for (std::size_t i = 0; i < spec.inertial.size(); ++i) {
    if (spec.inertial[i].empty()) continue;
    stiffening::GivenGeometric g;
    g.name = kInertialNames[i];
    g.inertial = static_cast<int>(i);
    g.K_G = files.read(add_file(spec.inertial[i]), true);
    given.geometric.push_back(std::move(g));
  }
  for (const auto& from : spec.geometric) {
    stiffening::GivenGeometric g;
    g.name = from.name;
    g.K_G = files.read(add_file(from.matrix), true);
    if (!from.load.empty()) g.load = files.read(add_file(from.load), false);
    g.load_column = from.load_column;
    g.node = from.node;
    g.direction = from.direction;
    g.load_set = from.load_set;
    given.geometric.push_back(std::move(g));
  }
  given.mass_scale = spec.mass_scale;
  given.clamped = spec.clamped;
  return given;
}

}  // namespace bough::analysis
