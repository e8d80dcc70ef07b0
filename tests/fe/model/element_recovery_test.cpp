/// \file Results of many cases at once against the elements' own functions, case after case.
#include "fe/statics/element_recovery.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "fe/elements/beam.hpp"
#include "fe/elements/stress_recovery.hpp"
#include "fe/elements/stress_state.hpp"
#include "fe/loads/load_sets.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/case_solver.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::fe {
namespace {

// A line along x with one element or more of every kind of recovery: shells, a laminate, a solid, beams, a spring.
const std::string kDeck =
    "SOL 101\nCEND\nSPC = 1\nTEMPERATURE(INITIAL) = 9\nSUBCASE 1\n LOAD = 1\nSUBCASE 2\n LOAD = 2\nSUBCASE 3\n LOAD = "
    "7\nSUBCASE 4\n LOAD = 1\n TEMPERATURE(LOAD) = 5\nSUBCASE 5\n LOAD = 4\nBEGIN BULK\n"
    "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,.1\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,2.,0.,0.\nGRID,6,,2.,1.,.1\n"
    "GRID,7,,1.,0.,1.\nGRID,8,,2.,0.,1.\nGRID,9,,2.,1.,1.\nGRID,10,,1.,1.,1.\nGRID,11,,3.,0.,0.\nGRID,12,,3.,.2,.3\n"
    "CQUAD4,1,1,1,2,3,4\nCTRIA3,2,1,2,5,6\nCQUAD4,3,2,2,5,6,3\nCHEXA,4,3,2,5,6,3,7,8\n,9,10\n"
    "CBAR,5,4,5,11,0.,0.,1.\nCROD,6,5,11,12\nCBAR,8,4,11,12,0.,1.,0.\nCELAS2,7,1.+4,12,1,6,1\n"
    "PSHELL,1,1,.05,1,,1\nPCOMP,2\n,1,.02,0.,,1,.02,45.\nPSOLID,3,1\nPBAR,4,1,1.-3,1.-6,2.-6,1.-6\n,.1,.1,-.1,.1\n"
    "PROD,5,1,1.-3,1.-6\nMAT1,1,7.+10,,.3,2700.,1.-5,20.\nSPC1,1,123456,1,4\n"
    "FORCE,1,11,,100.,1.,2.,3.\nFORCE,2,9,,50.,0.,1.,-1.\nPLOAD1,4,5,FY,FR,0.,3.,1.,5.\nFORCE,4,6,,1.,1.,1.,1.\n"
    "TEMPD,9,20.\nTEMPD,5,80.\nENDDATA\n";

struct Read {
  Diagnostics diagnostics;
  records::Deck deck = nastran::read_deck_text(kDeck, "deck.bdf", {}, diagnostics);
  Model model = [this] {
    diagnostics.throw_if_errors();
    ModelOptions options;
    options.uses_enforced = true;
    return build_model(deck, options, diagnostics);
  }();
};

TEST(ElementRecovery, CasesTogetherAreWhatTheElementsGiveOneByOne) {
  Read read;
  const Model& model = read.model;
  const int load = 4;
  const auto initial = calc_thermal(model, read.deck, 5, read.diagnostics);
  const auto end_loads = calc_beam_end_loads(model, read.deck, load, read.diagnostics);
  ASSERT_FALSE(end_loads.empty());
  ASSERT_FALSE(initial.of.empty());
  MatrixXd U = MatrixXd::Random(model.num_gdofs(), 19);  // not a multiple of the rows that are written at once
  std::vector<VectorXd> u;
  for (Eigen::Index c = 0; c < U.cols(); ++c) u.emplace_back(U.col(c));
  std::vector<RecoveryCase> cases;
  for (std::size_t c = 0; c < u.size(); ++c) {
    cases.push_back({&u[c], c % 2 == 0 ? load : 0, c % 3 == 0 ? &initial : nullptr, &read.diagnostics});
  }
  const auto results = recover_elements(model, read.deck, cases, {true, true, true});
  ASSERT_EQ(results.size(), u.size());
  int num_forces = 0, num_stresses = 0, num_strains = 0;
  for (std::size_t e = 0; e < model.elements().size(); ++e) {
    const Element& element = *model.elements()[e];
    for (std::size_t c = 0; c < cases.size(); ++c) {
      const VectorXd u_e = u[c](element.gdofs());
      const auto* heated = cases[c].initial ? initial.find(element) : nullptr;
      const StressState* state = element.stress_state();
      VectorXd force = VectorXd::Zero(state ? state->num_internal_forces() : 0), printed;
      if (state) state->calc_internal_forces(u_e, force);
      if (element.printed_forces()) printed = element.printed_forces()->calc_printed_forces(u_e);
      if (heated) force += heated->force;
      if (const auto own = end_loads.find(static_cast<int>(e)); own != end_loads.end() && cases[c].load > 0)
        element.as_beam()->add_load_forces(own->second, force);
      if (force.size() > 0) printed = force.head(printed.size());
      MatrixXd K = MatrixXd::Zero(u_e.size(), u_e.size());
      element.add_stiffness(1, K);
      double energy = 0.5 * u_e.dot(K * u_e);
      if (heated) energy += heated->energy - u_e.dot(heated->load);
      for (const auto& block : results[c].forces)
        for (std::size_t r = 0; r < block.id.size(); ++r) {
          if (block.id[r] != element.id()) continue;
          const auto row = static_cast<Eigen::Index>(r);
          EXPECT_LT((block.force.row(row).transpose() - printed).norm(), 1e-12 * printed.norm()) << element.card();
          EXPECT_NEAR(block.strain_energy[row], energy, 1e-12 * std::abs(u_e.dot(K.cwiseAbs() * u_e.cwiseAbs())));
          EXPECT_EQ(block.components, element.printed_forces()->printed_force_names());
          ++num_forces;
        }
      const auto compare = [&](const std::vector<records::ElementStresses>& blocks, const VectorXd& wanted,
                               int& count) {
        for (const auto& block : blocks)
          for (std::size_t r = 0; r < block.id.size(); ++r) {
            if (block.id[r] != element.id()) continue;
            const VectorXd got = block.stress.row(static_cast<Eigen::Index>(r)).transpose();
            EXPECT_LT((got - wanted).norm(), 1e-11 * wanted.norm()) << element.card() << element.id();
            ++count;
          }
      };
      if (const StressRecovery* recovery = element.stress_recovery()) {
        const auto points = recovery->stress_points();
        VectorXd stress = recovery->calc_stresses(force);
        if (heated && heated->stress.size() > 0) stress += heated->stress;
        compare(results[c].stresses, calc_stress_results(points, stress), num_stresses);
      }
      if (const StressRecovery* recovery = element.stress_recovery()) {
        const auto points = recovery->strain_points();
        VectorXd strain = recovery->calc_strains(force);
        if (heated && heated->strain.size() > 0) strain += heated->strain;
        compare(results[c].strains, calc_strain_results(points, strain), num_strains);
      }
    }
  }
  const int count = static_cast<int>(cases.size());
  EXPECT_EQ(num_forces, 8 * count);
  EXPECT_EQ(num_stresses, 7 * count);
  EXPECT_GE(num_strains, 6 * count);
}

TEST(ElementRecovery, SubcasesTogetherAreTheSubcasesAlone) {
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck_text(kDeck, "deck.bdf", {}, diagnostics);
  diagnostics.throw_if_errors();
  CaseSolver together(deck, {}), alone(deck, {});
  const auto all = together.solve_next(deck.subcases);
  ASSERT_EQ(all.size(), 5u);
  EXPECT_FALSE(all[2].result) << "set 7 is not in the deck";
  EXPECT_THROW(std::rethrow_exception(all[2].failure), InputError);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto own = alone.solve_next(std::span(deck.subcases).subspan(k, 1));
    ASSERT_EQ(own.size(), 1u);
    ASSERT_EQ(own[0].result.has_value(), all[k].result.has_value());
    EXPECT_EQ(own[0].diagnostics.items().size(), all[k].diagnostics.items().size());
    if (!own[0].result) continue;
    const auto &a = *own[0].result, &b = *all[k].result;
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.temperature_set, b.temperature_set);
    EXPECT_LT((a.displacement - b.displacement).norm(), 1e-11 * a.displacement.norm());
    EXPECT_LT((a.reaction - b.reaction).norm(), 1e-9 * a.reaction.norm());
    EXPECT_NEAR(a.strain_energy, b.strain_energy, 1e-10 * std::abs(a.strain_energy));
    ASSERT_EQ(a.elements.size(), b.elements.size());
    double largest = 0;  // some elements carry nothing but roundoff of what others carry
    for (const auto& of_card : a.elements) largest = std::max(largest, of_card.force.norm());
    for (std::size_t i = 0; i < a.elements.size(); ++i) {
      EXPECT_LT((a.elements[i].force - b.elements[i].force).norm(), 1e-11 * largest);
      EXPECT_LT((a.elements[i].strain_energy - b.elements[i].strain_energy).cwiseAbs().maxCoeff(),
                1e-10 * std::abs(a.strain_energy));
    }
  }
}

TEST(ElementRecovery, DividesManySubcasesIntoFewGroupsTheLastTheSmallest) {
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck_text(kDeck, "deck.bdf", {}, diagnostics);
  diagnostics.throw_if_errors();
  const std::vector<std::pair<std::size_t, std::vector<std::size_t>>> expected{
      {1, {1}}, {40, {40}}, {41, {23, 18}}, {80, {40, 40}}, {100, {37, 35, 28}}};
  for (const auto& [number, sizes] : expected) {
    std::vector<records::Subcase> subcases(number, deck.subcases[0]);
    CaseSolver solver(deck, {});
    std::vector<std::size_t> seen;
    for (std::size_t next = 0; next < number; next += seen.back())
      seen.push_back(solver.solve_next(std::span(subcases).subspan(next)).size());
    EXPECT_EQ(seen, sizes) << number;
  }
}

}  // namespace
}  // namespace bough::fe
