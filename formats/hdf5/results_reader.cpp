#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <set>
#include <thread>

#include "base/part_file.hpp"
#include "base/version.hpp"
#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/detail/results_layout.hpp"
#include "formats/hdf5/detail/results_reader.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::hdf5 {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Paths of all datasets below `group` ("" is the root), each under the first of its names.
void collect_datasets(FileReader& file, const std::string& group, std::set<haddr_t>& seen,
                      std::vector<std::string>& paths) {
  for (const auto& name : file.get_children(group.empty() ? "/" : group)) {
    const std::string path = group + "/" + name;
    if (path == "/checkpoint" || path == "/events" || path == "/system" || path == "/settings" || path == "/resumed")
      continue;
    const Handle object(H5Oopen(file.get(), path.c_str(), H5P_DEFAULT), H5Oclose);
    if (!object.is_valid() || !seen.insert(get_address(object.get())).second) continue;
    const H5I_type_t type = H5Iget_type(object.get());
    if (type == H5I_GROUP) collect_datasets(file, path, seen, paths);
    if (type == H5I_DATASET) paths.push_back(path);
  }
}

int get_rank(const FileReader& file, const std::string& path) {
  const Handle dataset(H5Dopen2(file.get(), path.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  return H5Sget_simple_extent_ndims(space.get());
}

ResultsFile read_once(const std::string& path) {
  FileReader file(path, kResultsFormat, kResultsFormatVersion);
  ResultsFile results;
  results.completed = file.read_integer_attribute("/", "completed", 0) != 0;
  results.reason = file.read_attribute("/", "reason");
  if (file.has("/system")) results.system_text = file.read_text("/system");
  results.energy_error = read_energy_error(file);
  // A run killed within a flush may have left a part of its last samples after the valid ones.
  const long committed = file.read_integer_attribute("/", kNumSamples, -1);
  const NumberArray time = file.read_array("/time", {-1}, true, committed);
  results.time = Eigen::Map<const Eigen::VectorXd>(time.data.data(), static_cast<Eigen::Index>(time.data.size()));
  std::vector<std::string> paths;
  const Handle root(H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose);
  std::set<haddr_t> seen{get_address(root.get())};
  collect_datasets(file, "", seen, paths);
  Eigen::Index rows = results.time.size();
  for (const auto& name : paths) {
    const bool is_vector = get_rank(file, name) == 1;
    const NumberArray array = file.read_array(name, is_vector ? Shape{-1} : Shape{-1, -1}, true, committed);
    const auto nt = static_cast<Eigen::Index>(array.shape[0]);
    const auto size = is_vector ? 1 : static_cast<Eigen::Index>(array.shape[1]);
    results.descriptions[name] = file.read_attribute(name, "description");
    results.dims[name] = file.read_attribute(name, "dims");
    results.units[name] = file.read_attribute(name, "units");
    if (name != "/time") results.channels[name] = Eigen::Map<const RowMajor>(array.data.data(), nt, size);
    rows = std::min(rows, nt);
  }
  results.time.conservativeResize(rows);
  for (auto& [unused, values] : results.channels) values.conservativeResize(rows, Eigen::NoChange);
  results.events = read_events(file);
  file.throw_if_errors();
  return results;
}

bool is_being_written(const std::string& path) {
  std::error_code error;
  const auto written = std::filesystem::last_write_time(path, error);
  return !error && std::filesystem::file_time_type::clock::now() - written < std::chrono::seconds(2);
}

long read_count(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return -1;
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  std::int64_t count = -1;
  if (H5Sget_simple_extent_npoints(space.get()) != 1 || H5Aread(attribute.get(), H5T_NATIVE_INT64, &count) < 0)
    return -1;
  return static_cast<long>(count);
}

bool read_checkpoint_from(FileReader& file, const std::string& group, records::Checkpoint& checkpoint) {
  checkpoint = {};
  const std::string state = group + "/state";
  if (!file.has(group + "/time") || !file.has(state)) return false;
  checkpoint.time = file.read_number(group + "/time");
  checkpoint.state = file.read_vector(state, -1);
  if (file.has(group + "/memory")) {
    for (const auto& name : file.get_children(group + "/memory"))
      checkpoint.memory.emplace_back(name, file.read_vector(group + "/memory/" + name, -1));
  }
  const Handle dataset(H5Dopen2(file.get(), state.c_str(), H5P_DEFAULT), H5Dclose);
  checkpoint.num_samples = read_count(dataset.get(), kNumSamples);
  checkpoint.num_events = read_count(dataset.get(), kNumEvents);
  const Handle attribute(H5Aopen(dataset.get(), kChecksum, H5P_DEFAULT), H5Aclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  std::int64_t checksum = 0;
  return attribute.is_valid() && H5Sget_simple_extent_npoints(space.get()) == 1 &&
         H5Aread(attribute.get(), H5T_NATIVE_INT64, &checksum) >= 0 && checksum == calc_checksum(checkpoint);
}

/// A flush of the running program can fall into the reading: looks again a moment later, in no step with its flushes.
template <class Read>
auto read_patiently(const std::string& path, const Read& read) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  for (int attempt = 0; std::chrono::steady_clock::now() < end; ++attempt) {
    try {
      return read();
    } catch (const InputError&) {
      if (!is_being_written(path)) throw;
      std::this_thread::sleep_for(std::chrono::milliseconds(5 + 7 * (attempt % 6)));
    }
  }
  return read();
}

}  // namespace

std::vector<records::EventRecord> read_events(FileReader& file) {
  std::vector<records::EventRecord> events;
  if (!file.has("/events/time") || !file.has("/events/what")) return events;
  const Eigen::VectorXd times = file.read_vector("/events/time", -1, true);
  const auto what = file.read_strings("/events/what", -1);
  const auto source = file.has("/events/source") ? file.read_strings("/events/source", -1) : std::vector<std::string>();
  const auto count = std::min(static_cast<std::size_t>(times.size()), what.size());
  for (std::size_t i = 0; i < count; ++i)
    events.push_back({times[static_cast<Eigen::Index>(i)], what[i], i < source.size() ? source[i] : std::string()});
  return events;
}

double read_real_attribute(hid_t object, const char* name, double otherwise) {
  if (H5Aexists(object, name) <= 0) return otherwise;
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  double value = otherwise;
  if (H5Sget_simple_extent_npoints(space.get()) == 1) H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value);
  return value;
}

