#include "formats/flat/flex_body.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <climits>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>

#include "base/diagnostic.hpp"
#include "base/file_roles.hpp"
#include "base/input_bytes.hpp"
#include "base/part_file.hpp"
#include "formats/flat/detail/fields.hpp"
#include "formats/flat/detail/seal.hpp"
#include "formats/records/body_faults.hpp"

namespace bough::flat {

namespace {

using detail::FieldOptions;
using detail::Shape;

constexpr std::string_view kMagic = "bough-flat ";
constexpr int kVersion = 1;
constexpr std::size_t kMaxRank = 8;
constexpr long kMaxSize = INT_MAX;  ///< of one direction: Eigen and the readers of others count in int
constexpr const char* kWriteAgain = "write the file again with bough export --to flat";

template <class T>
concept EigenDense = requires {
  typename T::Scalar;
  T::RowsAtCompileTime;
};
template <class T>
concept Leaf = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// The type of a number in the file.
template <Leaf T>
using Stored = std::conditional_t<std::is_floating_point_v<T>, T, std::int32_t>;

template <class T>
constexpr const char* get_type_name() {
  if constexpr (std::is_same_v<T, double>) return "float64";
  if constexpr (std::is_same_v<T, float>) return "float32";
  return "int32";
}

template <class Node>
struct LeafOf {
  using Type = Node;
};
template <EigenDense Node>
struct LeafOf<Node> {
  using Type = typename Node::Scalar;
};
template <class Node>
requires(!EigenDense<Node> && requires { typename Node::value_type; }) struct LeafOf<Node> {
  using Type = typename LeafOf<typename Node::value_type>::Type;
};

/// Shape of a number, a matrix or nested containers of equal matrices; short where a container is empty.
template <class Node>
Shape measure(const Node& node, bool is_transposed) {
  Shape shape;
  if constexpr (EigenDense<Node>) {
    shape = {node.rows(), node.cols()};
    if (is_transposed) std::swap(shape[0], shape[1]);
    if (Node::IsVectorAtCompileTime) shape = {node.size()};
  } else if constexpr (!Leaf<Node>) {
    Shape of_item;
    for (const auto& item : node) {
      const bool is_first = &item == &*node.begin();
      if (is_first) of_item = measure(item, is_transposed);
      BOUGH_DEMAND(is_first || measure(item, is_transposed) == of_item);
    }
    shape = {detail::count(node)};
    shape.insert(shape.end(), of_item.begin(), of_item.end());
  }
  return shape;
}

template <class Node>
void resize(Node& node, const long* shape, bool is_transposed) {
  if constexpr (Leaf<Node>) {
    return;
  } else if constexpr (EigenDense<Node>) {
    if constexpr (Node::IsVectorAtCompileTime) {
      node.resize(shape[0]);
    } else {
      node.resize(shape[is_transposed ? 1 : 0], shape[is_transposed ? 0 : 1]);
    }
  } else {
    if constexpr (requires { node.resize(1); }) node.resize(static_cast<std::size_t>(shape[0]));
    for (auto& item : node) resize(item, shape + 1, is_transposed);
  }
}

/// Calls `visit` with each number, in the order of the file.
template <class Node, class Visit>
void walk(Node& node, bool is_transposed, const Visit& visit) {
  using Plain = std::remove_const_t<Node>;
  if constexpr (Leaf<Plain>) {
    visit(node);
  } else if constexpr (EigenDense<Plain>) {
    const Eigen::Index rows = is_transposed ? node.cols() : node.rows();
    const Eigen::Index cols = is_transposed ? node.rows() : node.cols();
    for (Eigen::Index i = 0; i < rows; ++i)
      for (Eigen::Index j = 0; j < cols; ++j) visit(is_transposed ? node(j, i) : node(i, j));
  } else {
    for (auto& item : node) walk(item, is_transposed, visit);
  }
}

bool has_entries(const Shape& shape) {
  for (const long size : shape)
    if (size == 0) return false;
  return true;
}

bool fits(const Shape& found, const Shape& expected) {
  if (found.size() != expected.size()) return false;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (expected[i] >= 0 && found[i] != expected[i]) return false;
  return true;
}

std::string print_shape(const Shape& shape) {
  std::string text;
  for (const long size : shape) text += (text.empty() ? "" : " x ") + (size < 0 ? "any" : std::to_string(size));
  return text.empty() ? "scalar" : text;
}

template <class T>
void reverse_on_big_endian(T& value) {
  if constexpr (std::endian::native == std::endian::big) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    std::reverse(bytes.begin(), bytes.end());
    value = std::bit_cast<T>(bytes);
  }
}

class Writer {
 public:
  static constexpr bool kReads = false;

