// Matrices that are written read back unchanged, whatever the numbers; written again they give the same bytes.
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include "formats/matrices/mat_file.hpp"
#include "formats/matrices/matrix_market.hpp"
#include "formats/matrices/op4.hpp"
#include "tests/formats/matrices/matrix_cases.hpp"
#include "tests/support/draws.hpp"

namespace bough {
namespace {

using matrices::Matrix;
using test::TempFolder;

/// Numbers of every size that a double has: by its bits, and the ends of its range.
class AnyNumber : public test::Draws<std::mt19937_64> {
 public:
  using Draws::Draws;

  double draw_value() {
    using Limits = std::numeric_limits<double>;
    constexpr std::array ends{Limits::denorm_min(),
                              -Limits::denorm_min(),
                              Limits::min(),
                              Limits::max(),
                              -Limits::max(),
                              Limits::epsilon(),
                              1.0 / 3.0,
                              1e-100,
                              1e100,
                              -1e10};
    if (draw(0, 3) == 0) return ends[static_cast<std::size_t>(draw(0, ends.size() - 1))];
    for (;;) {
      const std::uint64_t bits = random_();
      double value = 0;
      std::memcpy(&value, &bits, sizeof value);
      if (std::isfinite(value) && value != 0) return value;
    }
  }

  Matrix draw_matrix(const std::string& name, bool is_complex) {
    const int rows = draw(1, 12), columns = draw(1, 12), share = draw(1, 4);
    std::vector<test::Entry> entries;
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c)
        if (draw(1, share) == 1) entries.push_back({r, c, draw_value(), is_complex ? draw_value() : 0.0});
    return test::make_matrix(name, rows, columns, entries, is_complex);
  }

  /// Both triangles.
  records::SparseMatrix draw_symmetric() {
    const int n = draw(1, 10);
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j)
        if (i == j || draw(0, 2) == 0) full(i, j) = full(j, i) = draw_value();
    std::vector<test::Entry> entries;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        if (full(i, j) != 0) entries.push_back({i, j, full(i, j)});
    return test::make_matrix("", n, n, entries).values;
  }
};

TEST(RoundTrips, Op4) {
  const TempFolder folder;
  for (unsigned seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE(seed);
    AnyNumber any(seed);
    matrices::Op4Options options;
    options.is_text = any.draw(0, 1) == 1;
    options.layout = any.draw(0, 1) == 1 ? matrices::Op4Layout::Dense : matrices::Op4Layout::Strings;
    options.is_bigmat = any.draw(0, 1) == 1;
    options.exponent = any.draw(0, 1) == 1 ? 'E' : 'D';
    options.is_big_endian = any.draw(0, 1) == 1;
    options.is_64_bit = any.draw(0, 1) == 1;
    std::vector<Matrix> all;
    for (int k = any.draw(1, 4); k > 0; --k)
      all.push_back(any.draw_matrix("M" + std::to_string(k), any.draw(0, 3) == 0));
    const auto write = [&](const std::vector<Matrix>& matrices) {
      std::ostringstream out;
      for (const auto& m : matrices) matrices::write_op4(out, m, options);
      return out.str();
    };
    const auto text = write(all);
    const auto path = folder.write("m.op4", text);
    const auto found = options.is_text ? matrices::read_op4_text(path) : matrices::read_op4_binary(path);
    ASSERT_EQ(found.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) test::expect_same(found[i], all[i]);
    EXPECT_EQ(write(found), text);
  }
}

TEST(RoundTrips, MatrixMarket) {
  const TempFolder folder;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    AnyNumber any(seed);
    Matrix matrix;
    matrix.values = any.draw_symmetric();
    std::ostringstream out, again;
    matrices::write_matrix_market(out, matrix.values, "K of the test");
    const auto found = test::read_one(folder.write("k.mtx", out.str()));
    test::expect_same(found, matrix);
    matrices::write_matrix_market(again, found.values, "K of the test");
    EXPECT_EQ(again.str(), out.str());
  }
}

TEST(RoundTrips, Matlab) {
  const TempFolder folder;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    AnyNumber any(seed);
    std::vector<Matrix> all;
    for (int k = any.draw(1, 4); k > 0; --k) all.push_back(any.draw_matrix("M" + std::to_string(k), false));
    const auto write = [&](const std::vector<Matrix>& matrices, const char* name) {
      matrices::MatFields fields;
      for (const auto& m : matrices) fields.emplace_back(m.name, m.values);
      matrices::write_mat(folder.at(name), fields);
      return test::read_bytes(folder.at(name));
    };
    const auto bytes = write(all, "a.mat");
    Diagnostics diagnostics;
    const auto found = matrices::read_matrices(folder.at("a.mat"), diagnostics);
    ASSERT_EQ(found.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) test::expect_same(found[i], all[i]);
    EXPECT_EQ(write(found, "b.mat"), bytes);
  }
}

}  // namespace
}  // namespace bough
