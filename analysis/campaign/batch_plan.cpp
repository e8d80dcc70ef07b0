#include "analysis/campaign/batch_plan.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>
#include <sstream>

#include "analysis/campaign/batch_steps.hpp"
#include "analysis/common/body_files.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/text_file.hpp"
#include "base/file_roles.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/toml/key_editor.hpp"
#include "formats/toml/specs.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;
using toml_files::Setting;

namespace {

constexpr std::size_t max_cases = 1'000'000;

std::string read_all(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  note_input(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

bool is_deck_name(const std::string& path) {
  return has_suffix(path, ".bdf") || has_suffix(path, ".dat") || has_suffix(path, ".nas") || has_suffix(path, ".fem");
}

/// The value as a deck holds it.
std::string make_field(const Setting& value) {
  return value.kind == Setting::Kind::Real ? nastran::format_field(value.number) : value.text;
}
/// The value as a TOML file holds it.
std::string make_toml(const Setting& value) {
  return value.kind == Setting::Kind::Word ? toml_files::quote_text(value.text) : value.text;
}

std::string describe(const Diagnostics& diagnostics) {
  for (const auto& item : diagnostics.items())
    if (item.severity == Severity::Error) return item.what + (item.advice.empty() ? "" : "; " + item.advice);
  return {};
}

}  // namespace

BatchPlan::BatchPlan(const std::string& campaign_file, const std::vector<std::string>& verbs, bool may_leave) {
  demand_file(campaign_file);
  campaign_folder_ = fs::absolute(campaign_file).parent_path().string();
  spec_ = toml_files::read_campaign(campaign_file, diagnostics_);
  diagnostics_.throw_if_errors();
  double count = 1;
  for (const auto& p : spec_.parameters)
    count *=
        spec_.method == toml_files::CampaignMethod::Grid ? (p.low ? p.number : static_cast<int>(p.values.size())) : 1;
  if (std::max(count, static_cast<double>(spec_.samples)) > static_cast<double>(max_cases))
    throw InputError("batch.too-many-cases", {campaign_file}, "the campaign has more than a million cases",
                     "use method = \"latin-hypercube\" or fewer values");
  cases_ = make_cases(spec_);
  check_steps(spec_, verbs, diagnostics_);
  if (!may_leave) check_places(spec_, diagnostics_);
  carry_all();
  diagnostics_.throw_if_errors();
  outputs_ = find_outputs(spec_, campaign_folder_);
  check_filled_names();
  for (auto& [file, carried] : carried_)
    if (carried.kind == FileKind::Toml) resolve_paths(file, carried);
  find_fields();
  diagnostics_.throw_if_errors();
  calc_inputs();
}

void BatchPlan::carry(const std::string& file, const SourceLocation& at, bool has_cards) {
  const auto known = carried_.find(file);
  if (known == carried_.end()) {
    if (!fs::is_regular_file(file)) {
      diagnostics_.error("batch.no-file", at, file + " is no file", "paths are relative to the campaign file");
      return;
    }
    Carried carried;
    carried.local = fs::path(file).lexically_relative(campaign_folder_).string();
    if (carried.local.empty() || carried.local.rfind("..", 0) == 0) carried.local = fs::path(file).filename().string();
    for (const auto& [other, of_other] : carried_)
      if (of_other.local == carried.local)
        diagnostics_.error("batch.no-file", at, file + " and " + other + " would both be " + carried.local,
                           "rename one of them");
    if (has_suffix(file, ".toml")) {
      carried.kind = FileKind::Toml;
      carried.text = read_all(file);
    } else if (has_cards || is_deck_name(file)) {
      carried.kind = FileKind::Deck;
      Diagnostics own;
      editors_.emplace(file, nastran::DeckEditor(file, own));
      for (const auto& item : own.items()) diagnostics_.add(item);
    }
    carried_.emplace(file, std::move(carried));
  }
}

void BatchPlan::carry_all() {
  for (const auto& p : spec_.parameters) {
    if (p.file.empty()) continue;
    if (p.key.empty() == has_suffix(p.file, ".toml") && fs::is_regular_file(p.file)) {
      diagnostics_.error("batch.bad-parameter", p.at,
                         p.key.empty() ? "card is for decks, " + p.file + " is a TOML file"
                                       : "key is for TOML files, " + p.file + " is none",
                         p.key.empty() ? "use key = \"body.modes.number\"" : "use card, id and field");
      continue;
    }
    carry(p.file, p.at, !p.card.empty());
  }
  for (const auto& file : spec_.files) carry(file, {spec_.file}, false);
  // The TOML file that a step reads is there too: it may name files that vary.
  for (const auto& step : spec_.steps) {
    for (std::size_t i = 1; i < step.words.size(); ++i) {
      const auto file = make_absolute(campaign_folder_, step.words[i]);
      if (is_input_word(step.words, i) && has_suffix(file, ".toml") && fs::is_regular_file(file))
        carry(file, step.at, false);
    }
  }
}

/// Inputs of steps whose names hold a parameter: each differs from case to case, so that only `files` brings them
/// there.
void BatchPlan::check_filled_names() {
  for (const auto& step : spec_.steps) {
    for (std::size_t i = 1; i < step.words.size(); ++i) {
      if (!is_input_word(step.words, i) || step.words[i].find('{') == std::string::npos) continue;
      std::set<std::string> seen;
      std::string missing, first;
      for (const auto& one : cases_) {
        auto names = outputs_;
        names.push_back(step.words[i]);
        fill_in(names, spec_, one);
        const auto name = names.back(), file = make_absolute(campaign_folder_, name);
        names.pop_back();
        if (!seen.insert(file).second || std::find(names.begin(), names.end(), file) != names.end()) continue;
        if (carried_.count(file) != 0 || !fs::is_regular_file(file)) continue;
        if (first.empty()) first = name;
        missing += (missing.empty() ? "\"" : ", \"") + name + "\"";
      }
      if (!missing.empty())
        diagnostics_.error(
            "batch.no-file", step.at,
            "'" + step.words.front() + " " + step.words[i] + "' reads " + first + ", which no case has in its folder",
            "add files = [" + missing + "] to [campaign]");
    }
  }
}

/// Files that a TOML file names: one of the case's own stays relative, any other is named where it lies.
void BatchPlan::resolve_paths(const std::string& file, Carried& carried) {
  const auto local_folder = fs::path(carried.local).parent_path();
  toml_files::change_file_keys(carried.text, [&](const std::string& path) -> std::string {
    const auto alone = get_body_path(path), of_body = path.substr(alone.size());  // "panels.FLX" ":2"
    const auto target = make_absolute(fs::path(file).parent_path().string(), alone);
    if (const auto own = carried_.find(target); own != carried_.end())
      return fs::path(own->second.local).lexically_relative(local_folder.empty() ? "." : local_folder).string() +
             of_body;
    if (std::find(outputs_.begin(), outputs_.end(), target) != outputs_.end() || !fs::is_regular_file(target))
      return path;
    others_.push_back(target);
    return target + of_body;
  });
}

void BatchPlan::find_fields() {
  for (const auto& p : spec_.parameters) {
    places_.emplace_back();
    if (!p.key.empty()) check_keys(p);
    if (p.card.empty()) continue;
    const auto editor = editors_.find(p.file);
    if (editor == editors_.end()) continue;
    for (const auto& id : p.ids)
      if (const auto place =
              editor->second.find({p.card, id, p.occurrence, p.field, p.field_number}, p.at, diagnostics_))
        places_.back().push_back(*place);
    // Two parameters on one field: the second would silently override the first.
    for (std::size_t other = 0; other + 1 < places_.size(); ++other)
      for (const auto& a : places_[other])
        for (const auto& b : places_.back())
          if (spec_.parameters[other].file == p.file && a.card == b.card && a.field == b.field)
            diagnostics_.error(
                "batch.bad-parameter", p.at,
                "parameter '" + p.name + "' changes the same field as '" + spec_.parameters[other].name + "'",
                "remove one of them");
  }
}

/// Sets the key to each of its values (a range: to its ends) and asks the schema.
void BatchPlan::check_keys(const toml_files::CampaignParameter& p) {
  const auto& original = carried_.at(p.file).text;
  Diagnostics before;
  toml_files::check_text(original, p.file, before);
  auto values = p.values;
  if (p.low)
    for (const double end : {*p.low, *p.high}) values.push_back(toml_files::make_setting(end, p.is_integer));
  for (const auto& value : values) {
    auto text = original;
    if (const auto wrong = toml_files::set_key(text, p.key, make_toml(value)); !wrong.empty()) {
      diagnostics_.error("batch.unknown-key", p.at, "key " + p.key + " of " + p.file + ": " + wrong,
                         "write a path such as body.modes.number or hinge.spin.damping");
      return;
    }
    Diagnostics after;
    toml_files::check_text(text, p.file, after);
    if (after.num_errors() <= before.num_errors()) continue;
    const bool is_unknown = after.has("toml.unknown-key") || after.has("toml.unknown-table");
    diagnostics_.error(is_unknown ? "batch.unknown-key" : "batch.bad-value", p.at,
                       "key " + p.key + " = " + make_toml(value) + ": " + describe(after));
    return;
  }
}

void BatchPlan::calc_inputs() {
  std::vector<std::string> files{fs::absolute(spec_.file).lexically_normal().string()};
  if (!spec_.table.empty()) files.push_back(spec_.table);
  for (const auto& [file, carried] : carried_) files.push_back(file);
  for (const auto& step : spec_.steps) {
    for (std::size_t i = 1; i < step.words.size(); ++i) {
      const auto input = make_absolute(campaign_folder_, step.words[i]);
      const bool is_made = std::find(outputs_.begin(), outputs_.end(), input) != outputs_.end();
      if (is_input_word(step.words, i) && !is_made && fs::is_regular_file(input)) files.push_back(input);
    }
  }
  files.insert(files.end(), others_.begin(), others_.end());
  for (std::size_t i = 1; i < files.size(); ++i) {
    const auto file = files[i];
    const auto editor = editors_.find(file);
    if (editor == editors_.end() && !is_deck_name(file)) continue;
    Diagnostics ignored;
    const auto included =
        editor != editors_.end() ? editor->second.get_files() : nastran::DeckEditor(file, ignored).get_files();
    for (std::size_t k = 1; k < included.size(); ++k)
      files.push_back(fs::absolute(included[k]).lexically_normal().string());
  }
  std::sort(files.begin() + 1, files.end());
  files.erase(std::unique(files.begin() + 1, files.end()), files.end());
  for (const auto& file : files)
    if (inputs_.empty() || file != inputs_.front().first) inputs_.emplace_back(file, hdf5::calc_sha256(file));
}

void BatchPlan::write_files(const BatchCase& one, const fs::path& folder) const {
  for (const auto& [file, carried] : carried_) {
    const auto path = folder / carried.local;
    if (path.parent_path() != folder) fs::create_directories(path.parent_path());
    if (carried.kind == FileKind::Other) {
      fs::create_symlink(file, path);
      continue;
    }
    auto text = carried.text;
    std::vector<nastran::FieldEdit> edits;
    for (std::size_t i = 0; i < spec_.parameters.size(); ++i) {
      const auto& p = spec_.parameters[i];
      if (p.file != file) continue;
      for (const auto& place : places_[i]) edits.push_back({place, make_field(one.values[i])});
      if (p.key.empty()) continue;
      if (const auto wrong = toml_files::set_key(text, p.key, make_toml(one.values[i])); !wrong.empty())
        throw InputError("batch.unknown-key", p.at, "key " + p.key + ": " + wrong);
    }
    if (carried.kind == FileKind::Toml) {
      write_text_file(path.string(), text);
    } else {
      for (const auto& part : editors_.at(file).write(path.filename().string(), edits))
        write_text_file((path.parent_path() / part.name).string(), part.text);
    }
  }
}

std::vector<std::string> BatchPlan::make_words(const BatchCase& one, std::size_t step) const {
  auto words = spec_.steps[step].words;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (!is_input_word(spec_.steps[step].words, i)) continue;
    const auto input = make_absolute(campaign_folder_, words[i]);
    const auto own = carried_.find(input);
    if (own != carried_.end())
      words[i] = own->second.local;
    else if (std::find(outputs_.begin(), outputs_.end(), input) == outputs_.end() && fs::is_regular_file(input))
      words[i] = input;
  }
  fill_in(words, spec_, one);
  if (is_collected_as_json(spec_, step) && std::find(words.begin(), words.end(), "--json") == words.end())
    words.emplace_back("--json");
  return words;
}

}  // namespace bough::analysis
