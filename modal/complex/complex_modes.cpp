#include "modal/complex/complex_modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "fe/statics/build_model.hpp"
#include "modal/complex/complex_solver.hpp"
#include "modal/complex/physical_input.hpp"
#include "modal/complex/rotor_case.hpp"
#include "modal/response/accuracy.hpp"
#include "modal/response/deck_response.hpp"
#include "modal/response/direct_model.hpp"
#include "modal/response/frequency_tables.hpp"
#include "modal/response/residual_modes.hpp"

namespace bough::modal::complex_modes {
namespace {

constexpr int kDefaultModes = 10;
constexpr int kReferenceModes = 8;      ///< real modes from which the shift and the scale of time are chosen
constexpr Index kMaxComplete = 2000;    ///< unknowns up to which every eigenvalue is computed on request
constexpr double kRigidBody = 1e-5;     ///< of the first elastic frequency
constexpr double kNoOrbit = 1e-12;      ///< square of the share of the largest component
constexpr double kRepeated = 1e-7;      ///< relative difference of eigenvalues
constexpr Index kMaxInputVectors = 60;  ///< dofs of direct input with residual vectors

/// The matrices with the way back to the dofs of the model.
struct Problem {
  PencilBuilder builder{0};
  Eigen::SparseMatrix<double> T_g;  ///< u_g = T_g x of the first unknowns (107)
  MatrixXd Phi;                     ///< the same, dense (110)
  Index num_coordinates = 0;        ///< unknowns before the extra points
  VectorXd lambda;                  ///< of real modes, ascending
  int num_rigid = 0, num_massless = 0;

  /// Adds Nᵀ A N of matrices on the g-set, u_g = N x.
  void add(PencilBuilder& to, const ComplexSparse& K, const ComplexSparse& B, const ComplexSparse& M) const {
    if (Phi.size() == 0) return to.add_projected(T_g, K, B, M);
    const MatrixXcd N = Phi.cast<Complex>();
    to.add_dense(N.transpose() * (K * N), N.transpose() * (B * N), N.transpose() * (M * N));
  }

