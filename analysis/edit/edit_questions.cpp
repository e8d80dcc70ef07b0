/// Questions of `add` at a terminal.
#include <algorithm>

#include "analysis/common/system_files.hpp"
#include "analysis/edit/command_words.hpp"
#include "analysis/edit/edit_session.hpp"
#include "base/diagnostic.hpp"
#include "formats/toml/key_editor.hpp"

namespace bough::analysis {

using toml_files::KeyValues;
using toml_files::KindHelp;

void EditSession::ask_for_key(const KindHelp& kind, const toml_files::KeyHelp& key, KeyValues& given) const {
  host_.print(toml_files::format_help(key));
  const auto answer = ask_("  " + key.name + (key.is_required ? "" : " (empty: none)") + " = ");
  if (!answer) throw InputError("cli.edit-command", {}, "add was left", "it changed nothing");
  if (!answer->empty()) given.emplace_back(key.name, text_.make_value(&kind, key.name, *answer));
}

std::vector<Diagnostic> EditSession::list_errors(const std::string& text) const {
  Diagnostics diagnostics;
  try {
    toml_files::check_text(text, text_.get_file(), diagnostics);
    if (diagnostics.num_errors() == 0 && !text_.is_body_file()) {
      LoadOptions options;
      options.text = text;
      load_system(text_.get_file(), diagnostics, options);
    }
  } catch (const Failure& failure) {
    return failure.items();
  }
  return diagnostics.items();
}

KeyValues EditSession::ask_for_missing(const KindHelp& kind, KeyValues given) const {
  const auto find_missing = [&]() -> const toml_files::KeyHelp* {
    auto text = text_.get_text();
    if (!toml_files::add_item(text, kind.kind, kind.is_list, given).empty()) return nullptr;
    std::string who = kind.kind;
    for (const auto& [key, value] : given)
      if (key == "name") who += " '" + strip_quotes(value) + "'";
    for (const auto& error : list_errors(text)) {
      const bool is_of_it = error.what.find(who) != std::string::npos;
      if (!is_of_it) continue;
      for (const auto& key : kind.keys) {
        const bool is_given =
            std::any_of(given.begin(), given.end(), [&](const auto& pair) { return pair.first == key.name; });
        const auto says = [&](const std::string& words) { return error.what.find(words) != std::string::npos; };
        const bool is_missing = error.id.ends_with("missing-key") || error.id.ends_with("missing-parameter");
        if (!is_given &&
            ((is_missing && (says("'" + key.name + "'") || says(" no " + key.name))) || says(" " + key.name + " ''")))
          return &key;
      }
    }
    return nullptr;
  };
  std::size_t count = given.size();
  for (const auto* key = find_missing(); key != nullptr; key = find_missing()) {
    ask_for_key(kind, *key, given);
    if (given.size() == count) break;  // left empty
    count = given.size();
  }
  return given;
}

KeyValues EditSession::ask_for_keys(const KindHelp& kind, KeyValues given) const {
  const auto has = [&](const std::string& key) {
    return std::any_of(given.begin(), given.end(), [&](const auto& pair) { return pair.first == key; });
  };
  const auto ask = [&](const toml_files::KeyHelp& key) { ask_for_key(kind, key, given); };
  for (const auto& key : kind.keys)
    while (key.is_required && !has(key.name)) ask(key);
  for (const auto& expected : kind.expected) {
    const auto is_wanted = [&](const toml_files::KeyHelp& key) {
      return (expected + ",").find(" " + key.name + ",") != std::string::npos;
    };
    const auto is_met = [&] {
      return std::any_of(kind.keys.begin(), kind.keys.end(),
                         [&](const auto& k) { return is_wanted(k) && has(k.name); });
    };
    if (!is_met()) host_.print("  it needs " + expected + "\n");
    for (const auto& key : kind.keys)
      if (is_wanted(key) && !is_met()) ask(key);
  }
  return ask_for_missing(kind, std::move(given));
}

}  // namespace bough::analysis
