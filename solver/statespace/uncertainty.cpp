#include "solver/statespace/uncertainty.hpp"

#include <algorithm>
#include <sstream>

#include "base/diagnostic.hpp"
#include "solver/statespace/poles.hpp"

namespace bough::statespace {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using records::LinearModel;

/// Numbers of displacements, states, inputs and outputs.
struct Sizes {
  Index n, nx, nu, ny;
  explicit Sizes(const LinearModel& m) : n(m.mass.rows()), nx(m.A.rows()), nu(m.B.cols()), ny(m.C.rows()) {}
  Index num_z() const { return nx - 2 * n; }
};

MatrixXd join(const MatrixXd& x, const MatrixXd& u) {
  MatrixXd out(x.rows(), x.cols() + u.cols());
  out << x, u;
  return out;
}

/// Rows of δü by [x; u].
MatrixXd get_accelerations(const LinearModel& m) {
  const Sizes s(m);
  return join(m.A.middleRows(s.n, s.n), m.B.middleRows(s.n, s.n));
}

/// Dependence of outputs on δü, by what all models have in common: y changes with them as Ca δü does.
MatrixXd find_acceleration_outputs(const LinearModel& nominal, const std::vector<const LinearModel*>& others) {
  const Sizes s(nominal);
  const auto num_models = static_cast<Index>(others.size()), width = (s.nx + s.nu) * num_models;
  MatrixXd y(s.ny, width), a(s.n, width);
  for (std::size_t k = 0; k < others.size(); ++k) {
    const auto at = static_cast<Index>(k) * (s.nx + s.nu);
    y.middleCols(at, s.nx + s.nu) = join(others[k]->C, others[k]->D) - join(nominal.C, nominal.D);
    a.middleCols(at, s.nx + s.nu) = get_accelerations(*others[k]) - get_accelerations(nominal);
  }
  if (s.n == 0 || a.cwiseAbs().maxCoeff() == 0) return MatrixXd::Zero(s.ny, s.n);
  // Columns of one size, so that the rank does not depend on units: a size for a state or input in all models, since
  // that of one model may be round-off.
  VectorXd sizes = VectorXd::Zero(s.nx + s.nu);
  for (Index k = 0; k < num_models; ++k)
    sizes = sizes.cwiseMax(a.middleCols(k * sizes.size(), sizes.size()).colwise().norm().transpose());
  const VectorXd scale = sizes.cwiseMax(1e-300).replicate(num_models, 1);
  const MatrixXd a_scaled = a * scale.cwiseInverse().asDiagonal(), y_scaled = y * scale.cwiseInverse().asDiagonal();
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver;
  solver.setThreshold(1e-8);
  solver.compute(a_scaled.transpose());
  return solver.solve(y_scaled.transpose()).transpose();
}

/// R(p): rows δ̇, 0 = M-row, ż, y; columns [δü; x; u].
MatrixXd make_rows(const LinearModel& m, const MatrixXd& Ca) {
  const Sizes s(m);
  MatrixXd R = MatrixXd::Zero(s.nx + s.ny, s.n + s.nx + s.nu);
  const MatrixXd all = join(m.A, m.B), a = get_accelerations(m);
  R.topRightCorner(s.nx, s.nx + s.nu) = all;
  R.block(s.n, 0, s.n, s.n) = -m.mass;
  R.block(s.n, s.n, s.n, s.nx + s.nu) = m.mass * a;
  R.bottomLeftCorner(s.ny, s.n) = Ca;
  R.bottomRightCorner(s.ny, s.nx + s.nu) = join(m.C, m.D) - Ca * a;
  return R;
}

/// Largest terms that each row of R sums: an output that feels an acceleration nearly cancels in y - Ca δü.
VectorXd calc_row_sizes(const LinearModel& m, const MatrixXd& Ca) {
  const Sizes s(m);
  const MatrixXd a = get_accelerations(m).cwiseAbs();
  VectorXd size = make_rows(m, Ca).cwiseAbs().rowwise().maxCoeff();
  if (s.n == 0) return size;
  auto forces = size.segment(s.n, s.n), outputs = size.tail(s.ny);
  forces = forces.cwiseMax((m.mass.cwiseAbs() * a).rowwise().maxCoeff());
  if (s.ny > 0) outputs = outputs.cwiseMax((Ca.cwiseAbs() * a).rowwise().maxCoeff());
  return size;
}

/// An output that is next to zero, as a component of an acceleration across the motion, is judged by others of its
/// dimension: what is left of it is round-off, and the residual of the equilibrium.
void raise_small_outputs(const LinearModel& m, VectorXd& row_size) {
  constexpr double kSmall = 1e-4;
  const Sizes s(m);
  auto outputs = row_size.tail(s.ny);
  const VectorXd own = outputs;
  for (Index i = 0; i < s.ny; ++i)
    for (Index j = 0; j < s.ny; ++j)
      if (m.outputs.dims[static_cast<std::size_t>(i)] == m.outputs.dims[static_cast<std::size_t>(j)])
        outputs[i] = std::max(outputs[i], kSmall * own[j]);
}

/// \param models  all that were compared: where one of them accelerates, M A_u has -(∂M/∂q) u̇, u̇ = M⁻¹ f.
[[noreturn]] void refuse(const std::string& what, const std::vector<const LinearModel*>& models,
                         const SourceLocation& at) {
  constexpr double kAtRest = 1e-9;  // of |A| times one; equilibria are found to much less
  double largest = 0;
  for (const auto* m : models)
    if (m->residual > kAtRest * m->A.cwiseAbs().maxCoeff()) largest = std::max(largest, m->residual);
  const bool at_rest = models.front()->residual <= kAtRest * models.front()->A.cwiseAbs().maxCoeff();
  if (largest == 0)
    throw InputError("linear.not-affine", at, what,
                     "linearize at a state that does not move with the parameter, take the square or the inverse as "
                     "the parameter, or use bough linearize --sweep");
  std::ostringstream text;
  text.precision(3);
  text << what << "; the operating point "
       << (at_rest ? "is at rest in the middle of the ranges only: " : "is not at rest: ") << "it accelerates by "
       << largest << ", and what follows from that acceleration is not affine in a mass or a load";
  throw InputError("linear.not-affine", at, text.str(),
                   at_rest
                       ? "use bough linearize --sweep: the state of rest moves with the parameter"
                       : "give --equilibrium, which is exact if the state of rest does not move with the parameter, "
                         "or use bough linearize --sweep");
}

void demand_same(const LinearModel& nominal, const LinearModel& other, const std::string& name,
                 const SourceLocation& at) {
  if (other.states.name != nominal.states.name || other.inputs.name != nominal.inputs.name ||
      other.outputs.name != nominal.outputs.name || other.mass.rows() != nominal.mass.rows())
    refuse("the model has other states, inputs or outputs at an end of the range of " + name, {&nominal}, at);
}

/// Columns U and rows V with U V = change, by the singular values of its scaled rows.
struct Factors {
  MatrixXd U, V;
};
Factors factor(const MatrixXd& change, const VectorXd& row_size, double tolerance) {
  const MatrixXd scaled = row_size.cwiseInverse().asDiagonal() * change;
  const Eigen::JacobiSVD<MatrixXd> svd(scaled, Eigen::ComputeThinU | Eigen::ComputeThinV);
  Index rank = 0;
  while (rank < svd.singularValues().size() && svd.singularValues()[rank] > tolerance) ++rank;
  const VectorXd root = svd.singularValues().head(rank).cwiseSqrt();
  return {row_size.asDiagonal() * svd.matrixU().leftCols(rank) * root.asDiagonal(),
          root.asDiagonal() * svd.matrixV().leftCols(rank).transpose()};
}

}  // namespace

