#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>

#include "base/diagnostic.hpp"
#include "formats/hdf5/files.hpp"
#include "tests/formats/hdf5/full_disk.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temp_folder.hpp"

namespace bough::hdf5 {
namespace {

using Eigen::VectorXd;
using test::TempFolder;
using testing::HasSubstr;

/// Commits with every flush.
constexpr std::chrono::milliseconds kAtOnce{0};

records::ResultsHeader make_header() {
  records::ResultsHeader header;
  header.system_text = "name = \"pendulum ü\"\n[simulation]\nduration = 1.0\n";
  header.source = {{"system.toml", std::string(64, 'd')}};
  header.max_samples = 100000;
  header.settings = {{"integrator", "adams"}, {"relative_tolerance", "1e-08"}};
  header.channels = {{"/time", 1, "time", "T"},
                     {"/bodies/arm/position", 3, "origin, inertial axes", "L"},
                     {"/bodies/arm/eta", 0, "modal coordinates", "E"},
                     {"/sensors/tip", 3, "tip, body axes", "L"},
                     {"/energy/kinetic", 1, "kinetic energy", "M L^2/T^2"}};
  return header;
}

/// A sample that says where and when it belongs.
VectorXd make_sample(int k) {
  VectorXd sample(8);
  sample << 0.1 * k, k + 0.25, k + 0.5, k + 0.75, -k, -2 * k, -3 * k, 1000 + k;
  return sample;
}

void expect_samples(const ResultsFile& file, int count) {
  ASSERT_EQ(file.time.size(), count);
  ASSERT_EQ(file.channels.size(), 4u);
  EXPECT_EQ(file.channels.at("/bodies/arm/eta").cols(), 0);
  for (int k = 0; k < count; ++k) {
    const VectorXd s = make_sample(k);
    EXPECT_EQ(file.time[k], s[0]);
    EXPECT_EQ(file.channels.at("/bodies/arm/position").row(k), s.segment(1, 3).transpose());
    EXPECT_EQ(file.channels.at("/sensors/tip").row(k), s.segment(4, 3).transpose());
    EXPECT_EQ(file.channels.at("/energy/kinetic")(k, 0), s[7]);
  }
}

TEST(ResultsFile, RoundTripOverManyFlushesAndChunks) {
  const TempFolder folder;
  auto sink = make_results_writer(folder.at("r.h5"), {7});
  sink->begin(make_header());
  for (int k = 0; k < 2500; ++k) {
    sink->write_sample(make_sample(k));
    if (k == 40) sink->write_event({4.0, "hinge stop reached: größer"});
  }
  sink->write_event({249.9, "end"});
  sink->end(true, "reached the end");
  const ResultsFile file = read_results(folder.at("r.h5"));
  expect_samples(file, 2500);
  EXPECT_TRUE(file.completed);
  EXPECT_EQ(file.reason, "reached the end");
  EXPECT_EQ(file.system_text, make_header().system_text);
  ASSERT_EQ(file.events.size(), 2u);
  EXPECT_EQ(file.events[0].time, 4.0);
  EXPECT_EQ(file.events[0].what, "hinge stop reached: größer");
  EXPECT_EQ(file.descriptions.at("/sensors/tip"), "tip, body axes");
  EXPECT_EQ(read_info(folder.at("r.h5")).attributes.at("format"), "bough-results");
}

TEST(ResultsFile, H5pySeesTheContractWhileTheRunGoesOn) {
  const TempFolder folder;
  auto sink = make_results_writer(folder.at("r.h5"), {10, kAtOnce});
  sink->begin(make_header());
  for (int k = 0; k < 25; ++k) sink->write_sample(make_sample(k));
  const std::string script = BOUGH_SOURCE_DIR "/tests/formats/hdf5/check_results.py " + folder.at("r.h5");
  EXPECT_EQ(test::run_python(script + " 20 0 running"), 0);
  expect_samples(read_results(folder.at("r.h5")), 20);
  sink->write_checkpoint({2.4, VectorXd::LinSpaced(5, 0, 1)});
  EXPECT_EQ(test::run_python(script + " 25 0 running"), 0);
  sink->end(false, "stopped by the user");
  EXPECT_EQ(test::run_python(script + " 25 0 'stopped by the user'"), 0);
}

TEST(ResultsFile, KilledRunKeepsWhatItHad) {
  const TempFolder folder;
  const std::string path = folder.at("r.h5");
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    auto sink = make_results_writer(path, {50, kAtOnce});
    sink->begin(make_header());
    for (int k = 0; k < 1234; ++k) {
      sink->write_sample(make_sample(k));
      if (k == 1000) sink->write_checkpoint({100.0, VectorXd::Constant(4, 2.5)});
    }
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  const ResultsFile file = read_results(path);
  expect_samples(file, 1201);  // 1001 by the checkpoint, then whole batches of 50
  EXPECT_FALSE(file.completed);
  EXPECT_EQ(file.reason, "running");
  EXPECT_EQ(read_checkpoint(path).time, 100.0);
  EXPECT_EQ(read_checkpoint(path).state, VectorXd::Constant(4, 2.5));
}

/// 100 samples with a checkpoint at the 61st, an event before it and one after it.
void write_killed_run(const std::string& path) {
  auto sink = make_results_writer(path, {10, kAtOnce});
  sink->begin(make_header());
  for (int k = 0; k < 100; ++k) {
    sink->write_sample(make_sample(k));
    if (k == 60) {
      sink->write_event({5.5, "before"});
      sink->write_checkpoint({6.0, VectorXd::Constant(3, 6)});
    }
    if (k == 70) sink->write_event({7.0, "after the checkpoint"});
  }
  sink->end(false, "killed");
}

TEST(ResultsFile, ResumeCutsBackToTheCheckpointAndGoesOn) {
  const TempFolder folder;
  const std::string path = folder.at("r.h5");
  write_killed_run(path);
  const auto checkpoint = read_checkpoint(path);
  auto sink = make_results_appender(path, checkpoint.time, {10, kAtOnce});
  sink->begin(make_header());
  expect_samples(read_results(path), 100);  // the old file, until the new one has more
  EXPECT_EQ(read_results(path).reason, "killed");
  for (int k = 60; k < 130; ++k) sink->write_sample(make_sample(k));  // the first is there already
  sink->write_event({12.0, "late"});
  sink->end(true, "done");
  const ResultsFile file = read_results(path);
  expect_samples(file, 130);
  ASSERT_EQ(file.events.size(), 2u);
  EXPECT_EQ(file.events[0].what, "before");
  EXPECT_EQ(file.events[1].what, "late");
  EXPECT_TRUE(file.completed);
  EXPECT_EQ(read_checkpoint(path).state, VectorXd::Constant(3, 6));
}

TEST(ResultsFile, AContinuationIsSeenOnceItHasAsManySamples) {
  const TempFolder folder;
  const std::string path = folder.at("r.h5");
  write_killed_run(path);
  auto sink = make_results_appender(path, 6.0, {10, kAtOnce});
  sink->begin(make_header());
  for (int k = 61; k < 99; ++k) sink->write_sample(make_sample(k));
  EXPECT_EQ(read_results(path).reason, "killed");
  for (int k = 99; k < 118; ++k) sink->write_sample(make_sample(k));  // no new checkpoint
  const ResultsFile file = read_results(path);
  EXPECT_EQ(file.reason, "running");
  expect_samples(file, 111);  // 61 of the checkpoint and five groups of ten
  EXPECT_EQ(read_checkpoint(path).time, 6.0);
  sink->end(true, "done");
  expect_samples(read_results(path), 118);
}

// A user library may change the working folder.
TEST(ResultsFile, ARelativePathIsThatOfTheStart) {
  const TempFolder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.at("."));
  auto sink = make_results_writer("r.h5", {10, kAtOnce});
  sink->begin(make_header());
  std::filesystem::current_path("/");
  for (int k = 0; k < 25; ++k) sink->write_sample(make_sample(k));
  sink->end(true, "done");
  std::filesystem::current_path(before);
  expect_samples(read_results(folder.at("r.h5")), 25);
}

TEST(ResultsFile, ResumeOfAnotherRunIsRefusedAndTheFileUntouched) {
  const TempFolder folder;
  const std::string path = folder.at("r.h5");
  {
    auto sink = make_results_writer(path, {10, kAtOnce});
    sink->begin(make_header());
    for (int k = 0; k < 10; ++k) sink->write_sample(make_sample(k));
    sink->write_checkpoint({0.9, VectorXd::Zero(2)});
    sink->end(true, "done");
  }
  const std::string before = test::read_bytes(path);
  auto header = make_header();
  header.channels[3].size = 2;
  header.channels.push_back({"/sensors/more", 1, "", ""});
  try {
    make_results_appender(path, 0.9)->begin(header);
    FAIL();
  } catch (const InputError& e) {
    ASSERT_EQ(e.items().size(), 2u);
    EXPECT_EQ(e.items()[0].id, "hdf5.resume");
    EXPECT_THAT(e.what(), HasSubstr("/sensors/tip has 3 components, expected 2"));
    EXPECT_THAT(e.what(), HasSubstr("the file has no /sensors/more"));
  }
  EXPECT_THROW(make_results_appender(path, 7.0)->begin(make_header()), InputError);
  EXPECT_THROW(make_results_appender(folder.at("none.h5"), 0.9)->begin(make_header()), InputError);
  EXPECT_EQ(test::read_bytes(path), before);
}

TEST(ResultsFile, CorruptedCheckpointIsReported) {
  const TempFolder folder;
  const std::string path = folder.at("r.h5");
  {
    auto sink = make_results_writer(path, {10, kAtOnce});
    sink->begin(make_header());
    sink->write_sample(make_sample(0));
    sink->write_checkpoint({1.0, VectorXd::Constant(4, 1)});
    sink->write_checkpoint({2.0, VectorXd::Constant(4, 2)});
    sink->end(true, "done");
  }
  EXPECT_EQ(read_checkpoint(path).time, 2.0);
  EXPECT_EQ(read_checkpoint(path).state, VectorXd::Constant(4, 2));
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t state = H5Dopen2(file, "/checkpoint/state", H5P_DEFAULT);
  const double data[4] = {9, 2, 2, 2};
  H5Dwrite(state, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
  H5Dclose(state);
  H5Fclose(file);
  try {
    read_checkpoint(path);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.items().front().id, "hdf5.damaged");
  }
}

TEST(ResultsFile, WithoutACheckpointThereIsNothingToResume) {
  const TempFolder folder;
  auto sink = make_results_writer(folder.at("r.h5"));
  sink->begin(make_header());
  sink->end(true, "done");
  try {
    read_checkpoint(folder.at("r.h5"));
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.items().front().id, "hdf5.missing");
  }
  EXPECT_EQ(read_results(folder.at("r.h5")).time.size(), 0);
}

