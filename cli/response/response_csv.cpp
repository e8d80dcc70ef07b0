#include "cli/response/response_csv.hpp"

#include <sstream>

#include "formats/export/csv.hpp"

namespace bough::cli {

using Eigen::Index;

std::string make_response_csv(const records::FrequencyResponse& response) {
  std::vector<exports::CsvColumn> columns{{"frequency_hz", response.frequency_hz}};
  const Index count = response.frequency_hz.size();
  for (int j = 0; j < response.inputs.size(); ++j)
    for (int i = 0; i < response.outputs.size(); ++i) {
      const std::string name =
          response.outputs.name[static_cast<std::size_t>(i)] + "/" + response.inputs.name[static_cast<std::size_t>(j)];
      Eigen::VectorXd real(count), imag(count);
      for (Index k = 0; k < count; ++k) {
        const auto h = response.value[static_cast<std::size_t>(k)](i, j);
        real[k] = h.real(), imag[k] = h.imag();
      }
      columns.push_back({name + ":real", std::move(real)});
      columns.push_back({name + ":imag", std::move(imag)});
    }
  for (Index s = 0; s < response.singular_values.cols(); ++s)
    columns.push_back({"sigma" + std::to_string(s + 1), response.singular_values.col(s)});
  std::ostringstream text;
  exports::write_csv(text, columns);
  return text.str();
}

}  // namespace bough::cli
