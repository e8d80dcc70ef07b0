#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "base/file_roles.hpp"
#include "formats/toml/campaign.hpp"
#include "formats/toml/detail/campaign_words.hpp"
#include "formats/toml/detail/fields.hpp"
#include "formats/toml/detail/schema.hpp"

namespace bough::toml_files {

namespace {

using Kind = Setting::Kind;

Setting read_value(const Value& v) {
  if (v.kind == Value::Kind::Integer) return make_setting(static_cast<double>(v.integer), true);
  if (v.kind == Value::Kind::Float) return make_setting(v.number, false);
  if (v.kind == Value::Kind::Boolean) return {Kind::Boolean, v.boolean ? "true" : "false", v.boolean ? 1.0 : 0.0};
  return {Kind::Word, v.text, 0};
}

class Reader {
 public:
  Reader(CampaignSpec& spec, Diagnostics& diagnostics) : spec_(spec), diagnostics_(diagnostics) {}

  void read(const Fields& root) {
    const Fields campaign = root.get_table("campaign");
    spec_.name = campaign.get_string("name", get_stem(spec_.file));
    const auto method = campaign.get_string("method", "grid");
    spec_.method = method == "list"              ? CampaignMethod::List
                   : method == "latin-hypercube" ? CampaignMethod::LatinHypercube
                   : method == "monte-carlo"     ? CampaignMethod::MonteCarlo
                                                 : CampaignMethod::Grid;
    spec_.samples = campaign.get_int("samples", 0);
    spec_.seed = static_cast<unsigned long>(campaign.get_int("seed", 1));
    spec_.time_limit = campaign.get_number("time_limit", 0);
    for (const auto& file : campaign.get_strings("files")) spec_.files.push_back(resolve_path(spec_.file, file));
    read_steps(campaign);
    for (const Fields& table : root.get_tables("parameter")) read_parameter(table);
    for (const Fields& table : root.get_tables("collect")) read_collect(table);
    spec_.percentiles = campaign.get_numbers("percentiles");
    spec_.confidence = campaign.get_number("confidence", spec_.confidence);
    for (const double percent : spec_.percentiles)
      if (!(percent < 100)) wrong(campaign.locate("percentiles"), "a percentile is 100 or above", "give it below 100");
    if (!(spec_.confidence < 100))
      wrong(campaign.locate("confidence"), "the confidence is 100 % or above", "give it below 100");
    if (spec_.percentiles.empty() && campaign.has("confidence"))
      wrong(campaign.locate("confidence"), "confidence is given without percentiles", "add percentiles = [50, 95]");
    if (campaign.has("table")) {
      spec_.table = resolve_path(spec_.file, campaign.get_string("table"));
      if (spec_.method != CampaignMethod::List)
        wrong(campaign.locate("table"), "table stands with method = \"" + method + "\"", "set method = \"list\"");
      else
        read_table(campaign.locate("table"));
    }
    if (is_random() && spec_.samples == 0)
      wrong(campaign.locate(), method + " needs samples", "add samples = 100 to [campaign]");
    if (!is_random() && campaign.has("samples"))
      wrong(campaign.locate("samples"), "samples stands with method = \"" + method + "\"",
            "set method = \"latin-hypercube\" or \"monte-carlo\", or remove it");
    for (const Fields& table : root.get_tables("correlation")) read_correlation(table);
    if (spec_.parameters.empty())
      wrong(campaign.locate(), "there is no parameter", "add [[parameter]] tables, or a table with method = \"list\"");
    check_values();
    check_names();
  }

 private:
  bool is_random() const {
    return spec_.method == CampaignMethod::LatinHypercube || spec_.method == CampaignMethod::MonteCarlo;
  }

  std::string get_method() const {
    return spec_.method == CampaignMethod::MonteCarlo ? "monte-carlo" : is_random() ? "latin-hypercube" : "list";
  }

  void wrong(const SourceLocation& at, const std::string& what, const std::string& advice) {
    diagnostics_.error("batch.bad-parameter", at, what, advice);
  }

