#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>

#include <matio.h>

#include "base/file_roles.hpp"
#include "base/isolated.hpp"
#include "formats/hdf5/inspect.hpp"
#include "formats/matrices/detail/readers.hpp"
#include "formats/matrices/detail/triplets.hpp"

namespace bough::matrices::detail {
namespace {

using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

template <class T>
double get_item(const void* data, std::size_t i) {
  return static_cast<double>(static_cast<const T*>(data)[i]);
}

/// Types of numbers with the function that reads one of an array.
struct Item {
  matio_types type;
  double (*get)(const void* data, std::size_t i);
};
constexpr Item kItems[] = {{MAT_T_DOUBLE, get_item<double>},     {MAT_T_SINGLE, get_item<float>},
                           {MAT_T_INT8, get_item<mat_int8_t>},   {MAT_T_UINT8, get_item<mat_uint8_t>},
                           {MAT_T_INT16, get_item<mat_int16_t>}, {MAT_T_UINT16, get_item<mat_uint16_t>},
                           {MAT_T_INT32, get_item<mat_int32_t>}, {MAT_T_UINT32, get_item<mat_uint32_t>},
                           {MAT_T_INT64, get_item<mat_int64_t>}, {MAT_T_UINT64, get_item<mat_uint64_t>}};

class MatReader {
 public:
  explicit MatReader(const std::string& path) : path_(path), file_(Mat_Open(path.c_str(), MAT_ACC_RDONLY), Mat_Close) {
    if (!file_) fail("the file cannot be read as a MATLAB file", "write it with save -v6, -v7 or -v7.3");
    note_input(path);
  }

  std::vector<Matrix> read() {
    std::error_code ignored;
    const double size = static_cast<double>(std::filesystem::file_size(path_, ignored));
    for (;;) {
      Variable info(Mat_VarReadNextInfo(file_.get()), Mat_VarFree);
      if (!info) break;
      // zlib packs at most 1032 bytes into one: what claims more is damaged.
      double count = 1;
      for (int i = 0; i < info->rank && info->dims; ++i) count *= static_cast<double>(info->dims[i]);
      const bool is_full = info->class_type >= MAT_C_DOUBLE && info->class_type <= MAT_C_UINT64;
      if (is_full && count * static_cast<double>(Mat_SizeOfClass(info->class_type)) > 1100 * size + 1e6)
        fail("variable " + get_name(*info) + " claims more values than the file can hold", "write the file again");
      if (is_full || info->class_type == MAT_C_SPARSE || info->class_type == MAT_C_STRUCT) {
        if (Mat_VarReadDataAll(file_.get(), info.get()) != 0)
          fail("variable " + get_name(*info) + " cannot be read", "the file is damaged: write it again");
        add(*info, get_name(*info), 0);
      }
    }
    return std::move(matrices_);
  }

 private:
  static std::string get_name(const matvar_t& variable) { return variable.name ? variable.name : ""; }

  void add(const matvar_t& variable, const std::string& name, int depth) {
    if (variable.rank != 2 || !variable.dims) return;
    if (variable.class_type == MAT_C_STRUCT) {
      // Fields of a struct of one element: "model.K".
      if (variable.dims[0] != 1 || variable.dims[1] != 1 || depth > 4) return;
      auto& whole = const_cast<matvar_t&>(variable);
      const unsigned count = Mat_VarGetNumberOfFields(&whole);
      for (unsigned i = 0; i < count; ++i)
        if (const auto* field = Mat_VarGetStructFieldByIndex(&whole, i, 0); field)
          add(*field, name + "." + get_name(*field), depth + 1);
      return;
    }
    const bool is_full = variable.class_type >= MAT_C_DOUBLE && variable.class_type <= MAT_C_UINT64;
    if (!is_full && variable.class_type != MAT_C_SPARSE) return;
    const std::size_t rows = variable.dims[0], columns = variable.dims[1];
    if (rows > static_cast<std::size_t>(kMaxRows) || columns > static_cast<std::size_t>(kMaxRows))
      fail("variable " + name + " has " + std::to_string(rows) + " rows and " + std::to_string(columns) + " columns",
           "write the file again");
    Matrix matrix;
    matrix.name = name;
    matrix.form = rows == columns ? kSquare : kRectangular;
    Triplets entries;
    if (rows > 0 && columns > 0) {
      if (is_full) {
        add_full(variable, rows, columns, entries);
      } else {
        add_sparse(variable, rows, columns, name, entries);
      }
    }
    entries.compress(static_cast<int>(rows), static_cast<int>(columns), variable.isComplex != 0, matrix);
    matrices_.push_back(std::move(matrix));
  }

