#pragma once
/// \file Layouts of the HDF5 files: one row per dataset and attribute, from which writers take descriptions, readers
/// take shapes, `info` takes missing descriptions, and docs/formats takes its tables.
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/hdf5/files.hpp"

namespace bough::hdf5 {

/// Type of the values of an array: 64-bit reals, 32-bit reals, 32-bit integers, UTF-8 texts of variable length.
enum class ArrayKind { Real, Single, Integer, Text };

/// One dataset, or one attribute.
struct LayoutRow {
  /// "/modes/phi", "/modes@num_rigid"; {word} stands for any name or part of a name.
  std::string_view path;
  ArrayKind kind = ArrayKind::Real;
  /// Sizes, separated by ", ": numbers, names of counts, or expressions; empty: a single value of an attribute.
  std::string_view shape;
  std::string_view dims;         ///< M L T F E, as the attribute `dims` of a dataset
  std::string_view description;  ///< as the attribute `description` of a dataset
  std::string_view when;         ///< condition; empty: in every file
  std::string_view since;        ///< version of Bough; empty: from 0.1 on
  std::string_view note;         ///< for the manual alone
};

/// The rows of one kind of file.
struct Layout {
  std::string_view format;  ///< root attribute `format`
  std::string_view page;    ///< docs/formats/PAGE.md; empty: its rows are those of another format
  std::vector<LayoutRow> rows;
};

/// Layouts of all kinds of files that have one.
const std::vector<Layout>& get_layouts();
/// Returns the layout of a format; nullptr if it has none.
const Layout* find_layout(std::string_view format);

/// Texts of a file that its layout names in braces, as {equation}, by these names.
using LayoutTexts = std::map<std::string, std::string>;

/// The row of a path, and the word that its last placeholder stands for.
struct LayoutMatch {
  const LayoutRow* row = nullptr;
  std::string word;
  /// Returns a text of the row with the texts of the file, else the word, in place of each name in braces.
  std::string fill_in(std::string_view text, const LayoutTexts& texts = {}) const;
};
/// Returns the row of this path, else the first one whose placeholders match; none if there is no such row.
std::optional<LayoutMatch> find_row(const Layout& layout, std::string_view path);

/// Sizes of the named counts of a layout, as far as arrays of a file have shown them.
class LayoutCounts {
 public:
  explicit LayoutCounts(const Layout& layout);
  /// \return the shape of the array at `path` by its row, -1 for a size that is not known yet.
  std::vector<long> get_shape(const LayoutRow& row, const std::string& path) const;
  /// Takes the counts that are not known yet from the shape of an array. A shape of another rank is ignored.
  void add(const LayoutRow& row, const std::string& path, const std::vector<long>& shape);

 private:
  /// "n" of the file, or "/mesh/elements/quad4/e" of a group.
  std::string name_count(const std::string& word, const std::string& group) const;

  const Layout& layout_;
  std::map<std::string, long> counts_;
};

/// Splits "p, 6, n" into its sizes.
std::vector<std::string> split_shape(std::string_view shape);

/// Compares the objects of a file with the layout of its format.
/// \return one line per required array that is missing and per array of another shape or type than its row; empty for
/// formats without a layout.
std::vector<std::string> find_layout_faults(const FileInfo& info);

}  // namespace bough::hdf5
