#include "stiffening/reduction.hpp"

#include <set>

#include "fe/linear/factor.hpp"
#include "fe/matrices/connected_parts.hpp"
#include "fe/matrices/mass_directions.hpp"
#include "fe/statics/build_model.hpp"
#include "modal/integrals.hpp"
#include "stiffening/basis_check.hpp"

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
  if (fe::calc_mass_difference(properties.rigid_mass) > fe::kMassDifference) {
    SourceLocation at = where();
    const auto what = fe::describe_mass(model, deck_, properties.rigid_mass, at);
    diagnostics_.warning("reduce.mass-by-direction", at,
                         what +
                             ": a rigid body has one; the body gets their mean, by which gravity, joints and forces "
                             "move it",
                         "give CONM2, or CMASS of one value in all three translations of one grid, unless only the "
                         "modes matter");
  }
  body_.is_free_free = is_free() && spec_.frame != BodyFrame::Node && spec_.frame != BodyFrame::ThreeNodes;
}

bool Reduction::lacks_rotation(const fe::Model& model, const fe::Node& node) {
  const auto moves = [&](int c) { return model.T().row(node.first_gdof + c).norm() > 0; };
  return (moves(0) || moves(1) || moves(2)) && !moves(3) && !moves(4) && !moves(5);
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
    body_.phi.push_back(Phi_.cols() > 0 ? MatrixXd(Phi_.middleRows(node.first_gdof, 6)) : MatrixXd(6, 0));
    if (lacks_rotation(model, node)) body_.phi.back().bottomRows<3>().setZero();
  }
  body_.mesh = model.calc_mesh();
  body_.dof_map = model.calc_dof_map();
  if (spec_.full)
    body_.full_phi = Phi_;
  else
    body_.set_mesh_shapes(Phi_);
}

/// What needs M on the g-set, assembled once: many products are cheaper so than element by element.
void Reduction::set_integrals(const fe::Model& model) {
  const auto kind = model.mass_kind();
  const bool is_lumped = kind == fe::MassKind::Lumped;
  const auto dofs = modal::NodalDofs::from_model(model);
  const fe::PetscMat M = fe::assemble_mass(model, fe::DofSet::Global, kind);
  const auto mass_times = [&M](const MatrixXd& X) { return fe::multiply(M.get(), X); };
  body_.exact = modal::calc_exact_integrals(model, kind, Phi_);
  const bool is_approximate = fe::has_approximate_mass(model, kind);
  body_.masses = is_approximate ? "nodal momenta" : "bodies";
  if (is_approximate)
    diagnostics_.warning("reduce.inertia-approximated", where(),
                         "part of the mass matrix is not that of bodies on single grids: the loads of spin, the exact "
                         "integrals and the stiffening by carried mass take its nodal momenta instead",
                         "reduce the deck itself, or give a lumped mass matrix");
  (is_lumped ? body_.lumped : body_.consistent) =
      is_lumped && !is_approximate ? body_.exact : modal::calc_momentum_integrals(dofs, mass_times, Phi_);
  (is_lumped ? body_.consistent : body_.lumped) =
      modal::calc_named_integrals(model, is_lumped ? fe::MassKind::Consistent : fe::MassKind::Lumped, Phi_);
  body_.integrals_method = spec_.integrals;
  body_.effective_mass = modal::calc_effective_mass(model, Phi_, mass_times(Phi_));
  body_.F_I = fe::calc_inertial_loads(model, kind, MatrixXd::Identity(12, 12), mass_times);
}

/// The parts that nothing holds, if there are several; else what may hold the model.
void Reduction::add_mechanism_error(const fe::Model& model, const std::string& what) {
  if (const auto loose = fe::describe_loose_parts(model); !loose.what.empty())
    diagnostics_.error("reduce.mechanism", where(), loose.what, loose.advice);
  else if (is_free())
    diagnostics_.error("reduce.mechanism", where(), "besides the six rigid motions of a free body, " + what,
                       "tie the loose parts or constrain the free dofs");
  else
    diagnostics_.error("reduce.mechanism", where(), "the constraints do not hold the fixed body: " + what,
                       "complete the SPC set and select it in the case control, or use frame = \"free\" (--free)");
}

