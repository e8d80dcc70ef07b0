#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "formats/hdf5/detail/handle.hpp"
#include "formats/hdf5/detail/text_heaps.hpp"
#include "formats/hdf5/inspect.hpp"

namespace bough::hdf5 {

namespace {

constexpr double kMega = 1024.0 * 1024.0;
/// Bytes read at a time.
constexpr double kPiece = 8 * kMega;
/// At the end of a dataset whose middle is passed over.
constexpr double kEnd = kMega / 4;
/// Numbers may be claimed and not stored up to this many bytes in a whole file: samples of a run that was killed.
constexpr double kMaxUnstored = 64 * kMega;
/// A compressed file may hold this many times its size.
constexpr double kMaxCompression = 200;
/// Limit of the bytes of uncompressed numbers read; beyond it only the ends of each dataset are read.
constexpr double kMaxPlain = 32 * kMega;
constexpr int kMaxGroupLevels = 64;

struct Link {
  std::string name;
  H5L_type_t type;
  haddr_t address;
};

herr_t add_link(hid_t, const char* name, const H5L_info_t* info, void* links) {
  static_cast<std::vector<Link>*>(links)->push_back(
      {name, info->type, info->type == H5L_TYPE_HARD ? info->u.address : HADDR_UNDEF});
  return 0;
}

herr_t add_attribute(hid_t, const char* name, const H5A_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

Dims get_dims(hid_t space) {
  Dims dims(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  if (!dims.empty()) H5Sget_simple_extent_dims(space, dims.data(), nullptr);
  return dims;
}

double calc_count(const Dims& dims) {
  double count = 1;
  for (const auto d : dims) count *= static_cast<double>(d);
  return count;
}

/// The type in memory that Bough reads a stored one as; invalid for kinds that it never reads.
Handle make_memory_type(hid_t type) {
  switch (H5Tget_class(type)) {
    case H5T_INTEGER:
      return {H5Tcopy(H5T_NATIVE_LLONG), H5Tclose};
    case H5T_FLOAT:
      return {H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose};
    case H5T_STRING:
      return H5Tis_variable_str(type) > 0 ? make_string_type() : Handle(H5Tcopy(type), H5Tclose);
    default:
      return {};
  }
}

class Walker {
 public:
  explicit Walker(const std::string& path) : path_(path) {
    std::error_code ignored;
    file_size_ = static_cast<double>(std::filesystem::file_size(path, ignored));
  }

  std::vector<Diagnostic> walk() {
    const Handle access = make_file_access();
    const Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
    if (!file.is_valid()) return {};  // who opens it for its content says why
    heaps_.emplace(file.get());
    const Handle root(H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose);
    if (root.is_valid()) {
      seen_.insert(get_address(root.get()));
      visit(root.get(), "/", 0);
    } else {
      report_unreadable("/");
    }
    return found_.items();
  }

 private:
  void report(const char* id, const std::string& what, const std::string& advice) {
    found_.error(id, {path_}, what, advice);
  }
  void report_outside(const std::string& what) {
    report("hdf5.outside", what + ": Bough reads nothing outside the file that is named",
           "copy what it leads to into the file (h5copy, h5repack)");
  }
  void report_claim(const std::string& what) { report("hdf5.damaged", what, "write the file again"); }

  /// A call that fails leaves the library in a state that the next one may not survive.
  void report_unreadable(const std::string& what) { report_claim(what + " cannot be read"); }

  void visit(hid_t object, const std::string& path, int level) {
    std::vector<std::string> attributes;
    if (H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_attribute, &attributes) < 0)
      return report_unreadable("the attributes of " + path);
    for (const auto& name : attributes) read_attribute(object, path, name);
    const auto kind = H5Iget_type(object);
    if (kind == H5I_DATASET) read_dataset(object, path);
    if (kind != H5I_GROUP) return;
    if (level > kMaxGroupLevels)
      return report_claim(path + " is nested deeper than " + std::to_string(kMaxGroupLevels));
    std::vector<Link> links;
    if (H5Literate(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_link, &links) < 0)
      return report_unreadable("group " + path);
    for (const auto& link : links) {
      const std::string child = (level == 0 ? "/" : path + "/") + link.name;
      if (link.type == H5L_TYPE_SOFT) continue;  // its target is visited by its own path
      if (link.type != H5L_TYPE_HARD) {
        report_outside(child + " is a link to another file");
        continue;
      }
      if (!seen_.insert(link.address).second) continue;
      const Handle opened(H5Oopen(object, link.name.c_str(), H5P_DEFAULT), H5Oclose);
      if (opened.is_valid())
        visit(opened.get(), child, level + 1);
      else
        report_unreadable(child);
    }
  }

  void read_attribute(hid_t object, const std::string& path, const std::string& name) {
    const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
    const std::string what = "attribute " + path + "@" + name;
    if (!attribute.is_valid()) return report_unreadable(what);
    const Handle type(H5Aget_type(attribute.get()), H5Tclose), space(H5Aget_space(attribute.get()), H5Sclose);
    const Handle memory = make_memory_type(type.get());
    const double count = calc_count(get_dims(space.get()));
    if (count > 0 && H5Tget_size(type.get()) == 0) return report_claim(what + " has values without a size");
    if (count * static_cast<double>(H5Tget_size(type.get())) > std::max(file_size_, kMega))
      return report_claim(what + " claims more than the file holds");
    if (!memory.is_valid() || H5Sget_simple_extent_type(space.get()) == H5S_NULL || count == 0) return;
    if (is_text(memory)) {
      std::vector<char> references(static_cast<std::size_t>(count) * heaps_->reference_size());
      if (H5Aread(attribute.get(), heaps_->reference_type(), references.data()) < 0 || !heaps_->holds(references))
        return report_unreadable(what);
    }
    std::vector<char> data(static_cast<std::size_t>(count) * H5Tget_size(memory.get()));
    if (H5Aread(attribute.get(), memory.get(), data.data()) < 0) return report_unreadable(what);
    free_text(memory, space, data);
  }

  /// Returns true for strings of variable length.
  static bool is_text(const Handle& memory) {
    return H5Tget_class(memory.get()) == H5T_STRING && H5Tis_variable_str(memory.get()) > 0;
  }

  /// Counts and gives back the texts that variable strings point to.
  void free_text(const Handle& memory, const Handle& space, std::vector<char>& data) {
    if (!is_text(memory)) return;
    auto** texts = reinterpret_cast<char**>(data.data());
    for (std::size_t i = 0; i < data.size() / sizeof(char*); ++i)
      if (texts[i]) text_ += static_cast<double>(std::string_view(texts[i]).size());
    H5Dvlen_reclaim(memory.get(), space.get(), H5P_DEFAULT, data.data());
  }

  void read_dataset(hid_t dataset, const std::string& path) {
    const Handle creation(H5Dget_create_plist(dataset), H5Pclose), type(H5Dget_type(dataset), H5Tclose),
        space(H5Dget_space(dataset), H5Sclose);
    const auto layout = H5Pget_layout(creation.get());
    if (layout == H5D_VIRTUAL) return report_outside(path + " is a virtual dataset");
    if (H5Pget_external_count(creation.get()) > 0) return report_outside(path + " is stored in another file");
    const int num_filters = H5Pget_nfilters(creation.get());
    const Dims dims = get_dims(space.get());
    const double width = static_cast<double>(H5Tget_size(type.get())), size = calc_count(dims) * width;
    if (calc_count(dims) > 0 && width == 0) return report_claim(path + " has values without a size");
    if (H5Sget_simple_extent_type(space.get()) == H5S_NULL || size == 0) return;
    double chunk_size = 0;
    if (layout == H5D_CHUNKED) {
      Dims chunk(dims.size());
      H5Pget_chunk(creation.get(), static_cast<int>(chunk.size()), chunk.data());
      chunk_size = calc_count(chunk) * width;
    }
    const auto stored = static_cast<double>(H5Dget_storage_size(dataset));
    const double expected = num_filters > 0 ? kMaxCompression * file_size_ : 0;
    unstored_ += std::max(0.0, size - stored);
    if (stored > file_size_ || unstored_ > kMaxUnstored + expected || chunk_size > kMaxUnstored + expected)
      return report_claim(path + " claims the shape " + describe_shape(dims) + ", which the " +
                          std::to_string(static_cast<long long>(file_size_)) + " bytes of the file cannot hold");
    const Handle memory = make_memory_type(type.get());
    if (!memory.is_valid()) return;
    // H5Dget_storage_size has read all chunks; the data after them are uncompressed numbers.
    const bool is_plain = num_filters == 0 && H5Tget_class(memory.get()) != H5T_STRING;
    read_rows(dataset, path, memory, dims, is_plain && plain_ > kMaxPlain);
    if (is_plain) plain_ += size;
  }

  /// All of the dataset, some rows at a time, or the first and the last of them.
  void read_rows(hid_t dataset, const std::string& path, const Handle& memory, const Dims& dims, bool ends_only) {
    const double width = static_cast<double>(H5Tget_size(memory.get()));
    Dims start(dims.size(), 0), block = dims;
    const hsize_t rows = dims.empty() ? 1 : dims[0];
    const double row_size = calc_count(dims) / static_cast<double>(rows) * width;
    const auto step = static_cast<hsize_t>(std::max(1.0, (ends_only ? kEnd : kPiece) / row_size));
    for (hsize_t row = 0; row < rows;
         row = ends_only ? std::max(row + step, rows - std::min(rows, step)) : row + step) {
      const Handle from(H5Dget_space(dataset), H5Sclose);
      Handle to(H5Scopy(from.get()), H5Sclose);
      if (!dims.empty()) {
        start[0] = row;
        block[0] = std::min(step, rows - row);
        H5Sselect_hyperslab(from.get(), H5S_SELECT_SET, start.data(), nullptr, block.data(), nullptr);
        to = Handle(H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr), H5Sclose);
      }
      if (is_text(memory)) {
        std::vector<char> references(static_cast<std::size_t>(calc_count(block)) * heaps_->reference_size());
        if (H5Dread(dataset, heaps_->reference_type(), to.get(), from.get(), H5P_DEFAULT, references.data()) < 0 ||
            !heaps_->holds(references))
          return report_unreadable(path);
      }
      std::vector<char> data(static_cast<std::size_t>(calc_count(block) * width));
      if (H5Dread(dataset, memory.get(), to.get(), from.get(), H5P_DEFAULT, data.data()) < 0)
        return report_unreadable(path);
      free_text(memory, to, data);
      if (text_ > kMaxUnstored + 16 * file_size_)
        return report_claim(path + " claims more text than the " + std::to_string(static_cast<long long>(file_size_)) +
                            " bytes of the file hold");
    }
  }

  const std::string& path_;
  double file_size_ = 0, unstored_ = 0, text_ = 0, plain_ = 0;
  std::set<haddr_t> seen_;
  std::optional<TextHeaps> heaps_;
  Diagnostics found_;
};

}  // namespace

std::vector<Diagnostic> find_faults(const std::string& path) {
  QuietErrors quiet;
  // Only the filters of the library itself: no code is loaded for a file's sake.
  H5PLset_loading_state(0);
  // Memory that the library leaves uninitialized must not contain old data: the file would be read here and crash
  // elsewhere.
  H5garbage_collect();
  H5set_free_list_limits(0, 0, 0, 0, 0, 0);
  return Walker(path).walk();
}

}  // namespace bough::hdf5
