// What `reduce` says of the modal matrices, where they are right and where they have been spoiled.
#include "stiffening/basis_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fe/statics/build_model.hpp"
#include "stiffening/reduce.hpp"
#include "tests/support/beam_decks.hpp"

namespace bough {
namespace {

struct ReducedBeam {
  records::FlexBody body;
  stiffening::BasisCheck check;
  Diagnostics said;
};

ReducedBeam reduce_beam(bool is_free) {
  const auto maker = test::make_cantilever(test::get_report_section(), test::kReportLength, 20);
  records::BodySpec spec;
  spec.file = "beam.toml";
  spec.name = "beam";
  spec.num_modes = 4;
  spec.full = true;
  if (is_free) spec.frame = records::BodyFrame::Free;
  ReducedBeam reduced;
  auto result = stiffening::reduce(maker.deck, spec, {}, reduced.said);
  reduced.body = std::move(result.body);
  reduced.check = std::move(result.check);
  return reduced;
}

TEST(BasisCheck, ABodyStatesHowFarItsModalMatricesAreFromItsShapes) {
  for (const bool is_free : {false, true}) {
    const auto reduced = reduce_beam(is_free);
    EXPECT_LT(reduced.check.mass, 1e-10);
    EXPECT_LT(reduced.check.stiffness, 1e-6);
    EXPECT_FALSE(reduced.said.has("reduce.basis-off"));
  }
}

TEST(BasisCheck, ASpoiledMatrixIsTold) {
  const auto reduced = reduce_beam(false);
  const auto maker = test::make_cantilever(test::get_report_section(), test::kReportLength, 20);
  Diagnostics diagnostics;
  const auto model = fe::build_model(maker.deck, {}, diagnostics);
  auto K = reduced.body.modal_stiffness, M = reduced.body.modal_mass;
  K(0, 1) += 1e-4 * std::sqrt(K(0, 0) * K(1, 1));
  M(2, 2) *= 1.0005;
  const auto check = stiffening::check_basis(model, reduced.body.full_phi, M, K);
  EXPECT_NEAR(check.mass, 0.0005 / 1.0005, 1e-6);
  EXPECT_NEAR(check.stiffness, 1e-4, 1e-6);
  stiffening::report_basis(check, {}, diagnostics);
  EXPECT_TRUE(diagnostics.has("reduce.basis-off"));
  // What is known to be wrong, not by round-off, ends it.
  for (auto* A : {&K, &M}) {
    const auto before = *A;
    (*A)(2, 2) *= 1.01;
    EXPECT_THROW(stiffening::report_basis(stiffening::check_basis(model, reduced.body.full_phi, M, K), {}, diagnostics),
                 ComputationError);
    *A = before;
  }
  K(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(stiffening::report_basis(stiffening::check_basis(model, reduced.body.full_phi, M, K), {}, diagnostics),
               ComputationError);
}

}  // namespace
}  // namespace bough
