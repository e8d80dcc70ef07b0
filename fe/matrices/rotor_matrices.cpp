#include "fe/matrices/rotor_matrices.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <unordered_map>

#include "base/rotation.hpp"
#include "fe/elements/beam.hpp"
#include "fe/elements/damping.hpp"
#include "fe/elements/point_mass.hpp"

namespace bough::fe {
namespace {

/// Relative difference of K and of M under a rotation about the axis that is reported.
constexpr double kMaxAsymmetry = 1e-4;

using AddMatrix = std::function<void(const Element&, Eigen::Ref<MatrixXd>)>;

/// Σ of element matrices of a rotor on the g-set.
SparseColumns sum(const Model& model, const Rotor& rotor, const AddMatrix& add) {
  std::vector<Eigen::Triplet<double>> terms;
  for (const Element* element : rotor.elements) {
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
  return sum(model, rotor,
             [&](const Element& e, Eigen::Ref<MatrixXd> M) { e.add_mass(model.mass_kind(), model.wtmass(), M); });
}
SparseColumns sum_stiffness(const Model& model, const Rotor& rotor) {
  return sum(model, rotor, [&](const Element& e, Eigen::Ref<MatrixXd> K) { e.add_stiffness(1, K); });
}

/// ẽ at the translations and rotations of each grid of the rotor.
SparseColumns make_spin_operator(const Model& model, const Rotor& rotor) {
  const Matrix3d e = skew(rotor.axis);
  std::vector<Eigen::Triplet<double>> terms;
  for (const int node : rotor.nodes)
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

/// Norm of A ẽ - ẽ A over that of A ẽ, with translations and rotations of each grid scaled by the traces of A.
double calc_asymmetry(const Model& model, const Rotor& rotor, const SparseColumns& A, const SparseColumns& spin) {
  std::vector<Eigen::Triplet<double>> terms;
  for (const int node : rotor.nodes)
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

/// Gyroscopic matrix per unit of spin; false for an element with rotary inertia that has none.
bool add_gyroscopic(const Element& element, MassKind kind, const Vector3d& axis, double scale, Eigen::Ref<MatrixXd> G) {
  if (const Beam* beam = element.as_beam()) {
    beam->add_gyroscopic(kind, axis, scale, G);
    return true;
  }
  const auto n = element.num_dofs();
  if (n != 6 * static_cast<int>(element.nodes().size())) return !has_mass(element, kind);
  MatrixXd M = MatrixXd::Zero(n, n);
  element.add_mass(kind, scale, M);
  const bool is_point = dynamic_cast<const PointMass*>(&element) != nullptr;
  for (int first = 3; first < n; first += 6) {
    const Matrix3d inertia = M.block<3, 3>(first, first);
    if (inertia.isZero(0)) continue;
    if (!is_point) return false;
    G.block<3, 3>(first, first) -= axis.dot(inertia * axis) * skew(axis);
  }
  return true;
}

std::string describe(const Element& element) { return element.card() + " " + std::to_string(element.id()); }

}  // namespace

std::vector<Rotor> find_rotors(const Model& model, const std::vector<RotorAxis>& axes, Diagnostics& diagnostics) {
  std::vector<Rotor> rotors;
  std::unordered_map<int, std::size_t> rotor_of;  // by node
  for (const auto& axis : axes) {
    Rotor rotor;
    rotor.id = axis.id;
    rotor.axis = axis.axis;
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
    for (const Element* element : rotor.elements) {
      MatrixXd G = MatrixXd::Zero(element->num_dofs(), element->num_dofs());
      if (!add_gyroscopic(*element, model.mass_kind(), rotor.axis, 1, G))
        diagnostics.error("modal.rotor-element", axes[k].at,
                          describe(*element) + " on rotor " + std::to_string(rotor.id) +
                              " has rotary inertia without a gyroscopic matrix",
                          "model the rotor by CBEAM, CBAR, CROD, CONM1 and CONM2");
    }
    const SparseColumns spin = make_spin_operator(model, rotor), M = sum_mass(model, rotor);
    VectorXd along = VectorXd::Zero(model.num_gdofs()), about = along;
    for (const int node : rotor.nodes) {
      along.segment<3>(model.node(node).first_gdof) = rotor.axis;
      about.segment<3>(model.node(node).first_gdof + 3) = rotor.axis;
    }
    rotor.mass = along.dot(M * along);
    rotor.polar_inertia = about.dot(M * about);
    const double in_mass = calc_asymmetry(model, rotor, M, spin);
    const double in_stiffness = calc_asymmetry(model, rotor, sum_stiffness(model, rotor), spin);
    if (std::max(in_mass, in_stiffness) <= kMaxAsymmetry) continue;
    char text[64];
    std::snprintf(text, sizeof text, "%.2g %%", 100 * std::max(in_mass, in_stiffness));
    diagnostics.warning("modal.rotor-asymmetric", axes[k].at,
                        "the " + std::string(in_mass > in_stiffness ? "mass" : "stiffness") + " of rotor " +
                            std::to_string(rotor.id) + " differs by " + text + " across its axis: it is taken as if " +
                            "it did not turn, and coefficients that vary with the angle of rotation are left out",
                        "give equal moments of area and of inertia about both axes across, and no offsets");
  }
  return rotors;
}

RotorMatrices assemble_rotor(const Model& model, const Rotor& rotor, const RotorDamping& d) {
  RotorMatrices r;
  const SparseColumns spin = make_spin_operator(model, rotor);
  r.gyroscopic = sum(model, rotor, [&](const Element& e, Eigen::Ref<MatrixXd> G) {
    add_gyroscopic(e, model.mass_kind(), rotor.axis, model.wtmass(), G);
  });
  const SparseColumns dampers = sum(model, rotor, [&](const Element& e, Eigen::Ref<MatrixXd> B) {
    if (const Damping* damping = e.damping()) damping->add_damping(1, B);
  });
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
  r.circulation = -1.0 * SparseColumns(SparseColumns(dampers + r.damping) * spin);
  r.structural_circulation = -1.0 * SparseColumns(r.structural * spin);
  return r;
}

SparseColumns assemble_rotor_structural(const Model& model, const Rotor& rotor, double g) {
  return sum(model, rotor, [&](const Element& e, Eigen::Ref<MatrixXd> K) { e.add_structural_damping(g, K); });
}

}  // namespace bough::fe
