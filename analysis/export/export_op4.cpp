#include <algorithm>
#include <cctype>
#include <sstream>

#include "analysis/common/body_files.hpp"
#include "analysis/export/export_matrices.hpp"
#include "analysis/export/op4_matrices.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/hdf5/sparse_file.hpp"

namespace bough::analysis {

namespace {

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

void put_body(Op4Matrices& out, const records::FlexBody& body, const std::optional<exports::ReducedSolid>& solid) {
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

std::string make_op4(const std::string& file, Diagnostics& diagnostics) {
  const auto format = read_file_format(file);
  Op4Matrices out;
  if (format == "bough-flexbody") {
    const auto body = read_body(file, diagnostics);
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
  } else if (format == "bough-linear") {
    const auto model = hdf5::read_linear_model(file);
    for (const auto& [name, matrix] : {std::pair{"A", &model.A}, {"B", &model.B}, {"C", &model.C}, {"D", &model.D}})
      out.put(name, *matrix);
    const auto second = records::make_second_order(model);
    for (const auto& [name, matrix] : {std::pair{"MASS", &second.M},
                                       {"DAMPING", &second.D},
                                       {"STIFF", &second.K},
                                       {"FORCE", &second.F},
                                       {"STATES", &second.Z}})
      out.put(name, *matrix);
  } else {
    refuse_export(file, "op4", "a flexible body, or what bough modes, matrices or linearize wrote");
  }
  return out.take();
}

}  // namespace bough::analysis
