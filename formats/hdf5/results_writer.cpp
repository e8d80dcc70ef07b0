#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "base/diagnostic.hpp"
#include "base/file_roles.hpp"
#include "base/version.hpp"
#include "formats/hdf5/detail/growing_file.hpp"
#include "formats/hdf5/detail/results_image.hpp"
#include "formats/hdf5/detail/results_layout.hpp"
#include "formats/hdf5/detail/results_reader.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::hdf5 {

namespace {

using Clock = std::chrono::steady_clock;

/// Rows that wait in memory, in bytes.
constexpr std::uint64_t kBufferBytes = 16 << 20;
/// Pieces that the headers of the channels are written in.
constexpr std::size_t kPiece = 1 << 20;
/// Runs shorter than that are committed at their end alone.
constexpr std::chrono::milliseconds kFirstCommit{100};
/// Samples that a run of unknown length may have.
constexpr std::uint64_t kUnboundedRows = 1 << 20;
constexpr std::uint64_t kFirstEvents = 16;
/// [bytes] of samples: a file with at most as many has its final size from the beginning.
constexpr std::uint64_t kShortBytes = 4 << 20;
/// A checkpoint block is written while the file may still lead to the one before or, after a power cut, to the one
/// before that.
constexpr std::size_t kNumSlots = 3;
constexpr const char* kRunning = "running";

class ResultsWriter final : public records::ResultSink {
 public:
  ResultsWriter(std::string path, std::optional<double> resume_time, const ResultsWriterOptions& options)
      : file_(std::move(path)), resume_time_(resume_time), options_(options) {}

  ~ResultsWriter() override {
    if (!file_.is_open() || file_.has_failed()) return;
    try {
      flush();
    } catch (const Failure&) {
      // There is no caller to report to; what was committed before stays.
    }
  }

  void begin(const records::ResultsHeader& header) override {
    began_ = last_commit_ = Clock::now();
    channels_ = header.channels;
    for (const auto& channel : channels_) {
      firsts_.push_back(sample_size_);
      sample_size_ += static_cast<std::uint64_t>(channel.size);
    }
    if (resume_time_) {
      continue_file(header);
    } else {
      file_.create();
      create({header, {}}, header.max_samples > 0 ? static_cast<std::uint64_t>(header.max_samples) : kUnboundedRows);
      file_.publish();
    }
  }

  void write_sample(const Eigen::Ref<const Eigen::VectorXd>& sample) override {
    BOUGH_DEMAND(file_.is_open() && static_cast<std::uint64_t>(sample.size()) == sample_size_);
    // On resume the solver may give the sample of the checkpoint again.
    if (skip_until_ && sample[0] <= *skip_until_) return;
    skip_until_.reset();
    if (num_rows_ == buffer_first_ + buffer_rows_) flush_rows();
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      const auto size = static_cast<std::uint64_t>(channels_[i].size);
      std::copy_n(sample.data() + firsts_[i], size,
                  buffer_.data() + firsts_[i] * buffer_rows_ + (num_rows_ - buffer_first_) * size);
    }
    ++num_rows_;
    const bool is_batch = ++num_since_look_ >= static_cast<std::uint64_t>(options_.flush_every);
    if (is_batch) num_since_look_ = 0;
    if (is_batch || options_.commit_every.count() > 0) commit_if_due();
  }

  void write_event(const records::EventRecord& event) override {
    BOUGH_DEMAND(file_.is_open());
    new_events_.push_back(event);
  }

  void write_checkpoint(const records::Checkpoint& checkpoint) override {
    BOUGH_DEMAND(file_.is_open());
    checkpoint_ = checkpoint;
    checkpoint_->num_samples = static_cast<long>(num_rows_);
    checkpoint_->num_events = static_cast<long>(event_rows_.size() + new_events_.size());
    commit_if_due();
  }

  void write_energy_error(double worst) override {
    BOUGH_DEMAND(file_.is_open());
    energy_error_ = worst;
  }

  void flush() override {
    BOUGH_DEMAND(file_.is_open());
    if (num_rows_ > num_committed_ || checkpoint_) commit();
  }

  void end(bool completed, const std::string& reason) override {
    BOUGH_DEMAND(file_.is_open());
    completed_ = completed;
    reason_ = reason;
    // A continuation that ends before the place that the killed run had reached is given up: the old file has more.
    if (!file_.is_published() && !completed && num_rows_ < num_safe_rows_) return file_.close();
    commit();
    file_.sync();
    if (file_.size() > used_) {
      file_.truncate(used_);
      file_.sync();
    }
    if (!file_.is_published()) file_.publish();
    file_.check_name();
    file_.close();
  }