LinearModel make_uncertain_model(const LinearModel& nominal, const std::vector<ParameterEnds>& ends,
                                 const LinearModel& together, double error, const SourceLocation& at) {
  BOUGH_DEMAND(nominal.sample_time == 0 && !ends.empty());
  const Sizes s(nominal);
  std::vector<const LinearModel*> others;
  for (const auto& end : ends) {
    demand_same(nominal, end.at_low, end.name, at);
    demand_same(nominal, end.at_high, end.name, at);
    others.insert(others.end(), {&end.at_low, &end.at_high});
  }
  demand_same(nominal, together, "the parameters together", at);
  others.push_back(&together);
  const MatrixXd Ca = find_acceleration_outputs(nominal, others);
  const MatrixXd R0 = make_rows(nominal, Ca);
  VectorXd row_size = calc_row_sizes(nominal, Ca);
  for (const auto* other : others) row_size = row_size.cwiseMax(calc_row_sizes(*other, Ca));
  raise_small_outputs(nominal, row_size);
  row_size = (row_size.array() > 0).select(row_size, 1);
  const double noise = std::max(1e-11, error), tolerance = 100 * noise, allowed = 1e-6;
  const auto is_zero = [&](const MatrixXd& R) {
    return (row_size.cwiseInverse().asDiagonal() * R).cwiseAbs().maxCoeff() <= allowed;
  };

  LinearModel out = nominal;
  MatrixXd all = MatrixXd::Zero(R0.rows(), R0.cols());
  std::vector<Factors> factors;
  Index num_w = 0;
  for (const auto& end : ends) {
    const MatrixXd low = make_rows(end.at_low, Ca), high = make_rows(end.at_high, Ca);
    if (!is_zero(low + high - 2 * R0))
      refuse("the equations are not affine in " + end.name, {&nominal, &end.at_low, &end.at_high}, at);
    const MatrixXd change = 0.5 * (high - low);
    all += change;
    factors.push_back(factor(change, row_size, tolerance));
    const auto rank = factors.back().U.cols();
    if (rank == 0)
      throw InputError(
          "linear.no-effect", at, end.name + " changes nothing in its range",
          "leave it out, or give it a wider range; parameters of a controller that --open or --break leaves "
          "out are not in the model");
    out.uncertainty.push_back({end.name, end.low, end.high, static_cast<int>(rank)});
    num_w += rank;
  }
  if (!is_zero(make_rows(together, Ca) - R0 - all))
    refuse("the parameters multiply each other: their effects do not add up", {&nominal, &together}, at);

  MatrixXd U(R0.rows(), num_w), V(num_w, R0.cols());
  Index first = 0;
  records::Signals w, z;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const auto rank = factors[i].U.cols();
    U.middleCols(first, rank) = factors[i].U;
    V.middleRows(first, rank) = factors[i].V;
    first += rank;
    for (Index k = 1; k <= rank; ++k) {
      w.name.push_back(ends[i].name + ":w" + std::to_string(k));
      z.name.push_back(ends[i].name + ":z" + std::to_string(k));
      w.dims.emplace_back("scaled");
      z.dims.emplace_back("scaled");
    }
  }
  // δü = (rows of A) x + (rows of B) u + M⁻¹ U_m w
  const MatrixXd push = s.n > 0 ? MatrixXd(nominal.mass.ldlt().solve(U.middleRows(s.n, s.n))) : MatrixXd(0, num_w);
  MatrixXd B_w = U.topRows(s.nx);
  B_w.middleRows(s.n, s.n) = push;
  const MatrixXd Va = V.leftCols(s.n), Vx = V.middleCols(s.n, s.nx), Vu = V.rightCols(s.nu);
  const MatrixXd a = get_accelerations(nominal);
  out.B = join(B_w, nominal.B);
  out.C.resize(num_w + s.ny, s.nx);
  out.C << Vx + Va * a.leftCols(s.nx), nominal.C;
  out.D.resize(num_w + s.ny, num_w + s.nu);
  out.D << Va * push, Vu + Va * a.rightCols(s.nu), Ca * push + U.bottomRows(s.ny), nominal.D;
  for (auto [list, more] : {std::pair(&out.inputs, &w), std::pair(&out.outputs, &z)}) {
    list->name.insert(list->name.begin(), more->name.begin(), more->name.end());
    list->dims.insert(list->dims.begin(), more->dims.begin(), more->dims.end());
  }
  return out;
}

