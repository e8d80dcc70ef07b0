#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>

#include "bough/base/diagnostic.hpp"
#include "bough/base/version.hpp"
#include "bough/formats/hdf5/detail/reader.hpp"
#include "bough/formats/hdf5/detail/results_layout.hpp"
#include "bough/formats/hdf5/files.hpp"

namespace bough::hdf5 {

namespace {

/// Rows per chunk: some 16 k numbers, so that long runs make few chunks and short ones waste little.
hsize_t get_chunk_rows(int size) { return static_cast<hsize_t>(std::clamp(16384 / std::max(1, size), 16, 1024)); }

/// Metadata stay in memory between flushes: a killed run then leaves the file as the last flush made it.
Handle make_growing_access() {
  Handle access = make_file_access();
  H5AC_cache_config_t config;
  config.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  H5Pget_mdc_config(access.get(), &config);
  config.evictions_enabled = false;
  config.incr_mode = H5C_incr__off;
  config.flash_incr_mode = H5C_flash_incr__off;
  config.decr_mode = H5C_decr__off;
  H5Pset_mdc_config(access.get(), &config);
  return access;
}

/// No chunk cache: samples go to the file as they are written, so that a full disk shows there and not in a flush.
Handle make_uncached_access() {
  Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access.get(), 1, 0, 1.0);
  return access;
}

class ResultsWriter final : public records::ResultSink {
 public:
  ResultsWriter(std::string path, std::optional<double> resume_time, int flush_every)
      : path_(std::move(path)), resume_time_(resume_time), flush_every_(std::max(1, flush_every)) {}

  ~ResultsWriter() override {
    if (!file_.is_valid()) return;
    QuietErrors quiet;
    try {
      if (!failed_) flush();
    } catch (const Failure&) {
      // Nobody is left to tell; what was flushed before stays.
    }
    close();
  }

  void begin(const records::ResultsHeader& header) override {
    BOUGH_DEMAND(!header.channels.empty() && header.channels.front().path == "/time" &&
                 header.channels.front().size == 1);
    QuietErrors quiet;
    sample_size_ = 0;
    for (const auto& channel : header.channels) {
      Column column;
      column.channel = channel;
      column.offset = sample_size_;
      sample_size_ += channel.size;
      columns_.push_back(std::move(column));
    }
    buffer_.resize(static_cast<std::size_t>(sample_size_ * flush_every_));
    if (resume_time_) {
      open_existing(header);
    } else {
      create(header);
    }
    set_state(false, "running");
    flush();
  }

  void write_sample(const Eigen::Ref<const Eigen::VectorXd>& sample) override {
    BOUGH_DEMAND(file_.is_valid() && sample.size() == sample_size_);
    // On resume the solver may give the sample of the checkpoint again.
    if (skip_until_ && sample[0] <= *skip_until_) return;
    skip_until_.reset();
    // Columns are kept apart, so that each goes to its dataset in one piece.
    for (const auto& column : columns_) {
      const auto size = static_cast<std::size_t>(column.channel.size);
      double* to = buffer_.data() + static_cast<std::size_t>(column.offset * flush_every_) +
                   static_cast<std::size_t>(num_buffered_) * size;
      std::copy_n(sample.data() + column.offset, size, to);
    }
    if (++num_buffered_ == flush_every_) {
      QuietErrors quiet;
      flush();
    }
  }

  void write_event(const records::EventRecord& event) override {
    BOUGH_DEMAND(file_.is_valid());
    events_.push_back(event);
  }

  void write_checkpoint(const records::Checkpoint& checkpoint) override {
    BOUGH_DEMAND(file_.is_valid());
    QuietErrors quiet;
    flush();
    // The old one is saved first: whenever a kill comes, one of the two is whole.
    if (last_checkpoint_) write_checkpoint_to("/checkpoint/previous", *last_checkpoint_);
    write_checkpoint_to("/checkpoint", checkpoint);
    last_checkpoint_ = checkpoint;
  }