 private:
  void commit_if_due() {
    // A continuation is seen from when it has as many samples as the old file: its first commit waits for that alone.
    if (!file_.is_published() && num_rows_ < num_safe_rows_) return;
    const auto now = Clock::now();
    const auto wait = has_committed_ ? options_.commit_every : std::min(options_.commit_every, kFirstCommit);
    if (now - last_commit_ >= wait) commit();
  }

  /// The file with its channels, without a row.
  void create(const ResultsOrigin& origin, std::uint64_t max_rows) {
    groups_ = plan_row_groups(max_rows, sample_size_);
    buffer_rows_ = std::clamp<std::uint64_t>(kBufferBytes / (sizeof(double) * sample_size_), 1, groups_.chunk_rows);
    buffer_.resize(sample_size_ * buffer_rows_);
    image_.emplace(origin, groups_, kRunning);
    state_.reason = image_->find_text(kRunning);
    used_ = image_->image().end();
    events_.emplace(used_, kFirstEvents, *image_);
    used_ = events_->end();
    image_->set_events(events_->headers());
    announced_ = used_;
    announce(kShortBytes);
    const std::string& bytes = image_->image().bytes();
    file_.write(image_->image().begin(), bytes.data(), bytes.size());
    file_.write(events_->begin(), events_->bytes().data(), events_->bytes().size());
    write_first_page();
  }

  void continue_file(const records::ResultsHeader& header);
  void copy_rows(hid_t old, std::uint64_t rows);

  /// Space at the end of the file.
  Address allocate(std::uint64_t size) { return std::exchange(used_, used_ + size); }

  void write_first_page() {
    state_.end = announced_;
    const std::string page = image_->encode_first_page(state_);
    file_.write(0, page.data(), page.size());
  }

  /// Writes the buffered rows to the file; they become valid with the next commit.
  void flush_rows() {
    const std::uint64_t rows = groups_.chunk_rows;
    for (auto row = std::max(buffer_first_, num_flushed_); row < num_rows_;) {
      const auto group = row / rows, first = row % rows, count = std::min(num_rows_ - row, rows - first);
      if (group == group_places_.size()) group_places_.push_back(allocate(groups_.group_bytes()));
      BOUGH_DEMAND(group < groups_.max_groups && group < group_places_.size());
      const char* begin = nullptr;
      std::uint64_t place = 0, size = 0;
      for (std::size_t i = 0; i < channels_.size(); ++i) {
        const auto width = static_cast<std::uint64_t>(channels_[i].size) * sizeof(double);
        const auto* from =
            reinterpret_cast<const char*>(buffer_.data() + firsts_[i] * buffer_rows_) + (row - buffer_first_) * width;
        const auto to = group_places_[group] + rows * firsts_[i] * sizeof(double) + first * width;
        // Whole groups are in one piece, in memory and in the file.
        if (begin && begin + size == from && place + size == to) {
          size += count * width;
          continue;
        }
        if (size > 0) file_.write(place, begin, size);
        begin = from, place = to, size = count * width;
      }
      if (size > 0) file_.write(place, begin, size);
      row += count;
    }
    num_flushed_ = num_rows_;
    if (num_rows_ == buffer_first_ + buffer_rows_) buffer_first_ = num_rows_;
  }

  /// Blocks that nothing leads to yet: the texts and rows of new events. Whether their headers change.
  bool write_new_events() {
    if (new_events_.empty()) return false;
    TextHeap heap;
    for (const auto& event : new_events_)
      for (const auto& text : {event.what, event.source})
        if (!text.empty()) heap.add(text);
    place_heap(heap);
    const auto first = event_rows_.size();
    for (const auto& event : new_events_) {
      EventTable::Row row;
      append_number(row[0], get_bits(event.time), 8);
      row[1] = heap.encode(event.what);
      row[2] = heap.encode(event.source);
      event_rows_.push_back(std::move(row));
    }
    new_events_.clear();
    const auto count = event_rows_.size();
    const bool is_full = count > events_->capacity();
    if (is_full) {
      events_.emplace(used_, 2 * count, *image_);
      used_ = events_->end();
    }
    for (std::size_t i = is_full ? 0 : first; i < count; ++i) events_->set_row(i, event_rows_[i]);
    if (is_full) {
      events_->set_num_rows(count);
      file_.write(events_->begin(), events_->bytes().data(), events_->bytes().size());
      return true;
    }
    for (int c = 0; c < EventTable::kNumColumns; ++c) {
      const auto begin = events_->find_row(c, first), end = events_->find_row(c, count);
      file_.write(begin, events_->bytes().data() + (begin - events_->begin()), end - begin);
    }
    return true;
  }

