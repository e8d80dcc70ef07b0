#include "export_matrices.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "bough/formats/export/reduced_solid.hpp"
#include "bough/formats/hdf5/files.hpp"
#include "bough/formats/hdf5/sparse_file.hpp"
#include "bough/formats/matrices/mat_file.hpp"
#include "bough/formats/matrices/op4.hpp"

namespace bough::cli {

namespace {

using matrices::MatArray;
using matrices::MatCells;
using matrices::MatFields;
using matrices::MatValue;

MatValue make_ids(const std::vector<int>& ids) {
  return Eigen::VectorXd(
      Eigen::Map<const Eigen::VectorXi>(ids.data(), static_cast<Eigen::Index>(ids.size())).cast<double>());
}

MatValue make_kinds(const std::vector<records::ModeKind>& kinds) {
  MatCells cells;
  for (const auto kind : kinds)
    cells.emplace_back(kind == records::ModeKind::Constraint   ? "constraint"
                       : kind == records::ModeKind::Attachment ? "attachment"
                                                               : "normal");
  return cells;
}

/// `dims` as in the contract's C order; get(i...) by index in that order.
template <class Get>
MatArray make_array(const std::vector<std::size_t>& dims, const Get& get) {
  MatArray array{dims, {}};
  std::size_t count = 1;
  for (const auto d : dims) count *= d;
  array.data.resize(count);
  std::vector<Eigen::Index> index(dims.size(), 0);
  for (std::size_t at = 0; at < count; ++at) {
    array.data[at] = get(index);
    for (std::size_t d = 0; d < dims.size() && ++index[d] == static_cast<Eigen::Index>(dims[d]); ++d) index[d] = 0;
  }
  return array;
}

using Index = std::vector<Eigen::Index>;

std::size_t to_size(Eigen::Index i) { return static_cast<std::size_t>(i); }

MatValue make_shapes(const std::vector<Eigen::MatrixXd>& phi, std::size_t num_modes) {
  return make_array({phi.size(), 6, num_modes}, [&](const Index& i) { return phi[to_size(i[0])](i[1], i[2]); });
}

MatValue make_stack(const std::vector<Eigen::MatrixXd>& stack, std::size_t n) {
  return make_array({stack.size(), n, n}, [&](const Index& i) { return stack[to_size(i[0])](i[1], i[2]); });
}

MatValue make_integrals(const records::MassIntegrals& s, std::size_t n) {
  return MatFields{
      {"gamma0", s.gamma0.transpose()},
      {"gamma1", s.gamma1.transpose()},
      {"gamma2", make_array({n, n, 3}, [&](const Index& i) { return s.gamma2[to_size(i[0])](i[2], i[1]); })},
      {"gamma3", make_array({n, 3, 3}, [&](const Index& i) { return s.gamma3[to_size(i[0])](i[1], i[2]); })},
      {"gamma4",
       make_array({n, n, 3, 3}, [&](const Index& i) { return s.gamma4[to_size(i[0])][to_size(i[1])](i[2], i[3]); })}};
}

std::vector<std::pair<std::string, const records::MassIntegrals*>> list_integrals(const records::FlexBody& body) {
  std::vector<std::pair<std::string, const records::MassIntegrals*>> found;
  for (const auto& [name, set] : {std::pair<std::string, const records::MassIntegrals*>{"lumped", &body.lumped},
                                  {"consistent", &body.consistent},
                                  {"exact", &body.exact}})
    if (!set->empty()) found.emplace_back(name, set);
  return found;
}

std::vector<Eigen::MatrixXd> list_inertial(const records::FlexBody& body) {
  std::vector<Eigen::MatrixXd> all(body.kg_inertial.begin(), body.kg_inertial.end());
  for (auto& m : all)
    if (m.size() == 0) m = Eigen::MatrixXd::Zero(body.num_modes(), body.num_modes());
  return all;
}

MatFields make_variables(const records::FlexBody& body) {
  const auto n = static_cast<std::size_t>(body.num_modes());
  MatFields integrals{{"method", body.integrals_method}};
  for (const auto& [name, set] : list_integrals(body)) integrals.emplace_back(name, make_integrals(*set, n));
  Eigen::VectorXd computed(records::kNumInertialLoads);
  for (int i = 0; i < records::kNumInertialLoads; ++i)
    computed(i) = body.kg_inertial_computed[static_cast<std::size_t>(i)];
  MatCells names;
  std::vector<int> nodes, directions;
  for (const auto& locator : body.locators) {
    names.emplace_back(locator.name);
    nodes.push_back(locator.node);
    directions.push_back(locator.direction);
  }
  MatFields stiffening{
      {"kg_inertial", make_stack(list_inertial(body), n)},
      {"computed", computed},
      {"kg_external", make_stack(body.kg_external, n)},
      {"locator", MatFields{{"name", names}, {"node", make_ids(nodes)}, {"direction", make_ids(directions)}}},
      {"external_load", body.external_load}};
  if (body.load_resultant.size() > 0) {
    stiffening.emplace_back("load_resultant", body.load_resultant);
    stiffening.emplace_back("load_moment", make_array({body.load_moment.size(), 3, n}, [&](const Index& i) {
                              return body.load_moment[to_size(i[0])](i[1], i[2]);
                            }));
  }
  MatFields variables{
      {"name", body.name},
      {"rigid", MatFields{{"mass", body.mass}, {"cg", body.cg}, {"inertia", body.inertia}}},
      {"nodes",
       MatFields{
           {"id", make_ids(body.node_id)}, {"xyz", body.node_xyz}, {"interface", make_ids(body.interface_nodes)}}},
      {"modes", MatFields{{"frequency_hz", body.frequency_hz},
                          {"eigenvalue", body.eigenvalue},
                          {"kind", make_kinds(body.kind)},
                          {"phi", make_shapes(body.phi, n)}}},
      {"modal",
       MatFields{{"mass", body.modal_mass}, {"stiffness", body.modal_stiffness}, {"damping", body.modal_damping}}},
      {"integrals", integrals},
      {"stiffening", stiffening},
      {"effective_mass", body.effective_mass}};
  if (body.F_I.size() > 0) variables.emplace_back("inertial_loads", MatFields{{"f", body.F_I}});
  if (body.dof_map.size() > 0) variables.emplace_back("dof_map", body.dof_map.cast<double>());
  if (body.full_phi.size() > 0) variables.emplace_back("full", MatFields{{"phi", body.full_phi}});
  if (!body.mesh.grid_id.empty())
    variables.emplace_back("grids", MatFields{{"id", make_ids(body.mesh.grid_id)}, {"xyz", body.mesh.grid_xyz}});
  return variables;
}

/// Nothing for a body of normal modes; a warning for one whose constraint modes do not fit.
std::optional<exports::ReducedSolid> find_solid(const records::FlexBody& body, const std::string& file,
                                                Diagnostics& diagnostics) {
  if (std::find(body.kind.begin(), body.kind.end(), records::ModeKind::Constraint) == body.kind.end()) return {};
  std::string why;
  auto solid = exports::calc_reduced_solid(body, why);
  if (!solid)
    diagnostics.warning("export.no-frames", {file}, "P, K, M on the interface frames are left out: " + why,
                        "reduce with the interface nodes that the constraint modes belong to");
  return solid;
}

MatFields make_variables(const records::ModesResult& modes) {
  const auto n = static_cast<std::size_t>(std::max(modes.eigenvalue.size(), modes.load_factor.size()));
  const auto& rigid = modes.mass_properties;
  MatFields variables{{"rigid", MatFields{{"mass", rigid.mass},
                                          {"cg", rigid.cg},
                                          {"inertia", rigid.inertia},
                                          {"reference", rigid.reference},
                                          {"mass_matrix", rigid.rigid_mass}}},
                      {"nodes", MatFields{{"id", make_ids(modes.node_id)}, {"xyz", modes.node_xyz}}},
                      {"modes", MatFields{{"frequency_hz", modes.frequency_hz},
                                          {"eigenvalue", modes.eigenvalue},
                                          {"kind", make_kinds(modes.kind)},
                                          {"phi", make_shapes(modes.phi, n)},
                                          {"mass", modes.modal_mass}}},
                      {"effective_mass", modes.effective_mass}};
  if (modes.load_factor.size() > 0) variables.emplace_back("buckling", MatFields{{"load_factor", modes.load_factor}});
  return variables;
}

/// A name that MATLAB takes.
std::string make_name(std::string name) {
  for (auto& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  if (name.empty() || !std::isalpha(static_cast<unsigned char>(name.front()))) name = "x" + name;
  return name.substr(0, 63);
}

/// "a/b/c" puts the value into struct a, in it b, in it c.
void put(MatFields& fields, const std::string& path, MatValue value) {
  const auto slash = path.find('/');
  const auto name = make_name(path.substr(0, slash));
  const auto same = [&](const auto& field) { return field.first == name; };
  auto found = std::find_if(fields.begin(), fields.end(), same);
  if (slash == std::string::npos) {
    // Two names that differ in a sign only.
    auto unique = name;
    for (int k = 2; found != fields.end(); ++k) {
      unique = name.substr(0, 60) + "_" + std::to_string(k);
      found = std::find_if(fields.begin(), fields.end(), [&](const auto& field) { return field.first == unique; });
    }
    fields.emplace_back(unique, std::move(value));
    return;
  }
  if (found == fields.end() || !std::holds_alternative<MatFields>(found->second.value)) {
    fields.emplace_back(name, MatFields{});
    found = fields.end() - 1;
  }
  put(std::get<MatFields>(found->second.value), path.substr(slash + 1), std::move(value));
}

/// Compressed rows of a symmetric matrix hold (j, i) for every (i, j).
bool is_symmetric(const records::SparseMatrix& a) {
  if (a.num_rows != a.num_cols) return false;
  const auto find = [&](int row, int column) {
    const auto begin = a.indices.begin() + a.indptr[to_size(row)], end = a.indices.begin() + a.indptr[to_size(row) + 1];
    const auto at = std::lower_bound(begin, end, column);
    return at == end || *at != column ? 0.0 : a.data[to_size(at - a.indices.begin())];
  };
  for (int r = 0; r < a.num_rows; ++r)
    for (int k = a.indptr[to_size(r)]; k < a.indptr[to_size(r) + 1]; ++k)
      if (a.data[to_size(k)] != find(a.indices[to_size(k)], r)) return false;
  return true;
}

class Op4Text {
 public:
  void put(const std::string& name, const Eigen::MatrixXd& dense) {
    if (dense.size() == 0) return;
    records::SparseMatrix a;
    a.num_rows = static_cast<int>(dense.rows());
    a.num_cols = static_cast<int>(dense.cols());
    a.indptr.push_back(0);
    for (Eigen::Index r = 0; r < dense.rows(); ++r) {
      for (Eigen::Index c = 0; c < dense.cols(); ++c)
        if (dense(r, c) != 0) {
          a.indices.push_back(static_cast<int>(c));
          a.data.push_back(dense(r, c));
        }
      a.indptr.push_back(static_cast<int>(a.indices.size()));
    }
    put(name, a);
  }
  void put(const std::string& name, const records::SparseMatrix& a) {
    matrices::Matrix matrix;
    matrix.name = name;
    matrix.form = a.num_rows != a.num_cols ? matrices::kRectangular
                  : is_symmetric(a)        ? matrices::kSymmetric
                                           : matrices::kSquare;
    matrix.values = a;
    matrices::write_op4(out_, matrix, {});
  }
  std::string take() const { return out_.str(); }

 private:
  std::ostringstream out_;
};

std::string number(const std::string& name, int i, int width) {
  auto digits = std::to_string(i);
  digits.insert(0, to_size(std::max<Eigen::Index>(0, width - static_cast<Eigen::Index>(digits.size()))), '0');
  return name + digits;
}

Eigen::MatrixXd stack(const std::vector<Eigen::MatrixXd>& blocks) {
  if (blocks.empty()) return {};
  Eigen::MatrixXd all(static_cast<Eigen::Index>(blocks.size()) * blocks.front().rows(), blocks.front().cols());
  for (std::size_t k = 0; k < blocks.size(); ++k)
    all.middleRows(static_cast<Eigen::Index>(k) * blocks[k].rows(), blocks[k].rows()) = blocks[k];
  return all;
}

Eigen::MatrixXd make_nodes(const std::vector<int>& id, const Eigen::MatrixXd& xyz) {
  Eigen::MatrixXd nodes(static_cast<Eigen::Index>(id.size()), 4);
  for (Eigen::Index k = 0; k < nodes.rows(); ++k) nodes.row(k) << id[to_size(k)], xyz.row(k);
  return nodes;
}

void put_body(Op4Text& out, const records::FlexBody& body, const std::optional<exports::ReducedSolid>& solid) {
  out.put("MASS", Eigen::MatrixXd::Constant(1, 1, body.mass));
  out.put("CG", body.cg);
  out.put("INERTIA", body.inertia);
  out.put("NODES", make_nodes(body.node_id, body.node_xyz));
  out.put("FREQ", body.frequency_hz);
  out.put("LAMBDA", body.eigenvalue);
  out.put("PHI", stack(body.phi));
  out.put("MHH", body.modal_mass);
  out.put("KHH", body.modal_stiffness);
  out.put("BHH", body.modal_damping);
  for (const auto& [name, s] : list_integrals(body)) {
    const std::string initial(1, static_cast<char>(std::toupper(name.front())));
    const std::vector<Eigen::MatrixXd> gamma3(s->gamma3.begin(), s->gamma3.end());
    std::vector<Eigen::MatrixXd> gamma4;
    for (const auto& row : s->gamma4) {
      Eigen::MatrixXd wide(3, 3 * static_cast<Eigen::Index>(row.size()));
      for (std::size_t k = 0; k < row.size(); ++k) wide.middleCols(3 * static_cast<Eigen::Index>(k), 3) = row[k];
      gamma4.push_back(wide);
    }
    out.put("GAMMA0" + initial, s->gamma0);
    out.put("GAMMA1" + initial, s->gamma1);
    out.put("GAMMA2" + initial, stack(s->gamma2));
    out.put("GAMMA3" + initial, stack(gamma3));
    out.put("GAMMA4" + initial, stack(gamma4));
  }
  out.put("FI", body.F_I);
  for (int i = 0; i < records::kNumInertialLoads; ++i)
    if (body.kg_inertial_computed[to_size(i)]) out.put(number("KGI", i + 1, 2), body.kg_inertial[to_size(i)]);
  for (std::size_t e = 0; e < body.kg_external.size(); ++e)
    out.put(number("KGE", static_cast<int>(e) + 1, 4), body.kg_external[e]);
  out.put("FEXT", body.external_load);
  out.put("LOADRES", body.load_resultant);
  out.put("LOADMOM", stack(body.load_moment));
  out.put("EFFMASS", body.effective_mass);
  out.put("DOFMAP", body.dof_map.cast<double>());
  out.put("FULLPHI", body.full_phi);
  if (!solid) return;
  out.put("PIF", solid->P);
  out.put("KIF", solid->K);
  out.put("MIF", solid->M);
  out.put("BIF", solid->C);
}

/// "KG/LOAD_3" -> "KG3", as `matrices --to op4`.
std::string make_op4_name(const std::string& path) {
  std::string name;
  for (std::size_t i = path.rfind("KG/LOAD_", 0) == 0 ? (name = "KG", 8) : 0; i < path.size(); ++i)
    if (std::isalnum(static_cast<unsigned char>(path[i])))
      name += static_cast<char>(std::toupper(static_cast<unsigned char>(path[i])));
  return name.substr(0, 8);
}

}  // namespace

std::string read_file_format(const std::string& file) {
  const auto attributes = hdf5::read_info(file).attributes;
  const auto found = attributes.find("format");
  return found == attributes.end() ? std::string{} : found->second;
}

void refuse_export(const std::string& file, const std::string& format, const std::string& expected) {
  throw InputError("cli.no-export", {file},
                   "a file of format \"" + read_file_format(file) + "\" has no export to " + format,
                   "give " + expected);
}

void export_mat(const std::string& file, const std::string& output, Diagnostics& diagnostics) {
  const auto format = read_file_format(file);
  MatFields variables;
  if (format == "bough-flexbody") {
    const auto body = hdf5::read_flex_body(file);
    variables = make_variables(body);
    if (const auto solid = find_solid(body, file, diagnostics); solid) {
      variables.emplace_back("P", solid->P);
      variables.emplace_back("K", solid->K);
      variables.emplace_back("M", solid->M);
      variables.emplace_back("C", solid->C);
      variables.emplace_back("frame_node", make_ids(solid->node));
    }
  } else if (format == "bough-modes") {
    variables = make_variables(hdf5::read_modes(file));
  } else if (format == "bough-matrices") {
    auto set = hdf5::read_sparse_file(file);
    for (auto& [path, matrix] : set.matrices) put(variables, path, std::move(matrix));
    variables.emplace_back("dof_map", set.dof_map.cast<double>());
  } else if (format == "bough-results") {
    const auto results = hdf5::read_results(file);
    variables.emplace_back("time", results.time);
    for (const auto& [path, values] : results.channels)
      if (path != "/time") put(variables, path.substr(1), values);
  } else {
    refuse_export(file, "mat", "a flexible body, or what bough modes, matrices or run wrote");
  }
  matrices::write_mat(output, variables);
}

std::string make_op4(const std::string& file, Diagnostics& diagnostics) {
  const auto format = read_file_format(file);
  Op4Text out;
  if (format == "bough-flexbody") {
    const auto body = hdf5::read_flex_body(file);
    put_body(out, body, find_solid(body, file, diagnostics));
  } else if (format == "bough-modes") {
    const auto modes = hdf5::read_modes(file);
    out.put("NODES", make_nodes(modes.node_id, modes.node_xyz));
    out.put("FREQ", modes.frequency_hz);
    out.put("LAMBDA", modes.eigenvalue);
    out.put("FACTOR", modes.load_factor);
    out.put("PHI", stack(modes.phi));
    out.put("EFFMASS", modes.effective_mass);
  } else if (format == "bough-matrices") {
    const auto set = hdf5::read_sparse_file(file);
    for (const auto& [path, matrix] : set.matrices) out.put(make_op4_name(path), matrix);
    out.put("DOFMAP", set.dof_map.cast<double>());
  } else {
    refuse_export(file, "op4", "a flexible body, or what bough modes or matrices wrote");
  }
  return out.take();
}

}  // namespace bough::cli