TEST(ResultsFile, NoFolderIsAWriteError) {
  const TempFolder folder;
  auto sink = make_results_writer(folder.at("missing/r.h5"));
  try {
    sink->begin(make_header());
    FAIL();
  } catch (const ComputationError& e) {
    EXPECT_EQ(e.items().front().id, "hdf5.write");
    EXPECT_THAT(e.what(), HasSubstr("No such file or directory"));
  }
}

/// 42 when the full disk is reported and what was there before can still be read.
[[noreturn]] void run_on_a_full_disk(const std::string& path, long limit) {
  int code = 1;
  int written = 0;
  try {
    const test::FullDisk disk(limit);
    auto sink = make_results_writer(path, {100, kAtOnce});
    sink->begin(make_header());
    for (; written < 100000; ++written) sink->write_sample(make_sample(written));
  } catch (const ComputationError& e) {
    const auto samples = static_cast<int>(read_results(path).time.size());
    const bool is_reported = e.items().front().id == "hdf5.write";
    code = is_reported && samples > 0 && samples >= written - 100 && samples <= written + 1 ? 42 : 2;
  }
  std::exit(code);
}

TEST(ResultsFile, FullDiskKeepsWhatWasWrittenBefore) {
  for (const long limit : {400000L, 600001L, 900000L}) {
    const TempFolder folder;
    EXPECT_EXIT(run_on_a_full_disk(folder.at("r.h5"), limit), testing::ExitedWithCode(42), "^$") << limit;
  }
}

}  // namespace
}  // namespace bough::hdf5
