#include "formats/hdf5/detail/reader.hpp"

#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

#include <unistd.h>

#include "base/file_roles.hpp"
#include "base/part_file.hpp"
#include "formats/hdf5/inspect.hpp"

namespace bough::hdf5 {

namespace {

constexpr char kSignature[8] = {'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// To open a file that a run writes.
constexpr int kMaxTries = 40;

std::string describe_expected(const Shape& shape) {
  std::string text;
  for (const long d : shape) text += (text.empty() ? "" : " x ") + (d < 0 ? std::string("any") : std::to_string(d));
  return text.empty() ? "scalar" : text;
}

bool matches(const Dims& found, const Shape& expected) {
  if (found.size() != expected.size()) return false;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (expected[i] >= 0 && found[i] != static_cast<hsize_t>(expected[i])) return false;
  }
  return true;
}

std::size_t count(const Dims& shape) {
  std::size_t n = 1;
  for (const auto d : shape) n *= d;
  return n;
}

Dims get_dims(hid_t space) {
  Dims dims(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  if (!dims.empty()) H5Sget_simple_extent_dims(space, dims.data(), nullptr);
  return dims;
}

Dims make_fallback(const Shape& expected) {
  Dims dims;
  for (const long d : expected) dims.push_back(static_cast<hsize_t>(std::max(0L, d)));
  return dims;
}

herr_t add_name(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

int get_major(const std::string& version) { return std::atoi(version.c_str()); }

}  // namespace

Handle open_file(const std::string& path, bool to_write) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw InputError("hdf5.cannot-open", {path}, "no such file", "check its path");
  std::ifstream in;  // opening a pipe would wait for a writer
  if (!std::filesystem::is_regular_file(path, ignored) || !(in.open(path, std::ios::binary), in)) {
    throw InputError("hdf5.cannot-open", {path}, "the file cannot be opened", "check its path and permissions");
  }
  if (!to_write) note_input(path);
  char head[8] = {};
  in.read(head, sizeof head);
  const auto length = static_cast<std::size_t>(in.gcount());
  if (std::memcmp(head, kSignature, length) != 0) {
    throw InputError("hdf5.not-hdf5", {path}, "the file is not an HDF5 file", "give a file written by bough");
  }
  inspect_file(path);
  const Handle access = make_file_access();
  const auto open = [&] {
    return Handle(H5Fopen(path.c_str(), to_write ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access.get()), H5Fclose);
  };
  Handle file = open();
  // In the middle of a flush of the run that writes it: the next moment will do.
  for (int i = 0; !file.is_valid() && !to_write && i < kMaxTries && is_file_locked(path); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    file = open();
  }
  if (!file.is_valid()) {
    if (to_write && H5Fis_hdf5(path.c_str()) > 0 && ::access(path.c_str(), W_OK) != 0) {
      throw InputError("hdf5.cannot-open", {path}, "the file cannot be written to", "check its permissions");
    }
    if (is_file_locked(path))
      throw InputError("hdf5.busy", {path}, "another process writes this file",
                       "wait until it ends, or choose another");
    const auto size = std::filesystem::file_size(path, ignored);
    if (ignored) throw InputError("hdf5.cannot-open", {path}, "no such file", "check its path");  // removed meanwhile
    throw InputError("hdf5.truncated", {path}, "the file ends early or is damaged: " + std::to_string(size) + " bytes",
                     "copy or write it again");
  }
  return file;
}

void check_format(hid_t file, const std::string& path, const std::string& format, const std::string& version) {
  const std::string found = read_text_attribute(file, "format");
  if (found != format) {
    throw InputError("hdf5.wrong-format", {path},
                     found.empty() ? "the file has no attribute 'format', expected \"" + format + "\""
                                   : "the file is \"" + found + "\", expected \"" + format + "\"",
                     "give a file of that kind");
  }
  const std::string found_version = read_text_attribute(file, "format_version");
  if (get_major(found_version) > get_major(version) || get_major(found_version) < 1) {
    throw InputError(
        "hdf5.wrong-format", {path},
        "the file has format version '" + found_version + "', expected " + std::to_string(get_major(version)) + ".x",
        "use a newer version of Bough, or write the file again");
  }
}

FileReader::FileReader(const std::string& path, const std::string& format, const std::string& version)
    : path_(path), file_(open_file(path)) {
  check_format(file_.get(), path, format, version);
  layout_ = find_layout(format);
  if (layout_ != nullptr) counts_.emplace(*layout_);
}

FileReader::FileReader(const std::string& path) : path_(path), file_(open_file(path)) {}

void FileReader::error(const char* id, const std::string& what, const std::string& advice) {
  diagnostics_.error(id, {path_}, what, advice);
}

Handle FileReader::find_dataset(const std::string& path, const Shape& shape, H5T_class_t type, Dims& found) {
  found = make_fallback(shape);
  Handle dataset(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.is_valid()) {
    if (has(path))
      error("hdf5.damaged", path + " cannot be read", "write the file again");
    else
      error("hdf5.missing", path + " is missing", "write the file again");
    return {};
  }
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  const Dims dims = get_dims(space.get());
  if (!matches(dims, shape)) {
    error("hdf5.shape", path + " has the shape " + describe_shape(dims) + ", expected " + describe_expected(shape),
          "write the file again");
    return {};
  }
  double elements = 1;
  for (const auto d : dims) elements *= static_cast<double>(d);
  if (elements > 1e11) {
    error("hdf5.damaged", path + " claims the shape " + describe_shape(dims), "write the file again");
    return {};
  }
  const Handle found_type(H5Dget_type(dataset.get()), H5Tclose);
  const H5T_class_t found_class = H5Tget_class(found_type.get());
  const bool fits = found_class == type || (type == H5T_FLOAT && found_class == H5T_INTEGER);
  if (!fits) {
    error("hdf5.type",
          path + " holds values of another type, expected " +
              (type == H5T_STRING    ? "strings"
               : type == H5T_INTEGER ? "integers"
                                     : "numbers"),
          "write the file again");
    return {};
  }
  found = dims;
  return dataset;
}

Handle FileReader::open_dataset(const std::string& path, const Shape& shape, H5T_class_t type, Dims& found) {
  Handle dataset = find_dataset(path, shape, type, found);
  // Counts of an array that cannot be read are those of its fallback, so that later arrays fit it.
  if (const auto match = layout_ == nullptr ? std::nullopt : find_row(*layout_, path))
    counts_->add(*match->row, path, Shape(found.begin(), found.end()));
  return dataset;
}

Shape FileReader::get_shape(const std::string& path) const {
  const auto match = layout_ == nullptr ? std::nullopt : find_row(*layout_, path);
  BOUGH_DEMAND(match.has_value());
  return counts_->get_shape(*match->row, path);
}

Eigen::MatrixXd FileReader::read_matrix(const std::string& path) {
  const Shape shape = get_shape(path);
  return read_matrix(path, shape.at(0), shape.at(1));
}

Eigen::MatrixXi FileReader::read_integer_matrix(const std::string& path) {
  const Shape shape = get_shape(path);
  return read_integer_matrix(path, shape.at(0), shape.at(1));
}

NumberArray FileReader::read_array(const std::string& path, const Shape& shape, bool may_be_nan, long most_rows) {
  NumberArray array;
  const Handle dataset = open_dataset(path, shape, H5T_FLOAT, array.shape);
  const bool is_part = most_rows >= 0 && !array.shape.empty() && array.shape[0] > static_cast<hsize_t>(most_rows);
  if (is_part) array.shape[0] = static_cast<hsize_t>(most_rows);
  array.data.assign(count(array.shape), 0.0);
  if (!dataset.is_valid() || array.data.empty()) return array;
  const Handle memory(H5Screate_simple(static_cast<int>(array.shape.size()), array.shape.data(), nullptr), H5Sclose);
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  const Dims start(array.shape.size(), 0);
  if (is_part) H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, array.shape.data(), nullptr);
  if (H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, memory.get(), space.get(), H5P_DEFAULT, array.data.data()) < 0) {
    error("hdf5.damaged", path + " cannot be read", "write the file again");
    return array;
  }
  if (!may_be_nan) {
    std::size_t bad = 0;
    for (const double x : array.data) bad += std::isfinite(x) ? 0 : 1;
    if (bad > 0) {
      error("hdf5.nan", path + " has " + std::to_string(bad) + " values that are not finite numbers",
            "find out which step made them and write the file again");
    }
  }
  return array;
}

