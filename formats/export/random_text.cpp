#include "formats/export/random_text.hpp"

#include <charconv>

#include "formats/records/group_names.hpp"

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
        output.quantity = records::get_card_of_group(curves.card) + (curves.quantity == "stress" ? ":stress" : "");
        output.id = curves.ids[at / num];
        output.component = curves.components[at % num];
      }
      output.name = output.quantity + ":" + std::to_string(output.id) + ":" + output.component;
      outputs.push_back(std::move(output));
    }
  }
  return outputs;
}

std::string make_rms_csv(const records::RandomResponse& response) {
  const auto outputs = list_random_outputs(response);
  const bool has_modal = !outputs.empty() && outputs.front().curves->modal_rms.size() > 0;
  std::string text = "random,output,rms,zero_crossings_hz";
  text += has_modal ? ",modal_rms,modal_zero_crossings_hz\n" : "\n";
  const auto add = [&](double value) {
    char buffer[40];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value + 0.0, std::chars_format::general, 17);
    text += ',' + std::string(buffer, end.ptr);
  };
  for (const auto& output : outputs) {
    const auto& curves = *output.curves;
    text += std::to_string(response.set) + ',' + write_csv_field(output.name);
    add(curves.rms(output.column));
    add(curves.crossing_hz(output.column));
    if (has_modal) add(curves.modal_rms(output.column));
    if (has_modal) add(curves.modal_crossing_hz(output.column));
    text += '\n';
  }
  return text;
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

std::string name_cross(const records::RandomCross& cross) {
  const auto name = [](const records::RandomCross::Output& output) {
    return output.quantity + ":" + std::to_string(output.id) + ":" + std::to_string(output.component);
  };
  return name(cross.a) + "|" + name(cross.b);
}

std::vector<CsvColumn> make_cross_columns(const records::RandomResponse& response) {
  if (response.crosses.empty()) return {};
  std::vector<CsvColumn> columns{{"random", Eigen::VectorXd::Constant(response.hz.size(), response.set)},
                                 {"frequency_hz", response.hz}};
  for (const auto& cross : response.crosses) {
    const auto name = name_cross(cross);
    columns.push_back({"cross_psd:" + name + ":real", cross.psd.real()});
    columns.push_back({"cross_psd:" + name + ":imag", cross.psd.imag()});
    columns.push_back({"coherence:" + name, cross.coherence});
  }
  return columns;
}

std::vector<CsvColumn> make_correlation_columns(const records::RandomResponse& response) {
  if (response.crosses.empty() || response.lags.size() == 0) return {};
  std::vector<CsvColumn> columns{{"random", Eigen::VectorXd::Constant(response.lags.size(), response.set)},
                                 {"lag", response.lags}};
  for (const auto& cross : response.crosses)
    columns.push_back({"cross_correlation:" + name_cross(cross), cross.correlation});
  return columns;
}

}  // namespace bough::exports