  MatrixXcd recover(const MatrixXcd& X) const {
    const MatrixXcd q = X.topRows(num_coordinates);
    MatrixXcd u(Phi.size() > 0 ? Phi.rows() : T_g.rows(), X.cols());
    u.real() = Phi.size() > 0 ? MatrixXd(Phi * q.real()) : MatrixXd(T_g * q.real());
    u.imag() = Phi.size() > 0 ? MatrixXd(Phi * q.imag()) : MatrixXd(T_g * q.imag());
    return u;
  }
};

response::Excitation make_no_excitation(const fe::Model& model) {
  response::Excitation none;
  none.F.resize(model.num_gdofs(), 0);
  none.D.resize(static_cast<Index>(model.fixed_dofs().size()), 0);
  return none;
}

/// Real modes for the choice of the shift; none if the real problem has none.
void find_reference(const fe::System& system, Problem& problem) {
  Diagnostics unreported;
  EigenOptions few;
  few.num_modes = kReferenceModes;
  few.check_inertia = false;
  try {
    const auto pairs = calc_normal_modes(system, few, unreported);
    problem.lambda = pairs.lambda;
    problem.num_rigid = pairs.num_rigid;
    problem.num_massless = pairs.num_massless;
  } catch (const Failure&) {  // no mass, no stiffness: the pencil may still be regular
  }
}

Problem make_direct_problem(const fe::System& system, const records::DynamicDeck& deck,
                            const records::DynamicSubcase& subcase, const response::DampingChoice& damping,
                            const PhysicalInput& input) {
  const auto& model = system.model;
  Problem problem;
  find_reference(system, problem);
  const auto direct = response::make_direct_model(system, deck, subcase, make_no_excitation(model), damping);
  problem.num_coordinates = model.num_fdofs();
  problem.T_g = model.T();
  auto& builder = problem.builder;
  builder = PencilBuilder(problem.num_coordinates + static_cast<Index>(input.extra_points.size()));
  if (!input.is_empty()) builder.add_projected(input.calc_transform(problem.T_g), input.K, input.B, input.M);
  builder.add_stiffness(direct.K, 1);
  if (direct.S) builder.add_stiffness(direct.S, Complex(0, 1));
  if (direct.B) builder.add_damping(direct.B, 1);
  builder.add_mass(direct.M, 1);
  return problem;
}

Problem make_modal_problem(const fe::System& system, const records::DynamicDeck& deck,
                           const records::DynamicSubcase& subcase, const response::DampingChoice& damping,
                           const PhysicalInput& input, const std::optional<response::FrequencyTables>& tables,
                           const ComplexModesOptions& options, Diagnostics& diagnostics) {
  const auto& model = system.model;
  Problem problem;
  const auto modes = response::calc_mode_basis(system, options.choose_eigen(subcase, diagnostics), deck,
                                               problem.num_massless, diagnostics);
  problem.lambda = modes.lambda;
  problem.num_rigid = modes.num_rigid;
  auto excitation = make_no_excitation(model);
  // Forces of direct input, and of USETi U6 and RVDOFi: residual vectors make the modes exact for these statically.
  excitation.residual = response::collect_unit_loads(model, deck, diagnostics).F;
  const auto add_residual = [&](const MatrixXd& loads) {
    if (loads.cols() > kMaxInputVectors) return;
    MatrixXd all(model.num_gdofs(), excitation.residual.cols() + loads.cols());
    all << excitation.residual, loads;
    excitation.residual = all;
  };
  add_residual(MatrixXd(input.N_g.transpose()));
  if (tables) add_residual(MatrixXd(tables->directions()));
  diagnostics.throw_if_errors();
  const auto statics = response::make_residual_solver(system, modes, problem.num_massless);
  const auto solve_static = [&](const MatrixXd& F) { return statics->solve(F, &diagnostics); };
  const bool with_residuals = subcase.dynamics.resvec.value_or(deck.find_param("RESVEC") == nullptr ||
                                                               deck.find_param("RESVEC")->value[0] != 'N');
  auto reduced =
      response::make_response_model(model, modes, solve_static, excitation, {}, damping, with_residuals, diagnostics);
  response::select_modes(deck, subcase, modes.num_left_out, reduced, diagnostics);
  diagnostics.throw_if_errors();
  response::report_accuracy(response::calc_basis_error(model, reduced), 0, deck.locate({}), diagnostics);
  problem.Phi = reduced.Phi;
  problem.num_coordinates = reduced.Phi.cols();
  MatrixXcd K = MatrixXcd(reduced.S.cast<Complex>() * Complex(0, 1));
  K.diagonal() += reduced.lambda;
  VectorXd mass = VectorXd::Ones(problem.num_coordinates);
  mass.tail(reduced.num_massless).setZero();
  auto& builder = problem.builder;
  builder = PencilBuilder(problem.num_coordinates + static_cast<Index>(input.extra_points.size()));
  builder.add_dense(K, reduced.D.cast<Complex>(), MatrixXd(mass.asDiagonal()).cast<Complex>());
  if (!input.is_empty()) {
    const Eigen::SparseMatrix<double> Phi = problem.Phi.sparseView(0, 0);
    builder.add_projected(input.calc_transform(Phi), input.K, input.B, input.M);
  }
  return problem;
}

/// Frequencies of the real modes that set the scale of time and the shift.
struct Reference {
  double first = 1, last = 1;
};
Reference choose_reference(const Problem& problem, const QuadraticPencil& p) {
  Reference reference;
  const Index elastic = problem.lambda.size() - problem.num_rigid;
  const auto omega = [](double lambda) { return std::sqrt(std::abs(lambda)); };
  if (elastic > 0 && omega(problem.lambda(problem.num_rigid)) > 0) {
    reference.first = omega(problem.lambda(problem.num_rigid));
    reference.last = omega(problem.lambda(problem.num_rigid + std::min<Index>(elastic, kReferenceModes) - 1));
    return reference;
  }
  // Without modes: from the magnitude of the matrices.
  const double k = p.K.norm(), b = p.B.norm(), m = p.M.norm();
  const double scale = k > 0 && m > 0 ? std::sqrt(k / m) : k > 0 && b > 0 ? k / b : b > 0 && m > 0 ? b / m : 1;
  return {scale, scale};
}

std::vector<Complex> list_shifts(const Problem& problem, const Reference& reference) {
  std::vector<Complex> shifts;
  if (problem.num_rigid == 0 && problem.num_massless == 0) shifts.emplace_back(0);
  for (const Complex factor : {Complex(0.5, 0), Complex(0.31, 0.17), Complex(0.83, 0.29)})
    shifts.push_back(factor * reference.first);
  return shifts;
}

int count_wanted(const records::ComplexMethod& method, const ComplexModesOptions& options, Index size) {
  if (options.num_modes > 0) return options.num_modes;
  if (method.num_modes > 0) return method.num_modes;
  return method.method == "HESS" && size <= kMaxComplete ? 0 : kDefaultModes;
}

/// Appends pairs of another shift without those that are there.
void append(ComplexPairs& all, const ComplexPairs& more) {
  std::vector<Index> kept;
  for (Index j = 0; j < more.lambda.size(); ++j)
    if ((all.lambda.array() - more.lambda(j)).abs().minCoeff() > 1e-8 * std::abs(more.lambda(j))) kept.push_back(j);
  const Index before = all.lambda.size(), after = before + static_cast<Index>(kept.size());
  const auto join = [&](auto& to, const auto& from) {
    to.conservativeResize(to.rows(), after);
    to.rightCols(after - before) = from(Eigen::all, kept);
  };
  join(all.X, more.X);
  join(all.Y, more.Y);
  all.lambda.conservativeResize(after);
  all.lambda.tail(after - before) = more.lambda(kept);
  all.residual.conservativeResize(after);
  all.residual.tail(after - before) = more.residual(kept);
  all.biorthogonality = std::max(all.biorthogonality, more.biorthogonality);
  all.num_iterations += more.num_iterations;
  std::vector<Index> order(static_cast<std::size_t>(after));
  for (Index j = 0; j < after; ++j) order[static_cast<std::size_t>(j)] = j;
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    const Complex x = all.lambda(a), y = all.lambda(b);
    return x.imag() != y.imag() ? x.imag() < y.imag() : x.real() > y.real();
  });
  all.X = all.X(Eigen::all, order).eval();
  all.Y = all.Y(Eigen::all, order).eval();
  all.lambda = all.lambda(order).eval();
  all.residual = all.residual(order).eval();
}