  bool has(const std::string&, bool is_in_body) const { return is_in_body; }

  template <class Node>
  void array(const std::string& name, const Node& node, const Shape& expected, const FieldOptions& options = {}) {
    using Number = typename LeafOf<Node>::Type;
    Shape shape = measure(node, options.is_transposed);
    // An empty container has no matrices to measure.
    for (std::size_t i = shape.size(); i < expected.size() && !has_entries(shape); ++i) shape.push_back(expected[i]);
    if (!fits(shape, expected)) {
      BOUGH_DEMAND(!has_entries(shape) && (options.is_optional || !has_entries(expected)));
      return;
    }
    begin(name, get_type_name<Stored<Number>>(), shape);
    walk(node, options.is_transposed, [&](const Number& number) {
      auto stored = static_cast<Stored<Number>>(number);
      reverse_on_big_endian(stored);
      bytes_.append(reinterpret_cast<const char*>(&stored), sizeof stored);
    });
  }

  void text(const std::string& name, const std::string& text) {
    begin(name, "text", {detail::count(text)});
    bytes_ += text;
  }

  void texts(const std::string& name, const std::vector<std::string>& list, long size, const FieldOptions& = {}) {
    BOUGH_DEMAND(size < 0 || detail::count(list) == size);
    std::vector<int> lengths;
    std::string joined;
    for (const auto& item : list) {
      lengths.push_back(static_cast<int>(item.size()));
      joined += item;
    }
    array(name + "/length", lengths, {-1});
    text(name, joined);
  }

  std::string finish() {
    bytes_ += detail::make_seal(bytes_);
    return std::move(bytes_);
  }

 private:
  void begin(const std::string& name, const char* type, const Shape& shape) {
    bytes_ += name + ' ' + type + ' ' + std::to_string(shape.size());
    for (const long size : shape) bytes_ += ' ' + std::to_string(size);
    bytes_ += '\n';
  }

  std::string bytes_ = std::string(kMagic) + std::to_string(kVersion) + '\n';
};

struct Entry {
  std::string name, type;
  Shape shape;
  std::string_view bytes;
};

InputError make_damage(const std::string& label, const std::string& what) {
  return InputError("flat.damaged", {label}, what, "copy the file again, or " + std::string(kWriteAgain));
}

std::optional<long> parse_size(std::string_view word) {
  long size = -1;
  const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), size);
  const bool is_size = failed == std::errc() && end == word.data() + word.size() && size >= 0 && size <= kMaxSize;
  return is_size ? std::optional(size) : std::nullopt;
}

std::size_t get_number_size(std::string_view type) {
  return type == "float64" ? 8 : type == "float32" || type == "int32" ? 4 : type == "text" ? 1 : 0;
}

/// The array that begins at `at`, which moves to the one after it. Claims of size are held against the bytes there are.
Entry parse_entry(std::string_view bytes, std::size_t& at, const std::string& label) {
  const auto fail = [&](const std::string& what) {
    return make_damage(label, "at byte " + std::to_string(at) + ": " + what);
  };
  const auto end = bytes.find('\n', at);
  if (end == std::string_view::npos) throw fail("expected a line with name, type and shape of an array");
  std::vector<std::string_view> words;
  for (std::size_t from = at; from <= end && words.size() < kMaxRank + 4;) {
    const auto to = std::min(bytes.find(' ', from), end);
    words.push_back(bytes.substr(from, to - from));
    from = to + 1;
  }
  const std::size_t size_of_number = words.size() < 3 ? 0 : get_number_size(words[1]);
  const auto rank = words.size() < 3 ? std::nullopt : parse_size(words[2]);
  if (words[0].size() < 2 || words[0][0] != '/' || size_of_number == 0 || !rank ||
      static_cast<std::size_t>(*rank) > kMaxRank || words.size() != static_cast<std::size_t>(*rank) + 3)
    throw fail("expected name, type and shape of an array, found another line");
  Entry entry{std::string(words[0]), std::string(words[1]), {}, {}};
  for (std::size_t i = 3; i < words.size(); ++i) {
    const auto size = parse_size(words[i]);
    if (!size) throw fail(entry.name + " has a shape that is none");
    entry.shape.push_back(*size);
  }
  const std::size_t max_number = (bytes.size() - end - 1) / size_of_number;
  std::size_t number = has_entries(entry.shape) ? 1 : 0;
  for (const long size : entry.shape) {
    if (number > 0 && number > max_number / static_cast<std::size_t>(size)) number = max_number + 1;
    if (number > max_number) break;
    number *= static_cast<std::size_t>(size);
  }
  if (number > max_number)
    throw fail(entry.name + " has the shape " + print_shape(entry.shape) + ", more than the bytes that follow");
  entry.bytes = bytes.substr(end + 1, number * size_of_number);
  at = end + 1 + entry.bytes.size();
  return entry;
}

