#include "analysis/edit/edit_text.hpp"

#include <algorithm>
#include <map>

#include "analysis/edit/command_words.hpp"
#include "base/diagnostic.hpp"
#include "formats/toml/key_editor.hpp"

namespace bough::analysis {

using toml_files::KindHelp;
using toml_files::TableItem;

namespace {

[[noreturn]] void throw_name_error(const std::string& what, const std::string& advice) {
  throw InputError("cli.edit-name", {}, what, advice);
}

std::vector<Diagnostic> list_errors(const std::string& text, const std::string& file) {
  Diagnostics diagnostics;
  toml_files::check_text(text, file, diagnostics);
  return diagnostics.items();
}

}  // namespace

EditText::EditText(std::string file, std::string text, bool is_body_file)
    : file_(std::move(file)),
      text_(std::move(text)),
      saved_(text_),
      is_body_file_(is_body_file),
      kinds_(toml_files::describe_kinds(is_body_file)) {}

void EditText::change(const std::string& text, bool allows_missing) {
  if (text == text_) return;
  std::map<std::string, int> known;
  for (const auto& item : list_errors(text_, file_)) ++known[item.id + item.what];
  std::vector<Diagnostic> added;
  for (auto& item : list_errors(text, file_)) {
    const bool is_missing = item.id == "toml.missing-key" || item.id == "toml.missing-table";
    if (--known[item.id + item.what] >= 0 || (allows_missing && is_missing)) continue;
    item.where = {};
    added.push_back(item);
  }
  if (!added.empty()) throw InputError(added);
  before_.push_back(text_);
  after_.clear();
  text_ = text;
}

void EditText::undo() {
  if (before_.empty()) throw InputError("cli.edit-command", {}, "there is no change to take back");
  after_.push_back(text_);
  text_ = before_.back();
  before_.pop_back();
}

void EditText::redo() {
  if (after_.empty()) throw InputError("cli.edit-command", {}, "there is no change to do again");
  before_.push_back(text_);
  text_ = after_.back();
  after_.pop_back();
}

const KindHelp* EditText::find_kind_or_null(const std::string& name) const {
  const auto at = std::find_if(kinds_.begin(), kinds_.end(), [&](const auto& k) { return k.kind == name; });
  return at == kinds_.end() ? nullptr : &*at;
}

const KindHelp& EditText::find_kind(const std::string& name) const {
  // "hinges" is understood as well.
  for (const auto& word : {name, name.ends_with("ies") ? name.substr(0, name.size() - 3) + "y" : name,
                           name.ends_with('s') ? name.substr(0, name.size() - 1) : name})
    if (const auto* kind = find_kind_or_null(word)) return *kind;
  std::vector<std::string> known;
  std::string list;
  for (const auto& kind : kinds_) {
    known.push_back(kind.kind);
    list += (list.empty() ? "" : ", ") + kind.kind;
  }
  const auto nearest = find_nearest(name, known);
  throw_name_error("there is no kind of table '" + name + "'",
                   nearest.empty() ? "the kinds are " + list : "did you mean '" + nearest + "'?");
}

EditTarget EditText::find_target(const std::string& words, bool wants_key) const {
  const auto items = toml_files::list_items(text_);
  struct Candidate {
    EditTarget target;
    std::size_t length;
    bool has_kind;
  };
  std::vector<Candidate> found;
  const auto try_prefix = [&](const TableItem& item, const std::string& prefix, bool has_kind) {
    if (prefix.empty() || !words.starts_with(prefix)) return;
    if (words.size() == prefix.size()) {
      if (!wants_key) found.push_back({{item, {}}, prefix.size(), has_kind});
    } else if (words[prefix.size()] == '.' && (wants_key || item.kind == "parameters")) {
      found.push_back({{item, words.substr(prefix.size() + 1)}, prefix.size(), has_kind});
    }
  };
  std::vector<std::string> names;
  for (const auto& item : items) {
    try_prefix(item, item.path(), true);
    if (item.number == 0) continue;
    for (const auto& name : {item.name, '"' + item.name + '"'}) {
      if (item.name.empty()) continue;
      try_prefix(item, item.kind + "." + name, true);
      try_prefix(item, name, false);
    }
    if (!item.name.empty()) names.push_back(item.name);
  }
  const auto keep = [&](const auto& is_match) {
    if (std::any_of(found.begin(), found.end(), is_match))
      found.erase(std::remove_if(found.begin(), found.end(), [&](const auto& c) { return !is_match(c); }), found.end());
  };
  keep([](const Candidate& c) { return c.has_kind; });
  std::size_t longest = 0;
  for (const auto& c : found) longest = std::max(longest, c.length);
  keep([&](const Candidate& c) { return c.length == longest; });
  if (wants_key && found.size() > 1) {
    keep([&](const Candidate& c) {
      const auto* kind = find_kind_or_null(c.target.item.kind);
      return kind != nullptr && kind->find(c.target.rest.substr(0, c.target.rest.find('.'))) != nullptr;
    });
  }
  if (found.size() == 1) return found.front().target;
  if (found.size() > 1) {
    std::string list;
    for (const auto& c : found) list += (list.empty() ? "" : ", ") + c.target.item.kind + "." + c.target.item.name;
    throw_name_error("'" + words + "' may be one of " + list, "write the kind before it");
  }
  // A table that the file does not have yet.
  const auto first = words.substr(0, words.find('.'));
  const auto* kind = find_kind_or_null(first);
  if (wants_key && kind != nullptr && !kind->is_list && words.size() > first.size()) {
    TableItem item;
    item.kind = first;
    return {item, words.substr(first.size() + 1)};
  }
  if (wants_key && words == "name" && !is_body_file_) return {{}, words};
  const auto nearest = find_nearest(first, names);
  if (wants_key && words.find('.') == std::string::npos)
    throw_name_error("'" + words + "' names no key", "write NAME.key, as boom.damping");
  throw_name_error("there is no '" + words + "'",
                   nearest.empty() ? "'list' shows what there is" : "did you mean '" + nearest + "'?");
}

namespace {

/// [tip:x, "rate"] with quotes around what has none.
std::string quote_entries(const std::string& list) {
  std::string quoted;
  for (std::size_t from = 1; from < list.size();) {
    const std::size_t to = std::min(list.find(',', from), list.size() - 1);
    const auto first = list.find_first_not_of(" \t", from), last = list.find_last_not_of(" \t", to - 1);
    const std::string entry = first < to ? list.substr(first, last - first + 1) : std::string();
    quoted += (quoted.empty() ? "" : ", ") +
              (entry.empty() || toml_files::is_value(entry) ? entry : toml_files::quote_text(entry));
    from = to + 1;
  }
  return "[" + quoted + "]";
}

}  // namespace

std::string EditText::make_value(const KindHelp* kind, const std::string& key, const std::string& text) const {
  if (text.empty()) throw InputError("cli.edit-command", {}, "the value of " + key + " is missing", "write key=value");
  const bool is_value = toml_files::is_value(text);
  const auto* help = kind == nullptr ? nullptr : kind->find(key);
  // Keys of a function depend on its type and are checked by `check`; keys of no function are rejected here. Angles may
  // be in degrees.
  const bool in_degrees =
      kind != nullptr && key.ends_with("_deg") && kind->find(key.substr(0, key.size() - 4)) != nullptr;
  if (help == nullptr && !in_degrees && kind != nullptr && kind->kind == "function")
    throw InputError("toml.unknown-key", {}, "unknown key '" + key + "' in a function",
                     "'help function' lists the keys");
  if (help == nullptr || !help->takes_text) {
    // Parameters stand for numbers.
    if (text[0] == '$') return toml_files::quote_text(text);
    if (is_value) return text;
    if (help != nullptr)
      throw InputError("cli.edit-command", {}, "'" + text + "' is no TOML value", "as " + help->type);
    return toml_files::quote_text(text);
  }
  const bool has_quotes = text[0] == '"' || text[0] == '\'';
  if (is_value && (has_quotes || help->takes_other)) return text;
  if (help->takes_other && text.size() > 1 && text.front() == '[' && text.back() == ']') {
    const std::string list = quote_entries(text);
    if (toml_files::is_value(list)) return list;
  }
  return toml_files::quote_text(text);
}

}  // namespace bough::analysis
