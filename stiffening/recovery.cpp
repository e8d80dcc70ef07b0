// Forces and stresses of the elements that the body file names, per mode and per unit load.
#include <cctype>
#include <charconv>
#include <optional>
#include <string_view>
#include <unordered_set>

#include "fe/cards/element_properties.hpp"
#include "fe/elements/beam.hpp"
#include "fe/loads/load_sets.hpp"
#include "fe/model/element_loop.hpp"
#include "fe/statics/element_groups.hpp"
#include "fe/statics/element_results.hpp"
#include "stiffening/stages.hpp"

namespace bough::stiffening {
namespace {

bool read_id(std::string_view text, int& id) {
  const auto end = text.data() + text.size();
  return !text.empty() && std::from_chars(text.data(), end, id).ptr == end && id > 0;
}

/// The elements of a word of `recover`: "ALL", an id, "A-B", "property:P", "card:CBAR".
struct ElementChoice {
  bool all = false;
  int first = 0, last = -1, property = 0;
  std::string card;

  bool names(const fe::Element& element, int pid) const {
    return all || (element.id() >= first && element.id() <= last) || (property > 0 && pid == property) ||
           (!card.empty() && element.card() == card);
  }
};

std::optional<ElementChoice> read_choice(const std::string& word) {
  ElementChoice w;
  std::string upper = word;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const auto dash = upper.find('-'), colon = upper.find(':');
  if (upper == "ALL") {
    w.all = true;
  } else if (colon != std::string::npos) {
    const auto kind = upper.substr(0, colon), name = upper.substr(colon + 1);
    if (kind == "CARD" && !name.empty())
      w.card = name;
    else if (kind != "PROPERTY" || !read_id(name, w.property))
      return std::nullopt;
  } else if (dash != std::string::npos) {
    if (!read_id(upper.substr(0, dash), w.first) || !read_id(upper.substr(dash + 1), w.last) || w.last < w.first)
      return std::nullopt;
  } else {
    if (!read_id(upper, w.first)) return std::nullopt;
    w.last = w.first;
  }
  return w;
}

/// Components of the forces, then those of the stresses; empty without either.
std::vector<std::string> list_components(const fe::Element& element) {
  auto names = fe::list_force_components(element);
  if (const auto* recovery = element.stress_recovery())
    for (auto& name : fe::list_stress_names(recovery->stress_points())) names.push_back(std::move(name));
  return names;
}

/// The elements that spec.recover names. Reports reduce.bad-recover, reduce.unknown-element, reduce.nothing-to-recover.
std::vector<fe::ElementGroup> choose_recovered(const BodyRequest& request, const fe::Model& model) {
  const auto properties = fe::list_element_properties(request.deck);
  std::unordered_set<int> chosen;
  const auto& elements = model.elements();
  for (const auto& word : request.spec.recover) {
    const auto choice = read_choice(word);
    if (!choice) {
      request.error_at("output/recover", "reduce.bad-recover",
                       "recover names \"" + word + "\", which is no element, range, property or card",
                       "write \"ALL\", 17, \"17-25\", \"property:3\" or \"card:CBAR\"");
      continue;
    }
    bool is_there = false;
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const auto property = properties.find(elements[e]->id());
      if (!choice->names(*elements[e], property == properties.end() ? 0 : property->second)) continue;
      is_there = true;
      chosen.insert(static_cast<int>(e));
    }
    if (!is_there)
      request.error_at("output/recover", "reduce.unknown-element",
                       "recover names \"" + word + "\", but the deck has no such element", "correct it");
  }
  request.diagnostics.throw_if_errors();
  auto groups = fe::group_elements(model, [&](const fe::Element& element, int e) {
    return chosen.count(e) > 0 ? list_components(element) : std::vector<std::string>{};
  });
  if (groups.empty())
    request.warning_at("output/recover", "reduce.nothing-to-recover",
                       "the elements that recover names have neither forces nor stresses",
                       "name bars, beams, rods, shells, solids, springs or bushes");
  return groups;
}

/// Adds to each load the accelerations of the rigid body that balance it, so that its answer does not depend on the
/// support of the static solutions: a load whose value is unknown in motion then lacks its own answer alone, not that
/// of its reaction. Loads of a motion balance in sum.
void balance_loads(const fe::Model& model, const std::vector<int>& inertial, MatrixXd& F, MatrixXd& U) {
  std::vector<Eigen::Index> rigid;
  for (int k = 0; k < 6; ++k)
    if (const auto at = std::find(inertial.begin(), inertial.end(), k); at != inertial.end())
      rigid.push_back(at - inertial.begin());
  if (rigid.size() < 6) return;
  const MatrixXd resultants = model.calc_rigid_modes().transpose() * F;
  const MatrixXd accelerations =
      MatrixXd(resultants(Eigen::all, rigid)).completeOrthogonalDecomposition().solve(resultants);
  F -= MatrixXd(F(Eigen::all, rigid)) * accelerations;
  U -= MatrixXd(U(Eigen::all, rigid)) * accelerations;
}

}  // namespace