  void read_steps(const Fields& campaign) {
    const Value* steps = campaign.find("steps");
    if (!steps || !steps->is_array()) return;
    for (const Value& item : steps->items) {
      if (!item.is_string()) continue;
      CampaignStep step{split_words(item.text), {spec_.file, item.line}};
      if (!step.words.empty() && step.words[0] == "bough") step.words.erase(step.words.begin());
      if (step.words.empty())
        diagnostics_.error("batch.bad-step", step.at, "the step is empty", "write a command and its arguments");
      else
        spec_.steps.push_back(std::move(step));
    }
  }

  void read_parameter(const Fields& table) {
    CampaignParameter p;
    p.at = table.locate();
    p.name = table.get_string("name");
    if (table.has("file")) p.file = resolve_path(spec_.file, table.get_string("file"));
    p.card = table.get_string("card");
    p.occurrence = table.get_int("occurrence", 0);
    if (const Value* id = table.find("id")) {
      for (const Value& v : id->is_array() ? id->items : std::vector<Value>{*id}) p.ids.push_back(read_value(v).text);
    }
    if (p.ids.empty()) p.ids.emplace_back();
    p.field = table.get_string("field");
    p.field_number = table.get_int("field", 0);
    p.key = table.get_string("key");
    if (const Value* values = table.find("values"))
      for (const Value& v : values->items) p.values.push_back(read_value(v));
    if (const auto range = table.get_numbers("range"); range.size() == 2) {
      p.low = range[0];
      p.high = range[1];
    }
    p.number = table.get_int("number", 0);
    p.is_integer = table.get_bool("integer", false);
    p.is_log = table.get_string("spacing") == "log";
    const std::string who = "parameter '" + p.name + "'";
    const bool is_deck = !p.card.empty(), is_toml = !p.key.empty();
    if (is_deck && is_toml) wrong(table.locate("key"), who + " has both card and key", "keep one of them");
    if ((is_deck || is_toml) && p.file.empty())
      wrong(p.at, who + " has no file", "add file = \"the deck, body file or system file that it changes\"");
    if (!p.file.empty() && !is_deck && !is_toml)
      wrong(table.locate("file"), who + " says neither card nor key",
            "add card, id and field of a deck, or key of a TOML file");
    if (is_deck && !table.has("field")) wrong(p.at, who + " has no field", "add field = \"E\" or field = 3");
    if (!is_deck)
      for (const char* key : {"id", "occurrence", "field"})
        if (table.has(key)) wrong(table.locate(key), who + " has " + key + " without card", "add card or remove it");
    if (table.has("number") && (!p.low || spec_.method != CampaignMethod::Grid))
      wrong(table.locate("number"),
            who + " has number " + (p.low ? "with method = \"" + get_method() + "\"" : "without range"),
            p.low && is_random() ? "remove it; samples of [campaign] is the number of cases"
                                 : "remove it; number divides the range of a grid");
    if (table.has("spacing") && !p.low && !table.has("mean"))
      wrong(table.locate("spacing"), who + " has spacing without range", "add range = [low, high], or remove it");
    if (p.low && *p.low > *p.high) wrong(table.locate("range"), who + " has a range from high to low", "swap the two");
    if (p.low && p.is_log && *p.low <= 0)
      wrong(table.locate("range"), who + " has logarithmic spacing down to zero or less", "give positive ends");
    if (p.low && p.is_integer && std::floor(*p.high) < std::ceil(*p.low))
      wrong(table.locate("range"), who + " has a range without a whole number", "widen it");
    read_distribution(table, p);
    spec_.parameters.push_back(std::move(p));
  }

