// Nastran OUTPUT4 of every flavour: written and read back, and read by tests/oracle/op4_reader.py.
#include "formats/matrices/op4.hpp"
#include "formats/matrices/detail/op4_header.hpp"

#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/formats/matrices/matrix_cases.hpp"

namespace bough {
namespace {

using matrices::Matrix;
using matrices::Op4Layout;
using matrices::Op4Options;
using namespace test;

std::string write_op4(const TempFolder& folder, const std::vector<Matrix>& all, const Op4Options& options) {
  std::ostringstream out;
  for (const auto& m : all) matrices::write_op4(out, m, options);
  return folder.write("m.op4", out.str());
}

/// Matrices in the output of the oracle.
std::vector<Matrix> read_by_oracle(const std::string& path) {
  std::istringstream in(run_oracle("op4_reader.py " + path));
  std::vector<Matrix> all;
  std::string name, word;
  int form = 0, type = 0, rows = 0, columns = 0;
  while (in >> name >> form >> type >> rows >> columns) {
    std::vector<Entry> entries;
    while (in >> word && word != "end") {
      int column = 0;
      std::string re, im;
      in >> column >> re >> im;
      entries.push_back({std::stoi(word) - 1, column - 1, std::stod(re), std::stod(im)});
    }
    all.push_back(make_matrix(name, rows, columns, entries, type > 2));
    all.back().form = form;
  }
  return all;
}

struct Flavour {
  std::string name;
  Op4Options options;
};

void PrintTo(const Flavour& flavour, std::ostream* out) { *out << flavour.name; }

std::vector<Flavour> make_flavours() {
  std::vector<Flavour> flavours;
  for (const bool is_single : {false, true})
    for (const int layout : {0, 1, 2}) {
      Op4Options o;
      o.is_single = is_single;
      o.layout = layout == 0 ? Op4Layout::Dense : Op4Layout::Strings;
      o.is_bigmat = layout == 2;
      const std::string kind = std::string(is_single ? "Single" : "Double") + (layout == 0   ? "Dense"
                                                                               : layout == 1 ? "Strings"
                                                                                             : "Bigmat");
      flavours.push_back({"Text" + kind, o});
      o.exponent = 'D';
      o.digits = 18;
      flavours.push_back({"TextD" + kind, o});
      o.is_text = false;
      for (const bool is_big_endian : {false, true})
        for (const bool is_64_bit : {false, true}) {
          o.is_big_endian = is_big_endian;
          o.is_64_bit = is_64_bit;
          flavours.push_back({std::string(is_big_endian ? "Big" : "Little") + (is_64_bit ? "64" : "32") + kind, o});
        }
    }
  return flavours;
}

class Op4 : public testing::TestWithParam<Flavour> {};

TEST_P(Op4, RoundTripsAndIsReadByTheOracle) {
  const TempFolder folder;
  const auto& options = GetParam().options;
  std::vector<Matrix> all{make_random("K", 9, 9, false, options.is_single),
                          make_random("PHI", 30, 5, false, options.is_single),
                          make_random("CPLX", 7, 11, true, options.is_single), make_matrix("NULL", 4, 3, {})};
  all[0].form = matrices::kSquare;
  const auto path = write_op4(folder, all, options);
  EXPECT_EQ(matrices::detect_format(path), options.is_text ? matrices::Format::Op4Text : matrices::Format::Op4Binary);
  Diagnostics diagnostics;
  const auto found = matrices::read_matrices(path, diagnostics);
  const auto oracle = read_by_oracle(path);
  ASSERT_EQ(found.size(), all.size());
  ASSERT_EQ(oracle.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE(all[i].name);
    EXPECT_EQ(found[i].name, all[i].name);
    EXPECT_EQ(found[i].form, all[i].form);
    EXPECT_EQ(oracle[i].name, all[i].name);
    EXPECT_EQ(oracle[i].form, all[i].form);
    expect_same(found[i], all[i]);
    expect_same(oracle[i], all[i]);
  }
}

INSTANTIATE_TEST_SUITE_P(Flavours, Op4, testing::ValuesIn(make_flavours()),
                         [](const auto& flavour) { return flavour.param.name; });

TEST(Op4Text, ReadsWhatNastranWrites) {
  // Typed from the description: a string of two words per real, 3 x 65536 + row; scale factor, one blank column.
  const TempFolder folder;
  const auto path = folder.write("a.op4",
                                 "       3       3       6       2KGG     1P,5E16.9\n"
                                 "       1       0       5\n"
                                 "     327681\n"
                                 " 1.500000000E+00-2.500000000E-01\n"
                                 "       2       0       3\n"
                                 "     196610\n"
                                 " 4.000000000E+00\n"
                                 "       4       1       1\n"
                                 " 1.000000000E+00\n"
                                 "       2      -3       2       1B       (1P,3D23.16)\r\n"
                                 "       2       0       7\r\n"
                                 "       2       1\r\n"
                                 " 1.0000000000000000D+00\r\n"
                                 "       3       2\r\n"
                                 " 2.0000000000000000D+00 3.0000000000000000-101\r\n"
                                 "       3       1       1\r\n"
                                 " 1.0000000000000000D+00\r\n");
  const auto k = read_one(path, "kgg");
  // One triangle of a symmetric matrix (form 6) stands for both.
  expect_same(k, make_matrix("KGG", 3, 3, {{0, 0, 1.5}, {0, 1, -0.25}, {1, 0, -0.25}, {1, 1, 4.0}}));
  EXPECT_EQ(k.form, matrices::kSymmetric);
  expect_same(read_one(path, "B"), make_matrix("B", 3, 2, {{0, 1, 1.0}, {1, 1, 2.0}, {2, 1, 3e-101}}));
}

TEST(Op4Text, LongRunsAreCutToFitTheStringHeader) {
  const TempFolder folder;
  std::vector<Entry> entries;
  for (int r = 0; r < 40000; ++r) entries.push_back({r, 0, r + 1.0});
  const auto tall = make_matrix("TALL", 40000, 1, entries);
  for (const bool is_text : {true, false}) {
    Op4Options options;
    options.is_text = is_text;
    options.layout = Op4Layout::Strings;
    const auto path = write_op4(folder, {tall}, options);
    expect_same(read_one(path), tall);
    expect_same(read_by_oracle(path).at(0), tall);
  }
}

TEST(Op4Text, ManyRowsMakeItBigmat) {
  const TempFolder folder;
  const auto wide = make_matrix("W", 70000, 2, {{0, 0, 1.0}, {69999, 1, 2.0}});
  Op4Options options;
  options.layout = Op4Layout::Strings;
  for (const bool is_text : {true, false}) {
    options.is_text = is_text;
    const auto path = write_op4(folder, {wide}, options);
    expect_same(read_one(path), wide);
    expect_same(read_by_oracle(path).at(0), wide);
  }
}

TEST(Op4Text, EachFaultHasItsErrorAndItsLine) {
  const TempFolder folder;
  const std::string head = "       2       2       1       2K       1P,3E23.16\n",
                    column = "       1       1       2\n", row = " 1.0000000000000000E+00 2.0000000000000000E+00\n";
  const auto error = [&](const std::string& text) { return read_error(folder.write("x.op4", text)); };
  EXPECT_EQ(error(head + column), "matrices.truncated");
  EXPECT_EQ(error(head + column + row), "matrices.truncated");
  EXPECT_EQ(error(head + column + " 1.0000000000000000E+00 2.0000000000x00000E+00\n"), "matrices.bad-number");
  EXPECT_EQ(error(head + "       1       2       2\n" + row), "matrices.op4-column");
  EXPECT_EQ(error(head + "       0       1       2\n" + row), "matrices.op4-column");
  EXPECT_EQ(error(head + "  garbage\n"), "matrices.op4-column");
  EXPECT_EQ(error(head + "       1       0       3\n       what\n"), "matrices.op4-string");
  EXPECT_EQ(error(head + "       1       0       3\n     393217\n"), "matrices.op4-string");
  EXPECT_EQ(error("       2       2       1       7K       1P,3E23.16\n"), "matrices.op4-header");
  EXPECT_EQ(error("       2       2       1       2K       nonsense\n"), "matrices.op4-format");
  EXPECT_EQ(error(head + column + " 1.00000000000000000E+00 2.00000000000000000E+00\n"), "matrices.op4-format");
  EXPECT_EQ(error("       2 9999999       1       2K\n"), "matrices.truncated");
  EXPECT_EQ(error("       299999999       1       2K\n"), "matrices.size");
  EXPECT_EQ(error("       2       0       1       2K\n"), "matrices.size");
  // Each of these would be one that a file may have; not all of them in a file of 1000 bytes.
  matrices::detail::Op4Header header{40'000'000, 40'000'000, 2, 2, "K", false};
  double claimed = 0;
  std::string id;
  for (int i = 0; i < 3; ++i)
    matrices::detail::settle_header(header, 1000, claimed, [&](const char* what, const std::string&) { id += what; });
  EXPECT_EQ(id, "matrices.size");
  try {
    read_one(folder.write("x.op4", head + column + "nonsense\n"));
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.items().front().where.line, 3);
  }
}

/// Every cut and many flipped bytes of every binary flavour: an error or a matrix, never a crash, never much memory.
TEST(Op4Binary, DamagedFilesAreRefused) {
  const TempFolder folder;
  std::mt19937 random(5);
  for (const auto& flavour : make_flavours()) {
    if (flavour.options.is_single) continue;
    std::ostringstream out;
    matrices::write_op4(out, make_random("K", 6, 5, false, false), flavour.options);
    const auto whole = out.str();
    const auto path = folder.at("x.op4");
    for (std::size_t size = 5; size < whole.size(); size += flavour.options.is_text ? 67 : 23) {
      std::ofstream(path, std::ios::binary) << whole.substr(0, size);
      const auto id = read_error(path);
      // The last number of a formatted matrix says nothing: what ends within it is whole.
      EXPECT_TRUE(id.rfind("matrices.", 0) == 0 || (flavour.options.is_text && size + 30 > whole.size()))
          << flavour.name << " cut at " << size << ": " << id;
    }
    for (int i = 0; i < 40; ++i) {
      auto damaged = whole;
      damaged[random() % damaged.size()] = static_cast<char>(random());
      std::ofstream(path, std::ios::binary) << damaged;
      const auto id = read_error(path);
      EXPECT_TRUE(id.empty() || id.rfind("matrices.", 0) == 0) << flavour.name << ": " << id;
    }
  }
}

TEST(Op4Binary, FaultsNameTheByte) {
  const TempFolder folder;
  std::ostringstream out;
  Op4Options options;
  options.is_text = false;
  matrices::write_op4(out, make_random("K", 6, 5, false, false), options);
  auto bytes = out.str();
  bytes[32] ^= 1;  // the length of the second record
  try {
    read_one(folder.write("x.op4", bytes));
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.items().front().id, "matrices.record");
    EXPECT_NE(std::string(e.what()).find("at byte 32"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace bough
