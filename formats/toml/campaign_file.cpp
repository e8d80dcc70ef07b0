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
                                                 : CampaignMethod::Grid;
    spec_.samples = campaign.get_int("samples", 0);
    spec_.seed = static_cast<unsigned long>(campaign.get_int("seed", 1));
    spec_.time_limit = campaign.get_number("time_limit", 0);
    for (const auto& file : campaign.get_strings("files")) spec_.files.push_back(resolve_path(spec_.file, file));
    read_steps(campaign);
    for (const Fields& table : root.get_tables("parameter")) read_parameter(table);
    for (const Fields& table : root.get_tables("collect")) read_collect(table);
    if (campaign.has("table")) {
      spec_.table = resolve_path(spec_.file, campaign.get_string("table"));
      if (spec_.method != CampaignMethod::List)
        wrong(campaign.locate("table"), "table stands with method = \"" + method + "\"", "set method = \"list\"");
      else
        read_table(campaign.locate("table"));
    }
    if (spec_.method == CampaignMethod::LatinHypercube && spec_.samples == 0)
      wrong(campaign.locate(), "latin-hypercube needs samples", "add samples = 100 to [campaign]");
    if (spec_.method != CampaignMethod::LatinHypercube && campaign.has("samples"))
      wrong(campaign.locate("samples"), "samples stands with method = \"" + method + "\"",
            "set method = \"latin-hypercube\", or remove it");
    if (spec_.parameters.empty())
      wrong(campaign.locate(), "there is no parameter", "add [[parameter]] tables, or a table with method = \"list\"");
    check_values();
    check_names();
  }

 private:
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
        diagnostics_.error("batch.bad-step", step.at, "the step is empty", "write a verb and its arguments");
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
    if (p.low && *p.low > *p.high) wrong(table.locate("range"), who + " has a range from high to low", "swap the two");
    if (p.low && p.is_log && *p.low <= 0)
      wrong(table.locate("range"), who + " has logarithmic spacing down to zero or less", "give positive ends");
    if (p.low && p.is_integer && std::floor(*p.high) < std::ceil(*p.low))
      wrong(table.locate("range"), who + " has a range without a whole number", "widen it");
    spec_.parameters.push_back(std::move(p));
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
      if (p.values.empty() && !p.low) wrong(p.at, who + " has no values", "add values = [...], or range = [low, high]");
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
