#pragma once
/// \file A campaign made ready: its cases, the files each of them gets, and its commands.
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "analysis/campaign/batch_cases.hpp"
#include "formats/nastran/field_editor.hpp"

namespace bough::analysis {

class BatchPlan {
 public:
  /// Reads the campaign and every file it changes, and looks every field and key up. Throws InputError with all errors,
  /// at the campaign's lines: batch.unknown-card, batch.unknown-field, batch.ambiguous-card, batch.replicated-card,
  /// batch.unknown-key, batch.bad-value, batch.bad-step, batch.no-file, batch.too-many-cases, and, unless
  /// the steps `may_leave` the folder of their case, cli.output-outside.
  BatchPlan(const std::string& campaign_file, const std::vector<std::string>& verbs, bool may_leave = false);

  /// The campaign file.
  const toml_files::CampaignSpec& get_spec() const { return spec_; }
  /// Every case, numbered from 1.
  const std::vector<BatchCase>& get_cases() const { return cases_; }
  /// Number of cases of all shards.
  int num_cases() const { return static_cast<int>(cases_.size()); }
  /// Name of the folder of a case within that of the campaign.
  std::string get_folder(int number) const { return get_case_folder(number, num_cases()); }
  /// (file, SHA-256) of all that the outcomes depend on, the campaign first.
  const std::vector<std::pair<std::string, std::string>>& get_inputs() const { return inputs_; }

  /// Writes the case's files into its folder, which is there.
  void write_files(const BatchCase& one, const std::filesystem::path& folder) const;
  /// The words of a step, command first.
  std::vector<std::string> make_words(const BatchCase& one, std::size_t step) const;

 private:
  enum class FileKind { Deck, Toml, Other };
  /// A file that cases have in their folders.
  struct Carried {
    std::string local;  ///< path in the case's folder
    FileKind kind = FileKind::Other;
    std::string text;  ///< of a TOML file, its paths resolved
  };

  void carry(const std::string& file, const SourceLocation& at, bool has_cards);
  void carry_all();
  void resolve_paths(const std::string& file, Carried& carried);
  void check_filled_names();
  void find_fields();
  void check_keys(const toml_files::CampaignParameter& p);
  void calc_inputs();

  toml_files::CampaignSpec spec_;
  std::string campaign_folder_;  ///< absolute: a worker goes from folder to folder
  Diagnostics diagnostics_;
  std::vector<BatchCase> cases_;
  std::map<std::string, Carried> carried_;                ///< by absolute path
  std::map<std::string, nastran::DeckEditor> editors_;    ///< likewise
  std::vector<std::vector<nastran::FieldPlace>> places_;  ///< by parameter
  std::vector<std::string> outputs_;                      ///< what steps write, as if in the campaign's folder
  std::vector<std::string> others_;                       ///< further inputs, absolute
  std::vector<std::pair<std::string, std::string>> inputs_;
};

}  // namespace bough::analysis