Eigen::VectorXd FileReader::read_vector(const std::string& path, long size, bool may_be_nan) {
  const NumberArray array = read_array(path, {size}, may_be_nan);
  return Eigen::Map<const Eigen::VectorXd>(array.data.data(), static_cast<Eigen::Index>(array.data.size()));
}

Eigen::MatrixXd FileReader::read_matrix(const std::string& path, long rows, long cols) {
  const NumberArray array = read_array(path, {rows, cols});
  return Eigen::Map<const RowMajor>(array.data.data(), static_cast<Eigen::Index>(array.shape[0]),
                                    static_cast<Eigen::Index>(array.shape[1]));
}

double FileReader::read_number(const std::string& path) { return read_array(path, {1}).data[0]; }

std::vector<int> FileReader::read_integers(const std::string& path, long size) {
  Dims found;
  const Handle dataset = open_dataset(path, {size}, H5T_INTEGER, found);
  std::vector<int> data(count(found), 0);
  if (dataset.is_valid() && !data.empty() &&
      H5Dread(dataset.get(), H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()) < 0) {
    error("hdf5.damaged", path + " cannot be read", "write the file again");
  }
  return data;
}

Eigen::MatrixXi FileReader::read_integer_matrix(const std::string& path, long rows, long cols) {
  Dims found;
  const Handle dataset = open_dataset(path, {rows, cols}, H5T_INTEGER, found);
  Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> data(static_cast<Eigen::Index>(found[0]),
                                                                           static_cast<Eigen::Index>(found[1]));
  data.setZero();
  if (dataset.is_valid() && data.size() > 0 &&
      H5Dread(dataset.get(), H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()) < 0) {
    error("hdf5.damaged", path + " cannot be read", "write the file again");
  }
  return data;
}

