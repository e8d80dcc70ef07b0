#pragma once
/// \file Matrices to write and read, and files in a folder of the test's own.
#include <cstdio>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "formats/matrices/matrix_reader.hpp"
#include "tests/support/members.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temp_folder.hpp"

namespace bough::test {

inline const std::string kOracle = BOUGH_SOURCE_DIR "/tests/oracle/";

/// Entries (row, column, value) in the order of the rows.
struct Entry {
  int row, column;
  double re, im = 0;
};

inline matrices::Matrix make_matrix(const std::string& name, int rows, int columns, const std::vector<Entry>& entries,
                                    bool is_complex = false) {
  matrices::Matrix m;
  m.name = name;
  m.form = rows == columns ? matrices::kSquare : matrices::kRectangular;
  m.is_complex = is_complex;
  m.values.num_rows = rows;
  m.values.num_cols = columns;
  m.values.indptr.assign(static_cast<std::size_t>(rows) + 1, 0);
  for (const auto& e : entries) {
    ++m.values.indptr[static_cast<std::size_t>(e.row) + 1];
    m.values.indices.push_back(e.column);
    m.values.data.push_back(e.re);
    if (is_complex) m.imaginary.push_back(e.im);
  }
  for (std::size_t r = 0; r < static_cast<std::size_t>(rows); ++r) m.values.indptr[r + 1] += m.values.indptr[r];
  return m;
}

/// About a third of the places filled; values that single precision holds when asked.
inline matrices::Matrix make_random(const std::string& name, int rows, int columns, bool is_complex, bool is_single) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> value(-1, 1);
  std::vector<Entry> entries;
  const auto draw = [&] {
    const double x = value(random) * std::pow(10.0, static_cast<int>(random() % 13) - 6);
    return is_single ? static_cast<double>(static_cast<float>(x)) : x;
  };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      // Column 3 stays empty, runs and gaps elsewhere.
      if (c != 3 && random() % 3 != 0) entries.push_back({r, c, draw(), is_complex ? draw() : 0.0});
  return make_matrix(name, rows, columns, entries, is_complex);
}

inline void expect_same(const matrices::Matrix& found, const matrices::Matrix& expected) {
  using Values = records::SparseMatrix;
  expect_same_members(found.values, expected.values, &Values::num_rows, &Values::num_cols, &Values::indptr,
                      &Values::indices, &Values::data);
  expect_same_members(found, expected, &matrices::Matrix::is_complex, &matrices::Matrix::imaginary);
}

/// Output of a program of tests/oracle.
inline std::string run_oracle(const std::string& arguments) {
  std::string text;
  FILE* pipe = ::popen(("/usr/bin/python3 -W ignore " + kOracle + arguments + " 2>&1").c_str(), "r");
  char buffer[4096];
  for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, n);
  EXPECT_EQ(::pclose(pipe), 0) << text;
  return text;
}

/// The id of the first diagnostic that reading raises; "" when nothing is wrong.
template <class Read>
std::string find_error(const Read& read) {
  try {
    read();
  } catch (const Failure& failure) {
    return failure.items().front().id;
  }
  return "";
}

inline std::string read_error(const std::string& path, const std::string& name = {}) {
  Diagnostics diagnostics;
  return find_error([&] { matrices::read_matrix(path, name, diagnostics); });
}

inline matrices::Matrix read_one(const std::string& path, const std::string& name = {}) {
  Diagnostics diagnostics;
  return matrices::read_matrix(path, name, diagnostics);
}

}  // namespace bough::test
