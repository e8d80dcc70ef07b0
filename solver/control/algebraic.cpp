// Controllers without states: product, limit, table.
#include <algorithm>

#include "solver/control/makers.hpp"

namespace bough::solver {
namespace {

class Product final : public Block {
 public:
  int groups = 0;
  double gain = 1;
  void calc_outputs(const BlockInput& in, double* y) const override {
    for (int i = 0; i < sizes.outputs; ++i) {
      y[i] = gain;
      for (int g = 0; g < groups; ++g) y[i] *= in.u[g * sizes.outputs + i];
    }
  }
};

class Limit final : public Block {
 public:
  VectorXd low, high, band;
  void calc_outputs(const BlockInput& in, double* y) const override {
    for (int i = 0; i < sizes.outputs; ++i) {
      y[i] = evaluate_scalar_law(in.tangents, as_owner(), i, in.u[i], [&]<class T>(T u) {
        u = u > T(band[i]) ? u - band[i] : u < T(-band[i]) ? u + band[i] : T(0);
        return std::clamp(u, T(low[i]), T(high[i]));
      });
    }
  }
};

/// Linear between the points, the end values outside; share: where in its interval.
template <class T>
size_t find_interval(const std::vector<double>& x, T at, T& share) {
  const auto above = std::upper_bound(x.begin(), x.end(), at, [](T a, double b) { return a < T(b); });
  const auto i = static_cast<size_t>(
      std::clamp<std::ptrdiff_t>(above - x.begin() - 1, 0, static_cast<std::ptrdiff_t>(x.size()) - 2));
  share = std::clamp((at - x[i]) / (x[i + 1] - x[i]), T(0.0), T(1.0));
  return i;
}

class Table1 final : public Block {
 public:
  std::vector<double> x, y;
  void calc_outputs(const BlockInput& in, double* out) const override {
    for (int c = 0; c < sizes.outputs; ++c) {
      out[c] = evaluate_scalar_law(in.tangents, as_owner(), c, in.u[c], [this]<class T>(T u) {
        T s = 0;
        const size_t i = find_interval(x, u, s);
        return y[i] + s * (y[i + 1] - y[i]);
      });
    }
  }
};

class Table2 final : public Block {
 public:
  std::vector<double> x1, x2;
  MatrixXd y;  ///< rows: x1
  void calc_outputs(const BlockInput& in, double* out) const override {
    out[0] =
        evaluate_law<1, 2>(in.tangents, as_owner(), 0, {in.u[0], in.u[1]}, [this]<class T>(const std::array<T, 2>& u) {
          T r = 0, s = 0;
          const auto i = static_cast<Eigen::Index>(find_interval(x1, u[0], r));
          const auto j = static_cast<Eigen::Index>(find_interval(x2, u[1], s));
          return std::array{(1 - r) * ((1 - s) * y(i, j) + s * y(i, j + 1)) +
                            r * ((1 - s) * y(i + 1, j) + s * y(i + 1, j + 1))};
        })[0];
  }
};

bool is_ascending(const std::vector<double>& x) {
  return x.size() >= 2 && std::adjacent_find(x.begin(), x.end(), std::greater_equal<>()) == x.end();
}

}  // namespace

std::unique_ptr<Block> make_product(SettingsReader& keys, const ControllerWiring& wiring) {
  auto made = std::make_unique<Product>();
  made->gain = keys.get("gain", 1);
  if (!wiring.are_alike())
    keys.error("control.bad-size", "multiplies inputs of different sizes", "name single components, as tip:x");
  made->groups = static_cast<int>(wiring.inputs.size());
  made->sizes.outputs = wiring.inputs.front();
  return made;
}

std::unique_ptr<Block> make_limit(SettingsReader& keys, const ControllerWiring& wiring) {
  auto made = std::make_unique<Limit>();
  const int n = made->sizes.outputs = wiring.size();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  made->low = keys.get_vector("lower", n, -kInfinite);
  made->high = keys.get_vector("upper", n, kInfinite);
  made->band = keys.get_vector("deadband", n, 0);
  keys.demand((made->low.array() < made->high.array()).all(), "has lower limits that are not below the upper ones",
              "give lower < upper");
  keys.demand((made->band.array() >= 0).all(), "has a negative deadband", "give half its width");
  return made;
}

std::unique_ptr<Block> make_table(SettingsReader& keys, const ControllerWiring& wiring) {
  if (keys.has("x2")) {
    auto made = std::make_unique<Table2>();
    made->x1 = keys.get_list("x");
    made->x2 = keys.get_list("x2");
    made->y = keys.get_matrix("y", static_cast<int>(made->x1.size()), static_cast<int>(made->x2.size()));
    keys.demand(is_ascending(made->x1) && is_ascending(made->x2), "has points that do not ascend",
                "give two at least, ascending");
    if (!keys.has("y")) keys.error("control.missing-key", "has no 'y'", "give a row for each x");
    if (wiring.size() != 2) keys.error("control.bad-size", "has two axes and not two inputs", "give two inputs");
    return made;
  }
  auto made = std::make_unique<Table1>();
  made->x = keys.get_list("x");
  made->y = keys.get_list("y");
  keys.demand(is_ascending(made->x), "has points that do not ascend", "give two at least, ascending");
  if (made->x.size() != made->y.size())
    keys.error("control.bad-size", "has not as many y as x", "give one y for each x");
  made->sizes.outputs = wiring.size();
  return made;
}

}  // namespace bough::solver
