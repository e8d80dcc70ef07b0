#include "analysis/edit/text_diff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <vector>

namespace bough::analysis {

namespace {

struct DiffLine {
  char mark;
  std::string text;
};

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Compares by the longest common subsequence of the lines between the common beginning and the common end.
std::vector<DiffLine> compare_lines(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  std::size_t first = 0, last = 0;
  while (first < std::min(a.size(), b.size()) && a[first] == b[first]) ++first;
  while (last < std::min(a.size(), b.size()) - first && a[a.size() - 1 - last] == b[b.size() - 1 - last]) ++last;
  const std::size_t n = a.size() - first - last, m = b.size() - first - last;
  std::vector<std::vector<unsigned>> length(n + 1, std::vector<unsigned>(m + 1, 0));
  for (std::size_t i = n; i-- > 0;)
    for (std::size_t j = m; j-- > 0;)
      length[i][j] =
          a[first + i] == b[first + j] ? length[i + 1][j + 1] + 1 : std::max(length[i + 1][j], length[i][j + 1]);
  std::vector<DiffLine> lines;
  for (std::size_t i = 0; i < first; ++i) lines.push_back({' ', a[i]});
  std::size_t i = 0, j = 0;
  while (i < n || j < m) {
    if (i < n && j < m && a[first + i] == b[first + j]) {
      lines.push_back({' ', a[first + i]});
      ++i, ++j;
    } else if (i < n && (j == m || length[i + 1][j] >= length[i][j + 1])) {
      lines.push_back({'-', a[first + i++]});
    } else {
      lines.push_back({'+', b[first + j++]});
    }
  }
  for (std::size_t k = a.size() - last; k < a.size(); ++k) lines.push_back({' ', a[k]});
  return lines;
}

}  // namespace

std::string make_diff(const std::string& before, const std::string& after, const std::string& name) {
  constexpr std::size_t kContext = 3;
  const auto lines = compare_lines(split_lines(before), split_lines(after));
  std::string text;
  std::size_t old_line = 1, new_line = 1;
  for (std::size_t i = 0; i < lines.size();) {
    // A hunk begins kContext lines before a change and ends where twice as many lines are the same.
    std::size_t change = i;
    while (change < lines.size() && lines[change].mark == ' ') ++change;
    if (change == lines.size()) break;
    const std::size_t begin = std::max(i, change < kContext ? 0 : change - kContext);
    old_line += begin - i;
    new_line += begin - i;
    std::size_t end = change, same = 0;
    while (end < lines.size() && same <= 2 * kContext) same = lines[end++].mark == ' ' ? same + 1 : 0;
    if (same > kContext) end -= same - kContext;
    std::string hunk;
    std::size_t num_old = 0, num_new = 0;
    for (std::size_t k = begin; k < end; ++k) {
      hunk += lines[k].mark + lines[k].text + "\n";
      num_old += lines[k].mark != '+';
      num_new += lines[k].mark != '-';
    }
    if (text.empty()) text = fmt::format("--- {0}\n+++ {0}\n", name);
    // An empty range has the line before it, as in diff -u.
    text += fmt::format("@@ -{},{} +{},{} @@\n{}", num_old == 0 ? old_line - 1 : old_line, num_old,
                        num_new == 0 ? new_line - 1 : new_line, num_new, hunk);
    old_line += num_old;
    new_line += num_new;
    i = end;
  }
  return text;
}

}  // namespace bough::analysis
