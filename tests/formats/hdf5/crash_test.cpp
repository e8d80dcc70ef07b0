// Results files at every instant: after each write of a run, and after power cuts that lose any of the writes since the
// last sync. The oracle is the HDF5 library, which reads each state, and the samples that were given.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "base/diagnostic.hpp"
#include "formats/hdf5/detail/handle.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/hdf5/table_file.hpp"
#include "tests/formats/hdf5/full_disk.hpp"
#include "tests/support/temp_folder.hpp"

namespace bough::hdf5 {
namespace {

using Eigen::VectorXd;
using test::DiskCall;
using test::TempFolder;
using Calls = std::vector<DiskCall>;

constexpr std::size_t kPage = 4096;
/// Their headers fill several pages.
constexpr int kNumSensors = 12;
/// Samples of the run; some come after its last checkpoint.
constexpr int kNumSamples = 33;
/// Samples of a run and its continuation.
constexpr int kNumContinued = 41;
constexpr ResultsWriterOptions kEveryFive{5, std::chrono::milliseconds(0)};

records::ResultsHeader make_header(long max_samples) {
  records::ResultsHeader header;
  header.system_text = "[simulation]\nduration = 1.0\n";
  header.settings = {{"integrator", "rk4"}};
  header.max_samples = max_samples;
  header.channels = {{"/time", 1, "time", "T"}, {"/energy/kinetic", 1, "kinetic energy", "F L"}};
  for (int i = 0; i < kNumSensors; ++i)
    header.channels.push_back({"/sensors/s" + std::to_string(i), 3, "a sensor", "L"});
  return header;
}

VectorXd make_sample(int k) {
  VectorXd sample(2 + 3 * kNumSensors);
  for (int i = 1; i < sample.size(); ++i) sample[i] = k + 0.001 * i;
  sample[0] = 0.1 * k;
  return sample;
}

records::EventRecord make_event(int k) {
  return {0.1 * k, "event " + std::to_string(k) + std::string(static_cast<std::size_t>(k), '.'), "event low"};
}

/// Samples first to last - 1; an event with every third, a checkpoint with every seventh.
void write_part(records::ResultSink& sink, int first, int last) {
  for (int k = first; k < last; ++k) {
    sink.write_sample(make_sample(k));
    if (k % 3 == 0) sink.write_event(make_event(k));
    if (k % 7 == 0) {
      sink.write_energy_error(1e-9 * k);
      sink.write_checkpoint({0.1 * k, VectorXd::Constant(700 + k, k), {{"energy", VectorXd::Constant(3, k)}}});
    }
  }
}

/// A dataset of the library's own reading: all of it, in rows.
std::vector<double> read_rows(hid_t file, const std::string& path) {
  const Handle dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  const auto count = dataset.is_valid() ? H5Sget_simple_extent_npoints(space.get()) : -1;
  std::vector<double> values(static_cast<std::size_t>(std::max<hssize_t>(0, count)));
  const bool is_read = count >= 0 && (count == 0 || H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL,
                                                            H5P_DEFAULT, values.data()) >= 0);
  EXPECT_TRUE(is_read) << path;
  return values;
}

std::vector<std::string> read_texts(hid_t file, const std::string& path) {
  const Handle dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle space(H5Dget_space(dataset.get()), H5Sclose), type = make_string_type();
  const auto count = dataset.is_valid() ? H5Sget_simple_extent_npoints(space.get()) : -1;
  std::vector<char*> data(static_cast<std::size_t>(std::max<hssize_t>(0, count)));
  const bool is_read =
      count >= 0 && (count == 0 || H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()) >= 0);
  EXPECT_TRUE(is_read) << path;
  std::vector<std::string> texts;
  for (char* text : data) {
    texts.emplace_back(text ? text : "");
    H5free_memory(text);
  }
  return texts;
}

std::int64_t read_integer(hid_t object, const char* name) {
  std::int64_t value = -1;
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  EXPECT_TRUE(attribute.is_valid() && H5Aread(attribute.get(), H5T_NATIVE_INT64, &value) >= 0) << name;
  return value;
}