  void end(bool completed, const std::string& reason) override {
    BOUGH_DEMAND(file_.is_valid());
    QuietErrors quiet;
    flush();
    set_state(completed, reason);
    check(flush_file(file_.get()), "the file cannot be written");
    check(close(), "the file cannot be written");
  }

 private:
  struct Column {
    records::Channel channel;
    int offset = 0;
    Handle dataset;
  };

  void check(bool ok, const std::string& what) {
    if (ok) return;
    failed_ = true;
    const int cause = errno;
    if (file_.is_valid()) abandon_writes(file_.get());
    errno = cause;
    const std::string reason = errno != 0 ? std::string(": ") + std::strerror(errno) : std::string();
    throw ComputationError("hdf5.write", {path_}, what + reason,
                           "check the folder, its permissions and the free space");
  }

  bool close() {
    for (auto& column : columns_) column.dataset.reset();
    event_time_.reset();
    event_what_.reset();
    return file_.reset();
  }

  void create(const records::ResultsHeader& header) {
    errno = 0;
    // A new file, not the old one emptied: who is reading the old one keeps it.
    std::error_code ignored;
    if (std::filesystem::is_regular_file(path_, ignored)) std::filesystem::remove(path_, ignored);
    check(make_empty_file(path_), "the file cannot be created");
    const Handle access = make_growing_access();
    file_ = Handle(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
    check(file_.is_valid(), "the file cannot be created");
    check(write_text_attribute(file_.get(), "format", kResultsFormat) &&
              write_text_attribute(file_.get(), "format_version", kResultsFormatVersion) &&
              write_text_attribute(file_.get(), "bough_version", get_version()),
          "the file cannot be written");
    write_source(header.source);
    const Handle checkpoint(H5Gcreate2(file_.get(), "/checkpoint", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    check(checkpoint.is_valid(), "/checkpoint cannot be written");
    write_header(header);
    for (auto& column : columns_) {
      column.dataset = make_column(column.channel.path, column.channel.size, H5T_IEEE_F64LE, column.channel.description,
                                   column.channel.dims);
    }
    const Handle text = make_string_type();
    event_time_ = make_column("/events/time", 1, H5T_IEEE_F64LE, "time of the event", "T");
    event_what_ = make_column("/events/what", 1, text.get(), "what happened", "1");
  }

  Handle make_column(const std::string& path, int size, hid_t type, const std::string& description,
                     const std::string& dims) {
    const int rank = size == 1 ? 1 : 2;
    const hsize_t shape[2] = {0, static_cast<hsize_t>(size)};
    const hsize_t most[2] = {H5S_UNLIMITED, shape[1]};
    const hsize_t chunk[2] = {get_chunk_rows(size), std::max<hsize_t>(1, shape[1])};
    const Handle space(H5Screate_simple(rank, shape, most), H5Sclose);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(creation.get(), rank, chunk);
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links.get(), 1);
    const Handle access = make_uncached_access();
    Handle dataset(H5Dcreate2(file_.get(), path.c_str(), type, space.get(), links.get(), creation.get(), access.get()),
                   H5Dclose);
    check(dataset.is_valid(), "dataset " + path + " cannot be written");
    check(write_text_attribute(dataset.get(), "description", description) &&
              write_text_attribute(dataset.get(), "dims", dims),
          "the attributes of " + path + " cannot be written");
    return dataset;
  }

  void write_header(const records::ResultsHeader& header) {
    const Handle type = make_string_type();
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    Handle system(exists(file_.get(), "/system") ? H5Dopen2(file_.get(), "/system", H5P_DEFAULT)
                                                 : H5Dcreate2(file_.get(), "/system", type.get(), space.get(),
                                                              H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                  H5Dclose);
    const char* text = header.system_text.c_str();
    check(system.is_valid() && H5Dwrite(system.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &text) >= 0 &&
              write_text_attribute(system.get(), "description", "the system file of the run, TOML") &&
              write_text_attribute(system.get(), "dims", "1"),
          "/system cannot be written");
    const Handle settings(exists(file_.get(), "/settings")
                              ? H5Gopen2(file_.get(), "/settings", H5P_DEFAULT)
                              : H5Gcreate2(file_.get(), "/settings", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                          H5Gclose);
    for (const auto& [name, value] : header.settings) {
      check(write_text_attribute(settings.get(), name, value), "setting " + name + " cannot be written");
    }
  }

  void write_source(const std::vector<std::pair<std::string, std::string>>& source) {
    const Handle type = make_string_type();
    const hsize_t shape[2] = {source.size(), 2};
    const Handle space(H5Screate_simple(2, shape, nullptr), H5Sclose);
    const Handle attribute(H5Acreate2(file_.get(), "source", type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    std::vector<const char*> data;
    for (const auto& [name, hash] : source) {
      data.push_back(name.c_str());
      data.push_back(hash.c_str());
    }
    check(attribute.is_valid() && (data.empty() || H5Awrite(attribute.get(), type.get(), data.data()) >= 0),
          "attribute source cannot be written");
  }

  void set_state(bool completed, const std::string& reason) {
    errno = 0;
    const int flag = completed ? 1 : 0;
    if (H5Aexists(file_.get(), "completed") <= 0) {
      const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
      const Handle made(H5Acreate2(file_.get(), "completed", H5T_STD_I32LE, space.get(), H5P_DEFAULT, H5P_DEFAULT),
                        H5Aclose);
      check(made.is_valid(), "attribute completed cannot be written");
    }
    const Handle attribute(H5Aopen(file_.get(), "completed", H5P_DEFAULT), H5Aclose);
    check(H5Awrite(attribute.get(), H5T_NATIVE_INT, &flag) >= 0 && write_text_attribute(file_.get(), "reason", reason),
          "attribute completed cannot be written");
  }

  void open_existing(const records::ResultsHeader& header);
  void cut(Handle& dataset, hsize_t rows);
  void append(Handle& dataset, hsize_t first, hsize_t rows, int size, hid_t type, const void* data);
  void write_checkpoint_to(const std::string& group, const records::Checkpoint& checkpoint);

  void flush() {
    errno = 0;
    const auto rows = static_cast<hsize_t>(num_buffered_);
    check(reserve_space(file_.get(), calc_growth(rows)), "samples cannot be written");
    if (rows > 0) {
      for (auto& column : columns_) {
        append(column.dataset, num_written_, rows, column.channel.size, H5T_NATIVE_DOUBLE,
               buffer_.data() + static_cast<std::size_t>(column.offset * flush_every_));
      }
      num_written_ += rows;
      num_buffered_ = 0;
    }
    if (!events_.empty()) {
      const Handle text = make_string_type();
      for (const auto& event : events_) {
        const char* what = event.what.c_str();
        append(event_time_, num_events_, 1, 1, H5T_NATIVE_DOUBLE, &event.time);
        append(event_what_, num_events_, 1, 1, text.get(), &what);
        ++num_events_;
      }
      events_.clear();
    }
    check(flush_file(file_.get()), "the file cannot be written");
    // Told only when all of it is in the file: a kill within the flush above leaves the number of before.
    if (rows > 0 || !has_count_) {
      write_count();
      check(flush_file(file_.get()), "the file cannot be written");
    }
  }

  void write_count() {
    if (!has_count_ && H5Aexists(file_.get(), kNumSamples) <= 0) {
      const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
      const Handle made(H5Acreate2(file_.get(), kNumSamples, H5T_STD_I64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT),
                        H5Aclose);
      check(made.is_valid(), "attribute num_samples cannot be written");
    }
    has_count_ = true;
    const auto count = static_cast<std::int64_t>(num_written_);
    const Handle attribute(H5Aopen(file_.get(), kNumSamples, H5P_DEFAULT), H5Aclose);
    check(H5Awrite(attribute.get(), H5T_NATIVE_INT64, &count) >= 0, "attribute num_samples cannot be written");
  }

  /// At most what `rows` more samples and the waiting events take: whole chunks, and some for the indices.
  hsize_t calc_growth(hsize_t rows) const {
    hsize_t bytes = 64 * 1024 + 1024 * events_.size();
    for (const auto& column : columns_) {
      const hsize_t chunk = get_chunk_rows(column.channel.size);
      bytes += (rows / chunk + 2) * chunk * static_cast<hsize_t>(column.channel.size) * sizeof(double);
    }
    for (const auto& event : events_) bytes += event.what.size();
    return bytes;
  }

  std::string path_;
  std::optional<double> resume_time_, skip_until_;
  int flush_every_ = 1, sample_size_ = 0, num_buffered_ = 0;
  hsize_t num_written_ = 0, num_events_ = 0;
  bool failed_ = false, has_count_ = false;
  std::vector<Column> columns_;
  std::vector<double> buffer_;  ///< a block of flush_every rows per channel
  std::vector<records::EventRecord> events_;
  std::optional<records::Checkpoint> last_checkpoint_;
  Handle file_, event_time_, event_what_;
};

void ResultsWriter::append(Handle& dataset, hsize_t first, hsize_t rows, int size, hid_t type, const void* data) {
  const int rank = size == 1 ? 1 : 2;
  const hsize_t shape[2] = {first + rows, static_cast<hsize_t>(size)};
  const hsize_t start[2] = {first, 0}, block[2] = {rows, static_cast<hsize_t>(size)};
  bool ok = H5Dset_extent(dataset.get(), shape) >= 0;
  if (ok && size == 0) return;  // a rigid body's eta: rows without entries
  const Handle file_space(H5Dget_space(dataset.get()), H5Sclose);
  const Handle memory_space(H5Screate_simple(rank, block, nullptr), H5Sclose);
  ok = ok && H5Sselect_hyperslab(file_space.get(), H5S_SELECT_SET, start, nullptr, block, nullptr) >= 0;
  ok = ok && H5Dwrite(dataset.get(), type, memory_space.get(), file_space.get(), H5P_DEFAULT, data) >= 0;
  check(ok, "samples cannot be written");
}

void ResultsWriter::write_checkpoint_to(const std::string& group, const records::Checkpoint& checkpoint) {
  errno = 0;
  const std::string time_path = group + "/time", state_path = group + "/state";
  auto open_or_make = [&](const std::string& path, hsize_t size, const char* description) {
    if (exists(file_.get(), path)) {
      Handle found(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Dclose);
      const Handle space(H5Dget_space(found.get()), H5Sclose);
      if (static_cast<hsize_t>(H5Sget_simple_extent_npoints(space.get())) == size) return found;
      found.reset();
      H5Ldelete(file_.get(), path.c_str(), H5P_DEFAULT);
    }
    const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links.get(), 1);
    Handle made(
        H5Dcreate2(file_.get(), path.c_str(), H5T_IEEE_F64LE, space.get(), links.get(), H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    check(made.is_valid() && write_text_attribute(made.get(), "description", description) &&
              write_text_attribute(made.get(), "dims", "solver's own"),
          path + " cannot be written");
    return made;
  };
  const Handle time = open_or_make(time_path, 1, "time of the checkpoint");
  const Handle state =
      open_or_make(state_path, static_cast<hsize_t>(checkpoint.state.size()), "state vector of the solver");
  const std::int64_t checksum = calc_checksum(checkpoint.time, checkpoint.state);
  bool ok = H5Dwrite(time.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &checkpoint.time) >= 0;
  ok = ok && (checkpoint.state.size() == 0 ||
              H5Dwrite(state.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, checkpoint.state.data()) >= 0);
  if (H5Aexists(state.get(), kChecksum) <= 0) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle made(H5Acreate2(state.get(), kChecksum, H5T_STD_I64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT),
                      H5Aclose);
    ok = ok && made.is_valid();
  }
  const Handle attribute(H5Aopen(state.get(), kChecksum, H5P_DEFAULT), H5Aclose);
  ok = ok && H5Awrite(attribute.get(), H5T_NATIVE_INT64, &checksum) >= 0;
  check(ok && flush_file(file_.get()), "the checkpoint cannot be written");
}

void ResultsWriter::cut(Handle& dataset, hsize_t rows) {
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  hsize_t shape[2] = {0, 0};
  H5Sget_simple_extent_dims(space.get(), shape, nullptr);
  shape[0] = rows;
  check(H5Dset_extent(dataset.get(), shape) >= 0, "the file cannot be cut back to the checkpoint");
}

void ResultsWriter::open_existing(const records::ResultsHeader& header) {
  // Everything that can be wrong is looked at before the file is touched.
  const ResultsFile old = read_results(path_);
  Diagnostics diagnostics;
  const std::string advice = "resume with the system file of the run, or start again";
  for (const auto& column : columns_) {
    const auto& channel = column.channel;
    if (channel.path == "/time") continue;
    const auto it = old.channels.find(channel.path);
    if (it == old.channels.end()) {
      diagnostics.error("hdf5.resume", {path_}, "the file has no " + channel.path, advice);
    } else if (it->second.cols() != channel.size) {
      diagnostics.error("hdf5.resume", {path_},
                        channel.path + " has " + std::to_string(it->second.cols()) + " components, expected " +
                            std::to_string(channel.size),
                        advice);
    }
  }
  const double time = *resume_time_;
  const double tolerance = 1e-12 * std::max(1.0, std::abs(time));
  const Eigen::Index total = old.time.size();
  Eigen::Index keep = 0;
  while (keep < total && old.time[keep] <= time + tolerance) ++keep;
  const double last_step = total > 1 ? old.time[total - 1] - old.time[total - 2] : 0;
  if (keep == 0 || (keep == total && old.time[total - 1] + 1.5 * last_step < time - tolerance)) {
    diagnostics.error("hdf5.resume", {path_},
                      "the file ends at time " +
                          (total > 0 ? std::to_string(old.time[total - 1]) : std::string("(none)")) +
                          ", before the time " + std::to_string(time) + " to resume from",
                      "start the run again");
  }
  diagnostics.throw_if_errors();
  skip_until_ = old.time[keep - 1] + tolerance;
  const auto num_kept_events = std::count_if(old.events.begin(), old.events.end(),
                                             [&](const records::EventRecord& e) { return e.time <= time + tolerance; });
  const records::Checkpoint checkpoint = read_checkpoint(path_);

  const Handle access = make_growing_access();
  file_ = Handle(H5Fopen(path_.c_str(), H5F_ACC_RDWR, access.get()), H5Fclose);
  check(file_.is_valid(), "the file cannot be opened for writing");
  last_checkpoint_ = checkpoint;
  const Handle uncached = make_uncached_access();
  for (auto& column : columns_) {
    column.dataset = Handle(H5Dopen2(file_.get(), column.channel.path.c_str(), uncached.get()), H5Dclose);
    cut(column.dataset, static_cast<hsize_t>(keep));
  }
  event_time_ = Handle(H5Dopen2(file_.get(), "/events/time", uncached.get()), H5Dclose);
  event_what_ = Handle(H5Dopen2(file_.get(), "/events/what", uncached.get()), H5Dclose);
  num_written_ = static_cast<hsize_t>(keep);
  num_events_ = static_cast<hsize_t>(num_kept_events);
  cut(event_time_, num_events_);
  cut(event_what_, num_events_);
  write_header(header);
}

}  // namespace

std::unique_ptr<records::ResultSink> make_results_writer(const std::string& path, int flush_every) {
  return std::make_unique<ResultsWriter>(path, std::nullopt, flush_every);
}

std::unique_ptr<records::ResultSink> make_results_appender(const std::string& path, double resume_time,
                                                           int flush_every) {
  return std::make_unique<ResultsWriter>(path, resume_time, flush_every);
}

}  // namespace bough::hdf5