/// \throws InputError "flat.not-flat", "flat.version" or "flat.damaged".
std::vector<Entry> parse_entries(std::string_view bytes, const std::string& label) {
  if (!bytes.starts_with(kMagic))
    throw InputError("flat.not-flat", {label}, "the file does not begin with \"" + std::string(kMagic) + "\"",
                     "give a file of bough export --to flat");
  const auto end = bytes.substr(0, 32).find('\n');
  if (end == std::string_view::npos) throw make_damage(label, "the file ends in its first line");
  const auto version = bytes.substr(kMagic.size(), end - kMagic.size());
  if (parse_size(version) != kVersion)
    throw InputError("flat.version", {label},
                     "the file has version \"" + std::string(version) + "\", expected " + std::to_string(kVersion),
                     "use a newer Bough, or " + std::string(kWriteAgain));
  if (bytes.size() < end + 1 + detail::kSealSize || !bytes.substr(bytes.size() - detail::kSealSize).starts_with("end "))
    throw make_damage(label, "the file has " + std::to_string(bytes.size()) + " bytes and no last line \"end\"");
  const auto content = bytes.substr(0, bytes.size() - detail::kSealSize);
  if (bytes.substr(content.size()) != detail::make_seal(content))
    throw make_damage(label, "the checksum in the last line is not that of the bytes before it");
  std::vector<Entry> entries;
  for (std::size_t at = end + 1; at < content.size();) entries.push_back(parse_entry(content, at, label));
  return entries;
}

class Reader {
 public:
  static constexpr bool kReads = true;

  Reader(std::string_view bytes, const std::string& label) : label_(label) {
    for (auto& entry : parse_entries(bytes, label)) {
      const auto name = entry.name;
      if (!entries_.emplace(name, std::move(entry)).second) throw make_damage(label, name + " is there twice");
    }
  }

  bool has(const std::string& name, bool) const { return entries_.count(name) > 0; }

  template <class Node>
  void array(const std::string& name, Node& node, const Shape& expected, const FieldOptions& options = {}) {
    using Number = typename LeafOf<Node>::Type;
    const Entry* entry = find(name, get_type_name<Stored<Number>>(), expected, options.is_optional);
    if (!entry) return;
    resize(node, entry->shape.data(), options.is_transposed);
    const char* at = entry->bytes.data();
    long num_bad = 0;
    walk(node, options.is_transposed, [&](Number& number) {
      Stored<Number> stored;
      std::memcpy(&stored, at, sizeof stored);
      at += sizeof stored;
      reverse_on_big_endian(stored);
      bool is_valid = true;
      if constexpr (std::is_floating_point_v<Number>)
        is_valid = std::isfinite(stored);
      else if (options.max_value < INT_MAX)
        is_valid = stored >= 0 && stored <= options.max_value;
      if (!is_valid) ++num_bad;
      number = static_cast<Number>(is_valid ? stored : Stored<Number>{});
    });
    if (num_bad == 0) return;
    const auto range = options.max_value < INT_MAX ? "in 0 to " + std::to_string(options.max_value) : "finite numbers";
    diagnostics_.error("flat.value", {label_},
                       name + " has " + std::to_string(num_bad) + " values that are not " + range,
                       "find the step that made them, and " + std::string(kWriteAgain));
  }

  void text(const std::string& name, std::string& text) {
    if (const Entry* entry = find(name, "text", {-1}, true)) text = entry->bytes;
  }

