#include "modal/compare/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/rotation.hpp"

namespace bough::modal {

using Eigen::Index;
using Eigen::Matrix3d;
using records::FlexBody;
using records::MassIntegrals;

namespace {

/// Columns of the chosen modes, scaled.
struct Choice {
  std::vector<int> modes;
  VectorXd scale;

  MatrixXd project(const MatrixXd& K) const {
    return scale.asDiagonal() * MatrixXd(K(modes, modes)) * scale.asDiagonal();
  }
  MassIntegrals choose(const MassIntegrals& set) const {
    MassIntegrals g;
    if (set.empty()) return g;
    g.gamma0 = set.gamma0(Eigen::all, modes) * scale.asDiagonal();
    g.gamma1 = set.gamma1(Eigen::all, modes) * scale.asDiagonal();
    for (std::size_t i = 0; i < modes.size(); ++i) {
      const auto j = static_cast<std::size_t>(modes[i]);
      const double s = scale[static_cast<Index>(i)];
      g.gamma2.push_back(s * set.gamma2[j](Eigen::all, modes) * scale.asDiagonal());
      g.gamma3.push_back(s * set.gamma3[j]);
      g.gamma4.emplace_back();
      for (std::size_t k = 0; k < modes.size(); ++k)
        g.gamma4.back().push_back(s * scale[static_cast<Index>(k)] * set.gamma4[j][static_cast<std::size_t>(modes[k])]);
    }
    return g;
  }
};

/// Shifts the integrals to a new origin, from which every position p is p + d.
void shift(MassIntegrals& set, const Vector3d& d) {
  for (std::size_t j = 0; j < set.gamma3.size(); ++j) {
    const Vector3d g0 = set.gamma0.col(static_cast<Index>(j));
    set.gamma1.col(static_cast<Index>(j)) += d.cross(g0);
    set.gamma3[j] += d.dot(g0) * Matrix3d::Identity() - g0 * d.transpose();
  }
}

FlexBody choose(const FlexBody& body, const Choice& choice) {
  FlexBody chosen;
  chosen.name = body.name;
  chosen.mass = body.mass;
  chosen.cg = body.cg;
  chosen.inertia = body.inertia;
  chosen.eigenvalue = body.eigenvalue(choice.modes);
  chosen.frequency_hz = body.frequency_hz(choice.modes);
  chosen.modal_mass = choice.project(body.modal_mass);
  chosen.lumped = choice.choose(body.lumped);
  chosen.consistent = choice.choose(body.consistent);
  chosen.exact = choice.choose(body.exact);
  chosen.integrals_method = body.integrals_method;
  chosen.kg_inertial_computed = body.kg_inertial_computed;
  for (std::size_t i = 0; i < body.kg_inertial.size(); ++i)
    if (body.kg_inertial_computed[i]) chosen.kg_inertial[i] = choice.project(body.kg_inertial[i]);
  chosen.locators = body.locators;
  for (const auto& K : body.kg_external) chosen.kg_external.push_back(choice.project(K));
  return chosen;
}

StiffnessDifference compare(const std::string& load, const MatrixXd& a, const MatrixXd& b) {
  StiffnessDifference d{load, a.norm(), b.norm(), 0};
  const double larger = std::max(d.norm_a, d.norm_b);
  d.difference = larger > 0 ? (a - b).norm() / larger : std::numeric_limits<double>::quiet_NaN();
  return d;
}

/// Cosine between the same direction of two bodies, at least.
constexpr double kSameDirection = 0.999;

/// Coefficients of one degree by the exponents of other modes: mode of a paired with the mode of b, for each large
/// mode.
VectorXd permute(const VectorXd& of_b, int degree, const std::vector<int>& order) {
  const Eigen::MatrixXi exponents = records::list_exponents(static_cast<int>(order.size()), degree);
  VectorXd of_a(of_b.size());
  for (Index i = 0; i < exponents.rows(); ++i)
    for (Index k = 0; k < exponents.rows(); ++k)
      if (exponents.row(i) == exponents(k, order)) of_a[i] = of_b[k];
  return of_a;
}

std::string describe_order(const FlexBody& body) {
  if (body.third_order.empty()) return "second order";
  if (body.third_order.directions.size() > 0)
    return "third order (" + std::to_string(body.third_order.num_large()) + " large directions)";
  std::string text;
  for (const int mode : body.third_order.large) text += (text.empty() ? "" : ", ") + std::to_string(mode + 1);
  return "third order (large modes " + text + ")";
}

/// A large amplitude by those of all modes of `body` that have a pair, at unit strain energy and with the signs of the
/// first body: directions x pairs.
MatrixXd calc_paired_directions(const FlexBody& a, const FlexBody& body, const std::vector<ModePair>& pairs,
                                bool is_first) {
  const auto& third = body.third_order;
  MatrixXd rows(third.num_large(), static_cast<Index>(pairs.size()));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const int mode = is_first ? pairs[i].a : pairs[i].b;
    const double scale =
        (is_first ? 1 : pairs[i].sign) / std::sqrt(a.eigenvalue[pairs[i].a] * body.modal_mass(mode, mode));
    for (Index f = 0; f < rows.rows(); ++f)
      rows(f, static_cast<Index>(i)) =
          scale * (third.directions.size() > 0 ? third.directions(f, mode)
                                               : (third.large[static_cast<std::size_t>(f)] == mode ? 1.0 : 0.0));
  }
  return rows;
}

/// Returns false if a large mode or direction of one body is none of the other.
bool compare_energies(const FlexBody& a, const FlexBody& b, const std::vector<ModePair>& pairs,
                      std::vector<StiffnessDifference>& differences) {
  const auto &x = a.third_order, &y = b.third_order;
  if (x.empty() && y.empty()) return true;
  if (x.num_large() != y.num_large()) return false;
  std::vector<int> order;  // place in b's large modes of each of a's
  VectorXd scale(x.num_large()), scale_b(x.num_large());
  const MatrixXd of_a = calc_paired_directions(a, a, pairs, true), of_b = calc_paired_directions(a, b, pairs, false);
  for (Index f = 0; f < of_a.rows(); ++f) {
    const VectorXd along = of_b.rowwise().normalized() * of_a.row(f).normalized().transpose();
    Index found = 0;
    if (!(along.cwiseAbs().maxCoeff(&found) > kSameDirection)) return false;
    scale[f] = of_a.row(f).norm();
    scale_b[f] = (along[found] < 0 ? -1 : 1) * of_b.row(found).norm();
    order.push_back(static_cast<int>(found));
  }
  const auto calc_scaled = [&](VectorXd c, int degree, const VectorXd& s) {
    const Eigen::MatrixXi exponents = records::list_exponents(x.num_large(), degree);
    for (Index i = 0; i < c.size(); ++i)
      for (Index j = 0; j < s.size(); ++j) c[i] *= std::pow(s[j], exponents(i, j));
    return c;
  };
  for (int k = records::ThirdOrder::kMinEnergy; k <= records::ThirdOrder::kMaxEnergy; ++k) {
    const auto at = static_cast<std::size_t>(k - records::ThirdOrder::kMinEnergy);
    differences.push_back(compare("degree " + std::to_string(k), calc_scaled(x.energy[at], k, scale),
                                  calc_scaled(permute(y.energy[at], k, order), k, scale_b)));
  }
  return true;
}

}  // namespace

