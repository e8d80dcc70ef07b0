#include "analysis/reduce/reduce_body.hpp"

#include <filesystem>
#include <limits>
#include <optional>

#include "analysis/common/choices.hpp"
#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/solution.hpp"
#include "analysis/common/system_files.hpp"
#include "analysis/listing/listing.hpp"
#include "analysis/reduce/matrix_files.hpp"
#include "analysis/reduce/point_files.hpp"
#include "fe/linear/petsc.hpp"
#include "fe/model/model.hpp"
#include "formats/toml/specs.hpp"
#include "modal/response/residual_modes.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

namespace {

/// RESVEC of the deck, as `modes` has it: loads of the subcase, unit forces of USETi and RVDOFi. Only for a deck on the
/// command line, a body file specifies the contents of the body. Empty if the deck does not request them.
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

/// "[NAME=]NODE:DIRECTIONS", "[NAME=]set:ID" or "[NAME=]temperature:ID".
records::ExternalLoadSpec parse_load(const std::string& text) {
  const auto fail = [&]() -> InputError {
    return {"cli.bad-load",
            {},
            "cannot read --load \"" + text + "\"",
            "write NODE:DIRECTIONS such as 41:2 or 41:123, set:ID or temperature:ID; NAME= may come before"};
  };
  records::ExternalLoadSpec load;
  std::string rest = text;
  if (const auto equals = rest.find('='); equals != std::string::npos) {
    load.name = rest.substr(0, equals);
    rest.erase(0, equals + 1);
  }
  const auto colon = rest.find(':');
  if (colon == std::string::npos || colon + 1 == rest.size()) throw fail();
  const auto before = rest.substr(0, colon), after = rest.substr(colon + 1);
  const auto is_number = [](const std::string& s) {
    return !s.empty() && s.size() < 9 && s.find_first_not_of("0123456789") == std::string::npos;
  };
  if (!is_number(after)) throw fail();
  if (before == "set") {
    load.load_set = std::stoi(after);
  } else if (before == "temperature") {
    load.temperature_set = std::stoi(after);
  } else {
    if (!is_number(before)) throw fail();
    load.node = std::stoi(before);
    for (char c : after) {
      if (c < '1' || c > '6') throw fail();
      load.directions.push_back(c - '0');
    }
  }
  if (load.name.empty()) load.name = "load " + rest;
  return load;
}

void add_matrices(const ReduceRequest& request, records::BodySpec& spec) {
  if (request.matrices.empty()) return;
  if (!spec.matrices) spec.matrices.emplace();
  // The common file first: ":NAME" of the others is in it.
  for (const bool is_file : {true, false})
    for (const auto& text : request.matrices)
      if ((text.find('=') == std::string::npos) == is_file) add_matrices_option(text, *spec.matrices);
  if (spec.name.empty())
    spec.name = fs::path(spec.matrices->file.empty() ? spec.matrices->stiffness.file : spec.matrices->file).stem();
}

void check_values(const ReduceRequest& request) {
  if (request.num_modes) demand_range("--modes", *request.num_modes, 0, std::numeric_limits<int>::max());
  if (request.max_hz) demand_positive("--max-hz", *request.max_hz);
  if (request.damping) demand_positive("--damping", *request.damping, true);
  if (!request.mass.empty()) demand_word("--mass", request.mass, {"deck", "lumped", "consistent"});
  if (!request.integrals.empty()) demand_word("--integrals", request.integrals, {"exact", "consistent", "lumped"});
  for (const double coordinate : request.origin) demand_finite("--origin", coordinate);
  if (!request.origin.empty() && request.origin.size() != 3)
    throw InputError("cli.bad-option", {}, fmt::format("--origin has {} numbers", request.origin.size()),
                     "give three: X Y Z");
}

records::BodySpec make_spec(const ReduceRequest& request, Diagnostics& diagnostics) {
  check_values(request);
  records::BodySpec spec;
  const bool is_toml = has_suffix(request.file, ".toml");
  if (is_toml) {
    do_once([&] { demand_kind(request.file, toml_files::detect_kind(request.file), "body"); });
    spec = read_body_spec_once(request.file, diagnostics);
    diagnostics.throw_if_errors();
    if (!spec.deck.empty()) spec.deck = resolve_beside(request.file, spec.deck);
    add_matrices(request, spec);
  } else {
    if (!request.file.empty()) do_once([&] { demand_deck(request.file); });
    spec.deck = request.file;
    spec.name = fs::path(request.file).stem().string();
    add_matrices(request, spec);
    const bool has_modes = spec.matrices && !spec.matrices->modes.empty();
    if (!request.num_modes && !request.max_hz && !has_modes) {
      throw InputError("cli.no-modes", {request.file}, "the number of modes is not given",
                       "add --modes N or --max-hz F");
    }
  }
  if (!request.name.empty()) spec.name = request.name;
  if (request.num_modes) spec.num_modes = *request.num_modes;
  if (request.max_hz) spec.max_frequency_hz = request.max_hz;
  if (request.free) spec.frame = records::BodyFrame::Free;
  if (!request.interface_nodes.empty()) spec.interface_nodes = request.interface_nodes;
  for (const auto& load : request.loads) spec.loads.push_back(parse_load(load));
  if (request.full) spec.full = *request.full;
  if (!request.recover.empty()) spec.recover = request.recover;
  if (request.strain_energy) spec.strain_energy = true;
  if (!request.mass.empty()) spec.mass = request.mass;
  if (!request.integrals.empty()) spec.integrals = request.integrals;
  if (!request.origin.empty()) spec.origin = records::Vector3d(request.origin[0], request.origin[1], request.origin[2]);
  spec.ignore_cards.insert(spec.ignore_cards.end(), request.ignore_cards.begin(), request.ignore_cards.end());
  if (request.subcase > 0) spec.subcase = request.subcase;
  if (request.damping) {
    spec.damping_ratio = *request.damping;
    spec.damping_ratios.clear();
  }
  return spec;
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

Reduced reduce_body(const ReduceRequest& request, const std::function<void(const records::BodySpec&)>& check_spec,
                    Events& events) {
  if (!request.file.empty()) do_once([&] { demand_file(request.file); });
  Diagnostics diagnostics;
  const auto spec = make_spec(request, diagnostics);
  if (check_spec) check_spec(spec);
  linear::initialize_petsc();
  stiffening::ReduceOptions options;
  options.progress = [&](const std::string& stage) { events.show_progress("reduce: " + stage); };
  if (!request.solver.empty()) options.solver = modal::find_eps_type(request.solver);
  auto reduced = reduce_body(spec, options, diagnostics);
  events.show_progress("");
  diagnostics.throw_if_errors();
  add_messages(diagnostics, events);
  return reduced;
}

}  // namespace bough::analysis
