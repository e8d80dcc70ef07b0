#pragma once
/// \file Reads one HDF5 file of Bough: every departure from the expected is collected, then reported together.
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "base/diagnostic.hpp"
#include "formats/hdf5/detail/handle.hpp"
#include "formats/hdf5/layouts.hpp"
#include "formats/records/flex_body.hpp"

namespace bough::hdf5 {

/// Opens an existing file that inspect_file finds nothing wrong with. Throws InputError "hdf5.cannot-open",
/// "hdf5.not-hdf5", "hdf5.truncated", "hdf5.outside" or "hdf5.damaged".
Handle open_file(const std::string& path, bool to_write = false);

/// Throws InputError "hdf5.wrong-format" unless the root says this format, in a major version that is known.
void check_format(hid_t file, const std::string& path, const std::string& format, const std::string& version);

/// A shape with -1 for "any".
using Shape = std::vector<long>;

/// An array as it is in the file, C order.
struct NumberArray {
  Dims shape;
  std::vector<double> data;
};

class FileReader {
 public:
  /// Opens a file of Bough. Throws InputError if its format or version is not the expected one.
  FileReader(const std::string& path, const std::string& format, const std::string& version);
  /// Opens a file of any format, as of another program.
  explicit FileReader(const std::string& path);

  /// The identifier of the file, owned by this.
  hid_t get() const { return file_.get(); }
  /// Returns true if the file has an object at `path`.
  bool has(const std::string& path) const { return exists(file_.get(), path); }

  /// These report "hdf5.missing", "hdf5.shape" (found against expected), "hdf5.type", "hdf5.damaged" and, unless
  /// told, "hdf5.nan", and then return zeros of the expected shape (0 if it is open).
  /// If given, only the first `most_rows` of a longer array are read.
  NumberArray read_array(const std::string& path, const Shape& shape, bool may_be_nan = false, long most_rows = -1);
  /// These take the expected shape from the row of the path in the layout of the format: named counts are those of the
  /// arrays read before; a count that is not known yet may have any value, which it keeps. \pre the layout has the
  /// path.
  NumberArray read_array(const std::string& path) { return read_array(path, get_shape(path)); }
  /// Vector of the layout's size.
  Eigen::VectorXd read_vector(const std::string& path) { return read_vector(path, get_shape(path).at(0)); }
  /// Matrix of the layout's rows and columns, row by row in the file.
  Eigen::MatrixXd read_matrix(const std::string& path);
  /// List of 32-bit integers of the layout's size.
  std::vector<int> read_integers(const std::string& path) { return read_integers(path, get_shape(path).at(0)); }
  /// Matrix of integers of the layout's rows and columns.
  Eigen::MatrixXi read_integer_matrix(const std::string& path);
  /// Texts, as many as the layout has.
  std::vector<std::string> read_strings(const std::string& path) { return read_strings(path, get_shape(path)); }

  /// Vector of `size` numbers; -1: any.
  Eigen::VectorXd read_vector(const std::string& path, long size, bool may_be_nan = false);
  /// Matrix, row by row in the file; -1: any number.
  Eigen::MatrixXd read_matrix(const std::string& path, long rows, long cols);
  /// Array of length 1.
  double read_number(const std::string& path);
  /// Integers; -1: any number of them.
  std::vector<int> read_integers(const std::string& path, long size);
  /// Matrix of integers; -1: any number of rows or columns.
  Eigen::MatrixXi read_integer_matrix(const std::string& path, long rows, long cols);
  /// Texts of variable length; -1: any number of them.
  std::vector<std::string> read_strings(const std::string& path, long size) { return read_strings(path, Shape{size}); }
  std::vector<std::string> read_strings(const std::string& path, const Shape& shape);
  /// The one text of a dataset that is there.
  std::string read_text(const std::string& path);

  /// Text of an attribute; empty if the object or the attribute is missing.
  std::string read_attribute(const std::string& object, const std::string& name);
  /// A list of texts; empty if it is missing or of another kind.
  std::vector<std::string> read_attribute_words(const std::string& object, const std::string& name);
  /// Integer of an attribute; `otherwise` if it is missing or of another kind.
  int read_integer_attribute(const std::string& object, const std::string& name, int otherwise);
  /// Root attribute `source`: pairs of file name and SHA-256; empty if it is missing.
  std::vector<std::pair<std::string, std::string>> read_source();
  /// Names of the members of a group, in alphabetical order; empty if it is missing.
  std::vector<std::string> get_children(const std::string& group);

  /// Reports an error of this file, thrown by throw_if_errors().
  void error(const char* id, const std::string& what, const std::string& advice = {});
  /// Throws InputError with everything reported.
  void throw_if_errors() const { diagnostics_.throw_if_errors(); }

 private:
  /// The dataset if it is there with this shape and class; fills found.
  Handle find_dataset(const std::string& path, const Shape& shape, H5T_class_t type, Dims& found);
  /// Likewise; takes the counts of the layout from the shape.
  Handle open_dataset(const std::string& path, const Shape& shape, H5T_class_t type, Dims& found);

  /// Shape of an array by its row; -1 for a count that is not known yet.
  Shape get_shape(const std::string& path) const;

  QuietErrors quiet_;
  std::string path_;
  Handle file_;
  const Layout* layout_ = nullptr;  ///< of the format; none for formats without a table
  std::optional<LayoutCounts> counts_;
  Diagnostics diagnostics_;
};

/// Matrix of a two-dimensional array.
Eigen::MatrixXd to_matrix(const NumberArray& array);

/// Reads /mesh; an empty mesh if the file has none. Reports "hdf5.value" for elements with unknown grids.
records::BodyMesh read_mesh(FileReader& file);
/// Reads /modes/phi: for each node 6 x num_modes, translations first.
std::vector<Eigen::MatrixXd> read_mode_shapes(FileReader& file, long num_nodes, long num_modes);
/// Reads /modes/kind. Reports "hdf5.value" for an unknown kind.
std::vector<records::ModeKind> read_mode_kinds(FileReader& file);

}  // namespace bough::hdf5
