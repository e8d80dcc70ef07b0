#include "fe/loads/inertial_loads.hpp"

#include "fe/loads/arm_strains.hpp"

#include "base/rotation.hpp"
#include "fe/linear/blas.hpp"
#include "fe/model/element_loop.hpp"

namespace bough::fe {
namespace {

/// Column of A_I for ω_a ω_b.
int find_product(int a, int b) { return a == b ? 6 + a : 8 + a + b; }

/// Nodal displacements as if the grids were accelerated: translations a_o + A x and rotations α.
MatrixXd calc_grid_field(const Model& model, const MatrixXd& A_I) {
  MatrixXd X = MatrixXd::Zero(model.num_gdofs(), A_I.cols());
  for (Eigen::Index c = 0; c < A_I.cols(); ++c) {
    const auto field = calc_acceleration_field(A_I.col(c));
    for (const Node& node : model.nodes()) {
      if (node.num_dofs != 6) continue;
      X.block<3, 1>(node.first_gdof, c) = field.a_o + field.A * node.x;
      X.block<3, 1>(node.first_gdof + 3, c) = A_I.block<3, 1>(3, c);
    }
  }
  return X;
}

/// -M_e A c - Σ ω_r ω_s S_r P_s, P = M_e Φ_R of rotations about the mean c of the element's grids: each nodal momentum
/// turned as if it were that of a mass at the grid (NASA-CR-202063, eqs. 7-12). About a point of the element: mass that
/// differs by direction makes the turned momenta of a translation other than its inertial forces.
MatrixXd turn_momenta(const Model& model, const Element& element, const MatrixXd& M, const MatrixXd& A_I) {
  MatrixXd Phi_R = MatrixXd::Zero(element.num_dofs(), 3), moved = MatrixXd::Zero(element.num_dofs(), A_I.cols());
  std::vector<std::pair<int, Vector3d>> grids;  // first row, place
  int row = 0;
  for (int k : element.nodes()) {
    const Node& node = model.node(k);
    if (node.num_dofs == 6 && row + 6 <= element.num_dofs() &&
        element.gdofs()[static_cast<std::size_t>(row)] == node.first_gdof)
      grids.emplace_back(row, node.x);
    row += node.num_dofs;
  }
  Vector3d mean = Vector3d::Zero();
  for (const auto& [first, x] : grids) mean += x / static_cast<double>(grids.size());
  for (const auto& [first, x] : grids) {
    Phi_R.middleRows<3>(first) = -skew(x - mean);
    Phi_R.middleRows<3>(first + 3).setIdentity();
    for (Eigen::Index c = 0; c < A_I.cols(); ++c)
      moved.block<3, 1>(first, c) = calc_acceleration_field(A_I.col(c)).A * mean;
  }
  const MatrixXd P = M * Phi_R;
  MatrixXd F = -M * moved;
  for (int r = 0; r < 3; ++r)
    for (int s = 0; s < 3; ++s)
      for (const auto& [grid, x] : grids)
        for (const int first : {grid, grid + 3}) {
          const Vector3d turned = Vector3d::Unit(r).cross(Vector3d(P.block<3, 1>(first, s)));
          F.middleRows<3>(first) -= turned * A_I.row(find_product(r, s));
        }
  return F;
}

}  // namespace

AccelerationField calc_acceleration_field(const Vector12d& A_I) {
  AccelerationField field;
  field.a_o = A_I.head<3>();
  field.A = skew(A_I.segment<3>(3));
  // ω̃ω̃ = ω ωᵀ - |ω|² 1.
  Matrix3d products;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) products(a, b) = A_I[find_product(a, b)];
  field.A += products - products.trace() * Matrix3d::Identity();
  return field;
}

Vector12d calc_load_factors(const Vector3d& a_o, const Vector3d& alpha, const Vector3d& omega) {
  Vector12d A_I;
  A_I << a_o, alpha, omega.cwiseAbs2(), omega.x() * omega.y(), omega.x() * omega.z(), omega.y() * omega.z();
  return A_I;
}

bool calc_carried(const Model& model, const Element& element, MassKind kind, CarriedMass& carried) {
  Matrix3Xd x(3, element.nodes().size());
  for (Eigen::Index k = 0; k < x.cols(); ++k) x.col(k) = model.node(element.nodes()[static_cast<std::size_t>(k)]).x;
  if (!element.offset_mass(kind)->add_carried(kind, x, carried)) return false;
  carried.mu *= model.wtmass();
  return true;
}

AccelerationFields::AccelerationFields(const std::vector<AccelerationField>& fields)
    : num_(static_cast<Eigen::Index>(fields.size())), of_place_(4, 3 * num_) {
  for (Eigen::Index c = 0; c < num_; ++c) {
    const auto& field = fields[static_cast<std::size_t>(c)];
    for (int a = 0; a < 3; ++a) of_place_.col(a * num_ + c) << field.a_o[a], field.A.row(a).transpose();
  }
}

