#include "fe/elements/solid.hpp"

#include <algorithm>
#include <utility>

#include "fe/elements/geometric_projection.hpp"
#include "fe/linear/blas.hpp"
#include "fe/sections/stress.hpp"

namespace bough::fe {

/// Gradients at a quadrature point: of the shapes (3 x m) and of the incompatible modes (3 x num_modes()).
struct Solid::Field {
  VectorXd shape;
  Eigen::Matrix3Xd gradient;
  Eigen::Matrix3Xd modes;
  double weight = 0;
};

namespace {

/// Strain of a displacement column c along axis a with gradient g: rows of the strain-displacement matrix.
Eigen::Matrix<double, 6, 3> calc_strain_block(const Vector3d& g) {
  Eigen::Matrix<double, 6, 3> b;
  b << g.x(), 0, 0, 0, g.y(), 0, 0, 0, g.z(), g.y(), g.x(), 0, 0, g.z(), g.y(), g.z(), 0, g.x();
  return b;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> calc_strain_disp(const Eigen::Ref<const Eigen::Matrix3Xd>& gradient) {
  Eigen::Matrix<double, 6, Eigen::Dynamic> b(6, 3 * gradient.cols());
  for (int i = 0; i < gradient.cols(); ++i) b.middleCols<3>(3 * i) = calc_strain_block(gradient.col(i));
  return b;
}

/// Where a corner is in the middle of its element, in natural coordinates.
Vector3d calc_centre(SolidKind kind) {
  return kind == SolidKind::Penta ? Vector3d(1.0 / 3, 1.0 / 3, 0) : Vector3d(Vector3d::Zero());
}

/// Natural gradients of the incompatible modes, each of no mean over the element: 1 - ξ², 1 - η², 1 - ζ² of the brick;
/// r², s², rs minus their linear parts, and 1 - ζ², of the wedge.
Eigen::Matrix3Xd calc_mode_gradients(SolidKind kind, const Vector3d& at) {
  if (kind == SolidKind::Hexa) return Matrix3d(-2 * at.asDiagonal());
  const double r = at.x() - 1.0 / 3, s = at.y() - 1.0 / 3;
  Eigen::Matrix3Xd g(3, 4);
  g << 2 * r, 0, s, 0, 0, 2 * s, r, 0, 0, 0, 0, -2 * at.z();
  return g;
}

/// A cubic brick takes four points a direction unless the scheme says otherwise, for its mass always.
std::vector<SolidPoint> list_points(const SolidGeometry& g, bool mass) {
  if (is_cubic(g.midside))
    return calc_solid_points(g.kind, true, false, mass || g.scheme.points == 0 ? 4 : g.scheme.points);
  return calc_solid_points(g.kind, static_cast<int>(g.x.size()) > get_num_corners(g.kind), mass, g.scheme.points);
}

}  // namespace

Solid::Solid(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, SolidGeometry geometry,
             const Matrix6d& C_el, double density, std::shared_ptr<const SolidExpansion> expansion)
    : Element(id, std::move(card), std::move(nodes), std::move(gdofs)),
      geometry_(std::move(geometry)),
      C_el_(C_el),
      density_(density),
      expansion_(std::move(expansion)) {
  num_points_ = static_cast<int>(list_points(geometry_, false).size());
}

ElementShape Solid::shape() const {
  std::vector<int> corners(nodes().begin(), nodes().begin() + get_num_corners(geometry_.kind));
  const char* type = geometry_.kind == SolidKind::Hexa    ? "hexa8"
                     : geometry_.kind == SolidKind::Penta ? "penta6"
                     : geometry_.kind == SolidKind::Tetra ? "tetra4"
                                                          : "pyramid5";
  return {type, std::move(corners)};
}

std::vector<Solid::Field> Solid::calc_fields(bool mass) const {
  const int m = static_cast<int>(geometry_.x.size());
  Eigen::Matrix3Xd x(3, m), dshape(3, m);
  for (int i = 0; i < m; ++i) x.col(i) = geometry_.x[i];
  VectorXd shape(m);
  Matrix3d J0 = Matrix3d::Identity();
  if (has_modes()) {
    calc_solid_shape(geometry_.kind, geometry_.midside, calc_centre(geometry_.kind), shape, dshape);
    J0 = dshape * x.transpose();
  }
  std::vector<Field> fields;
  for (const auto& point : list_points(geometry_, mass)) {
    calc_solid_shape(geometry_.kind, geometry_.midside, point.natural, shape, dshape);
    const Matrix3d J = dshape * x.transpose();  // rows: dx/dξ
    Field f;
    f.shape = shape;
    f.gradient = J.inverse() * dshape;
    f.weight = point.weight * J.determinant();
    if (has_modes())
      f.modes = J0.determinant() / J.determinant() * J0.inverse() * calc_mode_gradients(geometry_.kind, point.natural);
    fields.push_back(std::move(f));
  }
  return fields;
}

/// Incompatible amplitudes (three per mode) from nodal displacements; `condensed` receives the condensed stiffness.
MatrixXd Solid::calc_mode_map(const std::vector<Field>& fields, MatrixXd* condensed) const {
  const int n = num_dofs(), m = 3 * num_modes();
  MatrixXd K = MatrixXd::Zero(n, n), Kau = MatrixXd::Zero(m, n), Kaa = MatrixXd::Zero(m, m);
  for (const auto& f : fields) {
    const auto B = calc_strain_disp(f.gradient);
    const Eigen::Matrix<double, 6, Eigen::Dynamic> stress = C_el_ * B;
    K.noalias() += f.weight * B.transpose() * stress;
    if (!has_modes()) continue;
    const auto Ba = calc_strain_disp(f.modes);
    Kaa += f.weight * Ba.transpose() * C_el_ * Ba;
    Kau.noalias() += f.weight * Ba.transpose() * stress;
  }
  MatrixXd map = MatrixXd::Zero(m, n);
  if (has_modes()) {
    map = -Kaa.ldlt().solve(Kau);
    K.noalias() += Kau.transpose() * map;
  }
  if (condensed) *condensed = std::move(K);
  return map;
}

void Solid::add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const {
  MatrixXd condensed;
  calc_mode_map(calc_fields(false), &condensed);
  K += scale * condensed;
}

void Solid::add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const {
  const int m = static_cast<int>(geometry_.x.size());
  MatrixXd scalar = MatrixXd::Zero(m, m);
  double total = 0;
  for (const auto& f : calc_fields(true)) {
    scalar.noalias() += density_ * f.weight * f.shape * f.shape.transpose();
    total += density_ * f.weight;
  }
  const double diagonal = scalar.diagonal().sum();
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      if (kind == MassKind::Lumped && i != j) continue;
      const double value =
          kind == MassKind::Lumped ? (diagonal > 0 ? scalar(i, i) * total / diagonal : 0) : scalar(i, j);
      for (int a = 0; a < 3; ++a) M(3 * i + a, 3 * j + a) += scale * value;
    }
}

MassSamples Solid::sample_mass(MassKind kind, const SpinAxis& spin) const {
  const int m = static_cast<int>(geometry_.x.size());
  Matrix3Xd x(3, m), dshape(3, m);
  for (int i = 0; i < m; ++i) x.col(i) = geometry_.x[static_cast<std::size_t>(i)] - spin.point;
  MassSamples samples;
  const auto add = [&](double mass, const VectorXd& shape, const Matrix3Xd& gradient) {
    MassSample s;
    s.mass = mass;
    s.r = x * shape;
    const VectorXd along = gradient.transpose() * spin.axis.cross(s.r);
    s.N.setZero(3, 3 * m);
    s.DN.setZero(3, 3 * m);
    for (int i = 0; i < m; ++i) {
      s.N.middleCols<3>(3 * i).diagonal().setConstant(shape[i]);
      s.DN.middleCols<3>(3 * i).diagonal().setConstant(along[i]);
    }
    samples.push_back(std::move(s));
  };
  if (kind == MassKind::Consistent) {
    for (const auto& f : calc_fields(true)) add(density_ * f.weight, f.shape, f.gradient);
    return samples;
  }
  MatrixXd M = MatrixXd::Zero(3 * m, 3 * m);
  add_mass(kind, 1, M);
  const auto points = list_nodes(geometry_.kind, geometry_.midside);
  VectorXd shape(m);
  for (int i = 0; i < m; ++i) {
    calc_solid_shape(geometry_.kind, geometry_.midside, points[static_cast<std::size_t>(i)], shape, dshape);
    Matrix3d J = dshape * x.transpose();
    if (!(J.determinant() > 0)) {  // corners of a brick that are one point: the gradient of its middle
      VectorXd unused(m);
      calc_solid_shape(geometry_.kind, geometry_.midside, calc_centre(geometry_.kind), unused, dshape);
      J = dshape * x.transpose();
    }
    add(M(3 * i, 3 * i), shape, J.inverse() * dshape);
  }
  return samples;
}

MatrixXd Solid::calc_force_map(const std::vector<Field>& fields) const {
  const MatrixXd modes = calc_mode_map(fields, nullptr);
  MatrixXd map(num_internal_forces(), num_dofs());
  for (std::size_t q = 0; q < fields.size(); ++q) {
    Eigen::Matrix<double, 6, Eigen::Dynamic> strain = calc_strain_disp(fields[q].gradient);
    if (has_modes()) strain += calc_strain_disp(fields[q].modes) * modes;
    map.middleRows<6>(6 * static_cast<int>(q)) = C_el_ * strain;
  }
  return map;
}

void Solid::calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const {
  force = calc_force_map(calc_fields(false)) * u;
}

void Solid::calc_internal_forces_of(const Eigen::Ref<const MatrixXd>& U, Eigen::Ref<MatrixXd> forces) const {
  linear::multiply_dense(false, calc_force_map(calc_fields(false)), U, 0, forces);
}

ThermalState Solid::calc_thermal(const ElementTemperature& given) const {
  const ElementTemperature T = given.calc_change(expansion_->tref);
  const auto fields = calc_fields(false);
  const int m = 3 * num_modes();
  MatrixXd Kaa = MatrixXd::Zero(m, m);
  VectorXd f_a = VectorXd::Zero(m), f_u = VectorXd::Zero(num_dofs());
  std::vector<Eigen::Matrix<double, 6, 1>> stress;
  ThermalState state(num_dofs(), num_internal_forces());
  VectorXd change(static_cast<Eigen::Index>(fields.size()));  // of temperature, at the points of quadrature
  double mean = 0, volume = 0;
  for (const auto& f : fields) {
    change[static_cast<Eigen::Index>(stress.size())] = f.shape.dot(T.node);
    mean += f.weight * f.shape.dot(T.node);
    volume += f.weight;
    const Eigen::Matrix<double, 6, 1> strain = f.shape.dot(T.node) * expansion_->alpha;
    stress.push_back(C_el_ * strain);
    f_u += f.weight * calc_strain_disp(f.gradient).transpose() * stress.back();
    state.energy += 0.5 * f.weight * strain.dot(stress.back());
    if (m == 0) continue;
    const auto Ba = calc_strain_disp(f.modes);
    Kaa += f.weight * Ba.transpose() * C_el_ * Ba;
    f_a += f.weight * Ba.transpose() * stress.back();
  }
  // The incompatible modes are condensed; the rest of their load acts on the nodes.
  VectorXd a = VectorXd::Zero(m);
  if (m > 0) {
    a = Kaa.ldlt().solve(f_a);
    f_u += calc_mode_map(fields, nullptr).transpose() * f_a;
    state.energy -= 0.5 * a.dot(f_a);
  }
  state.load += f_u;
  for (std::size_t q = 0; q < fields.size(); ++q) {
    auto at = state.force.segment<6>(6 * static_cast<int>(q));
    at -= stress[q];
    if (m > 0) at += C_el_ * (calc_strain_disp(fields[q].modes) * a);
  }
  state.strain = mean / volume * expansion_->alpha;
  const MatrixXd corner_strain = expansion_->alpha * (calc_corner_map() * change).transpose();
  state.corner_strain = corner_strain.reshaped();
  return state;
}

std::vector<std::string> Solid::internal_force_names() const {
  std::vector<std::string> names;
  for (int q = 1; q <= num_points_; ++q)
    for (const char* c : {"sxx", "syy", "szz", "sxy", "syz", "szx"})
      names.push_back(c + std::string("@") + std::to_string(q));
  return names;
}

std::vector<StressPoint> Solid::stress_points() const {
  StressPoint point;
  point.kind = StressKind::Solid;
  return {point};
}

MatrixXd Solid::calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const {
  MatrixXd mean = MatrixXd::Zero(6, forces.cols());
  double volume = 0;
  const auto fields = calc_fields(false);
  for (std::size_t q = 0; q < fields.size(); ++q) {
    mean += fields[q].weight * forces.middleRows<6>(6 * static_cast<int>(q));
    volume += fields[q].weight;
  }
  return mean / volume;
}

MatrixXd Solid::calc_corner_map() const {
  const auto points = list_points(geometry_, false);
  const int num = get_num_corners(geometry_.kind);
  const auto count = static_cast<Eigen::Index>(points.size());
  if (count < num) {
    Eigen::RowVectorXd weight(count);
    const auto fields = calc_fields(false);
    for (Eigen::Index q = 0; q < count; ++q) weight[q] = fields[static_cast<std::size_t>(q)].weight;
    return (weight / weight.sum()).replicate(num, 1);
  }
  MatrixXd L(count, num);
  VectorXd shape(num);
  Eigen::Matrix3Xd dshape(3, num);
  for (Eigen::Index q = 0; q < count; ++q) {
    calc_solid_shape(geometry_.kind, {}, points[static_cast<std::size_t>(q)].natural, shape, dshape);
    L.row(q) = shape.transpose();
  }
  return L.colPivHouseholderQr().solve(MatrixXd::Identity(count, count));
}

MatrixXd Solid::calc_corner_stresses(const Eigen::Ref<const VectorXd>& force) const {
  return Eigen::Map<const MatrixXd>(force.data(), 6, force.size() / 6) * calc_corner_map().transpose();
}

MatrixXd Solid::calc_strains(const Eigen::Ref<const MatrixXd>& forces) const {
  return C_el_.completeOrthogonalDecomposition().solve(calc_stresses(forces));
}

MatrixXd Solid::calc_corner_strains(const Eigen::Ref<const MatrixXd>& forces) const {
  const MatrixXd map = calc_corner_map();
  const auto law = C_el_.completeOrthogonalDecomposition();
  MatrixXd strains(6 * map.rows(), forces.cols());
  for (Eigen::Index c = 0; c < forces.cols(); ++c) {
    const VectorXd force = forces.col(c);
    const Eigen::Map<const MatrixXd> at_points(force.data(), 6, map.cols());
    strains.col(c) = MatrixXd(law.solve(MatrixXd(at_points * map.transpose()))).reshaped();
  }
  return strains;
}

void Solid::add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                                    Eigen::Ref<MatrixXd> K_G) const {
  const auto fields = calc_fields(false);
  const int m = static_cast<int>(geometry_.x.size());
  MatrixXd scalar = MatrixXd::Zero(m, m);
  for (std::size_t q = 0; q < fields.size(); ++q) {
    const auto s = force.segment<6>(6 * static_cast<int>(q));
    Matrix3d sigma;
    sigma << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    scalar.noalias() += fields[q].weight * fields[q].gradient.transpose() * sigma * fields[q].gradient;
  }
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j)
      for (int a = 0; a < 3; ++a) K_G(3 * i + a, 3 * j + a) += scale * scalar(i, j);
}