  void place_heap(TextHeap& heap) {
    FileImage block(used_);
    heap.place(block);
    used_ = block.end();
    if (!block.bytes().empty()) file_.write(block.begin(), block.bytes().data(), block.bytes().size());
  }

  /// To the slot that has not been in use for longest.
  void write_checkpoint_block() {
    auto& slot = slots_[next_slot_];
    auto block = encode_checkpoint(*checkpoint_, slot.place, *image_);
    if (block.bytes.size() > slot.size) {
      // The place decides a little about the size: headers cross no border of a page.
      slot.size = block.bytes.size() + kPage;
      slot.place = allocate(slot.size);
      block = encode_checkpoint(*checkpoint_, slot.place, *image_);
      BOUGH_DEMAND(block.bytes.size() <= slot.size);
    }
    file_.write(slot.place, block.bytes.data(), block.bytes.size());
    state_.checkpoint = block.header;
    next_slot_ = (next_slot_ + 1) % kNumSlots;
  }

  /// Announces row groups ahead of their use, at least `bytes`: the end of the file rarely has to be written for them,
  /// and a copy that is made meanwhile includes it.
  void announce(std::uint64_t bytes) {
    const auto size = groups_.group_bytes();
    const auto end =
        used_ + size * std::min((bytes + size - 1) / size, groups_.max_groups - std::uint64_t{group_places_.size()});
    if (end > announced_ && file_.try_extend(end)) announced_ = end;
  }

  /// Everything given so far, in an order that leaves a whole file after each write, and after a power cut whichever of
  /// the writes since the last sync have reached the disk (docs/adr/0027): new blocks and a new end of the file before
  /// headers that need them, all of these before the first page with the number of samples. The rows of uncounted
  /// samples may come in any order.
  void commit() {
    errno = 0;
    const auto old = state_;
    flush_rows();
    const bool has_events = write_new_events();
    if (checkpoint_) write_checkpoint_block();
    if (reason_) {
      TextHeap heap;
      if (!reason_->empty()) heap.add(*reason_);
      place_heap(heap);
      state_.reason = heap.encode(*reason_);
    }
    const bool has_grown = used_ > announced_;
    if (has_events || has_grown) {
      file_.extend(used_);
      file_.sync();
    }
    if (has_grown) {
      announced_ = used_;
      const auto next = std::exchange(state_, old);
      write_first_page();
      state_ = next;
      file_.sync();
    }
    for (; num_placed_groups_ < group_places_.size(); ++num_placed_groups_)
      image_->add_group(group_places_[num_placed_groups_]);
    image_->set_num_rows(num_rows_);
    if (energy_error_) image_->set_energy_error(*energy_error_);
    if (has_events) {
      events_->set_num_rows(event_rows_.size());
      image_->set_events(events_->headers());
      file_.write(events_->begin(), events_->bytes().data(), events_->headers_size());
    }
    const auto& image = image_->image();
    for (auto at = image_->changing_begin(); at < image_->changing_end(); at += kPiece)
      file_.write(at, image.bytes().data() + (at - image.begin()), std::min(kPiece, image_->changing_end() - at));
    if (reason_)
      announced_ = used_;
    else
      announce(2 * (used_ - last_used_));
    file_.sync();
    state_.num_samples = static_cast<std::int64_t>(num_rows_);
    if (reason_) {  // on no page before: a file that a kill leaves here is not complete
      state_.completed = completed_;
      state_.wall_time = wall_time_before_ + std::chrono::duration<double>(Clock::now() - began_).count();
    }
    write_first_page();
    num_committed_ = num_rows_;
    num_since_look_ = 0;
    last_used_ = used_;
    has_committed_ = true;
    if (file_.is_published()) {
      file_.check_name();
    } else if (checkpoint_ && num_rows_ >= num_safe_rows_ && !reason_) {
      file_.publish();
    }
    checkpoint_.reset();
    last_commit_ = Clock::now();
  }

