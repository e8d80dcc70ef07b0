// MATLAB files: written and read by scipy.io, and the other way round.
#include "formats/matrices/mat_file.hpp"

#include <fstream>
#include <random>

#include "tests/formats/matrices/matrix_cases.hpp"

namespace bough {
namespace {

using matrices::MatArray;
using matrices::MatCells;
using matrices::MatFields;
using namespace test;

TEST(MatFile, EveryKindOfValueIsReadBySciPy) {
  const TempFolder folder;
  const auto path = folder.at("v.mat");
  Eigen::MatrixXd a(2, 3);
  a << 1, 2, 3, 4, 5, 6.5;
  const auto k = make_matrix("K", 3, 3, {{0, 0, 4.0}, {0, 2, -1.5}, {2, 1, 7.0}});
  matrices::write_mat(
      path, {{"a", a},
             {"x", 2.5},
             {"empty", Eigen::MatrixXd(0, 3)},
             {"cube", MatArray{{2, 2, 2}, {1, 2, 3, 4, 5, 6, 7, 8}}},
             {"K", k.values},
             {"none", make_matrix("", 2, 2, {}).values},
             {"text", "metres, kg"},
             {"nothing", ""},
             {"names", MatCells{"alpha", "be", a}},
             {"modal", MatFields{{"mass", a}, {"kind", "normal"}, {"K", k.values}, {"inner", MatFields{{"y", 1.0}}}}}});
  const auto code = folder.write("check.py", R"(
import sys, numpy as np, scipy.io as io
m = io.loadmat(sys.argv[1], squeeze_me=False, struct_as_record=True)
a = np.array([[1, 2, 3], [4, 5, 6.5]]); k = np.array([[4, 0, -1.5], [0, 0, 0], [0, 7, 0]])
assert (m['a'] == a).all() and m['x'] == 2.5 and m['empty'].shape == (0, 3)
assert (m['cube'].ravel(order='F') == np.arange(1, 9)).all() and m['cube'].shape == (2, 2, 2)
assert (m['K'].toarray() == k).all() and m['none'].nnz == 0 and m['none'].shape == (2, 2)
assert m['text'][0] == 'metres, kg' and m['nothing'].size == 0
assert m['names'].shape == (3, 1) and m['names'][0, 0][0] == 'alpha' and m['names'][1, 0][0] == 'be'
assert (m['names'][2, 0] == a).all()
s = m['modal'][0, 0]
assert s.dtype.names == ('mass', 'kind', 'K', 'inner'), s.dtype
assert (s['mass'] == a).all() and s['kind'][0] == 'normal' and (s['K'].toarray() == k).all()
assert s['inner'][0, 0]['y'] == 1
)");
  EXPECT_EQ(run_python(code + " " + path), 0);
  expect_same(read_one(path, "modal.K"), k);
  // Equal values give equal bytes, on any day.
  matrices::write_mat(folder.at("w.mat"), {{"a", a}});
  const auto first = read_bytes(folder.at("w.mat"));
  matrices::write_mat(folder.at("w.mat"), {{"a", a}});
  EXPECT_EQ(read_bytes(folder.at("w.mat")), first);
}

TEST(MatFile, NoPlaceToWrite) {
  EXPECT_EQ(find_error([] { matrices::write_mat("/nonexistent/x.mat", {{"x", 1.0}}); }), "matrices.write");
}

class MatOfSciPy : public testing::Test {
 protected:
  void make(const std::string& arguments) {
    const auto code = folder_.write("make.py", R"(
import sys, numpy as np, scipy.io as io, scipy.sparse as sp
k = sp.csc_matrix([[4, -1.5, 0], [-1.5, 5, 0], [0, 0, 6.25]])
dense = k.toarray()
io.savemat(sys.argv[1], dict(K=k, M=dense, I=np.array([[1, 2], [3, 4]], 'i2'), C=k * 2j + k, F=dense.astype('f4'),
    B=dense > 0, text='hello', cube=np.ones((2, 2, 2)), sys=dict(K=k, name='x'), cells=np.array([1, 'a'], object)),
)" + arguments + ")");
    ASSERT_EQ(run_python(code + " " + path_), 0);
  }
  const TempFolder folder_;
  const std::string path_ = folder_.at("m.mat");
};

TEST_F(MatOfSciPy, PlainAndCompressed) {
  const std::vector<Entry> entries{{0, 0, 4.0}, {0, 1, -1.5}, {1, 0, -1.5}, {1, 1, 5.0}, {2, 2, 6.25}};
  auto twice = entries;
  for (auto& e : twice) e.im = 2 * e.re;
  for (const char* compressed : {"do_compression=False", "do_compression=True"}) {
    make(compressed);
    for (const char* name : {"K", "M", "F", "sys.K"})
      expect_same(read_one(path_, name), make_matrix("", 3, 3, entries));
    expect_same(read_one(path_, "C"), make_matrix("", 3, 3, twice, true));
    expect_same(read_one(path_, "I"), make_matrix("", 2, 2, {{0, 0, 1.0}, {0, 1, 2.0}, {1, 0, 3.0}, {1, 1, 4.0}}));
    EXPECT_EQ(read_error(path_, "text"), "matrices.unknown-name");
    EXPECT_EQ(read_error(path_, "cube"), "matrices.unknown-name");
  }
}

TEST_F(MatOfSciPy, DamagedFilesAreRefused) {
  std::mt19937 random(3);
  for (const char* compressed : {"do_compression=False", "do_compression=True"}) {
    make(compressed);
    const auto whole = read_bytes(path_);
    const auto damaged_path = folder_.at("d.mat");
    for (int i = 0; i < 400; ++i) {
      auto damaged = whole;
      if (i % 4 == 0)
        damaged.resize(130 + random() % (whole.size() - 130));
      else
        damaged[128 + random() % (damaged.size() - 128)] = static_cast<char>(random());
      std::ofstream(damaged_path, std::ios::binary) << damaged;
      const auto id = read_error(damaged_path, "K");
      EXPECT_TRUE(id.empty() || id.rfind("matrices.", 0) == 0) << id;
    }
  }
  EXPECT_EQ(read_error(folder_.write("head.mat", "MATLAB 5.0 MAT-file")), "matrices.mat");
}

/// Layout of -v7.3 of MATLAB: HDF5 after 512 bytes, columns first, classes as attributes.
TEST(MatFile, Version73) {
  const TempFolder folder;
  const auto path = folder.at("m.mat");
  const auto code = folder.write("make.py", R"(
import sys, h5py, numpy as np
def mark(item, text):
    kind = h5py.h5t.C_S1.copy()
    kind.set_size(len(text) + 1)
    attribute = h5py.h5a.create(item.id, b'MATLAB_class', kind, h5py.h5s.create(h5py.h5s.SCALAR))
    attribute.write(np.array(text.encode(), dtype='S%d' % (len(text) + 1)))
with h5py.File(sys.argv[1], 'w', userblock_size=512) as f:
    mark(f.create_dataset('A', data=np.array([[1., 2], [3, 4], [5, 6]]).T), 'double')
    group = f.create_group('K')
    mark(group, 'double')
    group.attrs.create('MATLAB_sparse', np.uint64(3))
    group['data'] = np.array([4., -1.5, -1.5, 5., 6.25])
    group['ir'], group['jc'] = np.array([0, 1, 0, 1, 2], 'u8'), np.array([0, 2, 4, 5], 'u8')
with open(sys.argv[1], 'r+b') as f:
    f.write(b'MATLAB 7.3 MAT-file, Platform: GLNXA64'.ljust(116) + bytes(8) + b'\x00\x02IM')
)");
  ASSERT_EQ(run_python(code + " " + path), 0);
  expect_same(read_one(path, "A"),
              make_matrix("A", 3, 2, {{0, 0, 1.0}, {0, 1, 2.0}, {1, 0, 3.0}, {1, 1, 4.0}, {2, 0, 5.0}, {2, 1, 6.0}}));
  expect_same(read_one(path, "K"),
              make_matrix("K", 3, 3, {{0, 0, 4.0}, {0, 1, -1.5}, {1, 0, -1.5}, {1, 1, 5.0}, {2, 2, 6.25}}));
}

}  // namespace
}  // namespace bough
