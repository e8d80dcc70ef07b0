// Displacements, strain energy and loads to third order: the static manifold of the large modes
// (docs/theory/third-order.md). Code below works in scaled amplitudes, 1/ω of a mode each.
#include <algorithm>
#include <cstdio>

#include "fe/corotational/corotational_element.hpp"
#include "fe/corotational/series.hpp"
#include "fe/elements/carried.hpp"
#include "fe/elements/stress_state.hpp"
#include "fe/linear/blas.hpp"
#include "fe/model/element_loop.hpp"
#include "modal/integrals.hpp"
#include "stiffening/stages.hpp"

namespace bough::stiffening {

using records::BodyFrame;
using records::FlexBody;
using records::ThirdOrder;

namespace {

/// Mass of an affine field after projection, relative to the field.
constexpr double kNoMass = 1e-8;
/// Kinetic energy of u₂ outside the fields, relative.
constexpr double kLeftOut = 1e-3;
/// Kinetic energy of a field that is dropped, relative to all.
constexpr double kNoUse = 1e-9;
constexpr int kMaxExtraFields = 12;

/// Values of all monomials of a degree: points x monomials; amplitudes: points x n.
MatrixXd calc_monomials(const Eigen::MatrixXi& exponents, const MatrixXd& amplitudes) {
  MatrixXd values = MatrixXd::Ones(amplitudes.rows(), exponents.rows());
  for (Eigen::Index p = 0; p < values.rows(); ++p)
    for (Eigen::Index i = 0; i < values.cols(); ++i)
      for (Eigen::Index j = 0; j < exponents.cols(); ++j)
        for (int e = 0; e < exponents(i, j); ++e) values(p, i) *= amplitudes(p, j);
  return values;
}

/// Points that fix a polynomial of one degree, the principal lattice of a simplex, and coefficients from values there.
class Lattice {
 public:
  Lattice(int n, int degree) : exponents_(records::list_exponents(n, degree)) {
    points_ = exponents_.cast<double>() / degree;
    factor_.compute(calc_monomials(exponents_, points_));
  }

  const Eigen::MatrixXi& exponents() const { return exponents_; }
  const MatrixXd& points() const { return points_; }  ///< points x n
  Eigen::Index size() const { return points_.rows(); }
  /// values, result: rows x points, rows x monomials.
  MatrixXd fit(const MatrixXd& values) const { return factor_.solve(values.transpose()).transpose(); }

