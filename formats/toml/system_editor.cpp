#include "formats/toml/system_editor.hpp"

#include <algorithm>
#include <functional>
#include <set>

#include <toml++/toml.h>

#include "formats/toml/detail/source_text.hpp"
#include "formats/toml/key_editor.hpp"

namespace bough::toml_files {

namespace {

struct Region {
  std::size_t begin = 0, end = 0;
};

/// A parsed text and the lines on which its [tables] begin.
struct Document {
  const std::string& text;
  toml::table root;
  std::string problem;
  std::set<std::size_t> heads;

  explicit Document(const std::string& t) : text(t) {
    try {
      root = toml::parse(std::string_view(text));
      collect_heads(root, heads);
    } catch (const toml::parse_error& error) {
      problem = std::string(error.description());
    }
  }

  std::size_t get_begin(const toml::node& node) const { return find_byte(text, node.source().begin); }
  std::size_t get_end(const toml::node& node) const { return find_byte(text, node.source().end); }

  std::size_t find_line_begin(std::size_t at) const {
    const auto before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    return before == std::string::npos ? 0 : before + 1;
  }
  std::size_t find_line_end(std::size_t at) const {
    const auto end = text.find('\n', at);
    return end == std::string::npos ? text.size() : end + 1;
  }

  /// Returns true if the table has a [heading].
  bool is_block(const toml::node& node) const {
    const auto* table = node.as_table();
    if (table == nullptr || table->is_inline() || table == &root) return false;
    const auto at = get_begin(node);
    return at < text.size() && text[at] == '[';
  }
  bool is_block_list(const toml::node& node) const {
    const auto* list = node.as_array();
    return list != nullptr && !list->empty() && is_block(*list->get(0));
  }

  void collect_heads(const toml::node& node, std::set<std::size_t>& found) const {
    if (is_block(node)) found.insert(find_line_begin(get_begin(node)));
    if (const auto* table = node.as_table())
      for (const auto& [key, child] : *table) collect_heads(child, found);
    if (const auto* list = node.as_array())
      for (const auto& child : *list) collect_heads(child, found);
  }

  /// The heading's line, or the first of the comment lines right above it; those at the top belong to the file.
  std::size_t find_comment_above(std::size_t head) const {
    auto begin = head;
    while (begin > 0) {
      const auto line = find_line_begin(begin - 1);
      const auto first = text.find_first_not_of(" \t", line);
      if (first >= begin || text[first] != '#') break;
      begin = line;
    }
    return begin == 0 ? head : begin;
  }

  /// The lines of a node's tables, from heading to heading.
  std::vector<Region> list_pieces(const toml::node& node) const {
    std::set<std::size_t> own;
    collect_heads(node, own);
    std::vector<Region> pieces;
    for (const auto head : own) {
      const auto next = heads.upper_bound(head);
      pieces.push_back({find_comment_above(head), next == heads.end() ? text.size() : find_comment_above(*next)});
    }
    return pieces;
  }

  /// End of the last value under the heading of the table; `otherwise` if there is none.
  std::size_t find_last_end(const toml::table& table, std::size_t otherwise) const {
    auto last = otherwise;
    for (const auto& [key, child] : table) {
      if (is_block(child) || is_block_list(child)) continue;
      const auto* below = child.as_table();
      const bool is_dotted = below != nullptr && !below->is_inline();
      last = std::max(last, is_dotted ? find_last_end(*below, otherwise) : get_end(child));
    }
    return last;
  }