  void read_distribution(const Fields& table, CampaignParameter& p) {
    const std::string who = "parameter '" + p.name + "'";
    for (const char* key : {"mean", "deviation", "probabilities"})
      if (table.has(key) && !is_random())
        wrong(table.locate(key), who + " has " + key + ", and the cases are not random",
              "set method = \"monte-carlo\" or \"latin-hypercube\"");
    if (table.has("mean") != table.has("deviation"))
      wrong(p.at, who + " has mean without deviation, or deviation without mean", "give both");
    if (table.has("mean")) {
      p.mean = table.get_number("mean", 0);
      p.deviation = table.get_number("deviation", 1);
      if (!p.values.empty()) wrong(table.locate("mean"), who + " has values and mean", "keep one of them");
      if (p.is_log) wrong(table.locate("spacing"), who + " has spacing and mean", "remove spacing");
      constexpr double kMaxDeviations = 37;  // the probability beyond is below 1e-300
      if (p.low && std::max(*p.low - *p.mean, *p.mean - *p.high) > kMaxDeviations * p.deviation)
        wrong(table.locate("range"), who + " has a range more than 37 deviations from its mean",
              "bring the range nearer to the mean");
    }
    p.probabilities = table.get_numbers("probabilities");
    if (!table.has("probabilities")) return;
    double sum = 0;
    for (const double share : p.probabilities) sum += share;
    if (p.probabilities.size() != p.values.size() || !(sum > 0))
      wrong(table.locate("probabilities"),
            who + " has " + std::to_string(p.values.size()) + " values and " + std::to_string(p.probabilities.size()) +
                " probabilities of the sum " + std::to_string(sum),
            "give one number for each value, not all zero");
  }

  void read_correlation(const Fields& table) {
    CampaignCorrelation one;
    one.at = table.locate();
    one.value = table.get_number("value", 0);
    if (!is_random())
      wrong(one.at, "a correlation is given, and the cases are not random",
            "set method = \"monte-carlo\" or \"latin-hypercube\"");
    if (!(std::abs(one.value) < 1))
      wrong(table.locate("value"), "a correlation is " + std::to_string(one.value), "give it between -1 and 1");
    const auto names = table.get_strings("parameters");
    std::vector<std::size_t> found;
    for (const auto& name : names) {
      for (std::size_t i = 0; i < spec_.parameters.size(); ++i)
        if (spec_.parameters[i].name == name) found.push_back(i);
      if (found.empty() || spec_.parameters[found.back()].name != name)
        wrong(table.locate("parameters"), "a correlation names the unknown parameter '" + name + "'",
              "name two [[parameter]]");
    }
    if (found.size() != 2) return;
    one.a = found[0];
    one.b = found[1];
    const auto is_pair = [&](const CampaignCorrelation& other) {
      return std::minmax(other.a, other.b) == std::minmax(one.a, one.b);
    };
    if (one.a == one.b || std::any_of(spec_.correlations.begin(), spec_.correlations.end(), is_pair))
      wrong(one.at, "the pair '" + names[0] + "', '" + names[1] + "' is one parameter or was given before",
            "give each pair once");
    spec_.correlations.push_back(one);
  }

  void read_collect(const Fields& table) {
    static const std::map<std::string, CollectTake> takes{{"first", CollectTake::First},   {"last", CollectTake::Last},
                                                          {"min", CollectTake::Min},       {"max", CollectTake::Max},
                                                          {"absmax", CollectTake::AbsMax}, {"mean", CollectTake::Mean}};
    CampaignCollect c;
    c.at = table.locate();
    c.name = table.get_string("name");
    c.step = table.get_int("step", 0);
    c.json = table.get_string("json");
    c.file = table.get_string("file");
    c.dataset = table.get_string("dataset");
    c.column = table.get_int("column", 0);
    const auto take = takes.find(table.get_string("take", "all"));
    if (take != takes.end()) c.take = take->second;
    const std::string who = "collect '" + c.name + "'";
    if (!c.dataset.empty() && c.file.empty()) wrong(c.at, who + " names no file", "add file = \"boom.h5\"");
    if (!c.json.empty() && c.json[0] != '/')
      wrong(table.locate("json"), who + " has json = \"" + c.json + "\", expected a path such as /frequency_hz/0",
            "begin it with a slash");
    if (c.step > static_cast<int>(spec_.steps.size()))
      wrong(table.locate("step"),
            who + " names step " + std::to_string(c.step) + " of " + std::to_string(spec_.steps.size()),
            "count from 1");
    if (c.step == 0) c.step = static_cast<int>(spec_.steps.size());
    spec_.collect.push_back(std::move(c));
  }

