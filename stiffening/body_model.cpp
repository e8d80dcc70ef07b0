// The model of a body: origin, preload, support.
#include <cstdio>

#include "fe/matrices/connected_parts.hpp"
#include "fe/model/coordinates.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/preload.hpp"
#include "fe/statics/statics.hpp"
#include "modal/bases/fixed_interface.hpp"
#include "stiffening/given_model.hpp"
#include "stiffening/given_rigid.hpp"
#include "stiffening/stages.hpp"

namespace bough::stiffening {

using modal::bases::StaticSolve;
using records::BodyFrame;
using records::BodySpec;
using records::Deck;

fe::ElementFactory BodyRequest::make_factory() const {
  if (!given) return fe::make_elements;
  return [matrices = given](const Deck& points, const fe::NodeTable& nodes, Diagnostics&) {
    return make_given_elements(*matrices, points, nodes);
  };
}

std::optional<Eigen::Vector3d> find_origin(const Deck& deck, const BodySpec& spec) {
  if (spec.origin_node == 0) return spec.origin;
  Diagnostics repeated;  // by the model
  const fe::CoordinateSystems systems(deck, Eigen::Vector3d::Zero(), repeated);
  for (std::size_t i = 0; i < deck.grids.size(); ++i)
    if (deck.grids[i].id == spec.origin_node) return systems.get_grid_position(static_cast<int>(i));
  return {};
}

namespace {

/// The subcase of the body: by default a subcase of modes that names a preload by STATSUB.
int choose_subcase(const BodyRequest& request) {
  if (request.spec.subcase != 0 || request.spec.preload || request.given) return request.spec.subcase;
  for (const auto& subcase : request.deck.subcases)
    if (subcase.preload != 0 && subcase.method != 0) return subcase.id;
  return 0;
}

fe::ModelOptions make_model_options(const BodyRequest& request) {
  fe::ModelOptions options;
  options.subcase = choose_subcase(request);
  options.ignore_spc = request.is_free();
  options.origin = find_origin(request.deck, request.spec);
  options.ignore_cards = request.spec.ignore_cards;
  if (request.spec.mass == "lumped") options.mass_kind = fe::MassKind::Lumped;
  if (request.spec.mass == "consistent") options.mass_kind = fe::MassKind::Consistent;
  if (request.is_free())
    options.adjust_direct = [origin = options.origin.value_or(Eigen::Vector3d::Zero())](
                                const Deck& deck, const fe::Elements& others, fe::ElementList& direct,
                                Diagnostics& diagnostics) {
      restore_direct_stiffness(deck, origin, others, direct, diagnostics);
    };
  return options;
}

std::string describe_preload(const records::PreloadSpec& spec) {
  std::string name;
  const auto add = [&](const std::string& load) { name += (name.empty() ? "" : ", ") + load; };
  if (spec.load_set != 0) add("LOAD " + std::to_string(spec.load_set));
  if (spec.temperature_set != 0) add("TEMPERATURE " + std::to_string(spec.temperature_set));
  if (!spec.spin.isZero(0)) {
    char text[96];
    std::snprintf(text, sizeof text, "spin (%g, %g, %g)", spec.spin.x(), spec.spin.y(), spec.spin.z());
    add(text);
  }
  return name;
}

/// The stress from which the body starts; nullptr: none.
std::shared_ptr<const fe::Prestress> calc_prestress(const BodyRequest& request, fe::ModelOptions options) {
  const Deck& deck = request.deck;
  Diagnostics& diagnostics = request.diagnostics;
  if (request.given) return nullptr;
  if (request.prestress) return request.prestress;
  if (!request.spec.preload) {
    for (const auto& subcase : deck.subcases)
      if (subcase.id == options.subcase && subcase.id != 0)
        return fe::calc_subcase_prestress(deck, options, subcase, diagnostics);
    return nullptr;
  }
  const auto& spec = *request.spec.preload;
  if (spec.subcase != 0) {
    options.prestress =
        fe::calc_subcase_prestress(deck, options, fe::make_elements, spec.subcase, spec.at, diagnostics);
    if (spec.spin.isZero(0)) return options.prestress;
  }
  const fe::Preload preload{spec.load_set, spec.temperature_set, spec.spin, describe_preload(spec), spec.at};
  auto prestress = fe::calc_prestress(deck, options, fe::make_elements, preload, diagnostics);
  diagnostics.note("fe.preload", spec.at, "the stiffness contains the geometric stiffness of " + prestress->name,
                   "displacements and forces count from the loaded state");
  return prestress;
}

/// Dofs of a statically determinate support; none for a fixed body.
std::vector<int> choose_support(const BodyRequest& request, const fe::Model& model) {
  if (!request.is_free()) return {};
  int node = request.spec.support.empty() ? 0 : request.spec.support.front();
  if (request.spec.frame == BodyFrame::Node) node = request.spec.frame_nodes.front();
  return fe::choose_determinate_support(model, node);
}

/// Returns true if the node of the frame depends on others (RBE2, RBE3), so that its dofs cannot be constrained.
bool is_on_dependent_node(const BodySpec& spec, const fe::Model& model) {
  if (spec.frame != BodyFrame::Node) return false;
  const int index = model.find_node(spec.frame_nodes.front());
  for (int c = 1; c <= 6; ++c)
    if (model.find_fdof(index, c) < 0) return true;
  return false;
}

}  // namespace

fe::DeformedPreload calc_nonlinear_preload(const BodyRequest& request) {
  const auto& spec = *request.spec.preload;
  const fe::ModelOptions options = make_model_options(request);
  auto result = spec.subcase != 0
                    ? fe::calc_nonlinear_preload(request.deck, options, spec.subcase, spec.at, request.diagnostics)
                    : fe::calc_nonlinear_preload(
                          request.deck, options,
                          fe::Preload{spec.load_set, spec.temperature_set, spec.spin, describe_preload(spec), spec.at},
                          request.diagnostics);
  char moved[32];
  std::snprintf(moved, sizeof moved, "%.4g", result.max_displacement);
  request.diagnostics.note(
      "fe.preload", spec.at,
      "the body has the shape and the stress of " + result.prestress->name + ", largest displacement " + moved,
      "displacements and forces count from the loaded state");
  return result;
}

/// A second model where the first one has to exist before: its mass gives the centre of mass that is the origin (the
/// elements contain positions), and AUTOSPC and the a-set depend on the stiffness of the preload.
BodyModel build_body_model(const BodyRequest& request) {
  const auto factory = request.make_factory();
  BodyModel result;
  result.options = make_model_options(request);
  auto model = fe::build_model(request.deck, result.options, factory, request.diagnostics);
  if (request.moves_to_frame()) modal::bases::calc_reference_conditions(model, make_frame_spec(request.spec));
  const bool is_at_mass_centre = request.spec.origin_at_mass_centre;
  if (is_at_mass_centre)
    result.options.origin = fe::calc_mass_properties(model, model.mass_kind(), Eigen::Vector3d::Zero()).cg;
  result.options.prestress = calc_prestress(request, result.options);
  if (is_at_mass_centre || result.options.prestress) {
    Diagnostics repeated;  // those of the first model
    model = fe::build_model(request.deck, result.options, factory, repeated);
  }
  result.model = std::make_unique<const fe::Model>(std::move(model));
  result.system = std::make_unique<const fe::System>(*result.model);
  return result;
}

void add_mechanism_error(const BodyRequest& request, const fe::Model& model, const std::string& message) {
  if (const auto loose = fe::describe_loose_parts(model); !loose.what.empty())
    request.error_at("frame", "reduce.mechanism", loose.what, loose.advice);
  else if (request.is_free())
    request.error_at("frame", "reduce.mechanism", "besides the six rigid-body motions of a free body, " + message,
                     "tie the loose parts or constrain the free dofs");
  else
    request.error_at("frame", "reduce.mechanism", "the constraints do not hold the fixed body: " + message,
                     "complete the SPC set and select it in the case control, or use frame = \"free\" (--free)");
}

StaticSupport make_static_support(const BodyRequest& request, const fe::System& system) {
  const fe::Model& model = system.model;
  try {
    if (is_on_dependent_node(request.spec, model)) {
      const auto fixed =
          std::make_shared<modal::bases::FixedInterface>(system, request.spec.frame_nodes, request.diagnostics);
      return {[fixed](const MatrixXd& F) { return fixed->solve(F); }, nullptr};
    }
    const auto solver = std::make_shared<fe::StaticSolver>(model, system.K, choose_support(request, model));
    return {[solver](const MatrixXd& F) { return solver->solve(F); }, solver->find_definite_factor()};
  } catch (const ComputationError& error) {
    // A deck with a mechanism is wrong input here: the dofs that the factorization names, and the needs of a body.
    const auto& id = error.items().front().id;
    const bool is_mechanism = id == "fe.mechanism" || id == "modal.interface-mechanism";
    if (is_mechanism) add_mechanism_error(request, model, "the stiffness matrix is singular");
    for (auto item : error.items()) {
      if (item.where.file.empty()) item.where = request.deck.locate({0, 0});
      request.diagnostics.add(std::move(item));
    }
    if (!is_mechanism) throw;
    throw InputError(request.diagnostics.items());
  }
}

}  // namespace bough::stiffening
