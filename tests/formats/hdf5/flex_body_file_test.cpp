#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include "base/diagnostic.hpp"
#include "formats/hdf5/files.hpp"
#include "tests/formats/hdf5/full_disk.hpp"
#include "tests/formats/hdf5/random_body.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temp_folder.hpp"

namespace bough::hdf5 {
namespace {

using test::TempFolder;
using testing::HasSubstr;

/// The ids of the InputError that `action` throws, "none" when it does not.
template <class Action>
std::vector<std::string> collect_ids(Action action) {
  try {
    action();
  } catch (const InputError& e) {
    std::vector<std::string> ids;
    for (const auto& d : e.items()) ids.push_back(d.id);
    return ids;
  }
  return {"none"};
}

/// Changes a valid file in place through plain HDF5.
class Surgeon {
 public:
  explicit Surgeon(const std::string& path) : file_(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT)) {}
  ~Surgeon() { H5Fclose(file_); }
  void remove(const char* path) { ASSERT_GE(H5Ldelete(file_, path, H5P_DEFAULT), 0); }
  void set_number(const char* path, hsize_t index, double value) {
    const hid_t dataset = H5Dopen2(file_, path, H5P_DEFAULT);
    const hid_t space = H5Dget_space(dataset);
    std::vector<double> data(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data());
    data[index] = value;
    ASSERT_GE(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()), 0);
    H5Sclose(space);
    H5Dclose(dataset);
  }
  void replace_by_vector(const char* path, hsize_t size) {
    remove(path);
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    const hid_t dataset = H5Dcreate2(file_, path, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dclose(dataset);
    H5Sclose(space);
  }
  void set_text(const char* object, const char* attribute, const char* text) {
    H5Adelete_by_name(file_, object, attribute, H5P_DEFAULT);
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t made = H5Acreate_by_name(file_, object, attribute, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    ASSERT_GE(H5Awrite(made, type, &text), 0);
    H5Aclose(made);
    H5Sclose(space);
    H5Tclose(type);
  }

 private:
  hid_t file_;
};

/// More texts than the buffer holds that strings are converted in, a megabyte.
TEST(FlexBodyFile, ManyTexts) {
  const TempFolder folder;
  auto body = test::make_random_body(2, 3, 5, true);
  constexpr int num_elements = 70'000;
  body.strain_energy = {};
  for (int i = 0; i < num_elements; ++i) {
    body.strain_energy.id.push_back(i + 1);
    body.strain_energy.card.push_back("CARD" + std::to_string(i));
  }
  const auto n = body.num_modes();
  body.strain_energy.matrix = Eigen::MatrixXd::Zero(num_elements, n * (n + 1) / 2);
  write_flex_body(body, folder.at("body.h5"));
  EXPECT_EQ(read_flex_body(folder.at("body.h5")).strain_energy.card, body.strain_energy.card);
}

TEST(FlexBodyFile, RoundTripIsExact) {
  const TempFolder folder;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const auto body = test::make_random_body(seed, static_cast<int>(seed) + 1, 5, seed % 2 == 0);
    write_flex_body(body, folder.at("body.h5"));
    EXPECT_TRUE(test::are_identical(read_flex_body(folder.at("body.h5")), body)) << seed;
  }
}

TEST(FlexBodyFile, ResultantsOfLoadsMayBeAbsent) {
  const TempFolder folder;
  auto body = test::make_random_body(2, 3, 5, true);
  write_flex_body(body, folder.at("body.h5"));
  {
    Surgeon surgeon(folder.at("body.h5"));
    surgeon.remove("/stiffening/load_resultant");
    surgeon.remove("/stiffening/load_moment");
  }
  const auto old = read_flex_body(folder.at("body.h5"));
  EXPECT_EQ(old.load_resultant.size(), 0);
  EXPECT_TRUE(old.load_moment.empty());
  body.load_resultant.resize(0, 0);
  body.load_moment.clear();
  EXPECT_TRUE(test::are_identical(old, body));
  write_flex_body(old, folder.at("again.h5"));  // what is not known is not written
  EXPECT_TRUE(test::are_identical(read_flex_body(folder.at("again.h5")), body));
}

TEST(FlexBodyFile, BodyWithoutModesOrWithoutNodesRoundTrips) {
  const TempFolder folder;
  for (const auto& [n, p] : {std::pair{0, 3}, std::pair{2, 0}}) {
    auto body = test::make_random_body(5, n, p, false);
    if (n == 0) body.exact = {};  // there is nothing to integrate
    write_flex_body(body, folder.at("body.h5"));
    EXPECT_TRUE(test::are_identical(read_flex_body(folder.at("body.h5")), body));
  }
}

/// Returns true if an object of the file holds the time of its creation or of a change.
bool has_times(const std::string& path) {
#if H5_VERSION_GE(1, 12, 0)
  using Info = H5O_info2_t;
#else
  using Info = H5O_info_t;
#endif
  const auto look = [](hid_t, const char*, const Info* info, void* found) -> herr_t {
    if (info->atime != 0 || info->mtime != 0 || info->ctime != 0 || info->btime != 0) *static_cast<bool*>(found) = true;
    return 0;
  };
  bool found = false;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  EXPECT_GE(file, 0);
#if H5_VERSION_GE(1, 12, 0)
  EXPECT_GE(H5Ovisit3(file, H5_INDEX_NAME, H5_ITER_NATIVE, look, &found, H5O_INFO_TIME), 0);
#else
  EXPECT_GE(H5Ovisit1(file, H5_INDEX_NAME, H5_ITER_NATIVE, look, &found), 0);
#endif
  H5Fclose(file);
  return found;
}

TEST(FlexBodyFile, SameBodyGivesSameBytes) {
  const TempFolder folder;
  const auto body = test::make_random_body(3, 4, 3, true);
  write_flex_body(body, folder.at("a.h5"));
  write_flex_body(body, folder.at("b.h5"));
  EXPECT_EQ(test::read_bytes(folder.at("a.h5")), test::read_bytes(folder.at("b.h5")));
  EXPECT_FALSE(has_times(folder.at("a.h5")));  // which would differ a second later
}

TEST(FlexBodyFile, H5pySeesTheContract) {
  const TempFolder folder;
  write_flex_body(test::make_random_body(7, 4, 3, true), folder.at("body.h5"));
  EXPECT_EQ(test::run_python(BOUGH_SOURCE_DIR "/tests/formats/hdf5/check_flexbody.py " + folder.at("body.h5") + " 4 3"),
            0);
}

TEST(FlexBodyFile, TruncatedAnywhereIsAnInputError) {
  const TempFolder folder;
  write_flex_body(test::make_random_body(1, 3, 4, true), folder.at("body.h5"));
  const std::string bytes = test::read_bytes(folder.at("body.h5"));
  for (const double part : {0.0, 0.0001, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99}) {
    const auto size = static_cast<std::size_t>(part * static_cast<double>(bytes.size()));
    const std::string path = folder.write("cut.h5", bytes.substr(0, size));
    EXPECT_EQ(collect_ids([&] { read_flex_body(path); }), std::vector<std::string>{"hdf5.truncated"}) << size;
  }
  const std::string path = folder.write("cut.h5", bytes.substr(0, bytes.size() - 1));
  EXPECT_EQ(collect_ids([&] { read_flex_body(path); }), std::vector<std::string>{"hdf5.truncated"});
}

TEST(FlexBodyFile, FilesThatAreNotOursAreRefused) {
  const TempFolder folder;
  EXPECT_EQ(collect_ids([&] { read_flex_body(folder.at("none.h5")); }), std::vector<std::string>{"hdf5.cannot-open"});
  EXPECT_EQ(collect_ids([&] { read_flex_body(folder.get_path()); }), std::vector<std::string>{"hdf5.cannot-open"});
  try {
    read_flex_body(folder.at("none.h5"));
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.items().front().what, "no such file");
  }
  EXPECT_EQ(collect_ids([&] { read_flex_body(folder.write("a.h5", "GRID,1,,0.,0.,0.\n")); }),
            std::vector<std::string>{"hdf5.not-hdf5"});
  write_modes(test::make_random_modes(1, 2, 2), folder.at("modes.h5"));
  try {
    read_flex_body(folder.at("modes.h5"));
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.items().front().id, "hdf5.wrong-format");
    EXPECT_THAT(e.what(), HasSubstr("the file is \"bough-modes\", expected \"bough-flexbody\""));
  }
}

