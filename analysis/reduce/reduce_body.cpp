#include "analysis/reduce/reduce_body.hpp"

#include <optional>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/solution.hpp"
#include "analysis/listing/listing.hpp"
#include "analysis/reduce/matrix_files.hpp"
#include "analysis/reduce/point_files.hpp"
#include "fe/model/model.hpp"
#include "modal/response/residual_modes.hpp"

namespace bough::analysis {

namespace {

/// RESVEC of the deck, as `modes` has it: loads of the subcase, unit forces of USETi and RVDOFi. Only for a deck on the
/// command line, a body file says itself what is in the body. Empty where the deck does not ask for them.
std::optional<records::DynamicDeck> read_residuals(const records::BodySpec& spec, const fe::ModelOptions& model_options,
                                                   const records::Deck& deck, records::DynamicSelection& selection,
                                                   Diagnostics& diagnostics) {
  if (!spec.file.empty() || spec.basis != records::BodyBasis::Normal || !spec.residual.empty()) return {};
  Diagnostics ignored;  // about output requests, of which reduce has none
  const auto requests = read_requests_once(spec.deck, ignored);
  const int first = deck.subcases.empty() ? 0 : deck.subcases.front().id;
  const auto* found = find_selection(requests, spec.subcase != 0 ? spec.subcase : first);
  if (!found || !modal::response::asks_residual_vectors(deck, *found)) return {};
  selection = *found;
  return read_loads_deck_or_throw(spec.deck, model_options, false, diagnostics);
}

Reduced reduce_deck(const records::BodySpec& spec, const stiffening::ReduceOptions& options,
                    std::vector<std::string>& files, Diagnostics& diagnostics) {
  fe::ModelOptions model_options;
  model_options.subcase = spec.subcase;
  model_options.ignore_cards = spec.ignore_cards;
  const auto deck = read_deck_or_throw(spec.deck, model_options, diagnostics);
  note_solution(deck, diagnostics);
  records::DynamicSelection selection;
  Diagnostics loads_said;  // the cards of the model are reported above
  const auto loads_deck = read_residuals(spec, model_options, deck, selection, loads_said);
  auto own = options;
  if (loads_deck)
    own.residual_loads = [&](const fe::Model& model) {
      auto loads = modal::response::collect_residual_loads(
          model, *loads_deck, records::DynamicSubcase(model.subcase(), selection), diagnostics);
      diagnostics.throw_if_errors();
      return loads;
    };
  files = deck.files;
  stiffening::ReducedBody reduced;
  with_prior_messages(diagnostics, [&] { reduced = stiffening::reduce(deck, spec, own, diagnostics); });
  return {std::move(reduced.body), std::move(reduced.check), {}};
}

Reduced reduce_given(const records::BodySpec& spec, const stiffening::ReduceOptions& options,
                     std::vector<std::string>& files, Diagnostics& diagnostics) {
  const auto deck = read_points(spec, diagnostics);
  files = deck.files;
  const auto given = read_given_matrices(*spec.matrices, deck, files, diagnostics);
  // Faults of the matrices are faults of this file, not of the points.
  const auto& matrices = *spec.matrices;
  stiffening::ReducedBody reduced;
  const auto reduce = [&] {
    with_prior_messages(diagnostics,
                        [&] { reduced = stiffening::reduce_matrices(deck, spec, given, options, diagnostics); });
    return 0;
  };
  with_file(matrices.file.empty() ? matrices.stiffness.file : matrices.file, reduce,
            deck.files.empty() ? "" : deck.files.front());
  Reduced result{std::move(reduced.body), std::move(reduced.check), {}};
  if (spec.matrices->check_modes.empty()) return result;
  const auto others = read_given_modes(spec.matrices->check_modes, *spec.matrices, deck, diagnostics);
  result.check = stiffening::compare_modes(result.body, deck, others, diagnostics);
  return result;
}

}  // namespace

Reduced reduce_body(const records::BodySpec& spec, const stiffening::ReduceOptions& options, Diagnostics& diagnostics) {
  std::vector<std::string> files;
  auto result =
      spec.matrices ? reduce_given(spec, options, files, diagnostics) : reduce_deck(spec, options, files, diagnostics);
  if (!spec.file.empty()) files.insert(files.begin(), spec.file);
  result.body.source = calc_sources(files);
  return result;
}

}  // namespace bough::analysis
