#include "formats/export/random_text.hpp"

namespace bough::exports {

std::vector<RandomOutput> list_random_outputs(const records::RandomResponse& response) {
  std::vector<RandomOutput> outputs;
  for (const auto& curves : response.curves) {
    const auto num = curves.components.size();
    for (Eigen::Index c = 0; c < curves.rms.size(); ++c) {
      const auto at = static_cast<std::size_t>(c);
      RandomOutput output;
      output.curves = &curves;
      output.column = c;
      if (curves.card.empty()) {
        output.quantity = curves.quantity;
        output.id = curves.dofs[at].first;
        output.component = std::to_string(curves.dofs[at].second);
      } else {
        output.quantity = curves.card + (curves.quantity == "stress" ? ":stress" : "");
        output.id = curves.ids[at / num];
        output.component = curves.components[at % num];
      }
      output.name = output.quantity + ":" + std::to_string(output.id) + ":" + output.component;
      outputs.push_back(std::move(output));
    }
  }
  return outputs;
}

std::vector<CsvColumn> make_psd_columns(const records::RandomResponse& response) {
  std::vector<CsvColumn> columns{{"random", Eigen::VectorXd::Constant(response.hz.size(), response.set)},
                                 {"frequency_hz", response.hz}};
  for (const auto& output : list_random_outputs(response))
    columns.push_back({"psd:" + output.name, output.curves->psd.col(output.column)});
  return columns;
}

std::vector<CsvColumn> make_autocorrelation_columns(const records::RandomResponse& response) {
  if (response.lags.size() == 0) return {};
  std::vector<CsvColumn> columns{{"random", Eigen::VectorXd::Constant(response.lags.size(), response.set)},
                                 {"lag", response.lags}};
  for (const auto& output : list_random_outputs(response))
    columns.push_back({"autocorrelation:" + output.name, output.curves->autocorrelation.col(output.column)});
  return columns;
}

}  // namespace bough::exports