  void texts(const std::string& name, std::vector<std::string>& list, long size, const FieldOptions& options = {}) {
    std::vector<int> lengths;
    array(name + "/length", lengths, {size}, options);
    std::string joined;
    text(name, joined);
    std::size_t at = 0;
    for (const int length : lengths) {
      if (length < 0 || static_cast<std::size_t>(length) > joined.size() - at) break;
      list.push_back(joined.substr(at, static_cast<std::size_t>(length)));
      at += static_cast<std::size_t>(length);
    }
    if (list.size() == lengths.size() && at == joined.size()) return;
    diagnostics_.error("flat.shape", {label_}, name + " does not have the bytes that " + name + "/length counts",
                       kWriteAgain);
    list.resize(lengths.size());
  }

  /// \throws InputError with all that is wrong with the values.
  void finish(const records::FlexBody& body) {
    add(records::find_unknown_names(body));
    add(records::find_body_faults(body));
  }

 private:
  void add(const std::vector<std::string>& faults) {
    for (const auto& what : faults)
      diagnostics_.error("flat.value", {label_}, what,
                         "correct the body it was made from, and " + std::string(kWriteAgain));
    diagnostics_.throw_if_errors();
  }

  const Entry* find(const std::string& name, const std::string& type, const Shape& expected, bool is_optional) {
    const auto found = entries_.find(name);
    const Entry* entry = found == entries_.end() ? nullptr : &found->second;
    if (!entry && (is_optional || !has_entries(expected))) return nullptr;
    if (!entry) {
      diagnostics_.error("flat.missing", {label_}, name + " is missing", kWriteAgain);
    } else if (entry->type != type || !fits(entry->shape, expected)) {
      diagnostics_.error("flat.shape", {label_},
                         name + " has the type " + entry->type + " and the shape " + print_shape(entry->shape) +
                             ", expected " + type + " and " + print_shape(expected),
                         kWriteAgain);
      entry = nullptr;
    }
    // Shapes of others depend on an open one: they would all seem wrong.
    for (const long size : expected)
      if (!entry && size < 0) diagnostics_.throw_if_errors();
    return entry;
  }

  std::string label_;
  std::map<std::string, Entry> entries_;
  Diagnostics diagnostics_;
};

std::string read_bytes(const std::string& path) {
  std::error_code ignored;
  std::ifstream in;  // opening a pipe would wait for a writer
  if (!std::filesystem::is_regular_file(path, ignored) || !(in.open(path, std::ios::binary), in))
    throw InputError("flat.cannot-read", {path}, "the file cannot be opened", "check its path and permissions");
  note_input(path);
  std::string bytes(static_cast<std::size_t>(std::filesystem::file_size(path)), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

}  // namespace

std::string detail::make_seal(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  std::string seal = "end ";
  for (int shift = 60; shift >= 0; shift -= 4) seal += "0123456789abcdef"[(hash >> shift) & 15];
  return seal + '\n';
}

bool is_flex_body(const std::string& path) { return read_input_head(path, kMagic.size()) == kMagic; }

std::string format_flex_body(const records::FlexBody& body) {
  Writer writer;
  detail::visit_body(writer, body);
  return writer.finish();
}

records::FlexBody parse_flex_body(std::string_view bytes, const std::string& label) {
  Reader reader(bytes, label);
  records::FlexBody body;
  detail::visit_body(reader, body);
  reader.finish(body);
  return body;
}

void write_flex_body(const std::string& path, const records::FlexBody& body) {
  const std::string bytes = format_flex_body(body);
  PartFile part(path);
  if (part.write(bytes.data(), bytes.size()) && part.commit()) return;
  throw ComputationError("flat.write", {path}, "the file could not be written: " + part.error().message(),
                         "check the folder, its permissions and the space left");
}

records::FlexBody read_flex_body(const std::string& path) { return parse_flex_body(read_bytes(path), path); }

std::vector<ArrayInfo> list_arrays(const std::string& path) {
  constexpr std::size_t kMaxText = 200;
  const std::string bytes = read_bytes(path);
  std::vector<ArrayInfo> arrays;
  for (const auto& entry : parse_entries(bytes, path))
    arrays.push_back({entry.name, entry.type, entry.shape,
                      entry.type == "text" ? std::string(entry.bytes.substr(0, kMaxText)) : std::string()});
  return arrays;
}

}  // namespace bough::flat
