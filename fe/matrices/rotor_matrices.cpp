#include "fe/matrices/rotor_matrices.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

#include "base/rotation.hpp"
#include "fe/elements/beam.hpp"
#include "fe/elements/damping.hpp"
#include "fe/elements/point_mass.hpp"
#include "fe/elements/shell.hpp"
#include "fe/elements/solid.hpp"

namespace bough::fe {
namespace {

/// Relative difference of K and of M under a rotation about the axis that is reported.
constexpr double kMaxAsymmetry = 1e-4;

using AddMatrix = std::function<void(const Element&, Eigen::Ref<MatrixXd>)>;

/// Σ of element matrices on the g-set.
SparseColumns sum(const Model& model, const std::vector<const Element*>& elements, const AddMatrix& add) {
  std::vector<Eigen::Triplet<double>> terms;
  for (const Element* element : elements) {
    const auto& dofs = element->gdofs();
    MatrixXd A = MatrixXd::Zero(element->num_dofs(), element->num_dofs());
    add(*element, A);
    for (Eigen::Index j = 0; j < A.cols(); ++j)
      for (Eigen::Index i = 0; i < A.rows(); ++i)
        if (A(i, j) != 0)
          terms.emplace_back(dofs[static_cast<std::size_t>(i)], dofs[static_cast<std::size_t>(j)], A(i, j));
  }
  SparseColumns S(model.num_gdofs(), model.num_gdofs());
  S.setFromTriplets(terms.begin(), terms.end());
  return S;
}

SparseColumns sum_mass(const Model& model, const Rotor& rotor) {
  return sum(model, rotor.elements,
             [&](const Element& e, Eigen::Ref<MatrixXd> M) { e.add_mass(model.mass_kind(), model.wtmass(), M); });
}
SparseColumns sum_stiffness(const Model& model, const Rotor& rotor) {
  return sum(model, rotor.elements, [&](const Element& e, Eigen::Ref<MatrixXd> K) { e.add_stiffness(1, K); });
}

/// ẽ at the translations and rotations of each grid.
SparseColumns make_spin_operator(const Model& model, const Vector3d& axis, const std::vector<int>& nodes) {
  const Matrix3d e = skew(axis);
  std::vector<Eigen::Triplet<double>> terms;
  for (const int node : nodes)
    for (int part = 0; part < 2; ++part)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          if (e(i, j) != 0)
            terms.emplace_back(model.node(node).first_gdof + 3 * part + i, model.node(node).first_gdof + 3 * part + j,
                               e(i, j));
  SparseColumns S(model.num_gdofs(), model.num_gdofs());
  S.setFromTriplets(terms.begin(), terms.end());
  return S;
}

/// Grids of the model.
std::vector<int> list_grids(const Model& model) {
  std::vector<int> grids;
  for (int i = 0; i < static_cast<int>(model.nodes().size()); ++i)
    if (model.node(i).num_dofs == 6) grids.push_back(i);
  return grids;
}

/// Norm of A ẽ - ẽ A over that of A ẽ, with translations and rotations of each grid scaled by the traces of A.
double calc_asymmetry(const Model& model, const std::vector<int>& nodes, const SparseColumns& A,
                      const SparseColumns& spin) {
  std::vector<Eigen::Triplet<double>> terms;
  for (const int node : nodes)
    for (int part = 0; part < 2; ++part) {
      const int first = model.node(node).first_gdof + 3 * part;
      const double trace = A.coeff(first, first) + A.coeff(first + 1, first + 1) + A.coeff(first + 2, first + 2);
      for (int i = 0; trace > 0 && i < 3; ++i) terms.emplace_back(first + i, first + i, 1 / std::sqrt(trace));
    }
  SparseColumns scale(A.rows(), A.cols());
  scale.setFromTriplets(terms.begin(), terms.end());
  const SparseColumns scaled = scale * A * scale;
  const SparseColumns turned = scaled * spin;
  const double size = turned.norm();
  return size > 0 ? SparseColumns(turned - SparseColumns(spin * scaled)).norm() / size : 0;
}

bool has_mass(const Element& element, MassKind kind) {
  MatrixXd M = MatrixXd::Zero(element.num_dofs(), element.num_dofs());
  element.add_mass(kind, 1, M);
  return !M.isZero(0);
}

SpinAxis get_spin(const Rotor& rotor) { return {rotor.point, rotor.axis}; }

MassSamples sample_point(const PointMass& element, const Eigen::Ref<const Matrix3Xd>& x, const SpinAxis& spin) {
  MatrixXd M = MatrixXd::Zero(6, 6);
  element.add_mass(MassKind::Consistent, 1, M);
  MassSample s;
  s.mass = M(0, 0);
  const Vector3d at =
      s.mass > 0 ? Vector3d(Vector3d(-M(4, 2), M(3, 2), -M(3, 1)) / s.mass) : Vector3d(Vector3d::Zero());
  s.arm = at;
  s.r = x.col(0) + at - spin.point;
  s.N.setZero(3, 6);
  s.N.leftCols<3>().setIdentity();
  s.N.rightCols<3>() = -skew(at);
  s.Theta.setZero(3, 6);
  s.Theta.rightCols<3>().setIdentity();
  s.DN = -skew(spin.axis.cross(s.r)) * s.Theta;
  s.J = M.bottomRightCorner<3, 3>() + s.mass * skew(at) * skew(at);
  return {s};
}

/// The mass of an element at points; none if the element has mass without such a description.
std::optional<MassSamples> sample_mass(const Element& element, const Model& model, const SpinAxis& spin) {
  const MassKind kind = model.mass_kind();
  Matrix3Xd x(3, static_cast<Eigen::Index>(element.nodes().size()));
  for (std::size_t i = 0; i < element.nodes().size(); ++i)
    x.col(static_cast<Eigen::Index>(i)) = model.node(element.nodes()[i]).x;
  if (const Beam* beam = element.as_beam()) return beam->sample_mass(kind, x, spin);
  if (const Solid* solid = element.as_solid()) return solid->sample_mass(kind, spin);
  if (const auto* shell = dynamic_cast<const Shell*>(&element)) return shell->sample_mass(kind, x, spin);
  if (const auto* point = dynamic_cast<const PointMass*>(&element); point && point->is_rigid())
    return sample_point(*point, x, spin);
  if (has_mass(element, kind)) return std::nullopt;
  return MassSamples{};
}

/// Gyroscopic matrix of the inertia of sections and points about a line of grids; false for an element with rotary
/// inertia that has none.
bool add_line_gyroscopic(const Element& element, const Model& model, const SpinAxis& spin, double scale,
                         Eigen::Ref<MatrixXd> G) {
  const Matrix3d e = skew(spin.axis);
  if (element.as_beam() != nullptr) {
    const auto samples = sample_mass(element, model, spin);
    for (const auto& s : *samples)
      G -= scale * spin.axis.dot((s.J - s.mass * skew(s.arm) * skew(s.arm)) * spin.axis) *
           (s.Theta.transpose() * (e * s.Theta));
    return true;
  }
  const auto n = element.num_dofs();
  if (n != 6 * static_cast<int>(element.nodes().size())) return !has_mass(element, model.mass_kind());
  MatrixXd M = MatrixXd::Zero(n, n);
  element.add_mass(model.mass_kind(), scale, M);
  const bool is_point = dynamic_cast<const PointMass*>(&element) != nullptr;
  for (int first = 3; first < n; first += 6) {
    const Matrix3d inertia = M.block<3, 3>(first, first);
    if (inertia.isZero(0)) continue;
    if (!is_point) return false;
    G.block<3, 3>(first, first) -= spin.axis.dot(inertia * spin.axis) * e;
  }
  return true;
}

/// Adds the gyroscopic and the centrifugal matrix of samples, per unit of spin and of its square.
void add_spin_terms(const MassSamples& samples, const SpinAxis& spin, RotorFrame frame, double scale,
                    Eigen::Ref<MatrixXd> G, Eigen::Ref<MatrixXd> Z) {
  const Matrix3d e = skew(spin.axis);
  for (const auto& s : samples) {
    // Velocity N u̇ + Ω V u: convection in the fixed frame, the velocity of the frame in the rotating one.
    const Matrix3Xd V = frame == RotorFrame::Fixed ? s.DN : Matrix3Xd(e * s.N);
    const MatrixXd momentum = (scale * s.mass) * s.N.transpose() * V;
    G += momentum - momentum.transpose();
    Z.noalias() -= (scale * s.mass) * V.transpose() * V;
    if (s.J.isZero(0)) continue;
    const Vector3d Je = s.J * spin.axis;
    Matrix3d of_rates = -skew(Je), of_angles = Matrix3d::Zero();
    if (frame == RotorFrame::Rotating) {
      of_rates += s.J * e + e * s.J;
      const Matrix3d outer = Je * spin.axis.transpose();
      of_angles = e * s.J * e + spin.axis.dot(Je) * Matrix3d::Identity() - 0.5 * (outer + outer.transpose());
    }
    G += scale * (s.Theta.transpose() * (of_rates * s.Theta));
    Z += scale * (s.Theta.transpose() * (of_angles * s.Theta));
  }
}

void append(const Element& element, const MatrixXd& A, std::vector<Eigen::Triplet<double>>& terms) {
  const auto& dofs = element.gdofs();
  for (Eigen::Index j = 0; j < A.cols(); ++j)
    for (Eigen::Index i = 0; i < A.rows(); ++i)
      if (A(i, j) != 0)
        terms.emplace_back(dofs[static_cast<std::size_t>(i)], dofs[static_cast<std::size_t>(j)], A(i, j));
}

SparseColumns to_matrix(const Model& model, const std::vector<Eigen::Triplet<double>>& terms) {
  SparseColumns A(model.num_gdofs(), model.num_gdofs());
  A.setFromTriplets(terms.begin(), terms.end());
  return A;
}

/// Elements that turn with the displacements: of the rotor, or all of them in the rotating frame.
std::vector<const Element*> list_turning(const Model& model, const Rotor& rotor) {
  if (rotor.frame == RotorFrame::Fixed) return rotor.elements;
  std::vector<const Element*> all;
  for (const auto& element : model.elements()) all.push_back(element.get());
  return all;
}

/// Elements of the model that are not on the rotor.
std::vector<const Element*> list_others(const Model& model, const Rotor& rotor) {
  const std::unordered_set<const Element*> own(rotor.elements.begin(), rotor.elements.end());
  std::vector<const Element*> others;
  for (const auto& element : model.elements())
    if (!own.contains(element.get())) others.push_back(element.get());
  return others;
}

void assemble_spin_terms(const Model& model, const Rotor& rotor, RotorMatrices& r) {
  const SpinAxis spin = get_spin(rotor);
  if (rotor.frame == RotorFrame::Fixed && !rotor.is_spatial) {
    r.gyroscopic = sum(model, rotor.elements, [&](const Element& e, Eigen::Ref<MatrixXd> G) {
      add_line_gyroscopic(e, model, spin, model.wtmass(), G);
    });
    r.centrifugal.resize(model.num_gdofs(), model.num_gdofs());
    return;
  }
  std::vector<Eigen::Triplet<double>> rates, angles;
  std::vector<const Element*> by_grids;  // their mass moves as the grids do
  MatrixXd G, Z;
  for (const Element* element : list_turning(model, rotor)) {
    const auto samples = sample_mass(*element, model, spin);
    if (!samples) {
      by_grids.push_back(element);
      continue;
    }
    G.setZero(element->num_dofs(), element->num_dofs());
    Z = G;
    add_spin_terms(*samples, spin, rotor.frame, model.wtmass(), G, Z);
    append(*element, G, rates);
    append(*element, Z, angles);
  }
  r.gyroscopic = to_matrix(model, rates);
  r.centrifugal = to_matrix(model, angles);
  if (by_grids.empty()) return;
  const SparseColumns M = sum(model, by_grids, [&](const Element& e, Eigen::Ref<MatrixXd> A) {
    e.add_mass(model.mass_kind(), model.wtmass(), A);
  });
  const SparseColumns e = make_spin_operator(model, rotor.axis, list_grids(model));
  r.gyroscopic += SparseColumns(M * e) + SparseColumns(e * M);
  r.centrifugal += SparseColumns(e * SparseColumns(M * e));
}

/// Largest relative difference of the inertia, and of the strain energy of bending, between directions across the axis.
std::pair<double, double> calc_spatial_asymmetry(const Model& model, const Rotor& rotor, const SparseColumns& M,
                                                 const SparseColumns& K) {
  const Vector3d e = rotor.axis, a = e.unitOrthogonal(), b = e.cross(a);
  MatrixXd rigid = MatrixXd::Zero(model.num_gdofs(), 4), bent = MatrixXd::Zero(model.num_gdofs(), 2);
  for (const int node : rotor.nodes) {
    const auto& grid = model.node(node);
    const Vector3d r = grid.x - rotor.point;
    const double z = r.dot(e);
    for (int k = 0; k < 2; ++k) {
      const Vector3d across = k == 0 ? a : b, about = k == 0 ? b : Vector3d(-a);
      rigid.col(k).segment<3>(grid.first_gdof) = across;
      rigid.col(2 + k).segment<3>(grid.first_gdof) = across.cross(r);
      rigid.col(2 + k).segment<3>(grid.first_gdof + 3) = across;
      bent.col(k).segment<3>(grid.first_gdof) = 0.5 * z * z * across - r.dot(across) * z * e;
      bent.col(k).segment<3>(grid.first_gdof + 3) = z * about;
    }
  }
  const Eigen::Matrix4d J = rigid.transpose() * (M * rigid);
  const auto differ = [](const Eigen::Matrix2d& E) {
    const double mean = 0.5 * E.trace();
    return mean > 0 ? (E - mean * Eigen::Matrix2d::Identity()).norm() / mean : 0;
  };
  // The centre of mass is on the axis if a translation has no moment about it in its plane.
  const double spread = std::sqrt(J(0, 0) * J(2, 2));
  const double offset = spread > 0 ? std::abs(J(0, 2)) / spread : 0;
  return {std::max(differ(J.bottomRightCorner<2, 2>()), offset), differ(bent.transpose() * (K * bent))};
}

std::string describe(const Element& element) { return element.card() + " " + std::to_string(element.id()); }

/// Returns true if the mass of the element has its gyroscopic matrix.
bool has_gyroscopic(const Element& element, const Model& model, const Rotor& rotor) {
  if (rotor.frame == RotorFrame::Rotating) return true;
  if (rotor.is_spatial) return sample_mass(element, model, get_spin(rotor)).has_value();
  MatrixXd G = MatrixXd::Zero(element.num_dofs(), element.num_dofs());
  return add_line_gyroscopic(element, model, get_spin(rotor), 1, G);
}

/// Sets mass and polar inertia of a rotor.
void measure(const Model& model, Rotor& rotor) {
  const SparseColumns M = sum_mass(model, rotor);
  VectorXd along = VectorXd::Zero(model.num_gdofs()), about = along;
  for (const int node : rotor.nodes) {
    const auto& grid = model.node(node);
    along.segment<3>(grid.first_gdof) = rotor.axis;
    if (rotor.is_spatial) about.segment<3>(grid.first_gdof) = rotor.axis.cross(grid.x - rotor.point);
    about.segment<3>(grid.first_gdof + 3) = rotor.axis;
  }
  rotor.mass = along.dot(M * along);
  rotor.polar_inertia = about.dot(M * about);
}

/// Warns of a rotor that is not alike in all directions across its axis, in the rotating frame of such supports.
void warn_of_asymmetry(const Model& model, const Rotor& rotor, const RotorAxis& axis, Diagnostics& diagnostics) {
  const bool is_rotating = rotor.frame == RotorFrame::Rotating;
  double in_mass = 0, in_stiffness = 0;
  if (is_rotating) {
    const auto others = list_others(model, rotor);
    const auto grids = list_grids(model);
    const SparseColumns spin = make_spin_operator(model, rotor.axis, grids);
    const auto measure = [&](const AddMatrix& add) {
      return calc_asymmetry(model, grids, sum(model, others, add), spin);
    };
    in_mass = measure([&](const Element& e, Eigen::Ref<MatrixXd> M) { e.add_mass(model.mass_kind(), 1, M); });
    in_stiffness = measure([&](const Element& e, Eigen::Ref<MatrixXd> K) { e.add_stiffness(1, K); });
  } else if (rotor.is_spatial) {
    std::tie(in_mass, in_stiffness) =
        calc_spatial_asymmetry(model, rotor, sum_mass(model, rotor), sum_stiffness(model, rotor));
  } else {
    const SparseColumns spin = make_spin_operator(model, rotor.axis, rotor.nodes);
    in_mass = calc_asymmetry(model, rotor.nodes, sum_mass(model, rotor), spin);
    in_stiffness = calc_asymmetry(model, rotor.nodes, sum_stiffness(model, rotor), spin);
  }
  if (std::max(in_mass, in_stiffness) <= kMaxAsymmetry) return;
  char text[64];
  std::snprintf(text, sizeof text, "%.2g %%", 100 * std::max(in_mass, in_stiffness));
  diagnostics.warning("modal.rotor-asymmetric", axis.at,
                      "the " + std::string(in_mass > in_stiffness ? "mass" : "stiffness") + " of " +
                          (is_rotating ? "the supports of rotor " : "rotor ") + std::to_string(rotor.id) +
                          " differs by " + text + " across its axis: it is taken as if it " +
                          (is_rotating ? "turned with the rotor" : "did not turn") +
                          ", and coefficients that vary with the angle of rotation are left out",
                      is_rotating ? "give equal stiffness in both directions, or solve in the fixed frame"
                                  : "give equal moments of area and of inertia about both axes across, and no offsets");
}

}  // namespace

std::vector<Rotor> find_rotors(const Model& model, const std::vector<RotorAxis>& axes, Diagnostics& diagnostics) {
  std::vector<Rotor> rotors;
  std::unordered_map<int, std::size_t> rotor_of;  // by node
  for (const auto& axis : axes) {
    Rotor rotor;
    rotor.id = axis.id;
    rotor.axis = axis.axis;
    rotor.point = axis.point;
    rotor.is_spatial = axis.is_spatial;
    rotor.frame = axis.frame;
    for (const int grid : axis.grids) {
      rotor.nodes.push_back(model.find_node(grid));
      rotor_of[rotor.nodes.back()] = rotors.size();
    }
    rotors.push_back(std::move(rotor));
  }
  for (const auto& element : model.elements()) {
    const auto& nodes = element->nodes();
    const auto on = std::find_if(nodes.begin(), nodes.end(), [&](int node) { return rotor_of.count(node) > 0; });
    if (on == nodes.end()) continue;
    const std::size_t k = rotor_of.at(*on);
    const bool is_inside = std::all_of(nodes.begin(), nodes.end(), [&](int node) {
      const auto found = rotor_of.find(node);
      return found != rotor_of.end() && found->second == k;
    });
    const bool is_massive = has_mass(*element, model.mass_kind());
    if (is_inside && (nodes.size() > 1 || is_massive)) {
      rotors[k].elements.push_back(element.get());
      continue;
    }
    if (!is_massive) continue;  // a bearing
    const int grid = model.node(*on).id;
    diagnostics.error("modal.rotor-element", axes[k].at,
                      describe(*element) + " has mass and joins grid " + std::to_string(grid) + " of rotor " +
                          std::to_string(rotors[k].id) + " to a grid that is not on the rotor",
                      "list all of its grids on ROTORG, or give it no mass, as a bearing has");
  }
  for (std::size_t k = 0; k < rotors.size(); ++k) {
    auto& rotor = rotors[k];
    for (const Element* element : rotor.elements)
      if (!has_gyroscopic(*element, model, rotor))
        diagnostics.error("modal.rotor-element", axes[k].at,
                          describe(*element) + " on rotor " + std::to_string(rotor.id) +
                              (rotor.is_spatial ? " has mass without a gyroscopic matrix in the fixed frame"
                                                : " has rotary inertia without a gyroscopic matrix"),
                          rotor.is_spatial
                              ? "model the rotor by CHEXA, CPENTA, CTETRA, CQUAD4, CTRIA3, CBAR, CBEAM and "
                                "CONM2, or solve in the rotating frame (ROTORD with REFSYS = ROT)"
                              : "model the rotor by CBEAM, CBAR, CROD, CONM1 and CONM2");
    measure(model, rotor);
    warn_of_asymmetry(model, rotor, axes[k], diagnostics);
  }
  return rotors;
}

RotorMatrices assemble_rotor(const Model& model, const Rotor& rotor, const RotorDamping& d) {
  RotorMatrices r;
  assemble_spin_terms(model, rotor, r);
  const AddMatrix add_dampers = [](const Element& e, Eigen::Ref<MatrixXd> B) {
    if (const Damping* damping = e.damping()) damping->add_damping(1, B);
  };
  const SparseColumns K = sum_stiffness(model, rotor), K4 = assemble_rotor_structural(model, rotor, 0);
  r.damping = d.alpha1 * sum_mass(model, rotor);
  r.damping += d.alpha2 * K;
  r.structural.resize(model.num_gdofs(), model.num_gdofs());
  if (d.viscous_g > 0)
    r.damping += d.viscous_g * K;
  else
    r.structural += d.g * K;
  if (d.viscous_ge > 0)
    r.damping += d.viscous_ge * K4;
  else
    r.structural += K4;
  if (rotor.frame == RotorFrame::Rotating) {  // the dampers that do not turn
    const SparseColumns all = make_spin_operator(model, rotor.axis, list_grids(model));
    r.circulation = sum(model, list_others(model, rotor), add_dampers) * all;
    r.structural_circulation.resize(model.num_gdofs(), model.num_gdofs());
    return r;
  }
  const SparseColumns spin = make_spin_operator(model, rotor.axis, rotor.nodes);
  const SparseColumns dampers = sum(model, rotor.elements, add_dampers);
  r.circulation = -1.0 * SparseColumns(SparseColumns(dampers + r.damping) * spin);
  r.structural_circulation = -1.0 * SparseColumns(r.structural * spin);
  return r;
}

CentrifugalLoad calc_centrifugal_load(const Model& model, const Rotor& rotor) {
  CentrifugalLoad load;
  load.F = VectorXd::Zero(model.num_gdofs());
  std::vector<Eigen::Triplet<double>> terms;
  MatrixXd K;
  for (const Element* element : rotor.elements) {
    const auto samples = sample_mass(*element, model, get_spin(rotor));
    if (!samples) {  // of the rotating frame: translations of the grids
      MatrixXd M = MatrixXd::Zero(element->num_dofs(), element->num_dofs());
      element->add_mass(model.mass_kind(), model.wtmass(), M);
      const auto per_node =
          static_cast<Eigen::Index>(element->num_dofs() / std::max<std::size_t>(1, element->nodes().size()));
      VectorXd a = VectorXd::Zero(element->num_dofs());
      for (std::size_t i = 0; i < element->nodes().size() && per_node >= 3; ++i) {
        const Vector3d r = model.node(element->nodes()[i]).x - rotor.point;
        a.segment<3>(static_cast<Eigen::Index>(i) * per_node) = r - rotor.axis * rotor.axis.dot(r);
      }
      const VectorXd f = M * a;
      for (Eigen::Index i = 0; i < f.size(); ++i) load.F[element->gdofs()[static_cast<std::size_t>(i)]] += f[i];
      continue;
    }
    K.setZero(element->num_dofs(), element->num_dofs());
    for (const auto& s : *samples) {
      const Vector3d f = model.wtmass() * s.mass * (s.r - rotor.axis * rotor.axis.dot(s.r));
      const VectorXd at_grids = s.N.transpose() * f;
      for (Eigen::Index i = 0; i < at_grids.size(); ++i)
        load.F[element->gdofs()[static_cast<std::size_t>(i)]] += at_grids[i];
      if (!s.arm.isZero(0)) K += s.Theta.transpose() * (calc_arm_stiffness(f, s.arm) * s.Theta);
    }
    append(*element, K, terms);
  }
  load.stiffness = to_matrix(model, terms);
  return load;
}

SparseColumns assemble_rotor_structural(const Model& model, const Rotor& rotor, double g) {
  return sum(model, rotor.elements, [&](const Element& e, Eigen::Ref<MatrixXd> K) { e.add_structural_damping(g, K); });
}

}  // namespace bough::fe