  double get(matio_types type, const void* data, std::size_t i) const {
    const auto at =
        std::find_if(std::begin(kItems), std::end(kItems), [&](const Item& item) { return item.type == type; });
    if (at == std::end(kItems))
      fail("a variable holds values of an unknown type", "the file is damaged: write it again");
    const double value = at->get(data, i);
    if (!std::isfinite(value)) fail("a variable holds a value that is not a finite number");
    return value;
  }

  void add_value(const matvar_t& variable, const void* data, std::size_t i, std::size_t row, std::size_t column,
                 Triplets& entries) const {
    double re = 0, im = 0;
    if (variable.isComplex) {
      const auto& parts = *static_cast<const mat_complex_split_t*>(data);
      if (!parts.Re || !parts.Im) fail("a complex variable has no values", "the file is damaged: write it again");
      re = get(variable.data_type, parts.Re, i);
      im = get(variable.data_type, parts.Im, i);
    } else {
      re = get(variable.data_type, data, i);
    }
    if (re != 0 || im != 0) entries.add(static_cast<int>(row), static_cast<int>(column), re, im);
  }

  void add_full(const matvar_t& variable, std::size_t rows, std::size_t columns, Triplets& entries) const {
    if (!variable.data || variable.nbytes / static_cast<std::size_t>(std::max(1, variable.data_size)) < rows * columns)
      fail("variable " + get_name(variable) + " has fewer values than its size says", "write the file again");
    for (std::size_t c = 0; c < columns; ++c)
      for (std::size_t r = 0; r < rows; ++r) add_value(variable, variable.data, c * rows + r, r, c, entries);
  }

  void add_sparse(const matvar_t& variable, std::size_t rows, std::size_t columns, const std::string& name,
                  Triplets& entries) const {
    const auto* sparse = static_cast<const mat_sparse_t*>(variable.data);
    const auto damaged = [&] { fail("variable " + name + " is no sparse matrix", "write the file again"); };
    if (!sparse || !sparse->jc || sparse->njc != columns + 1 || sparse->jc[0] != 0) damaged();
    for (std::size_t c = 0; c < columns; ++c) {
      if (sparse->jc[c + 1] < sparse->jc[c] || sparse->jc[c + 1] > sparse->nir || sparse->jc[c + 1] > sparse->ndata)
        damaged();
      for (std::size_t k = sparse->jc[c]; k < sparse->jc[c + 1]; ++k) {
        if (!sparse->ir || !sparse->data || sparse->ir[k] >= rows) damaged();
        add_value(variable, sparse->data, k, sparse->ir[k], c, entries);
      }
    }
  }

  [[noreturn]] void fail(const std::string& what, const std::string& advice = {}) const {
    throw InputError("matrices.mat", {path_}, what, advice);
  }

  std::string path_;
  std::unique_ptr<mat_t, decltype(&Mat_Close)> file_;
  std::vector<Matrix> matrices_;
};

/// Reads and discards; errors found by Bough itself are reported when the file is read again.
std::string try_mat(const std::string& path) {
  try {
    MatReader(path).read();
  } catch (const InputError&) {
  }
  return {};
}

}  // namespace

std::vector<Matrix> read_mat(const std::string& path) {
  if (read_bytes(path, 10) == "MATLAB 7.3") hdf5::inspect_file(path);
  std::error_code ignored;
  const double size = static_cast<double>(std::filesystem::file_size(path, ignored));
  // Damaged files break the library (heap overflows, gigabytes for the names of a struct), in a separate process
  // first.
  const IsolatedResult tried = run_isolated(path, try_mat, {5 + 1e-6 * size, 1e9 + 2200 * size}, "MATLAB file");
  if (!tried.end.empty())
    throw InputError("matrices.mat", {path}, "the file is damaged: " + tried.end, "copy or write it again");
  return MatReader(path).read();
}

}  // namespace bough::matrices::detail