/// Σ_ij A_ij u_i·u_j with A = ∫ N_i,a σ_ab N_j,b, whose rows sum to zero, is -Σ_i<j A_ij (u_j - u_i)².
void Solid::add_projected_geometric_stiffness(const Eigen::Ref<const MatrixXd>& U,
                                              const Eigen::Ref<const MatrixXd>& Phi, GeometricProjection& sums) const {
  const auto fields = calc_fields(false);
  const int m = static_cast<int>(geometry_.x.size()), num_pairs = m * (m - 1) / 2;
  MatrixXd pairs(num_pairs, num_internal_forces());  // -A_ij per internal force
  for (int q = 0; q < num_points_; ++q) {
    const auto& f = fields[static_cast<std::size_t>(q)];
    for (int j = 0, k = 0; j < m; ++j)
      for (int i = 0; i < j; ++i, ++k) {
        const Vector3d a = f.gradient.col(i), b = -f.weight * f.gradient.col(j);
        pairs.block<1, 6>(k, 6 * q) << a.x() * b.x(), a.y() * b.y(), a.z() * b.z(), a.x() * b.y() + a.y() * b.x(),
            a.y() * b.z() + a.z() * b.y(), a.z() * b.x() + a.x() * b.z();
      }
  }
  auto terms = sums.add_terms(num_pairs);
  MatrixXd force(num_internal_forces(), U.cols());
  linear::multiply_dense(false, calc_force_map(fields), U, 0, force);
  linear::multiply_dense(false, pairs, force, 0, terms.weights);
  const MatrixXd X = Phi.transpose();
  for (int j = 0, k = 0; j < m; ++j)
    for (int i = 0; i < j; ++i, ++k)
      for (int a = 0; a < 3; ++a) add_square(X.col(3 * j + a) - X.col(3 * i + a), 1, terms.products.col(k));
}