  GrowingFile file_;
  std::optional<double> resume_time_, skip_until_;
  ResultsWriterOptions options_;
  Clock::time_point began_, last_commit_;
  std::vector<records::Channel> channels_;
  std::vector<std::uint64_t> firsts_;  ///< of the channels in a sample
  std::uint64_t sample_size_ = 0;
  RowGroups groups_;
  std::optional<ResultsImage> image_;
  ResultsState state_;

  std::vector<double> buffer_;  ///< a block of buffer_rows_ rows per channel
  std::uint64_t buffer_rows_ = 0, buffer_first_ = 0;
  std::uint64_t num_rows_ = 0, num_flushed_ = 0, num_committed_ = 0, num_since_look_ = 0;
  std::uint64_t num_safe_rows_ = 0;  ///< of the file that is continued
  std::vector<Address> group_places_;
  std::uint64_t num_placed_groups_ = 0;

  std::optional<EventTable> events_;
  std::vector<EventTable::Row> event_rows_;
  std::vector<records::EventRecord> new_events_;
  std::optional<records::Checkpoint> checkpoint_;  ///< the latest, not committed
  struct Slot {
    Address place = 0;
    std::uint64_t size = 0;
  };
  std::array<Slot, kNumSlots> slots_;
  std::size_t next_slot_ = 0;
  std::optional<double> energy_error_;
  std::optional<std::string> reason_;  ///< at the end
  bool completed_ = false;             ///< the same
  double wall_time_before_ = 0;
  bool has_committed_ = false;
  Address used_ = 0, announced_ = 0, last_used_ = 0;
};

/// The first rows of the old file, a piece of a channel at a time, to row groups of this one.
void ResultsWriter::copy_rows(hid_t old, std::uint64_t rows) {
  std::vector<double> data;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const auto size = static_cast<hsize_t>(channels_[i].size);
    if (size == 0) continue;
    const Handle dataset(H5Dopen2(old, channels_[i].path.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle space(H5Dget_space(dataset.get()), H5Sclose);
    const int rank = H5Sget_simple_extent_ndims(space.get());
    const std::uint64_t piece = std::max<std::uint64_t>(1, kBufferBytes / (sizeof(double) * size));
    for (std::uint64_t row = 0; row < rows;) {
      const auto group = row / groups_.chunk_rows, in_group = row % groups_.chunk_rows;
      const auto count = std::min({piece, rows - row, groups_.chunk_rows - in_group});
      while (group >= group_places_.size()) group_places_.push_back(allocate(groups_.group_bytes()));
      const hsize_t start[2] = {row, 0}, block[2] = {count, size};
      data.resize(count * size);
      const Handle memory(H5Screate_simple(rank, block, nullptr), H5Sclose);
      const bool is_read =
          rank >= 1 && rank <= 2 &&
          H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start, nullptr, block, nullptr) >= 0 &&
          H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, memory.get(), space.get(), H5P_DEFAULT, data.data()) >= 0;
      if (!is_read)
        throw InputError("hdf5.damaged", {file_.path()}, channels_[i].path + " cannot be read", "start the run again");
      file_.write(group_places_[group] + (groups_.chunk_rows * firsts_[i] + in_group * size) * sizeof(double),
                  reinterpret_cast<const char*>(data.data()), data.size() * sizeof(double));
      row += count;
    }
  }
}

