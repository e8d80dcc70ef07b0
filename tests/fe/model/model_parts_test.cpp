/// A model by parts against the whole one: elements, rows, sums, AUTOSPC, messages. On one process there is one part.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "fe/linear/factor.hpp"
#include "fe/linear/own_rows.hpp"
#include "fe/linear/ranks.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/matrices/mass_directions.hpp"
#include "fe/matrices/reach.hpp"
#include "fe/statics/build_model.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::fe {
namespace {

constexpr int kLong = 24, kWide = 6;

int grid(int i, int j) { return 1 + i + j * (kLong + 1); }

/// A strip of shells held at its left edge, with an RBE2 and an RBE3 from end to end, an MPC, a mass on an offset, a
/// spring from end to end, a grid that nothing holds and an oblique rod.
std::string write_strip(const std::string& more = "") {
  std::string text = "SOL 103\nCEND\nSPC = 1\nMPC = 1\nBEGIN BULK\nMAT1,1,2.+11,,.3,8000.\nPSHELL,1,1,.05,1,,1\n";
  const auto number = [](double v) { return std::to_string(v).substr(0, 8); };
  for (int j = 0; j <= kWide; ++j)
    for (int i = 0; i <= kLong; ++i)
      text += "GRID," + std::to_string(grid(i, j)) + ",," + number(0.25 * i) + "," + number(0.2 * j) + ",0.\n";
  int id = 0;
  for (int j = 0; j < kWide; ++j)
    for (int i = 0; i < kLong; ++i) {
      text += "CQUAD4," + std::to_string(++id) + ",1";
      for (const int g : {grid(i, j), grid(i + 1, j), grid(i + 1, j + 1), grid(i, j + 1)})
        text += "," + std::to_string(g);
      text += "\n";
    }
  for (int j = 0; j <= kWide; ++j) text += "SPC1,1,123456," + std::to_string(grid(0, j)) + "\n";
  const auto name = [](int i, int j) { return std::to_string(grid(i, j)); };
  text += "GRID,9001,,3.,.6,.5\nCONM2,9001,9001,,50.,,.1,.2,.3\n";
  text += "RBE3,9002,,9001,123456,1.,123," + name(3, 1) + ",\n," + name(20, 1) + "," + name(3, 5) + "," + name(20, 5) +
          "\n";
  text += "RBE2,9003," + name(2, 3) + ",123," + name(22, 3) + "\n";
  text += "MPC,1," + name(24, 2) + ",3,1.," + name(4, 2) + ",3,-1.\n";
  text += "CELAS2,9004,1.+4," + name(1, 6) + ",3," + name(24, 6) + ",3\n";
  text += "GRID,9005,,7.,.3,.4\nCONROD,9006," + name(24, 0) + ",9005,1,.01\nGRID,9007,,9.,9.,9.\n";
  return text + more + "ENDDATA\n";
}

struct Made {
  Diagnostics said;
  std::optional<Model> model;
};

Made make(const std::string& text, bool by_parts) {
  Made made;
  const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, made.said);
  ModelOptions options;
  options.by_parts = by_parts;
  try {
    made.model.emplace(build_model(deck, options, made.said));
  } catch (const InputError& error) {
    made.said = {};
    for (const auto& item : error.items()) made.said.add(item);
  }
  return made;
}

std::string list(const Diagnostics& said) {
  std::string text;
  for (const auto& item : said.items()) text += format(item) + "\n";
  return text;
}

int sum(int own) {
  const auto all = join_over_ranks(std::vector<int>{own});
  return std::accumulate(all.begin(), all.end(), 0);
}

/// By number in the deck.
VectorXd order_as(const Model& other, const Model& model, const VectorXd& x) {
  VectorXd y(x.size());
  for (int f = 0; f < model.num_fdofs(); ++f) {
    const auto [id, component] = model.describe_fdof(f);
    y(other.find_fdof(other.find_node(id), component)) = x(f);
  }
  return y;
}

class ModelParts : public ::testing::Test {
 protected:
  const Made whole = make(write_strip(), false), made = make(write_strip(), true);
  const Model &one = *whole.model, &parts = *made.model;
};