TEST(FlexBodyFile, NewerMajorVersionIsRefusedNewerMinorIsRead) {
  const TempFolder folder;
  write_flex_body(test::make_random_body(1, 2, 2, false), folder.at("body.h5"));
  Surgeon(folder.at("body.h5")).set_text("/", "format_version", "1.9");
  EXPECT_NO_THROW(read_flex_body(folder.at("body.h5")));
  Surgeon(folder.at("body.h5")).set_text("/", "format_version", "2.0");
  EXPECT_EQ(collect_ids([&] { read_flex_body(folder.at("body.h5")); }), std::vector<std::string>{"hdf5.wrong-format"});
}

TEST(FlexBodyFile, EveryFaultIsReportedAtOnce) {
  const TempFolder folder;
  const std::string path = folder.at("body.h5");
  write_flex_body(test::make_random_body(1, 2, 3, true), path);
  {
    Surgeon surgeon(path);
    surgeon.remove("/rigid/mass");
    surgeon.replace_by_vector("/modal/mass", 3);
    surgeon.replace_by_vector("/modes/kind", 2);
    surgeon.set_number("/integrals/exact/gamma4", 5, std::nan(""));
    surgeon.set_number("/modes/phi", 0, std::numeric_limits<double>::infinity());
    surgeon.set_text("/integrals", "method", "guessed");
  }
  try {
    read_flex_body(path);
    FAIL();
  } catch (const InputError& e) {
    const std::string text = e.what();
    EXPECT_THAT(text, HasSubstr("/rigid/mass is missing; write the file again [hdf5.missing]"));
    EXPECT_THAT(text, HasSubstr("/modal/mass has the shape 3, expected 2 x 2"));
    EXPECT_THAT(text, HasSubstr("[hdf5.shape]"));
    EXPECT_THAT(text, HasSubstr("/modes/kind holds values of another type, expected strings"));
    EXPECT_THAT(text, HasSubstr("[hdf5.type]"));
    EXPECT_THAT(text, HasSubstr("/integrals/exact/gamma4 has 1 values that are not finite"));
    EXPECT_THAT(text, HasSubstr("/modes/phi has 1 values"));
    EXPECT_THAT(text, HasSubstr("[hdf5.nan]"));
    EXPECT_THAT(text, HasSubstr("method 'guessed', expected lumped, consistent or exact"));
    EXPECT_THAT(text, HasSubstr("[hdf5.value]"));
    EXPECT_EQ(e.items().size(), 6u);
    EXPECT_EQ(e.items().front().where.file, path);
  }
}

