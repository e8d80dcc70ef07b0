#include "analysis/common/subcase_failures.hpp"

#include <algorithm>
#include <set>

#include "analysis/common/failures.hpp"

namespace bough::analysis {

namespace {

constexpr std::size_t kMaxNamed = 10;

std::string name_subcases(const std::vector<int>& ids) {
  std::string text = ids.size() == 1 ? "subcase " : "subcases ";
  for (std::size_t i = 0; i < std::min(ids.size(), kMaxNamed); ++i) text += (i ? ", " : "") + std::to_string(ids[i]);
  if (ids.size() > kMaxNamed) text += " and " + std::to_string(ids.size() - kMaxNamed) + " more";
  return text;
}

}  // namespace

void SubcaseFailures::add(int subcase, const Failure& failure) {
  failed_.emplace_back(subcase, failure.items());
  exit_code_ = std::max(exit_code_, choose_exit_code(failure));
}

std::vector<Diagnostic> SubcaseFailures::get_items(const Diagnostics& prior) const {
  std::set<std::string> known;
  for (const auto& item : prior.items()) known.insert(format(item));
  std::vector<std::pair<Diagnostic, std::vector<int>>> found;
  for (const auto& [id, items] : failed_)
    for (const auto& item : items) {
      const auto text = format(item);
      if (item.severity != Severity::Error && known.count(text) > 0) continue;
      const auto same =
          std::find_if(found.begin(), found.end(), [&](const auto& other) { return format(other.first) == text; });
      auto& ids = same == found.end() ? found.emplace_back(item, std::vector<int>{}).second : same->second;
      if (ids.empty() || ids.back() != id) ids.push_back(id);
    }
  std::vector<Diagnostic> items;
  for (auto& [item, ids] : found) {
    // A message that every subcase gives for one location in the deck concerns the deck.
    const bool is_of_deck = item.severity != Severity::Error || (ids.size() == num_solved_ && item.where.line > 0);
    if (is_named_ && !is_of_deck && ids.front() > 0) item.what = name_subcases(ids) + ": " + item.what;
    items.push_back(std::move(item));
  }
  return items;
}

void SubcaseFailures::throw_all(const Diagnostics& prior) const {
  auto items = prior.items();
  for (auto& item : get_items(prior)) items.push_back(std::move(item));
  if (exit_code_ == 1) throw InputError(std::move(items));
  throw ComputationError(std::move(items));
}

void add_warnings(const Diagnostics& from, Diagnostics& to) {
  Diagnostics warnings;
  for (const auto& item : from.items())
    if (item.severity == Severity::Warning) warnings.add(item);
  add_new(warnings, to);
}

void add_new(const Diagnostics& from, Diagnostics& to) {
  std::set<std::string> known;
  for (const auto& item : to.items()) known.insert(format(item));
  for (const auto& item : from.items())
    if (known.insert(format(item)).second) to.add(item);
}

}  // namespace bough::analysis
