// Flat body files: every field bit for bit, and no file that makes the reader do more than refuse it.
#include "formats/flat/flex_body.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "base/diagnostic.hpp"
#include "formats/flat/detail/seal.hpp"
#include "tests/formats/hdf5/random_body.hpp"
#include "tests/support/temp_folder.hpp"

namespace bough::flat {
namespace {

using records::FlexBody;
using test::TempFolder;
using testing::HasSubstr;

/// Text of the InputError; empty if nothing is thrown.
template <class Action>
std::string collect_errors(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

std::string parse_errors(const std::string& bytes) {
  return collect_errors([&] { parse_flex_body(bytes, "x.flat"); });
}

/// The bytes with `from` replaced and the checksum made again.
std::string change(std::string bytes, const std::string& from, const std::string& to) {
  const auto at = bytes.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  bytes.replace(at, from.size(), to);
  bytes.resize(bytes.size() - detail::kSealSize);
  return bytes + detail::make_seal(bytes);
}

FlexBody make_full_body(unsigned seed, int n = 3) {
  auto body = test::make_random_body(seed, n, 5, true);
  const auto numbers = [n](Eigen::Index rows, Eigen::Index cols) {
    return Eigen::MatrixXd(Eigen::MatrixXd::Random(rows, cols) * n);
  };
  // Not in alphabetical order.
  for (const auto& [name, count] : {std::pair{"CQUAD4-2", 2}, std::pair{"CBAR", 3}}) {
    records::RecoveryBlock block;
    block.name = name;
    for (int i = 0; i < count; ++i) block.id.push_back(10 * i + 1);
    block.components = {"axial", "stress_xx@oben\nänd"};
    block.matrix = numbers(2 * count, n);
    block.inertial = numbers(2 * count, records::kNumInertialLoads);
    block.external = numbers(2 * count, 3);
    block.offset = numbers(2 * count, 1);
    body.recovery.push_back(block);
  }
  body.inertial_load = numbers(n, records::kNumInertialLoads);
  body.strain_energy.id = {4, 5};
  body.strain_energy.card = {"CBAR", ""};
  body.strain_energy.matrix = numbers(2, n * (n + 1) / 2);
  body.kind.back() = records::ModeKind::Residual;
  body.modal_damping(0, 0) = -0.0;
  body.modal_damping(0, 1) = std::numeric_limits<double>::denorm_min();
  body.modal_damping(1, 0) = 0.1;
  return body;
}

bool same(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

TEST(FlatBody, EveryFieldReturnsBitForBit) {
  const TempFolder folder;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const auto body = make_full_body(seed);
    write_flex_body(folder.at("body.flat"), body);
    EXPECT_TRUE(is_flex_body(folder.at("body.flat")));
    const auto read = read_flex_body(folder.at("body.flat"));
    EXPECT_TRUE(test::are_identical(read, body));
    EXPECT_TRUE(same(read.modal_damping, body.modal_damping));
    EXPECT_TRUE(same(read.inertial_load, body.inertial_load));
    ASSERT_EQ(read.recovery.size(), body.recovery.size());
    for (std::size_t i = 0; i < body.recovery.size(); ++i) {
      const auto &a = read.recovery[i], &b = body.recovery[i];
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.id, b.id);
      EXPECT_EQ(a.components, b.components);
      EXPECT_TRUE(same(a.matrix, b.matrix) && same(a.inertial, b.inertial) && same(a.external, b.external) &&
                  same(a.offset, b.offset));
    }
    EXPECT_EQ(read.strain_energy.id, body.strain_energy.id);
    EXPECT_EQ(read.strain_energy.card, body.strain_energy.card);
    EXPECT_TRUE(same(read.strain_energy.matrix, body.strain_energy.matrix));
    EXPECT_EQ(format_flex_body(read), format_flex_body(body));
    EXPECT_EQ(test::read_bytes(folder.at("body.flat")), format_flex_body(body));
  }
}

TEST(FlatBody, BodiesThatLackPartsRoundTrip) {
  for (const auto& [n, p] : {std::pair{2, 3}, std::pair{0, 3}, std::pair{2, 0}, std::pair{0, 0}}) {
    auto body = test::make_random_body(5, n, p, false);
    if (n == 0) body.exact = {};
    if (n > 0) body.kg_inertial[3].resize(0, 0);
    EXPECT_TRUE(test::are_identical(parse_flex_body(format_flex_body(body), "x"), body)) << n << ' ' << p;
  }
}

TEST(FlatBody, MatricesAreByRowAndLittleEndian) {
  auto body = test::make_random_body(1, 2, 3, false);
  body.modal_damping << 1.0, 2.0, 3.0, 4.0;
  const auto bytes = format_flex_body(body);
  const std::string head = "/modal/damping float64 2 2 2\n";
  const auto at = bytes.find(head);
  ASSERT_NE(at, std::string::npos);
  const unsigned char two[] = {0, 0, 0, 0, 0, 0, 0, 0x40};
  EXPECT_EQ(std::memcmp(bytes.data() + at + head.size() + 8, two, sizeof two), 0);
  EXPECT_EQ(bytes.substr(0, 13), "bough-flat 1\n");
  EXPECT_EQ(detail::make_seal("foobar"), "end 85944171f73967e8\n");  // published value of FNV-1a, 64 bits
}

TEST(FlatBody, TruncatedAnywhereIsAnError) {
  const auto bytes = format_flex_body(test::make_random_body(3, 1, 1, false));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto error = parse_errors(bytes.substr(0, size));
    EXPECT_THAT(error, HasSubstr(size < 11 ? "[flat.not-flat]" : "[flat.damaged]")) << size;
    // The arrays end early, and the checksum is right: optional ones may be absent.
    const auto cut = bytes.substr(0, size);
    const auto error_of_cut = parse_errors(cut + detail::make_seal(cut));
    EXPECT_TRUE(!error_of_cut.empty() || size > bytes.find("/stiffening/computed")) << size;
  }
  EXPECT_THAT(parse_errors(bytes + "\n"), HasSubstr("[flat.damaged]"));
}

TEST(FlatBody, EveryChangedByteIsAnError) {
  const auto bytes = format_flex_body(test::make_random_body(3, 1, 1, false));
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    auto changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    EXPECT_NE(parse_errors(changed), "") << at;
  }
}