TEST_F(ModelParts, KeepLessThanTheWholeAndTogetherAllOfIt) {
  ASSERT_EQ(parts.share() != nullptr, initialize_petsc().size > 1);
  ASSERT_FALSE(one.share());
  if (!parts.share()) return;
  const auto& share = *parts.share();
  EXPECT_LT(parts.elements().size(), one.elements().size() * 9 / 10);
  EXPECT_EQ(sum(static_cast<int>(share.owned.size())), static_cast<int>(one.elements().size()));
  EXPECT_EQ(sum(share.last_fdof - share.first_fdof), one.num_fdofs());
  EXPECT_GT(share.last_fdof, share.first_fdof);
  std::vector<int> places;
  for (const int e : share.owned) places.push_back(share.number[static_cast<std::size_t>(e)]);
  places = join_over_ranks(places);
  std::sort(places.begin(), places.end());
  for (std::size_t i = 0; i < places.size(); ++i) ASSERT_EQ(places[i], static_cast<int>(i));
  for (std::size_t e = 0; e < parts.elements().size(); ++e) {
    const auto& same = one.elements()[static_cast<std::size_t>(share.number[e])];
    EXPECT_EQ(parts.elements()[e]->id(), same->id());
    EXPECT_EQ(parts.elements()[e]->card(), same->card());
  }
}

TEST_F(ModelParts, HaveTheMatricesOfTheWhole) {
  ASSERT_EQ(parts.num_fdofs(), one.num_fdofs());
  for (const bool is_mass : {false, true}) {
    const auto assemble_one = [&](const Model& model) {
      return is_mass ? assemble_mass(model, DofSet::Free, MassKind::Consistent)
                     : assemble_stiffness(model, DofSet::Free);
    };
    const PetscMat A = assemble_one(one), B = assemble_one(parts);
    VectorXd x(one.num_fdofs());
    for (Eigen::Index i = 0; i < x.size(); ++i) x(i) = std::sin(1.7 * static_cast<double>(i));
    VectorXd x_parts(x.size());
    for (int f = 0; f < parts.num_fdofs(); ++f) {
      const auto [id, component] = parts.describe_fdof(f);
      x_parts(f) = x(one.find_fdof(one.find_node(id), component));
    }
    const VectorXd expected = multiply(A.get(), x), found = order_as(one, parts, multiply(B.get(), x_parts));
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-13 * expected.cwiseAbs().maxCoeff());
    const OwnRows rows = find_own_rows(B.get());
    const VectorXd by_rows = rows.replicate(rows.multiply(B.get(), rows.take(x_parts)));
    EXPECT_LT((order_as(one, parts, by_rows) - expected).cwiseAbs().maxCoeff(), 1e-13 * expected.cwiseAbs().maxCoeff());
    EXPECT_NEAR(rows.dot(rows.take(x_parts), rows.take(x_parts))(0, 0), x.squaredNorm(), 1e-12 * x.squaredNorm());
  }
}