/// Demands a sound file, as the HDF5 library reads it: all samples that it counts, the events and the checkpoint as
/// they were given. \return the number of samples.
int demand_sound(const std::string& path, const std::string& where) {
  const testing::ScopedTrace trace(__FILE__, __LINE__, where);
  const QuietErrors quiet;
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  EXPECT_TRUE(file.is_valid());
  if (!file.is_valid()) return -1;
  const auto count = static_cast<int>(read_integer(file.get(), "num_samples"));
  // A run that is marked complete is never resumed.
  if (read_integer(file.get(), "completed") != 0) EXPECT_THAT(count, testing::AnyOf(kNumSamples, kNumContinued));
  const auto demand_channel = [&](const std::string& channel, int first, int size) {
    const auto values = read_rows(file.get(), channel);
    EXPECT_GE(values.size(), static_cast<std::size_t>(count * size)) << channel;
    for (int k = 0; k < count && values.size() >= static_cast<std::size_t>(count * size); ++k)
      for (int i = 0; i < size; ++i)
        EXPECT_EQ(values[static_cast<std::size_t>(k * size + i)], make_sample(k)[first + i]) << channel;
  };
  demand_channel("/time", 0, 1);
  demand_channel("/energy/kinetic", 1, 1);
  for (int i = 0; i < kNumSensors; ++i) demand_channel("/sensors/s" + std::to_string(i), 2 + 3 * i, 3);
  const auto what = read_texts(file.get(), "/events/what"), source = read_texts(file.get(), "/events/source");
  const auto times = read_rows(file.get(), "/events/time");
  for (std::size_t i = 0; i < std::min({times.size(), what.size(), source.size()}); ++i) {
    const auto event = make_event(3 * static_cast<int>(i));
    EXPECT_EQ(times[i], event.time);
    EXPECT_EQ(what[i], event.what);
    EXPECT_EQ(source[i], event.source);
  }
  if (H5Lexists(file.get(), "/checkpoint/state", H5P_DEFAULT) > 0) {
    const double k = std::round(read_rows(file.get(), "/checkpoint/time").at(0) * 10);
    EXPECT_EQ(read_rows(file.get(), "/checkpoint/state"), std::vector<double>(static_cast<std::size_t>(700 + k), k));
    EXPECT_EQ(read_rows(file.get(), "/checkpoint/memory/energy"), std::vector<double>(3, k));
    const Handle state(H5Dopen2(file.get(), "/checkpoint/state", H5P_DEFAULT), H5Dclose);
    EXPECT_LE(read_integer(state.get(), "num_samples"), count);
  }
  return count;
}

int count_samples(const std::string& path) {
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  return static_cast<int>(read_integer(file.get(), "num_samples"));
}

void apply(const DiskCall& call, std::string& bytes) {
  if (call.kind == DiskCall::Truncate) bytes.resize(call.place);
  if (call.kind != DiskCall::Write) return;
  bytes.resize(std::max(bytes.size(), static_cast<std::size_t>(call.place) + call.data.size()));
  bytes.replace(call.place, call.data.size(), call.data);
}

/// Some of the pages of a write.
void apply_torn(const DiskCall& call, std::mt19937& random, std::string& bytes) {
  if (call.kind == DiskCall::Truncate && random() % 2 == 0) apply(call, bytes);
  if (call.kind != DiskCall::Write) return;
  for (std::size_t at = 0; at < call.data.size();) {
    const auto size = std::min(call.data.size() - at, kPage - (call.place + at) % kPage);
    if (random() % 2 == 0) apply({DiskCall::Write, {}, call.place + at, call.data.substr(at, size)}, bytes);
    at += size;
  }
}

Calls log_run(const TempFolder& folder, bool ends = true) {
  const test::DiskLog log(folder.get_path());
  auto sink = make_results_writer(folder.at("r.h5"), kEveryFive);
  sink->begin(make_header(60));
  write_part(*sink, 0, kNumSamples);
  if (ends) sink->end(true, "stopped by an event");
  sink.reset();
  return log.calls();
}

std::size_t find_rename(const Calls& calls) {
  const auto at = std::find_if(calls.begin(), calls.end(), [](const auto& c) { return c.kind == DiskCall::Rename; });
  return static_cast<std::size_t>(at - calls.begin());
}

