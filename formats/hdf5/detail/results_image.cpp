#include "formats/hdf5/detail/results_image.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "base/diagnostic.hpp"
#include "base/version.hpp"
#include "formats/hdf5/detail/dimension_scales.hpp"
#include "formats/hdf5/detail/results_layout.hpp"

namespace bough::hdf5 {

namespace {

constexpr std::size_t kSuperblock = 48;
/// K of the B-trees of chunks is what one leaf for all row groups needs, and a leaf fits into a page.
constexpr std::uint64_t kMaxGroups = 96;
/// Size of a row group, and bounds of its rows.
constexpr std::uint64_t kGroupBytes = 4 << 20, kMinRows = 16, kMaxRows = 1024;
/// Takes the place of the reference to /time in the heap until its address is known.
const std::string kTimeReference = "\1\2\3/time";

constexpr const char* kSystemDescription = "the system file of the run, TOML";
constexpr const char* kResumedTime = "times at which the run was resumed";
constexpr const char* kResumedSystem = "the system file it was resumed with, TOML";
constexpr const char* kCheckpointTime = "time of the checkpoint";
constexpr const char* kCheckpointState = "state vector of the solver";
constexpr const char* kCheckpointMemory = "continued quantities besides the state";
constexpr const char* kOwnDims = "solver's own";

std::string encode_number(std::uint64_t value, int size) {
  std::string data;
  append_number(data, value, size);
  return data;
}

std::string encode_bytes(const double* values, std::size_t count) {
  std::string data;
  data.reserve(8 * count);
  for (std::size_t i = 0; i < count; ++i) append_number(data, get_bits(values[i]), 8);
  return data;
}

Message make_text_attribute(const std::string& name, const std::string& encoded) {
  return make_attribute(name, encode_text(), encode_space({}), encoded);
}

Message make_integer_attribute(const std::string& name, std::int64_t value, int size) {
  return make_attribute(name, encode_integer(size), encode_space({}),
                        encode_number(static_cast<std::uint64_t>(value), size));
}

Message make_real_attribute(const std::string& name, double value) {
  return make_attribute(name, encode_real(), encode_space({}), encode_number(get_bits(value), 8));
}

/// Where the body of message `index` begins in the header.
std::size_t find_body(const std::vector<Message>& messages, std::size_t index) {
  std::size_t at = kHeaderPrefix + kMessagePrefix;
  for (std::size_t i = 0; i < index; ++i) at += messages[i].body.size() + kMessagePrefix;
  return at;
}

/// A leaf of the B-tree of a dataset's chunks (III.A.1): keys with the size, the filters and the first element of each
/// chunk, and one after the last.
class ChunkLeaf {
 public:
  ChunkLeaf(int rank, std::uint64_t k)
      : key_size_(8 + 8 * (static_cast<std::size_t>(rank) + 1)), size_(24 + (2 * k + 1) * key_size_ + 16 * k) {}

  std::size_t size() const { return size_; }
  void begin(char* node) const {
    std::memcpy(node, "TREE\x01", 5);
    set_number(node + 8, kUndefined, 8);
    set_number(node + 16, kUndefined, 8);
  }
  /// Chunk `index`, the one after all others.
  void add(char* node, std::uint64_t index, std::uint64_t chunk_rows, std::uint64_t chunk_bytes, Address chunk) const {
    char* key = node + 24 + index * (key_size_ + 8);
    set_number(key, chunk_bytes, 4);
    set_number(key + 8, index * chunk_rows, 8);
    set_number(key + key_size_, chunk, 8);
    set_number(key + key_size_ + 8 + 8, (index + 1) * chunk_rows, 8);
    set_number(node + 6, index + 1, 2);
  }

