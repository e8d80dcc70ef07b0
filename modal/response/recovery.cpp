#include "modal/response/recovery.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "fe/matrices/assembly.hpp"
#include "fe/statics/static_case.hpp"

namespace bough::modal::response {
namespace {

using namespace std::complex_literals;

/// u = W z with z = [q; d].
MatrixXd join_shapes(const ResponseModel& r) {
  MatrixXd W(r.Phi.rows(), r.Phi.cols() + r.Psi.cols());
  W << r.Phi, r.Psi;
  return W;
}

struct Rows {
  std::vector<std::pair<int, int>> dofs;
  std::vector<int> gdofs;  ///< rows in CD axes
};

Rows list_rows(const fe::Model& model, const std::vector<int>& grids) {
  Rows rows;
  for (const int id : grids) {
    const auto& node = model.node(model.find_node(id));
    for (int c = 0; c < node.num_dofs; ++c) {
      rows.dofs.emplace_back(id, node.num_dofs == 1 ? 0 : c + 1);
      rows.gdofs.push_back(node.first_gdof + c);
    }
  }
  return rows;
}

/// Rows of U (g-set, basic) in CD axes.
MatrixXd pick_rows(const fe::Model& model, const std::vector<int>& gdofs, MatrixXd U) {
  for (Eigen::Index c = 0; c < U.cols(); ++c) turn_to_cd(model, U.col(c));
  return U(gdofs, Eigen::all);
}

/// Forces of the supports at rows (CD axes) per unit of z, ż, z̈ and p.
struct SupportForces {
  MatrixXd K, S, B, M, F;
};

SupportForces calc_support_forces(const fe::Model& model, const DampingChoice& damping, const Excitation& excitation,
                                  const MatrixXd& W, const std::vector<int>& gdofs) {
  const auto& fixed = model.fixed_dofs();
  const auto pick = [&](const MatrixXd& Y) {
    const MatrixXd held = model.T_fixed().transpose() * Y;
    MatrixXd rows = MatrixXd::Zero(static_cast<Eigen::Index>(gdofs.size()), Y.cols());
    for (std::size_t i = 0; i < gdofs.size(); ++i)
      if (const auto at = std::lower_bound(fixed.begin(), fixed.end(), gdofs[i]); at != fixed.end() && *at == gdofs[i])
        rows.row(static_cast<Eigen::Index>(i)) = held.row(at - fixed.begin());
    return rows;
  };
  return {pick(fe::calc_stiffness_times(model, W)), pick(times_structural(model, damping, W)),
          pick(times_damping(model, damping, W)), pick(fe::calc_mass_times(model, model.mass_kind(), W)),
          pick(excitation.F)};
}

/// Shapes of what elements carry, by card: components of all chosen elements, one column of W each.
struct ElementShapes {
  std::string card;
  std::vector<std::string> components;
  std::vector<int> ids;
  MatrixXd forces;  ///< (elements x components) x columns
};

std::vector<ElementShapes> calc_element_shapes(const fe::Model& model, const records::DynamicDeck& deck,
                                               const MatrixXd& W, const std::vector<int>& chosen) {
  const std::set<int> wanted(chosen.begin(), chosen.end());
  std::vector<ElementShapes> all;
  Diagnostics unsaid;  // without loads along beams there is nothing to say
  for (Eigen::Index c = 0; c < W.cols(); ++c) {
    std::size_t at = 0;
    for (const auto& block : fe::calc_element_forces(model, W.col(c), deck, 0, unsaid)) {
      std::vector<int> rows;
      for (std::size_t i = 0; i < block.id.size(); ++i)
        if (wanted.count(block.id[i]) > 0) rows.push_back(static_cast<int>(i));
      if (rows.empty() || block.components.empty()) continue;
      if (c == 0) {
        all.push_back({block.card, block.components, {}, {}});
        for (const int i : rows) all.back().ids.push_back(block.id[static_cast<std::size_t>(i)]);
        all.back().forces.resize(static_cast<Eigen::Index>(rows.size()) * block.force.cols(), W.cols());
      }
      const MatrixXd values = block.force(rows, Eigen::all).transpose();
      all[at++].forces.col(c) = Eigen::Map<const VectorXd>(values.data(), values.size());
    }
  }
  return all;
}

template <class Values>
struct Series {
  Values z, z_dot, z_ddot, p;
};

void store(const MatrixXcd& values, MatrixXd& real, MatrixXd& imag) {
  real = values.real().transpose();
  imag = values.imag().transpose();
}
void store(const MatrixXd& values, MatrixXd& real, MatrixXd&) { real = values.transpose(); }

MatrixXcd add_structural(const MatrixXcd& force, const MatrixXd& S, const MatrixXcd& z) { return force + 1i * (S * z); }
MatrixXd add_structural(const MatrixXd& force, const MatrixXd&, const MatrixXd&) { return force; }

template <class Values>
void recover_series(const fe::Model& model, const records::DynamicDeck& deck, const ResponseModel& response,
                    const Excitation& excitation, const DampingChoice& damping,
                    const std::vector<OutputChoice>& outputs, const Series<Values>& s,
                    records::ResponseSubcase& result) {
  const MatrixXd W = join_shapes(response);
  for (const auto& output : outputs) {
    if (output.quantity == "force") {
      for (auto& shapes : calc_element_shapes(model, deck, W, output.ids)) {
        records::ElementCurves curves{shapes.card, shapes.components, shapes.ids,       {},
                                      {},          output.is_phase,   output.is_punched};
        store(Values(shapes.forces * s.z), curves.real, curves.imag);
        result.elements.push_back(std::move(curves));
      }
      continue;
    }
    const auto rows = list_rows(model, output.ids);
    records::ResponseCurves curves{output.quantity, rows.dofs, {}, {}, output.is_phase, output.is_punched};
    if (output.quantity == "spc_force") {
      const auto f = calc_support_forces(model, damping, excitation, W, rows.gdofs);
      const Values force = f.K * s.z + f.B * s.z_dot + f.M * s.z_ddot - f.F * s.p;
      store(add_structural(force, f.S, s.z), curves.real, curves.imag);
    } else {
      const MatrixXd U = pick_rows(model, rows.gdofs, W);
      const auto& z = output.quantity == "velocity" ? s.z_dot : output.quantity == "acceleration" ? s.z_ddot : s.z;
      store(Values(U * z), curves.real, curves.imag);
    }
    result.curves.push_back(std::move(curves));
  }
}

template <class Values>
Values stack(const Values& q, const Values& d) {
  Values z(q.rows() + d.rows(), q.cols());
  z << q, d;
  return z;
}

}  // namespace

void recover(const fe::Model& model, const records::DynamicDeck& deck, const ResponseModel& response,
             const Excitation& excitation, const DampingChoice& damping, const std::vector<OutputChoice>& outputs,
             const Spectrum& spectrum, records::ResponseSubcase& result) {
  Series<MatrixXcd> s;
  const Eigen::RowVectorXcd rate = 2i * std::numbers::pi * spectrum.hz.transpose().cast<std::complex<double>>();
  s.z = stack<MatrixXcd>(spectrum.q, spectrum.d);
  s.z_dot = s.z * rate.asDiagonal();
  s.z_ddot = s.z_dot * rate.asDiagonal();
  s.p = spectrum.a.topRows(excitation.F.cols());
  result.x = spectrum.hz;
  recover_series(model, deck, response, excitation, damping, outputs, s, result);
}

void recover(const fe::Model& model, const records::DynamicDeck& deck, const ResponseModel& response,
             const Excitation& excitation, const DampingChoice& damping, const std::vector<OutputChoice>& outputs,
             const History& history, records::ResponseSubcase& result) {
  Series<MatrixXd> s;
  s.z = stack<MatrixXd>(history.q, history.d);
  s.z_dot = stack<MatrixXd>(history.q_dot, history.d_dot);
  s.z_ddot = stack<MatrixXd>(history.q_ddot, history.d_ddot);
  s.p = history.a.topRows(excitation.F.cols());
  result.x = history.time;
  recover_series(model, deck, response, excitation, damping, outputs, s, result);
}

}  // namespace bough::modal::response
