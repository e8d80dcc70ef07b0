#pragma once
/// \file Tangents of the small nonlinear functions of a system: tables, limits, contacts, friction, formulas.
///
/// Linear models are differences of the equations of motion. A difference step suits the geometry (0.1 rad, 5 % of the
/// size of the bodies), not a function with limits, points of a table or a depth of penetration far below it. Each
/// function is therefore replaced by its tangent at the operating point, y0 + G (x - x0), while the rest is
/// differentiated: by the chain rule the derivative is the same, G is exact, and no step passes a kink.
#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "solver/state/dual.hpp"

namespace bough::solver {

/// Whose function it is; a name for messages: noun 'name', or the name alone if it is a label.
struct LawOwner {
  const void* key;
  const char* noun;
  const std::string& name;
};

/// A function with two slopes at the operating point.
struct LawKink {
  std::string label;                        ///< "controller 'law'"
  double at = 0;                            ///< of the input x
  double slope_below = 0, slope_above = 0;  ///< of the output that differs most
};

class LawTangents {
 public:
  /// The derivative of a function along +1 or -1 times input i, at x: y and dy/dx_i, from that side.
  using Slope = std::function<void(const double* x, int i, int direction, double* slope)>;

  /// From now on functions are evaluated, and their tangents taken.
  void record();
  /// From now on functions are their tangents; call it before each evaluation of the system.
  /// \param side  at a kink the slope above (1), below (-1), or the mean of both (0)
  void replay(int side);
  /// From now on functions are evaluated.
  void stop() { mode_ = Mode::Off; }
  /// Kinks of the functions whose inputs have moved since record().
  std::vector<LawKink> list_kinks() const;

  /// One evaluation of the function `slot` of `owner`: y from x.
  /// \param reach  of each input, the size of the terms that roundoff of x comes from, 0 for x itself; nullptr: the
  ///     slopes find kinks nearby themselves
  void evaluate(const LawOwner& owner, int slot, const std::vector<double>& x, const double* reach, int num_y,
                const std::function<void(const double* x, double* y)>& law, const Slope& slope, double* y);

 private:
  enum class Mode { Off, Record, Replay };
  struct Entry {
    std::string label;
    Eigen::VectorXd x, y;
    Eigen::MatrixXd slope;  ///< num_y x num_x, the mean at a kink
    Eigen::MatrixXd bend;   ///< slope above - slope below
    std::vector<char> has_moved;
  };
  struct Law {
    std::vector<Entry> entries;  ///< one for each evaluation within an evaluation of the system
    std::size_t next = 0;
  };
  static void take(Entry& entry, const double* reach, const Slope& slope);

  Mode mode_ = Mode::Off;
  int side_ = 0;
  std::map<std::pair<const void*, int>, Law> laws_;
};

/// y(x) of a function that is a template of its number type, double or Dual; its tangent if a linear model is made.
/// \param law  std::array<T, M> law(const std::array<T, N>& x)
template <std::size_t M, std::size_t N, class Law>
std::array<double, M> evaluate_law(LawTangents* tangents, const LawOwner& owner, int slot,
                                   const std::array<double, N>& x, const Law& law,
                                   const std::array<double, N>& reach = {}) {
  if (tangents == nullptr) return law(x);
  const auto value = [&](const double* at, double* to) {
    std::array<double, N> in;
    std::copy_n(at, N, in.begin());
    const std::array<double, M> out = law(in);
    std::copy_n(out.begin(), M, to);
  };
  const auto slope = [&](const double* at, int i, int direction, double* to) {
    std::array<Dual, N> in;
    for (std::size_t k = 0; k < N; ++k) in[k] = Dual(at[k], static_cast<int>(k) == i ? direction : 0);
    const std::array<Dual, M> out = law(in);
    for (std::size_t k = 0; k < M; ++k) to[k] = direction * out[k].dx;
  };
  std::array<double, M> y;
  tangents->evaluate(owner, slot, {x.begin(), x.end()}, reach.data(), static_cast<int>(M), value, slope, y.data());
  return y;
}

/// Evaluates a function with one input and one output: T law(T x).
template <class Law>
double evaluate_scalar_law(LawTangents* tangents, const LawOwner& owner, int slot, double x, const Law& law) {
  if (tangents == nullptr) return law(x);
  return evaluate_law<1, 1>(tangents, owner, slot, {x}, [&](const auto& in) { return std::array{law(in[0])}; })[0];
}

/// Evaluates a function for doubles only (formulas, libraries of users): its slopes by differences.
void evaluate_black_box(LawTangents* tangents, const LawOwner& owner, int slot, const std::vector<double>& x, int num_y,
                        const std::function<void(const double* x, double* y)>& law, double* y);

}  // namespace bough::solver
