#include "formats/flx/layout.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/diagnostic.hpp"
#include "base/file_roles.hpp"
#include "formats/flx/detail/layout_words.hpp"
#include "formats/flx/list_directed.hpp"

namespace bough::flx {

namespace {

using namespace detail;

const std::string kIndices = "ijkabdle";
const std::vector<std::string> kConditions{"rigid", "stiffening", "resultants", "preload"};

class LayoutParser {
 public:
  LayoutParser(const std::string& text, std::string file) : in_(text) { layout_.file = std::move(file); }

  Layout parse() {
    parse_body(layout_.statements, "", 0);
    diagnostics_.throw_if_errors();
    return std::move(layout_);
  }

 private:
  void syntax(const std::string& what, const std::string& advice) {
    diagnostics_.error("flx.layout-syntax", {layout_.file, line_}, what, advice);
  }
  template <class Info>
  void unknown(const std::string& what, const std::string& word, const std::vector<Info>& known) {
    std::vector<std::string> names;
    for (const auto& info : known) names.push_back(info.name);
    const std::string nearest = find_nearest(word, names);
    diagnostics_.error("flx.layout-name", {layout_.file, line_}, "unknown " + what + " \"" + word + "\"",
                       nearest.empty() ? "docs/formats/flx.md lists the names" : "did you mean \"" + nearest + "\"");
  }

  /// Statements up to "end" of a loop, or to the end of the file. `scope`: indices that loops give.
  void parse_body(std::vector<Statement>& statements, const std::string& scope, int opened) {
    std::string line;
    while (std::getline(in_, line)) {
      ++line_;
      std::vector<std::string> words;
      if (!split(line, words)) {
        syntax("a quote is not closed", "end the text with \"");
        continue;
      }
      if (words.empty()) continue;
      const std::string& verb = words[0];
      if (verb == "number" || verb == "integer") {
        parse_default(words);
      } else if (verb == "text") {
        Statement s = start(Statement::Kind::Text);
        if (words.size() != 2) syntax("text takes one quoted text", "write text \"...\"");
        if (words.size() == 2) s.text = parse_text(words[1], scope);
        statements.push_back(std::move(s));
      } else if (verb == "block") {
        parse_block(words, scope, statements);
      } else if (verb == "for") {
        parse_loop(words, scope, statements);
      } else if (verb == "when") {
        parse_condition(words, scope, statements);
      } else if (verb == "end" && opened > 0) {
        return;
      } else {
        syntax("unknown statement \"" + verb + "\"", "expected number, integer, text, block, for, when or end");
      }
    }
    if (opened > 0) {
      line_ = opened;
      syntax("the loop or condition is not closed", "add a line with end");
    }
  }

  Statement start(Statement::Kind kind) const {
    Statement s;
    s.kind = kind;
    s.line = line_;
    s.number = number_;
    s.integer = integer_;
    return s;
  }

  bool parse_format(const std::string& text, bool wants_integer, NumberFormat& format) {
    const auto parsed = NumberFormat::parse(text);
    if (!parsed || (parsed->is_integer() && !wants_integer)) {
      syntax("\"" + text + "\" is no format of " + (wants_integer ? "integers" : "numbers"),
             "write it as in C (%16.8E, %5d) or Fortran (5E16.8, 1P5E16.8, ES16.8, D24.16, F12.4, I5)");
      return false;
    }
    format = *parsed;
    return true;
  }

  void parse_default(const std::vector<std::string>& words) {
    if (words.size() != 2) {
      syntax(words[0] + " takes one format", "write number 5E16.8 or integer I5");
      return;
    }
    parse_format(words[1], words[0] == "integer", words[0] == "integer" ? integer_ : number_);
  }