ComplexPairs solve(const Problem& problem, const QuadraticPencil& pencil, const records::ComplexMethod& method,
                   const ComplexModesOptions& options, const std::function<std::string(Index)>& name_unknown) {
  if (pencil.size() == 0)
    throw ComputationError("modal.no-dofs", {}, "the model has no free dof", "check its SPC sets and rigid elements");
  const auto reference = choose_reference(problem, pencil);
  SolverOptions solver;
  solver.scale = reference.last;
  solver.zero = problem.num_rigid > 0 ? kRigidBody * reference.first : 0;
  const auto defaults = list_shifts(problem, reference);
  if (method.shifts.empty()) {
    solver.shifts = defaults;
    solver.num_modes = count_wanted(method, options, pencil.size());
    return solve_pencil(pencil, solver, name_unknown);
  }
  std::optional<ComplexPairs> all;
  for (const auto& shift : method.shifts) {
    const Complex sigma(shift.alpha, shift.omega);
    // Next to the shift, in case it is an eigenvalue.
    solver.shifts = {sigma, sigma + Complex(1e-3, 1.7e-3) * std::max(std::abs(sigma), reference.first)};
    solver.shifts.insert(solver.shifts.end(), defaults.begin(), defaults.end());
    solver.num_modes = options.num_modes > 0 ? options.num_modes
                       : shift.num_modes > 0 ? shift.num_modes
                                             : count_wanted(method, options, pencil.size());
    const auto pairs = solve_pencil(pencil, solver, name_unknown);
    if (all)
      append(*all, pairs);
    else
      all = pairs;
  }
  return *all;
}

/// Rows of the free components in CD axes, where NORM looks for the largest.
MatrixXcd calc_norm_rows(const fe::Model& model, const MatrixXcd& Phi, const MatrixXcd& extra, int grid, int component,
                         Index& named) {
  std::vector<Eigen::RowVectorXcd> rows;
  named = -1;
  for (int k = 0; k < static_cast<int>(model.nodes().size()); ++k) {
    const auto& node = model.node(k);
    for (int c = 0; c < node.num_dofs; ++c) {
      const bool is_named = node.id == grid && (node.num_dofs == 1 || c + 1 == component);
      if (!is_named && model.find_fdof(k, node.num_dofs == 1 ? 0 : c + 1) < 0) continue;
      if (is_named) named = static_cast<Index>(rows.size());
      if (node.num_dofs == 1)
        rows.emplace_back(Phi.row(node.first_gdof));
      else
        rows.emplace_back(node.R_basic_cd.col(c % 3).transpose().cast<Complex>() *
                          Phi.middleRows(node.first_gdof + 3 * (c / 3), 3));
    }
  }
  MatrixXcd all(static_cast<Index>(rows.size()) + extra.rows(), Phi.cols());
  for (std::size_t i = 0; i < rows.size(); ++i) all.row(static_cast<Index>(i)) = rows[i];
  all.bottomRows(extra.rows()) = extra;
  return all;
}

