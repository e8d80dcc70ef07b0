// The .fem file of MBDyn: order of nodes, what is left out. Its numbers: tests/oracle/mbdyn_test.py.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/mbdyn/fem_file.hpp"
#include "tests/formats/sid/point_masses.hpp"

namespace bough::test {
namespace {

TEST(Fem, InterfaceNodesComeFirst) {
  auto body = make_body(make_points(3, 2, 1));
  body.interface_nodes = {3};
  EXPECT_EQ(mbdyn::order_nodes(body), (std::vector<int>{3, 1, 2}));
  Diagnostics diagnostics;
  const auto text = mbdyn::make_fem(body, {"body.h5"}, diagnostics);
  EXPECT_THAT(text, testing::HasSubstr("NODE LIST\n3 1 2\n"));
  // The locators stand at node 1, which is no interface node now.
  ASSERT_TRUE(diagnostics.has("export.dropped-loads"));
  EXPECT_THAT(diagnostics.items()[0].what, testing::HasSubstr("\"node1_1\", \"node1_2\", \"node1_3\""));
}

TEST(Fem, UnitLoadsAreCountedPerInterfaceNode) {
  const auto body = make_body(make_points(3, 1, 1), 1, true);
  Diagnostics diagnostics;
  const auto text = mbdyn::make_fem(body, {"body.h5"}, diagnostics);
  EXPECT_TRUE(diagnostics.items().empty());
  EXPECT_THAT(text, testing::HasSubstr("MODAL STRESS STIFFENING MATRIX\n18\n1\n"));
  EXPECT_THAT(text, testing::HasSubstr("\n18\n"));
}

TEST(Fem, WhatIsNotComputedIsAbsent) {
  auto body = make_body(make_points(3, 1, 1));
  body.kg_inertial_computed.fill(false);
  body.kg_inertial_computed[8] = true;
  body.locators.clear();
  body.kg_external.clear();
  Diagnostics diagnostics;
  const auto text = mbdyn::make_fem(body, {"body.h5"}, diagnostics);
  EXPECT_TRUE(diagnostics.has("export.no-stiffening"));
  EXPECT_THAT(text, testing::HasSubstr("MODAL STRESS STIFFENING MATRIX\n1\n3\n"));
  body.kg_inertial_computed.fill(false);
  EXPECT_THAT(mbdyn::make_fem(body, {"body.h5"}, diagnostics), testing::Not(testing::HasSubstr("GROUP 19")));
  body.exact = {};
  EXPECT_THROW(mbdyn::make_fem(body, {"body.h5"}, diagnostics), InputError);
}

}  // namespace
}  // namespace bough::test
