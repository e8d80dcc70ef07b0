#pragma once
/// \file The commands of a campaign: what they are called with, read and write.
#include <string>
#include <vector>

#include "analysis/campaign/batch_cases.hpp"
#include "base/diagnostic.hpp"

namespace bough::analysis {

/// Joins `path` to `folder` and normalizes the result lexically; an absolute `path` is only normalized.
std::string make_absolute(const std::string& folder, const std::string& path);

/// A word that may be an input file: no option, and not the value of one.
bool is_input_word(const std::vector<std::string>& words, std::size_t i);

/// Reports "batch.bad-step": no command, or {NAME} that is no parameter.
void check_steps(const toml_files::CampaignSpec& spec, const std::vector<std::string>& verbs, Diagnostics& diagnostics);
/// Warns ("batch.unused-parameter") of parameters on which no case depends: they change no file and no step names them.
/// Columns of the table of a list are left out: they may describe a case.
void warn_of_unused(const toml_files::CampaignSpec& spec, Diagnostics& diagnostics);

/// Reports "cli.output-outside": an output of a step that does not lie in the folder of its case.
void check_places(const toml_files::CampaignSpec& spec, Diagnostics& diagnostics);

/// Files that the steps write, by -o or by default: such a file belongs to the case, even if one of the same name is
/// next to the campaign.
std::vector<std::string> find_outputs(const toml_files::CampaignSpec& spec, const std::string& folder);

/// {NAME} and {case} become the case's values.
void fill_in(std::vector<std::string>& words, const toml_files::CampaignSpec& spec, const BatchCase& one);

/// Returns true if a [[collect]] reads the output of the step (from 0).
bool is_collected_as_json(const toml_files::CampaignSpec& spec, std::size_t step);

}  // namespace bough::analysis
