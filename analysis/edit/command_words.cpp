#include "analysis/edit/command_words.hpp"

#include "base/diagnostic.hpp"

namespace bough::analysis {

std::vector<std::string> split_words(const std::string& line) {
  std::vector<std::string> raw;
  std::string word;
  int depth = 0;
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote != 0) {
      word += c;
      if (c == '\\' && quote == '"' && i + 1 < line.size())
        word += line[++i];
      else if (c == quote)
        quote = 0;
      continue;
    }
    const bool is_blank = c == ' ' || c == '\t' || c == '\r';
    if (c == '#' && depth == 0) break;
    if (is_blank && depth == 0) {
      if (!word.empty()) raw.push_back(word);
      word.clear();
      continue;
    }
    if (c == '"' || c == '\'') quote = c;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    word += c;
  }
  if (quote != 0 || depth != 0)
    throw InputError("cli.edit-command", {}, quote != 0 ? "a quote stays open" : "brackets do not match",
                     "write a value on one line: axis = [0, 0, 1]");
  if (!word.empty()) raw.push_back(word);
  std::vector<std::string> words;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const bool joins = !words.empty() && (raw[i].starts_with('=') || words.back().ends_with('=')) && i > 1;
    if (joins)
      words.back() += raw[i];
    else
      words.push_back(raw[i]);
  }
  return words;
}

std::optional<std::pair<std::string, std::string>> split_assignment(const std::string& word) {
  char quote = 0;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if (quote != 0) {
      if (word[i] == quote) quote = 0;
    } else if (word[i] == '"' || word[i] == '\'') {
      quote = word[i];
    } else if (word[i] == '=') {
      return std::pair{word.substr(0, i), word.substr(i + 1)};
    }
  }
  return std::nullopt;
}

std::string strip_quotes(const std::string& word) {
  const bool is_quoted =
      word.size() > 1 && (word.front() == '"' || word.front() == '\'') && word.back() == word.front();
  return is_quoted ? word.substr(1, word.size() - 2) : word;
}

}  // namespace bough::analysis
