#pragma once
/// \file The chapters of a comparison, of a campaign's table and of a list of modes that `select` ranked.
#include <string>
#include <utility>
#include <vector>

#include "formats/records/comparison.hpp"
#include "report/page.hpp"

namespace bough::report {

using Facts = std::vector<std::pair<std::string, std::string>>;

/// Chapter of a comparison as `compare -o` writes it.
Chapter make_chapter(const records::Comparison& comparison, const std::string& file, const Facts& facts);

/// A campaign: one row a case.
struct CampaignColumn {
  std::string name;
  std::vector<double> numbers;     ///< NaN where a case has none
  std::vector<std::string> words;  ///< in place of numbers
  bool is_output = false;          ///< collected from the case
};
struct CampaignTable {
  std::string file;
  Facts facts;
  std::vector<CampaignColumn> columns;  ///< "case" first; "exit_code" among them
};
/// Composes the chapter: number of cases with a nonzero exit code, scatter plot, percentiles, table of the first 1000
/// cases.
Chapter make_chapter(const CampaignTable& table);

/// `select --json`.
struct SelectedMode {
  int mode = 0;
  double frequency_hz = 0, cost = 0, share = 0;
  bool kept = true;
  std::string reason;
  std::string body;  ///< empty: of a body without a system
};
/// Composes the table of modes, with the sum of the shares of the modes that are not kept.
Chapter make_chapter(const std::vector<SelectedMode>& modes, double total_cost, const std::string& file);

}  // namespace bough::report