std::vector<std::string> FileReader::read_strings(const std::string& path, const Shape& shape) {
  Dims found;
  const Handle dataset = open_dataset(path, shape, H5T_STRING, found);
  std::vector<std::string> words(count(found));
  if (!dataset.is_valid() || words.empty()) return words;
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  if (H5Tis_variable_str(type.get()) > 0) {
    const Handle memory = make_string_type();
    std::vector<char*> data(words.size(), nullptr);
    const Handle transfer = make_string_transfer(words.size());
    if (H5Dread(dataset.get(), memory.get(), H5S_ALL, H5S_ALL, transfer.get(), data.data()) < 0) {
      error("hdf5.damaged", path + " cannot be read", "write the file again");
      return words;
    }
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (!data[i]) continue;
      words[i] = data[i];
      H5free_memory(data[i]);
    }
    return words;
  }
  const std::size_t width = H5Tget_size(type.get());
  std::string data(width * words.size(), '\0');
  if (H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()) < 0) {
    error("hdf5.damaged", path + " cannot be read", "write the file again");
    return words;
  }
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string word = data.substr(i * width, width);
    words[i] = word.substr(0, word.find('\0'));
  }
  return words;
}

std::string FileReader::read_text(const std::string& path) {
  const Handle dataset(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  const Dims dims = get_dims(space.get());
  if (count(dims) != 1) {
    error("hdf5.shape", path + " has the shape " + describe_shape(dims) + ", expected one text",
          "write the file again");
    return {};
  }
  return read_strings(path, Shape(dims.size(), 1)).front();
}

std::string FileReader::read_attribute(const std::string& object, const std::string& name) {
  if (object != "/" && !has(object)) return {};
  const Handle opened(H5Oopen(file_.get(), object.c_str(), H5P_DEFAULT), H5Oclose);
  return opened.is_valid() ? read_text_attribute(opened.get(), name) : std::string();
}

int FileReader::read_integer_attribute(const std::string& object, const std::string& name, int otherwise) {
  if (object != "/" && !has(object)) return otherwise;
  const Handle opened(H5Oopen(file_.get(), object.c_str(), H5P_DEFAULT), H5Oclose);
  if (!opened.is_valid() || H5Aexists(opened.get(), name.c_str()) <= 0) return otherwise;
  const Handle attribute(H5Aopen(opened.get(), name.c_str(), H5P_DEFAULT), H5Aclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  int value = otherwise;
  if (H5Sget_simple_extent_npoints(space.get()) == 1 && H5Tget_class(type.get()) == H5T_INTEGER) {
    H5Aread(attribute.get(), H5T_NATIVE_INT, &value);
  }
  return value;
}

namespace {
/// The texts of a list or table of them; empty for another kind.
std::vector<std::string> read_texts(hid_t object, const std::string& name, Dims& dims) {
  if (H5Aexists(object, name.c_str()) <= 0) return {};
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  dims = get_dims(space.get());
  if (H5Tis_variable_str(type.get()) <= 0 || count(dims) == 0) return {};
  const Handle memory = make_string_type();
  std::vector<char*> data(count(dims), nullptr);
  if (H5Aread(attribute.get(), memory.get(), data.data()) < 0) return {};
  std::vector<std::string> words;
  for (char* text : data) {
    words.emplace_back(text ? text : "");
    H5free_memory(text);
  }
  return words;
}
}  // namespace

std::vector<std::string> FileReader::read_attribute_words(const std::string& object, const std::string& name) {
  if (!has(object)) return {};
  const Handle opened(H5Oopen(file_.get(), object.c_str(), H5P_DEFAULT), H5Oclose);
  Dims dims;
  auto words = opened.is_valid() ? read_texts(opened.get(), name, dims) : std::vector<std::string>();
  return dims.size() == 1 ? words : std::vector<std::string>();
}

std::vector<std::pair<std::string, std::string>> FileReader::read_source() {
  std::vector<std::pair<std::string, std::string>> source;
  Dims dims;
  const auto words = read_texts(file_.get(), "source", dims);
  if (dims.size() != 2 || dims[1] != 2) return source;
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) source.emplace_back(words[i], words[i + 1]);
  return source;
}

std::vector<std::string> FileReader::get_children(const std::string& group) {
  std::vector<std::string> names;
  if (!has(group)) return names;
  const Handle opened(H5Gopen2(file_.get(), group.c_str(), H5P_DEFAULT), H5Gclose);
  if (opened.is_valid()) H5Literate(opened.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add_name, &names);
  return names;
}

Eigen::MatrixXd to_matrix(const NumberArray& array) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  BOUGH_DEMAND(array.shape.size() == 2);
  return Eigen::Map<const Rows>(array.data.data(), static_cast<Eigen::Index>(array.shape[0]),
                                static_cast<Eigen::Index>(array.shape[1]));
}

}  // namespace bough::hdf5
