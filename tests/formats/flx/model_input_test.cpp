/// MODEL.inp and MATRICES.mat: what the example files hold, and each fault with its line and item.
#include "formats/flx/model_input.hpp"

#include <gmock/gmock.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/support/paths.hpp"

namespace bough::flx {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string read_text(const std::string& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class ModelInputTest : public testing::Test {
 protected:
  const std::string data_ = std::string(BOUGH_SOURCE_DIR) + "/data/integrals/";
  std::string inp_ = read_text(data_ + "test.inp"), mat_ = read_text(data_ + "test.mat");
  Diagnostics diagnostics_;

  std::string write(const std::string& name, const std::string& text) {
    const auto path = testing::TempDir() + "/bough-flx-" + std::to_string(getpid()) + "-" + name;
    std::ofstream(path) << text;
    files_.push_back(path);
    return path;
  }
  void TearDown() override {
    for (const auto& file : files_) std::filesystem::remove(file);
  }

  static std::string replace(std::string text, const std::string& old, const std::string& by) {
    const auto at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return text.replace(at, old.size(), by);
  }

  ModelInput read(const std::string& text) { return read_model_input(write("model.inp", text), diagnostics_); }

  /// The example with one change fails with the id, at the line, saying the words.
  void expect_fault(const std::string& old, const std::string& by, const std::string& id, int line,
                    const std::string& says) {
    diagnostics_ = {};
    read(replace(inp_, old, by));
    ASSERT_GE(diagnostics_.items().size(), 1u) << by;
    const auto& first = diagnostics_.items()[0];
    EXPECT_EQ(first.id, id) << format(first);
    EXPECT_EQ(first.where.line, line) << format(first);
    EXPECT_THAT(first.what, HasSubstr(says));
  }

  std::vector<std::string> files_;
};

TEST_F(ModelInputTest, ReadsTheExample) {
  const auto model = read(inp_);
  EXPECT_TRUE(diagnostics_.items().empty());
  EXPECT_EQ(model.num_nodes, 2);
  EXPECT_EQ(model.num_dofs, 5);
  EXPECT_EQ(model.num_modes_given, 2);
  Eigen::MatrixXi dof_map(5, 2);
  dof_map << 1, 1, 1, 2, 2, 1, 2, 2, 2, 6;
  EXPECT_EQ(model.dof_map, dof_map);
  EXPECT_EQ(model.offset, Eigen::Vector3d(-1, 0, 0));
  EXPECT_EQ(model.xyz.row(1), Eigen::RowVector3d(1, 0, 0));
  EXPECT_EQ(model.body_id, 7);
  EXPECT_EQ(model.modopt, 0);
  EXPECT_EQ(model.mass, 4);
  EXPECT_EQ(model.damping_option, 1);
  EXPECT_THAT(model.modes, ElementsAre(1, 2));
  EXPECT_THAT(model.nodes, ElementsAre(1, 2));
  EXPECT_TRUE(model.has_special_nodes);

  const auto matrices = read_model_matrices(write("model.mat", mat_), model, diagnostics_);
  EXPECT_TRUE(diagnostics_.items().empty());
  EXPECT_EQ(Eigen::VectorXd(Eigen::MatrixXd(matrices.M).diagonal()),
            (Eigen::VectorXd(5) << 2, 2, 1, 1, 0.5).finished());
  EXPECT_EQ(matrices.M.nonZeros(), 5);
  EXPECT_EQ(matrices.K.coeff(2, 0), -2);
  EXPECT_EQ(matrices.D.coeff(4, 4), 0.2);
  EXPECT_EQ(Eigen::VectorXd(matrices.Phi.col(0)), (Eigen::VectorXd(5) << 0, 1, 0, 2, 1).finished());
}

TEST_F(ModelInputTest, ReadsEveryOption) {
  auto text = replace(inp_, "2, 5, 2 ", "2, 5, 3 ");
  text = replace(text, "2 6\n", "0 7\n");
  text = replace(text, "0                  ! integrals", "2                  ! integrals");
  text = replace(text, "1                  ! damping", "2\n0.005 !");
  text = replace(text, "1                  ! 1 the first ones, 2 by a list", "2\n1\n3");
  text = replace(text, "2                  ! nodes to output\n1\n2", "0");
  text = replace(text, "2                  ! special", "1                  ! special");
  const auto model = read(text);
  EXPECT_TRUE(diagnostics_.items().empty());
  EXPECT_EQ(model.dof_map(4, 1), kGeneralizedDof);
  EXPECT_EQ(model.modopt, 2);
  EXPECT_EQ(model.zeta, 0.005);
  EXPECT_THAT(model.modes, ElementsAre(1, 3));
  EXPECT_TRUE(model.nodes.empty());
  EXPECT_FALSE(model.has_special_nodes);
}

TEST_F(ModelInputTest, EveryFaultHasItsLineAndItem) {
  expect_fault("2, 5, 2 ", "0, 5, 2 ", "flx.wrong-size", 1, "item 1 of 15: sizes (nodes, dofs, modes): found 0 5 2");
  expect_fault("2, 5, 2 ", "2, 5, 6 ", "flx.wrong-size", 1, "found 2 5 6");
  expect_fault("2 2\n2 6", "2 2\n2 8", "flx.bad-dof", 6, "item 2 of 15: degree-of-freedom map: entry 5 has the type 8");
  expect_fault("2 2\n2 6", "2 2\n3 6", "flx.unknown-node", 6, "entry 5 is at node 3, the model has 1 to 2");
  expect_fault("2 2\n2 6", "2 2\n2 2", "flx.duplicate-dof", 6, "entry 5 is node 2 type 2 again");
  expect_fault("-1.0 2*0.0", "-1.0 x 0", "flx.bad-number", 7, "item 3 of 15: offset vector: value 2 of 3");
  expect_fault("0                  ! integrals", "3 !", "flx.bad-option", 11,
               "item 6 of 15: modal integral option: found 3");
  expect_fault("4.0                ! mass", "0.0 !", "flx.bad-value", 12, "item 7 of 15: body mass: found 0");
  expect_fault("1                  ! damping", "0 !", "flx.bad-option", 13, "item 8 of 15: damping option: found 0");
  expect_fault("1                  ! damping", "2\n-1 !", "flx.bad-value", 14, "item 9 of 15: damping ratio: found -1");
  expect_fault("2                  ! modes to output", "3 !", "flx.too-many-modes", 14,
               "item 10 of 15: number of modes: found 3, the modes given are 2");
  expect_fault("1                  ! 1 the first", "4 !", "flx.bad-option", 15, "item 11 of 15: mode selection flag");
  expect_fault("1                  ! 1 the first ones, 2 by a list", "2\n2\n1", "flx.bad-selection", 17,
               "item 12 of 15: mode selection: entry 2 is mode 1 after mode 2");
  expect_fault("1                  ! 1 the first ones, 2 by a list", "2\n1\n3", "flx.bad-selection", 17,
               "entry 2 is mode 3, the modes given are 1 to 2");
  expect_fault("2                  ! nodes to output", "3 !", "flx.too-many-nodes", 16, "item 13 of 15");
  expect_fault("output\n1\n2\n", "output\n1\n5\n", "flx.unknown-node", 18,
               "item 14 of 15: output nodes: entry 2 is node 5");
  expect_fault("output\n1\n2\n", "output\n2\n1\n", "flx.node-order", 18, "entry 2 is node 1 after node 2");
  expect_fault("2                  ! special", "0 !", "flx.bad-option", 19,
               "item 15 of 15: special node option: found 0");
  expect_fault("2                  ! special nodes: 1 no, 2 yes\n", "", "flx.short-file", 18, "item 15 of 15");
}

TEST_F(ModelInputTest, FaultsAreReportedTogether) {
  auto text = replace(inp_, "2 2\n2 6", "2 9\n5 6");
  text = replace(text, "4.0                ! mass", "-4.0 !");
  read(text);
  EXPECT_EQ(diagnostics_.num_errors(), 3);
}

TEST_F(ModelInputTest, AFileCutAnywhereIsShort) {
  for (std::size_t end = inp_.find("2, 5, 2") + 3; end + 48 < inp_.size(); end += 7) {
    diagnostics_ = {};
    read(inp_.substr(0, end));
    EXPECT_GT(diagnostics_.num_errors(), 0) << end;
  }
}

TEST_F(ModelInputTest, LeftoversAreReported) {
  read(replace(inp_, "1 1  ", "1 1 4  ") + "12\n");
  EXPECT_TRUE(diagnostics_.has("flx.extra-values"));
  EXPECT_TRUE(diagnostics_.has("flx.trailing-data"));
  EXPECT_EQ(diagnostics_.num_errors(), 0);
}

TEST_F(ModelInputTest, MatricesTooShortNameItemAndRow) {
  const auto model = read(inp_);
  read_model_matrices(write("short.mat", replace(mat_, "0 1\n1 0\n0 1\n2 0\n1 0\n", "0 1\n1 0\n0 1\n2 0\n")), model,
                      diagnostics_);
  ASSERT_EQ(diagnostics_.num_errors(), 1);
  EXPECT_EQ(diagnostics_.items()[0].id, "flx.short-file");
  EXPECT_THAT(diagnostics_.items()[0].what, HasSubstr("item 4 of 4: mode shapes, row 5 of 5"));

  // A value missing in the stiffness matrix: the message points to its row.
  diagnostics_ = {};
  read_model_matrices(write("gap.mat", replace(mat_, "-2  0  4  0 0", "-2  0  4  0")), model, diagnostics_);
  ASSERT_EQ(diagnostics_.num_errors(), 1);
  EXPECT_THAT(diagnostics_.items().back().advice, HasSubstr("item 2 of 4: stiffness matrix, row 3 of 5 took 2 lines"));
}

TEST_F(ModelInputTest, AnUnsymmetricMatrixIsUsedWithAWarning) {
  const auto model = read(inp_);
  const auto matrices =
      read_model_matrices(write("skew.mat", replace(mat_, " 6  0 -2  0 0", " 6  0 -1  0 0")), model, diagnostics_);
  EXPECT_TRUE(diagnostics_.has("flx.unsymmetric"));
  EXPECT_EQ(matrices.K.coeff(0, 2), -1);
  EXPECT_EQ(matrices.K.coeff(2, 0), -2);
}

TEST_F(ModelInputTest, AFileThatIsNotThere) {
  try {
    read_model_input("no-such.inp", diagnostics_);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.items()[0].id, "flx.cannot-read");
  }
}

}  // namespace
}  // namespace bough::flx
