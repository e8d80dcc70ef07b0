#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "modal/response/recovery.hpp"

namespace bough::modal::response {
namespace {

constexpr std::array<std::pair<const char*, const char*>, 6> kQuantities{{{"DISPLACEMENT", "displacement"},
                                                                          {"VELOCITY", "velocity"},
                                                                          {"ACCELERATION", "acceleration"},
                                                                          {"SPCFORCES", "spc_force"},
                                                                          {"FORCE", "force"},
                                                                          {"STRESS", "stress"}}};

/// Grids that the excitation loads or moves, or that TIC gives a start.
std::vector<int> list_driven_grids(const fe::Model& model, const records::DynamicDeck& deck,
                                   const records::DynamicSubcase& subcase, const Excitation& excitation) {
  std::vector<int> grids;
  const MatrixXd moved = model.T_fixed() * excitation.D;
  for (const auto& node : model.nodes()) {
    const auto is_driven = [&](const MatrixXd& A) {
      return A.cols() > 0 && !A.middleRows(node.first_gdof, node.num_dofs).isZero(0);
    };
    const auto& starts = deck.dynamics.initial;
    const bool starts_here = subcase.dynamics.ic != 0 && excitation.F.cols() + moved.cols() == 0 &&
                             std::any_of(starts.begin(), starts.end(), [&](const auto& start) {
                               return start.sid == subcase.dynamics.ic && start.g == node.id;
                             });
    if (starts_here || is_driven(excitation.F) || is_driven(moved)) grids.push_back(node.id);
  }
  return grids;
}

/// The tables of stresses of bars (axial stress) and solids (corners) need forces too.
void add_listed_forces(const fe::Model& model, std::vector<OutputChoice>& outputs) {
  static const std::set<std::string> cards{"CBAR", "CTETRA", "CPENTA", "CHEXA", "CPYRAM"};
  const auto stress =
      std::find_if(outputs.begin(), outputs.end(), [](const auto& output) { return output.quantity == "stress"; });
  if (stress == outputs.end()) return;
  const std::set<int> chosen(stress->ids.begin(), stress->ids.end());
  OutputChoice forces;
  forces.quantity = "force";
  forces.is_for_listing = true;
  for (const auto& element : model.elements())
    if (cards.count(element->card()) > 0 && chosen.count(element->id()) > 0) forces.ids.push_back(element->id());
  if (!forces.ids.empty()) outputs.push_back(std::move(forces));
}

}  // namespace

std::vector<OutputChoice> choose_outputs(const fe::Model& model, const records::DynamicDeck& deck,
                                         const records::DynamicSubcase& subcase, const Excitation& excitation,
                                         const std::vector<int>& extra_grids, bool with_listing,
                                         Diagnostics& diagnostics) {
  std::vector<OutputChoice> outputs;
  const auto& selection = subcase.dynamics;
  for (const auto& [command, quantity] : kQuantities) {
    const auto found = selection.outputs.find(command);
    const bool is_asked = found != selection.outputs.end() && !found->second.is_none;
    OutputChoice output;
    output.quantity = quantity;
    const bool of_elements = output.quantity == "force" || output.quantity == "stress";
    if (is_asked) {
      const auto& request = found->second;
      const auto set = selection.sets.find(request.set);
      if (!request.is_all && set == selection.sets.end()) {
        diagnostics.error("modal.missing-set", deck.locate(request.at),
                          std::string(command) + " = " + std::to_string(request.set) +
                              " names a SET that the case control does not define before it",
                          "write SET " + std::to_string(request.set) + " = ids, or " + command + " = ALL");
        continue;
      }
      const auto is_in = [&](int id) { return request.is_all || set->second.contains(id); };
      output.is_phase = request.is_phase;
      output.is_punched = request.is_punched;
      output.is_printed = request.is_printed;
      if (of_elements) {
        for (const auto& element : model.elements())
          if (is_in(element->id())) output.ids.push_back(element->id());
      } else {
        for (const auto& node : model.nodes())
          if (is_in(node.id)) output.ids.push_back(node.id);
      }
    }
    if (!of_elements && output.quantity != "spc_force")
      for (const int id : extra_grids)
        if (std::find(output.ids.begin(), output.ids.end(), id) == output.ids.end()) output.ids.push_back(id);
    if (output.quantity == "spc_force") {
      // Grids that are constrained, as in Nastran.
      const auto& fixed = model.fixed_dofs();
      std::erase_if(output.ids, [&](int id) {
        const auto& node = model.node(model.find_node(id));
        const auto at = std::lower_bound(fixed.begin(), fixed.end(), node.first_gdof);
        return at == fixed.end() || *at >= node.first_gdof + node.num_dofs;
      });
    }
    if (!output.ids.empty()) outputs.push_back(std::move(output));
  }
  if (with_listing) add_listed_forces(model, outputs);
  const bool is_said = std::any_of(kQuantities.begin(), kQuantities.end(),
                                   [&](const auto& q) { return selection.outputs.count(q.first) > 0; });
  if (!outputs.empty() || is_said) return outputs;
  outputs.emplace_back();
  outputs.back().quantity = "displacement";
  outputs.back().ids = list_driven_grids(model, deck, subcase, excitation);
  diagnostics.note("modal.default-output", deck.locate({}),
                   "the deck requests no result: the displacements of the grids that are driven are given",
                   "write DISPLACEMENT = n and SET n = ids in the case control, or --grid");
  return outputs;
}

}  // namespace bough::modal::response
