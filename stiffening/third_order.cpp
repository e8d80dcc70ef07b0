// Displacements, strain energy and loads to third order: the static manifold of the large modes
// (docs/theory/third-order.md). Code below works in scaled amplitudes, 1/ω of a mode each.
#include <algorithm>
#include <cstdio>
#include <set>
#include <utility>

#include "fe/corotational/corotational_element.hpp"
#include "fe/elements/carried.hpp"
#include "fe/linear/blas.hpp"
#include "fe/linear/products.hpp"
#include "fe/loads/arm_strains.hpp"
#include "fe/loads/inertial_loads.hpp"
#include "fe/model/element_loop.hpp"
#include "modal/integrals.hpp"
#include "stiffening/large_modes.hpp"
#include "stiffening/static_manifold.hpp"

namespace bough::stiffening {

using records::FlexBody;
using records::ModeKind;
using records::ThirdOrder;

namespace {

/// Mass of an affine field after projection, relative to the field.
constexpr double kNoMass = 1e-8;
/// Kinetic energy of u₂ outside the fields, relative.
constexpr double kLeftOut = 1e-3;
/// Kinetic energy of a field that is dropped, relative to all.
constexpr double kNoUse = 1e-9;
constexpr int kMaxExtraFields = 12;

void add_unfit(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

std::string join_names(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string list_modes(const std::vector<int>& modes) {
  std::vector<std::string> numbers;
  for (const int mode : modes) numbers.push_back(std::to_string(mode + 1));
  return join_names(numbers);
}

/// The first RBE3 or MPC card on one of these grids, with its place; empty: others join them.
std::pair<std::string, records::CardLocation> find_tie(const records::Deck& deck, const std::vector<int>& ids) {
  const auto is_joined = [&](int id) { return std::find(ids.begin(), ids.end(), id) != ids.end(); };
  for (const auto& card : deck.rbe3) {
    const bool is_dependent =
        card.um.empty() ? is_joined(card.ref_grid)
                        : std::any_of(card.um.begin(), card.um.end(), [&](const auto& of) { return is_joined(of.g); });
    if (is_dependent) return {"RBE3 " + std::to_string(card.id), card.at};
  }
  for (const auto& card : deck.mpc)
    if (!card.terms.empty() && is_joined(card.terms.front().g)) return {"MPC " + std::to_string(card.sid), card.at};
  return {};
}

/// Fields are displacements of the grids, with the strain E by which the arms of carried masses move in addition to
/// their grids' rotations: num_gdofs + 9 rows, E column by column.
class FieldMass {
 public:
  FieldMass(const fe::Model& model, const linear::SymmetricMatrix& M)
      : M_(M), arms_(fe::calc_arm_strain_mass(model, model.mass_kind())) {}

  MatrixXd multiply(const MatrixXd& X) const {
    MatrixXd M_X(X.rows(), X.cols());
    const auto u = X.topRows(X.rows() - 9);
    const auto strain = X.bottomRows<9>();
    M_X.topRows(X.rows() - 9) = linear::multiply(M_, u) + arms_.on_dofs * strain;
    M_X.bottomRows<9>() = arms_.on_dofs.transpose() * u;
    for (int b = 0; b < 3; ++b)
      for (int c = 0; c < 3; ++c)
        M_X.middleRows(X.rows() - 9 + 3 * b, 3) += arms_.moment(b, c) * strain.middleRows<3>(3 * c);
    return M_X;
  }

 private:
  const linear::SymmetricMatrix& M_;
  fe::ArmStrainMass arms_;
};

/// Fields without strain of the arms.
MatrixXd make_fields(const MatrixXd& U) {
  MatrixXd X = MatrixXd::Zero(U.rows() + 9, U.cols());
  X.topRows(U.rows()) = U;
  return X;
}

/// Rigid-body motions, then the six strains of the body as one, of arms too; rotations are those of the field. Rows of
/// scalar points are zero.
MatrixXd calc_affine_fields(const fe::Model& model, const Eigen::Vector3d& centre) {
  const int N = model.num_gdofs();
  MatrixXd X = MatrixXd::Zero(N + 9, 12);
  X.topLeftCorner(N, 6) = model.calc_rigid_modes(centre);
  const auto visit_strains = [&](const auto& visit) {
    for (int a = 0, c = 6; a < 3; ++a)
      for (int b = a; b < 3; ++b, ++c) visit(a, b, c);
  };
  visit_strains([&](int a, int b, int c) { X(N + a + 3 * b, c) = X(N + b + 3 * a, c) = 1; });
  for (const auto& node : model.nodes()) {
    if (node.num_dofs != 6) continue;
    const Eigen::Vector3d p = node.x - centre;
    visit_strains([&](int a, int b, int c) {
      X(node.first_gdof + a, c) += p[b];
      if (a != b) X(node.first_gdof + b, c) += p[a];
    });
  }
  return X;
}

/// Appends X without its parts along `basis`, orthonormal under M; columns of a smaller mass than no_mass, relative,
/// are left out.
void append_orthonormal(const FieldMass& M, const MatrixXd& X, double no_mass, MatrixXd& basis) {
  for (Eigen::Index c = 0; c < X.cols(); ++c) {
    VectorXd x = X.col(c);
    const double own = x.dot(VectorXd(M.multiply(x)));
    if (!(own > 0)) continue;
    for (int pass = 0; pass < 2; ++pass) x -= basis * (basis.transpose() * VectorXd(M.multiply(x)));
    const double left = x.dot(VectorXd(M.multiply(x)));
    if (!(left > no_mass * own)) continue;
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols<1>() = x / std::sqrt(left);
  }
}

/// Adds an error for each part of the body that has no power series.
void add_series_errors(const BodyRequest& request, const fe::Model& model) {
  const auto error = [&](const std::string& what, const std::string& advice) {
    request.error_at("stiffening/order", "reduce.bad-order", "[body.stiffening] order = 3 is given, but " + what,
                     advice);
  };
  const std::string second = "set order = 2";
  if (request.given)
    error("the stiffness is a matrix of another program, which does not turn with the deflection", second);
  if (model.prestress()) error("the body is preloaded: the series begin at the state without stress", second);
  if (!request.spec.augments.empty()) error("masses augment the modes", second);
  if (model.omitted()) error("ASET or OMIT eliminates dofs", "remove these cards, or " + second);
  if (request.spec.basis != records::BodyBasis::Normal)
    error("the basis has static shapes: they hold the stretch that bending takes, so the series do not converge",
          "use basis = \"normal\", with residual vectors if need be, or " + second);
  if (request.given) return;
  std::vector<std::string> joined;
  const fe::MeanTies ties(request.deck, model, fe::RigidArms(model));
  for (const int id : ties.others()) {
    if (joined.size() < 6) add_unfit(joined, std::to_string(id));
  }
  if (!joined.empty()) {
    const auto [card, at] = find_tie(request.deck, ties.others());
    request.diagnostics.error(
        "reduce.bad-order", card.empty() ? request.where("stiffening/order") : request.deck.locate(at),
        "[body.stiffening] order = 3 is given, but " + (card.empty() ? "equations join " : card + " joins ") +
            join_names(joined) + " to others otherwise than as parts of a rigid body or with the mean of an RBE3",
        "join all of their translations, or rotations, to one grid by RBE2 or RBAR, or to whole grids by RBE3, or " +
            second);
  }
  std::vector<std::string> elements, masses;
  for (const auto& element : model.elements()) {
    if (element->num_dofs() == 0) continue;
    const auto name = element->card() + " " + std::to_string(element->id());
    if (has_stiffness(*element)) {
      if (!fe::follows_nodes(*element, model.nodes())) add_unfit(elements, name);
    } else if (element->offset_mass(model.mass_kind())) {
      fe::CarriedMass carried(element->num_dofs());
      if (!fe::calc_carried(model, *element, model.mass_kind(), carried)) add_unfit(masses, name);
    }
    if (elements.size() + masses.size() > 5) break;
  }
  if (!elements.empty())
    error("the stiffness of " + join_names(elements) + " does not turn with its grids",
          "use elements between grids, or " + second);
  if (!masses.empty())
    error(join_names(masses) + (masses.size() > 1 ? " have mass" : " has mass") +
              " that is none of a rigid body: it differs by direction",
          "give it one mass for all directions, or " + second);
}

}  // namespace

void check_third_order(const BodyRequest& request, const fe::Model& model) {
  if (request.spec.stiffening_order < 3) return;
  add_series_errors(request, model);
  request.diagnostics.throw_if_errors();
}

bool has_series(const BodyRequest& request, const fe::Model& model) {
  Diagnostics found;
  add_series_errors({request.deck, request.spec, request.options, request.given, found}, model);
  return found.num_errors() == 0;
}

namespace {

/// Fields of T, (num_gdofs + 9) x m, orthonormal under M: the span of the modes, affine fields, and the leading
/// directions of what these leave of u₂; those that move. Amplitudes are weighted by 1/ω² (here 1/ω more than the
/// scale).
template <class GetLattice>
MatrixXd choose_fields(const fe::Model& model, const StaticManifold& manifold, const std::vector<int>& large,
                       const GetLattice& get_lattice, const ModalBasis& basis, const FieldMass& M,
                       const FlexBody& body) {
  const double unit = manifold.scale()(large).maxCoeff();
  const VectorXd weight = manifold.scale() / unit;
  /// of each monomial of a degree
  const auto calc_weights = [&](int degree) {
    const Eigen::MatrixXi& exponents = get_lattice(degree).exponents();
    VectorXd weights = VectorXd::Ones(exponents.rows());
    for (Eigen::Index i = 0; i < exponents.rows(); ++i)
      for (Eigen::Index j = 0; j < exponents.cols(); ++j)
        weights[i] *= std::pow(weight[degree == 2 ? j : large[static_cast<std::size_t>(j)]], exponents(i, j));
    return weights;
  };
  MatrixXd fields = MatrixXd::Zero(model.num_gdofs() + 9, 0);
  append_orthonormal(M, make_fields(basis.Phi), 0, fields);
  append_orthonormal(M, calc_affine_fields(model, body.cg), kNoMass, fields);
  MatrixXd rest = make_fields(manifold.field(2) * calc_weights(2).asDiagonal());
  const auto calc_gram = [&] { return linear::symmetrize(linear::calc_inner_products(rest, M.multiply(rest))); };
  const double whole = calc_gram().trace();
  const MatrixXd M_fields = M.multiply(fields);
  for (int pass = 0; pass < 2; ++pass) rest -= fields * linear::calc_inner_products(M_fields, rest);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(calc_gram());
  double left = eigen.eigenvalues().sum();
  int num_extra = 0;
  while (num_extra < kMaxExtraFields && num_extra < rest.cols() && left > kLeftOut * whole) {
    left -= eigen.eigenvalues()[rest.cols() - 1 - num_extra];
    ++num_extra;
  }
  append_orthonormal(M, rest * eigen.eigenvectors().rightCols(num_extra).rowwise().reverse(), 0, fields);

  const MatrixXd M_psi = M.multiply(fields).topRows(model.num_gdofs());
  VectorXd of_field = VectorXd::Zero(fields.cols());
  for (int k = 2; k <= 3; ++k) {
    const MatrixXd p =
        linear::calc_inner_products(M_psi, manifold.field(k)) +
        manifold.calc_carried_work(k, get_lattice(k), fields.topRows(model.num_gdofs()), fields.bottomRows<9>())
            .on_fields;
    of_field += (p * calc_weights(k).asDiagonal()).rowwise().squaredNorm();
  }
  std::vector<Eigen::Index> used;
  for (Eigen::Index q = 0; q < fields.cols(); ++q)
    if (of_field[q] > kNoUse * of_field.sum()) used.push_back(q);
  return fields(Eigen::all, used);
}

/// Degree `degree` of the rows of a block: rows x monomials.
MatrixXd calc_block(const StaticManifold& manifold, const fe::Model& model, int degree, const Lattice& lattice,
                    const std::vector<int>& elements, const records::RecoveryBlock& block) {
  const auto own = fe::get_own_elements(model);
  const auto c = static_cast<Eigen::Index>(block.components.size());
  MatrixXd rows = MatrixXd::Zero(block.num_rows(), lattice.size());
  for (std::size_t k = 0; k < elements.size(); ++k)
    if (own.contains(elements[k]))
      rows.middleRows(c * static_cast<Eigen::Index>(k), c) =
          manifold.calc_recovery(degree, lattice, *model.elements()[static_cast<std::size_t>(elements[k])]);
  linear::sum_over_ranks(rows);
  return rows;
}

}  // namespace

namespace {

/// Polynomials of degree 2 in y = Q x become those of x: monomials of y x monomials of x.
MatrixXd calc_substitution(const MatrixXd& Q) {
  const int n = static_cast<int>(Q.rows());
  const Eigen::MatrixXi exponents = records::list_exponents(n, 2);
  std::vector<std::pair<int, int>> pairs;
  for (Eigen::Index i = 0; i < exponents.rows(); ++i) {
    std::vector<int> factors;
    for (int j = 0; j < n; ++j) factors.insert(factors.end(), static_cast<std::size_t>(exponents(i, j)), j);
    pairs.emplace_back(factors[0], factors[1]);
  }
  MatrixXd X(exponents.rows(), exponents.rows());
  for (std::size_t i = 0; i < pairs.size(); ++i)
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto [a, b] = pairs[i];
      const auto [c, d] = pairs[k];
      double& x = X(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
      x = Q(a, c) * Q(b, d);
      if (c != d) x += Q(a, d) * Q(b, c);
    }
  return X;
}

/// Large modes that the body file names leave residual vectors small: a free body that an interface node holds bends by
/// them, without terms of degree 4.
void warn_of_held_frame(const BodyRequest& request, const ModalBasis& basis, const std::vector<int>& named) {
  if (named.empty() || !request.is_free() ||
      std::find(basis.kind.begin(), basis.kind.end(), ModeKind::Residual) == basis.kind.end())
    return;
  request.warning_at(
      "stiffening/large", "reduce.held-frame",
      "[body.stiffening] large names modes of a free body with residual vectors: held by a hinge it bends by "
      "residual vectors, whose terms of degree 4 are left out, 2 to 80 % at deflections of 0.02 sizes",
      "remove 'large': combinations of modes and residual vectors are large then");
}

}  // namespace

void set_third_order(const BodyRequest& request, const fe::Model& model, const ModalBasis& basis,
                     const std::vector<LoadPattern>& patterns, const StaticSupport& support,
                     const InertialLoads& inertial, const RecoveredElements& recovered, FlexBody& body) {
  if (request.spec.stiffening_order < 3) return;
  const int n = static_cast<int>(basis.Phi.cols());
  const auto is_static = [&](int mode) { return basis.kind[static_cast<std::size_t>(mode)] != ModeKind::Normal; };
  auto large = find_named_large_modes(request, n);
  if (const auto found = std::find_if(large.begin(), large.end(), is_static); found != large.end()) {
    request.error_at("stiffening/large", "reduce.bad-order",
                     "[body.stiffening] large selects mode " + std::to_string(*found + 1) + ", a residual vector",
                     "select normal modes alone: residual vectors follow them");
    request.diagnostics.throw_if_errors();
  }
  warn_of_held_frame(request, basis, large);
  const int max_large = large.empty() ? std::min(n, kDefaultLargeModes) : static_cast<int>(large.size());
  double num_columns = records::count_monomials(n, 2) * 2;
  for (int k = 3; k <= ThirdOrder::kMaxField; ++k) num_columns += 2 * records::count_monomials(max_large, k);
  char need[64];
  std::snprintf(need, sizeof need, "%.0f MB", 8e-6 * num_columns * model.num_gdofs());
  request.report("third order of at most " + std::to_string(max_large) + " modes, " + need);
  StaticManifold manifold(request, model, basis, support, inertial.M);
  if (!manifold.has_frame()) {
    request.error_at("stiffening/order", "reduce.bad-order",
                     "[body.stiffening] order = 3 is given, but the free body has no inertia about an axis",
                     "use frame = \"node\", give it that inertia, or set order = 2");
    request.diagnostics.throw_if_errors();
  }

  // Loads at the interface bend the body by normal modes and residual vectors together: their soft combinations are the
  // large amplitudes.
  const bool turns =
      large.empty() && std::find(basis.kind.begin(), basis.kind.end(), ModeKind::Residual) != basis.kind.end();
  if (turns)
    manifold.turn(calc_compliant_directions(model, manifold.Phi(), manifold.stiffness(), request.spec.interface_nodes));

  // Degree 2 is of all modes: stiffening by loads concerns the small ones as well.
  const Lattice pairs(n, 2);
  const auto report_points = [&](const std::string& stage, const Lattice& lattice) {
    request.report("third order: " + stage + ", " + std::to_string(lattice.size()) + " points");
  };
  report_points("degree 2", pairs);
  const MatrixXd on_modes = manifold.begin(pairs);  // n x pairs
  if (large.empty()) {
    for (int j = 0; j < n; ++j)
      if (turns || !is_static(j)) large.push_back(j);
    large = find_default_large_modes(model, manifold.Phi(), on_modes, std::move(large), turns);
  }
  request.report(std::string("third order: large ") + (turns ? "directions " : "modes ") + list_modes(large));
  manifold.select_large(large, on_modes);
  const int N = static_cast<int>(large.size());
  ThirdOrder third;
  third.large = large;
  const VectorXd scale = manifold.scale(), large_scale = scale(large);
  MatrixXd to_modes;  // of degree 2
  if (turns) {
    third.directions = large_scale.asDiagonal() * manifold.turned()(large, Eigen::all);
    third.count_directions();
    to_modes = calc_substitution(manifold.turned());
  }
  std::vector<MatrixXd> work;  // forces on the large modes at the lattice of degree k, k = 3..6
  std::vector<Lattice> lattices;
  for (int k = 3; k <= ThirdOrder::kMaxEnergy; ++k) lattices.emplace_back(N, k);
  {
    const MatrixXd points = spread(lattices[0].points(), large, n);
    work.push_back(on_modes(large, Eigen::all) * calc_monomials(pairs.exponents(), points).transpose());
  }
  for (int k = 3; k <= ThirdOrder::kMaxField; ++k) {
    const Lattice& own = lattices[static_cast<std::size_t>(k - 3)];
    report_points("degree " + std::to_string(k), own);
    const MatrixXd gradient = manifold.advance(k, own);
    const Lattice& next = lattices[static_cast<std::size_t>(k - 2)];
    work.push_back(gradient * calc_monomials(own.exponents(), next.points()).transpose());
  }
  {  // degree 6: u₅ is not needed
    const Lattice &own = lattices[2], &next = lattices[3];
    report_points("energy of degree 6", own);
    const MatrixXd gradient = own.fit(manifold.calc_gradient(spread(own.points(), large, n), 5));
    work.push_back(gradient * calc_monomials(own.exponents(), next.points()).transpose());
  }
  for (int k = ThirdOrder::kMinEnergy; k <= ThirdOrder::kMaxEnergy; ++k) {
    const auto at = static_cast<std::size_t>(k - ThirdOrder::kMinEnergy);
    MatrixXd c = fit_energy(lattices[at], work[at], k).transpose();
    unscale(lattices[at].exponents(), large_scale, c);
    third.energy[at] = c.transpose();
  }
  third.energy_small = MatrixXd::Zero(records::count_monomials(N, 2), n - N);

  const auto get_lattice = [&](int k) -> const Lattice& {
    return k == 2 ? pairs : lattices[static_cast<std::size_t>(k - 3)];
  };
  const FieldMass mass(model, inertial.M);
  const MatrixXd fields = choose_fields(model, manifold, large, get_lattice, basis, mass, body);
  const MatrixXd psi = fields.topRows(model.num_gdofs()), strain = fields.bottomRows<9>();
  const MatrixXd M_psi = mass.multiply(fields).topRows(model.num_gdofs());
  const auto find_node = [&](int id) -> const fe::Node& { return model.node(model.find_node(id)); };
  for (const int id : body.node_id) {
    const auto& node = find_node(id);
    MatrixXd& block = third.fields.emplace_back(psi.middleRows(node.first_gdof, 6));
    if (lacks_rotation(model, node)) block.bottomRows<3>().setZero();
  }
  third.node.resize(body.interface_nodes.size());
  const auto num_loads = static_cast<Eigen::Index>(patterns.size());
  MatrixXd F(model.num_gdofs(), num_loads), A_I(records::kNumInertialLoads, num_loads);
  std::vector<std::vector<fe::ArmLoad>> arms;
  for (Eigen::Index e = 0; e < num_loads; ++e) {
    const auto& load = patterns[static_cast<std::size_t>(e)].load;
    F.col(e) = load.F;
    A_I.col(e) = load.A_I;
    arms.push_back(load.arms);
  }
  for (int k = ThirdOrder::kMinField; k <= ThirdOrder::kMaxField; ++k) {
    const auto at = static_cast<std::size_t>(k - ThirdOrder::kMinField);
    const Eigen::MatrixXi& exponents = get_lattice(k).exponents();
    const auto unscaled = [&](MatrixXd c) {
      if (k == 2 && turns)
        c *= to_modes;
      else
        unscale(exponents, k == 2 ? scale : large_scale, c);
      return MatrixXd(c.transpose());
    };
    const MatrixXd& u = manifold.field(k);
    const auto carried = manifold.calc_carried_work(k, get_lattice(k), psi, strain);
    third.amplitudes[at] = unscaled(linear::calc_inner_products(M_psi, u) + carried.on_fields);
    third.load[at] = unscaled(linear::calc_inner_products(F, u) + A_I.transpose() * carried.on_inertial +
                              manifold.calc_arm_work(k, get_lattice(k), arms));
    for (std::size_t i = 0; i < third.node.size(); ++i) {
      const auto& node = find_node(body.interface_nodes[i]);
      MatrixXd rows = u.middleRows(node.first_gdof, 6);
      if (lacks_rotation(model, node)) rows.bottomRows<3>().setZero();
      third.node[i][at] = unscaled(std::move(rows));
    }
    for (std::size_t b = 0; b < recovered.size(); ++b)
      body.recovery[b].beyond[at] =
          unscaled(calc_block(manifold, model, k, get_lattice(k), recovered[b], body.recovery[b])).transpose();
  }
  MatrixXd both(model.num_gdofs(), n + psi.cols());
  both << basis.Phi, psi;
  FlexBody carrier;
  MatrixXd of_arms = MatrixXd::Zero(9, n + psi.cols());
  of_arms.rightCols(psi.cols()) = strain;
  set_integrals(request, model, both, inertial, carrier, of_arms);
  third.integrals = carrier.integrals();
  third.coupling = linear::calc_inner_products(basis.Phi, M_psi);
  body.third_order = std::move(third);
}

void set_lost_loads(const ModalBasis& basis, FlexBody& body) {
  auto& third = body.third_order;
  const auto n = static_cast<int>(basis.Phi.cols());
  if (third.empty()) return;
  const Eigen::MatrixXi exponents = records::list_exponents(n, 2);
  const auto is_named = [&](const std::string& name) {
    const auto& lost = basis.massless_loads;
    return std::find(lost.begin(), lost.end(), name) != lost.end();
  };
  // A unit load may have a locator of the interface and some of [[body.load]]s.
  std::set<std::pair<int, int>> lost_units;
  for (const auto& [name, node, direction] : body.locators)
    if (node != 0 && (is_named(name) || is_named(get_unit_name(node, direction)))) lost_units.emplace(node, direction);
  for (std::size_t e = 0; e < body.locators.size(); ++e) {
    const auto& [name, node, direction] = body.locators[e];
    if (node == 0 ? !is_named(name) : direction <= 3 || !lost_units.contains({node, direction})) continue;
    const auto at = std::find(body.interface_nodes.begin(), body.interface_nodes.end(), node);
    for (Eigen::Index i = 0; i < exponents.rows(); ++i) {
      std::vector<int> pair;
      for (int j = 0; j < n; ++j) pair.insert(pair.end(), static_cast<std::size_t>(exponents(i, j)), j);
      const auto is_residual = [&](int j) { return basis.kind[static_cast<std::size_t>(j)] == ModeKind::Residual; };
      if (!is_residual(pair[0]) && !is_residual(pair[1])) continue;
      const double second = -(pair[0] == pair[1] ? 0.5 : 1) * body.kg_external[e](pair[0], pair[1]);
      third.load[0](i, static_cast<Eigen::Index>(e)) = second;
      if (node != 0 && at != body.interface_nodes.end())
        third.node[static_cast<std::size_t>(at - body.interface_nodes.begin())][0](i, direction - 1) = second;
    }
  }
}

}  // namespace bough::stiffening