/// The largest component, or that of NORM = POINT, is 1.
void normalize(const fe::Model& model, const records::DynamicDeck& deck, const records::ComplexMethod& method,
               MatrixXcd& Phi, MatrixXcd& extra, bool reports, Diagnostics& diagnostics) {
  Index named = -1;
  const bool is_point = method.norm == "POINT";
  const auto rows = calc_norm_rows(model, Phi, extra, is_point ? method.norm_grid : 0, method.norm_component, named);
  std::string still;
  for (Index j = 0; j < Phi.cols(); ++j) {
    const double largest = rows.rows() > 0 ? rows.col(j).cwiseAbs().maxCoeff() : 0;
    if (!(largest > 0)) continue;
    Index row = 0;
    while (std::abs(rows(row, j)) < (1 - 1e-6) * largest) ++row;
    if (named >= 0 && std::abs(rows(named, j)) > 1e-9 * largest)
      row = named;
    else if (is_point)
      still += (still.empty() ? "" : ", ") + std::to_string(j + 1);
    const Complex factor = 1.0 / rows(row, j);
    Phi.col(j) *= factor;
    extra.col(j) *= factor;
  }
  if (reports && !still.empty())
    diagnostics.warning("modal.norm-point", deck.locate(method.at),
                        "grid " + std::to_string(method.norm_grid) + " component " +
                            std::to_string(method.norm_component) + " of NORM = POINT does not move in mode " + still +
                            ": its largest component is 1 instead",
                        "name a dof that moves in every mode, or use NORM MAX");
}

std::vector<MatrixXcd> list_shapes(const fe::Model& model, const MatrixXcd& Phi) {
  std::vector<MatrixXcd> shapes;
  for (const auto& node : model.nodes())
    if (node.num_dofs == 6) shapes.emplace_back(Phi.middleRows(node.first_gdof, 6));
  return shapes;
}

MatrixXcd list_points(const fe::Model& model, const MatrixXcd& Phi, const MatrixXcd& extra) {
  std::vector<Index> rows;
  for (const auto& node : model.nodes())
    if (node.num_dofs == 1) rows.push_back(node.first_gdof);
  MatrixXcd points(static_cast<Index>(rows.size()) + extra.rows(), Phi.cols());
  points.topRows(static_cast<Index>(rows.size())) = Phi(rows, Eigen::all);
  points.bottomRows(extra.rows()) = extra;
  return points;
}

void fill_values(const ComplexPairs& pairs, records::ComplexModesResult& result) {
  const Index m = pairs.lambda.size();
  result.eigenvalue = pairs.lambda;
  result.residual = pairs.residual;
  result.frequency_hz = pairs.lambda.imag() / (2 * std::numbers::pi);
  result.damping = result.damping_ratio = VectorXd::Zero(m);
  for (Index j = 0; j < m; ++j) {
    const Complex lambda = pairs.lambda(j);
    if (lambda.imag() > 0) result.damping(j) = -2 * lambda.real() / lambda.imag();
    if (lambda != 0.0) result.damping_ratio(j) = -lambda.real() / std::abs(lambda);
  }
  result.biorthogonality = pairs.biorthogonality;
  result.shift = pairs.shift;
  result.num_iterations = pairs.num_iterations;
  result.num_mirrored = pairs.num_mirrored;
  result.factor_entries = pairs.num_entries;
  result.is_complete = pairs.is_dense;
}

/// Spin rate of a rotor [1/T], at the speed of a mode.
using SpinRate = std::function<double(std::size_t rotor, Index mode)>;

/// Largest orbit across the axis of each mode, of translations (first = 0) or of rotations (first = 3) of the grids of
/// the rotors: its size |u_x|² + |u_y|² and its whirl, (|forward|² - |backward|²) over the sum, from u_x ∓ i u_y.
/// Forward is the direction of the spin, against the axis at a negative rate, and along it at rest.
void find_orbits(const fe::Model& model, const std::vector<fe::Rotor>& rotors, const SpinRate& rate,
                 const MatrixXcd& Phi, int first, VectorXd& largest, VectorXd& whirl) {
  largest = whirl = VectorXd::Zero(Phi.cols());
  for (std::size_t k = 0; k < rotors.size(); ++k) {
    const auto& rotor = rotors[k];
    const Eigen::Vector3d x = rotor.axis.unitOrthogonal(), y = rotor.axis.cross(x);
    for (const int node : rotor.nodes) {
      const auto u = Phi.middleRows(model.node(node).first_gdof + first, 3);
      const Eigen::RowVectorXcd u_x = x.transpose().cast<Complex>() * u, u_y = y.transpose().cast<Complex>() * u;
      for (Index j = 0; j < Phi.cols(); ++j) {
        const double size = std::norm(u_x(j)) + std::norm(u_y(j));
        if (!(size > largest(j))) continue;
        largest(j) = size;
        whirl(j) = (rate(k, j) < 0 ? 2 : -2) * (std::conj(u_x(j)) * u_y(j)).imag() / size;
      }
    }
  }
}