  TextTemplate parse_text(const std::string& text, const std::string& scope) {
    TextTemplate result;
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const bool doubled = i + 1 < text.size() && text[i + 1] == text[i];
      if ((text[i] == '{' || text[i] == '}') && doubled) {
        plain += text[i++];
      } else if (text[i] == '{') {
        const auto close = text.find('}', i);
        if (close == std::string::npos) {
          syntax("a { is not closed", "end the field with }; write {{ for a brace");
          return result;
        }
        result.pieces.push_back({plain, {}, {}});
        plain.clear();
        parse_field(text.substr(i + 1, close - i - 1), scope, result);
        i = close;
      } else {
        plain += text[i];
      }
    }
    result.pieces.push_back({plain, {}, {}});
    return result;
  }

  void parse_field(const std::string& text, const std::string& scope, TextTemplate& result) {
    const auto colon = text.find(':');
    TextTemplate::Piece piece;
    piece.field = text.substr(0, colon);
    const auto* field = find(get_fields(), piece.field);
    if (field == nullptr) {
      unknown("field", piece.field, get_fields());
      return;
    }
    if (!field->indices.empty() && scope.find(field->indices) == std::string::npos) {
      diagnostics_.error("flx.layout-name", {layout_.file, line_},
                         "{" + piece.field + "} needs the index " + field->indices + ", which has no value here",
                         "use it in a loop over it, or in the label of a block that has it");
      return;
    }
    if (colon != std::string::npos) {
      NumberFormat format;
      if (!parse_format(text.substr(colon + 1), piece.field != "mass", format)) return;
      if (field->is_text) {
        syntax("{" + piece.field + "} is a text and takes no format", "leave the format out");
        return;
      }
      piece.format = format;
    }
    result.pieces.push_back(piece);
  }

  static std::optional<NodeSet> parse_nodes(const std::string& word) {
    if (word == "output") return NodeSet::Output;
    if (word == "special") return NodeSet::Special;
    if (word == "all") return NodeSet::All;
    return std::nullopt;
  }

  void parse_loop(const std::vector<std::string>& words, const std::string& scope, std::vector<Statement>& statements) {
    Statement s = start(Statement::Kind::For);
    const int opened = line_;
    if (words.size() < 2 || words[1].size() != 1 || kIndices.find(words[1]) == std::string::npos ||
        scope.find(words[1]) != std::string::npos) {
      syntax("for takes an index that has no value yet", "write for j (indices: i j k a b d l e)");
      s.name = "j";
    } else {
      s.name = words[1];
    }
    for (std::size_t w = 2; w < words.size(); ++w) {
      const auto nodes = words[w].rfind("nodes=", 0) == 0 ? parse_nodes(words[w].substr(6)) : std::nullopt;
      if (!nodes || s.name != "i") syntax("for takes no \"" + words[w] + "\"", "for i nodes=output|special|all");
      if (nodes) s.nodes = *nodes;
    }
    parse_body(s.body, scope + s.name, opened);
    statements.push_back(std::move(s));
  }

  void parse_condition(const std::vector<std::string>& words, const std::string& scope,
                       std::vector<Statement>& statements) {
    Statement s = start(Statement::Kind::When);
    const int opened = line_;
    if (words.size() == 2) s.name = words[1];
    if (std::find(kConditions.begin(), kConditions.end(), s.name) == kConditions.end())
      syntax("when takes what the body must have", "write when rigid, stiffening, resultants or preload");
    parse_body(s.body, scope, opened);
    statements.push_back(std::move(s));
  }