LinearModel close_uncertainty(const LinearModel& model, const VectorXd& delta) {
  BOUGH_DEMAND(delta.size() == static_cast<Index>(model.uncertainty.size()));
  Index num_w = 0;
  for (const auto& one : model.uncertainty) num_w += one.size;
  VectorXd gain(num_w);
  Index at = 0;
  for (std::size_t i = 0; i < model.uncertainty.size(); ++i)
    for (int k = 0; k < model.uncertainty[i].size; ++k) gain[at++] = delta[static_cast<Index>(i)];
  const Index nu = model.B.cols() - num_w, ny = model.C.rows() - num_w;
  const auto B_w = model.B.leftCols(num_w), B_u = model.B.rightCols(nu);
  const auto C_z = model.C.topRows(num_w), C_y = model.C.bottomRows(ny);
  // z = C_z x + D_zw δ z + D_zu u
  const MatrixXd loop = MatrixXd::Identity(num_w, num_w) - model.D.topLeftCorner(num_w, num_w) * gain.asDiagonal();
  const Eigen::FullPivLU<MatrixXd> lu(loop);
  if (num_w > 0 && !lu.isInvertible())
    throw ComputationError("linear.no-inverse", {}, "the loop of the uncertain parameters has no solution there",
                           "choose values inside their ranges");
  LinearModel out = model;
  const MatrixXd on_x = gain.asDiagonal() * lu.solve(MatrixXd(C_z)),
                 on_u = gain.asDiagonal() * lu.solve(MatrixXd(model.D.topRightCorner(num_w, nu)));
  out.A = model.A + B_w * on_x;
  out.B = B_u + B_w * on_u;
  out.C = C_y + model.D.bottomLeftCorner(ny, num_w) * on_x;
  out.D = model.D.bottomRightCorner(ny, nu) + model.D.bottomLeftCorner(ny, num_w) * on_u;
  for (auto* list : {&out.inputs, &out.outputs}) {
    list->name.erase(list->name.begin(), list->name.begin() + num_w);
    list->dims.erase(list->dims.begin(), list->dims.begin() + num_w);
  }
  out.uncertainty.clear();
  out.mass.resize(0, 0);
  out.poles = calc_poles(out.A, out.states.name);
  out.has_zeros = false;
  out.zeros_real.resize(0);
  out.zeros_imag.resize(0);
  return out;
}

}  // namespace bough::statespace