/// Whirl of each mode; empty without rotors. Rotations count where translations are round-off, and 0 is of modes
/// without both: axial motion and torsion.
VectorXd calc_whirl(const fe::Model& model, const std::vector<fe::Rotor>& rotors, const SpinRate& rate,
                    const MatrixXcd& Phi) {
  if (rotors.empty()) return {};
  const VectorXd all = Phi.cwiseAbs2().colwise().maxCoeff();
  VectorXd largest, whirl, tilt, of_tilt;
  find_orbits(model, rotors, rate, Phi, 0, largest, whirl);
  find_orbits(model, rotors, rate, Phi, 3, tilt, of_tilt);
  for (Index j = 0; j < Phi.cols(); ++j)
    if (!(largest(j) > kNoOrbit * all(j))) whirl(j) = tilt(j) > kNoOrbit * all(j) ? of_tilt(j) : 0;
  return whirl;
}

void report_accuracy(const records::DynamicDeck& deck, const ComplexPairs& pairs, int num_wanted,
                     Diagnostics& diagnostics) {
  const auto found = std::count_if(pairs.lambda.begin(), pairs.lambda.end(), [](Complex l) { return l.imag() > 0; });
  if (num_wanted > 0 && found < num_wanted)
    diagnostics.warning("modal.fewer-complex-modes", deck.locate({}),
                        std::to_string(num_wanted) + " complex modes are asked for, the matrices have " +
                            std::to_string(found) + " that oscillate",
                        "ask for fewer, or take more real modes in SOL 110");
}

}  // namespace

std::vector<int> list_subcases(const records::DynamicDeck& deck) {
  std::vector<int> chosen;
  for (const auto& subcase : deck.subcases) {
    const auto selection = deck.selections.find(subcase.id);
    const bool is_preload = std::any_of(deck.subcases.begin(), deck.subcases.end(), [&](const auto& other) {
      return other.id != subcase.id && (other.statsub == subcase.id || other.preload == subcase.id);
    });
    if (selection != deck.selections.end() && selection->second.cmethod != 0 && !is_preload)
      chosen.push_back(subcase.id);
  }
  return chosen.empty() ? std::vector<int>{0} : chosen;
}

const records::ComplexMethod& choose_method(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                                            int num_modes) {
  static const records::ComplexMethod lanczos{0, "LAN", "MAX", 0, 0, 0, {}, {}};
  const int set = subcase.dynamics.cmethod;
  const auto& all = deck.dynamics.complex_methods;
  const auto found = std::find_if(all.begin(), all.end(), [set](const auto& m) { return m.sid == set; });
  if (set != 0 && found == all.end())
    throw InputError("modal.missing-complex-method", deck.locate(subcase.find_command("CMETHOD")),
                     "CMETHOD = " + std::to_string(set) + " names no EIGC card of the deck",
                     "add the card, for instance EIGC," + std::to_string(set) + ",LAN,,,,,10, or correct the id");
  if (set != 0) return *found;
  if (num_modes > 0) return lanczos;
  throw InputError("modal.no-complex-method", deck.locate({}),
                   "SOL " + deck.sol + " requests complex eigenvalues, found no CMETHOD in the case control",
                   "write CMETHOD = n with a card EIGC,n,LAN,,,,,10, or give --number");
}

struct ComplexModesSolver::Prepared {
  Prepared(const records::DynamicDeck& d, const records::DynamicSubcase& s, const ComplexModesOptions& o, fe::Model&& m)
      : deck(d), subcase(s), options(o), model(std::move(m)), system(model) {}

  const records::DynamicDeck& deck;
  const records::DynamicSubcase subcase;
  const ComplexModesOptions options;
  const fe::Model model;
  const fe::System system;
  records::ComplexMethod method;
  PhysicalInput input;
  Problem problem;
  std::optional<rotors::RotorCase> rotor_case;
  std::optional<rotors::RotorTerms> rotor_terms;
  std::optional<response::FrequencyTables> tables;  ///< over the speed; none without rotors

