#pragma once
/// \file Outcome of one case: outcome.json in the folder of the case, written at its end.
#include <optional>
#include <string>
#include <vector>

#include "analysis/campaign/batch_plan.hpp"
#include "analysis/campaign/batch_statistics.hpp"

namespace bough::analysis {

struct BatchOutcome {
  int number = 0;
  int exit_code = 0;                         ///< of the step that failed; 0 when none did
  double seconds = 0;                        ///< wall time
  std::string error;                         ///< the first one, with its step; empty: the case succeeded
  long memory_kb = 0;                        ///< resident memory of the worker afterwards
  std::vector<std::vector<double>> outputs;  ///< by [[collect]]
};

/// One line of JSON, and back; nothing when it is no outcome.
std::string to_text(const BatchOutcome& outcome);
std::optional<BatchOutcome> parse_outcome(const std::string& text);

/// Returns true if a campaign may clear this folder for a case: it does not exist, is empty, or a campaign made it (it
/// contains a mark or an outcome). Never true for a symbolic link.
bool is_case_folder(const std::filesystem::path& folder);
/// Everything in it goes but the mark, so that a kill in between leaves a folder that is known.
void clear_case_folder(const std::filesystem::path& folder);
/// Makes the folder with its mark. Throws InputError("batch.foreign-folder") when it is there and not a case's.
void make_case_folder(const std::filesystem::path& folder);

/// The outcome kept in this folder; nothing when the case is not over.
std::optional<BatchOutcome> read_outcome(const std::filesystem::path& case_folder);
/// Writes outcome.json into the folder of a case. Throws ComputationError "cli.write".
void write_outcome(const BatchOutcome& outcome, const std::filesystem::path& case_folder);

/// The numbers that a [[collect]] asks for, from the case's folder. Throws InputError "batch.collect".
std::vector<double> collect(const toml_files::CampaignCollect& rule, const std::filesystem::path& case_folder);

/// Writes outcomes.csv and outcomes.h5: a row for each outcome there is; statistics.csv of them, which are returned.
std::vector<Statistics> write_tables(const BatchPlan& plan, const std::vector<BatchOutcome>& outcomes,
                                     const std::string& fingerprint, const std::filesystem::path& folder);

}  // namespace bough::analysis
