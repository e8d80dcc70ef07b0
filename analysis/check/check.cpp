#include "analysis/check/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/check/check_responses.hpp"
#include "analysis/check/check_solutions.hpp"
#include "analysis/check/check_subcases.hpp"
#include "analysis/check/try_reduction.hpp"
#include "analysis/common/body_files.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/solution.hpp"
#include "fe/linear/factor.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/matrices/checks.hpp"
#include "fe/matrices/connected_parts.hpp"
#include "fe/matrices/mass_directions.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/preload.hpp"
#include "formats/flx/flx_file.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/nastran/reader.hpp"
#include "formats/records/params.hpp"
#include "formats/toml/specs.hpp"
#include "solver/bodies/body.hpp"
#include "solver/bodies/soft_energy.hpp"
#include "solver/simulate/modal_range_monitor.hpp"
#include "solver/simulate/simulate.hpp"

namespace bough::analysis {

namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;

/// Grid of the weight table: from the command line, else from PARAM,GRDPNT, whose negative value requests no table.
std::optional<int> choose_weight_grid(const CheckRequest& request, const records::Deck& deck,
                                      Diagnostics& diagnostics) {
  if (request.weight_grid) return request.weight_grid;
  if (!deck.find_param("GRDPNT")) return std::nullopt;
  const double value = records::get_real_param(deck, "GRDPNT", -1, diagnostics);
  return value < 0 ? std::nullopt : std::optional<int>(static_cast<int>(std::min(value, 1e9)));
}

/// A deck with errors is still taken as far as it goes, so that one pass shows all of them.
void check_model(const CheckRequest& request, fe::ModelOptions model_options, DeckCheck& check,
                 Diagnostics& diagnostics) {
  const auto& deck = check.deck;
  model_options.uses_enforced = true;
  fe::check_preloads(deck, diagnostics);
  note_solution(deck, diagnostics);
  auto built = fe::build_model(deck, model_options, diagnostics);
  if (diagnostics.num_errors() > 0) return;
  check.model.emplace(std::move(built));
  const auto& model = *check.model;
  check.mass = fe::calc_mass_properties(model, model.mass_kind(), Vector3d::Zero());
  if (check.mass.rigid_mass.isZero(0)) {
    const auto M = fe::assemble_mass(model, fe::DofSet::Global, model.mass_kind());
    if (model.num_gdofs() > 0 && linear::get_diagonal(M).maxCoeff() > 0)
      diagnostics.note("cli.no-mass", deck.locate({}), "the only mass is at scalar points, which have no place",
                       "modes are right; a body needs mass at grids");
    else
      diagnostics.note("cli.no-mass", deck.locate({}), "the model has no mass",
                       "for modes and bodies give RHO in MAT1, NSM in a property, or CONM2 and CMASS cards");
  }
  fe::report_mass(model, deck, check.mass, diagnostics);
  if (const auto loose = fe::describe_loose_parts(model); !loose.what.empty())
    diagnostics.warning("fe.loose-parts", deck.locate({}), loose.what, loose.advice);
  check.ground = {fe::calc_ground_check(model, fe::GroundSet::Global),
                  fe::calc_ground_check(model, fe::GroundSet::Independent),
                  fe::calc_ground_check(model, fe::GroundSet::Free)};
  for (const auto& superelement : deck.superelements)
    check.superelements.push_back(fe::check_superelement(deck, superelement, diagnostics));
  if (const auto grid = choose_weight_grid(request, deck, diagnostics)) {
    auto weight_grid = *grid;
    if (weight_grid > 0 && model.find_node(weight_grid) < 0 && !request.weight_grid) {
      diagnostics.warning("cli.no-weight-grid", deck.locate(deck.find_param("GRDPNT")->at),
                          fmt::format("PARAM,GRDPNT names grid {}, which the deck does not define", weight_grid),
                          "the weight table is about the origin");
      weight_grid = 0;
    }
    check.weight = fe::calc_grid_point_weight(model, weight_grid);
  }
  check.subcases = check_subcases(deck, model, model_options, diagnostics);
}

CheckAnswer check_deck(const CheckRequest& request, CheckEvents& events) {
  do_once([&] { demand_deck(request.file); });
  events.set_rank(linear::initialize_petsc().rank);
  CheckAnswer answer;
  DeckCheck check;
  const auto model_options = make_model_options(request.model);
  Diagnostics of_statics;
  check.deck = read_deck_once(request.file, request.model.ignore_cards, of_statics);
  const bool is_response = find_response_solution(check.deck.sol) != nullptr;
  const bool is_complex = asks_complex_modes(check.deck, request.model.ignore_cards);
  if (is_response || is_complex) {
    const auto deck =
        read_dynamic_deck_once(request.file, {request.model.ignore_cards, is_response, is_complex}, answer.messages);
    check.deck = deck;
    check_model(request, model_options, check, answer.messages);
    if (check.model) check.responses = check_responses(deck, *check.model, model_options, answer.messages);
  } else {
    for (const auto& item : of_statics.items()) answer.messages.add(item);
    check_model(request, model_options, check, answer.messages);
  }
  answer.content = std::move(check);
  return answer;
}

/// Reports errors that `reduce` would find after its factorizations, as far as rigid-body modes show them: a free body
/// that is constrained, a fixed one that is not. Internal mechanisms are found by `reduce` alone.
void check_support(const CheckRequest& request, bool is_free, const DeckCheck& check, Diagnostics& diagnostics) {
  if (!check.model) return;
  const auto calc_largest = [](const Eigen::Matrix<double, 6, 1>& energies) {
    double largest = 0;
    for (const double x : energies) largest = std::max(largest, std::isfinite(x) ? x : 0.0);
    return largest;
  };
  if (is_free && calc_largest(check.ground.n) > 1e-8)
    diagnostics.error(
        "reduce.grounded", {request.file},
        fmt::format("a free body must have 6 rigid-body motions, this model strains in them: {:.1e} of what "
                    "its stiffness allows",
                    calc_largest(check.ground.n)),
        "remove springs and bushes to ground, and CELASi between grids that lie apart (they hold rotations), "
        "or use frame = \"fixed\"");
  if (!is_free && check.model->num_fdofs() > 0 && calc_largest(check.ground.f) < 1e-12)
    diagnostics.error("reduce.mechanism", {request.file},
                      "the constraints do not hold the fixed body: no rigid-body motion of it strains it",
                      "complete the SPC set and select it in the case control, or use frame = \"free\" (--free)");
}

CheckAnswer check_body(const CheckRequest& request, CheckEvents& events) {
  events.set_rank(linear::initialize_petsc().rank);
  CheckAnswer answer;
  auto& diagnostics = answer.messages;
  BodyCheck check;
  check.spec = read_body_spec_once(request.file, diagnostics);
  const auto& spec = check.spec;
  const auto deck_path = resolve_beside(request.file, spec.deck);
  if (!spec.deck.empty()) {
    do_once([&] { demand_file(deck_path); });
    auto& deck = check.deck.emplace();
    deck.deck = read_deck_once(deck_path, spec.ignore_cards, diagnostics);
    auto model_options = make_model_options(request.model);
    model_options.subcase = spec.subcase;
    model_options.ignore_spc = spec.frame != records::BodyFrame::Fixed;
    model_options.origin = spec.origin;
    model_options.ignore_cards = spec.ignore_cards;
    check_model(request, model_options, deck, diagnostics);
    if (diagnostics.num_errors() == 0) check_support(request, model_options.ignore_spc, deck, diagnostics);
    for (int id : spec.interface_nodes) {
      const bool found =
          std::any_of(deck.deck.grids.begin(), deck.deck.grids.end(), [&](const auto& g) { return g.id == id; });
      if (!found && diagnostics.num_errors() == 0) {
        diagnostics.error("cli.unknown-interface", {request.file},
                          fmt::format("interface node {} is not a grid of {}", id, spec.deck),
                          "name a GRID of the deck");
      }
    }
  }
  if (diagnostics.num_errors() == 0)
    try_reduction(request.file, spec, check.deck && check.deck->model ? check.deck->model->num_fdofs() : 0,
                  diagnostics);
  answer.content = std::move(check);
  return answer;
}

CheckAnswer check_system(const CheckRequest& request) {
  CheckAnswer answer;
  auto loaded = load_system(request.file, answer.messages, {}, request.set);
  solver::check_start(loaded.system, loaded.spec, answer.messages);
  answer.content = SystemCheck{std::move(loaded)};
  return answer;
}

/// Size of /third_order of a body in kB, if it has the fields of a body in space.
double calc_third_order_size(const records::FlexBody& body, int num_large) {
  constexpr double kNumFields = 14;
  const int n = body.num_modes();
  double numbers = 6 * kNumFields * body.num_nodes() + 12 * (n + kNumFields) * (n + kNumFields);
  for (int k = 3; k <= records::ThirdOrder::kMaxEnergy; ++k) numbers += records::count_monomials(num_large, k);
  for (int k = 2; k <= records::ThirdOrder::kMaxField; ++k)
    numbers += records::count_monomials(k == 2 ? n : num_large, k) *
               (kNumFields + 6.0 * static_cast<double>(body.interface_nodes.size()) +
                static_cast<double>(body.locators.size()));
  return 8e-3 * numbers;
}

std::optional<FlexBodyCheck::Reach> find_reach(const records::FlexBody& record) {
  if (record.next_order.empty()) return {};
  constexpr int kMaxLarge = 6;  // that reduce selects
  const auto body = solver::Body::make_flexible(record, -1, true, {});
  FlexBodyCheck::Reach reach;
  reach.mode = record.next_order.modes.front();
  const solver::Node* node = nullptr;
  const auto calc_way = [&](const solver::Node& at) { return at.phi.col(reach.mode).norm(); };
  for (const auto& one : body.nodes())
    if (one.moves && (!node || calc_way(one) > calc_way(*node))) node = &one;
  if (!node || !(calc_way(*node) > 0)) return {};
  const Eigen::VectorXd shape = Eigen::VectorXd::Unit(body.num_modes(), reach.mode) / calc_way(*node);
  const auto is_inside = [&](double way) {
    return body.soft_energy()->calc_error(*node, body.K(), way * shape) < solver::kNextOrderLimit;
  };
  double inside = 0, outside = 1e-12;
  for (int i = 0; i < 200 && is_inside(outside); ++i) outside *= 2;
  if (is_inside(outside)) return {};
  for (int i = 0; i < 200 && outside - inside > 1e-3 * outside; ++i)
    (is_inside(0.5 * (inside + outside)) ? inside : outside) = 0.5 * (inside + outside);
  reach.node = node->id;
  reach.deflection = outside;
  reach.num_large = std::min<int>(
      kMaxLarge, static_cast<int>(std::count(record.kind.begin(), record.kind.end(), records::ModeKind::Normal)));
  reach.file_kilobytes = calc_third_order_size(record, reach.num_large);
  reach.evaluation_microseconds = 0.4 + 1.6 * records::count_monomials(reach.num_large, 4) / 126;
  return reach;
}

FlexBodyCheck check_flex_body(const std::string& path, Diagnostics& diagnostics) {
  const auto body = read_body(path, diagnostics);
  FlexBodyCheck check{body.name,
                      0,
                      body.mass,
                      body.frequency_hz,
                      body.num_nodes(),
                      0,
                      body.interface_nodes.size(),
                      body.locators.size(),
                      0,
                      body.third_order.large,
                      find_reach(body)};
  for (bool flag : body.kg_inertial_computed) check.num_kg_inertial += flag ? 1 : 0;
  auto& worst = check.kg_asymmetry;
  for (const auto& list : {std::vector<MatrixXd>(body.kg_inertial.begin(), body.kg_inertial.end()), body.kg_external}) {
    for (const auto& kg : list) {
      if (kg.size() > 0) worst = std::max(worst, (kg - kg.transpose()).norm() / std::max(kg.norm(), 1e-300));
    }
  }
  if (worst > 1e-6)
    diagnostics.error("cli.bad-body", {path}, fmt::format("geometric stiffness is not symmetric, {:.1e}", worst),
                      "reduce the body again");
  return check;
}

ResultsCheck check_results(const std::string& path, Diagnostics& diagnostics) {
  const auto results = hdf5::read_results(path);
  const auto nt = results.time.size();
  for (const auto& [name, values] : results.channels) {
    if (!values.allFinite()) {
      diagnostics.error("cli.not-finite", {path}, "channel " + name + " holds values that are not finite",
                        "look at the sample before the first of them");
    }
  }
  if (!results.completed) {
    diagnostics.warning("cli.incomplete-run", {path}, "the run did not complete",
                        "continue it with bough run --resume");
  }
  return {nt,
          nt ? results.time[0] : 0.0,
          nt ? results.time[nt - 1] : 0.0,
          results.channels.size(),
          results.completed,
          results.reason};
}

/// Every body of the file, or the one that its name chooses.
FlxCheck check_flx(const std::string& file, Diagnostics& diagnostics) {
  FlxCheck bodies;
  const auto name = flx::parse_flx_name(file).value_or(flx::FlxName{});
  for (const auto& body : flx::read_flx_bodies(name.path)) {
    if (name.body_id > 0 && name.body_id != body.body_id) continue;
    bodies.push_back(check_flex_body(name.path + ":" + std::to_string(body.body_id), diagnostics));
    bodies.back().body_id = body.body_id;
  }
  if (bodies.empty()) flx::read_flx(name.path, name.body_id);  // says which there are
  return bodies;
}

CheckAnswer check_hdf5(const std::string& file) {
  CheckAnswer answer;
  auto& diagnostics = answer.messages;
  const auto info = hdf5::read_info(file);
  const auto found = info.attributes.find("format");
  const auto format = found == info.attributes.end() ? std::string() : found->second;
  if (format == "bough-flexbody") {
    answer.content = check_flex_body(file, diagnostics);
  } else if (format == "bough-results") {
    answer.content = check_results(file, diagnostics);
  } else if (format == "bough-modes") {
    const auto modes = hdf5::read_modes(file);
    answer.content = ModesCheck{modes.residual.size(), modes.node_id.size(), modes.num_rigid_modes};
  } else if (format == "bough-static") {
    answer.content = check_static(file, info, diagnostics);
  } else if (format == "bough-matrices") {
    answer.content = check_matrices(file, info, diagnostics);
  } else if (format == "bough-linear") {
    const auto model = hdf5::read_linear_model(file);
    answer.content = LinearCheck{model.states.size(), model.inputs.size(), model.outputs.size(), model.time,
                                 std::max(model.error, model.difference)};
  } else if (format.starts_with("bough-")) {
    diagnostics.error("cli.unknown-format", {file},
                      "there is nothing that check looks at in a file of format \"" + format + "\"",
                      "bough info FILE lists what is in it; bough report FILE makes a page of it");
  } else {
    diagnostics.error("cli.unknown-format", {file},
                      "an HDF5 file without a format of Bough" +
                          (found == info.attributes.end() ? std::string() : ", found \"" + format + "\""),
                      "expected bough-flexbody, bough-modes, bough-results, bough-static, bough-linear or "
                      "bough-matrices");
  }
  return answer;
}

}  // namespace

Eigen::Matrix3d calc_central_inertia(const records::MassProperties& p) {
  const Vector3d c = p.cg - p.reference;
  return p.inertia - p.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
}

Vector3d calc_principal_inertias(const records::MassProperties& properties) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(calc_central_inertia(properties)).eigenvalues();
}

CheckAnswer check_file(const CheckRequest& request, CheckEvents& events) {
  do_once([&] { demand_body_file(request.file); });
  CheckAnswer answer;
  if (is_flat(request.file)) {
    answer.content = check_flex_body(request.file, answer.messages);
    return answer;
  }
  if (is_flx(request.file)) {
    answer.content = check_flx(request.file, answer.messages);
    return answer;
  }
  if (has_suffix(request.file, ".h5") || has_suffix(request.file, ".hdf5")) return check_hdf5(request.file);
  if (has_suffix(request.file, ".toml")) {
    const auto kind = share([&] { return toml_files::detect_kind(request.file); });
    if (kind == "body") return check_body(request, events);
    demand_kind(request.file, kind, "system");
    return check_system(request);
  }
  return check_deck(request, events);
}

}  // namespace bough::analysis
