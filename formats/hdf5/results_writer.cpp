#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <optional>

#include "base/diagnostic.hpp"
#include "formats/hdf5/detail/dimension_scales.hpp"
#include "formats/hdf5/detail/results_header.hpp"
#include "formats/hdf5/detail/results_layout.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::hdf5 {

namespace {

class ResultsWriter final : public records::ResultSink {
 public:
  ResultsWriter(std::string path, std::optional<double> resume_time, int flush_every)
      : file_(std::move(path)), resume_time_(resume_time), flush_every_(std::max(1, flush_every)) {}

  ~ResultsWriter() override {
    if (!file_.is_open()) return;
    QuietErrors quiet;
    try {
      if (!file_.has_failed()) flush();
    } catch (const Failure&) {
      // Nobody is left to tell; what was flushed before stays.
    }
    close();
  }

  void begin(const records::ResultsHeader& header) override {
    BOUGH_DEMAND(!header.channels.empty() && header.channels.front().path == "/time" &&
                 header.channels.front().size == 1);
    began_ = std::chrono::steady_clock::now();
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
    write_state(file_, false, "running");
    flush();
  }

  void write_sample(const Eigen::Ref<const Eigen::VectorXd>& sample) override {
    BOUGH_DEMAND(file_.is_open() && sample.size() == sample_size_);
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
    BOUGH_DEMAND(file_.is_open());
    events_.push_back(event);
  }

  void write_checkpoint(const records::Checkpoint& checkpoint) override {
    BOUGH_DEMAND(file_.is_open());
    QuietErrors quiet;
    flush();
    // The old one is saved first: whenever a kill comes, one of the two is whole.
    if (last_checkpoint_) write_checkpoint_to("/checkpoint/previous", *last_checkpoint_);
    last_checkpoint_ = checkpoint;
    last_checkpoint_->num_samples = static_cast<long>(num_written_);
    last_checkpoint_->num_events = static_cast<long>(num_events_);
    write_checkpoint_to("/checkpoint", *last_checkpoint_);
    file_.check_name();
  }

  void write_energy_error(double worst) override {
    BOUGH_DEMAND(file_.is_open());
    QuietErrors quiet;
    hdf5::write_energy_error(file_, worst);
  }

  void end(bool completed, const std::string& reason) override {
    BOUGH_DEMAND(file_.is_open());
    QuietErrors quiet;
    flush();
    add_wall_time(file_, std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count());
    write_state(file_, completed, reason);
    file_.flush();
    file_.check_name();
    file_.check(close(), "the file cannot be written");
  }

 private:
  struct Column {
    records::Channel channel;
    int offset = 0;
    Handle dataset;
  };

  bool close() {
    for (auto& column : columns_) column.dataset.reset();
    event_time_.reset();
    event_what_.reset();
    return file_.close();
  }