SolidQuality calc_quality(const SolidGeometry& geometry) {
  const int m = static_cast<int>(geometry.x.size());
  Eigen::Matrix3Xd x(3, m), dshape(3, m);
  VectorXd shape(m);
  for (int i = 0; i < m; ++i) x.col(i) = geometry.x[static_cast<std::size_t>(i)];
  double volume = 0, reference = 0, min_J = 1e300, max_J = -1e300;
  for (const auto& point : list_points(geometry, false)) {
    calc_solid_shape(geometry.kind, geometry.midside, point.natural, shape, dshape);
    const double J = Matrix3d(dshape * x.transpose()).determinant();
    volume += point.weight * J;
    reference += point.weight;
    min_J = std::min(min_J, J);
    max_J = std::max(max_J, J);
  }
  if (volume == 0) return {};
  return {volume, (volume > 0 ? min_J : max_J) * reference / volume};
}

void turn_round(SolidGeometry& geometry, std::vector<int>& nodes) {
  // Corners, and with them edges, that change places: below and above, or two corners of a tetrahedron.
  using Pairs = std::vector<std::pair<int, int>>;
  static const Pairs corners[] = {{{0, 4}, {1, 5}, {2, 6}, {3, 7}}, {{0, 3}, {1, 4}, {2, 5}}, {{1, 2}}, {{1, 3}}};
  static const Pairs edges[] = {
      {{0, 8}, {1, 9}, {2, 10}, {3, 11}}, {{0, 6}, {1, 7}, {2, 8}}, {{0, 2}, {4, 5}}, {{0, 3}, {1, 2}, {5, 7}}};
  const auto kind = static_cast<std::size_t>(geometry.kind);
  for (const auto& [a, b] : corners[kind]) {
    std::swap(geometry.x[static_cast<std::size_t>(a)], geometry.x[static_cast<std::size_t>(b)]);
    std::swap(nodes[static_cast<std::size_t>(a)], nodes[static_cast<std::size_t>(b)]);
  }
  if (geometry.midside.empty()) return;
  if (is_cubic(geometry.midside)) {
    for (std::size_t e = 0; e < 4; ++e)
      for (std::size_t k : {0U, 1U}) std::swap(geometry.midside[2 * e + k], geometry.midside[2 * (e + 8) + k]);
    for (std::size_t e = 4; e < 8; ++e) std::swap(geometry.midside[2 * e], geometry.midside[2 * e + 1]);
    return;
  }
  for (const auto& [a, b] : edges[kind])
    std::swap(geometry.midside[static_cast<std::size_t>(a)], geometry.midside[static_cast<std::size_t>(b)]);
}

}  // namespace bough::fe