  std::string name_unknown(Index i) const {
    if (i >= problem.num_coordinates) {
      const auto k = static_cast<std::size_t>(i - problem.num_coordinates);
      return k < input.extra_points.size() ? "extra point " + std::to_string(input.extra_points[k]) : "a constraint";
    }
    if (options.is_by_modes) return "mode " + std::to_string(i + 1);
    const auto [node, component] = model.describe_fdof(static_cast<int>(i));
    return component == 0 ? "scalar point " + std::to_string(node)
                          : "grid " + std::to_string(node) + " component " + std::to_string(component);
  }

  /// Rotors at a speed of the reference rotor, or at the speed ω of the motion (λ = iω).
  QuadraticPencil make_pencil(std::optional<double> speed) const {
    if (!rotor_terms) return problem.builder.build();
    PencilBuilder builder = problem.builder;
    const Index n = model.num_gdofs();
    // The structural damping of rotors acts by its viscous equivalent only.
    const auto without = ComplexSparse(rotor_terms->model_structural().cast<Complex>() * Complex(0, -1));
    const auto complex = [](const fe::SparseColumns& A, Complex factor) {
      return ComplexSparse(A.cast<Complex>() * factor);
    };
    if (speed) {
      const fe::SparseColumns K = rotor_terms->calc_circulation(*speed) + rotor_terms->calc_centrifugal(*speed);
      ComplexSparse K_s = complex(K, 1) + without, B_s = complex(rotor_terms->calc_damping(*speed), 1);
      if (tables) {
        const double revolutions = std::abs(*speed) / (2 * std::numbers::pi);
        K_s += tables->calc_stiffness_matrix(revolutions);
        B_s += tables->calc_damping_matrix(revolutions);
      }
      problem.add(builder, K_s, B_s, ComplexSparse(n, n));
      return builder.build();
    }
    const auto terms = rotor_terms->calc_synchronous();
    // ω = -iλ, ω² = -λ².
    problem.add(builder, complex(terms.circulation + terms.centrifugal, 1) + without,
                complex(terms.damping, 1) + complex(terms.circulation_rate + terms.centrifugal_rate, Complex(0, -1)),
                complex(terms.gyroscopic_rate, Complex(0, -1)) + complex(terms.centrifugal_square, -1));
    return builder.build();
  }

  /// Whirl of modes at a speed of the reference rotor, or at the speed Im λ; empty without rotors.
  VectorXd calc_whirl(std::optional<double> speed, const Eigen::VectorXcd& lambda, const MatrixXcd& Phi) const {
    if (!rotor_terms) return {};
    const auto rate = [&](std::size_t rotor, Index j) {
      return rotor_case->relations[rotor].evaluate(speed.value_or(lambda(j).imag()));
    };
    return complex_modes::calc_whirl(model, rotor_terms->rotors(), rate, Phi);
  }

  ComplexPairs find_pairs(const QuadraticPencil& pencil, const records::ComplexMethod& by,
                          const ComplexModesOptions& with) const {
    try {
      return complex_modes::solve(problem, pencil, by, with, [this](Index i) { return name_unknown(i); });
    } catch (const ComputationError& failure) {
      auto items = failure.items();
      for (auto& item : items)
        if (item.where.file.empty()) item.where = deck.locate(method.at);
      throw ComputationError(std::move(items));
    }
  }
};