/// A new file with the rows and events up to the checkpoint. The old one stays until the new one has as many rows.
void ResultsWriter::continue_file(const records::ResultsHeader& header) {
  QuietErrors quiet;
  FileRoles::allow_both(file_.path());
  file_.lock();
  FileReader old(file_.path(), kResultsFormat, kResultsFormatVersion);
  Diagnostics diagnostics;
  const std::string advice = "resume with the system file of the run, or start again";
  const long committed = old.read_integer_attribute("/", kNumSamples, -1);
  const auto time = old.read_array("/time", {-1}, true, committed).data;
  old.throw_if_errors();
  for (const auto& channel : channels_) {
    if (channel.path == "/time") continue;
    if (!old.has(channel.path)) {
      diagnostics.error("hdf5.resume", {file_.path()}, "the file has no " + channel.path, advice);
      continue;
    }
    const Handle dataset(H5Dopen2(old.get(), channel.path.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle space(H5Dget_space(dataset.get()), H5Sclose);
    hsize_t shape[2] = {0, 1};
    const int rank = dataset.is_valid() ? H5Sget_simple_extent_ndims(space.get()) : -1;
    if (rank == 1 || rank == 2) H5Sget_simple_extent_dims(space.get(), shape, nullptr);
    if (shape[1] != static_cast<hsize_t>(channel.size) || rank != (channel.size == 1 ? 1 : 2))
      diagnostics.error(
          "hdf5.resume", {file_.path()},
          channel.path + " has " + std::to_string(shape[1]) + " components, expected " + std::to_string(channel.size),
          advice);
    else if (shape[0] < time.size())
      diagnostics.error("hdf5.resume", {file_.path()}, channel.path + " has fewer samples than /time", advice);
  }
  const double from = *resume_time_;
  const double tolerance = 1e-12 * std::max(1.0, std::abs(from));
  const records::Checkpoint checkpoint = read_checkpoint(file_.path());
  const auto total = static_cast<long>(time.size());
  long keep = 0;
  while (keep < total && time[static_cast<std::size_t>(keep)] <= from + tolerance) ++keep;
  const double last_step = total > 1 ? time.back() - time[time.size() - 2] : 0;
  // If only a part of the run is written, the number of samples determines those before the checkpoint.
  const bool is_counted = checkpoint.time == from && checkpoint.num_samples >= 0;
  if (is_counted ? checkpoint.num_samples > total
                 : keep == 0 || (keep == total && time.back() + 1.5 * last_step < from - tolerance)) {
    diagnostics.error("hdf5.resume", {file_.path()},
                      "the file ends at time " + (total > 0 ? std::to_string(time.back()) : std::string("(none)")) +
                          ", before the time " + std::to_string(from) + " to resume from",
                      "start the run again");
  }
  diagnostics.throw_if_errors();
  if (checkpoint.time != from)
    throw InputError("hdf5.resume", {file_.path()},
                     "the file was continued to time " + std::to_string(checkpoint.time) + " in the meantime",
                     "resume it again");
  if (is_counted) keep = checkpoint.num_samples;
  if (keep > 0) skip_until_ = time[static_cast<std::size_t>(keep - 1)] + tolerance;
  auto events = read_events(old);
  auto num_kept =
      std::count_if(events.begin(), events.end(), [&](const auto& e) { return e.time <= from + tolerance; });
  if (is_counted && checkpoint.num_events >= 0 && checkpoint.num_events <= std::ssize(events))
    num_kept = checkpoint.num_events;
  events.resize(static_cast<std::size_t>(num_kept));

  ResultsOrigin origin{header, {}};
  origin.header.system_text = old.has("/system") ? old.read_text("/system") : header.system_text;
  origin.header.source = old.read_source();
  if (origin.header.source.empty()) origin.header.source = header.source;
  if (old.has("/resumed/time") && old.has("/resumed/system")) {
    const auto times = old.read_vector("/resumed/time", -1, true);
    const auto texts = old.read_strings("/resumed/system", -1);
    for (std::size_t i = 0; i < texts.size() && static_cast<Eigen::Index>(i) < times.size(); ++i)
      origin.resumed.emplace_back(times[static_cast<Eigen::Index>(i)], texts[i]);
  }
  origin.resumed.emplace_back(from, header.system_text);
  wall_time_before_ = read_real_attribute(old.get(), kWallTime, 0);
  const double worst = read_energy_error(old);
  if (!std::isnan(worst)) energy_error_ = worst;
  old.throw_if_errors();

  const auto kept = static_cast<std::uint64_t>(keep);
  file_.create();
  create(origin, kept + (header.max_samples > 0 ? static_cast<std::uint64_t>(header.max_samples) : kUnboundedRows));
  copy_rows(old.get(), kept);
  num_rows_ = num_flushed_ = num_committed_ = buffer_first_ = kept;
  // The buffer begins where rows of the group do.
  buffer_first_ -= kept % groups_.chunk_rows % buffer_rows_;
  num_safe_rows_ = static_cast<std::uint64_t>(total);
  new_events_ = std::move(events);
  checkpoint_ = checkpoint;
  checkpoint_->num_samples = keep;
  checkpoint_->num_events = static_cast<long>(num_kept);
}

}  // namespace

std::unique_ptr<records::ResultSink> make_results_writer(const std::string& path, const ResultsWriterOptions& options) {
  return std::make_unique<ResultsWriter>(path, std::nullopt, options);
}

std::unique_ptr<records::ResultSink> make_results_appender(const std::string& path, double resume_time,
                                                           const ResultsWriterOptions& options) {
  return std::make_unique<ResultsWriter>(path, resume_time, options);
}

}  // namespace bough::hdf5
