#include "formats/hdf5/comparison_file.hpp"

#include "formats/hdf5/detail/writer.hpp"

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

}  // namespace bough::hdf5
