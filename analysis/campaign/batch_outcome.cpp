#include "analysis/campaign/batch_outcome.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "analysis/common/text_file.hpp"
#include "formats/hdf5/table_file.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;
using nlohmann::json;
using toml_files::CampaignCollect;
using toml_files::CollectTake;

namespace {

constexpr std::size_t max_numbers = 1000;
constexpr const char* kCaseMark = ".bough-case";

InputError fail(const CampaignCollect& rule, const std::string& what, const std::string& advice) {
  return {"batch.collect", rule.at, "collect '" + rule.name + "': " + what, advice};
}

void flatten(const json& value, const CampaignCollect& rule, std::vector<double>& numbers) {
  if (value.is_array()) {
    for (const auto& item : value) flatten(item, rule, numbers);
  } else if (value.is_number()) {
    numbers.push_back(value.get<double>());
  } else if (value.is_boolean()) {
    numbers.push_back(value.get<bool>() ? 1 : 0);
  } else if (value.is_null()) {
    numbers.push_back(std::numeric_limits<double>::quiet_NaN());
  } else {
    throw fail(rule, rule.json + " does not hold numbers", "name a number or a list of numbers");
  }
}

/// Keys below the longest part of the path that exists.
std::string list_below(const json& printed, json::json_pointer place) {
  while (!place.empty() && !printed.contains(place)) place.pop_back();
  const json& found = printed[place];
  std::string keys;
  if (found.is_array())
    return place.to_string() + "/0 to " + place.to_string() + "/" + std::to_string(found.size() - 1);
  if (!found.is_object()) return place.to_string();
  for (const auto& item : found.items()) keys += (keys.empty() ? "" : ", ") + (place / item.key()).to_string();
  return keys;
}

Eigen::MatrixXd read_printed(const CampaignCollect& rule, const fs::path& folder) {
  const auto path = folder / ("step-" + std::to_string(rule.step) + ".out");
  std::ifstream in(path);
  const auto printed = json::parse(in, nullptr, false);
  if (printed.is_discarded())
    throw fail(rule, path.filename().string() + " is no JSON", "choose a step that has --json");
  const json::json_pointer place(rule.json);
  if (!printed.contains(place)) {
    const std::string keys = list_below(printed, place);
    throw fail(rule, "the step prints no " + rule.json, keys.empty() ? "" : "it prints " + keys);
  }
  const auto& found = printed[place];
  std::vector<double> numbers;
  flatten(found, rule, numbers);
  const bool is_table = found.is_array() && !found.empty() && found[0].is_array() && !found[0].empty();
  const auto cols = is_table ? static_cast<Eigen::Index>(found[0].size()) : 1;
  const auto size = static_cast<Eigen::Index>(numbers.size());
  if (size % cols != 0) throw fail(rule, rule.json + " has rows of different lengths", "choose one of them");
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(numbers.data(), size / cols, cols);
}

std::string format_number(double x) {
  return std::isfinite(x) ? toml_files::make_setting(x, x == std::floor(x) && std::abs(x) < 1e15).text : "";
}

/// Returns true if a spreadsheet would read the text as a formula.
bool is_formula(const std::string& text) {
  if (text.empty() || std::string_view("=+-@\t\r").find(text[0]) == std::string_view::npos) return false;
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return *end != '\0';
}

/// A cell of a CSV file; what a spreadsheet would compute gets the apostrophe by which they mark text.
std::string quote_cell(const std::string& cell) {
  const std::string text = is_formula(cell) ? "'" + cell : cell;
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

hdf5::OutcomeColumn make_parameter(const BatchPlan& plan, std::size_t index,
                                   const std::vector<BatchOutcome>& outcomes) {
  hdf5::OutcomeColumn column{"/parameters/" + plan.get_spec().parameters[index].name, "value of the parameter", {}, {}};
  column.numbers.resize(static_cast<Eigen::Index>(outcomes.size()), 1);
  bool is_text = false;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const auto& value = plan.get_cases()[static_cast<std::size_t>(outcomes[i].number - 1)].values[index];
    is_text = is_text || value.kind == toml_files::Setting::Kind::Word;
    column.numbers(static_cast<Eigen::Index>(i), 0) = value.number;
    column.words.push_back(value.text);
  }
  if (!is_text) column.words.clear();
  return column;
}

hdf5::OutcomeColumn make_output(const std::string& name, std::size_t index, const std::vector<BatchOutcome>& outcomes) {
  std::size_t width = 1;
  for (const auto& outcome : outcomes)
    if (index < outcome.outputs.size()) width = std::max(width, outcome.outputs[index].size());
  hdf5::OutcomeColumn column{"/outputs/" + name, "collected from each case; NaN where it has none", {}, {}};
  column.numbers.setConstant(static_cast<Eigen::Index>(outcomes.size()), static_cast<Eigen::Index>(width),
                             std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    for (std::size_t k = 0; index < outcomes[i].outputs.size() && k < outcomes[i].outputs[index].size(); ++k)
      column.numbers(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = outcomes[i].outputs[index][k];
  return column;
}

std::string make_csv(const hdf5::OutcomeTable& table) {
  std::string text = "case";
  for (const auto& column : table.columns) {
    const auto name = quote_cell(column.path.substr(column.path.rfind('/') + 1));
    if (column.numbers.cols() <= 1) text += "," + name;
    for (Eigen::Index k = 0; column.numbers.cols() > 1 && k < column.numbers.cols(); ++k)
      text += "," + name + "." + std::to_string(k + 1);
  }
  text += "\n";
  for (std::size_t i = 0; i < table.cases.size(); ++i) {
    text += std::to_string(table.cases[i]);
    for (const auto& column : table.columns) {
      if (!column.words.empty()) {
        text += "," + quote_cell(column.words[i]);
        continue;
      }
      for (const double x : column.numbers.row(static_cast<Eigen::Index>(i))) text += "," + format_number(x);
    }
    text += "\n";
  }
  return text;
}

std::string make_percentile_csv(const std::vector<Statistics>& statistics, double confidence) {
  std::string text = "output,count,percent,value,confidence,lower,upper\n";
  for (const auto& s : statistics)
    for (const auto& one : s.percentiles) {
      text += quote_cell(s.name) + "," + std::to_string(s.count) + "," + format_number(one.percent) + "," +
              format_number(one.value) + "," + format_number(confidence);
      for (const double x : {one.lower, one.upper}) text += "," + (std::isfinite(x) ? format_number(x) : "");
      text += "\n";
    }
  return text;
}

std::string make_csv(const std::vector<Statistics>& statistics) {
  std::string text = "output,count,mean,deviation,min,p5,median,p95,max\n";
  for (const auto& s : statistics) {
    text += quote_cell(s.name) + "," + std::to_string(s.count);
    for (const double x : {s.mean, s.deviation, s.min, s.p5, s.median, s.p95, s.max}) text += "," + format_number(x);
    text += "\n";
  }
  return text;
}

}  // namespace

std::string to_text(const BatchOutcome& outcome) {
  return json{{"case", outcome.number}, {"exit_code", outcome.exit_code}, {"seconds", outcome.seconds},
              {"error", outcome.error}, {"memory_kb", outcome.memory_kb}, {"outputs", outcome.outputs}}
             .dump(-1, ' ', false, json::error_handler_t::replace) +
         "\n";
}

std::optional<BatchOutcome> parse_outcome(const std::string& text) {
  const auto parsed = json::parse(text, nullptr, false);
  if (!parsed.is_object()) return std::nullopt;
  try {
    BatchOutcome outcome;
    outcome.number = parsed.at("case");
    outcome.exit_code = parsed.at("exit_code");
    outcome.seconds = parsed.at("seconds");
    outcome.error = parsed.at("error");
    outcome.memory_kb = parsed.at("memory_kb");
    for (const auto& output : parsed.at("outputs")) {
      outcome.outputs.emplace_back();
      for (const auto& x : output)
        outcome.outputs.back().push_back(x.is_number() ? x.get<double>() : std::numeric_limits<double>::quiet_NaN());
    }
    return outcome;
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

std::optional<BatchOutcome> read_outcome(const fs::path& case_folder) {
  std::ifstream in(case_folder / "outcome.json");
  if (!in) return std::nullopt;
  std::ostringstream text;
  text << in.rdbuf();
  return parse_outcome(text.str());
}

bool is_case_folder(const fs::path& folder) {
  std::error_code failed;
  const auto kind = fs::symlink_status(folder, failed).type();
  if (kind == fs::file_type::not_found) return true;
  return kind == fs::file_type::directory &&
         (fs::is_empty(folder, failed) || fs::exists(folder / kCaseMark, failed) || read_outcome(folder).has_value());
}

void clear_case_folder(const fs::path& folder) {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed))
    if (entry.path().filename() != kCaseMark) fs::remove_all(entry.path());
}

void make_case_folder(const fs::path& folder) {
  if (!is_case_folder(folder))
    throw InputError("batch.foreign-folder", {folder.string()}, "is there already, and not the work of a campaign",
                     "choose another folder with -o, or move it away");
  fs::create_directories(folder);
  std::ofstream(folder / kCaseMark) << "bough batch may clear this folder\n";
}

void write_outcome(const BatchOutcome& outcome, const fs::path& case_folder) {
  make_case_folder(case_folder);
  write_text_file((case_folder / "outcome.json").string(), to_text(outcome));
}

std::vector<double> collect(const CampaignCollect& rule, const fs::path& case_folder) {
  Eigen::MatrixXd table;
  if (!rule.json.empty()) {
    table = read_printed(rule, case_folder);
  } else {
    try {
      table = hdf5::read_numbers((case_folder / rule.file).string(), rule.dataset);
    } catch (const InputError& error) {
      throw fail(rule, rule.file + ": " + error.items().front().what, error.items().front().advice);
    }
  }
  if (rule.column > table.cols())
    throw fail(rule, "there is no column " + std::to_string(rule.column), "it has " + std::to_string(table.cols()));
  if (rule.column > 0) table = table.col(rule.column - 1).eval();
  if (rule.take != CollectTake::All && table.size() == 0) throw fail(rule, "there are no numbers", "take all of them");
  // Several columns give one number each.
  std::vector<double> numbers;
  const auto take_each = [&](auto&& of) {
    for (Eigen::Index k = 0; k < table.cols(); ++k) numbers.push_back(of(table.col(k)));
  };
  switch (rule.take) {
    case CollectTake::All:
      for (Eigen::Index i = 0; i < table.rows(); ++i)
        for (const double x : table.row(i)) numbers.push_back(x);
      break;
    case CollectTake::First:
      take_each([](const auto& x) { return x[0]; });
      break;
    case CollectTake::Last:
      take_each([](const auto& x) { return x[x.size() - 1]; });
      break;
    case CollectTake::Min:
      take_each([](const auto& x) { return x.minCoeff(); });
      break;
    case CollectTake::Max:
      take_each([](const auto& x) { return x.maxCoeff(); });
      break;
    case CollectTake::AbsMax:
      take_each([](const auto& x) { return x.cwiseAbs().maxCoeff(); });
      break;
    case CollectTake::Mean:
      take_each([](const auto& x) { return x.mean(); });
      break;
  }
  if (numbers.size() > max_numbers)
    throw fail(rule, "there are " + std::to_string(numbers.size()) + " numbers, at most 1000 make columns",
               "choose a column, or take = \"max\"");
  return numbers;
}

std::vector<Statistics> write_tables(const BatchPlan& plan, const std::vector<BatchOutcome>& outcomes,
                                     const std::string& fingerprint, const fs::path& folder) {
  const auto& spec = plan.get_spec();
  hdf5::OutcomeTable table{spec.name, fingerprint, {}, {}};
  for (const auto& outcome : outcomes) table.cases.push_back(outcome.number);
  for (std::size_t i = 0; i < spec.parameters.size(); ++i) table.columns.push_back(make_parameter(plan, i, outcomes));
  const auto n = static_cast<Eigen::Index>(outcomes.size());
  hdf5::OutcomeColumn code{"/exit_code", "exit code; 0: success", Eigen::MatrixXd(n, 1), {}};
  hdf5::OutcomeColumn seconds{"/seconds", "wall time of the case in seconds", Eigen::MatrixXd(n, 1), {}};
  hdf5::OutcomeColumn error{"/error", "first error; empty: none", {}, {}};
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& outcome = outcomes[static_cast<std::size_t>(i)];
    code.numbers(i, 0) = outcome.exit_code;
    seconds.numbers(i, 0) = outcome.seconds;
    error.words.push_back(outcome.error);
  }
  table.columns.push_back(code);
  table.columns.push_back(seconds);
  for (std::size_t i = 0; i < spec.collect.size(); ++i)
    table.columns.push_back(make_output(spec.collect[i].name, i, outcomes));
  table.columns.push_back(error);
  write_text_file((folder / "outcomes.csv").string(), make_csv(table));
  hdf5::write_outcomes(table, (folder / "outcomes.h5").string());
  auto statistics = calc_statistics(table, spec.percentiles, spec.confidence);
  if (!spec.percentiles.empty() && !spec.collect.empty())
    write_text_file((folder / "percentiles.csv").string(), make_percentile_csv(statistics, spec.confidence));
  if (!spec.collect.empty()) write_text_file((folder / "statistics.csv").string(), make_csv(statistics));
  return statistics;
}

}  // namespace bough::analysis