AccelerationFields::AccelerationFields(const MatrixXd& A_I)
    : AccelerationFields([&A_I] {
        std::vector<AccelerationField> fields;
        for (Eigen::Index c = 0; c < A_I.cols(); ++c) fields.push_back(calc_acceleration_field(A_I.col(c)));
        return fields;
      }()) {}

MatrixXd AccelerationFields::calc_point_loads(const CarriedMass& carried) const {
  const auto count = static_cast<Eigen::Index>(carried.points.size());
  MatrixXd places(count, 4), all(count, 3 * num_), loads(3 * count, num_);
  for (Eigen::Index s = 0; s < count; ++s) {
    const auto& point = carried.points[static_cast<std::size_t>(s)];
    places.row(s) << (point.is_place ? 1.0 : 0.0), point.x.transpose();
  }
  all.noalias() = (-carried.mu * places).eval() * of_place_;
  for (int a = 0; a < 3; ++a) loads.middleRows(a * count, count) = all.middleCols(a * num_, num_);
  return loads;
}

MatrixXd stack_motions(const CarriedMass& carried) {
  const auto count = static_cast<Eigen::Index>(carried.points.size());
  MatrixXd H(3 * count, carried.num_dofs);
  for (Eigen::Index r = 0; r < count; ++r)
    for (int a = 0; a < 3; ++a) H.row(a * count + r) = carried.points[static_cast<std::size_t>(r)].H.row(a);
  return H;
}

namespace {

/// Fewer are done before a thread has started.
constexpr int kMinElementsOfThread = 1000;

/// Change of the loads of a spin where mass is attached to rotations: the grids' own accelerations are not those of the
/// mass.
struct SpinLoads {
  const Model& model;
  MassKind kind;
  const MatrixXd &spin, &grid_field;
  const AccelerationFields& fields;
  MatrixXd loads = MatrixXd::Zero(grid_field.rows(), spin.cols());
  MatrixXd M = {}, f = {};

  void add(int, const Element& element) {
    if (!element.offset_mass(kind)) return;
    M.setZero(element.num_dofs(), element.num_dofs());
    element.add_mass(kind, model.wtmass(), M);
    f.resize(M.rows(), spin.cols());
    linear::multiply_dense(false, M, grid_field(element.gdofs(), Eigen::all), 0, f);
    CarriedMass carried(element.num_dofs(), CarriedDetail::Points);
    if (calc_carried(model, element, kind, carried)) {
      linear::multiply_dense(true, stack_motions(carried), fields.calc_point_loads(carried), 1, f);
    } else {
      f += turn_momenta(model, element, M, spin);
    }
    for (int i = 0; i < element.num_dofs(); ++i) loads.row(element.gdofs()[static_cast<std::size_t>(i)]) += f.row(i);
  }
  void merge(const SpinLoads& second) { loads += second.loads; }
};

}  // namespace

MatrixXd calc_inertial_loads(const Model& model, MassKind kind, const MatrixXd& A_I, const MassProduct& mass_times) {
  BOUGH_DEMAND(A_I.rows() == 12);
  MatrixXd F = -mass_times(calc_grid_field(model, A_I));
  MatrixXd spin = A_I;
  spin.topRows<6>().setZero();
  if (spin.isZero(0)) return F;
  const MatrixXd grid_field = calc_grid_field(model, spin);
  const AccelerationFields fields(spin);
  MatrixXd change = sum_over_elements(model, get_own_elements(model), kMinElementsOfThread, [&] {
                      return SpinLoads{model, kind, spin, grid_field, fields};
                    }).loads;
  linear::sum_over_ranks(change);
  return F + change;
}

MatrixXd calc_inertial_loads(const Model& model, MassKind kind, const MatrixXd& A_I) {
  return calc_inertial_loads(model, kind, A_I,
                             [&](const MatrixXd& X) -> MatrixXd { return calc_mass_times(model, kind, X); });
}

MatrixXd calc_inertial_loads(const Model& model, MassKind kind) {
  return calc_inertial_loads(model, kind, MatrixXd::Identity(12, 12));
}

MatrixXd calc_superelement_loads(const Model& model, MassKind kind, const MatrixXd& A_I,
                                 const std::vector<const Element*>& superelements) {
  MatrixXd spin = A_I, F = MatrixXd::Zero(model.num_gdofs(), A_I.cols()), M;
  spin.topRows<6>().setZero();
  const MatrixXd change = calc_grid_field(model, spin) - calc_grid_field(model, A_I);
  for (const auto* element : superelements) {
    M.setZero(element->num_dofs(), element->num_dofs());
    element->add_mass(kind, model.wtmass(), M);
    const MatrixXd f = M * change(element->gdofs(), Eigen::all) + turn_momenta(model, *element, M, spin);
    for (int i = 0; i < element->num_dofs(); ++i) F.row(element->gdofs()[static_cast<std::size_t>(i)]) += f.row(i);
  }
  return F;
}

bool has_approximate_mass(const Model& model, MassKind kind) {
  for (const auto& element : model.elements()) {
    CarriedMass carried(element->num_dofs(), CarriedDetail::Whether);
    if (element->offset_mass(kind) && !calc_carried(model, *element, kind, carried)) return true;
  }
  return false;
}