namespace {

/// Selections of a subcase in addition to its method: damping, direct input, rotors.
struct Selections {
  records::DynamicSubcase without_input;  ///< K2PP is no part of the structure here: neither G nor ALPHA2 acts on it
  response::DampingChoice damping;
  PhysicalInput input;
  std::optional<rotors::RotorCase> rotor_case;
  std::optional<response::FrequencyTables> tables;  ///< over the speed
};

/// Tables of PELAST, PDAMPT and PBUSHT over the speed of the reference rotor, in revolutions; none without rotors.
std::optional<response::FrequencyTables> choose_tables(const fe::Model& model, const records::DynamicDeck& deck,
                                                       const std::optional<rotors::RotorCase>& rotor_case, double g,
                                                       Diagnostics& diagnostics) {
  if (rotor_case) response::report_part_tables(deck, diagnostics);
  response::FrequencyTables tables(model, deck, g, diagnostics);
  if (tables.is_empty()) return std::nullopt;
  const auto at = deck.locate(deck.dynamics.frequency_tables.front().at);
  if (!rotor_case) {
    diagnostics.note("modal.nominal-tables", at,
                     "tables over frequency have no effect on complex modes without rotors: the values of PELAS, PDAMP "
                     "and PBUSH count",
                     "give the values at the frequency of interest there");
    return std::nullopt;
  }
  if (rotor_case->is_synchronous || rotor_case->is_rotating) {
    diagnostics.error(
        "modal.rotor-unsupported", at,
        std::string("tables over the speed are not supported ") +
            (rotor_case->is_synchronous ? "in synchronous analyses" : "in the rotating frame"),
        rotor_case->is_synchronous
            ? "solve at a list of speeds (ASYNC with RSPEED): the Campbell diagram has the critical speeds"
            : "solve in the fixed frame (REFSYS = FIX)");
    return std::nullopt;
  }
  diagnostics.note("modal.nominal-tables", at,
                   "tables of PELAST, PDAMPT and PBUSHT are evaluated at the speed of the reference rotor in "
                   "revolutions per unit of time",
                   "--ignore PBUSHT computes with the values of PBUSH at every speed, as MSC Nastran");
  return tables;
}

Selections read_selections(const fe::Model& model, const records::DynamicDeck& deck,
                           const records::DynamicSubcase& subcase, bool is_by_modes, Diagnostics& diagnostics) {
  Selections found;
  found.without_input = subcase;
  auto& d = found.without_input.dynamics;
  for (auto* list : {&d.k2pp, &d.m2pp, &d.b2pp}) list->clear();
  response::ResponseOptions damping_options;
  damping_options.is_direct = !is_by_modes;
  found.damping = response::choose_damping(deck, found.without_input, damping_options, model, diagnostics);
  found.input = collect_physical_input(model, deck, subcase, diagnostics);
  found.rotor_case = rotors::choose_rotors(model, deck, subcase, rotors::RotorUse::Eigenvalues, diagnostics);
  if (found.rotor_case && found.rotor_case->is_rotating &&
      (found.input.B.nonZeros() > 0 || found.input.M.nonZeros() > 0))
    diagnostics.error("modal.rotor-unsupported", deck.locate(subcase.find_command("RMETHOD")),
                      "B2PP, M2PP and TFL are matrices of the fixed frame, ROTORD has REFSYS = ROT",
                      "give dampers by CDAMP2, masses by CONM2, or solve in the fixed frame (REFSYS = FIX)");
  found.tables = choose_tables(model, deck, found.rotor_case, found.damping.g, diagnostics);
  if (!is_by_modes && d.sdamping != 0)
    diagnostics.warning("modal.no-modes", deck.locate(subcase.find_command("SDAMPING")),
                        "SDAMPING damps modes: the direct solution leaves it out, as in Nastran",
                        "damp by PARAM,G, GE or dampers, or solve by modes (SOL 110)");
  if (!is_by_modes && d.modsel != 0)
    diagnostics.warning("modal.no-modes", deck.locate(subcase.find_command("MODSEL")),
                        "MODSEL selects real modes: the direct solution has none and leaves it out",
                        "solve by modes (SOL 110), or take it out");
  return found;
}

}  // namespace

void check_selections(const fe::Model& model, const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                      bool is_by_modes, Diagnostics& diagnostics) {
  const auto found = read_selections(model, deck, subcase, is_by_modes, diagnostics);
  diagnostics.throw_if_errors();
  if (found.rotor_case) fe::find_rotors(model, found.rotor_case->axes, diagnostics);
}

ComplexModesSolver::ComplexModesSolver(const records::DynamicDeck& deck, const fe::ModelOptions& model_options,
                                       const records::DynamicSubcase& subcase, const ComplexModesOptions& options,
                                       Diagnostics& diagnostics) {
  const auto& method = choose_method(deck, subcase, options.num_modes);
  auto model = fe::build_model(deck, model_options, diagnostics);
  diagnostics.throw_if_errors();
  prepared_ = std::make_unique<Prepared>(deck, subcase, options, std::move(model));
  auto& p = *prepared_;
  p.method = method;
  auto [without_input, damping, input, rotor_case, tables] =
      read_selections(p.model, deck, subcase, options.is_by_modes, diagnostics);
  diagnostics.throw_if_errors();
  p.input = std::move(input);
  p.rotor_case = std::move(rotor_case);
  p.tables = std::move(tables);
  if (p.rotor_case) p.rotor_terms.emplace(p.model, *p.rotor_case, damping.g, diagnostics);
  p.problem = options.is_by_modes
                  ? make_modal_problem(p.system, deck, without_input, damping, p.input, p.tables, options, diagnostics)
                  : make_direct_problem(p.system, deck, without_input, damping, p.input);
}
ComplexModesSolver::~ComplexModesSolver() = default;

const rotors::RotorCase* ComplexModesSolver::rotor_case() const {
  return prepared_->rotor_case ? &*prepared_->rotor_case : nullptr;
}
const std::vector<fe::Rotor>& ComplexModesSolver::rotors() const {
  static const std::vector<fe::Rotor> none;
  return prepared_->rotor_terms ? prepared_->rotor_terms->rotors() : none;
}