 private:
  std::size_t key_size_, size_;
};

std::vector<Message> make_fixed_dataset(const Dims& shape, const std::string& type, Address data, std::uint64_t size,
                                        const std::string& description, const std::string& dims) {
  return {{message::kSpace, encode_space(shape)},
          {message::kType, type},
          make_fill(),
          make_contiguous(size > 0 ? data : kUndefined, size),
          make_text_attribute("description", description),
          make_text_attribute("dims", dims)};
}

}  // namespace

RowGroups plan_row_groups(std::uint64_t max_rows, std::uint64_t sample_size) {
  BOUGH_DEMAND(max_rows > 0 && sample_size > 0);
  RowGroups groups;
  groups.sample_size = sample_size;
  std::uint64_t rows = std::clamp(kGroupBytes / (sizeof(double) * sample_size), kMinRows, kMaxRows);
  rows = std::max(rows, (max_rows + kMaxGroups - 1) / kMaxGroups);
  // Rows are distributed evenly over the groups, so that the last one is full too.
  groups.max_groups = (max_rows + rows - 1) / rows;
  groups.chunk_rows = (max_rows + groups.max_groups - 1) / groups.max_groups;
  return groups;
}

ResultsImage::ResultsImage(const ResultsOrigin& origin, const RowGroups& groups, const std::string& reason)
    : groups_(groups), image_(kPage) {
  const auto& header = origin.header;
  for (const auto& text : {std::string("1"), std::string("T"), std::string("description"), reason,
                           std::string(kResultsFormat), std::string(kResultsFormatVersion), std::string(get_version()),
                           std::string(kSystemDescription), std::string(kResumedTime), std::string(kResumedSystem),
                           std::string(kCheckpointTime), std::string(kCheckpointState), std::string(kCheckpointMemory),
                           std::string(kOwnDims), header.system_text, kTimeReference})
    heap_.add(text);
  for (const char* text : EventTable::kDescriptions) heap_.add(text);
  for (const auto& [name, hash] : header.source) heap_.add(name), heap_.add(hash);
  for (const auto& [name, value] : header.settings) heap_.add(value);
  for (const auto& [time, text] : origin.resumed) heap_.add(text);
  for (const auto& channel : header.channels)
    for (const auto& text : {channel.description, channel.dims, channel.units})
      if (!text.empty()) heap_.add(text);
  heap_.place(image_);
  extension_ = image_.place_header({{message::kBtreeK, encode_number(0, 1) + encode_number(groups_.max_groups, 2) +
                                                           encode_number(kGroupK, 2) + encode_number(kGroupLeafK, 2)}});
  place_columns(header.channels);
  place_groups(origin);
}

void ResultsImage::place_columns(const std::vector<records::Channel>& channels) {
  BOUGH_DEMAND(!channels.empty() && channels.front().path == "/time" && channels.front().size == 1);
  const std::uint64_t rows = groups_.chunk_rows;
  const auto place = [&](const records::Channel& channel, Column& column, const std::vector<Message>& scale) {
    const ChunkLeaf leaf(column.rank, groups_.max_groups);
    Dims shape{0}, max{H5S_UNLIMITED}, chunk{rows};
    if (column.rank > 1)
      for (Dims* dims : {&shape, &max, &chunk}) dims->push_back(column.size);
    if (column.size > 0) {
      column.tree = image_.reserve(leaf.size());
      leaf.begin(image_.at(column.tree));
    } else {
      chunk.back() = 1;
    }
    std::vector<Message> messages{{message::kSpace, encode_space(shape, max)},
                                  {message::kType, encode_real()},
                                  make_fill(),
                                  make_chunked(column.tree, chunk, sizeof(double)),
                                  make_text_attribute("description", heap_.encode(channel.description)),
                                  make_text_attribute("dims", heap_.encode(channel.dims))};
    if (!channel.units.empty()) messages.push_back(make_text_attribute("units", heap_.encode(channel.units)));
    messages.insert(messages.end(), scale.begin(), scale.end());
    column.header = image_.place_header(messages);
    // The first block only, where the header goes on in another.
    std::uint32_t size = 0;
    std::memcpy(&size, image_.at(column.header) + 6, sizeof size);
    column.header_size = kHeaderPrefix + size + 4;
    tree_.add_object(channel.path, column.header);
  };
  std::uint64_t first = 0;
  for (const auto& channel : channels) {
    Column column;
    column.rank = channel.size == 1 ? 1 : 2;
    column.first = first;
    column.size = static_cast<std::uint64_t>(channel.size);
    first += column.size;
    columns_.push_back(column);
  }
  BOUGH_DEMAND(first == groups_.sample_size);
  changing_begin_ = image_.end();
  // Every other channel names /time as the scale of its rows; /time, placed last, lists them. Where they are too many
  // for its list there is no scale at all: half of an attachment is no attachment for H5DSis_attached.
  const hsize_t num_users = columns_.size() - 1;
  const bool has_scale = num_users > 0 && num_users <= kMaxUsers;
  std::string users;
  for (std::size_t i = 1; i < columns_.size(); ++i) {
    auto& column = columns_[i];
    if (!has_scale) {
      place(channels[i], column, {});
      continue;
    }
    std::string lists = heap_.encode(kTimeReference, 1);
    if (column.rank > 1) lists += heap_.encode("");
    place(channels[i], column,
          {make_attribute("DIMENSION_LIST", encode_reference_list(), encode_space({static_cast<hsize_t>(column.rank)}),
                          lists)});
    append_number(users, column.header, 8);
    append_number(users, 0, 8);  // its first dimension, and four bytes of padding
  }
  std::vector<Message> scale;
  for (const auto& [name, text] : {std::pair("CLASS", "DIMENSION_SCALE"), {"NAME", "time"}})
    scale.push_back(
        make_attribute(name, encode_fixed_text(std::strlen(text) + 1), encode_space({}), std::string(text) + '\0'));
  if (has_scale)
    scale.push_back(make_attribute("REFERENCE_LIST", encode_scale_user(), encode_space({num_users}), users));
  place(channels.front(), columns_.front(), scale);
  set_number(image_.at(heap_.find(kTimeReference)), columns_.front().header, 8);
}

void ResultsImage::place_groups(const ResultsOrigin& origin) {
  const auto& header = origin.header;
  // Groups that change come first, next to the channels.
  auto& energy = tree_.make_group("/energy");
  energy.add_attribute(make_real_attribute(kEnergyError, std::numeric_limits<double>::quiet_NaN()));
  energy.place_members(image_);
  energy_ = energy.place(image_);
  energy_at_ = find_body({make_real_attribute(kEnergyError, 0)}, 1) - kMessagePrefix - 8;
  auto events = make_group_messages();
  const std::size_t num_before = events.size();
  for (const char* name : EventTable::kNames) events.push_back(make_link(name, kUndefined));
  for (std::size_t i = num_before; i < events.size(); ++i)
    events_at_.push_back(find_body(events, i) + events[i].body.size() - sizeof(Address));
  events_size_ = calc_header_size(events);
  events_ = image_.place_header(events);
  tree_.add_object("/events", events_);
  changing_end_ = image_.end();
  energy_size_ = 0;
  std::uint32_t size = 0;
  std::memcpy(&size, image_.at(energy_) + 6, sizeof size);
  energy_size_ = kHeaderPrefix + size + 4;

  const auto one = heap_.encode("1");
  const auto place_dataset = [&](const std::string& path, const Dims& shape, const std::string& type,
                                 const std::string& data, const char* description, const std::string& dims) {
    tree_.add_object(path, image_.place_header(make_fixed_dataset(shape, type, image_.place(data), data.size(),
                                                                  heap_.encode(description), dims)));
  };
  place_dataset("/system", {}, encode_text(), heap_.encode(header.system_text), kSystemDescription, one);
  if (!origin.resumed.empty()) {
    std::string times, texts;
    for (const auto& [time, text] : origin.resumed) {
      append_number(times, get_bits(time), 8);
      texts += heap_.encode(text);
    }
    const Dims shape{origin.resumed.size()};
    place_dataset("/resumed/time", shape, encode_real(), times, kResumedTime, heap_.encode("T"));
    place_dataset("/resumed/system", shape, encode_text(), texts, kResumedSystem, one);
  }
  auto& settings = tree_.make_group("/settings");
  for (const auto& [name, value] : header.settings)
    settings.add_attribute(make_text_attribute(name, heap_.encode(value)));
  no_checkpoint_ = image_.place_header(make_group_messages());
  tree_.place_members(image_);
  root_links_ = tree_.make_links(image_);

  root_more_ = {make_text_attribute("format", heap_.encode(kResultsFormat)),
                make_text_attribute("format_version", heap_.encode(kResultsFormatVersion)),
                make_text_attribute("bough_version", heap_.encode(get_version()))};
  std::string source;
  for (const auto& [name, hash] : header.source) source += heap_.encode(name) + heap_.encode(hash);
  root_more_.push_back(make_attribute("source", encode_text(), encode_space({header.source.size(), 2}), source));
  const std::string more = encode_continuation(root_more_);
  std::string body;
  append_number(body, image_.place(more), 8);
  append_number(body, more.size(), 8);
  root_more_ = {{message::kContinuation, body}};
}

void ResultsImage::add_group(Address begin) {
  BOUGH_DEMAND(num_groups_ < groups_.max_groups);
  const std::uint64_t rows = groups_.chunk_rows;
  for (const auto& c : columns_)
    if (c.size > 0)
      ChunkLeaf(c.rank, groups_.max_groups)
          .add(image_.at(c.tree), num_groups_, rows, rows * c.size * sizeof(double),
               begin + rows * c.first * sizeof(double));
  ++num_groups_;
}

void ResultsImage::set_num_rows(std::uint64_t rows) {
  for (const auto& c : columns_) {
    char* header = image_.at(c.header);
    set_number(header + kHeaderPrefix + kMessagePrefix + 4, rows, 8);  // the first dimension
    seal(header, c.header_size);
  }
}

void ResultsImage::set_energy_error(double worst) {
  set_number(image_.at(energy_) + energy_at_, get_bits(worst), 8);
  seal(image_.at(energy_), energy_size_);
}

void ResultsImage::set_events(const std::vector<Address>& headers) {
  for (std::size_t i = 0; i < headers.size(); ++i) set_number(image_.at(events_) + events_at_[i], headers[i], 8);
  seal(image_.at(events_), events_size_);
}

std::string ResultsImage::encode_first_page(const ResultsState& state) const {
  std::string page("\x89HDF\r\n\x1a\n\x02\x08\x08", 11);
  page.push_back('\0');
  for (const Address address : {Address{0}, extension_, state.end, Address{kSuperblock}})
    append_number(page, address, 8);
  page.append(4, '\0');
  seal(page.data(), page.size());

  std::vector<Message> messages{make_integer_attribute(kNumSamples, state.num_samples, 8),
                                make_integer_attribute("completed", state.completed ? 1 : 0, 4),
                                make_text_attribute("reason", state.reason)};
  if (state.wall_time) messages.push_back(make_real_attribute(kWallTime, *state.wall_time));
  messages.insert(messages.end(), root_links_.begin(), root_links_.end());
  messages.push_back(make_link("checkpoint", state.checkpoint == kUndefined ? no_checkpoint_ : state.checkpoint));
  messages.insert(messages.end(), root_more_.begin(), root_more_.end());
  page += encode_header(messages);
  BOUGH_DEMAND(page.size() <= kPage);
  page.resize(kPage);
  return page;
}

CheckpointBlock encode_checkpoint(const records::Checkpoint& checkpoint, Address begin, const ResultsImage& texts) {
  FileImage image(begin);
  GroupTree tree;
  const auto own = texts.find_text(kOwnDims);
  const auto place = [&](const std::string& path, const Eigen::VectorXd& values, const char* description,
                         const std::vector<Message>& more) {
    const auto data = encode_bytes(values.data(), static_cast<std::size_t>(values.size()));
    auto messages = make_fixed_dataset({static_cast<hsize_t>(values.size())}, encode_real(), image.place(data),
                                       data.size(), texts.find_text(description), own);
    messages.insert(messages.end(), more.begin(), more.end());
    tree.add_object(path, image.place_header(messages));
  };
  place("/time", Eigen::VectorXd::Constant(1, checkpoint.time), kCheckpointTime, {});
  place("/state", checkpoint.state, kCheckpointState,
        {make_integer_attribute(kNumSamples, checkpoint.num_samples, 8),
         make_integer_attribute(kNumEvents, checkpoint.num_events, 8),
         make_integer_attribute(kChecksum, calc_checksum(checkpoint), 8)});
  for (const auto& [name, values] : checkpoint.memory)
    if (values.size() > 0) place("/memory/" + name, values, kCheckpointMemory, {});
  tree.place_members(image);
  const Address header = tree.place(image);
  return {image.bytes(), header};
}

EventTable::EventTable(Address begin, std::uint64_t capacity, const ResultsImage& texts)
    : capacity_(capacity), image_(begin) {
  // Headers come first, so their sizes are needed before the addresses that they contain.
  const auto encode = [&](std::size_t i, Address tree) {
    return std::vector<Message>{{message::kSpace, encode_space({0}, {H5S_UNLIMITED})},
                                {message::kType, i == 0 ? encode_real() : encode_text()},
                                make_fill(),
                                make_chunked(tree, {capacity_}, static_cast<int>(kWidths[i])),
                                make_text_attribute("description", texts.find_text(kDescriptions[i])),
                                make_text_attribute("dims", texts.find_text(i == 0 ? "T" : "1"))};
  };
  for (std::size_t i = 0; i < kNumColumns; ++i) {
    sizes_[i] = calc_header_size(encode(i, 0));
    headers_.push_back(image_.reserve(sizes_[i]));
  }
  headers_size_ = image_.bytes().size();
  const ChunkLeaf leaf(1, texts.get_max_groups());
  for (std::size_t i = 0; i < kNumColumns; ++i) {
    const Address tree = image_.reserve(leaf.size());
    data_[i] = image_.reserve(capacity_ * kWidths[i]);
    leaf.begin(image_.at(tree));
    leaf.add(image_.at(tree), 0, capacity_, capacity_ * kWidths[i], data_[i]);
    const auto header = encode_header(encode(i, tree));
    std::copy(header.begin(), header.end(), image_.at(headers_[i]));
  }
}

void EventTable::set_num_rows(std::uint64_t rows) {
  for (std::size_t i = 0; i < kNumColumns; ++i) {
    char* header = image_.at(headers_[i]);
    set_number(header + kHeaderPrefix + kMessagePrefix + 4, rows, 8);
    seal(header, sizes_[i]);
  }
}

void EventTable::set_row(std::uint64_t row, const Row& data) {
  for (int i = 0; i < kNumColumns; ++i) {
    const auto& bytes = data[static_cast<std::size_t>(i)];
    std::copy(bytes.begin(), bytes.end(), image_.at(find_row(i, row)));
  }
}

}  // namespace bough::hdf5
