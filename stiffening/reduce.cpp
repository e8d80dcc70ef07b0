#include "bough/stiffening/reduction.hpp"

#include <set>

#include "bough/fe/factor.hpp"
#include "bough/modal/integrals.hpp"

namespace bough::stiffening {

using records::BodyFrame;
using records::BodySpec;
using records::FlexBody;

void Reduction::set_rigid_part(const fe::Model& model) {
  const auto properties = fe::calc_mass_properties(model, model.mass_kind(), Eigen::Vector3d::Zero());
  body_.name = spec_.name;
  body_.mass = properties.mass;
  body_.cg = properties.cg;
  body_.inertia = properties.inertia;
  if (!(body_.mass > 0)) {
    diagnostics_.error("reduce.no-mass", where(), "the translations of the grids carry no mass: this is no body",
                       "give RHO, NSM or CONM2 cards; scalar points and CMASS between them are in no place");
    diagnostics_.throw_if_errors();
  }
  body_.is_free_free = is_free() && spec_.frame != BodyFrame::Node && spec_.frame != BodyFrame::ThreeNodes;
}

void Reduction::set_nodes(const fe::Model& model) {
  std::vector<int> ids;
  std::set<int> seen;
  const auto add = [&](int id) {
    if (seen.insert(id).second) ids.push_back(id);
  };
  for (const int id : spec_.output_nodes) add(id);
  if (spec_.output_nodes.empty())
    for (const auto& node : model.nodes())
      if (node.num_dofs == 6) add(node.id);
  for (const int id : spec_.interface_nodes) add(id);
  body_.node_id = ids;
  body_.node_xyz.resize(static_cast<Eigen::Index>(ids.size()), 3);
  body_.phi.clear();
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const auto& node = model.node(model.find_node(ids[k]));
    body_.node_xyz.row(static_cast<Eigen::Index>(k)) = node.x.transpose();
    body_.phi.push_back(Phi_.middleRows(node.first_gdof, 6));
  }
  body_.mesh = model.calc_mesh();
  body_.dof_map = model.calc_dof_map();
  if (spec_.full) body_.full_phi = Phi_;
}

/// What needs M on the g-set, assembled once: many products are cheaper so than element by element.
void Reduction::set_integrals(const fe::Model& model) {
  const auto kind = model.mass_kind();
  const bool is_lumped = kind == fe::MassKind::Lumped;
  const auto dofs = modal::NodalDofs::from_model(model);
  const fe::PetscMat M = fe::assemble_mass(model, fe::DofSet::Global, kind);
  const auto mass_times = [&M](const MatrixXd& X) { return fe::multiply(M.get(), X); };
  (is_lumped ? body_.lumped : body_.consistent) = modal::calc_momentum_integrals(dofs, mass_times, Phi_);
  (is_lumped ? body_.consistent : body_.lumped) =
      modal::calc_momentum_integrals(model, is_lumped ? fe::MassKind::Consistent : fe::MassKind::Lumped, Phi_);
  body_.exact = modal::calc_exact_integrals(dofs, mass_times, Phi_);
  body_.integrals_method = spec_.integrals;
  body_.effective_mass = modal::calc_effective_mass(model, Phi_, mass_times(Phi_));
  body_.F_I = calc_inertial_loads(dofs, mass_times(dofs.calc_rigid_modes()));
}

void Reduction::add_mechanism_error(const std::string& what) {
  if (is_free())
    diagnostics_.error("reduce.mechanism", where(), "besides the six rigid motions of a free body, " + what,
                       "tie the loose parts or constrain the free dofs");
  else
    diagnostics_.error("reduce.mechanism", where(), "the constraints do not hold the fixed body: " + what,
                       "complete the SPC set and select it in the case control, or use frame = \"free\" (--free)");
}

/// Twice where the origin is a node or the mass centre: the first model says where that is.
fe::Model Reduction::build_model() {
  const auto& elements = options_.elements ? options_.elements : fe::make_elements;
  auto options = make_model_options();
  auto model = fe::Model::build(deck_, options, elements, diagnostics_);
  if (spec_.origin_node > 0) check_node(model, spec_.origin_node, "origin", {});
  check_nodes(model);
  if (spec_.frame != BodyFrame::Fixed && spec_.frame != BodyFrame::Free)
    modal::bases::calc_reference_conditions(model, make_frame_spec(spec_));
  if (spec_.origin_node > 0)
    options.origin = model.node(model.find_node(spec_.origin_node)).x;
  else if (spec_.origin_at_mass_centre)
    options.origin = fe::calc_mass_properties(model, model.mass_kind(), Eigen::Vector3d::Zero()).cg;
  else
    return model;
  Diagnostics reported;
  return fe::Model::build(deck_, options, elements, reported);
}

FlexBody Reduction::run() {
  check_spec();
  report("model");
  const auto model = build_model();
  set_rigid_part(model);

  // The factor first: of a mechanism it names the dofs, which the modes could not.
  report("static factorization");
  const fe::PetscMat K = fe::assemble_stiffness(model, fe::DofSet::Free);
  const auto solve = make_solver(model, K);
  make_loads(model);
  report("modes");
  if (options_.modes)
    set_given_modes(model);
  else
    set_modes(model, solve);
  set_nodes(model);
  report("mass integrals");
  set_integrals(model);
  report("static solutions");
  set_stiffening(model, solve);
  return std::move(body_);
}

FlexBody reduce(const records::Deck& deck, const BodySpec& spec, const ReduceOptions& options,
                Diagnostics& diagnostics) {
  fe::initialize_petsc();
  return Reduction(deck, spec, options, diagnostics).run();
}

}  // namespace bough::stiffening