  void create(const records::ResultsHeader& header) {
    file_.create();
    write_provenance(file_, header);
    const Handle checkpoint(H5Gcreate2(file_.get(), "/checkpoint", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    file_.check(checkpoint.is_valid(), "/checkpoint cannot be written");
    write_settings(file_, header);
    for (auto& column : columns_) {
      const auto& channel = column.channel;
      column.dataset = file_.make_column(channel.path, channel.size, H5T_IEEE_F64LE, channel.description, channel.dims);
    }
    std::vector<std::string> users;
    for (std::size_t i = 1; i < columns_.size(); ++i) users.push_back(columns_[i].channel.path);
    file_.check(attach_scale(file_.get(), "/time", users), "the scale /time cannot be written");
    const Handle text = make_string_type();
    event_time_ = file_.make_column("/events/time", 1, H5T_IEEE_F64LE, "time of the event", "T");
    event_what_ = file_.make_column("/events/what", 1, text.get(), "what happened", "1");
  }

  void open_existing(const records::ResultsHeader& header);
  void write_checkpoint_to(const std::string& group, const records::Checkpoint& checkpoint);

  void flush() {
    errno = 0;
    const auto rows = static_cast<hsize_t>(num_buffered_);
    file_.check(reserve_space(file_.get(), calc_growth(rows)), "samples cannot be written");
    if (rows > 0) {
      for (auto& column : columns_) {
        file_.append(column.dataset, num_written_, rows, column.channel.size, H5T_NATIVE_DOUBLE,
                     buffer_.data() + static_cast<std::size_t>(column.offset * flush_every_));
      }
      num_written_ += rows;
      num_buffered_ = 0;
    }
    if (!events_.empty()) {
      const Handle text = make_string_type();
      std::vector<double> times;
      std::vector<const char*> texts;
      for (const auto& event : events_) {
        times.push_back(event.time);
        texts.push_back(event.what.c_str());
      }
      file_.append(event_time_, num_events_, events_.size(), 1, H5T_NATIVE_DOUBLE, times.data());
      file_.append(event_what_, num_events_, events_.size(), 1, text.get(), texts.data());
      num_events_ += events_.size();
      events_.clear();
    }
    file_.flush();
    // Told only when all of it is in the file: a kill within the flush above leaves the number of before.
    if (rows > 0 || !has_count_) {
      has_count_ = true;
      file_.write_integer(file_.get(), kNumSamples, static_cast<std::int64_t>(num_written_), H5T_STD_I64LE);
      file_.flush();
    }
  }

  /// At most what `rows` more samples and the waiting events take: whole chunks, and some for the indices.
  hsize_t calc_growth(hsize_t rows) const {
    hsize_t bytes = 64 * 1024 + 1024 * events_.size();
    for (const auto& column : columns_) {
      const hsize_t chunk = get_rows_per_chunk(column.channel.size);
      bytes += (rows / chunk + 2) * chunk * static_cast<hsize_t>(column.channel.size) * sizeof(double);
    }
    for (const auto& event : events_) bytes += event.what.size();
    return bytes;
  }

  GrowingFile file_;
  std::optional<double> resume_time_, skip_until_;
  int flush_every_ = 1, sample_size_ = 0, num_buffered_ = 0;
  std::chrono::steady_clock::time_point began_;
  hsize_t num_written_ = 0, num_events_ = 0;
  bool has_count_ = false;
  std::vector<Column> columns_;
  std::vector<double> buffer_;  ///< a block of flush_every rows per channel
  std::vector<records::EventRecord> events_;
  std::optional<records::Checkpoint> last_checkpoint_;
  Handle event_time_, event_what_;
};

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
    file_.check(made.is_valid() && write_text_attribute(made.get(), "description", description) &&
                    write_text_attribute(made.get(), "dims", "solver's own"),
                path + " cannot be written");
    return made;
  };
  const auto write_vector = [&](const std::string& path, const Eigen::VectorXd& values, const char* description) {
    Handle dataset = open_or_make(path, static_cast<hsize_t>(values.size()), description);
    const bool ok = values.size() == 0 ||
                    H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
    file_.check(ok, "the checkpoint cannot be written");
    return dataset;
  };
  write_vector(time_path, Eigen::VectorXd::Constant(1, checkpoint.time), "time of the checkpoint");
  const Handle state = write_vector(state_path, checkpoint.state, "state vector of the solver");
  for (const auto& [name, values] : checkpoint.memory) {
    if (values.size() > 0) write_vector(group + "/memory/" + name, values, "what the run carries on beside its state");
  }
  file_.write_integer(state.get(), kNumSamples, checkpoint.num_samples, H5T_STD_I64LE);
  file_.write_integer(state.get(), kNumEvents, checkpoint.num_events, H5T_STD_I64LE);
  file_.write_integer(state.get(), kChecksum, calc_checksum(checkpoint), H5T_STD_I64LE);
  file_.check(flush_file(file_.get()), "the checkpoint cannot be written");
}

void ResultsWriter::open_existing(const records::ResultsHeader& header) {
  file_.lock();
  // Everything that can be wrong is looked at before the file is touched.
  const ResultsFile old = read_results(file_.path());
  Diagnostics diagnostics;
  const std::string advice = "resume with the system file of the run, or start again";
  for (const auto& column : columns_) {
    const auto& channel = column.channel;
    if (channel.path == "/time") continue;
    const auto it = old.channels.find(channel.path);
    if (it == old.channels.end()) {
      diagnostics.error("hdf5.resume", {file_.path()}, "the file has no " + channel.path, advice);
    } else if (it->second.cols() != channel.size) {
      diagnostics.error("hdf5.resume", {file_.path()},
                        channel.path + " has " + std::to_string(it->second.cols()) + " components, expected " +
                            std::to_string(channel.size),
                        advice);
    }
  }
  const double time = *resume_time_;
  const double tolerance = 1e-12 * std::max(1.0, std::abs(time));
  const records::Checkpoint checkpoint = read_checkpoint(file_.path());
  const Eigen::Index total = old.time.size();
  Eigen::Index keep = 0;
  while (keep < total && old.time[keep] <= time + tolerance) ++keep;
  const double last_step = total > 1 ? old.time[total - 1] - old.time[total - 2] : 0;
  // Where samples are written of a part of the run only, their count tells what belongs to the checkpoint.
  const bool is_counted = checkpoint.time == time && checkpoint.num_samples >= 0;
  if (is_counted ? checkpoint.num_samples > total
                 : keep == 0 || (keep == total && old.time[total - 1] + 1.5 * last_step < time - tolerance)) {
    diagnostics.error("hdf5.resume", {file_.path()},
                      "the file ends at time " +
                          (total > 0 ? std::to_string(old.time[total - 1]) : std::string("(none)")) +
                          ", before the time " + std::to_string(time) + " to resume from",
                      "start the run again");
  }
  diagnostics.throw_if_errors();
  if (is_counted) keep = checkpoint.num_samples;
  if (keep > 0) skip_until_ = old.time[keep - 1] + tolerance;
  auto num_kept_events = std::count_if(old.events.begin(), old.events.end(),
                                       [&](const records::EventRecord& e) { return e.time <= time + tolerance; });
  if (is_counted && checkpoint.num_events >= 0 && checkpoint.num_events <= std::ssize(old.events))
    num_kept_events = checkpoint.num_events;
  if (checkpoint.time != time)
    throw InputError("hdf5.resume", {file_.path()},
                     "the file was continued to time " + std::to_string(checkpoint.time) + " in the meantime",
                     "resume it again");

  file_.open();
  last_checkpoint_ = checkpoint;
  for (auto& column : columns_) {
    column.dataset = file_.open_column(column.channel.path);
    file_.cut(column.dataset, static_cast<hsize_t>(keep));
  }
  event_time_ = file_.open_column("/events/time");
  event_what_ = file_.open_column("/events/what");
  num_written_ = static_cast<hsize_t>(keep);
  num_events_ = static_cast<hsize_t>(num_kept_events);
  file_.cut(event_time_, num_events_);
  file_.cut(event_what_, num_events_);
  write_settings(file_, header);
  write_resumed(file_, header, time);
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
