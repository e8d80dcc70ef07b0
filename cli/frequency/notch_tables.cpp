#include "cli/frequency/notch_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/common/console.hpp"
#include "cli/common/deck_tables.hpp"
#include "formats/export/csv.hpp"

namespace bough::cli {
namespace {

using Eigen::Index;

double calc_decibel(double factor) { return 20 * std::log10(factor); }

}  // namespace

std::string format_notch(const analysis::Notch& notch) {
  Table table{{"from Hz", "to Hz", "deepest factor", "dB", "at Hz", "by"}, {}};
  for (Index first = 0, last = 0; first < notch.factor.size(); first = last) {
    last = first + 1;
    if (!(notch.factor[first] < 1)) continue;
    Index deepest = first;
    for (; last < notch.factor.size() && notch.factor[last] < 1; ++last)
      if (notch.factor[last] < notch.factor[deepest]) deepest = last;
    const double factor = notch.factor[deepest];
    table.rows.push_back({fmt::format("{:.6g}", notch.hz[first]), fmt::format("{:.6g}", notch.hz[last - 1]),
                          fmt::format("{:.5g}", factor), fmt::format("{:.2f}", calc_decibel(factor)),
                          fmt::format("{:.6g}", notch.hz[deepest]), notch.by[static_cast<std::size_t>(deepest)]});
  }
  return fmt::format("notches of the input of subcase {}\n", notch.subcase) +
         (table.rows.empty() ? "none: the full input stays below the limits\n" : table.to_text());
}

nlohmann::json to_json(const analysis::Notch& notch) {
  return {{"subcase", notch.subcase},
          {"frequency_hz", to_json_list(notch.hz)},
          {"factor", to_json_list(notch.factor)},
          {"by", notch.by}};
}

std::string make_notch_csv(const std::vector<analysis::Notch>& notches) {
  Index size = 0;
  for (const auto& notch : notches) size += notch.hz.size();
  Eigen::VectorXd subcase(size), hz(size), factor(size);
  Index first = 0;
  for (const auto& notch : notches) {
    subcase.segment(first, notch.hz.size()).setConstant(notch.subcase);
    hz.segment(first, notch.hz.size()) = notch.hz;
    factor.segment(first, notch.hz.size()) = notch.factor;
    first += notch.hz.size();
  }
  std::ostringstream text;
  exports::write_csv(
      text, {{"subcase", subcase}, {"frequency_hz", hz}, {"factor", factor}, {"decibel", factor.unaryExpr([](double x) {
                                                                                return calc_decibel(x);
                                                                              })}});
  return text.str();
}

}  // namespace bough::cli
