// Each format that holds matrices: hand-written files, files written by SciPy, and every fault with its id.
#include <fstream>
#include <sstream>

#include "formats/matrices/matrix_market.hpp"
#include "formats/matrices/op4.hpp"
#include "tests/formats/matrices/matrix_cases.hpp"

namespace bough {
namespace {

using matrices::Matrix;
using namespace test;

const Matrix kSymmetric3 = make_matrix("", 3, 3, {{0, 0, 4.0}, {0, 1, -1.5}, {1, 0, -1.5}, {1, 1, 5.0}, {2, 2, 6.25}});

std::vector<std::pair<int, int>> list_dofs(const Eigen::MatrixXi& dofs) {
  std::vector<std::pair<int, int>> list;
  for (Eigen::Index i = 0; i < dofs.rows(); ++i) list.emplace_back(dofs(i, 0), dofs(i, 1));
  return list;
}

class Readers : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const { return folder_.write(name, text); }
  std::string error_of(const std::string& text) const { return read_error(write("x.txt", text)); }
  const TempFolder folder_;
};

TEST_F(Readers, MatrixMarketOfEveryKind) {
  const std::string banner = "%%MatrixMarket matrix ";
  const auto read = [&](const std::string& text) { return read_one(write("m.mtx", banner + text)); };
  expect_same(read("coordinate real symmetric\n% comment\n\n3 3 4\n1 1 4.0\n2 1 -1.5\n2 2 5d0\n3 3 6.25\n"),
              kSymmetric3);
  expect_same(read("coordinate integer general\n2 3 2\n2 3 -7\n1 1 2\n"),
              make_matrix("", 2, 3, {{0, 0, 2.0}, {1, 2, -7.0}}));
  expect_same(read("coordinate real skew-symmetric\n2 2 1\n2 1 3.5\n"),
              make_matrix("", 2, 2, {{0, 1, -3.5}, {1, 0, 3.5}}));
  expect_same(read("coordinate complex hermitian\n2 2 2\n1 1 1 0\n2 1 2 3\n"),
              make_matrix("", 2, 2, {{0, 0, 1.0, 0.0}, {0, 1, 2.0, -3.0}, {1, 0, 2.0, 3.0}}, true));
  expect_same(read("array real general\n2 2\n1\n3\n2\n4\n"),
              make_matrix("", 2, 2, {{0, 0, 1.0}, {0, 1, 2.0}, {1, 0, 3.0}, {1, 1, 4.0}}));
  expect_same(read("array real symmetric\n2 2\n1\n2\n3\n"),
              make_matrix("", 2, 2, {{0, 0, 1.0}, {0, 1, 2.0}, {1, 0, 2.0}, {1, 1, 3.0}}));
  expect_same(read("array real skew-symmetric\n2 2\n5\n"), make_matrix("", 2, 2, {{0, 1, -5.0}, {1, 0, 5.0}}));
  // Entries of one place add up.
  expect_same(read("coordinate real general\n1 1 2\n1 1 1.5\n1 1 2.5\n"), make_matrix("", 1, 1, {{0, 0, 4.0}}));
}

TEST_F(Readers, MatrixMarketFaults) {
  const std::string banner = "%%MatrixMarket matrix ";
  for (const auto& [rest, id] : std::vector<std::pair<std::string, std::string>>{
           {"coordinate pattern general\n1 1 1\n1 1\n", "matrices.market"},
           {"coordinate real symmetric\n2 3 0\n", "matrices.market"},
           {"coordinate real general\n1 1 1\n1 1 1\n1 1 1\n", "matrices.market"},
           {"coordinate real general\n2 2 2\n1 1 1.0\n", "matrices.truncated"},
           {"coordinate real general\n2 2 1\n3 1 1.0\n", "matrices.index"},
           {"coordinate real general\n2 2 1\n1 1 one\n", "matrices.bad-number"},
           {"coordinate real general\n2000000000 2 1\n1 1 1\n", "matrices.size"},
           {"coordinate real general\n2 2 99999999999\n", "matrices.truncated"},
       })
    EXPECT_EQ(error_of(banner + rest), id) << rest;
}

TEST_F(Readers, MatrixMarketOfSciPyAndForSciPy) {
  std::ostringstream text;
  matrices::write_matrix_market(text, kSymmetric3.values, "test");
  const auto ours = write("ours.mtx", text.str());
  ASSERT_EQ(run_python("-c \"import scipy.io as io, scipy.sparse as sp; a=io.mmread('" + ours + "').toarray(); " +
                       "assert a.tolist()==[[4,-1.5,0],[-1.5,5,0],[0,0,6.25]], a; io.mmwrite('" +
                       folder_.at("theirs.mtx") + "', sp.csr_matrix(a), precision=17)\""),
            0);
  expect_same(read_one(ours), kSymmetric3);
  expect_same(read_one(folder_.at("theirs.mtx")), kSymmetric3);
}

TEST_F(Readers, DmigPunch) {
  const auto path = write("k.pch",
                          "$TITLE   = OUR OWN\n"
                          "DMIG    KAAX           0       6       2       0                       4\n"
                          "DMIG*   KAAX                           7               1\n"
                          "*                      7               1 4.000000000D+00\n"
                          "DMIG*   KAAX                           7               2\n"
                          "*                      7               1-1.500000000D+00\n"
                          "*                      7               2 5.000000000D+00\n"
                          "DMIG*   KAAX                          12               0\n"
                          "*                     12               0 6.250000000D+00\n"
                          "DMIG    RECT           0       9       1       0                       2\n"
                          "DMIG    RECT           2       0               7       1      3.\n");
  const auto k = read_one(path, "KAAX");
  expect_same(k, kSymmetric3);
  EXPECT_EQ(k.form, matrices::kSymmetric);
  EXPECT_EQ(list_dofs(k.row_dofs), (std::vector<std::pair<int, int>>{{7, 1}, {7, 2}, {12, 0}}));
  const auto rect = read_one(path, "RECT");
  expect_same(rect, make_matrix("RECT", 1, 2, {{0, 1, 3.0}}));
  EXPECT_EQ(read_error(path, ""), "matrices.several");
  EXPECT_EQ(read_error(path, "KAAY"), "matrices.unknown-name");
  EXPECT_EQ(read_error(write("bad.pch",
                             "DMIG    K              0       9       1       0\n"
                             "DMIG    K       99999999       0               7       1      3.\n")),
            "matrices.size");
  EXPECT_EQ(read_error(write("none.pch", "DMIG    K              1       1               7       1      3.\n")),
            "deck.missing-header");
}

TEST_F(Readers, CalculixTripletsAndDofs) {
  const auto path = write("job.sti",
                          "1 1  4.0000000000000e+00\n1 2 -1.5000000000000e+00\n2 2  5.0000000000000e+00\n"
                          "3 3  6.2500000000000e+00\n");
  expect_same(read_one(path, "K"), kSymmetric3);
  EXPECT_FALSE(read_one(path).has_dofs());
  write("job.dof", "11.1\n11.2\n12.3\n14.1\n");
  const auto k = read_one(path);
  // The list may name dofs that no entry has.
  EXPECT_EQ(k.values.num_rows, 4);
  EXPECT_EQ(list_dofs(k.row_dofs), (std::vector<std::pair<int, int>>{{11, 1}, {11, 2}, {12, 3}, {14, 1}}));
  write("job.dof", "11.1\n11.2\n");
  EXPECT_EQ(read_error(path), "matrices.dof");
  write("job.dof", "11.1\n11.2\n11.x\n");
  EXPECT_EQ(read_error(path), "matrices.dof");
  EXPECT_EQ(error_of("1 1 2.0\n1 2\n"), "matrices.bad-number");
  EXPECT_EQ(error_of("1 1 2.0\n0 2 1.0\n"), "matrices.index");
}

TEST_F(Readers, AbaqusMatrixText) {
  const auto labels = write("job_STIF1.mtx",
                            "** comment\n*MATRIX INPUT, NAME=K\n20,2, 20,2,  5.0\n20,1, 20,2, -1.5\n20,1, 20,1, 4.0\n"
                            "31,6, 31,6, 6.25\n");
  const auto k = read_one(labels);
  expect_same(k, kSymmetric3);
  EXPECT_EQ(list_dofs(k.row_dofs), (std::vector<std::pair<int, int>>{{20, 1}, {20, 2}, {31, 6}}));
  expect_same(read_one(write("c.mtx", "1, 1, 4.0\n2, 1, -1.5\n2, 2, 5.0\n3, 3, 6.25\n")), kSymmetric3);
  expect_same(read_one(write("u.mtx", "*MATRIX INPUT, NAME=C, TYPE=UNSYMMETRIC\n1,1, 1,2, 2.5\n1,1,1,1,1.\n")),
              make_matrix("", 2, 2, {{0, 0, 1.0}, {0, 1, 2.5}}));
  EXPECT_EQ(error_of("20,11, 20,11, 5.0\n"), "matrices.dof");
  EXPECT_EQ(error_of("-3,1, -3,1, 5.0\n"), "matrices.dof");
  EXPECT_EQ(error_of("20,1, 20,1, 5.0\n20,1,5.0\n"), "matrices.bad-number");
}

TEST_F(Readers, HarwellBoeingAndAnsysMapping) {
  const auto make = [](const std::string& type, const std::string& size, const std::string& values) {
    return "Stiffness                                                               KEY     \n"
           "             6             1             1             3             1\n" +
           type + "                  " + size +
           "\n(4I4)           (10I4)          (2D20.12)           (1D20.12)\n"
           "F                          1             0\n   1   3   4   5\n   1   2   2   3\n" +
           values;
  };
  const std::string values = "  0.400000000000D+01 -0.150000000000D+01\n  0.500000000000D+01  0.625000000000D+01\n";
  const auto path = write("job.matrix", make("RSA", "3             3             4             0", values));
  EXPECT_EQ(matrices::detect_format(path), matrices::Format::HarwellBoeing);
  expect_same(read_one(path), kSymmetric3);
  expect_same(read_one(write("u.matrix", make("RUA", "3             3             4             0", values))),
              make_matrix("", 3, 3, {{0, 0, 4.0}, {1, 0, -1.5}, {1, 1, 5.0}, {2, 2, 6.25}}));
  write("job.mapping", "   Matrix Eqn    Node   DOF\n  1   8  UX\n  2   8  ROTZ\n  3   9  UY\n");
  EXPECT_EQ(list_dofs(read_one(path).row_dofs), (std::vector<std::pair<int, int>>{{8, 1}, {8, 6}, {9, 2}}));
  write("job.mapping", "  1   8  UX\n  2   8  TEMP\n");
  EXPECT_EQ(read_error(path), "matrices.dof");
  write("job.mapping", "  1   8  UX\n  3   8  UY\n");
  EXPECT_EQ(read_error(path), "matrices.dof");
  EXPECT_EQ(error_of(make("PSA", "3 3 4 0", "")), "matrices.hb-type");
  EXPECT_EQ(error_of(make("RSE", "3 3 4 0", "")), "matrices.hb-type");
  EXPECT_EQ(error_of(make("RSA", "3 3 400000000 0", values)), "matrices.size");
  EXPECT_EQ(error_of(make("RSA", "3 3 5 0", values)), "matrices.index");
  EXPECT_EQ(error_of(make("RSA", "2 3 4 0", values)), "matrices.hb-type");
  EXPECT_EQ(error_of(make("RUA", "2 3 4 0", values)), "matrices.index");
  EXPECT_EQ(error_of(make("RSA", "3 3 4 0", values.substr(0, 23) + "x\n")), "matrices.bad-number");
  EXPECT_EQ(error_of(make("RSA", "3 3 4 0", "")), "matrices.truncated");
  auto bad = make("RSA", "3 3 4 0", values);
  bad.replace(bad.find("(10I4)"), 6, "(what)");
  EXPECT_EQ(error_of(bad), "matrices.hb-format");
}

TEST_F(Readers, HarwellBoeingOfSciPy) {
  const auto path = folder_.at("s.rb");
  ASSERT_EQ(run_python("-c \"import scipy.io as io, scipy.sparse as sp; io.hb_write('" + path +
                       "', sp.csc_matrix([[4,-1.5,0],[-1.5,5,0],[0,0,6.25]]))\""),
            0);
  expect_same(read_one(path), kSymmetric3);
}

TEST_F(Readers, Hdf5OfSciPy) {
  const auto path = folder_.at("k.h5");
  const std::string code =
      "import h5py, numpy as np, scipy.sparse as sp\n"
      "k = sp.csr_matrix([[4,-1.5,0],[-1.5,5,0],[0,0,6.25]])\n"
      "def put(g, m, **more):\n"
      "    for n, v in dict(dict(data=m.data, indices=m.indices.astype('i8'), indptr=m.indptr.astype('i8'), "
      "shape=np.array(m.shape)), **more).items(): g[n] = v\n"
      "with h5py.File('" +
      path +
      "', 'w') as f:\n"
      "    put(f.create_group('system/K'), k); put(f.create_group('M'), k.astype('f4'))\n"
      "    f['dof_map'] = np.array([[1,1],[1,2],[2,1]])\n"
      "with h5py.File('" +
      path +
      "1', 'w') as f: put(f, k, indices=np.array([0,1,0,7,2]))\n"
      "with h5py.File('" +
      path +
      "2', 'w') as f: put(f, k, indptr=np.array([0,2,4,6]))\n"
      "with h5py.File('" +
      path + "3', 'w') as f: f['other'] = 1.0\n";
  ASSERT_EQ(run_python(folder_.write("make.py", code)), 1 - 1);
  const auto k = read_one(path, "system/k");
  expect_same(k, kSymmetric3);
  EXPECT_EQ(list_dofs(k.row_dofs), (std::vector<std::pair<int, int>>{{1, 1}, {1, 2}, {2, 1}}));
  expect_same(read_one(path, "M"), kSymmetric3);
  EXPECT_EQ(read_error(path + "1"), "hdf5.value");
  EXPECT_EQ(read_error(path + "2"), "hdf5.value");
  EXPECT_EQ(read_error(path + "3"), "matrices.empty");
}

TEST_F(Readers, RealAndSquareWhereAsked) {
  std::ostringstream text;
  matrices::write_op4(text, make_matrix("C", 2, 2, {{0, 0, 1.0, 2.0}}, true), {});
  matrices::write_op4(text, make_matrix("Z", 2, 2, {{0, 0, 1.0, 0.0}}, true), {});
  matrices::write_op4(text, make_matrix("R", 2, 3, {{0, 0, 1.0}}), {});
  const auto path = write("m.op4", text.str());
  Diagnostics diagnostics;
  const auto read = [&](const char* name) { return matrices::read_real_square_matrix(path, name, diagnostics); };
  EXPECT_EQ(find_error([&] { read("C"); }), "matrices.complex");
  EXPECT_EQ(find_error([&] { read("R"); }), "matrices.not-square");
  expect_same(read("z"), make_matrix("Z", 2, 2, {{0, 0, 1.0}}));
}

TEST_F(Readers, FilesThatHoldNoMatrix) {
  EXPECT_EQ(read_error(folder_.at("absent")), "matrices.cannot-open");
  EXPECT_EQ(read_error(folder_.get_path()), "matrices.cannot-open");
  EXPECT_EQ(error_of(""), "matrices.empty");
  EXPECT_EQ(error_of("hello\nworld\n"), "matrices.unknown-format");
  EXPECT_EQ(error_of(std::string("\1\2\0\3binary", 10)), "matrices.unknown-format");
}

}  // namespace
}  // namespace bough