namespace {

/// ZᵀμZ of the points of carried masses, many at a time. Z: place (1 or 0, x) and motions in modes.
struct CarriedGram {
  const Model& model;
  MassKind kind;
  const MatrixXd& Phi;
  const MatrixXd& strain;
  Eigen::Index n = Phi.cols(), size = 4 + 3 * n, used = 0;
  MatrixXd gram = MatrixXd::Zero(size, size), Z = MatrixXd(512, size), mu_Z = Z, Phi_e = {}, u = {};

  void add(int, const Element& element) {
    if (!element.offset_mass(kind)) return;
    CarriedMass carried(element.num_dofs(), CarriedDetail::Points);
    if (!calc_carried(model, element, kind, carried)) return;
    const auto count = static_cast<Eigen::Index>(carried.points.size());
    if (used + count > Z.rows()) flush();
    if (count > Z.rows()) {
      Z.resize(count, size);
      mu_Z.resize(count, size);
    }
    Phi_e = Phi(element.gdofs(), Eigen::all);
    for (Eigen::Index r = 0; r < count; ++r) {
      const auto& point = carried.points[static_cast<std::size_t>(r)];
      Z(used + r, 0) = point.is_place ? 1 : 0;
      Z.row(used + r).segment<3>(1) = point.x.transpose();
    }
    u.resize(3 * count, n);
    linear::multiply_dense(false, stack_motions(carried), Phi_e, 0, u);
    if (strain.size() > 0)
      for (Eigen::Index r = 0; r < count; ++r) {
        const auto& point = carried.points[static_cast<std::size_t>(r)];
        if (point.is_place) continue;
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b) u.row(a * count + r) += point.x[b] * strain.row(a + 3 * b);
      }
    for (int a = 0; a < 3; ++a) Z.block(used, 4 + a * n, count, n) = u.middleRows(a * count, count);
    linear::multiply_dense(false, carried.mu, Z.middleRows(used, count), 0, mu_Z.middleRows(used, count));
    used += count;
  }
  void flush() {
    linear::multiply_dense(true, Z.topRows(used), mu_Z.topRows(used), 1, gram);
    used = 0;
  }
  void merge(CarriedGram second) {
    second.flush();
    flush();
    gram += second.gram;
  }
};

}  // namespace

MatrixXd calc_carried_gram(const Model& model, MassKind kind, const MatrixXd& Phi) {
  return calc_strained_gram(model, kind, Phi, MatrixXd::Zero(9, 0));
}

MatrixXd calc_strained_gram(const Model& model, MassKind kind, const MatrixXd& Phi, const MatrixXd& strain) {
  BOUGH_DEMAND(strain.cols() == 0 || (strain.rows() == 9 && strain.cols() == Phi.cols()));
  auto sum = sum_over_elements(model, get_own_elements(model), kMinElementsOfThread, [&] {
    return CarriedGram{model, kind, Phi, strain};
  });
  sum.flush();
  linear::sum_over_ranks(sum.gram);
  return sum.gram;
}

ArmStrainMass calc_arm_strain_mass(const Model& model, MassKind kind) {
  ArmStrainMass mass;
  mass.on_dofs = MatrixXd::Zero(model.num_gdofs(), 9);
  MatrixXd moment = MatrixXd::Zero(3, 3);
  visit_elements(model, get_own_elements(model), [&](int, const Element& element) {
    if (!element.offset_mass(kind)) return;
    CarriedMass carried(element.num_dofs(), CarriedDetail::Points);
    if (!calc_carried(model, element, kind, carried)) return;
    for (std::size_t s = 0; s < carried.points.size(); ++s) {
      const CarriedPoint& arm = carried.points[s];
      if (arm.is_place) continue;
      for (std::size_t r = 0; r < carried.points.size(); ++r) {
        const double mu = carried.mu(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(s));
        if (mu == 0) continue;
        const CarriedPoint& other = carried.points[r];
        for (int b = 0; b < 3; ++b)
          mass.on_dofs(element.gdofs(), Eigen::seqN(3 * b, 3)) += mu * arm.x[b] * other.H.transpose();
        if (!other.is_place) moment += mu * other.x * arm.x.transpose();
      }
    }
  });
  linear::sum_over_ranks(mass.on_dofs);
  linear::sum_over_ranks(moment);
  mass.moment = moment;
  return mass;
}

linear::SymmetricMatrix assemble_grid_mass(const Model& model, MassKind kind) {
  const double scale = model.wtmass();
  const auto is_carried = [&](const Element& e) {
    CarriedMass carried(e.num_dofs(), CarriedDetail::Whether);
    return e.offset_mass(kind) && calc_carried(model, e, kind, carried);
  };
  return assemble_some(
      model, [&](const Element& e, Eigen::Ref<MatrixXd> M) { e.add_mass(kind, scale, M); },
      [&](const Element& e) { return !is_carried(e); });
}

}  // namespace bough::fe
