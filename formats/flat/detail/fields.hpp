#pragma once
/// \file The table of the arrays of a flat body file: the writer and the reader visit the same lines.
#include <climits>
#include <string>
#include <utility>
#include <vector>

#include "formats/records/flex_body.hpp"

namespace bough::flat::detail {

/// Number of entries in each direction, last index fastest; -1: any. Empty: one value.
using Shape = std::vector<long>;

struct FieldOptions {
  bool is_optional = false;    ///< a body may lack the array; one whose shape holds no entries may always be absent
  bool is_transposed = false;  ///< the file has the transpose of each matrix
  int max_value = INT_MAX;     ///< of flags and kinds, which begin at 0
};
inline constexpr FieldOptions kOptional{.is_optional = true};
inline constexpr FieldOptions kTransposed{.is_transposed = true};

/// Number of items as the shapes have it.
template <class Container>
long count(const Container& items) {
  return static_cast<long>(items.size());
}

/// Visits one member of the items of a list as a separate array. \param size  -1: this array gives the number of
/// items.
template <class Archive, class Items, class GetMember>
void visit_column(Archive& archive, const std::string& name, Items& items, long size, GetMember get_member,
                  const FieldOptions& options = {}) {
  using Value = std::remove_cvref_t<decltype(get_member(items[0]))>;
  std::vector<Value> values;
  if constexpr (!Archive::kReads)
    for (const auto& item : items) values.push_back(get_member(item));
  if constexpr (std::is_same_v<Value, std::string>)
    archive.texts(name, values, size, options);
  else
    archive.array(name, values, {size}, options);
  if constexpr (Archive::kReads) {
    if (size < 0) items.resize(values.size());
    for (std::size_t i = 0; i < items.size() && i < values.size(); ++i) get_member(items[i]) = std::move(values[i]);
  }
}

/// Visits Γ0 to Γ4 of n modes below `path`; absent integrals have no arrays.
template <class Archive, class Integrals>
void visit_integrals(Archive& archive, const std::string& path, Integrals& g, long n) {
  if (!archive.has(path + "/gamma0", !g.empty())) return;
  archive.array(path + "/gamma0", g.gamma0, {n, 3}, kTransposed);
  archive.array(path + "/gamma1", g.gamma1, {n, 3}, kTransposed);
  archive.array(path + "/gamma2", g.gamma2, {n, n, 3}, kTransposed);
  archive.array(path + "/gamma3", g.gamma3, {n, 3, 3});
  archive.array(path + "/gamma4", g.gamma4, {n, n, 3, 3});
}

/// Visits K_G1, the locators with K_G2 and their loads, and the preload, all of n modes.
template <class Archive, class Body>
void visit_stiffening(Archive& archive, Body& body, long n) {
  constexpr const char* kLoads[] = {"ax", "ay", "az", "alx", "aly", "alz", "wx2", "wy2", "wz2", "wxwy", "wxwz", "wywz"};
  archive.array("/stiffening/computed", body.kg_inertial_computed, {records::kNumInertialLoads}, {.max_value = 1});
  for (std::size_t i = 0; i < records::kNumInertialLoads; ++i)
    archive.array(std::string("/stiffening/kg_inertial/") + kLoads[i], body.kg_inertial[i], {n, n}, kOptional);
  visit_column(
      archive, "/stiffening/locator/name", body.locators, -1, [](auto& l) -> auto& { return l.name; }, kOptional);
  const long ne = count(body.locators);
  visit_column(
      archive, "/stiffening/locator/node", body.locators, ne, [](auto& l) -> auto& { return l.node; });
  visit_column(
      archive, "/stiffening/locator/direction", body.locators, ne, [](auto& l) -> auto& { return l.direction; });
  archive.array("/stiffening/kg_external", body.kg_external, {ne, n, n});
  archive.array("/stiffening/external_load", body.external_load, {n, ne});
  archive.array("/stiffening/load_resultant", body.load_resultant, {6, ne}, kOptional);
  archive.array("/stiffening/load_moment", body.load_moment, {ne, 3, n}, kOptional);
  archive.text("/preload/loads", body.preload);
  archive.array("/preload/inertial", body.preload_A_I, {records::kNumInertialLoads}, kOptional);
  archive.array("/stiffening/kg_preload", body.kg_preload, {n, n}, kOptional);
}

/// Visits the tables of third order; a body without large modes has none.
template <class Archive, class Body>
void visit_third_order(Archive& archive, Body& body, long n) {
  using Third = records::ThirdOrder;
  auto& third = body.third_order;
  if (archive.has("/third_order/directions", third.directions.size() > 0)) {
    archive.array("/third_order/directions", third.directions, {-1, n});
    if constexpr (Archive::kReads) third.count_directions();
  } else {
    if (!archive.has("/third_order/large", !third.empty())) return;
    archive.array("/third_order/large", third.large, {-1}, {.max_value = static_cast<int>(n) - 1});
  }
  const long N = count(third.large);
  if (!records::is_valid_choice(third.large, static_cast<int>(n))) return;  // find_body_faults() says so
  const auto name = [](const char* word, int degree) {
    return std::string("/third_order/") + word + std::to_string(degree);
  };
  for (int k = Third::kMinEnergy; k <= Third::kMaxEnergy; ++k)
    archive.array(name("energy_", k), third.energy[static_cast<std::size_t>(k - Third::kMinEnergy)],
                  {records::count_monomials(static_cast<int>(N), k)});
  archive.array("/third_order/energy_small", third.energy_small,
                {records::count_monomials(static_cast<int>(N), 2), n - N}, kOptional);
  for (int k = Third::kMinField; k <= Third::kMaxField; ++k) {
    const auto at = static_cast<std::size_t>(k - Third::kMinField);
    const long rows = records::count_monomials(static_cast<int>(k == 2 ? n : N), k);
    archive.array(name("amplitudes_", k), third.amplitudes[at], {rows, -1});
    archive.array(name("load_", k), third.load[at], {rows, count(body.locators)}, kOptional);
    for (std::size_t i = 0; i < body.interface_nodes.size(); ++i) {
      if constexpr (Archive::kReads) third.node.resize(body.interface_nodes.size());
      archive.array("/third_order/node/" + std::to_string(i + 1) + "/" + std::to_string(k), third.node[i][at],
                    {rows, 6});
    }
  }
  const long m = third.amplitudes[0].cols();
  archive.array("/third_order/fields", third.fields, {count(body.node_id), 6, m});
  archive.array("/third_order/coupling", third.coupling, {n, m}, kOptional);
  visit_integrals(archive, "/third_order/integrals", third.integrals, n + m);
}

/// Visits /next_order: the energy of degrees 3 and 4 of soft modes.
template <class Archive, class Body>
void visit_next_order(Archive& archive, Body& body, long n) {
  auto& next = body.next_order;
  if (!archive.has("/next_order/modes", !next.empty())) return;
  archive.array("/next_order/modes", next.modes, {-1}, {.max_value = static_cast<int>(n) - 1});
  const int N = static_cast<int>(count(next.modes));
  if (N > records::kMaxLargeModes) return;  // find_body_faults() says so
  archive.array("/next_order/energy_3", next.cubic, {records::count_monomials(N, 3)});
  archive.array("/next_order/energy_4", next.quartic, {records::count_monomials(N, 4)});
}

/// Visits the recovery matrices and the strain energies of elements, all of n modes.
template <class Archive, class Body>
void visit_recovery(Archive& archive, Body& body, long n) {
  archive.array("/recovery/inertial_load", body.inertial_load, {n, records::kNumInertialLoads}, kOptional);
  visit_column(
      archive, "/recovery/name", body.recovery, -1, [](auto& b) -> auto& { return b.name; }, kOptional);
  for (std::size_t i = 0; i < body.recovery.size(); ++i) {
    auto& block = body.recovery[i];
    const std::string path = "/recovery/" + std::to_string(i + 1);
    archive.array(path + "/id", block.id, {-1});
    archive.texts(path + "/component", block.components, -1);
    const long rows = count(block.id) * count(block.components);
    archive.array(path + "/matrix", block.matrix, {rows, n});
    const auto& third = body.third_order;
    for (int k = records::ThirdOrder::kMinField; k <= records::ThirdOrder::kMaxField && !third.empty(); ++k)
      archive.array(path + "/matrix_" + std::to_string(k),
                    block.beyond[static_cast<std::size_t>(k - records::ThirdOrder::kMinField)],
                    {rows, records::count_monomials(third.num_variables(k, static_cast<int>(n)), k)}, kOptional);
    archive.array(path + "/inertial", block.inertial, {rows, records::kNumInertialLoads});
    archive.array(path + "/external", block.external, {rows, count(body.locators)});
    archive.array(path + "/offset", block.offset, {rows});
  }
  auto& energy = body.strain_energy;
  archive.array("/strain_energy/id", energy.id, {-1}, kOptional);
  archive.texts("/strain_energy/card", energy.card, count(energy.id));
  archive.array("/strain_energy/matrix", energy.matrix, {count(energy.id), n * (n + 1) / 2});
}

/// Visits grids, element blocks and mode shapes for pictures.
template <class Archive, class Body>
void visit_mesh(Archive& archive, Body& body, long n) {
  auto& mesh = body.mesh;
  archive.array("/mesh/grid_id", mesh.grid_id, {-1}, kOptional);
  const long g = count(mesh.grid_id);
  archive.array("/mesh/grid_xyz", mesh.grid_xyz, {g, 3});
  visit_column(
      archive, "/mesh/type", mesh.blocks, -1, [](auto& b) -> auto& { return b.type; }, kOptional);
  for (std::size_t i = 0; i < mesh.blocks.size(); ++i) {
    auto& block = mesh.blocks[i];
    const std::string path = "/mesh/" + std::to_string(i + 1);
    archive.array(path + "/id", block.element_id, {-1});
    archive.array(path + "/connectivity", block.connectivity, {count(block.element_id), -1});
  }
  archive.array("/mesh/phi", body.mesh_phi, {3 * g, n}, kOptional);
}

/// Visits every field of a body. Shapes depend on arrays that come before them.
template <class Archive, class Body>
void visit_body(Archive& archive, Body& body) {
  archive.text("/name", body.name);
  visit_column(
      archive, "/source/file", body.source, -1, [](auto& s) -> auto& { return s.first; }, kOptional);
  visit_column(
      archive, "/source/sha256", body.source, count(body.source), [](auto& s) -> auto& { return s.second; });
  archive.array("/frame/is_free", body.is_free_free, {}, {.max_value = 1});
  archive.array("/rigid/mass", body.mass, {});
  archive.array("/rigid/cg", body.cg, {3});
  archive.array("/rigid/inertia", body.inertia, {3, 3});
  archive.array("/nodes/id", body.node_id, {-1});
  const long p = count(body.node_id);
  archive.array("/nodes/xyz", body.node_xyz, {p, 3});
  archive.array("/nodes/interface", body.interface_nodes, {-1}, kOptional);

  archive.array("/modes/eigenvalue", body.eigenvalue, {-1});
  const long n = count(body.eigenvalue);
  archive.array("/modes/frequency_hz", body.frequency_hz, {n});
  archive.array("/modes/kind", body.kind, {n}, {.max_value = static_cast<int>(records::ModeKind::Residual)});
  archive.array("/modes/phi", body.phi, {p, 6, n});
  archive.array("/modal/mass", body.modal_mass, {n, n});
  archive.array("/modal/stiffness", body.modal_stiffness, {n, n});
  archive.array("/modal/damping", body.modal_damping, {n, n});
  archive.array("/effective_mass", body.effective_mass, {n, 6});

  archive.text("/integrals/method", body.integrals_method);
  archive.text("/integrals/masses", body.masses);
  visit_integrals(archive, "/integrals/lumped", body.lumped, n);
  visit_integrals(archive, "/integrals/consistent", body.consistent, n);
  visit_integrals(archive, "/integrals/exact", body.exact, n);

  archive.array("/dof_map", body.dof_map, {-1, 2}, kOptional);
  const long ndof = static_cast<long>(body.dof_map.rows());
  archive.array("/inertial_loads/f", body.F_I, {ndof, records::kNumInertialLoads}, kOptional);
  archive.array("/full/phi", body.full_phi, {ndof, n}, kOptional);
  visit_stiffening(archive, body, n);
  visit_third_order(archive, body, n);
  visit_next_order(archive, body, n);
  visit_recovery(archive, body, n);
  visit_mesh(archive, body, n);
}

}  // namespace bough::flat::detail