  std::string get_line_break() const { return text.find("\r\n") == std::string::npos ? "\n" : "\r\n"; }
};

/// The nodes along a path; shorter than it by what is absent.
std::vector<toml::node*> walk(toml::table& root, const std::vector<std::string>& parts) {
  std::vector<toml::node*> chain{&root};
  for (const auto& part : parts) {
    toml::node* next = nullptr;
    if (auto* table = chain.back()->as_table()) next = table->get(part);
    if (auto* list = chain.back()->as_array()) next = find_item(*list, part);
    if (next == nullptr) break;
    chain.push_back(next);
  }
  return chain;
}

std::string join_key(const std::vector<std::string>& parts, std::size_t first) {
  std::string key;
  for (std::size_t i = first; i < parts.size(); ++i) key += (i == first ? "" : ".") + quote_key(parts[i]);
  return key;
}

/// Returns false if table `a` has no heading and is defined by "[a.b]" only, whose path is longer than that of `a`.
bool has_own_heading(const Document& document, const toml::node& node, const std::vector<std::string>& parts) {
  const auto at = document.get_begin(node);
  auto begin = document.text.find_first_not_of('[', at);
  const auto end = document.text.find(']', begin);
  if (end == std::string::npos) return true;
  const auto heading = split_path(document.text.substr(begin, end - begin));
  std::size_t num_keys = 0;
  for (const auto& part : parts) num_keys += part.find_first_not_of("0123456789") == std::string::npos ? 0 : 1;
  return heading.size() == num_keys;
}

/// Takes an entry out of {...} or [...], with the comma that goes with it.
void remove_entry(std::string& text, Region entry) {
  const auto after = text.find_first_not_of(" \t\r\n", entry.end);
  if (after != std::string::npos && text[after] == ',') {
    entry.end = text.find_first_not_of(" \t", after + 1);
  } else {
    const auto before = text.find_last_not_of(" \t\r\n", entry.begin - 1);
    if (before != std::string::npos && text[before] == ',') entry.begin = before;
  }
  // An entry alone on its line is removed with the line.
  const auto line = text.find_last_not_of(" \t", entry.begin - 1);
  if (line != std::string::npos && text[line] == '\n' && entry.end < text.size() && text[entry.end] == '\n') {
    entry.begin = line + 1;
    ++entry.end;
  }
  text.erase(entry.begin, entry.end - entry.begin);
}

std::string write_keys(const KeyValues& values, const std::string& separator) {
  std::string text;
  for (const auto& [key, value] : values)
    text += (text.empty() ? "" : separator) + join_key(split_path(key), 0) + " = " + value;
  return text;
}

/// A block of lines at `at`, blank lines around it.
void insert_block(std::string& text, std::size_t at, std::string block, const std::string& line_break) {
  const auto before = text.substr(0, at);
  std::string gap;
  if (!before.empty() && before.back() != '\n') gap += line_break;
  if (!before.empty() && !before.ends_with("\n\n") && !before.ends_with("\n\r\n")) gap += line_break;
  if (at < text.size() && !block.ends_with(line_break + line_break)) block += line_break;
  text.insert(at, gap + block);
}

}  // namespace

bool is_value(const std::string& text) {
  if (text.find('\n') != std::string::npos) return false;
  try {
    const auto table = toml::parse("x = " + text);
    return table.size() == 1;
  } catch (const toml::parse_error&) {
    return false;
  }
}

std::vector<TableItem> list_items(const std::string& text) {
  Document document(text);
  std::vector<TableItem> items;
  const auto add = [&](const toml::table& table, const std::string& kind, int number) {
    TableItem item;
    item.kind = kind;
    item.number = number;
    item.name = table["name"].value_or(std::string());
    item.type = table["type"].value_or(std::string());
    item.line = static_cast<int>(table.source().begin.line);
    for (const auto& [key, child] : table) item.keys.emplace_back(key.str());
    items.push_back(item);
  };
  const std::function<void(const toml::table&, const std::string&)> visit = [&](const toml::table& table,
                                                                                const std::string& path) {
    for (const auto& [key, child] : table) {
      const auto kind = (path.empty() ? "" : path + ".") + quote_key(std::string(key.str()));
      if (const auto* below = child.as_table()) {
        add(*below, kind, 0);
        visit(*below, kind);
      } else if (child.is_array_of_tables()) {
        int number = 0;
        for (const auto& entry : *child.as_array()) add(*entry.as_table(), kind, ++number);
      }
    }
  };
  visit(document.root, {});
  std::stable_sort(items.begin(), items.end(), [](const auto& a, const auto& b) { return a.line < b.line; });
  return items;
}

std::string get_item_text(const std::string& text, const std::string& item_path) {
  Document document(text);
  const auto parts = split_path(item_path);
  const auto chain = walk(document.root, parts);
  if (chain.size() != parts.size() + 1) return {};
  std::string own;
  for (const auto& piece : document.list_pieces(*chain.back()))
    own += text.substr(piece.begin, piece.end - piece.begin);
  if (own.empty())
    own = text.substr(document.get_begin(*chain.back()),
                      document.get_end(*chain.back()) - document.get_begin(*chain.back()));
  while (own.ends_with('\n') || own.ends_with('\r')) own.pop_back();
  return own + "\n";
}

std::string get_value_text(const std::string& text, const std::string& path) {
  Document document(text);
  const auto parts = split_path(path);
  const auto chain = walk(document.root, parts);
  if (chain.size() != parts.size() + 1 || document.is_block(*chain.back()) || document.is_block_list(*chain.back()))
    return {};
  const auto begin = document.get_begin(*chain.back());
  return text.substr(begin, document.get_end(*chain.back()) - begin);
}

std::string set_value(std::string& text, const std::string& path, const std::string& value) {
  Document document(text);
  if (!document.problem.empty()) return document.problem;
  const auto parts = split_path(path);
  const auto chain = walk(document.root, parts);
  const auto line_break = document.get_line_break();
  if (chain.size() == parts.size() + 1) {
    const auto& node = *chain.back();
    if (document.is_block_list(node) || (node.is_table() && !node.as_table()->is_inline()))
      return "it is a table; name one of its keys";
    const auto begin = document.get_begin(node);
    text.replace(begin, document.get_end(node) - begin, value);
    return {};
  }
  auto host = chain.size() - 1;  // number of parts that lead to it
  if (chain[host]->is_array()) return "'" + parts[host] + "' is neither a number nor a name of the list before it";
  if (!chain[host]->is_table()) return "'" + parts[host] + "' stands below a single value";
  const auto is_dotted = [&](std::size_t i) {
    return i > 0 && !chain[i]->as_table()->is_inline() && !document.is_block(*chain[i]);
  };
  while (is_dotted(host)) --host;
  const auto& table = *chain[host]->as_table();
  const auto line = join_key(parts, host) + " = " + value;
  if (host == 0) {
    if (parts.size() > 1 && chain.size() == 1)
      return add_item(text, quote_key(parts[0]), false, {{join_key(parts, 1), value}});
    const auto last = document.find_last_end(table, 0);
    if (last > 0) {
      const auto at = document.find_line_end(last);
      text.insert(at, (text[at - 1] == '\n' ? "" : line_break) + line + line_break);
    } else {
      const auto at = document.heads.empty() ? text.size() : document.find_comment_above(*document.heads.begin());
      insert_block(text, at, line + line_break, line_break);
    }
    return {};
  }
  if (table.is_inline()) {
    if (table.empty())
      text.insert(document.get_begin(table) + 1, line);
    else
      text.insert(document.find_last_end(table, 0), ", " + line);
    return {};
  }
  const std::vector<std::string> above(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(host));
  if (!has_own_heading(document, table, above)) return "the table has no separate heading; give it one";
  const auto at = document.find_line_end(document.find_last_end(table, document.get_begin(table)));
  text.insert(at, (text[at - 1] == '\n' ? "" : line_break) + line + line_break);
  return {};
}

std::string remove_path(std::string& text, const std::string& path) {
  Document document(text);
  if (!document.problem.empty()) return document.problem;
  const auto parts = split_path(path);
  const auto chain = walk(document.root, parts);
  if (chain.size() != parts.size() + 1) return "there is no '" + parts[chain.size() - 1] + "'";
  const auto& node = *chain.back();
  auto pieces = document.list_pieces(node);
  if (!pieces.empty()) {
    const bool was_last = pieces.back().end == text.size();
    std::reverse(pieces.begin(), pieces.end());
    for (const auto& piece : pieces) text.erase(piece.begin, piece.end - piece.begin);
    if (was_last && text.ends_with("\n\n")) text.pop_back();
    return {};
  }
  const Region value{document.get_begin(node), document.get_end(node)};
  const auto& parent = *chain[chain.size() - 2];
  if (parent.is_array()) {
    remove_entry(text, value);
    return {};
  }
  if (node.is_table() && !node.as_table()->is_inline()) return "it is a table made by dotted keys; unset these";
  std::size_t begin = value.begin;
  for (const auto& [key, child] : *parent.as_table())
    if (&child == &node) begin = find_byte(text, key.source().begin);
  if (parent.as_table()->is_inline()) {
    remove_entry(text, {begin, value.end});
    return {};
  }
  for (std::size_t i = 1; i + 1 < chain.size(); ++i)
    if (chain[i]->is_table() && chain[i]->as_table()->is_inline()) return "it is in dotted keys within {}; set these";
  begin = document.find_line_begin(begin);
  text.erase(begin, document.find_line_end(value.end) - begin);
  return {};
}

std::string add_item(std::string& text, const std::string& kind, bool is_list, const KeyValues& values) {
  Document document(text);
  if (!document.problem.empty()) return document.problem;
  const auto parts = split_path(kind);
  const auto chain = walk(document.root, parts);
  const auto line_break = document.get_line_break();
  const bool exists = chain.size() == parts.size() + 1;
  if (exists && !is_list) return "there is a table [" + kind + "] already";
  if (exists && !chain.back()->is_array()) return "'" + kind + "' is no list of tables";
  if (exists && !document.is_block_list(*chain.back())) {
    const auto& list = *chain.back()->as_array();
    const auto entry = "{" + write_keys(values, ", ") + "}";
    if (list.empty())
      text.insert(document.get_begin(list) + 1, entry);
    else
      text.insert(document.get_end(*list.get(list.size() - 1)), ", " + entry);
    return {};
  }
  auto block = (is_list ? "[[" : "[") + join_key(parts, 0) + (is_list ? "]]" : "]") + line_break;
  if (!values.empty()) block += write_keys(values, line_break) + line_break;
  std::size_t at = text.size();
  if (exists) {
    at = document.list_pieces(*chain.back()).back().end;
  } else if (const auto* run = document.root.get("simulation"); run != nullptr && document.is_block(*run)) {
    at = document.list_pieces(*run).front().begin;
  }
  insert_block(text, at, block, line_break);
  return {};
}

std::string copy_item(std::string& text, const TableItem& item, const std::string& name) {
  Document document(text);
  if (!document.problem.empty()) return document.problem;
  if (item.number == 0) return "there can be only one [" + item.kind + "]";
  const auto chain = walk(document.root, split_path(item.path()));
  const auto& node = *chain.back();
  auto changed = text;
  const auto pieces = document.list_pieces(node);
  if (pieces.empty()) {
    const auto end = document.get_end(node);
    changed.insert(end, ", " + text.substr(document.get_begin(node), end - document.get_begin(node)));
  } else {
    std::string own;
    for (const auto& piece : pieces) {
      const auto head = *document.heads.lower_bound(piece.begin);
      own += text.substr(head, piece.end - head);
    }
    if (!own.ends_with('\n')) own += document.get_line_break();
    insert_block(changed, pieces.back().end, own, document.get_line_break());
  }
  const auto copy = item.kind + "." + std::to_string(item.number + 1);
  const auto problem = set_value(changed, copy + ".name", quote_text(name));
  if (problem.empty()) text = changed;
  return problem;
}

}  // namespace bough::toml_files