/// Demands a sound file with no fewer samples after each call since the rename. \return the last number of samples.
int replay(const TempFolder& folder, const Calls& calls, int count = 0) {
  std::string bytes;
  for (std::size_t i = 0; i < calls.size(); ++i) {
    apply(calls[i], bytes);
    if (i <= find_rename(calls) || calls[i].kind == DiskCall::Sync) continue;
    folder.write("state.h5", bytes);
    const int found = demand_sound(folder.at("state.h5"), "after call " + std::to_string(i));
    EXPECT_GE(found, count) << i;
    count = found;
  }
  return count;
}

TEST(Crash, EveryWriteOfARunLeavesAWholeFile) {
  const TempFolder folder;
  const auto calls = log_run(folder);
  ASSERT_LT(find_rename(calls), 12u);
  EXPECT_GT(calls.size(), 80u);
  EXPECT_EQ(replay(folder, calls), kNumSamples);
  const auto whole = read_results(folder.at("r.h5"));
  EXPECT_TRUE(whole.completed);
  EXPECT_EQ(whole.reason, "stopped by an event");
  EXPECT_EQ(whole.events.size(), 11u);
}

TEST(Crash, AWriteCutAtAPageLeavesAWholeFile) {
  const TempFolder folder;
  const auto calls = log_run(folder);
  std::string bytes;
  int count = 0;
  for (std::size_t i = 0; i < calls.size(); ++i) {
    const auto& call = calls[i];
    const auto first = kPage - call.place % kPage;
    if (i > find_rename(calls) && call.kind == DiskCall::Write) {
      for (auto size = first; size < call.data.size(); size += kPage) {
        std::string torn = bytes;
        apply({DiskCall::Write, {}, call.place, call.data.substr(0, size)}, torn);
        folder.write("state.h5", torn);
        EXPECT_GE(demand_sound(folder.at("state.h5"), "within call " + std::to_string(i)), count);
      }
    }
    apply(call, bytes);
    if (i < find_rename(calls)) continue;
    folder.write("state.h5", bytes);
    count = count_samples(folder.at("state.h5"));
  }
}

TEST(Crash, APowerCutLosesNoSampleThatIsCounted) {
  const TempFolder folder;
  const auto calls = log_run(folder);
  std::mt19937 random(17);
  for (int trial = 0; trial < 150; ++trial) {
    const auto first = find_rename(calls) + 2;  // the folder is synced
    const auto end = first + random() % (calls.size() - first) + 1;
    auto synced = end;
    while (calls[synced - 1].kind != DiskCall::Sync) --synced;
    std::string bytes;
    for (std::size_t i = 0; i < synced; ++i) apply(calls[i], bytes);
    folder.write("state.h5", bytes);
    const auto count = count_samples(folder.at("state.h5"));
    for (std::size_t i = synced; i < end; ++i) apply_torn(calls[i], random, bytes);
    folder.write("state.h5", bytes);
    EXPECT_GE(demand_sound(folder.at("state.h5"), "trial " + std::to_string(trial)), count) << trial;
  }
}

TEST(Crash, AContinuationLeavesTheOldFileUntilItHasMore) {
  const TempFolder folder;
  log_run(folder, false);
  const std::string path = folder.at("r.h5"), before = test::read_bytes(path);
  const auto old_count = read_results(path).time.size();
  const auto checkpoint = read_checkpoint(path);
  ASSERT_LT(checkpoint.num_samples, old_count);
  Calls calls;
  {
    const test::DiskLog log(folder.get_path());
    auto sink = make_results_appender(path, checkpoint.time, kEveryFive);
    sink->begin(make_header(60));
    EXPECT_TRUE(test::read_bytes(path) == before);
    write_part(*sink, static_cast<int>(checkpoint.num_samples) - 1, kNumContinued);
    sink->end(true, "");
    calls = log.calls();
  }
  const auto renamed = find_rename(calls);
  for (std::size_t i = 0; i < calls.size(); ++i)
    if (calls[i].kind == DiskCall::Write) EXPECT_EQ(calls[i].path != path, i < renamed) << i;
  EXPECT_EQ(calls[renamed - 1].kind, DiskCall::Sync);
  EXPECT_EQ(replay(folder, calls, static_cast<int>(old_count)), kNumContinued);
}