bool can_move_gamma3(const Vector3d& offset) { return offset.isZero(0); }

FlexBody keep_paired(const FlexBody& a, const std::vector<ModePair>& pairs) {
  Choice choice;
  for (const auto& p : pairs) choice.modes.push_back(p.a);
  choice.scale = VectorXd::Ones(static_cast<Index>(pairs.size()));
  return choose(a, choice);
}

FlexBody align_body(const FlexBody& a, const FlexBody& b, const std::vector<ModePair>& pairs, const Vector3d& offset) {
  Choice choice;
  choice.scale.resize(static_cast<Index>(pairs.size()));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& p = pairs[i];
    choice.modes.push_back(p.b);
    choice.scale[static_cast<Index>(i)] = p.sign * std::sqrt(a.modal_mass(p.a, p.a) / b.modal_mass(p.b, p.b));
  }
  FlexBody aligned = choose(b, choice);
  for (auto* set : {&aligned.lumped, &aligned.consistent, &aligned.exact}) shift(*set, -offset);
  const Vector3d c = b.cg - offset;
  const Matrix3d central = b.inertia + b.mass * skew(b.cg) * skew(b.cg);
  aligned.cg = c;
  aligned.inertia = central - b.mass * skew(c) * skew(c);
  return aligned;
}

BodyComparison compare_bodies(const FlexBody& a, const FlexBody& b, const std::vector<ModePair>& pairs,
                              const Vector3d& offset) {
  static constexpr const char* kLoads[] = {"ax",  "ay",  "az",  "alx",  "aly",  "alz",
                                           "wx2", "wy2", "wz2", "wxwy", "wxwz", "wywz"};
  const FlexBody x = keep_paired(a, pairs), y = align_body(a, b, pairs, offset);
  BodyComparison result;
  const MatrixXd scale = calc_integral_scale(x);
  for (int m = 0; m < kNumMethods; ++m) {
    const auto &of_x = get_method(x, m), &of_y = get_method(y, m);
    const auto s = static_cast<std::size_t>(m);
    result.has[s] = !of_x.empty() && !of_y.empty() && !pairs.empty();
    if (!result.has[s]) continue;
    result.norm_a[s] = calc_integral_norms(of_x);
    result.norm_b[s] = calc_integral_norms(of_y);
    result.difference[s] = calc_integral_differences(of_x, of_y, scale);
  }
  constexpr std::size_t kExact = 2;
  if (result.has[kExact] && !can_move_gamma3(offset)) {
    result.difference[kExact].col(3).setConstant(std::numeric_limits<double>::quiet_NaN());
    result.norm_b[kExact].col(3).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  if (pairs.empty()) return result;
  if (!compare_energies(a, b, pairs, result.energy))
    result.energy_note = "A has " + describe_order(a) + ", B " + describe_order(b) +
                         ": strain energies beyond degree 2 are not compared";
  // Angular accelerations and rates turn about the origin: with another one only accelerations can be compared.
  const std::size_t count = offset.isZero(0) ? x.kg_inertial.size() : 3;
  for (std::size_t i = 0; i < count; ++i)
    if (x.kg_inertial_computed[i] && y.kg_inertial_computed[i])
      result.stiffness.push_back(compare(kLoads[i], x.kg_inertial[i], y.kg_inertial[i]));
  for (std::size_t e = 0; e < x.locators.size(); ++e)
    for (std::size_t f = 0; f < y.locators.size(); ++f)
      if (x.locators[e].name == y.locators[f].name) {
        result.stiffness.push_back(compare(x.locators[e].name, x.kg_external[e], y.kg_external[f]));
        break;
      }
  return result;
}

}  // namespace bough::modal