  void read_table(const SourceLocation& asked_at) {
    const auto bad = [&](int line, const std::string& what, const std::string& advice) {
      diagnostics_.error("batch.bad-table", line > 0 ? SourceLocation{spec_.table, line} : asked_at, what, advice);
    };
    std::error_code failed;
    std::ifstream in;
    if (std::filesystem::is_regular_file(spec_.table, failed)) in.open(spec_.table);
    if (!in.is_open())
      return bad(0, "the table " + spec_.table + " cannot be opened", "check its path, relative to this file");
    note_input(spec_.table);
    std::vector<std::size_t> columns;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      if (trim(line).empty() || trim(line)[0] == '#') continue;
      const auto cells = split_cells(line);
      if (columns.empty()) {
        for (const auto& name : cells) columns.push_back(find_parameter(name, number));
        continue;
      }
      if (cells.size() != columns.size()) {
        bad(number,
            "the line has " + std::to_string(cells.size()) + " cells, the heading " + std::to_string(columns.size()),
            "give one for each");
        continue;
      }
      for (std::size_t i = 0; i < cells.size(); ++i) {
        if (cells[i].empty()) bad(number, "cell " + std::to_string(i + 1) + " is empty", "give a value");
        spec_.parameters[columns[i]].values.push_back(read_cell(cells[i]));
      }
    }
    if (columns.empty() || spec_.parameters[columns[0]].values.empty())
      bad(0, "the table " + spec_.table + " has no cases", "give a heading and a line for each case");
  }

  /// A column without a [[parameter]] is one for the commands.
  std::size_t find_parameter(const std::string& name, int line) {
    for (std::size_t i = 0; i < spec_.parameters.size(); ++i) {
      if (spec_.parameters[i].name != name) continue;
      if (!spec_.parameters[i].values.empty() || spec_.parameters[i].low)
        wrong(spec_.parameters[i].at, "parameter '" + name + "' has values here and in the table", "keep one of them");
      return i;
    }
    CampaignParameter p;
    p.name = name;
    p.at = {spec_.table, line};
    p.ids.emplace_back();
    spec_.parameters.push_back(std::move(p));
    return spec_.parameters.size() - 1;
  }

  void check_values() {
    std::size_t length = 0;
    for (const auto& p : spec_.parameters) {
      const std::string who = "parameter '" + p.name + "'";
      if (p.values.empty() && !p.low && !p.mean)
        wrong(p.at, who + " has no values", "add values = [...], or range = [low, high]");
      if (spec_.method == CampaignMethod::Grid && p.low && p.number == 0)
        wrong(p.at, who + " has a range without number", "add number = 5, or values = [...]");
      if (spec_.method != CampaignMethod::List) continue;
      if (p.low) wrong(p.at, who + " has a range, a list needs values", "add values = [...]");
      if (length == 0) length = p.values.size();
      if (p.values.size() != length && !p.values.empty())
        wrong(p.at,
              who + " has " + std::to_string(p.values.size()) + " values, the first one " + std::to_string(length),
              "give every parameter of a list as many");
    }
  }

  void check_names() {
    std::map<std::string, int> lines;
    const auto check = [&](const std::string& name, const SourceLocation& at) {
      const auto [it, is_new] = lines.emplace(name, at.line);
      if (!is_new && !name.empty())
        diagnostics_.error("toml.duplicate-name", at,
                           "'" + name + "' was already given in line " + std::to_string(it->second), "rename one");
    };
    for (const char* own : {"case", "exit_code", "seconds", "error"}) lines.emplace(own, 0);
    for (const auto& p : spec_.parameters) check(p.name, p.at);
    for (const auto& c : spec_.collect) check(c.name, c.at);
  }

  CampaignSpec& spec_;
  Diagnostics& diagnostics_;
};

}  // namespace

CampaignSpec read_campaign(const std::string& path, Diagnostics& diagnostics) {
  CampaignSpec spec;
  spec.file = path;
  std::string text;
  Value root;
  if (!read_text(path, text, diagnostics) || !parse_toml(text, path, root, diagnostics)) return spec;
  check_schema(root, get_campaign_schema(), path, diagnostics);
  if (diagnostics.num_errors() > 0) return spec;
  Reader(spec, diagnostics).read(Fields(root, path));
  return spec;
}

}  // namespace bough::toml_files
