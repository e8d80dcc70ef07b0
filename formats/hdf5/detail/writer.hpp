#pragma once
/// \\file Writes one HDF5 file: first under another name, renamed when complete.
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "base/part_file.hpp"
#include "formats/hdf5/detail/handle.hpp"
#include "formats/hdf5/layouts.hpp"
#include "formats/records/flex_body.hpp"

namespace bough::hdf5 {

/// Attributes of an array: text for its `description`, and its dimensions in M L T F for `dims`. An empty description,
/// and empty dimensions with it, are those of the row of the array in the layout of the format (formats/hdf5/layouts),
/// which must have one.
struct ArrayAttributes {
  std::string description, dims;
};

/// Every function throws ComputationError "hdf5.write". Without commit() no file is left.
class FileWriter {
 public:
  FileWriter(const std::string& path, const std::string& format, const std::string& version);
  /// Writes to memory; call get_image() instead of commit().
  FileWriter(const std::string& format, const std::string& version);
  ~FileWriter() = default;
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  /// Sets the text of a name in braces of the layout's descriptions, before the arrays that have it.
  void set_text(const std::string& name, const std::string& text) { texts_[name] = text; }

  /// Writes an array of doubles, last index fastest.
  void write_numbers(const std::string& path, const Dims& shape, const double* data,
                     const ArrayAttributes& attributes = {});
  /// Writes numbers that are not contiguous: fill(first, data) stores item `first` of the first dimension at `data`. A
  /// few megabytes at a time.
  void write_items(const std::string& path, const Dims& shape, const std::function<void(std::size_t, double*)>& fill,
                   const ArrayAttributes& attributes = {});
  /// Single precision, for what is only drawn.
  void write_floats(const std::string& path, const Dims& shape, const float* data,
                    const ArrayAttributes& attributes = {});
  /// Writes 32-bit integers, last index fastest.
  void write_integers(const std::string& path, const Dims& shape, const int* data,
                      const ArrayAttributes& attributes = {});
  /// Writes texts of variable length in UTF-8.
  void write_strings(const std::string& path, const std::vector<std::string>& data,
                     const ArrayAttributes& attributes = {});

  /// Writes one number as an array of length 1.
  void write_number(const std::string& path, double value, const ArrayAttributes& attributes = {});
  /// Writes a vector as an array of one dimension.
  void write_vector(const std::string& path, const Eigen::VectorXd& v, const ArrayAttributes& attributes = {});
  /// In chunks, of which those of zeros take no space.
  void write_vector_with_zeros(const std::string& path, const Eigen::VectorXd& v,
                               const ArrayAttributes& attributes = {});
  /// Writes a matrix row by row.
  void write_matrix(const std::string& path, const Eigen::MatrixXd& m, const ArrayAttributes& attributes = {});
  /// Writes a list of 32-bit integers.
  void write_integers(const std::string& path, const std::vector<int>& data, const ArrayAttributes& attributes = {});
  /// Writes a matrix of 32-bit integers row by row.
  void write_integers(const std::string& path, const Eigen::MatrixXi& m, const ArrayAttributes& attributes = {});

  /// `object` "/" is the root.
  void write_attribute(const std::string& object, const std::string& name, const std::string& text);
  void write_attribute(const std::string& object, const std::string& name, int value);
  void write_attribute(const std::string& object, const std::string& name, const std::vector<int>& values);
  void write_attribute(const std::string& object, const std::string& name, const std::vector<std::string>& words);
  /// Root attribute `source`: rows of (file name, SHA-256).
  void write_source(const std::vector<std::pair<std::string, std::string>>& source);
  /// Makes an empty group; groups above it are made too.
  void make_group(const std::string& path);
  /// A second name of an existing dataset.
  void link(const std::string& path, const std::string& existing);
  /// Makes the dataset `scale` the coordinates of the first dimension of `users`.
  void attach_scale(const std::string& scale, const std::vector<std::string>& users);

  /// Starts to write the bytes so far to disk, in the background.
  void start_sync() { part_->start_sync(); }
  /// Closes, forces the bytes to disk and renames. The file appears now.
  void commit();
  /// Closes and gives the bytes of a file in memory.
  std::string get_image();

 private:
  void open(const char* name, const Handle& access, const std::string& format, const std::string& version);
  void check(bool ok, const std::string& what);
  /// put(dataset, its space) writes all that is in it; false: it could not.
  using Put = std::function<bool(hid_t, hid_t)>;
  void write(const std::string& path, const Dims& shape, hid_t file_type, const Put& put,
             const ArrayAttributes& attributes);
  void write(const std::string& path, const Dims& shape, hid_t file_type, hid_t memory_type, const void* data,
             const ArrayAttributes& attributes, hid_t transfer = H5P_DEFAULT);
  void make_parents(const std::string& path);
  /// The group that `path` lies in, made where it is not there.
  hid_t find_parent(const std::string& path);
  /// `object` lies at `path`.
  void write_attribute(hid_t object, const std::string& path, const std::string& name, const Dims& shape,
                       hid_t file_type, hid_t memory_type, const void* data);
  void write_attribute(const std::string& object, const std::string& name, const Dims& shape, hid_t file_type,
                       hid_t memory_type, const void* data);
  void write_attributes(hid_t dataset, const std::string& path, const ArrayAttributes& attributes);

  QuietErrors quiet_;
  std::string path_;
  const Layout* layout_ = nullptr;  ///< of the format; none for formats without a table
  LayoutTexts texts_;
  std::optional<PartFile> part_;  ///< none: in memory
  // Created once: these objects take most of the time of a small dataset.
  Handle string_type_, scalar_, creation_, group_creation_, link_creation_;
  Handle file_;
  std::map<std::string, Handle> groups_;  ///< open, by path
};

/// The blocks that flexible-body and modes files share.
void write_mesh(FileWriter& file, const records::BodyMesh& mesh);
/// Writes /modes/phi: node after node 6 x num_modes.
void write_mode_shapes(FileWriter& file, const std::vector<Eigen::MatrixXd>& phi, int num_modes);
/// Writes /modes/kind as words.
void write_mode_kinds(FileWriter& file, const std::vector<records::ModeKind>& kinds);

}  // namespace bough::hdf5
