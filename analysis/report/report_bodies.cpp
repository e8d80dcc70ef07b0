#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "analysis/common/body_files.hpp"
#include "analysis/report/report_files.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/records/mode_kind.hpp"
#include "modal/compare/integrals_check.hpp"
#include "modal/compare/shapes.hpp"
#include "modal/spin.hpp"
#include "report/html.hpp"
#include "report/modal_chapter.hpp"

namespace bough::analysis {

using report::Verdict;

namespace {

Eigen::MatrixXd calc_own_mac(const modal::ModalModel& model) {
  const auto match = modal::match_nodes(model, model);
  return match.pairs.empty() ? Eigen::MatrixXd() : modal::calc_mac(model, model, match);
}

void add_integrals(const records::FlexBody& body, report::ModalModel& m) {
  const auto check = modal::check_integrals(body);
  double worst = 0;
  for (std::size_t k = 0; k < modal::kNumMethods; ++k) {
    if (!check.has[k]) continue;
    m.integrals.method[k] = modal::kMethodNames[k];
    m.integrals.norm[k] = check.norm[k];
    m.integrals.difference[k] = check.difference[k];
    for (const double d : check.difference[k].reshaped())
      if (std::isfinite(d) && modal::kMethodNames[k] == body.integrals_method) worst = std::max(worst, d);
  }
  if (check.has[2]) {
    m.integrals.captured = check.captured[2].fraction;
    m.checks.push_back(
        {"largest difference of the " + body.integrals_method +
             " mass integrals, which the solver takes, from the exact ones",
         report::format_percent(worst) + " %", worst > 0.1 ? Verdict::Warning : Verdict::Good,
         "a coarse mesh, or masses off their grids, where it is large; the other sets are in the table"});
  }
}

/// Ranges of rates, their ends by halving the steps between the rates looked at.
std::vector<std::pair<double, double>> find_divergence(const records::FlexBody& body, int axis,
                                                       const modal::SpinFrequencies& spin) {
  const auto find_edge = [&](double from, double to, bool is_after) {
    for (int i = 0; i < 16; ++i) {
      const double middle = 0.5 * (from + to);
      const bool diverges =
          modal::calc_spin_frequencies(body, Eigen::Vector3d::Unit(axis), Eigen::VectorXd::Constant(1, middle))
              .diverges[0];
      (diverges == is_after ? to : from) = middle;
    }
    return is_after ? to : from;
  };
  std::vector<std::pair<double, double>> ranges;
  const auto n = spin.diverges.size();
  for (std::size_t r = 0; r < n; ++r) {
    const auto k = static_cast<Eigen::Index>(r);
    const bool was = r > 0 && spin.diverges[r - 1];
    if (spin.diverges[r] && !was) ranges.emplace_back(r > 0 ? find_edge(spin.rate[k - 1], spin.rate[k], true) : 0, 0);
    if (!spin.diverges[r] && was) ranges.back().second = find_edge(spin.rate[k - 1], spin.rate[k], false);
  }
  if (n > 0 && spin.diverges[n - 1]) ranges.back().second = spin.rate[spin.rate.size() - 1];
  return ranges;
}

void add_spin(const records::FlexBody& body, report::ModalModel& m) {
  if (body.num_modes() == 0 || body.integrals().empty()) return;
  double first = 0;
  for (const double lambda : body.eigenvalue)
    if (lambda > 1e-9 * body.eigenvalue.cwiseAbs().maxCoeff()) {
      first = std::sqrt(lambda);
      break;
    }
  if (first <= 0) return;
  const std::array<const char*, 3> names{"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    const auto spin =
        modal::calc_spin_frequencies(body, Eigen::Vector3d::Unit(axis), Eigen::VectorXd::LinSpaced(33, 0, 2 * first));
    report::SpinCurves curves{
        names[static_cast<std::size_t>(axis)], spin.rate,         spin.frequency_hz, spin.without_hz,
        find_divergence(body, axis, spin),     spin.has_stiffness};
    m.spin.push_back(std::move(curves));
  }
}

/// Largest relative asymmetry of the K_G, and whether K or M have negative eigenvalues.
void check_matrices(const records::FlexBody& body, report::ModalModel& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> mass(body.modal_mass, Eigen::EigenvaluesOnly),
      stiffness(body.modal_stiffness, Eigen::EigenvaluesOnly);
  if (body.num_modes() == 0) return;
  const double least_mass = mass.eigenvalues()[0] / mass.eigenvalues().maxCoeff();
  m.checks.push_back({"least eigenvalue of the modal mass to the largest", report::format_value(least_mass, 3),
                      least_mass > 0 ? Verdict::Good : Verdict::Bad, "positive"});
  const double min_eigenvalue =
      stiffness.eigenvalues()[0] / std::max(stiffness.eigenvalues().cwiseAbs().maxCoeff(), 1e-300);
  m.checks.push_back({"least eigenvalue of the modal stiffness to the largest", report::format_value(min_eigenvalue, 3),
                      min_eigenvalue > -1e-9 ? Verdict::Good : Verdict::Warning, "not negative"});
  const auto computed = std::count(body.kg_inertial_computed.begin(), body.kg_inertial_computed.end(), true);
  m.checks.push_back({"geometric stiffness K_G1", fmt::format("{} of 12", computed),
                      computed == 12 ? Verdict::Good
                      : computed > 0 ? Verdict::Warning
                                     : Verdict::Warning,
                      computed == 12 ? "" : "motions of the others stiffen nothing"});
}

}  // namespace

report::Chapter make_body_chapter(const std::string& file, Diagnostics& diagnostics) {
  const auto body = read_body(file, diagnostics);
  report::ModalModel m;
  m.kind = "flexible body";
  m.file = file;
  m.name = body.name;
  m.facts = list_facts(file);
  m.facts.emplace_back("modes", std::to_string(body.num_modes()));
  m.facts.emplace_back("output nodes", std::to_string(body.num_nodes()));
  m.facts.emplace_back("locators", std::to_string(body.locators.size()));
  if (!body.preload.empty()) m.facts.emplace_back("preload", body.preload);
  m.frame = "In the body frame B, about its origin Bo";
  m.mass = body.mass;
  m.cg = body.cg;
  m.inertia = body.inertia;
  m.frequency_hz = body.frequency_hz;
  m.modal_mass = body.modal_mass.diagonal();
  m.damping = Eigen::VectorXd::Zero(body.num_modes());
  for (Eigen::Index j = 0; j < m.damping.size(); ++j) {
    const double critical = 2 * std::sqrt(std::max(0.0, body.modal_mass(j, j) * body.modal_stiffness(j, j)));
    m.damping[j] = critical > 0 ? body.modal_damping(j, j) / critical : 0;
  }
  for (const auto kind : body.kind) m.mode_kind.push_back(records::get_name(kind));
  m.effective_mass = body.effective_mass;
  m.mac = calc_own_mac(modal::ModalModel::from(body));
  for (int k = 0; k < body.num_nodes(); ++k) {
    const int id = body.node_id[static_cast<std::size_t>(k)];
    const auto& interface = body.interface_nodes;
    m.nodes.push_back({id, body.node_xyz.row(k), std::find(interface.begin(), interface.end(), id) != interface.end()});
  }
  for (const auto& locator : body.locators)
    if (locator.direction == 0) m.loads.push_back(locator.name);
  check_matrices(body, m);
  add_integrals(body, m);
  add_spin(body, m);
  m.drawing = report::make_drawing(body);
  report::add_energies(body, m.drawing);
  return report::make_chapter(m);
}

report::Chapter make_modes_chapter(const std::string& file) {
  const auto modes = hdf5::read_modes(file);
  report::ModalModel m;
  m.is_buckling = modes.load_factor.size() > 0;
  m.kind = m.is_buckling ? "buckling" : "modes";
  m.file = file;
  m.facts = list_facts(file);
  m.facts.emplace_back("modes", std::to_string(modes.frequency_hz.size()));
  m.facts.emplace_back("nodes", std::to_string(modes.node_id.size()));
  m.frame = "In the basic system, about its origin";
  const auto& p = modes.mass_properties;
  m.mass = p.mass;
  m.cg = p.cg;
  // The file has it about its reference; effective masses are about the origin.
  const auto move = [&](const Eigen::Vector3d& d) {
    return Eigen::Matrix3d(p.mass * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose()));
  };
  m.inertia = p.inertia - move(p.cg - p.reference) + move(p.cg);
  m.frequency_hz = m.is_buckling ? modes.load_factor : modes.frequency_hz;
  m.modal_mass = modes.modal_mass;
  for (const auto kind : modes.kind) m.mode_kind.push_back(records::get_name(kind));
  m.residual = modes.residual;
  m.effective_mass = modes.effective_mass;
  m.mac = calc_own_mac(modal::ModalModel::from(modes));
  const auto n = modes.residual.size();
  if (n > 0) {
    const double worst = modes.residual.maxCoeff();
    m.checks.push_back({"largest residual", report::format_value(worst, 2), worst > 1e-5 ? Verdict::Bad : Verdict::Good,
                        "below 1e-5"});
  }
  m.checks.push_back({"Sturm count up to the highest",
                      modes.inertia_count < 0 ? "not made" : std::to_string(modes.inertia_count),
                      modes.inertia_count < 0    ? Verdict::None
                      : modes.inertia_count >= n ? Verdict::Good
                                                 : Verdict::Bad,
                      modes.inertia_count == n  ? "as many as in the table: none missed"
                      : modes.inertia_count > n ? "the others are below the range or copies of the last root"
                                                : ""});
  m.checks.push_back({"rigid-body modes", std::to_string(modes.num_rigid_modes), Verdict::None, ""});
  m.drawing = report::make_drawing(modes.mesh, modes.node_id, modes.node_xyz, modes.phi);
  report::add_energies(modes.mesh, modes.energies.id, modes.energies.strain, modes.energies.total_strain, m.drawing);
  return report::make_chapter(m);
}

}  // namespace bough::analysis
