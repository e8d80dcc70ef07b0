#include "analysis/check/check_responses.hpp"

#include <algorithm>
#include <utility>

#include "analysis/check/subcase_models.hpp"
#include "analysis/common/solution.hpp"
#include "analysis/common/subcase_failures.hpp"
#include "modal/complex/complex_modes.hpp"
#include "modal/response/deck_response.hpp"
#include "modal/response/excitation.hpp"
#include "modal/response/frequency_list.hpp"
#include "modal/response/random/random_response.hpp"

namespace bough::analysis {

namespace {

namespace response = modal::response;

/// Returns true if the frequencies of the subcase depend on its modes.
bool follows_modes(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase) {
  const auto& all = deck.dynamics.frequencies;
  return std::any_of(all.begin(), all.end(), [&](const records::FrequencyList& list) {
    return list.sid == subcase.dynamics.frequency && list.kind >= 3;
  });
}

ResponseCheck check_response(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                             const fe::Model& model, const ResponseSolution& solution, Diagnostics& found) {
  ResponseCheck row;
  row.subcase = subcase.id;
  row.is_over_time = solution.is_over_time;
  if (solution.is_over_time) {
    const auto time = response::make_times(deck, subcase, found).time;
    row.num_steps = time.size();
    if (time.size() > 0) row.last = time(time.size() - 1);
  } else if (follows_modes(deck, subcase)) {
    row.follows_modes = true;
  } else if (const auto hz = response::make_frequencies(deck, subcase, {}, found); hz.size() > 0) {
    row.num_steps = hz.size();
    row.first = hz(0);
    row.last = hz(hz.size() - 1);
  }
  if (subcase.dynamics.dload != 0) {
    const auto excitation = response::calc_excitation(model, deck, subcase, solution.is_over_time, found);
    row.num_loads = static_cast<int>(excitation.forces.size());
    row.num_motions = static_cast<int>(excitation.motions.size());
  }
  response::ResponseOptions options;
  options.is_over_time = solution.is_over_time;
  options.is_direct = solution.is_direct;
  options.with_random = subcase.dynamics.random != 0;
  response::choose_damping(deck, subcase, options, model, found);
  found.throw_if_errors();
  response::check_rotors(model, deck, subcase, options, found);
  return row;
}

void check_complex(const records::DynamicDeck& deck, SubcaseModels& models, Diagnostics& diagnostics) {
  SubcaseFailures failures(deck.subcases.size(), deck.subcases.size());
  const auto ids = modal::complex_modes::list_subcases(deck);
  for (const auto& subcase : deck.subcases) {
    if (ids.front() != 0 && std::find(ids.begin(), ids.end(), subcase.id) == ids.end()) continue;
    const auto selection = deck.selections.find(subcase.id);
    const records::DynamicSubcase chosen(
        subcase, selection == deck.selections.end() ? records::DynamicSelection{} : selection->second);
    try {
      modal::complex_modes::choose_method(deck, chosen, 0);
      Diagnostics found;
      modal::complex_modes::check_selections(models.get(chosen), deck, chosen, has_modal_complex_modes(deck.sol),
                                             found);
      found.throw_if_errors();
      add_new(found, diagnostics);
    } catch (const Failure& failure) {
      failures.add(subcase.id, failure);
    }
  }
  for (const auto& item : failures.get_items(diagnostics)) diagnostics.add(item);
}

}  // namespace

std::vector<ResponseCheck> check_responses(const records::DynamicDeck& deck, const fe::Model& model,
                                           const fe::ModelOptions& options, Diagnostics& diagnostics) {
  std::vector<ResponseCheck> rows;
  const auto* solution = find_response_solution(deck.sol);
  SubcaseModels models(deck, model, options);
  if (!solution) {
    if (asks_complex_modes(deck, options.ignore_cards)) check_complex(deck, models, diagnostics);
    return rows;
  }
  std::vector<records::DynamicSubcase> subcases;
  try {
    subcases = response::choose_response_subcases(deck, options.subcase, solution->is_over_time);
    check_nonlinear_transient(deck, subcases.size(), diagnostics);
    if (!solution->is_over_time) {
      Diagnostics found;
      response::RandomAnalysis(deck, subcases, found);
      found.throw_if_errors();
    }
  } catch (const Failure& failure) {
    // A deck that selects no load at all is one for its modes and bodies so far.
    for (auto item : failure.items()) {
      if (item.id == "modal.no-dynamic-load") item.severity = Severity::Warning;
      diagnostics.add(std::move(item));
    }
  }
  SubcaseFailures failures(subcases.size(), deck.subcases.size());
  for (const auto& subcase : subcases) {
    Diagnostics found;
    try {
      rows.push_back(check_response(deck, subcase, models.get(subcase), *solution, found));
      found.throw_if_errors();
      add_new(found, diagnostics);
    } catch (const Failure& failure) {
      failures.add(subcase.id, failure);
    }
  }
  for (const auto& item : failures.get_items(diagnostics)) diagnostics.add(item);
  return rows;
}

}  // namespace bough::analysis
