#pragma once
/// \file The cases of a campaign.
#include <vector>

#include "formats/toml/campaign.hpp"

namespace bough::analysis {

struct BatchCase {
  int number = 0;                           ///< from 1
  std::vector<toml_files::Setting> values;  ///< by parameter
};

/// Grid: the last parameter varies fastest. Latin hypercube: of every parameter's `samples` equal parts (of the range,
/// of its logarithm, of the list of values) each is used once, at a random place in it; the order is random too, from
/// `seed` alone (McKay, Beckman, Conover, Technometrics 21, 1979).
std::vector<BatchCase> make_cases(const toml_files::CampaignSpec& spec);

/// "case-0007"; wider where there are more than 9999 cases.
std::string get_case_folder(int number, int num_cases);

}  // namespace bough::analysis
