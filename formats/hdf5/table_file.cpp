#include "formats/hdf5/table_file.hpp"

#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/detail/writer.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::hdf5 {

namespace {
constexpr const char* kFormat = "bough-outcomes";
constexpr const char* kVersion = "1.0";
}  // namespace

void write_outcomes(const OutcomeTable& table, const std::string& path) {
  FileWriter file(path, kFormat, kVersion);
  file.write_attribute("/", "campaign", table.name);
  file.write_attribute("/", "fingerprint", table.fingerprint);
  file.write_integers("/case", table.cases, {"number of the case; its folder is case-NNNN", "1"});
  for (const auto& column : table.columns) {
    if (!column.words.empty() || column.numbers.size() == 0)
      file.write_strings(column.path, column.words, {column.description, "1"});
    else if (column.numbers.cols() == 1)
      file.write_vector(column.path, column.numbers.col(0), {column.description, "of the quantity"});
    else
      file.write_matrix(column.path, column.numbers, {column.description, "of the quantity"});
  }
  file.commit();
}

OutcomeTable read_outcomes(const std::string& path) {
  FileReader file(path, kFormat, kVersion);
  OutcomeTable table;
  table.name = file.read_attribute("/", "campaign");
  table.fingerprint = file.read_attribute("/", "fingerprint");
  table.cases = file.read_integers("/case", -1);
  for (const auto& object : read_info(path).objects) {
    OutcomeColumn column{object.path, object.description, {}, {}};
    if (object.type == "string")
      column.words = file.read_strings(object.path, -1);
    else if (object.path != "/case" && object.type.starts_with("float"))
      column.numbers = read_numbers(path, object.path);
    else
      continue;
    table.columns.push_back(std::move(column));
  }
  file.throw_if_errors();
  return table;
}

Eigen::MatrixXd read_numbers(const std::string& path, const std::string& dataset) {
  FileReader file(path);
  const std::string name = dataset.empty() || dataset[0] != '/' ? "/" + dataset : dataset;
  const auto fail = [&](const char* id, const std::string& what) {
    return InputError(id, {path}, what, "bough info lists the contents of the file");
  };
  if (!file.has(name)) throw fail("hdf5.missing", name + " is missing");
  const Handle object(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!object.is_valid()) throw fail("hdf5.type", name + " is a group, not numbers");
  const Handle type(H5Dget_type(object.get()), H5Tclose);
  const auto kind = H5Tget_class(type.get());
  if (kind != H5T_FLOAT && kind != H5T_INTEGER) throw fail("hdf5.type", name + " does not hold numbers");
  const Handle space(H5Dget_space(object.get()), H5Sclose);
  Dims shape(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space.get()))));
  if (!shape.empty()) H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
  Eigen::Index rows = shape.empty() ? 1 : static_cast<Eigen::Index>(shape[0]), cols = 1;
  for (std::size_t i = 1; i < shape.size(); ++i) cols *= static_cast<Eigen::Index>(shape[i]);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> numbers(rows, cols);
  if (numbers.size() > 0 && H5Dread(object.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) < 0)
    throw fail("hdf5.damaged", name + " cannot be read");
  return numbers;
}

}  // namespace bough::hdf5
