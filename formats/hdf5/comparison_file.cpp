#include "formats/hdf5/comparison_file.hpp"

#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/detail/writer.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/hdf5/table_file.hpp"

namespace bough::hdf5 {

namespace {
constexpr const char* kFormat = "bough-comparison";
constexpr const char* kVersion = "1.0";
}  // namespace

void write_comparison(const records::Comparison& comparison, const std::string& path) {
  FileWriter file(path, kFormat, kVersion);
  file.write_source(comparison.source);
  for (const auto& [where, values, description, dims] : comparison.arrays) {
    if (values.cols() == 1)
      file.write_vector(where, values.col(0), {description, dims});
    else
      file.write_matrix(where, values, {description, dims});
  }
  for (const auto& [where, words] : comparison.words) file.write_strings(where, words, {"names of the rows", ""});
  file.commit();
}

records::Comparison read_comparison(const std::string& path) {
  FileReader file(path, kFormat, kVersion);
  records::Comparison comparison;
  comparison.source = file.read_source();
  for (const auto& object : read_info(path).objects) {
    if (object.type == "string")
      comparison.words.emplace_back(object.path, file.read_strings(object.path, -1));
    else if (object.type.starts_with("float") || object.type.starts_with("int"))
      comparison.arrays.push_back({object.path, read_numbers(path, object.path), object.description, object.dims});
  }
  file.throw_if_errors();
  return comparison;
}

}  // namespace bough::hdf5
