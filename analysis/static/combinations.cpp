#include "analysis/static/combinations.hpp"

#include <algorithm>
#include <unordered_map>

#include "fe/elements/stress_recovery.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/records/group_names.hpp"

namespace bough::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using records::StaticSubcase;

template <class Vector>
void add_scaled(double factor, const Vector& part, Vector& sum) {
  if (part.size() == 0) return;
  if (sum.size() == 0)
    sum = factor * part;
  else
    sum += factor * part;
}

/// The blocks of a card have the same elements in every subcase.
template <class Block>
void add_blocks(double factor, const std::vector<Block>& parts, Eigen::MatrixXd Block::*values,
                std::vector<Block>& sums) {
  if (sums.empty()) {
    sums = parts;
    for (auto& sum : sums) sum.*values *= factor;
    return;
  }
  BOUGH_DEMAND(sums.size() == parts.size());
  for (std::size_t b = 0; b < parts.size(); ++b) sums[b].*values += factor * (parts[b].*values);
}

void add_strains(double factor, const std::vector<records::ElementStresses>& parts,
                 std::vector<records::ElementStresses>& sums) {
  const bool is_first = sums.empty();
  add_blocks(factor, parts, &records::ElementStresses::stress, sums);
  for (std::size_t b = 0; b < sums.size(); ++b)
    sums[b].corner = factor * parts[b].corner + (is_first ? MatrixXd(0 * parts[b].corner) : sums[b].corner);
}

/// Computes derived stresses from the sums of the components.
void derive_results(const fe::Model& model, bool of_strain, std::vector<records::ElementStresses>& blocks) {
  std::unordered_map<int, std::vector<const fe::Element*>> elements;
  for (const auto& element : model.elements()) elements[element->id()].push_back(element.get());
  for (auto& block : blocks)
    for (std::size_t k = 0; k < block.id.size(); ++k) {
      const std::string card = records::get_card_of_group(block.card);
      const auto& named = elements.at(block.id[k]);
      const auto element = std::find_if(named.begin(), named.end(), [&](const auto* e) { return e->card() == card; });
      BOUGH_DEMAND(element != named.end());
      const fe::StressRecovery& recovery = *(*element)->stress_recovery();
      const auto points = of_strain ? recovery.strain_points() : recovery.stress_points();
      const auto names = fe::list_stress_names(points);
      VectorXd values(static_cast<Index>(names.size()));
      for (std::size_t i = 0; i < names.size(); ++i) {
        const auto name = names[i].substr(std::string("stress_").size());
        const auto at = std::find(block.components.begin(), block.components.end(), name);
        BOUGH_DEMAND(at != block.components.end());
        values[static_cast<Index>(i)] = block.stress(static_cast<Index>(k), at - block.components.begin());
      }
      block.stress.row(static_cast<Index>(k)) =
          (of_strain ? fe::calc_strain_results(points, values) : fe::calc_stress_results(points, values)).transpose();
    }
}

}  // namespace

StaticSubcase combine(const fe::Model& model, const records::Deck& deck, const records::CaseCombination& combination,
                      const std::vector<StaticSubcase>& solved) {
  StaticSubcase sum;
  sum.id = combination.control.id;
  sum.label = combination.control.label;
  sum.load_resultant.setZero();
  sum.reaction_resultant.setZero();
  sum.mpc_resultant.setZero();
  for (const auto& [factor, id] : combination.terms) {
    const auto part = std::find_if(solved.begin(), solved.end(), [id = id](const auto& s) { return s.id == id; });
    if (part == solved.end())
      throw InputError("cli.combination-missing", deck.locate(combination.at),
                       combination.command + " " + std::to_string(sum.id) + " needs subcase " + std::to_string(id) +
                           ", of which there is no result",
                       "give it a load, correct its error, or run without --subcase");
    for (const auto member : {&StaticSubcase::displacement, &StaticSubcase::load, &StaticSubcase::reaction,
                              &StaticSubcase::mpc_force, &StaticSubcase::inertia})
      add_scaled(factor, (*part).*member, sum.*member);
    sum.load_resultant += factor * part->load_resultant;
    sum.reaction_resultant += factor * part->reaction_resultant;
    sum.mpc_resultant += factor * part->mpc_resultant;
    sum.inertia_resultant += factor * part->inertia_resultant;
    add_blocks(factor, part->elements, &records::ElementForces::force, sum.elements);
    add_blocks(factor, part->stresses, &records::ElementStresses::stress, sum.stresses);
    add_strains(factor, part->strains, sum.strains);
  }
  sum.strain_energy = 0.5 * sum.displacement.dot(VectorXd(fe::calc_stiffness_times(model, sum.displacement)));
  Diagnostics ignored;  // by the subcases
  const auto alone = fe::calc_element_forces(model, sum.displacement, deck, 0, ignored);
  BOUGH_DEMAND(alone.size() == sum.elements.size());
  for (std::size_t b = 0; b < alone.size(); ++b) sum.elements[b].strain_energy = alone[b].strain_energy;
  derive_results(model, false, sum.stresses);
  derive_results(model, true, sum.strains);
  return sum;
}

}  // namespace bough::analysis
