#include "cli/reduce/reduce_body.hpp"

#include "cli/common/options.hpp"
#include "cli/common/solution.hpp"
#include "cli/reduce/matrix_files.hpp"
#include "cli/reduce/point_files.hpp"
#include "cli/verbs.hpp"
#include "fe/model/model.hpp"

namespace bough::cli {

namespace {

Reduced reduce_deck(const records::BodySpec& spec, const stiffening::ReduceOptions& options,
                    std::vector<std::string>& files, Diagnostics& diagnostics) {
  fe::ModelOptions model_options;
  model_options.subcase = spec.subcase;
  model_options.ignore_cards = spec.ignore_cards;
  const auto deck = read_deck_or_throw(spec.deck, model_options, diagnostics);
  note_solution(deck, diagnostics);
  Reduced result;
  files = deck.files;
  say_first(diagnostics, [&] { result.body = stiffening::reduce(deck, spec, options, diagnostics); });
  return result;
}

Reduced reduce_given(const records::BodySpec& spec, const stiffening::ReduceOptions& options,
                     std::vector<std::string>& files, Diagnostics& diagnostics) {
  const auto deck = read_points(spec, diagnostics);
  Reduced result;
  files = deck.files;
  const auto given = read_given_matrices(*spec.matrices, deck, files, diagnostics);
  // What is wrong with the numbers is wrong in this file and not in the points.
  const auto& matrices = *spec.matrices;
  const auto reduce = [&] {
    say_first(diagnostics, [&] { result.body = stiffening::reduce_matrices(deck, spec, given, options, diagnostics); });
    return kSuccess;
  };
  blame(matrices.file.empty() ? matrices.stiffness.file : matrices.file, reduce,
        deck.files.empty() ? "" : deck.files.front());
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

}  // namespace bough::cli
