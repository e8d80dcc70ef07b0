#include "fe/model/links.hpp"

#include <algorithm>
#include <set>

#include "base/rotation.hpp"
#include "fe/elements/carried.hpp"

namespace bough::fe {

int find_weight(int r, int i, int j) { return j * r - j * (j - 1) / 2 + i - j; }

MatrixXd calc_form(const QuadraticForm& form, Eigen::Index load) {
  const auto r = static_cast<int>(form.L.rows());
  MatrixXd W(r, r);
  for (int j = 0; j < r; ++j)
    for (int i = j; i < r; ++i) W(i, j) = W(j, i) = form.weights(find_weight(r, i, j), load);
  return form.L.transpose() * (W * form.L);
}

Links::Links(std::vector<Link> links, std::vector<ConstraintEquation> equations)
    : links_(std::move(links)), equations_(std::move(equations)) {
  if (links_.empty()) {
    equations_.clear();
    return;
  }
  std::map<int, int> equation_of;
  for (std::size_t e = 0; e < equations_.size(); ++e) equation_of[equations_[e].dependent] = static_cast<int>(e);
  for (const auto& [ldof, e] : equation_of) dependents_.push_back(ldof);
  // Equations that no other one depends on come first.
  std::vector<int> num_users(equations_.size(), 0);
  const auto for_each_carrier = [&](int e, const auto& visit) {
    for (const auto& [ldof, c] : equations_[static_cast<std::size_t>(e)].terms)
      if (const auto found = equation_of.find(ldof); found != equation_of.end()) visit(found->second);
  };
  const auto num = static_cast<int>(equations_.size());
  for (int e = 0; e < num; ++e)
    for_each_carrier(e, [&](int carrier) { ++num_users[static_cast<std::size_t>(carrier)]; });
  for (int e = 0; e < num; ++e)
    if (num_users[static_cast<std::size_t>(e)] == 0) order_.push_back(e);
  for (std::size_t i = 0; i < order_.size(); ++i)
    for_each_carrier(order_[i], [&](int carrier) {
      if (--num_users[static_cast<std::size_t>(carrier)] == 0) order_.push_back(carrier);
    });
}

std::vector<QuadraticForm> Links::calc_forms(const Eigen::Ref<const MatrixXd>& force) const {
  const auto find = [this](int ldof) -> Eigen::Index {
    const auto at = std::lower_bound(dependents_.begin(), dependents_.end(), ldof);
    return at != dependents_.end() && *at == ldof ? at - dependents_.begin() : -1;
  };
  MatrixXd carried = force, lambda(equations_.size(), force.cols());
  for (const int e : order_) {
    const auto& equation = equations_[static_cast<std::size_t>(e)];
    lambda.row(e) = carried.row(find(equation.dependent));
    for (const auto& [ldof, c] : equation.terms)
      if (const Eigen::Index row = find(ldof); row >= 0) carried.row(row) += c * lambda.row(e);
  }
  std::vector<QuadraticForm> forms;
  for (const Link& link : links_) {
    const auto r = static_cast<int>(link.L.rows());
    QuadraticForm form{link.gdofs, link.L, MatrixXd::Zero(r * (r + 1) / 2, force.cols())};
    for (std::size_t k = 0; k < link.W.size(); ++k)
      for (int j = 0; j < r; ++j)
        for (int i = j; i < r; ++i)
          if (const double w = link.W[k](i, j); w != 0)
            form.weights.row(find_weight(r, i, j)) += w * lambda.row(link.first_equation + static_cast<int>(k));
    if (!form.weights.isZero(0)) forms.push_back(std::move(form));
  }
  return forms;
}

LinkBuilder::LinkBuilder(const std::array<DofSum, 3>& v, const std::array<DofSum, 3>& theta) : v_(v) {
  rows_.assign(theta.begin(), theta.end());
}

int LinkBuilder::add_row(DofSum row) {
  rows_.push_back(std::move(row));
  return num_rows() - 1;
}

int LinkBuilder::find_own_rows(const Component& component) {
  const auto [found, is_new] = own_.try_emplace({component.node->first_gdof, component.is_rotation}, num_rows());
  for (int a = 0; a < 3 && is_new; ++a) {
    DofSum row;
    if (!component.is_rotation)
      for (const auto& [gdof, c] : v_[static_cast<std::size_t>(a)]) row[gdof] -= c;
    row[component.node->first_gdof + (component.is_rotation ? 3 : 0) + a] += 1;
    add_row(std::move(row));
  }
  return found->second;
}

/// Translation: (R e)·(x_i - x_o) = e·s, so e·u_i has the second order -(θ×e)·(u_i - v) - ½ (θ×(θ×e))·s, which for
/// three components is that of an arm. Rotation: the part of log(RᵀR_i) along e vanishes, e·θ_i has ½ e·(θ×θ_i).
void LinkBuilder::add_component(const Component& c, double factor) {
  if (c.is_rotation && c.is_whole) return;
  const Matrix3d arm = c.is_rotation ? Matrix3d::Zero() : calc_arm_stiffness(c.axis, c.place);
  const double sign = c.is_whole ? factor : -factor;
  for (int j = 0; j < 3; ++j)
    for (int i = j; i < 3; ++i) add_weight(i, j, sign * arm(i, j));
  if (c.is_whole) return;
  const int first = find_own_rows(c);
  const Matrix3d turn = (c.is_rotation ? 0.5 : 1.0) * skew(c.axis);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) add_weight(i, first + j, factor * turn(i, j));
}

Link LinkBuilder::finish(int first_equation) const {
  Link link;
  link.first_equation = first_equation;
  std::set<int> gdofs;
  for (const auto& row : rows_)
    for (const auto& [gdof, c] : row)
      if (c != 0) gdofs.insert(gdof);
  link.gdofs.assign(gdofs.begin(), gdofs.end());
  link.L = MatrixXd::Zero(num_rows(), static_cast<Eigen::Index>(link.gdofs.size()));
  for (int r = 0; r < num_rows(); ++r)
    for (const auto& [gdof, c] : rows_[static_cast<std::size_t>(r)])
      if (c != 0) link.L(r, std::lower_bound(link.gdofs.begin(), link.gdofs.end(), gdof) - link.gdofs.begin()) = c;
  for (const auto& weights : W_) {
    MatrixXd& W = link.W.emplace_back(MatrixXd::Zero(num_rows(), num_rows()));
    for (const auto& [at, value] : weights) W(at.first, at.second) = W(at.second, at.first) = value;
  }
  return link;
}

}  // namespace bough::fe