MatrixXd calc_recovery_rows(const fe::Element& element, const MatrixXd& d, const MatrixXd& forces,
                            const MatrixXd& more) {
  const fe::PrintedForces& printed_forces = *element.printed_forces();
  const fe::StressRecovery* recovery = element.stress_recovery();
  const auto count = static_cast<Eigen::Index>(printed_forces.printed_force_names().size());
  MatrixXd stresses(0, d.cols());
  if (recovery) stresses = recovery->calc_stresses(forces);
  if (more.size() > 0) stresses += more;
  MatrixXd rows(count + stresses.rows(), d.cols());
  for (Eigen::Index c = 0; c < d.cols(); ++c) {
    // The printed forces are the first internal forces; springs have no others.
    if (element.stress_state())
      rows.col(c).head(count) = forces.col(c).head(count);
    else
      rows.col(c).head(count) = printed_forces.calc_printed_forces(Eigen::VectorXd(d.col(c)));
  }
  rows.bottomRows(stresses.rows()) = stresses;
  return rows;
}

RecoveredElements start_recovery(const BodyRequest& request, const fe::Model& model, records::FlexBody& body) {
  if (request.spec.recover.empty()) return {};
  RecoveredElements recovered;
  for (const auto& [name, components, members] : choose_recovered(request, model)) {
    auto& block = body.recovery.emplace_back();
    block.name = name;
    block.components = components;
    for (const int e : members) block.id.push_back(model.elements()[static_cast<std::size_t>(e)]->id());
    recovered.push_back(members);
  }
  return recovered;
}

/// U - Φ K⁻¹ ΦᵀF is the deflection of each load that the modes lack (docs/theory/recovery.md).
void set_recovery(const BodyRequest& request, const fe::Model& model, const MatrixXd& Phi,
                  const std::vector<LoadPattern>& patterns, const SolvedLoads& solved,
                  const RecoveredElements& recovered, records::FlexBody& body) {
  MatrixXd F = solved.columns.F, U = solved.U;
  if (request.spec.frame == records::BodyFrame::Free || request.spec.frame == records::BodyFrame::MeanAxes)
    balance_loads(model, solved.inertial, F, U);
  const auto& inertial = solved.inertial;
  const auto n = Phi.cols(), num_inertial = solved.num_inertial();
  const auto num_loads = F.cols() - num_inertial;
  body.inertial_load = MatrixXd::Zero(n, records::kNumInertialLoads);
  for (Eigen::Index i = 0; i < num_inertial; ++i)
    body.inertial_load.col(inertial[static_cast<std::size_t>(i)]) = Phi.transpose() * solved.columns.F.col(i);
  MatrixXd residual = U;
  if (n > 0) residual -= Phi * body.modal_stiffness.ldlt().solve(Phi.transpose() * F);
  std::vector<std::unordered_map<int, Eigen::VectorXd>> end_loads(patterns.size());
  for (std::size_t e = 0; e < patterns.size(); ++e)
    if (patterns[e].load_set > 0) {
      Diagnostics repeated;  // of make_load_patterns()
      end_loads[e] = fe::calc_beam_end_loads(model, request.deck, patterns[e].load_set, repeated);
    }
  MatrixXd all(U.rows(), n + F.cols());
  all.leftCols(n) = Phi;
  all.rightCols(F.cols()) = residual;
  const auto own_elements = fe::get_own_elements(model);
  for (std::size_t b = 0; b < recovered.size(); ++b) {
    auto& block = body.recovery[b];
    const auto& members = recovered[b];
    const auto c = static_cast<Eigen::Index>(block.components.size());
    MatrixXd rows = MatrixXd::Zero(c * static_cast<Eigen::Index>(members.size()), all.cols() + 1);
    for (std::size_t k = 0; k < members.size(); ++k) {
      const int e = members[k];
      const fe::Element& element = *model.elements()[static_cast<std::size_t>(e)];
      if (!own_elements.contains(e)) continue;
      auto mine = rows.middleRows(c * static_cast<Eigen::Index>(k), c);
      const MatrixXd d = all(element.gdofs(), Eigen::all);
      MatrixXd forces = fe::calc_internal_forces(element, all);
      MatrixXd stresses = MatrixXd::Zero(
          element.stress_recovery() ? element.stress_recovery()->calc_stresses(forces).rows() : 0, all.cols());
      for (std::size_t l = 0; l < patterns.size(); ++l) {
        const auto column = n + num_inertial + static_cast<Eigen::Index>(l);
        if (const auto* part = patterns[l].initial.find(element)) {
          forces.col(column) += part->force;
          if (part->stress.size() > 0) stresses.col(column) += part->stress;
        }
        if (const auto own = end_loads[l].find(e); own != end_loads[l].end())
          element.as_beam()->add_load_forces(own->second, forces.col(column));
      }
      mine.leftCols(all.cols()) = calc_recovery_rows(element, d, forces, stresses);
      const auto* prestress = model.prestress();
      if (prestress && prestress->force[static_cast<std::size_t>(e)].size() > 0)
        mine.rightCols(1) = calc_recovery_rows(element, MatrixXd::Zero(element.num_dofs(), 1),
                                               prestress->force[static_cast<std::size_t>(e)]);
    }
    linear::sum_over_ranks(rows);
    block.matrix = rows.leftCols(n);
    block.inertial = MatrixXd::Zero(rows.rows(), records::kNumInertialLoads);
    for (Eigen::Index i = 0; i < num_inertial; ++i)
      block.inertial.col(inertial[static_cast<std::size_t>(i)]) = rows.col(n + i);
    block.external = rows.middleCols(n + num_inertial, num_loads);
    block.offset = rows.rightCols(1);
  }
}

}  // namespace bough::stiffening
