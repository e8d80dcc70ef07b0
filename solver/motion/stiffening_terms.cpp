#include "solver/motion/stiffening_terms.hpp"

#include <algorithm>

namespace bough::solver {

StiffeningTerms StiffeningTerms::collect(const records::SystemSpec& spec, const Tree& tree, const Loops& loops,
                                         const std::vector<AppliedForce>& forces, const records::FlexBody& flex, int b,
                                         bool constraints) {
  const int n = tree[b].num_modes();
  StiffeningTerms terms;
  terms.body_ = b;
  terms.n_ = n;
  for (size_t i = 0; i < terms.K1_.size(); ++i)
    if (flex.kg_inertial_computed[i] && flex.kg_inertial[i].size() > 0)
      terms.K1_[i] = flex.kg_inertial[i].topLeftCorner(n, n);
  const auto get_K2 = [&](size_t e) -> MatrixXd { return flex.kg_external[e].topLeftCorner(n, n); };
  const auto& nodes = tree[b].body.nodes();
  for (const auto& source : list_node_sources(tree, loops, forces, b)) {
    if (source.constraint >= 0 && !constraints) continue;
    Source own{source};
    bool has_any = false;
    for (int d = 1; d <= 6; ++d) {
      const int e = flex.find_locator(nodes[static_cast<size_t>(source.node)].id, d);
      if (e < 0 || static_cast<size_t>(e) >= flex.kg_external.size()) continue;
      own.K2[static_cast<size_t>(d) - 1] = get_K2(static_cast<size_t>(e));
      has_any = true;
    }
    if (has_any) terms.sources_.push_back(std::move(own));
  }
  for (const AppliedForce& force : forces) {
    if (force.body != b || force.pattern.size() == 0) continue;
    for (const auto& r : spec.forces) {
      if (r.name != force.name) continue;
      for (size_t e = 0; e < flex.locators.size() && e < flex.kg_external.size(); ++e) {
        if (flex.locators[e].name != r.locator) continue;
        Source own{{0, -1, -1, false, &force}};
        own.K2[0] = get_K2(e);
        terms.sources_.push_back(std::move(own));
        break;
      }
    }
  }
  return terms;
}

bool StiffeningTerms::has_hinges() const {
  return std::any_of(sources_.begin(), sources_.end(), [](const auto& s) { return s.source.hinge >= 0; });
}

void StiffeningTerms::calc_loads(const Motion& motion, double* y) const {
  const TreeData& data = motion.data;
  Eigen::Map<Eigen::Matrix<double, 12, 1>>{y} = motion.gravity.calc_inertial_acceleration(data, body_);
  for (size_t i = 0; i < sources_.size(); ++i) {
    Eigen::Map<Vector6d> load(y + 12 + 6 * i);
    const AppliedForce* f = sources_[i].source.force;
    if (f != nullptr && f->pattern.size() > 0) {
      load << (f->function ? data.functions[*f->function].calc(data.t).f : 1.0), 0, 0, 0, 0, 0;
    } else {
      load = calc_node_load(sources_[i].source, body_, motion);
    }
  }
}

void StiffeningTerms::add_modal_force(const double* y, const ConstVectorRef& eta, Eigen::Ref<VectorXd> modal) const {
  for (size_t i = 0; i < K1_.size(); ++i)
    if (K1_[i].size() > 0 && y[i] != 0) modal.noalias() -= y[i] * (K1_[i] * eta);
  for (size_t i = 0; i < sources_.size(); ++i) {
    for (size_t c = 0; c < 6; ++c) {
      const double value = y[12 + 6 * i + c];
      const MatrixXd& K = sources_[i].K2[c];
      if (K.size() > 0 && value != 0) modal.noalias() -= value * (K * eta);
    }
  }
}

MatrixXd StiffeningTerms::calc_stiffness(const double* y) const {
  MatrixXd K = MatrixXd::Zero(n_, n_);
  for (int j = 0; j < n_; ++j) {
    const VectorXd unit = -VectorXd::Unit(n_, j);
    add_modal_force(y, unit, K.col(j));
  }
  return 0.5 * (K + K.transpose());
}

}  // namespace bough::solver
