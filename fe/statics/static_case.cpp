#include "fe/statics/static_case.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fe/loads/enforced.hpp"
#include "fe/loads/load_sets.hpp"
#include "fe/loads/loads.hpp"
#include "fe/statics/reactions.hpp"

namespace bough::fe {
namespace {

/// Names of the loads that Subcase::deform selects, by command.
constexpr std::pair<const char*, const char*> kUnreadLoads[] = {{"DEFORM", "enforced deformations of elements"},
                                                                {"TRIM", "aerodynamic loads of a trimmed aircraft"},
                                                                {"BOLTLD", "preloads of bolts"},
                                                                {"CLOAD", "combinations of loads of superelements"}};

/// Reactions (in CD axes) of the oblique directions of AUTOSPC: along the direction, equal to the residual on its
/// components that are not constrained otherwise.
void add_oblique_reactions(const Model& model, const VectorXd& residual, VectorXd& reaction) {
  if (model.T_oblique().cols() == 0) return;
  const VectorXd held = model.T_oblique().transpose() * residual;
  Eigen::Index column = 0;
  for (const auto& entry : model.autospc()) {
    if (entry.terms.empty()) continue;
    const double force = held[column++];
    const int first = model.node(model.find_node(entry.node)).first_gdof - 1;
    reaction[first + entry.component] += force;
    for (const auto& [component, factor] : entry.terms) reaction[first + component] -= factor * force;
  }
}

/// Reactions in CD axes.
VectorXd calc_cd_reactions(const Model& model, const VectorXd& residual) {
  const VectorXd held = model.T_fixed().transpose() * residual;
  VectorXd reaction = VectorXd::Zero(model.num_gdofs());
  for (std::size_t i = 0; i < model.fixed_dofs().size(); ++i)
    reaction[model.fixed_dofs()[i]] = held[static_cast<Eigen::Index>(i)];
  add_oblique_reactions(model, residual, reaction);
  return reaction;
}

void turn_to_basic(const Model& model, VectorXd& values) {
  for (const Node& node : model.nodes()) {
    if (node.num_dofs != 6) continue;
    for (const int part : {0, 3}) {
      auto f = values.segment<3>(node.first_gdof + part);
      f = (node.R_basic_cd * f).eval();
    }
  }
}

/// Grids that no multipoint constraint or rigid element is at: each of their dofs has a column of T or T_fixed to
/// itself. The rest of the residual there, apart from the reactions, is round-off.
std::vector<bool> find_untied(const Model& model) {
  const auto& nodes = model.nodes();
  std::vector<int> columns_of(nodes.size(), 0);
  std::vector<bool> is_untied(nodes.size(), true);
  for (const SparseRows* map : {&model.T(), &model.T_fixed()}) {
    constexpr int kNone = -1, kSeveral = -2;
    std::vector<int> node_of(static_cast<std::size_t>(map->cols()), kNone);
    const auto visit = [&](const auto& act) {
      for (std::size_t n = 0; n < nodes.size(); ++n)
        for (int d = 0; d < nodes[n].num_dofs; ++d)
          for (SparseRows::InnerIterator entry(*map, nodes[n].first_gdof + d); entry; ++entry)
            act(n, static_cast<std::size_t>(entry.col()));
    };
    visit([&](std::size_t n, std::size_t column) {
      int& node = node_of[column];
      if (node == kNone) {
        node = static_cast<int>(n);
        ++columns_of[n];
      } else if (node != static_cast<int>(n)) {
        node = kSeveral;
      }
    });
    visit([&](std::size_t n, std::size_t column) {
      if (node_of[column] == kSeveral) is_untied[n] = false;
    });
  }
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (columns_of[n] != nodes[n].num_dofs) is_untied[n] = false;
  return is_untied;
}

}  // namespace

VectorXd calc_reactions(const Model& model, const VectorXd& residual) {
  VectorXd reaction = calc_cd_reactions(model, residual);
  turn_to_basic(model, reaction);
  return reaction;
}

std::vector<std::string> list_lost_loads(const Model& model, const VectorXd& F) {
  std::vector<std::pair<double, const AutospcEntry*>> found;
  const double min_force = 1e-9 * F.cwiseAbs().maxCoeff();
  for (const auto& entry : model.autospc()) {
    const Node& node = model.node(model.find_node(entry.node));
    const int c = std::max(entry.component - 1, 0);
    if (entry.is_skew && entry.terms.empty()) continue;  // what has stiffness passes the load on
    Vector3d n = Vector3d::Unit(c % 3);
    for (const auto& [component, factor] : entry.terms) n[(component - 1) % 3] -= factor;
    const double f = node.num_dofs == 1
                         ? F[node.first_gdof]
                         : F.segment<3>(node.first_gdof + 3 * (c / 3)).dot(node.R_basic_cd * n.normalized());
    if (std::abs(f) > min_force) found.emplace_back(f, &entry);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
  std::vector<std::string> text;
  for (const auto& [f, entry] : found) {
    char number[32];
    std::snprintf(number, sizeof number, " (%.4g)", f);
    text.push_back("component " + std::to_string(entry->component) + " of grid " + std::to_string(entry->node) +
                   number);
  }
  return text;
}

StaticLoad calc_static_load(const Model& model, const records::Deck& deck, int load, Diagnostics& diagnostics) {
  if (load < 0) return calc_static_load(model, deck, model.subcase(), diagnostics);
  records::Subcase subcase;
  subcase.load = load;
  return calc_static_load(model, deck, subcase, diagnostics);
}

StaticLoad calc_static_load(const Model& model, const records::Deck& deck, const records::Subcase& subcase,
                            Diagnostics& diagnostics) {
  StaticLoad result;
  if (subcase.load > 0)
    static_cast<AppliedLoad&>(result) = calc_applied_load(model, deck, subcase.load, diagnostics);
  else
    result.F = VectorXd::Zero(model.num_gdofs());
  result.d = calc_enforced(model, deck, subcase.load, diagnostics);
  bool is_unread = false;
  for (const int set : {subcase.temperature, subcase.temperature > 0 ? model.subcase().initial_temperature : 0})
    is_unread = (set > 0 && report_unread_loads(deck, "TEMPERATURE", set, diagnostics)) || is_unread;
  if (!is_unread) result.initial = calc_thermal(model, deck, subcase.temperature, diagnostics);
  if (subcase.deform > 0)
    for (const auto& [command, what] : kUnreadLoads)
      if (subcase.commands.count(command) > 0)
        diagnostics.error(
            "fe.unread-load", deck.locate(subcase.find_command(command)),
            std::string(command) + " loads subcase " + std::to_string(subcase.id) + ", and " + what + " are not read",
            std::string("give the load by other cards, or --ignore ") + command + " to compute without it");
  if (!result.initial.of.empty()) result.F += sum_loads(model, result.initial);
  if (const auto lost = list_lost_loads(model, result.F); !lost.empty())
    diagnostics.warning("fe.load-autospc", deck.locate({}),
                        "loads of subcase " + std::to_string(subcase.id) + " act on " + std::to_string(lost.size()) +
                            " dof(s) without stiffness, which AUTOSPC holds: " + lost.front() +
                            (lost.size() > 1 ? ", ..." : ""),
                        "a moment on a grid of solids needs an RBE2 or RBE3 that ties it to other grids");
  return result;
}

records::StaticSubcase solve_static_case(const Model& model, const StaticSolver& solver, const StaticLoad& load,
                                         const Suport& suport, Diagnostics* diagnostics) {
  return std::move(solve_static_cases(model, solver, {&load}, suport, diagnostics).front());
}

std::vector<records::StaticSubcase> solve_static_cases(const Model& model, const StaticSolver& solver,
                                                       const std::vector<const StaticLoad*>& loads,
                                                       const Suport& suport, Diagnostics* diagnostics,
                                                       MatrixXd* energy) {
  std::vector<records::StaticSubcase> results(loads.size());
  const auto count = static_cast<Eigen::Index>(loads.size());
  MatrixXd F(model.num_gdofs(), count), U0 = MatrixXd::Zero(model.num_gdofs(), count);
  std::vector<Eigen::Index> enforced;
  for (Eigen::Index c = 0; c < count; ++c) {
    const StaticLoad& load = *loads[static_cast<std::size_t>(c)];
    F.col(c) = load.F;
    if (load.d.isZero(0)) continue;
    U0.col(c) = model.T_fixed() * load.d;
    enforced.push_back(c);
  }
  if (!enforced.empty()) F(Eigen::all, enforced) -= calc_stiffness_times(model, U0(Eigen::all, enforced));
  for (Eigen::Index c = 0; c < count; ++c) {
    auto& result = results[static_cast<std::size_t>(c)];
    for (const int fdof : suport.fdofs) {
      const auto [node, component] = model.describe_fdof(fdof);
      const auto row = static_cast<Eigen::Index>(result.support.size());
      result.support.push_back({node, component, suport.strain_energy[row], 0});
    }
    result.support_epsilon = suport.epsilon;
    if (suport.relief == InertiaRelief::None) continue;
    const VectorXd a = calc_acceleration(suport, F.col(c));
    for (std::size_t i = 0; i < result.support.size(); ++i)
      result.support[i].acceleration = a[static_cast<Eigen::Index>(i)];
    result.inertia = -suport.M_motions * a;
    result.inertia_resultant = calc_resultant(model, result.inertia);
    F.col(c) += result.inertia;
  }
  MatrixXd U1;
  try {
    U1 = solver.solve(F, diagnostics);
  } catch (const ComputationError&) {
    solver.demand_no_mechanism(model);
    throw;
  }
  VectorXd work(count);
  for (Eigen::Index c = 0; c < count; ++c) {
    if (suport.relief == InertiaRelief::Free) {
      VectorXd u1 = U1.col(c);
      remove_rigid_part(suport, u1);
      U1.col(c) = u1;
    }
    work[c] = std::abs(U1.col(c).dot(F.col(c)));
  }
  const MatrixXd U = U1 + U0, K_U = calc_stiffness_times(model, U, energy);
  const auto is_untied = find_untied(model);
  for (Eigen::Index c = 0; c < count; ++c) {
    const StaticLoad& load = *loads[static_cast<std::size_t>(c)];
    auto& result = results[static_cast<std::size_t>(c)];
    result.displacement = U.col(c);
    result.load = load.F;
    VectorXd residual = K_U.col(c) - load.F;
    if (result.inertia.size() > 0) residual -= result.inertia;
    result.epsilon = work[c] > 0 ? std::abs(U1.col(c).dot(residual)) / work[c] : 0;
    result.strain_energy = 0.5 * U.col(c).dot(K_U.col(c));
    if (!load.initial.of.empty()) {
      result.strain_energy -= result.displacement.dot(sum_loads(model, load.initial));
      for (const auto& element : model.elements())
        if (const auto* part = load.initial.find(*element)) result.strain_energy += part->energy;
    }
    result.reaction = calc_cd_reactions(model, residual);
    if (!suport.fdofs.empty()) {
      const VectorXd at_f = model.T().transpose() * residual;
      for (const int fdof : suport.fdofs) {
        const auto [node, component] = model.describe_fdof(fdof);
        result.reaction[model.node(model.find_node(node)).first_gdof + std::max(component - 1, 0)] = at_f[fdof];
      }
    }
    turn_to_basic(model, result.reaction);
    result.mpc_force = residual - result.reaction;
    for (std::size_t n = 0; n < is_untied.size(); ++n)
      if (is_untied[n]) result.mpc_force.segment(model.nodes()[n].first_gdof, model.nodes()[n].num_dofs).setZero();
    result.load_resultant = calc_resultant(model, result.load);
    result.reaction_resultant = calc_resultant(model, result.reaction);
    result.mpc_resultant = calc_resultant(model, result.mpc_force);
  }
  return results;
}

Eigen::Matrix<double, 6, 1> calc_resultant(const Model& model, const VectorXd& F_g, const Vector3d& point) {
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  for (const Node& node : model.nodes()) {
    if (node.num_dofs != 6) continue;
    const Vector3d F = F_g.segment<3>(node.first_gdof);
    sum.head<3>() += F;
    sum.tail<3>() += (node.x - point).cross(F) + F_g.segment<3>(node.first_gdof + 3);
  }
  return sum;
}

records::SparseMatrix gather_sparse(const linear::SymmetricMatrix& A) {
  const linear::MpiWorld world = linear::initialize_petsc();
  PetscInt first = 0, last = 0, num_rows = 0, num_cols = 0;
  linear::check_petsc(MatGetOwnershipRange(A.sparse(), &first, &last));
  linear::check_petsc(MatGetSize(A.sparse(), &num_rows, &num_cols));
  std::vector<double> data;
  std::vector<int> indices, sizes;
  for (PetscInt row = first; row < last; ++row) {
    PetscInt count = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* values = nullptr;
    linear::check_petsc(MatGetRow(A.sparse(), row, &count, &columns, &values));
    const std::size_t before = data.size();
    for (PetscInt i = 0; i < count; ++i)
      if (values[i] != 0) {
        data.push_back(values[i]);
        indices.push_back(columns[i]);
      }
    sizes.push_back(static_cast<int>(data.size() - before));
    linear::check_petsc(MatRestoreRow(A.sparse(), row, &count, &columns, &values));
  }
  // One block after the other, to every rank.
  records::SparseMatrix result;
  result.num_rows = num_rows;
  result.num_cols = num_cols;
  const auto collect = [&](const auto& own, auto& all, MPI_Datatype type) {
    const int own_size = static_cast<int>(own.size());
    std::vector<int> counts(static_cast<std::size_t>(world.size)), starts(counts.size(), 0);
    MPI_Allgather(&own_size, 1, MPI_INT, counts.data(), 1, MPI_INT, PETSC_COMM_WORLD);
    int total = 0;
    for (std::size_t r = 0; r < counts.size(); ++r) {
      starts[r] = total;
      total += counts[r];
    }
    all.resize(static_cast<std::size_t>(total));
    MPI_Allgatherv(own.data(), own_size, type, all.data(), counts.data(), starts.data(), type, PETSC_COMM_WORLD);
  };
  std::vector<int> all_sizes;
  collect(data, result.data, MPI_DOUBLE);
  collect(indices, result.indices, MPI_INT);
  collect(sizes, all_sizes, MPI_INT);
  result.indptr.assign(1, 0);
  for (int size : all_sizes) result.indptr.push_back(result.indptr.back() + size);
  return result;
}

}  // namespace bough::fe