TEST_F(ModelParts, ExpandFieldsAndSumMasses) {
  const PetscMat M = assemble_mass(parts, DofSet::Free, MassKind::Lumped);
  const OwnRows rows = find_own_rows(M.get());
  VectorXd q(parts.num_fdofs());
  for (Eigen::Index i = 0; i < q.size(); ++i) q(i) = std::cos(0.3 * static_cast<double>(i));
  const Reach reach = find_reach(parts);
  const VectorXd field = parts.T() * q, own = expand(parts, rows, reach, rows.take(q));
  EXPECT_LT((VectorXd(field(reach.gdofs)) - own).cwiseAbs().maxCoeff(), 1e-14);
  for (const auto& element : parts.elements())
    if (!parts.share() || parts.share()->is_owned(*element))
      for (const int g : element->gdofs()) ASSERT_GE(reach.find_row(g), 0);
  MatrixXd product = own.transpose() * calc_own_mass_times(parts, MassKind::Lumped, reach, own);
  sum_alike(product);
  EXPECT_NEAR(product(0, 0), field.dot(calc_mass_times(parts, MassKind::Lumped, field).col(0)), 1e-10 * product(0, 0));
  const auto a = calc_mass_properties(one, MassKind::Lumped, Vector3d::Zero()),
             b = calc_mass_properties(parts, MassKind::Lumped, Vector3d::Zero());
  EXPECT_NEAR(a.mass, b.mass, 1e-12 * a.mass);
  EXPECT_LT((a.rigid_mass - b.rigid_mass).cwiseAbs().maxCoeff(), 1e-11 * a.rigid_mass.cwiseAbs().maxCoeff());
  EXPECT_LT((calc_ground_check(one) - calc_ground_check(parts)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_F(ModelParts, HoldTheSameDofsAndSayTheSame) {
  ASSERT_EQ(parts.autospc().size(), one.autospc().size());
  EXPECT_GT(one.autospc().size(), 6u);
  for (std::size_t i = 0; i < one.autospc().size(); ++i) {
    EXPECT_EQ(parts.autospc()[i].node, one.autospc()[i].node);
    EXPECT_EQ(parts.autospc()[i].component, one.autospc()[i].component);
    EXPECT_EQ(parts.autospc()[i].is_skew, one.autospc()[i].is_skew);
    EXPECT_EQ(parts.autospc()[i].terms.size(), one.autospc()[i].terms.size());
  }
  EXPECT_EQ(list(made.said), list(whole.said));
  EXPECT_NE(list(made.said).find("[fe.autospc]"), std::string::npos);
  EXPECT_EQ(parts.has_card("CONROD"), true);
  EXPECT_EQ(parts.has_damping(), false);
}

TEST_F(ModelParts, DrawTheSameOnTheFirstRank) {
  const auto expected = one.calc_mesh(), found = parts.calc_mesh();
  if (initialize_petsc().rank != 0) return;
  ASSERT_EQ(found.blocks.size(), expected.blocks.size());
  for (std::size_t b = 0; b < found.blocks.size(); ++b) {
    EXPECT_EQ(found.blocks[b].type, expected.blocks[b].type);
    EXPECT_EQ(found.blocks[b].element_id, expected.blocks[b].element_id);
    EXPECT_EQ(found.blocks[b].connectivity, expected.blocks[b].connectivity);
  }
}

/// Errors of elements and constraints, in elements at one end only: the same words in the same order on every rank.
TEST(ModelPartsMessages, AreThoseOfOne) {
  const std::string last = std::to_string(grid(kLong, kWide)), first = std::to_string(grid(1, 0));
  for (const std::string& more :
       {"CROD,7001,77," + last + "," + first + "\n",                              // no such property
        "CQUAD4,7001,1," + last + "," + last + "," + first + "," + first + "\n",  // no area
        "CBAR,7001,9," + last + ",88888,0.,0.,1.\nRBE2,7002," + last + ",123,99999\n",
        "MAT1,5,-1.,,.3\nPSHELL,5,5,.1\nCTRIA3,7001,5," + last + "," + std::to_string(grid(kLong - 1, kWide)) + "," +
            std::to_string(grid(kLong - 1, kWide - 1)) + "\n",
        std::string("CONM2,7001,88888,,1.\nSPC1,1,123,77777\n")}) {
    const Made whole = make(write_strip(more), false), made = make(write_strip(more), true);
    EXPECT_FALSE(made.model);
    EXPECT_GT(made.said.num_errors(), 0);
    EXPECT_EQ(list(made.said), list(whole.said));
  }
}

TEST(ModelPartsMessages, OfMassesByDirectionNameTheFirstOfTheDeck) {
  std::string more;
  for (int i = 0; i < 8; ++i)
    more += "CMASS2," + std::to_string(7001 + i) + ",5.," + std::to_string(grid(3 * i + 1, 1)) + ",3\n";
  std::string said[2];
  for (const bool by_parts : {false, true}) {
    const Made made = make(write_strip(more), by_parts);
    ASSERT_TRUE(made.model);
    Diagnostics own, unsaid;
    const auto deck = nastran::read_deck_text(write_strip(more), "deck.bdf", {}, unsaid);
    report_mass(*made.model, deck, calc_mass_properties(*made.model, MassKind::Lumped, Vector3d::Zero()), own);
    said[by_parts ? 1 : 0] = list(own);
  }
  EXPECT_EQ(said[1], said[0]);
  EXPECT_NE(said[0].find("CMASS2 7005 and 3 more"), std::string::npos) << said[0];
}

/// What the parts do not do is done with the whole.
TEST(ModelPartsStayWhole, WithAnASetOrMassOfTheCaseControl) {
  EXPECT_FALSE(
      make(write_strip("ASET1,3," + std::to_string(grid(5, 2)) + "," + std::to_string(grid(9, 2)) + "\n"), true)
          .model->share());
  std::string text = write_strip("NSM1,5,PSHELL,1.,1\n");
  text.insert(text.find("BEGIN BULK"), "NSM = 5\n");
  const Made made = make(text, true);
  ASSERT_TRUE(made.model) << list(made.said);
  EXPECT_FALSE(made.model->share());
}

}  // namespace
}  // namespace bough::fe