void Reduction::check_modal_matrices(const fe::Model& model) {
  auto check = check_basis(model, Phi_, body_.modal_mass, body_.modal_stiffness);
  check.modes = modes_check_;
  if (options_.check) *options_.check = check;
  report_basis(check, where(), diagnostics_);
}

/// Twice where the origin is a node or the mass centre, which the first model knows, and for a preload.
fe::Model Reduction::build_model() {
  const auto& elements = options_.elements ? options_.elements : fe::make_elements;
  auto options = make_model_options();
  auto model = fe::build_model(deck_, options, elements, diagnostics_);
  if (spec_.origin_node > 0) check_node(model, spec_.origin_node, "origin", {});
  check_nodes(model);
  if (spec_.frame != BodyFrame::Fixed && spec_.frame != BodyFrame::Free)
    modal::bases::calc_reference_conditions(model, make_frame_spec(spec_));
  if (spec_.origin_node > 0)
    options.origin = model.node(model.find_node(spec_.origin_node)).x;
  else if (spec_.origin_at_mass_centre)
    options.origin = fe::calc_mass_properties(model, model.mass_kind(), Eigen::Vector3d::Zero()).cg;
  options.prestress = calc_prestress(options);
  model_options_ = options;
  if (!options.origin && !options.prestress) return model;
  Diagnostics reported;
  return fe::build_model(deck_, options, elements, reported);
}

/// φᵀ K_e φ of each element that has stiffness, without what a preload adds to it.
void Reduction::set_strain_energy(const fe::Model& model) {
  if (!spec_.strain_energy) return;
  report("strain energy of elements");
  const auto n = Phi_.cols();
  const auto& elements = model.elements();
  MatrixXd all = MatrixXd::Zero(static_cast<Eigen::Index>(elements.size()), n * (n + 1) / 2), K, u;
  Eigen::VectorXd is_stiff = Eigen::VectorXd::Zero(all.rows());
  const auto [begin, end] = fe::calc_element_range(model);
  for (int e = begin; e < end; ++e) {
    const fe::Element& element = *elements[static_cast<std::size_t>(e)];
    K.setZero(element.num_dofs(), element.num_dofs());
    element.add_stiffness(1, K);
    if (K.isZero(0)) continue;
    is_stiff(e) = 1;
    u = Phi_(element.gdofs(), Eigen::all);
    const MatrixXd k = u.transpose() * K * u;
    for (Eigen::Index i = 0, column = 0; i < n; ++i)
      for (Eigen::Index j = i; j < n; ++j) all(e, column++) = 0.5 * (k(i, j) + k(j, i));
  }
  fe::sum_over_ranks(all);
  MatrixXd stiff = is_stiff;
  fe::sum_over_ranks(stiff);
  auto& energy = body_.strain_energy;
  std::vector<Eigen::Index> rows;
  for (Eigen::Index e = 0; e < all.rows(); ++e) {
    if (stiff(e, 0) == 0) continue;
    rows.push_back(e);
    energy.id.push_back(elements[static_cast<std::size_t>(e)]->id());
    energy.card.emplace_back(elements[static_cast<std::size_t>(e)]->card());
  }
  energy.matrix = all(rows, Eigen::all);
}

FlexBody Reduction::run() {
  check_spec();
  report("model");
  const auto model = build_model();
  if (model.prestress()) body_.preload = model.prestress()->name;
  set_rigid_part(model);

  // The factor first: of a mechanism it names the dofs, which the modes could not.
  report("static factorization");
  const fe::System system(model);
  const auto solve = make_solver(system);
  make_loads(model);
  report("modes");
  if (options_.modes)
    set_given_modes(system);
  else
    set_modes(system, solve);
  check_modal_matrices(model);
  set_nodes(model);
  report("mass integrals");
  set_integrals(model);
  report("static solutions");
  set_stiffening(model, solve);
  set_preload(model);
  set_strain_energy(model);
  return std::move(body_);
}

FlexBody reduce(const records::Deck& deck, const BodySpec& spec, const ReduceOptions& options,
                Diagnostics& diagnostics) {
  fe::initialize_petsc();
  return Reduction(deck, spec, options, diagnostics).run();
}

}  // namespace bough::stiffening
