#pragma once
/// \file A campaign: one job over many values of chosen inputs.
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::toml_files {

/// One value of a parameter. `text` is what is written: into a deck field, and into a command.
struct Setting {
  enum class Kind { Integer, Real, Word, Boolean };
  Kind kind = Kind::Word;
  std::string text;
  double number = 0;  ///< Integer, Real, Boolean (0 or 1)
};

/// Name in the table, target (none: only {name} in the commands), and values.
struct CampaignParameter {
  std::string name;
  SourceLocation at;
  std::string file;              ///< deck or TOML file, absolute
  std::string card;              ///< deck: the card ...
  std::vector<std::string> ids;  ///< ... its id, or several that get the same value
  int occurrence = 0;
  std::string field;
  int field_number = 0;
  std::string key;              ///< TOML: dotted path
  std::vector<Setting> values;  ///< given one by one, or
  std::optional<double> low, high;
  int number = 0;  ///< grid over low .. high: how many, both ends among them
  bool is_integer = false, is_log = false;
  std::optional<double> mean;         ///< normal distribution, truncated to low .. high if there are
  double deviation = 0;               ///< of it, before truncation
  std::vector<double> probabilities;  ///< of each value; empty: equal
};

/// Correlation of the normal scores of two parameters, by their numbers from 0.
struct CampaignCorrelation {
  std::size_t a = 0, b = 0;
  double value = 0;
  SourceLocation at;
};

enum class CampaignMethod { Grid, List, LatinHypercube, MonteCarlo };
enum class CollectTake { All, First, Last, Min, Max, AbsMax, Mean };

/// One or several numbers of the results of each case.
struct CampaignCollect {
  std::string name;
  SourceLocation at;
  int step = 0;         ///< with json: the step, from 1; 0 is the last
  std::string json;     ///< JSON pointer into what the step printed
  std::string file;     ///< or a file of the case, relative to its folder
  std::string dataset;  ///< and a path in it
  int column = 0;       ///< of a table of numbers, from 1; 0: all
  CollectTake take = CollectTake::All;
};

struct CampaignStep {
  std::vector<std::string> words;  ///< command and arguments
  SourceLocation at;
};

struct CampaignSpec {
  std::string file, name;
  CampaignMethod method = CampaignMethod::Grid;
  int samples = 0;
  unsigned long seed = 1;
  std::vector<double> percentiles;  ///< [%] of outputs
  double confidence = 90;           ///< [%] of their intervals
  std::vector<CampaignCorrelation> correlations;
  double time_limit = 0;           ///< s of wall time a case; 0: none
  std::string table;               ///< CSV file of a list, absolute
  std::vector<std::string> files;  ///< more files each case has in its folder, absolute
  std::vector<CampaignStep> steps;
  std::vector<CampaignParameter> parameters;
  std::vector<CampaignCollect> collect;
};

/// Adds toml.* for what departs from the schema, batch.bad-step, batch.bad-parameter, batch.bad-table and
/// toml.duplicate-name, each with file and line.
CampaignSpec read_campaign(const std::string& path, Diagnostics& diagnostics);

/// A number as a Setting; a real keeps a point or an exponent.
Setting make_setting(double value, bool is_integer);

}  // namespace bough::toml_files