 private:
  Eigen::MatrixXi exponents_;
  MatrixXd points_;
  Eigen::PartialPivLU<MatrixXd> factor_;
};

/// c of polynomials in η from those in η / scale. c: rows x monomials.
void unscale(const Eigen::MatrixXi& exponents, const VectorXd& scale, MatrixXd& c) {
  for (Eigen::Index i = 0; i < exponents.rows(); ++i)
    for (Eigen::Index j = 0; j < exponents.cols(); ++j)
      for (int e = 0; e < exponents(i, j); ++e) c.col(i) /= scale[j];
}

void add_unfit(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

std::string join_names(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// Returns true if u_g has equations between grids: rigid elements, MPC, splines.
bool has_links(const fe::Model& model) {
  // Rows of T without links have terms of one node alone.
  std::vector<int> owner(static_cast<std::size_t>(model.num_fdofs()));
  for (int q = 0; q < model.num_fdofs(); ++q)
    owner[static_cast<std::size_t>(q)] = model.find_node(model.describe_fdof(q).first);
  const auto& T = model.T();
  for (std::size_t k = 0; k < model.nodes().size(); ++k) {
    const auto& node = model.nodes()[k];
    for (int d = 0; d < node.num_dofs; ++d)
      for (fe::SparseRows::InnerIterator it(T, node.first_gdof + d); it; ++it)
        if (owner[static_cast<std::size_t>(it.col())] != static_cast<int>(k) && it.value() != 0) return true;
  }
  return false;
}

/// The manifold of one body.
class Manifold {
 public:
  Manifold(const BodyRequest& request, const fe::Model& model, const ModalBasis& basis, const StaticSupport& support,
           const std::vector<int>& large, const linear::SymmetricMatrix& M)
      : model_(model), support_(support), large_(large) {
    const Eigen::Index n = basis.Phi.cols();
    scale_.resize(n);
    for (Eigen::Index j = 0; j < n; ++j)
      scale_[j] = 1 / std::sqrt(basis.stiffness(j, j));  // a shape of unit strain energy
    Phi_ = basis.Phi * scale_.asDiagonal();
    const MatrixXd K = scale_.asDiagonal() * basis.stiffness * scale_.asDiagonal();
    K_factor_.compute(K);
    if (request.is_free()) {
      Phi_R_ = model.calc_rigid_modes();
      C_ = request.moves_to_frame()
               ? MatrixXd(modal::bases::calc_reference_conditions(model, make_frame_spec(request.spec)).transpose())
               : linear::multiply(M, Phi_R_);
      const MatrixXd CR = C_.transpose() * Phi_R_;
      const VectorXd unit = CR.rowwise().norm().cwiseMax(1e-300).cwiseInverse();
      const Eigen::FullPivLU<MatrixXd> factor(unit.asDiagonal() * CR);
      if (!(factor.rcond() > kNoMass)) {
        request.error("reduce.bad-order",
                      "[body.stiffening] order = 3 is given, but the free body has no inertia about an axis",
                      "use frame = \"node\", give it that inertia, or set order = 2");
        request.diagnostics.throw_if_errors();
      }
      CR_inverse_ = factor.inverse() * unit.asDiagonal();
    }
  }

  const VectorXd& scale() const { return scale_; }
  const MatrixXd& Phi() const { return Phi_; }

  /// Displacements -G R of the forces R that each monomial has, num_gdofs x monomials, without a part along the modes.
  MatrixXd solve(const MatrixXd& R) const {
    MatrixXd F = -R;
    if (C_.size() > 0)  // the frame's condition takes what has a resultant
      F += C_ * (CR_inverse_.transpose() * linear::calc_inner_products(Phi_R_, R));
    MatrixXd u = support_.solve(F);
    u -= Phi_ * K_factor_.solve(linear::calc_inner_products(Phi_, F));
    if (C_.size() > 0) u -= Phi_R_ * (CR_inverse_ * linear::calc_inner_products(C_, u));
    return u;
  }

  /// Adds u of the next degree. c: num_gdofs x monomials.
  void add_field(int degree, MatrixXd c) {
    fields_.push_back(std::move(c));
    BOUGH_DEMAND(static_cast<int>(fields_.size()) == degree - 1);
  }
  const MatrixXd& field(int degree) const { return fields_[static_cast<std::size_t>(degree - 2)]; }

  /// Order `order` of the elements' forces along u_1 .. of the fields there are, at each point: num_gdofs x points.
  /// points: points x n; with `projected` the forces on the large modes alone: N x points.
  MatrixXd calc_forces(const MatrixXd& points, int order, bool projected) const {
    std::vector<MatrixXd> monomials;  // of each field
    const int N = static_cast<int>(large_.size());
    const MatrixXd large_points = points(Eigen::all, large_);
    for (std::size_t k = 0; k < fields_.size(); ++k) {
      const int degree = static_cast<int>(k) + 2;
      monomials.push_back(degree == 2
                              ? calc_monomials(records::list_exponents(static_cast<int>(points.cols()), 2), points)
                              : calc_monomials(records::list_exponents(N, degree), large_points));
    }
    const Eigen::Index m = points.rows();
    MatrixXd result = MatrixXd::Zero(projected ? N : model_.num_gdofs(), m);
    fe::visit_elements(model_, fe::get_own_elements(model_), [&](int, const fe::Element& element) {
      if (element.num_dofs() == 0) return;
      const fe::CorotationalElement corotational(element, model_.nodes());
      if (corotational.K().isZero(0)) return;
      const auto& gdofs = element.gdofs();
      MatrixXd u = MatrixXd::Zero(element.num_dofs(), fe::kSeriesTop * m);
      const auto set_order = [&](int k, const MatrixXd& u_k) {
        for (Eigen::Index p = 0; p < m; ++p) u.col(fe::kSeriesTop * p + k - 1) = u_k.col(p);
      };
      set_order(1, Phi_(gdofs, Eigen::all) * points.transpose());
      for (std::size_t k = 0; k < fields_.size(); ++k)
        set_order(static_cast<int>(k) + 2, fields_[k](gdofs, Eigen::all) * monomials[k].transpose());
      const MatrixXd f = corotational.calc_forces(u);
      MatrixXd f_k(element.num_dofs(), m);
      for (Eigen::Index p = 0; p < m; ++p) f_k.col(p) = f.col(fe::kSeriesTop * p + order - 1);
      if (projected)
        result += Phi_(gdofs, large_).transpose() * f_k;
      else
        result(gdofs, Eigen::all) += f_k;
    });
    linear::sum_over_ranks(result);
    return result;
  }

 private:
  const fe::Model& model_;
  const StaticSupport& support_;
  const std::vector<int>& large_;
  VectorXd scale_;
  MatrixXd Phi_, Phi_R_, C_, CR_inverse_;
  Eigen::LDLT<MatrixXd> K_factor_;
  std::vector<MatrixXd> fields_;  ///< degree 2, 3, ...; num_gdofs x monomials
};

/// V_k from Φη·f_(k-1)/k at the points of its lattice. forces: f_(k-1) on the modes, N x points.
VectorXd fit_energy(const Lattice& lattice, const MatrixXd& forces, int degree) {
  const MatrixXd work = forces.cwiseProduct(lattice.points().transpose());
  return lattice.fit(work.colwise().sum() / degree).transpose();
}

/// Amplitudes of the large modes as those of all.
MatrixXd spread(const MatrixXd& points, const std::vector<int>& large, Eigen::Index n) {
  MatrixXd all = MatrixXd::Zero(points.rows(), n);
  all(Eigen::all, large) = points;
  return all;
}

/// Rigid-body motions, then the six strains of the body as one; rotations are those of the field. Rows of scalar points
/// are zero.
MatrixXd calc_affine_fields(const fe::Model& model, const Eigen::Vector3d& centre) {
  MatrixXd X = MatrixXd::Zero(model.num_gdofs(), 12);
  X.leftCols<6>() = model.calc_rigid_modes(centre);
  for (const auto& node : model.nodes()) {
    if (node.num_dofs != 6) continue;
    const Eigen::Vector3d p = node.x - centre;
    for (int a = 0, c = 6; a < 3; ++a)
      for (int b = a; b < 3; ++b, ++c) {
        X(node.first_gdof + a, c) += p[b];
        if (a != b) X(node.first_gdof + b, c) += p[a];
      }
  }
  return X;
}

/// Appends X without its parts along `basis`, orthonormal under M; columns of a smaller mass than no_mass, relative,
/// are left out.
void append_orthonormal(const linear::SymmetricMatrix& M, const MatrixXd& X, double no_mass, MatrixXd& basis) {
  for (Eigen::Index c = 0; c < X.cols(); ++c) {
    VectorXd x = X.col(c);
    const double own = x.dot(VectorXd(linear::multiply(M, x)));
    if (!(own > 0)) continue;
    for (int pass = 0; pass < 2; ++pass) x -= basis * (basis.transpose() * VectorXd(linear::multiply(M, x)));
    const double left = x.dot(VectorXd(linear::multiply(M, x)));
    if (!(left > no_mass * own)) continue;
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols<1>() = x / std::sqrt(left);
  }
}

}  // namespace

void check_third_order(const BodyRequest& request, const fe::Model& model) {
  if (request.spec.stiffening_order < 3) return;
  const auto error = [&](const std::string& what, const std::string& advice) {
    request.error("reduce.bad-order", "[body.stiffening] order = 3 is given, but " + what, advice);
  };
  const std::string second = "set order = 2";
  if (request.given)
    error("the stiffness is a matrix of another program, which does not turn with the deflection", second);
  if (model.prestress()) error("the body is preloaded: the series begin at the state without stress", second);
  if (!request.spec.augments.empty()) error("masses augment the modes", second);
  if (model.omitted()) error("ASET or OMIT eliminates dofs", "remove these cards, or " + second);
  if (request.spec.frame == BodyFrame::ThreeNodes || request.spec.frame == BodyFrame::MassCentre)
    error("the frame is carried by three nodes or the centre of mass",
          "use frame = \"fixed\", \"free\", \"mean\" or \"node\"");
  if (request.given) return;
  if (has_links(model))
    error("rigid elements or MPC join grids, whose motion has no third order yet",
          "join the grids by stiff CBAR, or " + second);
  std::vector<std::string> elements, masses;
  for (const auto& element : model.elements()) {
    if (element->num_dofs() == 0) continue;
    const fe::CorotationalElement corotational(*element, model.nodes());
    const auto name = element->card() + " " + std::to_string(element->id());
    if (!corotational.follows_nodes() && !corotational.K().isZero(0)) add_unfit(elements, name);
    if (corotational.K().isZero(0) && element->offset_mass(model.mass_kind())) add_unfit(masses, name);
    if (elements.size() + masses.size() > 5) break;
  }
  if (!elements.empty())
    error("the stiffness of " + join_names(elements) + " does not turn with its grids",
          "use elements between grids, or " + second);
  if (!masses.empty())
    error(join_names(masses) + (masses.size() > 1 ? " have mass" : " has mass") +
              " off its grid or rotary inertia, whose motion has no third order yet",
          "put the mass on a grid at its place, or " + second);
  request.diagnostics.throw_if_errors();
}

namespace {

std::vector<int> choose_large_modes(const BodyRequest& request, int num_modes) {
  const auto& spec = request.spec;
  std::vector<int> large;
  for (const int mode : spec.large_modes) {
    if (mode < 1 || mode > num_modes)
      request.error("reduce.bad-order",
                    "mode " + std::to_string(mode) + " in [body.stiffening] large does not exist: the body has " +
                        std::to_string(num_modes) + " modes",
                    "name modes from 1 to " + std::to_string(num_modes));
    large.push_back(mode - 1);
  }
  const int max_number = spec.num_large > 0 ? spec.num_large : kDefaultLargeModes;
  if (spec.num_large > num_modes)
    request.error("reduce.bad-order",
                  "[body.stiffening] large = " + std::to_string(spec.num_large) + ", but the body has " +
                      std::to_string(num_modes) + " modes",
                  "give at most " + std::to_string(num_modes));
  for (int j = 0; j < std::min(max_number, num_modes) && spec.large_modes.empty(); ++j) large.push_back(j);
  std::sort(large.begin(), large.end());
  if (std::adjacent_find(large.begin(), large.end()) != large.end())
    request.error("reduce.bad-order", "a mode occurs twice in [body.stiffening] large", "name each mode once");
  if (large.size() > records::kMaxLargeModes)
    request.error("reduce.bad-order",
                  "[body.stiffening] large has " + std::to_string(large.size()) + " modes, at most " +
                      std::to_string(records::kMaxLargeModes) + " are possible",
                  "the tables grow with the sixth power: keep the modes that deflect most");
  if (num_modes > records::kMaxThirdOrderModes)
    request.error("reduce.bad-order",
                  "a body of third order has at most " + std::to_string(records::kMaxThirdOrderModes) +
                      " modes, this one has " + std::to_string(num_modes),
                  "keep fewer modes, or set order = 2");
  request.diagnostics.throw_if_errors();
  return large;
}

}  // namespace

void set_third_order(const BodyRequest& request, const fe::Model& model, const ModalBasis& basis,
                     const std::vector<LoadPattern>& patterns, const StaticSupport& support,
                     const InertialLoads& inertial, FlexBody& body) {
  if (request.spec.stiffening_order < 3) return;
  const int n = static_cast<int>(basis.Phi.cols());
  const auto large = choose_large_modes(request, n);
  const int N = static_cast<int>(large.size());
  double num_columns = records::count_monomials(n, 2) * 2;
  for (int k = 3; k <= ThirdOrder::kMaxField; ++k) num_columns += 2 * records::count_monomials(N, k);
  char need[64];
  std::snprintf(need, sizeof need, "%.0f MB", 8e-6 * num_columns * model.num_gdofs());
  request.report("third order of " + std::to_string(N) + " modes, " + need);
  ThirdOrder third;
  third.large = large;
  Manifold manifold(request, model, basis, support, large, inertial.M);
  const VectorXd scale = manifold.scale(), large_scale = scale(large);

  // Degree 2 is of all modes: stiffening by loads concerns the small ones as well.
  const Lattice pairs(n, 2);
  const MatrixXd r2 = pairs.fit(manifold.calc_forces(pairs.points(), 2, false));
  const MatrixXd on_modes = linear::calc_inner_products(manifold.Phi(), r2);  // n x pairs
  manifold.add_field(2, manifold.solve(r2));
  std::vector<MatrixXd> work;  // forces on the large modes at the lattice of degree k, k = 3..6
  std::vector<Lattice> lattices;
  for (int k = 3; k <= ThirdOrder::kMaxEnergy; ++k) lattices.emplace_back(N, k);
  {
    const MatrixXd points = spread(lattices[0].points(), large, n);
    work.push_back(on_modes(large, Eigen::all) * calc_monomials(pairs.exponents(), points).transpose());
  }
  for (int k = 3; k <= ThirdOrder::kMaxField; ++k) {
    const Lattice& own = lattices[static_cast<std::size_t>(k - 3)];
    const MatrixXd r = own.fit(manifold.calc_forces(spread(own.points(), large, n), k, false));
    const Lattice& next = lattices[static_cast<std::size_t>(k - 2)];
    work.push_back(linear::calc_inner_products(manifold.Phi()(Eigen::all, large), r) *
                   calc_monomials(own.exponents(), next.points()).transpose());
    manifold.add_field(k, manifold.solve(r));
  }
  // Degree 6: u₅ is not needed, φᵀK u₅ = 0.
  work.push_back(manifold.calc_forces(spread(lattices[3].points(), large, n), 5, true));
  for (int k = ThirdOrder::kMinEnergy; k <= ThirdOrder::kMaxEnergy; ++k) {
    const auto at = static_cast<std::size_t>(k - ThirdOrder::kMinEnergy);
    MatrixXd c = fit_energy(lattices[at], work[at], k).transpose();
    unscale(lattices[at].exponents(), large_scale, c);
    third.energy[at] = c.transpose();
  }
  std::vector<int> small;
  for (int j = 0; j < n; ++j)
    if (!std::binary_search(large.begin(), large.end(), j)) small.push_back(j);
  const Lattice large_pairs(N, 2);
  {
    const MatrixXd points = spread(large_pairs.points(), large, n);
    MatrixXd c = large_pairs.fit(on_modes(small, Eigen::all) * calc_monomials(pairs.exponents(), points).transpose());
    unscale(large_pairs.exponents(), large_scale, c);
    for (std::size_t s = 0; s < small.size(); ++s) c.row(static_cast<Eigen::Index>(s)) /= scale[small[s]];
    third.energy_small = c.transpose();
  }

  // Fields of T: affine ones, then the leading directions of the rest of u₂; amplitudes weighted by 1/ω² (here
  // 1/ω more than the scale).
  MatrixXd psi(model.num_gdofs(), 0);
  {
    MatrixXd along = MatrixXd::Zero(model.num_gdofs(), 0);
    append_orthonormal(inertial.M, basis.Phi, 0, along);
    const Eigen::Index num = along.cols();
    append_orthonormal(inertial.M, calc_affine_fields(model, body.cg), kNoMass, along);
    MatrixXd rest = manifold.field(2);
    VectorXd weight(n);
    for (int j = 0; j < n; ++j) weight[j] = scale[j] / large_scale.maxCoeff();
    for (Eigen::Index i = 0; i < rest.cols(); ++i)
      for (int j = 0; j < n; ++j) rest.col(i) *= std::pow(weight[j], pairs.exponents()(i, j));
    const auto calc_gram = [&] {
      MatrixXd gram = linear::calc_inner_products(rest, linear::multiply(inertial.M, rest));
      return MatrixXd(0.5 * (gram + gram.transpose()));
    };
    const double whole = calc_gram().trace();
    const MatrixXd M_along = linear::multiply(inertial.M, along);
    for (int pass = 0; pass < 2; ++pass) rest -= along * linear::calc_inner_products(M_along, rest);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(calc_gram());
    double left = eigen.eigenvalues().sum();
    int num_extra = 0;
    while (num_extra < kMaxExtraFields && num_extra < rest.cols() && left > kLeftOut * whole) {
      left -= eigen.eigenvalues()[rest.cols() - 1 - num_extra];
      ++num_extra;
    }
    append_orthonormal(inertial.M, rest * eigen.eigenvectors().rightCols(num_extra).rowwise().reverse(), 0, along);
    psi = along.rightCols(along.cols() - num);
    // Fields that nothing moves along.
    const MatrixXd p = linear::calc_inner_products(linear::multiply(inertial.M, psi), manifold.field(2));
    const MatrixXd p3 = linear::calc_inner_products(linear::multiply(inertial.M, psi), manifold.field(3));
    std::vector<Eigen::Index> used;
    double total = 0;
    VectorXd of_field = VectorXd::Zero(psi.cols());
    for (Eigen::Index q = 0; q < psi.cols(); ++q) {
      for (Eigen::Index i = 0; i < p.cols(); ++i) {
        double w = 1;
        for (int j = 0; j < n; ++j) w *= std::pow(weight[j], pairs.exponents()(i, j));
        of_field[q] += std::pow(w * p(q, i), 2);
      }
      for (Eigen::Index i = 0; i < p3.cols(); ++i) {
        double w = 1;
        for (int j = 0; j < N; ++j)
          w *= std::pow(weight[large[static_cast<std::size_t>(j)]], lattices[0].exponents()(i, j));
        of_field[q] += std::pow(w * p3(q, i), 2);
      }
    }
    total = of_field.sum();
    for (Eigen::Index q = 0; q < psi.cols(); ++q)
      if (of_field[q] > kNoUse * total) used.push_back(q);
    psi = MatrixXd(psi(Eigen::all, used));
  }
  const MatrixXd M_psi = linear::multiply(inertial.M, psi);
  const auto find_node = [&](int id) -> const fe::Node& { return model.node(model.find_node(id)); };
  for (const int id : body.node_id) {
    const auto& node = find_node(id);
    MatrixXd& block = third.fields.emplace_back(psi.middleRows(node.first_gdof, 6));
    if (lacks_rotation(model, node)) block.bottomRows<3>().setZero();
  }
  third.node.resize(body.interface_nodes.size());
  MatrixXd F(model.num_gdofs(), static_cast<Eigen::Index>(patterns.size()));
  for (std::size_t e = 0; e < patterns.size(); ++e) F.col(static_cast<Eigen::Index>(e)) = patterns[e].load.F;
  for (int k = ThirdOrder::kMinField; k <= ThirdOrder::kMaxField; ++k) {
    const auto at = static_cast<std::size_t>(k - ThirdOrder::kMinField);
    const Eigen::MatrixXi& exponents =
        k == 2 ? pairs.exponents() : lattices[static_cast<std::size_t>(k - 3)].exponents();
    const auto unscaled = [&](MatrixXd c) {
      unscale(exponents, k == 2 ? scale : large_scale, c);
      return MatrixXd(c.transpose());
    };
    const MatrixXd& u = manifold.field(k);
    third.amplitudes[at] = unscaled(linear::calc_inner_products(M_psi, u));
    third.load[at] = unscaled(linear::calc_inner_products(F, u));
    for (std::size_t i = 0; i < third.node.size(); ++i) {
      const auto& node = find_node(body.interface_nodes[i]);
      MatrixXd rows = u.middleRows(node.first_gdof, 6);
      if (lacks_rotation(model, node)) rows.bottomRows<3>().setZero();
      third.node[i][at] = unscaled(std::move(rows));
    }
  }
  MatrixXd both(model.num_gdofs(), n + psi.cols());
  both << basis.Phi, psi;
  FlexBody carrier;
  set_integrals(request, model, both, inertial, carrier);
  third.integrals = carrier.integrals();
  body.third_order = std::move(third);
}

}  // namespace bough::stiffening
