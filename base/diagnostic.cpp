#include "bough/base/diagnostic.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>

namespace bough {

namespace {
const char* name_of(Severity s) {
  switch (s) {
    case Severity::Note:
      return "note";
    case Severity::Warning:
      return "warning";
    case Severity::Error:
      break;
  }
  return "error";
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
  text += name_of(d.severity);
  text += ": " + d.what;
  if (!d.advice.empty()) text += "; " + d.advice;
  if (!d.id.empty()) text += " [" + d.id + "]";
  return text;
}

void Diagnostics::add(Diagnostic d) {
  if (d.severity == Severity::Error) ++num_errors_;
  if (d.severity == Severity::Warning) ++num_warnings_;
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
  for (const auto& d : items_) {
    if (!text_.empty()) text_ += '\n';
    text_ += format(d);
  }
}
InputError::InputError(std::string_view id, SourceLocation where, std::string what, std::string advice)
    : InputError({make(Severity::Error, id, std::move(where), std::move(what), std::move(advice))}) {}
ComputationError::ComputationError(std::string_view id, SourceLocation where, std::string what, std::string advice)
    : ComputationError({make(Severity::Error, id, std::move(where), std::move(what), std::move(advice))}) {}

std::string find_nearest(std::string_view word, const std::vector<std::string>& candidates) {
  auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  std::vector<std::size_t> row;
  for (const auto& candidate : candidates) {
    row.resize(candidate.size() + 1);
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= word.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i;
      for (std::size_t j = 1; j < row.size(); ++j) {
        const std::size_t substitute = diagonal + (lower(word[i - 1]) == lower(candidate[j - 1]) ? 0 : 1);
        diagonal = row[j];
        row[j] = std::min({substitute, row[j] + 1, row[j - 1] + 1});
      }
    }
    if (row.back() < best_distance) {
      best_distance = row.back();
      best = candidate;
    }
  }
  return best;
}

void demand_failed(const char* condition, const char* function, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: broken contract in %s: %s\n", file, line, function, condition);
  std::abort();
}

}  // namespace bough