SpeedModes ComplexModesSolver::solve_at(double speed, int num_modes, std::optional<Complex> shift) const {
  const auto& p = *prepared_;
  const auto pencil = p.make_pencil(speed);
  auto method = p.method;
  auto options = p.options;
  if (shift) method.shifts = {{shift->real(), shift->imag(), num_modes}};
  if (num_modes > 0) options.num_modes = num_modes < pencil.size() / 2 ? num_modes : static_cast<int>(pencil.size());
  const auto pairs = p.find_pairs(pencil, method, options);
  std::vector<Index> kept;
  for (Index j = 0; j < pairs.lambda.size(); ++j)
    if (pairs.lambda(j).imag() > 0) kept.push_back(j);
  const auto n = pencil.size(), m = static_cast<Index>(kept.size());
  SpeedModes modes;
  modes.lambda = pairs.lambda(kept);
  const MatrixXcd X = pairs.X(Eigen::all, kept), Y = pairs.Y(Eigen::all, kept);
  modes.right.resize(2 * n, m);
  modes.right << X, X * modes.lambda.asDiagonal();
  const MatrixXcd MY = pencil.M.transpose() * Y, BY = pencil.B.transpose() * Y;
  modes.left.resize(m, 2 * n);
  modes.left << (MY * modes.lambda.asDiagonal() + BY).transpose(), MY.transpose();
  // Vectors of repeated eigenvalues are any basis of their space: the left ones become dual to the right ones.
  for (Index j = 0, next = 0; j < m; j = next) {
    for (next = j + 1;
         next < m && std::abs(modes.lambda(next) - modes.lambda(j)) < kRepeated * std::abs(modes.lambda(j));)
      ++next;
    auto rows = modes.left.middleRows(j, next - j);
    const Eigen::FullPivLU<MatrixXcd> products(rows * modes.right.middleCols(j, next - j));
    if (products.isInvertible()) rows = products.solve(rows).eval();
  }
  modes.whirl = p.calc_whirl(speed, modes.lambda, p.problem.recover(X));
  return modes;
}

records::ComplexModesResult ComplexModesSolver::solve(std::optional<double> speed, Diagnostics& diagnostics) const {
  const auto& [deck, subcase, options, model, system, method, input, problem, rotor_case, rotor_terms, tables] =
      *prepared_;
  const auto pencil = prepared_->make_pencil(speed);
  const auto pairs = prepared_->find_pairs(pencil, method, options);
  if (method.shifts.empty()) report_accuracy(deck, pairs, count_wanted(method, options, pencil.size()), diagnostics);
  records::ComplexModesResult result;
  result.subcase = model.subcase().id;
  result.is_by_modes = options.is_by_modes;
  result.method = method.method;
  result.norm = method.norm;
  result.num_unknowns = static_cast<int>(pencil.size());
  fill_values(pairs, result);
  MatrixXcd Phi = problem.recover(pairs.X);
  result.whirl = prepared_->calc_whirl(speed, pairs.lambda, Phi);
  if (!options.has_shapes) return result;
  std::vector<const fe::Node*> grids;
  for (const auto& node : model.nodes()) {
    if (node.num_dofs == 6)
      grids.push_back(&node);
    else
      result.point_id.push_back(node.id);
  }
  result.point_id.insert(result.point_id.end(), input.extra_points.begin(), input.extra_points.end());
  result.node_xyz.resize(static_cast<Index>(grids.size()), 3);
  for (std::size_t k = 0; k < grids.size(); ++k) {
    result.node_id.push_back(grids[k]->id);
    result.node_xyz.row(static_cast<Index>(k)) = grids[k]->x.transpose();
  }
  const auto num_extra = static_cast<Index>(input.extra_points.size());
  MatrixXcd extra = pairs.X.middleRows(problem.num_coordinates, num_extra);
  normalize(model, deck, method, Phi, extra, true, diagnostics);
  result.phi = list_shapes(model, Phi);
  result.point_phi = list_points(model, Phi, extra);
  if (!pencil.is_symmetric) {
    Phi = problem.recover(pairs.Y);
    extra = pairs.Y.middleRows(problem.num_coordinates, num_extra);
    normalize(model, deck, method, Phi, extra, false, diagnostics);
    result.left = list_shapes(model, Phi);
    result.point_left = list_points(model, Phi, extra);
  }
  result.mesh = model.calc_mesh();
  return result;
}

}  // namespace bough::modal::complex_modes