TEST(FlexBodyFile, WhatNoBodyHasIsRefused) {
  const TempFolder folder;
  const std::string path = folder.at("body.h5");
  const auto read = [&](const auto& change) -> std::string {
    records::FlexBody body = test::make_random_body(3, 3, 4, true);
    change(body);
    write_flex_body(body, path);
    try {
      read_flex_body(path);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  using records::FlexBody;
  EXPECT_EQ(read([](FlexBody&) {}), "");
  EXPECT_THAT(read([](FlexBody& b) { b.node_id[2] = b.node_id[1]; }), HasSubstr("/nodes/id lists node 8 twice"));
  EXPECT_THAT(read([](FlexBody& b) { b.mass = -2; }), HasSubstr("/rigid/mass is -2; correct the file"));
  EXPECT_THAT(read([](FlexBody& b) { b.mass = 0; }), HasSubstr("/rigid/mass is zero, and its modes move mass"));
  EXPECT_THAT(read([](FlexBody& b) { b.inertia(0, 1) *= 1.01; }),
              HasSubstr("/rigid/inertia is not symmetric: (2, 1) is"));
  EXPECT_THAT(read([](FlexBody& b) { b.inertia = Eigen::Vector3d(1, 2, -3).asDiagonal(); }),
              HasSubstr("/rigid/inertia has the principal moment -3"));
  EXPECT_THAT(read([](FlexBody& b) {
                b.modal_stiffness(2, 0) += 1;
                b.modal_stiffness(0, 2) *= 2;
              }),
              HasSubstr("/modal/stiffness is not symmetric: (3, 1) is"));
  EXPECT_THAT(read([](FlexBody& b) { b.modal_mass(1, 1) = -5; }), HasSubstr("/modal/mass of mode 2 is -5"));
  EXPECT_EQ(read([](FlexBody& b) { b.modal_stiffness(2, 0) *= 1 + 1e-7; }), "");
}

TEST(FlexBodyFile, FailedWriteLeavesTheOldFileAndNothingElse) {
  const TempFolder folder;
  const auto body = test::make_random_body(1, 3, 3, true);
  try {
    write_flex_body(body, folder.at("missing/body.h5"));
    FAIL();
  } catch (const ComputationError& e) {
    EXPECT_EQ(e.items().front().id, "hdf5.write");
    EXPECT_EQ(e.exit_code(), 3);
  }
  // A folder in the place of the file: the rename fails last.
  std::filesystem::create_directories(folder.at("body.h5/inside"));
  EXPECT_THROW(write_flex_body(body, folder.at("body.h5")), ComputationError);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.get_path()))
    files += entry.is_regular_file() ? 1 : 0;
  EXPECT_EQ(files, 0);
}

