#pragma once
/// \file A spring, damper and actuator between two points A and B at the distance l.
///
/// T = preload + k (l - l0) + table(l) + c l̇ + table(l̇) + f(t): tension pulls A and B together. One that acts
/// in tension only is slack where T without dampers is negative and never pushes; in compression only likewise.
#include "solver/forces/element.hpp"
#include "solver/functions/curve.hpp"

namespace bough::solver {

class SpringElement final : public ForceElement {
 public:
  struct Law {
    double stiffness = 0, damping = 0, free_length = 0, preload = 0;
    records::SpringSense sense = records::SpringSense::Both;
    std::unique_ptr<const Curve> spring, damper;
    const TimeFunction* function = nullptr;
  };
  /// \param from  marker A. \param to  marker B.
  SpringElement(std::string name, int from, int to, Law law)
      : ForceElement(std::move(name)), from_(from), to_(to), law_(std::move(law)) {}

  ForceResult calc(const Tree& tree, const TreeData& data, Loads* loads) const override;
  int num_kinks() const override { return law_.sense != records::SpringSense::Both && law_.stiffness > 0 ? 1 : 0; }
  void calc_kinks(const Tree& tree, const TreeData& data, double* g) const override {
    if (num_kinks() > 0)
      g[0] = law_.preload + law_.stiffness * (calc(tree, data, nullptr).values[0] - law_.free_length);
  }
  const TimeFunction* function() const override { return law_.function; }
  std::vector<ForceChannel> channels() const override;

 private:
  /// [elastic, damper] at [length, rate], positive in tension; of doubles the strain energy too.
  template <class T>
  std::array<T, 2> calc_tension(const std::array<T, 2>& at, double& stored) const;

  int from_, to_;  ///< markers
  Law law_;
};

}  // namespace bough::solver