  void parse_block(const std::vector<std::string>& words, const std::string& scope,
                   std::vector<Statement>& statements) {
    Statement s = start(Statement::Kind::Block);
    const auto* info = words.size() > 1 ? find(get_blocks(), words[1]) : nullptr;
    if (info == nullptr) {
      unknown("block", words.size() > 1 ? words[1] : "", get_blocks());
      return;
    }
    s.name = info->name;
    s.per_line = number_.per_line();
    std::string free;
    for (char index : info->indices)
      if (scope.find(index) == std::string::npos) free += index;
    for (std::size_t w = 2; w < words.size(); ++w) {
      const auto equals = words[w].find('=');
      const std::string key = words[w].substr(0, equals);
      const std::string value = equals == std::string::npos ? "" : words[w].substr(equals + 1);
      if (key.size() == 1 && free.find(key) != std::string::npos) free.erase(free.find(key), 1);
      if (!parse_key(s, key, value, scope + info->indices, *info))
        syntax("cannot read \"" + words[w] + "\" of block " + s.name, "docs/formats/flx.md lists what a block takes");
    }
    if (s.order.empty()) s.order = free;
    std::string sorted = s.order, expected = free;
    std::sort(sorted.begin(), sorted.end());
    std::sort(expected.begin(), expected.end());
    if (sorted != expected)
      syntax("order of block " + s.name + " must name each of " + list(free) + " once",
             "write order=" + list(free) + " in the sequence you need, slowest first");
    if (!s.has_record) s.record = s.order.substr(0, s.order.empty() ? 0 : s.order.size() - 1);
    if (s.has_record && !s.record.empty()) {
      const auto at = s.order.find(s.record);
      if (at == std::string::npos)
        syntax("record=" + s.record + " is no index of the order", "name one of " + list(free));
      s.record = s.order.substr(0, at == std::string::npos ? 0 : at + 1);
    }
    if (!s.has_continued) s.continued = s.text;
    statements.push_back(std::move(s));
  }

  static std::string list(const std::string& letters) {
    std::string text;
    for (const char c : letters) {
      if (!text.empty()) text += ',';
      text += c;
    }
    return text;
  }

  bool parse_key(Statement& s, const std::string& key, const std::string& value, const std::string& scope,
                 const BlockInfo& info) {
    if (key == "label") {
      s.text = parse_text(value, scope);
    } else if (key == "continue") {
      s.continued = parse_text(value, scope);
      s.has_continued = true;
    } else if (key == "heading") {
      s.heading = parse_text(value, scope);
      s.has_heading = true;
    } else if (key == "order") {
      for (char c : value)
        if (c != ',') s.order += c;
    } else if (key == "record") {
      s.has_record = true;
      s.record = value == "none" ? "" : value;
      return value == "none" || value.size() == 1;
    } else if (key == "per_line") {
      return parse_whole(value, s.per_line) && s.per_line >= 0;
    } else if (key == "separator") {
      s.separator = value;
    } else if (key == "number") {
      if (!parse_format(value, false, s.number)) return true;
      if (s.number.per_line() > 0) s.per_line = s.number.per_line();
    } else if (key == "integer") {
      parse_format(value, true, s.integer);
      if (s.integer.per_line() > 0) s.per_line = s.integer.per_line();
    } else if (key == "nodes" && info.indices.find('i') != std::string::npos) {
      const auto nodes = parse_nodes(value);
      if (nodes) s.nodes = *nodes;
      return nodes.has_value();
    } else if (key == "triangle" && info.indices.find('k') != std::string::npos) {
      s.triangle = value == "upper" ? 'u' : value == "lower" ? 'l' : '?';
      return s.triangle != '?';
    } else if (key.size() == 1 && info.indices.find(key) != std::string::npos) {
      int index = 0;
      if (!parse_whole(value, index) || index < 1) return false;
      s.fixed.emplace_back(key[0], index);
    } else {
      return false;
    }
    return true;
  }

  static bool parse_whole(const std::string& text, int& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size();
  }

  std::istringstream in_;
  Layout layout_;
  Diagnostics diagnostics_;
  int line_ = 0;
  NumberFormat number_ = *NumberFormat::parse("%17.8E"), integer_ = *NumberFormat::parse("%8d");
};

}  // namespace

Layout parse_layout(const std::string& text, const std::string& file) { return LayoutParser(text, file).parse(); }

Layout read_layout(const std::string& path) { return parse_layout(read_text_file(path), path); }

}  // namespace bough::flx
