#include "fe/loads/second_order.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>

#include "fe/model/element_loop.hpp"

namespace bough::fe {
namespace {

using Weights = Eigen::Matrix<double, 6, Eigen::Dynamic>;  ///< of a 3 x 3 form, per load

/// Lower triangle of K_arm, in the order of QuadraticForm.
Eigen::Matrix<double, 6, 1> calc_arm_weights(const Vector3d& f, const Vector3d& arm) {
  const Matrix3d K = calc_arm_stiffness(f, arm);
  Eigen::Matrix<double, 6, 1> w;
  w << K(0, 0), K(1, 0), K(2, 0), K(1, 1), K(2, 1), K(2, 2);
  return w;
}

/// Forms on the rotations of grids, one a grid: what many elements do there is summed.
class GridForms {
 public:
  GridForms(const Model& model, Eigen::Index num_loads)
      : num_loads_(num_loads), place_(static_cast<std::size_t>(model.num_gdofs()), -1) {}

  Weights& find(int first_rotation) {
    int& place = place_[static_cast<std::size_t>(first_rotation)];
    if (place < 0) {
      place = static_cast<int>(weights_.size());
      weights_.emplace_back(Weights::Zero(6, num_loads_));
    }
    return weights_[static_cast<std::size_t>(place)];
  }
  /// use(first rotation, weights), ascending.
  template <class Use>
  void visit(const Use& use) {
    for (std::size_t first = 0; first < place_.size(); ++first)
      if (place_[first] >= 0) use(static_cast<int>(first), weights_[static_cast<std::size_t>(place_[first])]);
  }

 private:
  Eigen::Index num_loads_;
  std::vector<int> place_;
  std::vector<Weights> weights_;
};

/// -f·(zᵀ Q z) of every point is ½ zᵀ W z. f: forces on the points in the twelve inertial loads.
void add_field(const Element& element, const MatrixXd& f, const CarriedField& field, const MatrixXd& A_I,
               std::vector<QuadraticForm>& forms) {
  const auto r = static_cast<int>(field.L.rows());
  const auto num_terms = 3 * static_cast<Eigen::Index>(field.parts.size()), num_points = f.rows() / 3;
  MatrixXd W(r * (r + 1) / 2, num_terms), by_load(num_terms, 12);  // of unit forces; forces
  Eigen::Index term = 0;
  for (const auto& part : field.parts)
    for (int a = 0; a < 3; ++a, ++term) {
      const auto& Q = part.Q[static_cast<std::size_t>(a)];
      for (int j = 0; j < r; ++j)
        for (int i = j; i < r; ++i) W(find_weight(r, i, j), term) = -(Q(i, j) + Q(j, i));
      by_load.row(term) = f.row(a * num_points + part.point);
    }
  MatrixXd weights = W * (by_load * A_I);
  if (!weights.isZero(0)) forms.push_back({element.gdofs(), field.L, std::move(weights)});
}

/// Weights of a rotation under the forces f: 6 x 12.
Eigen::Matrix<double, 6, 12> calc_turn_weights(const CarriedTurn& turn, const MatrixXd& f) {
  Eigen::Matrix<double, 6, 12> weights = Eigen::Matrix<double, 6, 12>::Zero();
  const auto num_points = f.rows() / 3;
  for (const auto& part : turn.parts) {
    Eigen::Matrix<double, 6, 3> of_force;
    for (int a = 0; a < 3; ++a) of_force.col(a) = calc_arm_weights(part.B.row(a).transpose(), part.arm);
    for (int a = 0; a < 3; ++a) weights.noalias() += of_force.col(a) * f.row(a * num_points + part.point);
  }
  return weights;
}

/// Forms of elements: `grids` in the twelve inertial loads, `forms` in all loads.
struct CarriedForms {
  const Model& model;
  const MatrixXd& A_I;
  GridForms grids{model, 12};
  std::vector<QuadraticForm> forms = {};
  AccelerationFields fields{Eigen::Matrix<double, 12, 12>::Identity()};