TEST(FlatBody, WrongFilesAreRefusedWithAReason) {
  const auto bytes = format_flex_body(make_full_body(1));
  const auto expect = [&](const std::string& from, const std::string& to, const std::string& error) {
    EXPECT_THAT(parse_errors(change(bytes, from, to)), HasSubstr(error)) << to;
  };
  struct Changed {
    std::string from, to, error;
  };
  for (const auto& [from, to, error] : std::vector<Changed>{
           {"bough-flat 1", "bough-flat 2", "the file has version \"2\", expected 1; use a newer Bough"},
           {"bough-flat 1", "bough-flat 2", "[flat.version]"},
           {"bough-flat 1", "bough-flat one", "[flat.version]"},
           {"/modes/eigenvalue float64 1 3", "/modes/eigenvalue float64 3 3 0 2147483647", "[flat.damaged]"},
           {"/modes/eigenvalue float64 1 3", "/modes/other float64 1 3", "/modes/eigenvalue is missing"},
           {"exact", "exakt", "the method 'exakt', expected lumped, consistent or exact"},
           {"exact", "exakt", "[flat.value]"},
           {"/source/file/length int32 1 2\n\x08", "/source/file/length int32 1 2\n\x09", "[flat.shape]"},
       })
    expect(from, to, error);
  for (const auto& [to, error] : std::vector<std::pair<std::string, std::string>>{
           {"mass float64 2 3000000 3000000", "more than the bytes that follow"},
           {"mass float64 4 2147483647 2147483647 2147483647 2147483647", "[flat.damaged]"},
           {"mass float64 2 3 99999999999999999999", "[flat.damaged]"},
           {"mass float64 2 -3 -3", "[flat.damaged]"},
           {"mass float64 99 3 3", "[flat.damaged]"},
           {"mass complex 2 3 3", "[flat.damaged]"},
           {"mass float64 1 9", "/modal/mass has the type float64 and the shape 9, expected float64 and 3 x 3"},
           {"mass float64 1 9", "[flat.shape]"},
           {"mass text 1 72", "[flat.shape]"},
           {"other float64 2 3 3", "/modal/mass is missing"},
           {"other float64 2 3 3", "[flat.missing]"},
           {"stiffness float64 2 3 3", "is there twice"},
       })
    expect("/modal/mass float64 2 3 3", "/modal/" + to, error);

  auto body = make_full_body(1);
  body.modal_damping(1, 1) = std::numeric_limits<double>::quiet_NaN();
  body.kind[0] = static_cast<records::ModeKind>(7);
  const auto errors = parse_errors(format_flex_body(body));
  EXPECT_THAT(errors, HasSubstr("/modal/damping has 1 values that are not finite numbers"));
  EXPECT_THAT(errors, HasSubstr("/modes/kind has 1 values that are not in 0 to 3"));
  body = make_full_body(1);
  body.locators[0].node = 12345;
  EXPECT_THAT(parse_errors(format_flex_body(body)), HasSubstr("locator 'tip x' is at node 12345"));
  body = make_full_body(1);
  body.exact = {};
  body.mass = -1;
  EXPECT_THAT(parse_errors(format_flex_body(body)), HasSubstr("/integrals/exact is missing"));
  EXPECT_THAT(parse_errors(format_flex_body(body)), HasSubstr("/rigid/mass is -1"));
}