/// In a child process, so that the library's clean-up at the end of a program is seen too.
[[noreturn]] void write_on_a_full_disk(const std::string& folder, long limit) {
  int code = 1;
  try {
    const test::FullDisk disk(limit);
    write_flex_body(test::make_random_body(1, 20, 30, true), folder + "/body.h5");
  } catch (const ComputationError& e) {
    const bool says_why = std::string(e.what()).find("No space left on device") != std::string::npos;
    const bool is_empty = std::filesystem::is_empty(folder);
    code = e.items().front().id == "hdf5.write" && says_why && is_empty ? 42 : 2;
  }
  std::exit(code);
}

TEST(FlexBodyFile, FullDiskIsReportedAndNothingIsLeft) {
  for (const long limit : {0L, 5000L, 100000L, 300000L}) {
    const TempFolder folder;
    EXPECT_EXIT(write_on_a_full_disk(folder.get_path(), limit), testing::ExitedWithCode(42), "^$") << limit;
  }
}

TEST(ModesFile, RoundTripIsExact) {
  const TempFolder folder;
  const auto modes = test::make_random_modes(11, 5, 4);
  write_modes(modes, folder.at("modes.h5"));
  EXPECT_TRUE(test::are_identical(read_modes(folder.at("modes.h5")), modes));
}

TEST(Info, ListsEveryDatasetWithItsMeaning) {
  const TempFolder folder;
  write_flex_body(test::make_random_body(7, 4, 3, true), folder.at("body.h5"));
  const FileInfo info = read_info(folder.at("body.h5"));
  EXPECT_EQ(info.attributes.at("format"), "bough-flexbody");
  EXPECT_THAT(info.attributes.at("source"), HasSubstr("größe.toml, bbbb"));
  bool found_phi = false, found_method = false;
  for (const auto& object : info.objects) {
    if (object.type != "attribute") {
      EXPECT_FALSE(object.description.empty()) << object.path;
      EXPECT_FALSE(object.dims.empty()) << object.path;
    }
    if (object.path == "/modes/phi") {
      found_phi = true;
      EXPECT_EQ(object.shape, "3 x 6 x 4");
      EXPECT_EQ(object.type, "float64");
    }
    if (object.path == "/integrals@method") {
      found_method = true;
      EXPECT_EQ(object.description, "exact");
    }
  }
  EXPECT_TRUE(found_phi && found_method);
  EXPECT_EQ(collect_ids([&] { read_info(folder.at("none.h5")); }), std::vector<std::string>{"hdf5.cannot-open"});
}

TEST(Sha256, NistVectors) {
  // FIPS 180-2 appendix B and the empty message.
  const TempFolder folder;
  EXPECT_EQ(calc_sha256(folder.write("empty", "")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(calc_sha256(folder.write("abc", "abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(calc_sha256(folder.write("two", "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(calc_sha256(folder.write("million", std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(collect_ids([&] { calc_sha256(folder.at("none")); }), std::vector<std::string>{"hdf5.cannot-open"});
}

}  // namespace
}  // namespace bough::hdf5
