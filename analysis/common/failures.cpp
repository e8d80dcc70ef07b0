#include "analysis/common/failures.hpp"

#include <algorithm>

#include "analysis/common/subcase_failures.hpp"

namespace bough::analysis {

int choose_exit_code(const Failure& failure) {
  // Both are found by the computation, and both are mended in the deck.
  const bool is_input = std::any_of(failure.items().begin(), failure.items().end(), [](const auto& item) {
    return item.id == "fe.mechanism" || item.id == "modal.no-mass";
  });
  return is_input ? 1 : failure.exit_code();
}

Diagnostic locate(Diagnostic diagnostic, const std::string& file) {
  if (diagnostic.where.file.empty() && !diagnostic.id.starts_with("cli.")) diagnostic.where.file = file;
  return diagnostic;
}

int with_file(const std::string& file, const std::function<int()>& act, const std::string& excluded_file) {
  const auto is_of_reduce = [](const Diagnostic& item) { return item.id.starts_with("reduce."); };
  const auto place = [&](const Failure& failure) {
    auto items = failure.items();
    for (auto& item : items) {
      if (!excluded_file.empty() && item.where.file == excluded_file && item.where.line == 0 && !is_of_reduce(item))
        item.where.file.clear();
      item = locate(std::move(item), file);
    }
    return items;
  };
  try {
    return act();
  } catch (const InputError& failure) {
    throw InputError(place(failure));
  } catch (const ComputationError& failure) {
    throw ComputationError(place(failure));
  }
}

void with_prior_messages(const Diagnostics& prior, const std::function<void()>& act) {
  const auto join = [&prior](const Failure& failure) {
    Diagnostics own, all;
    for (const auto& item : failure.items()) own.add(item);
    add_new(prior, all);
    add_new(own, all);
    return all.items();
  };
  try {
    act();
  } catch (const InputError& failure) {
    throw InputError(join(failure));
  } catch (const ComputationError& failure) {
    throw ComputationError(join(failure));
  }
}

}  // namespace bough::analysis