TEST(FlatBody, OtherArraysArePassedOver) {
  const auto body = make_full_body(2);
  const auto bytes = change(format_flex_body(body), "/name text", "/of/others int32 1 1\n0000/name text");
  EXPECT_TRUE(test::are_identical(parse_flex_body(bytes, "x"), body));
}

TEST(FlatBody, FilesThatCannotBeReadOrWritten) {
  const TempFolder folder;
  EXPECT_FALSE(is_flex_body(folder.at("none.flat")));
  EXPECT_FALSE(is_flex_body(folder.get_path()));
  EXPECT_FALSE(is_flex_body(folder.write("short", "bough")));
  EXPECT_THAT(collect_errors([&] { read_flex_body(folder.at("none.flat")); }), HasSubstr("[flat.cannot-read]"));
  EXPECT_THAT(collect_errors([&] { read_flex_body(folder.get_path()); }), HasSubstr("[flat.cannot-read]"));
  EXPECT_THAT(collect_errors([&] { list_arrays(folder.write("short", "bough")); }), HasSubstr("[flat.not-flat]"));
  try {
    write_flex_body(folder.at("nowhere/x.flat"), make_full_body(1));
    ADD_FAILURE() << "written";
  } catch (const ComputationError& error) {
    EXPECT_THAT(error.what(), HasSubstr("[flat.write]"));
  }
}

TEST(FlatBody, ListsItsArrays) {
  const TempFolder folder;
  write_flex_body(folder.at("body.flat"), make_full_body(1));
  const auto arrays = list_arrays(folder.at("body.flat"));
  ASSERT_FALSE(arrays.empty());
  EXPECT_EQ(arrays[0].name, "/name");
  EXPECT_EQ(arrays[0].text, make_full_body(1).name);
  const auto phi = std::find_if(arrays.begin(), arrays.end(), [](const auto& a) { return a.name == "/modes/phi"; });
  ASSERT_NE(phi, arrays.end());
  EXPECT_EQ(phi->type, "float64");
  EXPECT_EQ(phi->shape, (std::vector<long>{5, 6, 3}));
}

}  // namespace
}  // namespace bough::flat
