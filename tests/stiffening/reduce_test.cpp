/// The whole way from a deck to a flexible body: what the record holds, and its errors.
#include "bough/stiffening/reduce.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/beam_decks.hpp"

namespace bough {
namespace {

using records::BodyFrame;
using records::BodySpec;
using records::InertialLoad;

BodySpec make_spec(int num_modes) {
  BodySpec spec;
  spec.file = "beam.toml";
  spec.name = "beam";
  spec.num_modes = num_modes;
  return spec;
}

records::FlexBody reduce(const records::Deck& deck, const BodySpec& spec) {
  Diagnostics diagnostics;
  return stiffening::reduce(deck, spec, {}, diagnostics);
}

TEST(Reduce, CantileverRecordIsComplete) {
  const auto maker = test::make_cantilever(test::get_report_section(), test::kReportLength, 40);
  auto spec = make_spec(6);
  spec.interface_nodes = {41};
  const auto body = reduce(maker.deck, spec);
  EXPECT_NEAR(body.mass, 1.6154, 1e-4);
  for (int j = 0; j < 6; ++j)
    std::printf("%.5f %.5f  kwz2 %.6f\n", body.frequency_hz(j), std::sqrt(body.eigenvalue(j)), body.kg_inertial[8](j, j));
}

}  // namespace
}  // namespace bough
