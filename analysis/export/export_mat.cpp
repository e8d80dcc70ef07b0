#include "analysis/export/export_matrices.hpp"

#include <algorithm>
#include <cctype>

#include "analysis/common/body_files.hpp"
#include "analysis/export/linear_mat.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/hdf5/sparse_file.hpp"
#include "formats/hdf5/sweep_file.hpp"
#include "formats/matrices/mat_file.hpp"
#include "formats/records/mode_kind.hpp"

namespace bough::analysis {

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
  for (const auto kind : kinds) cells.emplace_back(records::get_name(kind));
  return cells;
}

MatValue make_events(const std::vector<records::EventRecord>& events) {
  Eigen::VectorXd time(static_cast<Eigen::Index>(events.size()));
  MatCells what, source;
  for (std::size_t i = 0; i < events.size(); ++i) {
    time[static_cast<Eigen::Index>(i)] = events[i].time;
    what.emplace_back(events[i].what);
    source.emplace_back(events[i].source);
  }
  return MatFields{{"time", time}, {"what", what}, {"source", source}};
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

using Subscripts = std::vector<Eigen::Index>;

MatValue make_shapes(const std::vector<Eigen::MatrixXd>& phi, std::size_t num_modes) {
  return make_array({phi.size(), 6, num_modes}, [&](const Subscripts& i) { return phi[to_size(i[0])](i[1], i[2]); });
}

MatValue make_stack(const std::vector<Eigen::MatrixXd>& stack, std::size_t n) {
  return make_array({stack.size(), n, n}, [&](const Subscripts& i) { return stack[to_size(i[0])](i[1], i[2]); });
}

MatValue make_integrals(const records::MassIntegrals& s, std::size_t n) {
  return MatFields{
      {"gamma0", s.gamma0.transpose()},
      {"gamma1", s.gamma1.transpose()},
      {"gamma2", make_array({n, n, 3}, [&](const Subscripts& i) { return s.gamma2[to_size(i[0])](i[2], i[1]); })},
      {"gamma3", make_array({n, 3, 3}, [&](const Subscripts& i) { return s.gamma3[to_size(i[0])](i[1], i[2]); })},
      {"gamma4", make_array({n, n, 3, 3},
                            [&](const Subscripts& i) { return s.gamma4[to_size(i[0])][to_size(i[1])](i[2], i[3]); })}};
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
    stiffening.emplace_back("load_moment", make_array({body.load_moment.size(), 3, n}, [&](const Subscripts& i) {
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

}  // namespace

void export_mat(const std::string& file, const std::string& output, Diagnostics& diagnostics) {
  const auto format = read_file_format(file);
  MatFields variables;
  if (format == "bough-flexbody") {
    const auto body = read_body(file, diagnostics);
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
    variables.emplace_back("events", make_events(results.events));
  } else if (format == "bough-linear") {
    const auto model = hdf5::read_linear_model(file);
    variables = make_linear_fields(model);
    for (auto& field : make_second_order_fields(model)) variables.push_back(std::move(field));
  } else if (format == "bough-sweep") {
    variables = make_sweep_fields(hdf5::read_sweep(file));
  } else {
    refuse_export(file, "mat", "a flexible body, or what bough modes, matrices, run or linearize wrote");
  }
  matrices::write_mat(output, variables);
}

}  // namespace bough::analysis
