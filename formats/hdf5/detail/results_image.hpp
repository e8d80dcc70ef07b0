#pragma once
/// \file Metadata of a results file in memory, and what of them changes while the file grows (docs/adr/0027).
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/hdf5/detail/file_image.hpp"
#include "formats/records/results.hpp"

namespace bough::hdf5 {

/// Contents of a new results file besides the samples.
struct ResultsOrigin {
  records::ResultsHeader header;
  std::vector<std::pair<double, std::string>> resumed;  ///< times, and the system files
};

/// Rows of the channels in storage: all channels have chunks of the same number of rows, and those of the same rows lie
/// one after the other, a row group. A channel of `size` numbers begins chunk_rows * first numbers after the
/// beginning of the group.
struct RowGroups {
  std::uint64_t chunk_rows = 1, max_groups = 1;
  std::uint64_t sample_size = 0;
  /// [bytes] of a row group in storage.
  std::uint64_t group_bytes() const { return chunk_rows * sample_size * sizeof(double); }
};
/// For max_rows samples of sample_size numbers.
RowGroups plan_row_groups(std::uint64_t max_rows, std::uint64_t sample_size);

/// Contents of the first page of the file, which is replaced as a whole.
struct ResultsState {
  std::uint64_t end = 0;  ///< [bytes] end of the file for readers
  std::int64_t num_samples = 0;
  bool completed = false;
  std::string reason;               ///< encoded
  std::optional<double> wall_time;  ///< [s]
  Address checkpoint = kUndefined;  ///< header of /checkpoint; kUndefined: the empty group
};

class ResultsImage {
 public:
  /// Lays out all metadata for at most groups.max_groups row groups; `reason`: the state that a new file has,
  /// "running".
  ResultsImage(const ResultsOrigin& origin, const RowGroups& groups, const std::string& reason);

  /// All of it but the first page, from kPage on.
  const FileImage& image() const { return image_; }
  /// Where the headers of the channels lie.
  Address changing_begin() const { return changing_begin_; }
  /// Address after the headers of the channels.
  Address changing_end() const { return changing_end_; }

  /// The next row group begins at the address.
  void add_group(Address begin);
  /// Sets the number of samples that a reader may read.
  void set_num_rows(std::uint64_t rows);
  /// Sets the largest relative error of the energy balance.
  void set_energy_error(double worst);
  /// Headers of the datasets of /events.
  void set_events(const std::vector<Address>& headers);
  /// Encodes the first page: superblock and root group, with the state of the run as attributes.
  std::string encode_first_page(const ResultsState& state) const;
  /// One of the texts that the image holds, as a reference to it.
  std::string find_text(const std::string& text) const { return heap_.encode(text); }
  /// Largest number of row groups that the metadata have space for.
  std::uint64_t get_max_groups() const { return groups_.max_groups; }

 private:
  struct Column {
    Address header = 0, tree = kUndefined;
    std::size_t header_size = 0;
    int rank = 1;
    std::uint64_t first = 0, size = 1;
  };
  void place_columns(const std::vector<records::Channel>& channels);
  void place_groups(const ResultsOrigin& origin);

  RowGroups groups_;
  FileImage image_;
  TextHeap heap_;
  std::vector<Column> columns_;
  GroupTree tree_;
  std::uint64_t num_groups_ = 0;
  Address changing_begin_ = 0, changing_end_ = 0, extension_ = 0, energy_ = 0, events_ = 0, no_checkpoint_ = 0;
  std::size_t energy_size_ = 0, energy_at_ = 0, events_size_ = 0;
  std::vector<std::size_t> events_at_;  ///< of the addresses in the group's header
  std::vector<Message> root_links_, root_more_;
};

/// A block with /checkpoint and all that is in it, placed at `begin`; `header` is its group.
struct CheckpointBlock {
  std::string bytes;
  Address header = 0;
};
/// Lays out state, time and memory of a checkpoint; the descriptions are those of the heap of `texts`.
CheckpointBlock encode_checkpoint(const records::Checkpoint& checkpoint, Address begin, const ResultsImage& texts);

/// The datasets of /events, of one chunk each in a block: rows beyond their number may be filled.
class EventTable {
 public:
  static constexpr int kNumColumns = 3;
  static constexpr std::array<const char*, kNumColumns> kNames = {"time", "what", "source"};
  static constexpr std::array<const char*, kNumColumns> kDescriptions = {
      "time of the event", "what happened", "what it happened to: kind and name; empty: the run"};
  static constexpr std::array<std::uint64_t, kNumColumns> kWidths = {8, 16, 16};  ///< [bytes] of a row
  /// Bytes of a row's columns.
  using Row = std::array<std::string, kNumColumns>;

  EventTable(Address begin, std::uint64_t capacity, const ResultsImage& texts);

  /// Address of the block in the file.
  Address begin() const { return image_.begin(); }
  /// Address after the block.
  Address end() const { return image_.end(); }
  /// The bytes of the block, headers first.
  const std::string& bytes() const { return image_.bytes(); }
  /// Number of rows that the block has space for.
  std::uint64_t capacity() const { return capacity_; }
  /// [bytes] of the headers, which come first in the block.
  std::size_t headers_size() const { return headers_size_; }
  /// Addresses of the headers of the datasets, in the order of the columns.
  const std::vector<Address>& headers() const { return headers_; }
  /// Sets the number of events that a reader may read.
  void set_num_rows(std::uint64_t rows);
  /// Sets the columns of a row below capacity().
  void set_row(std::uint64_t row, const Row& data);
  /// Address in the file of a row of a column.
  Address find_row(int column, std::uint64_t row) const {
    const auto c = static_cast<std::size_t>(column);
    return data_[c] + kWidths[c] * row;
  }

 private:
  std::uint64_t capacity_;
  FileImage image_;
  std::vector<Address> headers_;
  std::array<Address, kNumColumns> data_{};
  std::array<std::size_t, kNumColumns> sizes_{};
  std::size_t headers_size_ = 0;
};

}  // namespace bough::hdf5
