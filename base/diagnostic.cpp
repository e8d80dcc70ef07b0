#include "base/diagnostic.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace bough {

namespace {
/// In the order of Severity.
constexpr std::array kSeverityNames{"note", "warning", "error"};

/// Names come from files: what would end a message or move the cursor is written as "\\x00".
std::string make_visible(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if ((code >= 0x20 && code != 0x7f) || c == '\n' || c == '\t') {
      out += c;
      continue;
    }
    constexpr char digits[] = "0123456789abcdef";
    out += {'\\', 'x', digits[code >> 4], digits[code & 15]};
  }
  return out;
}

Diagnostic make(Severity s, std::string_view id, SourceLocation where, std::string what, std::string advice) {
  return {s, std::string(id), std::move(where), std::move(what), std::move(advice)};
}
}  // namespace

std::string format(const Diagnostic& d) {
  std::string text;
  if (!d.where.file.empty()) {
    text += d.where.file;
    if (d.where.line > 0) text += ":" + std::to_string(d.where.line);
    if (d.where.column > 0) text += ":" + std::to_string(d.where.column);
    text += ": ";
  }
  text += kSeverityNames[static_cast<std::size_t>(d.severity)];
  text += ": " + d.what;
  if (!d.advice.empty()) text += "; " + d.advice;
  if (!d.id.empty()) text += " [" + d.id + "]";
  return make_visible(text);
}

void Diagnostics::add_new(const Diagnostic& d) {
  for (const auto& item : items_)
    if (item.id == d.id && item.what == d.what) return;
  add(d);
}

void Diagnostics::add(Diagnostic d) {
  if (d.severity == Severity::Error) ++num_errors_;
  if (d.severity == Severity::Warning) ++num_warnings_;
  // A wrong card that is repeated three million times would give gigabytes of messages.
  constexpr std::size_t kMaxItems = 200'000;
  const auto is_same = [&](const Diagnostic& other) { return other.id == d.id && other.severity == d.severity; };
  if (items_.size() >= kMaxItems && std::any_of(items_.end() - 16, items_.end(), is_same)) return;
  items_.push_back(std::move(d));
}
void Diagnostics::error(std::string_view id, SourceLocation where, std::string what, std::string advice) {
  add(make(Severity::Error, id, std::move(where), std::move(what), std::move(advice)));
}
void Diagnostics::warning(std::string_view id, SourceLocation where, std::string what, std::string advice) {
  add(make(Severity::Warning, id, std::move(where), std::move(what), std::move(advice)));
}
void Diagnostics::note(std::string_view id, SourceLocation where, std::string what, std::string advice) {
  add(make(Severity::Note, id, std::move(where), std::move(what), std::move(advice)));
}
bool Diagnostics::has(std::string_view id) const {
  return std::any_of(items_.begin(), items_.end(), [&](const Diagnostic& d) { return d.id == id; });
}
void Diagnostics::throw_if_errors() const {
  if (num_errors_ > 0) throw InputError(items_);
}

Failure::Failure(std::vector<Diagnostic> items, int exit_code) : items_(std::move(items)), exit_code_(exit_code) {
  constexpr std::size_t kMaxItems = 1000;  // a card that is repeated a million times is wrong a million times
  for (std::size_t i = 0; i < std::min(items_.size(), kMaxItems); ++i) {
    if (!text_.empty()) text_ += '\n';
    text_ += format(items_[i]);
  }
  if (items_.size() > kMaxItems) text_ += "\n... and " + std::to_string(items_.size() - kMaxItems) + " more";
}
InputError::InputError(std::string_view id, SourceLocation where, std::string what, std::string advice)
    : InputError({make(Severity::Error, id, std::move(where), std::move(what), std::move(advice))}) {}
ComputationError::ComputationError(std::string_view id, SourceLocation where, std::string what, std::string advice)
    : ComputationError({make(Severity::Error, id, std::move(where), std::move(what), std::move(advice))}) {}

namespace {
bool is_same_letter(char x, char y) {
  return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
}

/// A bit for each letter of the word, case aside; some share one.
std::uint32_t find_letters(std::string_view word) {
  std::uint32_t bits = 0;
  for (const char c : word) bits |= std::uint32_t{1} << (std::tolower(static_cast<unsigned char>(c)) & 31);
  return bits;
}

/// Letters to change, add, leave out or swap with their neighbour to make one word of the other; case aside. Three rows
/// of the table are enough, and are kept between the calls.
class Distance {
 public:
  std::size_t calc(std::string_view a, std::string_view b) {
    for (auto& row : rows_) row.resize(b.size() + 1);
    for (std::size_t i = 0; i <= a.size(); ++i) {
      auto &row = rows_[i % 3], &above = rows_[(i + 2) % 3], &second = rows_[(i + 1) % 3];
      for (std::size_t j = 0; j <= b.size(); ++j) {
        if (i == 0 || j == 0) {
          row[j] = i + j;
          continue;
        }
        row[j] = std::min({above[j - 1] + (is_same_letter(a[i - 1], b[j - 1]) ? 0 : 1), above[j] + 1, row[j - 1] + 1});
        if (i > 1 && j > 1 && is_same_letter(a[i - 1], b[j - 2]) && is_same_letter(a[i - 2], b[j - 1]))
          row[j] = std::min(row[j], second[j - 2] + 1);
      }
    }
    return rows_[a.size() % 3][b.size()];
  }

 private:
  std::array<std::vector<std::size_t>, 3> rows_;
};

/// The one candidate that begins with the word, of three letters at least; empty when there are none or several.
std::string find_completion(std::string_view word, const std::vector<std::string>& candidates) {
  std::string found;
  for (const auto& candidate : candidates) {
    if (word.size() < 3 || candidate.size() < word.size()) continue;
    if (!std::equal(word.begin(), word.end(), candidate.begin(), is_same_letter)) continue;
    if (!found.empty()) return {};
    found = candidate;
  }
  return found;
}
}  // namespace

std::string find_nearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  Distance table;
  const auto letters = find_letters(word);
  for (const auto& candidate : candidates) {
    const auto longer = std::max(word.size(), candidate.size()), shorter = std::min(word.size(), candidate.size());
    if (longer - shorter >= best_distance) continue;  // as many letters to add at least
    const auto others = find_letters(candidate);      // and each that only one of them has is to change
    if (static_cast<std::size_t>(std::max(std::popcount(letters & ~others), std::popcount(others & ~letters))) >=
        best_distance)
      continue;
    const auto distance = table.calc(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best.empty() ? find_completion(word, candidates) : best;
}

void demand_failed(const char* condition, const char* function, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: broken contract in %s: %s\n", file, line, function, condition);
  std::abort();
}

}  // namespace bough