double read_energy_error(FileReader& file) {
  if (!file.has("/energy")) return std::numeric_limits<double>::quiet_NaN();
  const Handle group(H5Oopen(file.get(), "/energy", H5P_DEFAULT), H5Oclose);
  return read_real_attribute(group.get(), kEnergyError, std::numeric_limits<double>::quiet_NaN());
}

ResultsFile read_results(const std::string& path) {
  return read_patiently(path, [&] { return read_once(path); });
}

RunInputs read_run_inputs(const std::string& path) {
  return read_patiently(path, [&] {
    FileReader file(path, kResultsFormat, kResultsFormatVersion);
    RunInputs inputs;
    inputs.system_text = file.has("/system") ? file.read_text("/system") : std::string();
    inputs.source = file.read_source();
    inputs.completed = file.read_integer_attribute("/", "completed", 0) != 0;
    inputs.reason = file.read_attribute("/", "reason");
    file.throw_if_errors();
    return inputs;
  });
}

RunState read_run_state(const std::string& path) {
  RunState state;
  state.is_written = is_file_locked(path);
  return read_patiently(path, [&] {
    FileReader file(path, kResultsFormat, kResultsFormatVersion);
    state.completed = file.read_integer_attribute("/", "completed", 0) != 0;
    state.reason = file.read_attribute("/", "reason");
    const auto time = file.read_array("/time", {-1}, true, file.read_integer_attribute("/", kNumSamples, -1)).data;
    file.throw_if_errors();
    if (!time.empty()) state.time = time.back();
    return state;
  });
}

std::vector<records::EventRecord> read_events(const std::string& path) {
  return read_patiently(path, [&] {
    FileReader file(path, kResultsFormat, kResultsFormatVersion);
    auto events = read_events(file);
    file.throw_if_errors();
    return events;
  });
}

std::optional<records::Checkpoint> find_checkpoint(const std::string& path) {
  FileReader file(path, kResultsFormat, kResultsFormatVersion);
  records::Checkpoint checkpoint;
  if (read_checkpoint_from(file, "/checkpoint", checkpoint)) return checkpoint;
  if (read_checkpoint_from(file, "/checkpoint/previous", checkpoint)) return checkpoint;  // of version 0.2 and before
  if (!file.has("/checkpoint/state")) return {};
  throw InputError("hdf5.damaged", {path}, "/checkpoint is damaged", "start the run again");
}

records::Checkpoint read_checkpoint(const std::string& path) {
  if (auto found = find_checkpoint(path)) return *found;
  throw InputError("hdf5.missing", {path}, "/checkpoint is empty", "start the run again");
}

}  // namespace bough::hdf5