  void add(int, const Element& element) {
    if (!element.offset_mass(model.mass_kind())) return;
    CarriedMass carried(element.num_dofs());
    if (!calc_carried(model, element, model.mass_kind(), carried)) return;
    const MatrixXd f = fields.calc_point_loads(carried);
    for (const auto& field : carried.fields) add_field(element, f, field, A_I, forms);
    for (const auto& turn : carried.turns) {
      const auto unit = calc_turn_weights(turn, f);
      if (turn.slot >= 0) {
        if (!unit.isZero(0)) grids.find(element.gdofs()[static_cast<std::size_t>(turn.slot)]) += unit;
      } else if (const Weights weights = unit * A_I; !weights.isZero(0)) {
        forms.push_back({element.gdofs(), turn.Theta, weights});
      }
    }
  }
  void merge(CarriedForms second) {
    second.grids.visit([&](int first_rotation, const Weights& unit) { grids.find(first_rotation) += unit; });
    std::move(second.forms.begin(), second.forms.end(), std::back_inserter(forms));
  }
};

void add_carried_masses(const Model& model, const MatrixXd& A_I, GridForms& grids, std::vector<QuadraticForm>& forms) {
  constexpr int kMinElementsOfThread = 500;  // fewer are done before a thread has started
  auto carried = sum_over_elements(model, get_all_elements(model), kMinElementsOfThread, [&] {
    return CarriedForms{model, A_I};
  });
  carried.grids.visit([&](int first_rotation, const Weights& unit) { grids.find(first_rotation) += unit * A_I; });
  std::move(carried.forms.begin(), carried.forms.end(), std::back_inserter(forms));
}

using NodesByDof = std::map<int, const Node*>;  ///< by first g-dof

NodesByDof find_nodes(const Model& model, const std::vector<int>& ldofs) {
  NodesByDof nodes;
  std::size_t k = 0;
  for (int ldof : ldofs) {
    while (k + 1 < model.nodes().size() && model.nodes()[k + 1].first_gdof <= ldof) ++k;
    nodes[model.nodes()[k].first_gdof] = &model.nodes()[k];
  }
  return nodes;
}

/// Forces on dofs in displacement axes. R: in basic, g-dof g at row[g].
MatrixXd take_displacement_axes(const NodesByDof& nodes, const std::vector<int>& row, const std::vector<int>& ldofs,
                                const Eigen::Ref<const MatrixXd>& R) {
  MatrixXd result(ldofs.size(), R.cols());
  for (std::size_t i = 0; i < ldofs.size(); ++i) {
    const Node& node = *std::prev(nodes.upper_bound(ldofs[i]))->second;
    const int c = ldofs[i] - node.first_gdof, first = row[static_cast<std::size_t>(node.first_gdof + 3 * (c / 3))];
    const auto k = static_cast<Eigen::Index>(i);
    if (node.num_dofs == 6)
      result.row(k) = node.R_basic_cd.col(c % 3).transpose() * R.middleRows<3>(first);
    else
      result.row(k) = R.row(first);
  }
  return result;
}

/// F - K u of the dofs that the links need, in the displacement axes. K is that of the elements without K_G0 of a
/// preload, as their internal forces are: what a link passes on is what an offset of the element would.
MatrixXd calc_residual(const Model& model, const std::vector<int>& ldofs, const MatrixXd& F,
                       const Eigen::Ref<const MatrixXd>& U) {
  const NodesByDof nodes = find_nodes(model, ldofs);
  std::vector<int> row(static_cast<std::size_t>(model.num_gdofs()), -1), gdofs;
  for (const auto& [first, node] : nodes)
    for (int c = 0; c < node->num_dofs; ++c) {
      row[static_cast<std::size_t>(first + c)] = static_cast<int>(gdofs.size());
      gdofs.push_back(first + c);
    }
  MatrixXd R = F(gdofs, Eigen::all), K;
  const auto subtract = [&](const std::vector<int>& own, const MatrixXd& stiffness) {
    if (stiffness.isZero(0)) return;
    const MatrixXd f = stiffness * U(own, Eigen::all);
    for (std::size_t i = 0; i < own.size(); ++i)
      if (const int r = row[static_cast<std::size_t>(own[i])]; r >= 0) R.row(r) -= f.row(static_cast<Eigen::Index>(i));
  };
  for (const auto& element : model.elements()) {
    const auto& own = element->gdofs();
    if (std::none_of(own.begin(), own.end(), [&](int g) { return row[static_cast<std::size_t>(g)] >= 0; })) continue;
    K.setZero(element->num_dofs(), element->num_dofs());
    element->add_stiffness(1, K);
    subtract(own, K);
  }
  return take_displacement_axes(nodes, row, ldofs, R);
}

}  // namespace

AppliedLoads make_loads(const AppliedLoad& load) { return {load.F, load.A_I, {load.arms}, {load.followers}}; }

namespace {

/// Forms that do not depend on displacements: carried masses, loads on arms and loads that follow.
std::vector<QuadraticForm> calc_forms_of_loads(const Model& model, const AppliedLoads& loads) {
  BOUGH_DEMAND(loads.A_I.cols() == loads.F.cols() && loads.A_I.rows() == 12);
  const Eigen::Index num = loads.F.cols();
  std::vector<QuadraticForm> forms;
  GridForms grids(model, num);
  if (!loads.A_I.isZero(0)) add_carried_masses(model, loads.A_I, grids, forms);
  for (std::size_t c = 0; c < loads.arms.size(); ++c)
    for (const auto& arm : loads.arms[c])
      grids.find(arm.first_rotation).col(static_cast<Eigen::Index>(c)) += calc_arm_weights(arm.force, arm.arm);
  grids.visit([&](int first, Weights& weights) {
    if (!weights.isZero(0)) forms.push_back({{first, first + 1, first + 2}, Matrix3d::Identity(), std::move(weights)});
  });
  for (std::size_t c = 0; c < loads.followers.size(); ++c)
    for (const auto& follower : loads.followers[c]) {
      forms.push_back({follower.gdofs, follower.L, MatrixXd::Zero(follower.weights.rows(), num)});
      forms.back().weights.col(static_cast<Eigen::Index>(c)) = follower.weights.col(0);
    }
  return forms;
}

}  // namespace

std::vector<QuadraticForm> calc_second_order(const Model& model, const AppliedLoads& loads,
                                             const Eigen::Ref<const MatrixXd>& U) {
  BOUGH_DEMAND(loads.F.cols() == U.cols());
  auto forms = calc_forms_of_loads(model, loads);
  if (!model.links().empty())
    for (auto& form : model.links().calc_forms(calc_residual(model, model.links().dependents(), loads.F, U)))
      forms.push_back(std::move(form));
  return forms;
}

std::vector<QuadraticForm> calc_second_order_of_forces(const Model& model, const AppliedLoads& loads,
                                                       const Eigen::Ref<const MatrixXd>& forces) {
  auto forms = calc_forms_of_loads(model, loads);
  if (model.links().empty()) return forms;
  const auto& ldofs = model.links().dependents();
  std::vector<int> row(static_cast<std::size_t>(model.num_gdofs()));
  std::iota(row.begin(), row.end(), 0);
  for (auto& form : model.links().calc_forms(take_displacement_axes(find_nodes(model, ldofs), row, ldofs, forces)))
    forms.push_back(std::move(form));
  return forms;
}

}  // namespace bough::fe