TEST(Crash, AContinuationThatIsKilledEarlyChangesNothing) {
  const TempFolder folder;
  log_run(folder, false);
  const std::string path = folder.at("r.h5"), before = test::read_bytes(path);
  const auto checkpoint = read_checkpoint(path);
  {
    auto sink = make_results_appender(path, checkpoint.time, kEveryFive);
    sink->begin(make_header(60));
    sink->end(false, "stopped on request");
  }
  EXPECT_TRUE(test::read_bytes(path) == before);
}

/// All that is written is synced before the name, and the name afterwards.
void demand_synced(const Calls& calls, const std::string& path) {
  const auto renamed = find_rename(calls);
  ASSERT_LT(renamed + 1, calls.size());
  EXPECT_EQ(calls[renamed].path, path);
  std::map<std::string, bool> is_synced;
  for (std::size_t i = 0; i < calls.size(); ++i) {
    if (calls[i].kind == DiskCall::Write || calls[i].kind == DiskCall::Truncate) {
      EXPECT_LT(i, renamed);
      is_synced[calls[i].path] = false;
    }
    if (calls[i].kind == DiskCall::Sync) is_synced[calls[i].path] = true;
    if (i == renamed)
      for (const auto& [name, synced] : is_synced) EXPECT_TRUE(synced) << name;
  }
  EXPECT_EQ(calls.back().kind, DiskCall::Sync);
  EXPECT_EQ(calls.back().path, path.substr(0, path.rfind('/')));
}

TEST(Crash, TablesAndStreamedResultsAreSyncedBeforeAndAfterTheirName) {
  const TempFolder folder;
  {
    const test::DiskLog log(folder.get_path());
    OutcomeTable table{"campaign", "0", {1, 2}, {}};
    table.columns.push_back({"/parameters/E", "Young's modulus", Eigen::MatrixXd::Ones(2, 1), {}});
    write_outcomes(table, folder.at("outcomes.h5"));
    demand_synced(log.calls(), folder.at("outcomes.h5"));
  }
  const test::DiskLog log(folder.get_path());
  StaticWriter file(folder.at("static.h5"));
  for (int i = 1; i <= 3; ++i) {
    records::StaticSubcase subcase;
    subcase.id = i;
    subcase.displacement = VectorXd::Constant(12, i);
    file.add(subcase);
    file.start_sync();
  }
  records::StaticResult whole;
  whole.dof_map = Eigen::MatrixXi::Ones(12, 2);
  file.commit(whole);
  demand_synced(log.calls(), folder.at("static.h5"));
}

TEST(Crash, ManyBodiesTakeWhatTheirNumbersTake) {
  const TempFolder folder;
  records::ResultsHeader header = make_header(3);
  header.channels.resize(1);
  header.system_text = std::string(180'000, '#');
  for (int b = 0; b < 1000; ++b) {
    const auto body = "/bodies/b" + std::to_string(b) + "/", hinge = "/hinges/h" + std::to_string(b) + "/";
    for (const char* name : {"position", "velocity", "angular_velocity"})
      header.channels.push_back({body + name, 3, "of the body origin Bo, in the inertial frame", "L"});
    header.channels.push_back({body + "quaternion", 4, "orientation of the body frame", "1"});
    for (const char* name : {"q", "qdot", "force"}) header.channels.push_back({hinge + name, 1, "of the hinge", "1"});
    for (const char* name : {"reaction_force", "reaction_moment"})
      header.channels.push_back({hinge + name, 3, "of the parent on the child", "F"});
  }
  auto sink = make_results_writer(folder.at("r.h5"));
  sink->begin(header);
  VectorXd sample(1 + 22 * 1000);
  for (int k = 0; k < 3; ++k) {
    sample.setLinSpaced(k, k + 1);
    sink->write_sample(sample);
  }
  sink->end(true, "");
  EXPECT_LT(std::filesystem::file_size(folder.at("r.h5")), 5'000'000u);
  const auto file = read_results(folder.at("r.h5"));
  EXPECT_EQ(file.channels.size(), 9000u);
  EXPECT_EQ(file.channels.at("/hinges/h999/reaction_moment")(2, 2), sample[22000]);
}

}  // namespace
}  // namespace bough::hdf5
