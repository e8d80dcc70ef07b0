// Universal files, read back by tests/oracle/uff_reader.py.
#include "formats/export/uff.hpp"

#include <gtest/gtest.h>

#include "tests/support/paths.hpp"
#include "tests/support/temp_folder.hpp"

namespace bough {
namespace {

using test::TempFolder;

int check(const TempFolder& folder, const std::string& text, const std::string& code) {
  const auto path = folder.write("x.uff", text);
  const auto program = folder.write("check.py", "import sys; sys.path.insert(0, '" BOUGH_SOURCE_DIR
                                                "/tests/oracle'); sys.dont_write_bytecode = True\n"
                                                "import numpy as np, uff_reader\nsets = uff_reader.read('" +
                                                    path + "')\n" + code);
  return test::run_python(program);
}

records::ModesResult make_modes(int num_columns) {
  records::ModesResult modes;
  modes.source = {{"plate.bdf", ""}};
  modes.subcase = 3;
  modes.node_id = {10, 20, 40};
  modes.node_xyz.resize(3, 3);
  modes.node_xyz << 0, 0, 0, 1.5, 0, 0, 0, -2.25, 1e-3;
  for (int k = 0; k < 3; ++k) {
    Eigen::MatrixXd phi(6, num_columns);
    for (int c = 0; c < 6; ++c)
      for (int j = 0; j < num_columns; ++j) phi(c, j) = (k + 1) * 0.5 - c * 1.25 + j * 100;
    modes.phi.push_back(phi);
  }
  return modes;
}

TEST(Uff, ModesAndGeometry) {
  const TempFolder folder;
  auto modes = make_modes(2);
  modes.frequency_hz = Eigen::Vector2d(1.25, 33.5);
  modes.modal_mass = Eigen::Vector2d(1, 2);
  modes.mesh.grid_id = {10, 20, 30, 40};
  modes.mesh.grid_xyz.resize(4, 3);
  modes.mesh.grid_xyz << 0, 0, 0, 1.5, 0, 0, 1.5, -2.25, 0, 0, -2.25, 1e-3;
  modes.mesh.blocks = {{"quad4", Eigen::RowVector4i(0, 1, 2, 3), {1}}, {"line2", Eigen::RowVector2i(0, 2), {2}}};
  EXPECT_EQ(check(folder, exports::make_uff(modes), R"(
assert [s['dataset'] for s in sets] == [15, 82, 55, 55]
assert sets[0]['id'] == [10, 20, 30, 40] and (sets[0]['xyz'][3] == [0, -2.25, 1e-3]).all()
edges, last = set(), 0
for node in sets[1]['nodes']:
    if node and last: edges.add((last, node))
    last = node
assert edges == {(10, 20), (20, 30), (30, 40), (10, 40), (10, 30)}, edges
for j, s in enumerate(sets[2:]):
    assert s['model'] == 'plate.bdf' and s['analysis'] == 2 and s['parameters'] == [3, j + 1], s
    assert s['reals'] == [[1.25, 1, 0, 0], [33.5, 2, 0, 0]][j] and s['id'] == [10, 20, 40]
    expected = np.array([[(k + 1) * .5 - c * 1.25 + j * 100 for c in range(6)] for k in range(3)])
    assert (s['shape'] == expected).all()
)"),
            0);
}

TEST(Uff, BucklingAndBodies) {
  const TempFolder folder;
  auto modes = make_modes(1);
  modes.load_factor = Eigen::VectorXd::Constant(1, 4.32);
  EXPECT_EQ(check(folder, exports::make_uff(modes),
                  "assert [s['dataset'] for s in sets] == [15, 55]\n"
                  "assert sets[1]['analysis'] == 6 and sets[1]['parameters'] == [3] and sets[1]['reals'] == [4.32]\n"),
            0);
  records::FlexBody body;
  body.name = "boom";
  body.node_id = modes.node_id;
  body.node_xyz = modes.node_xyz;
  body.phi = modes.phi;
  body.frequency_hz = body.eigenvalue = Eigen::VectorXd::Constant(1, 9);
  body.modal_mass = Eigen::MatrixXd::Constant(1, 1, 4);
  body.modal_stiffness = Eigen::MatrixXd::Constant(1, 1, 25);
  body.modal_damping = Eigen::MatrixXd::Constant(1, 1, 0.4);
  EXPECT_EQ(check(folder, exports::make_uff(body),
                  "assert sets[1]['model'] == 'boom' and sets[1]['reals'] == [9, 4, .02, 0], sets[1]\n"),
            0);
}

TEST(Uff, LongTraceLinesAreCut) {
  const TempFolder folder;
  auto modes = make_modes(1);
  modes.frequency_hz = Eigen::VectorXd::Ones(1);
  Eigen::MatrixXi lines(300, 2);
  modes.mesh.grid_xyz = Eigen::MatrixXd::Zero(600, 3);
  for (int i = 0; i < 600; ++i) modes.mesh.grid_id.push_back(i + 1);
  for (int i = 0; i < 300; ++i) lines.row(i) << 2 * i, 2 * i + 1;
  modes.mesh.blocks = {{"line2", lines, std::vector<int>(300, 1)}};
  EXPECT_EQ(check(folder, exports::make_uff(modes), R"(
traces = [s for s in sets if s['dataset'] == 82]
assert [t['number'] for t in traces] == list(range(1, len(traces) + 1)) and len(traces) == 4
assert sum(len(t['nodes']) for t in traces) == 900
)"),
            0);
}

TEST(Uff, FunctionsOfEvenAndUnevenTime) {
  const TempFolder folder;
  const int n = 7;
  const Eigen::VectorXd even = Eigen::VectorXd::LinSpaced(n, 0.5, 0.5 + 6 * 0.125), value = even.array().square() / 3;
  Eigen::VectorXd uneven = even;
  uneven(3) += 0.0625;
  for (const bool is_even : {true, false})
    EXPECT_EQ(check(folder, exports::make_uff({{"time", is_even ? even : uneven}, {"tip:x", value}, {"tip:y", -value}}),
                    std::string("time = np.array([0.5 + 0.125 * i + ") + (is_even ? "0" : "0.0625 * (i == 3)") +
                        " for i in range(7)])\n" + R"(
assert [s['name'] for s in sets] == ['tip:x', 'tip:y'] and [s['number'] for s in sets] == [1, 2]
expected = (0.5 + 0.125 * np.arange(7)) ** 2 / 3
for s, sign in zip(sets, (1, -1)):
    assert (s['time'] == time).all() and np.allclose(s['values'], sign * expected, rtol=1e-12, atol=0)
)"),
              0);
}

}  // namespace
}  // namespace bough
