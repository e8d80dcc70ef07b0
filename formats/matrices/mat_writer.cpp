#include <cstdint>
#include <cstdio>
#include <fstream>
#include <memory>

#include <matio.h>

#include "base/diagnostic.hpp"
#include "base/part_file.hpp"
#include "base/version.hpp"
#include "formats/matrices/mat_file.hpp"

namespace bough::matrices {
namespace {

using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

Variable make_variable(const char* name, const MatValue& value);

/// The library takes pointers to data it does not change, without const.
Variable create(const char* name, matio_classes kind, matio_types type, std::vector<std::size_t> dims,
                const void* data) {
  return {Mat_VarCreate(name, kind, type, static_cast<int>(dims.size()), dims.data(), const_cast<void*>(data), 0),
          Mat_VarFree};
}

Variable make_sparse(const char* name, const records::SparseMatrix& a) {
  // Compressed columns.
  std::vector<mat_uint32_t> begin(static_cast<std::size_t>(a.num_cols) + 1, 0), row(a.data.size());
  std::vector<double> data(a.data.size());
  for (const int column : a.indices) ++begin[static_cast<std::size_t>(column) + 1];
  for (std::size_t c = 0; c + 1 < begin.size(); ++c) begin[c + 1] += begin[c];
  auto next = begin;
  for (int r = 0; r < a.num_rows; ++r)
    for (int k = a.indptr[static_cast<std::size_t>(r)]; k < a.indptr[static_cast<std::size_t>(r) + 1]; ++k) {
      const auto at = next[static_cast<std::size_t>(a.indices[static_cast<std::size_t>(k)])]++;
      row[at] = static_cast<mat_uint32_t>(r);
      data[at] = a.data[static_cast<std::size_t>(k)];
    }
  const auto count = static_cast<mat_uint32_t>(data.size());
  mat_sparse_t sparse{count, row.data(), count, begin.data(), static_cast<mat_uint32_t>(begin.size()),
                      count, data.data()};
  return create(name, MAT_C_SPARSE, MAT_T_DOUBLE,
                {static_cast<std::size_t>(a.num_rows), static_cast<std::size_t>(a.num_cols)}, &sparse);
}

Variable make_struct(const char* name, const MatFields& fields) {
  std::vector<const char*> names;
  for (const auto& field : fields) names.push_back(field.first.c_str());
  const std::size_t dims[] = {1, 1};
  Variable made(
      Mat_VarCreateStruct(name, 2, const_cast<std::size_t*>(dims), names.data(), static_cast<unsigned>(names.size())),
      Mat_VarFree);
  for (std::size_t i = 0; made && i < fields.size(); ++i)
    Mat_VarSetStructFieldByIndex(made.get(), i, 0, make_variable(names[i], fields[i].second).release());
  return made;
}

Variable make_variable(const char* name, const MatValue& value) {
  struct Make {
    const char* name;
    Variable operator()(const MatArray& array) const {
      std::size_t count = 1;
      for (const auto d : array.dims) count *= d;
      BOUGH_DEMAND(array.dims.size() >= 2 && count == array.data.size());
      return create(name, MAT_C_DOUBLE, MAT_T_DOUBLE, array.dims, array.data.data());
    }
    Variable operator()(const records::SparseMatrix& matrix) const { return make_sparse(name, matrix); }
    Variable operator()(const std::string& text) const {
      return create(name, MAT_C_CHAR, MAT_T_UTF8, {text.empty() ? std::size_t{0} : std::size_t{1}, text.size()},
                    text.data());
    }
    Variable operator()(const MatFields& fields) const { return make_struct(name, fields); }
    Variable operator()(const MatCells& cells) const {
      std::vector<matvar_t*> made;
      for (const auto& cell : cells) made.push_back(make_variable(nullptr, cell).release());
      // The cells belong to the variable from here on.
      return create(name, MAT_C_CELL, MAT_T_CELL, {cells.size(), 1}, made.data());
    }
  };
  return std::visit(Make{name}, value.value);
}

/// Returns true if a level 5 file holds `count` complete variables. The library does not report failed writes, as on a
/// full disk: the file is walked from header to header (MAT-File Format, level 5: 128 bytes, then each element with its
/// type and length of four bytes).
bool is_whole(const std::string& path, std::size_t count) {
  std::ifstream in(path, std::ios::binary);
  in.seekg(0, std::ios::end);
  const auto size = static_cast<std::uint64_t>(in.tellg());
  std::uint64_t at = 128;
  for (std::size_t k = 0; k < count; ++k) {
    std::uint32_t head[2];
    in.seekg(static_cast<std::streamoff>(at));
    if (!in.read(reinterpret_cast<char*>(head), sizeof head) || head[1] == 0) return false;
    at += sizeof head + head[1];
  }
  return at == size;
}

}  // namespace

MatValue::MatValue(double number) : value(MatArray{{1, 1}, {number}}) {}
MatArray MatValue::from_matrix(const Eigen::MatrixXd& matrix) {
  // Eigen keeps columns together, as MATLAB does.
  return {{static_cast<std::size_t>(matrix.rows()), static_cast<std::size_t>(matrix.cols())},
          {matrix.data(), matrix.data() + matrix.size()}};
}
MatValue::MatValue(MatArray array) : value(std::move(array)) {}
MatValue::MatValue(records::SparseMatrix matrix) : value(std::move(matrix)) {}
MatValue::MatValue(std::string text) : value(std::move(text)) {}
MatValue::MatValue(const char* text) : value(std::string(text)) {}
MatValue::MatValue(MatFields fields) : value(std::move(fields)) {}
MatValue::MatValue(MatCells cells) : value(std::move(cells)) {}

void write_mat(const std::string& path, const MatFields& variables) {
  const auto fail = [&](const std::string& what) {
    throw ComputationError("matrices.write", {path}, what, "check the folder, its permissions and the free space");
  };
  PartFile part(path);
  if (part.error()) fail("the file cannot be created: " + part.error().message());
  // A head without a date: the same variables give the same bytes.
  const auto head = std::string("MATLAB 5.0 MAT-file, written by Bough ") + get_version();
  mat_t* file = Mat_CreateVer(part.get_name().c_str(), head.c_str(), MAT_FT_MAT5);
  if (!file) fail("the file cannot be written");
  std::string bad;
  for (const auto& [name, value] : variables) {
    const auto variable = make_variable(name.c_str(), value);
    if (!variable || Mat_VarWrite(file, variable.get(), MAT_COMPRESSION_NONE) != 0) {
      bad = name;
      break;
    }
  }
  const bool is_closed = Mat_Close(file) == 0 && is_whole(part.get_name(), variables.size());
  if (!bad.empty()) fail("variable " + bad + " cannot be written");
  if (!is_closed || !part.commit()) fail("the file cannot be written whole");
}

}  // namespace bough::matrices
