#include "solver/motion/recovery.hpp"

#include <algorithm>
#include <set>

#include "solver/motion/node_load.hpp"

namespace bough::solver {

struct Recovery::Loaded {
  NodeSource source;
  std::array<int, 6> locator{-1, -1, -1, -1, -1, -1};  ///< column of external_, -1: none
};

Recovery::Recovery(const records::FlexBody& flex, int body, bool is_third_order) : body_(body) {
  Eigen::Index rows = 0;
  for (const auto& block : flex.recovery) rows += block.num_rows();
  matrix_.resize(rows, flex.num_modes());
  inertial_.resize(rows, records::kNumInertialLoads);
  external_.resize(rows, static_cast<Eigen::Index>(flex.locators.size()));
  offset_.resize(rows);
  if (flex.preload_A_I.size() > 0) preload_ = flex.preload_A_I;
  int first = 0;
  for (const auto& block : flex.recovery) {
    const auto count = block.num_rows();
    matrix_.middleRows(first, count) = block.matrix;
    inertial_.middleRows(first, count) = block.inertial;
    external_.middleRows(first, count) = block.external;
    offset_.segment(first, count) = block.offset;
    for (const int id : block.id) {
      elements_.push_back({block.name + "/" + std::to_string(id), id, first, block.components, false});
      first += elements_.back().size();
    }
  }
  if (is_third_order &&
      std::any_of(flex.recovery.begin(), flex.recovery.end(), [](const auto& block) { return block.has_beyond(); }))
    add_products(flex);
}

Recovery::~Recovery() = default;

void Recovery::add_products(const records::FlexBody& flex) {
  using records::ThirdOrder;
  const int n = flex.num_modes();
  large_ = LargeAmplitudes(flex.third_order);
  // Large amplitudes are modes, or directions, numbered after all modes.
  const auto find_amplitude = [&](int j) {
    return large_.directions.size() > 0 ? n + j : large_.modes[static_cast<size_t>(j)];
  };
  for (int k = ThirdOrder::kMinField; k <= ThirdOrder::kMaxField; ++k) {
    const auto exponents = records::list_exponents(flex.third_order.num_variables(k, n), k);
    for (Eigen::Index i = 0; i < exponents.rows(); ++i) {
      Product product;
      int factors = 0;
      for (int j = 0; j < exponents.cols(); ++j)
        for (int e = 0; e < exponents(i, j); ++e)
          product.modes[static_cast<size_t>(factors++)] = k == 2 ? j : find_amplitude(j);
      product.rows = VectorXd::Zero(matrix_.rows());
      Eigen::Index first = 0;
      for (const auto& block : flex.recovery) {
        const auto count = block.num_rows();
        if (block.has_beyond())
          product.rows.segment(first, count) = block.beyond[static_cast<size_t>(k - ThirdOrder::kMinField)].col(i);
        first += count;
      }
      products_.push_back(std::move(product));
    }
  }
}

const Recovery::Element* Recovery::find(int id) const {
  const auto found = std::find_if(elements_.begin(), elements_.end(), [&](const auto& e) { return e.id == id; });
  return found == elements_.end() ? nullptr : &*found;
}

void Recovery::record(int id) {
  for (auto& element : elements_)
    if (element.id == id) element.is_recorded = true;
}

std::vector<int> Recovery::connect(const Tree& tree, const Loops& loops, const std::vector<AppliedForce>& forces,
                                   const records::FlexBody& flex, const std::vector<records::ForceRecord>& records) {
  const auto& nodes = tree[body_].body.nodes();
  std::set<int> unknown;
  for (const auto& source : list_node_sources(tree, loops, forces, body_)) {
    const auto& node = nodes[static_cast<size_t>(source.node)];
    Loaded loaded;
    loaded.source = source;
    for (int d = 1; d <= 6; ++d) loaded.locator[static_cast<size_t>(d) - 1] = flex.find_locator(node.id, d);
    if (std::all_of(loaded.locator.begin(), loaded.locator.end(), [](int e) { return e < 0; })) {
      if (node.moves) unknown.insert(node.id);
      continue;
    }
    loaded_.push_back(loaded);
  }
  for (const auto& force : forces) {
    if (force.body != body_ || force.pattern.size() == 0) continue;
    for (const auto& record : records)
      for (size_t e = 0; record.name == force.name && e < flex.locators.size(); ++e)
        if (flex.locators[e].name == record.locator)
          patterns_.push_back({&force, external_.col(static_cast<Eigen::Index>(e))});
  }
  return {unknown.begin(), unknown.end()};
}

void Recovery::calc(const Motion& motion, int first, int count, double* out) const {
  const Tree& tree = motion.tree;
  const TreeData& data = motion.data;
  const Eigen::Matrix<double, 12, 1> A_I = motion.gravity.calc_inertial_acceleration(data, body_) - preload_;
  Eigen::Map<VectorXd> rows(out, count);
  rows = offset_.segment(first, count);
  rows.noalias() += matrix_.middleRows(first, count) * data.q.segment(tree[body_].eta_offset(), matrix_.cols());
  const auto n = matrix_.cols();
  const auto eta = data.q.segment(tree[body_].eta_offset(), n);
  double large[records::kMaxLargeModes];
  if (large_.directions.size() > 0) large_.get(eta, large);
  for (const auto& product : products_) {
    double value = 1;
    for (const int mode : product.modes)
      if (mode >= 0) value *= mode < n ? eta[mode] : large[mode - n];
    rows += value * product.rows.segment(first, count);
  }
  rows.noalias() += inertial_.middleRows(first, count) * A_I;
  for (const auto& loaded : loaded_) {
    const Vector6d load = calc_node_load(loaded.source, body_, motion);
    for (int d = 0; d < 6; ++d)
      if (const int e = loaded.locator[static_cast<size_t>(d)]; e >= 0)
        rows += load[d] * external_.col(e).segment(first, count);
  }
  for (const auto& pattern : patterns_) {
    const auto* f = pattern.force->function;
    rows += (f ? data.functions[*f].calc(data.t).f : 1.0) * pattern.rows.segment(first, count);
  }
}

}  // namespace bough::solver
