#include "solver/linear/linearize.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <tuple>

#include "solver/linear/ports.hpp"
#include "solver/linear/sampled.hpp"
#include "solver/linear/sampled_loop.hpp"
#include "solver/linear/sampled_system.hpp"
#include "solver/statespace/hankel.hpp"
#include "solver/statespace/poles.hpp"
#include "solver/statespace/zeros.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {
namespace {

using records::LinearModel;

/// The second step, for comparison; no power of two of the first.
constexpr double kOtherStep = 0.7;
/// Error of A and C, relative to their rows, above which a warning is issued.
constexpr double kInaccurate = 1e-4;
/// Steps of displacement within the time of the slowest motion: a system that moves less than that is at rest.
constexpr double kAtRest = 1e-6;
/// Way in steps of the plant that shows whether A changes along a motion.
constexpr double kFarWay = 7;
/// Kinks that a message lists.
constexpr std::size_t kMaxKinks = 5;

std::string brief_text(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

/// Dimensions of [u̇; ż; y]; a signal state shares its dimensions with no other.
std::vector<std::string> get_row_dims(const Plant& plant) {
  std::vector<std::string> dims;
  for (int i = 0; i < plant.num_dofs(); ++i) dims.push_back("u_dot " + plant.dof_dims(i));
  for (int i = 0; i < plant.num_states(); ++i)
    dims.push_back(i < plant.num_signal_states() ? plant.state_name(i) : "path_dot " + plant.state_dims(i));
  dims.insert(dims.end(), plant.outputs().dims.begin(), plant.outputs().dims.end());
  return dims;
}

/// Largest value, error and kink of some rows, columns weighted by their steps.
struct RowGroup {
  double value = 0, error = 0, kink = 0;

  /// All rows are below their errors, and these are negligible to `max_value` of all rows; or all are known to less
  /// than three digits, and are round-off of the accelerations or of the largest row.
  bool is_rounding(double max_value, double acceleration) const {
    const double unknown = std::max(error, kink);
    return (value <= error && error <= 1e-9 * max_value) ||
           (value <= 1e3 * unknown && std::max(value, unknown) <= 1e-11 * std::max(max_value, acceleration));
  }
};

/// Clears the rows of an output that is a difference of large and equal terms: all rows with its dimensions are
/// round-off, or it is a component that is round-off of the other components of its vector. Columns are weighted by
/// their steps.
/// \param base  [u̇; ż; y] at the operating point
void clear_rounding(const Plant& plant, const VectorXd& base, const VectorXd& step, Jacobian& jacobian) {
  constexpr double kNoComponent = 1e-14;
  const int n = plant.num_dofs() + plant.num_states();
  const auto calc_size = [&step](const MatrixXd& rows) -> VectorXd {
    return (rows * step.asDiagonal()).cwiseAbs().rowwise().maxCoeff();
  };
  if (step.size() == 0 || jacobian.value.rows() == 0) return;
  const VectorXd value = calc_size(jacobian.value), error = calc_size(jacobian.error), kink = calc_size(jacobian.kink);
  const double acceleration = plant.num_dofs() > 0 ? base.head(plant.num_dofs()).cwiseAbs().maxCoeff() : 0;
  const auto dims = get_row_dims(plant);
  std::map<std::string, RowGroup> by_dims;
  std::map<std::pair<std::string, std::string>, double> by_vector;
  const auto get_vector = [&](Eigen::Index i) {
    const std::string& name = plant.outputs().name[static_cast<size_t>(i - n)];
    return std::pair(name.substr(0, name.rfind(':')), dims[static_cast<size_t>(i)]);
  };
  for (Eigen::Index i = n; i < value.size(); ++i) {
    RowGroup& group = by_dims[dims[static_cast<size_t>(i)]];
    group.value = std::max(group.value, value[i]);
    group.error = std::max(group.error, error[i]);
    group.kink = std::max(group.kink, kink[i]);
    double& vector = by_vector[get_vector(i)];
    vector = std::max(vector, value[i]);
  }
  for (Eigen::Index i = n; i < value.size(); ++i) {
    if (!by_dims[dims[static_cast<size_t>(i)]].is_rounding(value.maxCoeff(), acceleration) &&
        std::max({value[i], error[i], kink[i]}) > kNoComponent * by_vector[get_vector(i)])
      continue;
    jacobian.value.row(i).setZero();
    jacobian.error.row(i).setZero();
    jacobian.kink.row(i).setZero();
  }
}

/// Rows: those of [u̇; ż; y]. Columns: δ, δu, δz.
Jacobian calc_jacobian(Plant& plant, const OperatingPoint& point, double step_factor) {
  const int nx = 2 * plant.num_dofs() + plant.num_states();
  const auto f = [&](const OperatingPoint& moved) { return plant.evaluate(moved); };
  Jacobian jacobian = differentiate_columns(plant, point, f, 0, nx, step_factor);
  const int rows = plant.num_dofs() + plant.num_states() + plant.outputs().size();
  VectorXd steps(nx);
  for (int j = 0; j < nx; ++j) steps[j] = choose_step(plant, point, j);
  if (nx == 0)
    for (MatrixXd* m : {&jacobian.value, &jacobian.error, &jacobian.kink}) m->setZero(rows, 0);
  clear_rounding(plant, plant.evaluate(point), steps, jacobian);
  return jacobian;
}

/// The largest entry of each row, or a thousandth of the largest of all rows with the same dimensions where that is
/// more: a row of zeros has nothing but rounding to be measured by.
VectorXd calc_row_scales(const MatrixXd& value, const std::vector<std::string>& dims) {
  VectorXd scale = solver::calc_row_scales(value);
  std::map<std::string, double> largest;
  for (Eigen::Index i = 0; i < scale.size(); ++i) {
    double& max_value = largest[dims[static_cast<size_t>(i)]];
    max_value = std::max(max_value, scale[i]);
  }
  for (Eigen::Index i = 0; i < scale.size(); ++i)
    scale[i] = std::max(scale[i], 1e-3 * largest[dims[static_cast<size_t>(i)]]);
  return scale;
}

/// The column of a force is exact, f being affine in it: f(value) - f(0), with a value that brings out the difference.
/// Commands and signals may pass limits and friction: their columns are differences, with an error estimate.
VectorXd calc_input_column(Plant& plant, const OperatingPoint& point, const PlantInput& input, const VectorXd& base,
                           Uncertainty& uncertainty) {
  const double large = base.size() > 0 ? base.cwiseAbs().maxCoeff() : 0;
  if (input.actuator >= 0 || input.signal >= 0) {  // limits, a dead band and friction are not affine
    constexpr double kMinStep = 1e-2;
    const VectorXd change = plant.evaluate(point, &input, kMinStep) - base;
    const double own = change.size() > 0 ? change.cwiseAbs().maxCoeff() / kMinStep : 0;
    // A tenth of what acts already: a newton more would be lost in the roundoff of an engine's thrust.
    const double step = own > 0 ? std::max(kMinStep, 0.1 * large / own) : kMinStep;
    Jacobian column = differentiate_column(
        plant, [&](double h) { return plant.evaluate(point, &input, h); }, step);
    clear_rounding(plant, base, VectorXd::Constant(1, step), column);
    Eigen::Index worst = 0;
    if (column.kinks.empty() && column.kink.size() > 0 && column.kink.col(0).cwiseAbs().maxCoeff(&worst) > 0)
      column.kinks.push_back({"input '" + input.name + "'", 0, column.value(worst, 0) - column.kink(worst, 0),
                              column.value(worst, 0) + column.kink(worst, 0)});
    uncertainty.add(column, calc_row_scales(column.value, get_row_dims(plant)));
    return column.value;
  }
  VectorXd column = plant.evaluate(point, &input, 1) - base;
  const double own = column.size() > 0 ? column.cwiseAbs().maxCoeff() : 0;
  const double value = own > 0 ? std::max(1.0, 10 * large / own) : 1;
  if (value > 1) column = (plant.evaluate(point, &input, value) - base) / value;
  const VectorXd rounding = 8 * std::numeric_limits<double>::epsilon() * (base.cwiseAbs() / value + column.cwiseAbs());
  return (column.array().abs() > rounding.array()).select(column, 0.0);
}

/// Largest entry of `difference` relative to the scale of its row.
double calc_relative(const MatrixXd& difference, const VectorXd& scale) {
  double worst = 0;
  for (Eigen::Index i = 0; i < scale.size() && difference.cols() > 0; ++i) {
    if (scale[i] > 0) worst = std::max(worst, difference.row(i).cwiseAbs().maxCoeff() / scale[i]);
  }
  return worst;
}

MatrixXd take_rows(const MatrixXd& m, int first, const std::vector<int>& rows) {
  MatrixXd taken(static_cast<Eigen::Index>(rows.size()), m.cols());
  for (size_t i = 0; i < rows.size(); ++i) taken.row(static_cast<Eigen::Index>(i)) = m.row(first + rows[i]);
  return taken;
}

/// Names of the N values at a cut within a period of all samples: "law@1" to "law@N"; the name itself of one.
records::Signals name_values(const std::string& name, const std::string& dims, Eigen::Index count) {
  records::Signals signals;
  for (Eigen::Index i = 0; i < count; ++i) {
    signals.name.push_back(count == 1 ? name : name + "@" + std::to_string(i + 1));
    signals.dims.push_back(dims);
  }
  return signals;
}

/// Opens the loop: the inserted signal d = u replaces the returned signal c = C x + D d, and y = -c. Direct feedthrough
/// would be an algebraic loop, which no system has: the diagonal of D is round-off. Below the diagonal a lifted loop
/// contains the returned earlier values of the same period: C and D by forward substitution.
void open_cut(LinearModel& model, const std::string& name) {
  const VectorXd back = 1 + model.D.diagonal().array();
  const MatrixXd below = back.cwiseInverse().asDiagonal() * model.D;
  const auto unit = below.triangularView<Eigen::UnitLower>();
  const auto divide = [&back](const MatrixXd& m) -> MatrixXd { return m.array().colwise() / back.array(); };
  const MatrixXd B = unit.solve<Eigen::OnTheRight>(model.B).array().rowwise() / back.transpose().array();
  const MatrixXd C = unit.solve(divide(model.C)), D = unit.solve(divide(model.D));
  // The returned signal is subtracted from the rows that it drives; entries of the loop alone leave round-off.
  const MatrixXd taken = B * model.C, sum = model.A.cwiseAbs() + taken.cwiseAbs();
  model.A -= taken;
  model.A = (model.A.array().abs() > 1e-13 * sum.array()).select(model.A, 0.0);
  model.B = B;
  model.C = -C;
  model.D = -D;
  model.outputs.name = name_values(name, "", model.outputs.size()).name;
  for (auto& output : model.outputs.name) output += ":return";
}

/// Notes a point that is neither at rest nor in steady motion: u̇ is larger than the effect of small displacements.
void note_unsteady(Plant& plant, const VectorXd& u_dot, const MatrixXd& A_lower, const SourceLocation& at,
                   Diagnostics& diagnostics) {
  const int n = plant.num_dofs();
  VectorXd steps(n);
  for (int i = 0; i < n; ++i) steps[i] = plant.step(i);
  const VectorXd scale = A_lower.leftCols(n).cwiseAbs() * steps;
  for (int i = 0; i < n; ++i) {
    if (std::abs(u_dot[i]) <= 1e-6 * std::max(scale[i], 1e-6 * scale.maxCoeff())) continue;
    diagnostics.note(
        "linear.not-steady", at,
        "the operating point is not steady: " + plant.dof_name(i) + " accelerates by " + brief_text(u_dot[i]),
        "bough equilibrium finds a state of rest or of steady spin");
    return;
  }
}

/// Name of the first state below `num_rows`, or output, that depends on a state; empty: none does.
std::string find_reader(const LinearModel& model, int state, int num_rows) {
  for (int i = 0; i < num_rows; ++i)
    if (std::abs(model.A(i, state)) > 1e-9 * model.A.row(i).cwiseAbs().maxCoeff())
      return model.states.name[static_cast<size_t>(i)];
  for (Eigen::Index i = 0; i < model.C.rows(); ++i)
    if (std::abs(model.C(i, state)) > 1e-9 * model.C.row(i).cwiseAbs().maxCoeff())
      return model.outputs.name[static_cast<size_t>(i)];
  return "";
}

/// A motion under way may change its own linear model.
void check_constancy(Plant& plant, const OperatingPoint& point, const Jacobian& here, const LinearModel& model,
                     const SourceLocation& at, Diagnostics& diagnostics) {
  const int n = plant.num_dofs();
  int fastest = -1;
  double travel = 0;  // in steps
  for (int i = 0; i < n; ++i) {
    if (plant.is_mode(i) || std::abs(point.u[i]) / plant.step(i) <= travel) continue;
    fastest = i;
    travel = std::abs(point.u[i]) / plant.step(i);
  }
  if (fastest < 0) return;
  // Speeds at rest are round-off: a motion counts only if it moves the system within the slowest time constant.
  const auto poles = statespace::calc_poles(model.A, model.states.name);
  double slowest = 0;
  bool drifts = false;
  for (int i = poles.size() - 1; i >= 0; --i) {
    const double size = std::hypot(poles.real[i], poles.imag[i]);
    if (size > 1e-6 * std::hypot(poles.real[poles.size() - 1], poles.imag[poles.size() - 1]))
      slowest = size;
    else
      drifts = true;
  }
  if (travel < kAtRest * slowest) return;
  // A motion that dies out or turns back within the slowest time constant goes no farther.
  const double way = drifts ? kFarWay : std::min(kFarWay, travel / slowest);
  OperatingPoint later = point;
  VectorXd delta = VectorXd::Zero(n);
  for (int i = 0; i < n; ++i) {
    if (!plant.is_mode(i)) delta[i] = way * point.u[i] / travel;
  }
  MatrixXd there;
  try {
    later.q = plant.displace(point.q, delta);
    there = calc_jacobian(plant, later, 1).value;
  } catch (const ComputationError&) {
    return;  // a loop does not reach as far
  }
  const VectorXd scale = calc_row_scales(here.value, get_row_dims(plant));
  const MatrixXd moved = there - here.value;
  const double allowed = way < kFarWay ? 1e-3 : 1e-5;
  const auto warn = [&](const std::string& what, double change, const std::string& advice) {
    diagnostics.warning("linear.time-varying", at,
                        what + " along the motion, by " + brief_text(100 * change) + " % while " +
                            plant.dof_name(fastest) + " moves by " + brief_text(delta[fastest]) +
                            ": the model holds at this instant only",
                        advice);
  };
  const double change = calc_relative(moved.topRows(n), scale.head(n));
  if (change >= allowed)
    return warn("A changes", change, "its poles are not those of the motion; linearize at several times");
  const int first = n + plant.num_signal_states();  // of the path rows; their columns are n further
  for (int i = 0; i < plant.num_paths(); ++i) {
    const double path_change = calc_relative(moved.row(first + i), scale.segment(first + i, 1));
    if (path_change < allowed) continue;
    const std::string reader = find_reader(model, n + first + i, 2 * n + plant.num_signal_states());
    if (reader.empty()) continue;
    return warn("the row of path coordinate " + plant.state_name(plant.num_signal_states() + i) + " in A, on which " +
                    reader + " depends, changes",
                path_change, "linearize at several times, or leave out what depends on it");
  }
}

/// Names the functions with two slopes at the operating point, or what else makes the derivatives uncertain.
void warn_of_inaccurate(const Uncertainty& uncertainty, double difference, const SourceLocation& at,
                        Diagnostics& diagnostics) {
  const double worst = std::max(uncertainty.relative, difference);
  if (worst <= kInaccurate) return;
  std::string what = "entries of the linear model are uncertain by " + brief_text(worst) +
                     " relative to their row, expected below " + brief_text(kInaccurate);
  for (std::size_t i = 0; i < uncertainty.kinks.size() && i < kMaxKinks; ++i) {
    const LawKink& kink = uncertainty.kinks[i];
    what += std::string(i == 0 ? ": " : ", ") + kink.label + " has a kink at " + brief_text(kink.at) + ", with slope " +
            brief_text(kink.slope_below) + " below and " + brief_text(kink.slope_above) + " above";
  }
  if (uncertainty.kinks.size() > kMaxKinks)
    what += " and " + std::to_string(uncertainty.kinks.size() - kMaxKinks) + " more";
  diagnostics.warning("linear.inaccurate", at, what,
                      uncertainty.kinks.empty()
                          ? "the motion has a kink or a jump near this state: linearize next to it"
                          : "the model has the mean of both slopes: linearize on one side, or use a smooth law");
}

/// Warns of ill-conditioned poles: soft poles follow from small differences of the largest entries of A.
void warn_of_uncertain(const records::Poles& poles, const SourceLocation& at, Diagnostics& diagnostics) {
  constexpr double kUncertain = 1e-4;
  int number = 0, worst = 0;
  double max_value = 0, least_known = std::numeric_limits<double>::infinity();
  const auto calc_size = [&](int i) { return std::hypot(poles.real[i], poles.imag[i]); };
  for (int i = 0; i < poles.size(); ++i)
    if (calc_size(i) > records::calc_origin_radius(poles, i)) least_known = std::min(least_known, calc_size(i));
  for (int i = 0; i < poles.size(); ++i) {
    const double size = calc_size(i);
    if (size == 0 || !(poles.error[i] > kUncertain * size)) continue;
    // Zero within its error, as of free motion, and far below all others.
    if (size <= records::calc_origin_radius(poles, i) && poles.error[i] <= kUncertain * least_known) continue;
    ++number;
    if (poles.error[i] > max_value * size) max_value = poles.error[i] / size, worst = i;
  }
  if (number == 0) return;
  diagnostics.warning("linear.uncertain-poles", at,
                      std::to_string(number) + (number == 1 ? " pole is" : " poles are") +
                          " known to less than four digits, worst of all number " + std::to_string(worst + 1) + " (" +
                          poles.mode[static_cast<std::size_t>(worst)] + "), to " + brief_text(100 * max_value) + " %",
                      "they are soft next to the stiffest, or nearly multiple: lock or leave out what is stiffest");
}

}  // namespace

LinearModel linearize(Plant& plant, const OperatingPoint& point, const LinearizeOptions& options,
                      const SourceLocation& at, Diagnostics& diagnostics) {
  const int n = plant.num_dofs();
  const Ports ports = choose_ports(plant, options, at, diagnostics);
  const std::vector<int>&inputs = ports.inputs, &outputs = ports.outputs;
  const auto& known = plant.outputs();

  LinearModel model;
  for (const char* suffix : {"", "_dot"}) {
    for (int i = 0; i < n; ++i) {
      model.states.name.push_back(plant.dof_name(i) + suffix);
      model.states.dims.push_back(*suffix ? plant.dof_dims(i) + "/T" : plant.dof_dims(i));
    }
  }
  const int nz = plant.num_states(), nx = 2 * n + nz;
  for (int i = 0; i < nz; ++i) {
    model.states.name.push_back(plant.state_name(i));
    model.states.dims.push_back(plant.state_dims(i));
  }
  const PlantInput* const cut = options.cut.empty() ? nullptr : &plant.inputs()[static_cast<size_t>(inputs.front())];
  const bool is_held = cut != nullptr && plant.find_hold(*cut).period > 0;
  if (const auto sampled = plant.list_sampled(); !sampled.empty() && !is_held) {
    std::string list;
    for (const auto& name : sampled) list += (list.empty() ? "" : ", ") + name;
    diagnostics.warning(
        "linear.sampled", at, "sampled in time, and held as they are in the linear model: " + list,
        "its poles are those with the loop open there; the multipliers of a period of the samples have it closed");
  }
  model.time = point.t;
  model.q = plant.get_for_file(point.q);
  model.q_names = plant.name_positions();
  model.u = point.u;
  for (int i = 0; i < n; ++i) {
    model.u_names.name.push_back(plant.dof_name(i));
    model.u_names.dims.push_back(plant.dof_dims(i) + "/T");
    if (plant.is_periodic(i)) model.periodic.push_back(plant.dof_name(i));
  }
  const VectorXd base = plant.evaluate(point);
  const VectorXd unsteady = plant.calc_unsteadiness(base);
  model.residual = unsteady.norm();

  Uncertainty uncertainty;
  const Jacobian jacobian = calc_jacobian(plant, point, 1);
  model.A = MatrixXd::Zero(nx, nx);
  model.A.block(0, n, n, n).setIdentity();
  model.A.bottomRows(n + nz) = jacobian.value.topRows(n + nz);
  const MatrixXd turning = plant.calc_turning(point);
  const int paths = plant.num_paths();
  model.A.topLeftCorner(n, n) = turning.topLeftCorner(n, n);
  model.A.topRightCorner(n, paths) = turning.topRightCorner(n, paths);
  model.A.bottomLeftCorner(paths, n) += turning.bottomLeftCorner(paths, n);
  model.A.bottomRightCorner(paths, paths) += turning.bottomRightCorner(paths, paths);
  model.C = take_rows(jacobian.value, n + nz, outputs);
  if (options.check) model.mass = plant.calc_mass(point);

  const auto num_inputs = static_cast<Eigen::Index>(inputs.size());
  model.B = MatrixXd::Zero(nx, num_inputs);
  model.D = MatrixXd::Zero(static_cast<Eigen::Index>(outputs.size()), num_inputs);
  for (Eigen::Index k = 0; k < num_inputs; ++k) {
    const PlantInput& input = plant.inputs()[static_cast<size_t>(inputs[static_cast<size_t>(k)])];
    model.inputs.name.push_back(input.name);
    model.inputs.dims.push_back(input.dims);
    const VectorXd column = calc_input_column(plant, point, input, base, uncertainty);
    model.B.col(k).tail(n + nz) = column.head(n + nz);
    model.D.col(k) = take_rows(column, n + nz, outputs);
  }
  for (const int i : outputs) {
    model.outputs.name.push_back(known.name[static_cast<size_t>(i)]);
    model.outputs.dims.push_back(known.dims[static_cast<size_t>(i)]);
  }

  note_unsteady(plant, unsteady, jacobian.value.topRows(n), at, diagnostics);
  std::vector<int> rows(static_cast<size_t>(n + nz));
  std::iota(rows.begin(), rows.end(), 0);
  for (const int i : outputs) rows.push_back(n + nz + i);
  const VectorXd scale = calc_row_scales(jacobian.value, get_row_dims(plant))(rows);
  Jacobian chosen;
  chosen.value = take_rows(jacobian.value, 0, rows);
  chosen.error = take_rows(jacobian.error, 0, rows);
  chosen.kink = take_rows(jacobian.kink, 0, rows);
  if (!chosen.kink.isZero(0)) chosen.kinks = jacobian.kinks;
  uncertainty.add(chosen, scale);
  if (options.check) {
    const Jacobian other = calc_jacobian(plant, point, kOtherStep);
    model.difference = calc_relative(take_rows(other.value - jacobian.value, 0, rows), scale);
    check_constancy(plant, point, jacobian, model, at, diagnostics);
  }
  if (options.check && options.cut.empty() && !plant.is_open())
    model.multipliers = calc_multipliers(plant, point, model.A, at, diagnostics, uncertainty);
  if (!options.cut.empty() && model.B.isZero(0) && model.D.isZero(0) && plant.list_sampled().empty())
    diagnostics.warning("linear.nothing-cut", at, "nothing reads '" + options.cut + "': the open loop there is 0",
                        "cut it where the motion depends on it, at an actuator or at what a controller reads");
  if (is_held) {
    const auto loop = calc_sampled_loop(plant, point, *cut, model.A, model.B.col(0), at, uncertainty);
    model.sample_time = loop.sample_time;
    model.aliased = find_aliased(statespace::calc_poles(model.A, model.states.name), loop.sample_time);
    model.states = loop.states;
    std::tie(model.A, model.B, model.C, model.D) = std::tie(loop.A, loop.B, loop.C, loop.D);
    model.inputs = name_values(model.inputs.name.front(), model.inputs.dims.front(), model.B.cols());
    model.outputs = name_values(model.outputs.name.front(), model.outputs.dims.front(), model.C.rows());
  }
  model.error = uncertainty.relative;
  warn_of_inaccurate(uncertainty, model.difference, at, diagnostics);
  if (!options.cut.empty()) open_cut(model, options.cut);
  if (is_held) {
    model.poles = calc_sampled_poles(model);
    return model;
  }
  if (options.check) model.hankel = statespace::calc_hankel(model.A, model.B, model.C);
  MatrixXd error = MatrixXd::Zero(nx, nx);
  error.bottomRows(n + nz) = (jacobian.value.array() != 0).select(jacobian.error.array(), 0.0).topRows(n + nz);
  model.poles = statespace::calc_poles(model.A, model.states.name, error);
  if (options.check) warn_of_uncertain(model.poles, at, diagnostics);
  if (num_inputs == static_cast<Eigen::Index>(outputs.size()) && num_inputs > 0) {
    const Eigen::VectorXcd zeros = statespace::calc_zeros(model.A, model.B, model.C, model.D);
    model.has_zeros = true;
    model.zeros_real = zeros.real();
    model.zeros_imag = zeros.imag();
  }
  return model;
}

void warn_of_latches(const System& system, const SourceLocation& at, Diagnostics& diagnostics) {
  std::string list;
  for (const JointContact& contact : system.joint_contacts) list += (list.empty() ? "" : ", ") + contact.name;
  if (list.empty()) return;
  diagnostics.warning("linear.latches-left-out", at, "dry friction and rigid stops are left out: " + list,
                      "give friction a smoothing and stops a stiffness, or lock what rests");
}

}  // namespace bough::solver
