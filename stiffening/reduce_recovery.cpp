/// Forces and stresses of the elements that the body file names, per mode and per unit load.
#include <cctype>
#include <charconv>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <unordered_set>

#include "fe/cards/element_properties.hpp"
#include "fe/elements/beam.hpp"
#include "fe/loads/load_sets.hpp"
#include "fe/statics/element_results.hpp"
#include "stiffening/reduction.hpp"

namespace bough::stiffening {
namespace {

bool read_id(std::string_view text, int& id) {
  const auto end = text.data() + text.size();
  return !text.empty() && std::from_chars(text.data(), end, id).ptr == end && id > 0;
}

/// What a word of `recover` names: "ALL", an id, "A-B", "property:P", "card:CBAR".
struct Wanted {
  bool all = false;
  int first = 0, last = -1, property = 0;
  std::string card;

  bool names(const fe::Element& element, int pid) const {
    return all || (element.id() >= first && element.id() <= last) || (property > 0 && pid == property) ||
           (!card.empty() && element.card() == card);
  }
};

std::optional<Wanted> read_wanted(const std::string& word) {
  Wanted w;
  std::string upper = word;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const auto dash = upper.find('-'), colon = upper.find(':');
  if (upper == "ALL") {
    w.all = true;
  } else if (colon != std::string::npos) {
    const auto kind = upper.substr(0, colon), what = upper.substr(colon + 1);
    if (kind == "CARD" && !what.empty())
      w.card = what;
    else if (kind != "PROPERTY" || !read_id(what, w.property))
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

/// Forces and stresses of an element for columns U_g, in the rows of a block: what static solutions print, then the
/// stresses. `add` (may be empty): what a column's internal forces have beside those of its displacements.
MatrixXd calc_rows(const fe::Element& element, const MatrixXd& U_g,
                   const std::function<void(MatrixXd& forces, MatrixXd& stresses)>& add) {
  const fe::PrintedForces& printed_forces = *element.printed_forces();
  const fe::StressRecovery* recovery = element.stress_recovery();
  const auto count = static_cast<Eigen::Index>(printed_forces.printed_force_names().size());
  MatrixXd forces = fe::calc_internal_forces(element, U_g), printed(count, U_g.cols());
  MatrixXd more = MatrixXd::Zero(recovery ? recovery->calc_stresses(forces).rows() : 0, U_g.cols());
  if (add) add(forces, more);
  for (Eigen::Index c = 0; c < U_g.cols(); ++c) {
    // Internal forces begin with those that are printed; springs have the latter alone.
    if (element.stress_state())
      printed.col(c) = forces.col(c).head(count);
    else
      printed.col(c) = printed_forces.calc_printed_forces(Eigen::VectorXd(U_g(element.gdofs(), c)));
  }
  MatrixXd rows(count + more.rows(), U_g.cols());
  rows.topRows(count) = printed;
  if (recovery) rows.bottomRows(more.rows()) = recovery->calc_stresses(forces) + more;
  return rows;
}

}  // namespace

/// The elements that spec_.recover names, by what their rows are called. Reports reduce.bad-recover,
/// reduce.unknown-element, reduce.nothing-to-recover.
std::map<std::pair<std::string, std::vector<std::string>>, std::vector<int>> Reduction::choose_recovered(
    const fe::Model& model) {
  std::map<std::pair<std::string, std::vector<std::string>>, std::vector<int>> groups;
  const auto properties = fe::list_element_properties(deck_);
  std::unordered_set<int> chosen;
  const auto& elements = model.elements();
  for (const auto& word : spec_.recover) {
    const auto wanted = read_wanted(word);
    if (!wanted) {
      diagnostics_.error("reduce.bad-recover", where(),
                         "recover names \"" + word + "\", which is no element, range, property or card",
                         "write \"ALL\", 17, \"17-25\", \"property:3\" or \"card:CBAR\"");
      continue;
    }
    bool is_there = false;
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const auto property = properties.find(elements[e]->id());
      if (!wanted->names(*elements[e], property == properties.end() ? 0 : property->second)) continue;
      is_there = true;
      std::vector<std::string> names;
      if (const auto* printed = elements[e]->printed_forces()) names = printed->printed_force_names();
      if (const auto* recovery = elements[e]->stress_recovery())
        for (auto& name : fe::list_stress_names(recovery->stress_points())) names.push_back(std::move(name));
      if (names.empty() || !chosen.insert(static_cast<int>(e)).second) continue;
      groups[{elements[e]->card(), std::move(names)}].push_back(static_cast<int>(e));
    }
    if (!is_there)
      diagnostics_.error("reduce.unknown-element", where(),
                         "recover names \"" + word + "\", but the deck has no such element", "correct it");
  }
  diagnostics_.throw_if_errors();
  if (groups.empty())
    diagnostics_.warning("reduce.nothing-to-recover", where(),
                         "the elements that recover names have neither forces nor stresses",
                         "name bars, beams, rods, shells, solids, springs or bushes");
  return groups;
}

/// U: the static solutions of the loads F, whose first columns are the inertial ones of `inertial`, then a column a
/// locator. What the modes leave out of each is U - Φ K⁻¹ ΦᵀF (docs/theory/recovery.md).
void Reduction::set_recovery(const fe::Model& model, const MatrixXd& U, const MatrixXd& F,
                             const std::vector<int>& inertial) {
  if (spec_.recover.empty()) return;
  report("element recovery");
  const auto groups = choose_recovered(model);
  const auto n = Phi_.cols(), num_inertial = static_cast<Eigen::Index>(inertial.size());
  const auto num_loads = F.cols() - num_inertial;
  body_.inertial_load = MatrixXd::Zero(n, records::kNumInertialLoads);
  for (Eigen::Index i = 0; i < num_inertial; ++i)
    body_.inertial_load.col(inertial[static_cast<std::size_t>(i)]) = Phi_.transpose() * F.col(i);
  MatrixXd left = U;
  if (n > 0) left -= Phi_ * body_.modal_stiffness.ldlt().solve(Phi_.transpose() * F);
  std::vector<std::unordered_map<int, Eigen::VectorXd>> end_loads(loads_.size());
  for (std::size_t e = 0; e < loads_.size(); ++e)
    if (loads_[e].load_set > 0) {
      Diagnostics said;
      end_loads[e] = fe::calc_beam_end_loads(model, deck_, loads_[e].load_set, said);
    }
  MatrixXd all(U.rows(), n + F.cols());
  all.leftCols(n) = Phi_;
  all.rightCols(F.cols()) = left;
  const auto [begin, end] = fe::calc_element_range(model);
  std::map<std::string, int> count;
  for (const auto& [key, members] : groups) {
    auto& block = body_.recovery.emplace_back();
    const int number = ++count[key.first];
    block.name = number == 1 ? key.first : key.first + "-" + std::to_string(number);
    block.components = key.second;
    const auto c = static_cast<Eigen::Index>(key.second.size());
    MatrixXd rows = MatrixXd::Zero(c * static_cast<Eigen::Index>(members.size()), all.cols() + 1);
    for (std::size_t k = 0; k < members.size(); ++k) {
      const int e = members[k];
      const fe::Element& element = *model.elements()[static_cast<std::size_t>(e)];
      block.id.push_back(element.id());
      if (e < begin || e >= end) continue;
      auto mine = rows.middleRows(c * static_cast<Eigen::Index>(k), c);
      mine.leftCols(all.cols()) = calc_rows(element, all, [&](MatrixXd& forces, MatrixXd& stresses) {
        for (std::size_t l = 0; l < loads_.size(); ++l) {
          const auto column = n + num_inertial + static_cast<Eigen::Index>(l);
          if (const auto* part = loads_[l].initial.find(element)) {
            forces.col(column) += part->force;
            if (part->stress.size() > 0) stresses.col(column) += part->stress;
          }
          if (const auto own = end_loads[l].find(e); own != end_loads[l].end())
            element.as_beam()->add_load_forces(own->second, forces.col(column));
        }
      });
      const auto* prestress = model.prestress();
      if (prestress && prestress->force[static_cast<std::size_t>(e)].size() > 0)
        mine.rightCols(1) = calc_rows(element, MatrixXd::Zero(U.rows(), 1), [&](MatrixXd& forces, MatrixXd&) {
          forces.col(0) = prestress->force[static_cast<std::size_t>(e)];
        });
    }
    fe::sum_over_ranks(rows);
    block.matrix = rows.leftCols(n);
    block.inertial = MatrixXd::Zero(rows.rows(), records::kNumInertialLoads);
    for (Eigen::Index i = 0; i < num_inertial; ++i)
      block.inertial.col(inertial[static_cast<std::size_t>(i)]) = rows.col(n + i);
    block.external = rows.middleCols(n + num_inertial, num_loads);
    block.offset = rows.rightCols(1);
  }
}

}  // namespace bough::stiffening
