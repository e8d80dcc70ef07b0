#include "analysis/edit/edit_session.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "analysis/common/inputs.hpp"
#include "analysis/common/system_files.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/edit/command_words.hpp"
#include "analysis/edit/edit_commands.hpp"
#include "analysis/edit/old_commands.hpp"
#include "analysis/edit/text_diff.hpp"
#include "base/diagnostic.hpp"
#include "base/file_roles.hpp"
#include "base/text_table.hpp"
#include "base/words.hpp"
#include "formats/toml/key_editor.hpp"
#include "formats/toml/specs.hpp"

namespace bough::analysis {

using toml_files::KeyValues;
using toml_files::KindHelp;

namespace {

[[noreturn]] void throw_usage(const std::string& command) {
  throw InputError("cli.edit-command", {}, "'" + command + "' is not complete or has too many words",
                   "write " + get_edit_command(command).usage);
}

void demand_success(const std::string& problem) {
  if (!problem.empty()) throw InputError("cli.edit-command", {}, problem);
}

/// "hinge.2.motion.1" -> "hinge.2"; with `kinds` that are nested, "body.load.1.node" -> "body.load.1".
std::string get_item_path(const std::string& path, const std::vector<toml_files::TableItem>& items) {
  std::string longest;
  for (const auto& item : items) {
    const auto own = item.path();
    if (path.starts_with(own + ".") && own.size() > longest.size()) longest = own;
  }
  return longest;
}

}  // namespace

EditSession::EditSession(EditText text, EditHost& host, Ask ask, std::string output)
    : text_(std::move(text)),
      host_(host),
      ask_(std::move(ask)),
      target_(output.empty() ? text_.get_file() : std::move(output)) {}

std::vector<std::string> EditSession::list_commands() {
  std::vector<std::string> names;
  for (const auto& command : get_edit_commands()) names.push_back(command.name);
  return names;
}

bool EditSession::execute(const std::string& line) {
  const auto words = split_words(line);
  if (words.empty()) return true;
  const auto known = list_commands();
  std::string command = words[0];
  std::transform(command.begin(), command.end(), command.begin(), [](unsigned char c) { return std::tolower(c); });
  if (command == "change") command = "set";
  if (command == "exit") command = "quit";
  if (std::find(known.begin(), known.end(), command) == known.end()) {
    const auto successor = find_successor(words[0]), nearest = find_nearest(command, known);
    throw InputError("cli.edit-command", {}, "there is no command '" + words[0] + "'",
                     !successor.empty() ? successor
                     : nearest.empty()  ? "'help' lists the commands"
                                        : "did you mean '" + nearest + "'?");
  }
  const bool takes_none = command == "undo" || command == "redo" || command == "diff" || command == "check";
  if (takes_none && words.size() > 1) throw_usage(command);
  if (command == "quit") return !quit();
  if (command == "list") list(words);
  if (command == "show") show(words);
  if (command == "add") add(words);
  if (command == "set") set(words);
  if (command == "unset") unset(words);
  if (command == "delete") remove(words);
  if (command == "rename") rename(words);
  if (command == "copy") copy(words);
  if (command == "undo") text_.undo();
  if (command == "redo") text_.redo();
  if (command == "check") check();
  if (command == "run" || command == "reduce" || command == "plot") run_verb(command, words);
  if (command == "diff") host_.print_data(make_diff(text_.get_saved(), text_.get_text(), text_.get_file()));
  if (command == "save") save(words);
  if (command == "help") help(words);
  if (command == "complete") {
    const auto at = line.find("complete") + 8;
    for (const auto& word : complete(at < line.size() ? line.substr(at + 1) : "")) host_.print_data(word + "\n");
  }
  return true;
}

bool EditSession::execute(const std::string& line, const std::string& script, int number) {
  const auto place = [&](std::vector<Diagnostic> items) {
    for (auto& item : items)
      if (item.where.file.empty()) item.where = {script, number, 0};
    return items;
  };
  try {
    return execute(line);
  } catch (const ComputationError& failure) {
    throw ComputationError(place(failure.items()));
  } catch (const Failure& failure) {
    throw InputError(place(failure.items()));
  }
}

void EditSession::list(const Words& words) {
  if (words.size() > 2) throw_usage("list");
  const auto* kind = words.size() > 1 ? &text_.find_kind(words[1]) : nullptr;
  TextTable table{{"kind", "name", "type", "line"}, {}};
  for (const auto& item : toml_files::list_items(text_.get_text()))
    if (kind == nullptr || kind->kind == item.kind)
      table.rows.push_back({item.kind, item.name.empty() && item.number > 0 ? std::to_string(item.number) : item.name,
                            item.type, std::to_string(item.line)});
  if (!table.rows.empty()) host_.print_data(table.to_text());
}

EditTarget EditSession::find_item(const Words& words, std::size_t first, std::size_t num_after) const {
  // NAME, KIND.NAME or KIND NAME.
  if (words.size() == first + 2 + num_after)
    return text_.find_target(text_.find_kind(words[first]).kind + "." + strip_quotes(words[first + 1]), false);
  if (words.size() != first + 1 + num_after) throw_usage(words[0]);
  return text_.find_target(strip_quotes(words[first]), false);
}

void EditSession::show(const Words& words) {
  if (words.size() == 1) {
    host_.print_data(text_.get_text());
    return;
  }
  if (words.size() == 2 && words[1].find('.') != std::string::npos) {
    try {
      const auto target = text_.find_target(words[1], true);
      const auto value = toml_files::get_value_text(text_.get_text(), target.path());
      if (!value.empty()) {
        host_.print_data(value + "\n");
        return;
      }
    } catch (const InputError&) {
      // then it is an item
    }
  }
  host_.print_data(toml_files::get_item_text(text_.get_text(), find_item(words, 1, 0).item.path()));
}

void EditSession::add(const Words& words) {
  if (words.size() < 2) throw_usage("add");
  const auto& kind = text_.find_kind(words[1]);
  KeyValues values;
  for (std::size_t i = 2; i < words.size(); ++i) {
    const auto pair = split_assignment(words[i]);
    if (!pair && i > 2) throw_usage("add");
    if (!pair && kind.find("name") == nullptr)
      throw InputError("cli.edit-command", {}, "a " + kind.kind + " has no name", "write key=value after the kind");
    if (pair)
      values.emplace_back(pair->first, text_.make_value(&kind, pair->first, pair->second));
    else
      values.emplace_back("name", toml_files::quote_text(strip_quotes(words[i])));
  }
  if (ask_) values = ask_for_keys(kind, values);
  for (const auto& [key, value] : values)
    for (const auto& item : toml_files::list_items(text_.get_text()))
      if (key == "name" && kind.is_list && item.kind == kind.kind && toml_files::quote_text(item.name) == value)
        throw InputError("cli.edit-name", {}, "there is a " + kind.kind + " '" + item.name + "' already",
                         "give it another name");
  auto text = text_.get_text();
  demand_success(toml_files::add_item(text, kind.kind, kind.is_list, values));
  text_.change(text);
}

void EditSession::set(const Words& words) {
  if (words.size() < 2) throw_usage("set");
  auto text = text_.get_text();
  for (std::size_t i = 1; i < words.size(); ++i) {
    const auto pair = split_assignment(words[i]);
    if (!pair) throw_usage("set");
    const auto target = text_.find_target(pair->first, true);
    const auto* kind = target.item.kind.empty() ? nullptr : &text_.find_kind(target.item.kind);
    if (kind != nullptr && kind->is_list && target.rest == "name")
      throw InputError("cli.edit-command", {}, "a name is changed by rename", "so that what refers to it follows");
    demand_success(toml_files::set_value(text, target.path(), text_.make_value(kind, target.rest, pair->second)));
  }
  text_.change(text);
}

void EditSession::unset(const Words& words) {
  if (words.size() < 2) throw_usage("unset");
  auto text = text_.get_text();
  for (std::size_t i = 1; i < words.size(); ++i)
    demand_success(toml_files::remove_path(text, text_.find_target(words[i], true).path()));
  text_.change(text, true);
}

std::vector<toml_files::NameUse> EditSession::find_uses_of(const EditTarget& target, const std::string& text) const {
  const bool is_parameter = target.item.kind == "parameters";
  auto uses = toml_files::find_uses(text, target.item.kind, is_parameter ? target.rest : target.item.name);
  std::erase_if(uses, [&](const auto& use) {
    return get_item_path(use.path, toml_files::list_items(text)) == target.item.path();
  });
  return uses;
}

void EditSession::remove(const Words& given) {
  auto words = given;
  const bool with_references = std::erase(words, "--with-references") > 0;
  auto target = find_item(words, 1, 0);
  auto text = text_.get_text();
  const auto uses = find_uses_of(target, text);
  if (!uses.empty() && !with_references) {
    std::string list;
    for (const auto& use : uses)
      list += (list.empty() ? "" : ", ") + use.path + " (line " + std::to_string(use.line) + ")";
    const auto answer = ask_ ? ask_("'" + words.back() + "' is named by " + list + ": delete these too (y/n)? ") : "n";
    if (!answer || !answer->starts_with('y'))
      throw InputError("cli.edit-referenced", {}, "'" + words.back() + "' is named by " + list,
                       "change these, or add --with-references to delete them too");
  }
  // Tables that name the target are deleted first, and before them those that name these; the numbers of others shift.
  std::vector<EditTarget> left{target};
  std::string deleted;
  while (!left.empty()) {
    const auto more = find_uses_of(left.back(), text);
    if (!more.empty()) {
      const auto items = toml_files::list_items(text);
      const auto path = get_item_path(more.front().path, items);
      const auto item = std::find_if(items.begin(), items.end(), [&](const auto& i) { return i.path() == path; });
      if (item == items.end() || item->number == 0)
        throw InputError("cli.edit-referenced", {}, more.front().path + " names it too", "change that first");
      const bool is_circle = std::any_of(left.begin(), left.end(), [&](const auto& l) {
        return l.item.kind == item->kind && l.item.name == item->name;
      });
      if (!is_circle) {
        left.push_back({*item, {}});
        continue;
      }
    }
    auto gone = left.back();
    left.pop_back();
    for (const auto& item : toml_files::list_items(text))
      if (gone.item.number > 0 && item.kind == gone.item.kind && item.name == gone.item.name &&
          (!item.name.empty() || item.number == gone.item.number))
        gone.item = item;
    demand_success(toml_files::remove_path(text, gone.path()));
    if (!left.empty()) deleted += "deleted: " + gone.item.kind + " " + gone.item.name + "\n";
  }
  text_.change(text, true);
  host_.print(deleted);
}

void EditSession::rename(const Words& words) {
  const auto target = find_item(words, 1, 1);
  auto item = target.item;
  if (item.kind == "parameters") item.name = target.rest;
  auto text = text_.get_text();
  demand_success(toml_files::rename_item(text, item, strip_quotes(words.back())));
  text_.change(text);
}

void EditSession::copy(const Words& words) {
  const auto target = find_item(words, 1, 1);
  const auto name = strip_quotes(words.back());
  for (const auto& item : toml_files::list_items(text_.get_text()))
    if (item.kind == target.item.kind && item.name == name)
      throw InputError("cli.edit-name", {}, "there is a " + item.kind + " '" + name + "' already", "give another name");
  auto text = text_.get_text();
  demand_success(toml_files::copy_item(text, target.item, name));
  text_.change(text);
}

void EditSession::check() const {
  Diagnostics diagnostics;
  toml_files::check_text(text_.get_text(), text_.get_file(), diagnostics);
  diagnostics.throw_if_errors();
  if (text_.is_body_file()) {
    host_.print("the keys are sound; 'save' and 'reduce' try the deck\n");
    return;
  }
  LoadOptions options;
  options.text = text_.get_text();
  const auto loaded = load_system(text_.get_file(), diagnostics, options);
  diagnostics.throw_if_errors();
  host_.print(diagnostics);
  host_.print("sound: " + count(loaded.spec.bodies.size(), "body") + ", " + count(loaded.spec.hinges.size(), "hinge") +
              ", " + count(static_cast<std::size_t>(loaded.system.num_dofs()), "generalized speed") + "\n");
}

void EditSession::run_verb(const std::string& verb, const Words& words) const {
  if (verb != "plot" && text_.is_changed())
    throw InputError("cli.edit-unsaved", {}, verb + " reads the file, which has not all changes", "save first");
  Words call{verb};
  if (verb != "plot") call.push_back(is_saved_ ? target_ : text_.get_file());
  for (std::size_t i = 1; i < words.size(); ++i) call.push_back(strip_quotes(words[i]));
  const int code = host_.run_command(call);
  if (code != 0) throw InputError("cli.edit-command", {}, verb + " ended with exit code " + std::to_string(code));
}

void EditSession::save(const Words& given) {
  auto words = given;
  const bool is_forced = std::erase(words, "--force") > 0;
  if (words.size() > 2) throw_usage("save");
  const auto path = words.size() > 1 ? strip_quotes(words[1]) : target_;
  std::error_code failed;
  if (path == text_.get_file()) {
    std::ifstream in(path, std::ios::binary);
    const std::string now{std::istreambuf_iterator<char>(in), {}};
    if (now != text_.get_saved() && !is_forced)
      throw InputError("cli.edit-changed", {path}, "the file has changed since it was read",
                       "save under another name, or save --force over it");
  } else if (path != target_ && std::filesystem::exists(path, failed) && !is_forced) {
    throw InputError("cli.output-exists", {path}, "the file exists", "choose another name, or save NAME --force");
  }
  if (path == text_.get_file() || path == target_) FileRoles::allow_both(path);
  host_.check_output(path);
  Diagnostics diagnostics;
  toml_files::check_text(text_.get_text(), path, diagnostics);
  host_.print(diagnostics);
  write_text_file(path, text_.get_text());
  if (path == target_) {
    text_.set_saved();
    is_saved_ = true;
  }
  host_.print("written: " + path + "\n");
}

void EditSession::help(const Words& words) const {
  if (words.size() > 2) throw_usage("help");
  if (words.size() == 1) {
    for (const auto& command : get_edit_commands())
      host_.print_data(command.usage + "\n    " + command.description + "\n");
    std::string kinds;
    for (const auto& kind : text_.get_kinds()) kinds += (kinds.empty() ? "" : ", ") + kind.kind;
    host_.print_data("Kinds: " + kinds + "\n");
    return;
  }
  const auto& word = words[1];
  bool found = false;
  for (const auto& command : get_edit_commands()) {
    if (command.name != word) continue;
    host_.print_data(command.usage + "\n    " + command.description + "\n");
    found = true;
  }
  for (const auto& kind : text_.get_kinds()) {
    if (kind.kind == word) host_.print_data(toml_files::format_help(kind));
    const auto* key = kind.find(word.starts_with(kind.kind + ".") ? word.substr(kind.kind.size() + 1) : word);
    if (key != nullptr) host_.print_data(kind.kind + "\n" + toml_files::format_help(*key));
    found = found || kind.kind == word || key != nullptr;
  }
  if (!found)
    throw InputError("cli.edit-name", {}, "no command, kind or key is called '" + word + "'", "'help' lists them");
}

bool EditSession::quit() {
  if (ask_ && text_.is_changed()) {
    const auto answer = ask_("The changes are not saved. Quit (y/n)? ");
    return !answer || answer->starts_with('y');
  }
  return true;
}

void EditSession::finish() const {
  if (!text_.is_changed()) return;
  Diagnostics diagnostics;
  diagnostics.warning("cli.edit-unsaved", {text_.get_file()}, "the changes were not saved", "end with 'save'");
  host_.print(diagnostics);
}

EditText read_edit_text(const std::string& file, EditHost& host) {
  if (!has_suffix(file, ".toml"))
    throw InputError("cli.wrong-file", {file}, "edit takes body and system files in TOML", "name a .toml file");
  std::error_code failed;
  if (!std::filesystem::exists(file, failed)) {
    host.check_output(file);
    return {file, "", false};
  }
  FileRoles::allow_both(file);
  demand_file(file);
  const auto kind = toml_files::detect_kind(file);
  if (kind != "body") demand_kind(file, kind, "system");
  std::ifstream in(file, std::ios::binary);
  return {file, std::string(std::istreambuf_iterator<char>(in), {}), kind == "body"};
}

}  // namespace bough::analysis
