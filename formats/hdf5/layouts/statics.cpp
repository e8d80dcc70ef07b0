#include "formats/hdf5/layouts/rows.hpp"

namespace bough::hdf5 {

namespace {

LayoutRow make_dof_row() {
  return {"/dof_map", ArrayKind::Integer, "d, 2", "1",
          "a row per dof: node id and code 1..6 (0 for a scalar point), basic axes"};
}

std::vector<LayoutRow> list_subcase_rows() {
  using enum ArrayKind;
  constexpr const char* kSupport = "with SUPORT";
  constexpr const char* kRelief = "with inertia relief";
  constexpr const char* kGridForces = "with `--grid-forces`";
  return {
      {"/subcases/{id}@label", Text, "", "", "", "", "", "LABEL of the case control"},
      {"/subcases/{id}@load_set", Integer, "", "", "", "", "", "LOAD; 0: none"},
      {"/subcases/{id}@temperature_set", Integer, "", "", "", "", "", "TEMPERATURE(LOAD); 0: none"},
      {"/subcases/{id}@spc_set", Integer, "", "", "", "", "", "SPC; 0: none"},
      {"/subcases/{id}@mpc_set", Integer, "", "", "", "", "", "MPC; 0: none"},
      {"/subcases/{id}/displacement", Real, "d", "L, 1", "displacements in the order of /dof_map"},
      {"/subcases/{id}/load", Real, "d", "F, F L", "loads on the grids, in the order of /dof_map", "", "",
       "work-equivalent, those of temperatures too (Nastran's OLOAD)"},
      {"/subcases/{id}/reaction", Real, "d", "F, F L",
       "forces of the single-point constraints on the structure, in the order of /dof_map", "", "",
       "SPC, permanent SPC and AUTOSPC (SPCFORCE)"},
      {"/subcases/{id}/mpc_force", Real, "d", "F, F L",
       "forces of multipoint constraints and rigid elements, in the order of /dof_map", "", "",
       "K u - F minus the reactions"},
      {"/subcases/{id}/strain_energy", Real, "1", "F L", "strain energy"},
      {"/subcases/{id}/epsilon", Real, "1", "1", "work of the residual over the work of the loads"},
      {"/subcases/{id}/resultants", Real, "3, 6", "F, F L",
       "of loads, reactions, multipoint forces: forces x y z and moments x y z about the origin"},
      {"/subcases/{id}/support/dofs", Integer, "r, 2", "1", "SUPORT: node id and component in its displacement system",
       kSupport, "", "displacement (CD) system"},
      {"/subcases/{id}/support/strain_energy", Real, "r", "F L, F L", "strain energy of the unit motion of each",
       kSupport},
      {"/subcases/{id}/support/epsilon", Real, "1", "1", "stiffness of these motions over K_rr", kSupport, "",
       "abs(K_rr - K_rl K_ll⁻¹ K_lr) / abs(K_rr)"},
      {"/subcases/{id}/support/acceleration", Real, "r", "L/T^2, 1/T^2", "acceleration of each", kRelief},
      {"/subcases/{id}/inertia", Real, "d", "F, F L",
       "forces of the mass that balance the load, in the order of /dof_map", kRelief},
      {"/subcases/{id}/grid_forces/grid", Integer, "f", "1", "grid that the force acts on", kGridForces},
      {"/subcases/{id}/grid_forces/source", Text, "f", "1", "card of the element, or LOAD, SPC, MPC, INERTIA",
       kGridForces},
      {"/subcases/{id}/grid_forces/element", Integer, "f", "1", "element id; 0: none", kGridForces},
      {"/subcases/{id}/grid_forces/force", Real, "f, 6", "F, F L", "force x y z and moment x y z, basic axes",
       kGridForces},
  };
}

std::vector<LayoutRow> list_element_rows() {
  using enum ArrayKind;
  constexpr const char* kForces = "with element forces";
  constexpr const char* kStresses = "with stresses";
  constexpr const char* kStrains = "with `--strains` or STRAIN of the deck";
  constexpr const char* kMargins = "where MAT1 has ST, SC, SS";
  return {
      {"/subcases/{id}/elements/{card}/id", Integer, "e", "1", "element ids", kForces},
      {"/subcases/{id}/elements/{card}/property", Integer, "e", "1", "property ids; 0: none", kForces},
      {"/subcases/{id}/elements/{card}/force", Real, "e, c", "F, F L",
       "a row per element: the forces that `components` names", kForces},
      {"/subcases/{id}/elements/{card}/strain_energy", Real, "e", "F L", "strain energy of each element", kForces},
      {"/subcases/{id}/elements/{card}@components", Text, "c", "", "", kForces, "", "names of the columns"},
      {"/subcases/{id}/stresses/{card}/id", Integer, "e", "1", "element ids", kStresses, "",
       "elements of one card with other `components`: CARD-2, CARD-3, ... in alphabetical order of these; so in "
       "`elements` and `strains`, in [responses](response.md) and `/recovery` of bodies"},
      {"/subcases/{id}/stresses/{card}/property", Integer, "e", "1", "property ids; 0: none", kStresses},
      {"/subcases/{id}/stresses/{card}/stress", Real, "e, c", "F/L^2, 1",
       "a row per element: what `components` names, as component@point", kStresses, "",
       "`xx@top`, `von_mises` ([which](../theory/recovery.md))"},
      {"/subcases/{id}/stresses/{card}@components", Text, "c", "", "", kStresses, "", "names of the columns"},
      {"/subcases/{id}/strains/{card}/id", Integer, "e", "1", "element ids", kStrains},
      {"/subcases/{id}/strains/{card}/property", Integer, "e", "1", "property ids; 0: none", kStrains},
      {"/subcases/{id}/strains/{card}/strain", Real, "e, c", "1, 1/L",
       "a row per element: what `components` names, as component@point; shears are angles", kStrains, "",
       "as stresses ([which](../theory/recovery.md#strains))"},
      {"/subcases/{id}/strains/{card}/corner", Real, "e, 6k", "1",
       "a row per element: xx yy zz xy yz zx at each of its corners, basic axes", "of solids, with strains", "",
       "k corners"},
      {"/subcases/{id}/strains/{card}@components", Text, "c", "", "", kStrains, "", "names of the columns"},
      {"/subcases/{id}/margins/{card}/id", Integer, "e", "1", "element ids", kMargins},
      {"/subcases/{id}/margins/{card}/margin", Real, "e, 3", "1",
       "a row per element: limit / |stress| - 1; no number without a limit or such a stress", kMargins},
      {"/subcases/{id}/margins/{card}@components", Text, "3", "", "", kMargins, "",
       "`tension`, `compression`, `shear`"},
  };
}

std::vector<LayoutRow> list_extremes_rows() {
  using enum ArrayKind;
  constexpr const char* kExtremes = "with `--extremes`";
  constexpr const char* kOf = "of the quantity";
  constexpr const char* kId = "grid or element of each row";
  constexpr const char* kMin = "least over the subcases, a column per component";
  constexpr const char* kMax = "largest over the subcases, a column per component";
  return {
      {"/extremes/{quantity}/id", Integer, "e", "1", kId, kExtremes, "", "quantity: `displacement`, `reaction`"},
      {"/extremes/{quantity}/min", Real, "e, c", kOf, kMin, kExtremes},
      {"/extremes/{quantity}/max", Real, "e, c", kOf, kMax, kExtremes},
      {"/extremes/{quantity}/min_subcase", Integer, "e, c", "1", "subcase of the least", kExtremes},
      {"/extremes/{quantity}/max_subcase", Integer, "e, c", "1", "subcase of the largest", kExtremes},
      {"/extremes/{quantity}@components", Text, "c", "", "", kExtremes, "", "names of the columns"},
      {"/extremes/{quantity}/{card}/id", Integer, "e", "1", kId, kExtremes, "",
       "quantity: `elements`, `stresses`, `strains`"},
      {"/extremes/{quantity}/{card}/min", Real, "e, c", kOf, kMin, kExtremes},
      {"/extremes/{quantity}/{card}/max", Real, "e, c", kOf, kMax, kExtremes},
      {"/extremes/{quantity}/{card}/min_subcase", Integer, "e, c", "1", "subcase of the least", kExtremes},
      {"/extremes/{quantity}/{card}/max_subcase", Integer, "e, c", "1", "subcase of the largest", kExtremes},
      {"/extremes/{quantity}/{card}@components", Text, "c", "", "", kExtremes, "", "names of the columns"},
  };
}

std::vector<LayoutRow> list_sparse_rows() {
  using enum ArrayKind;
  constexpr const char* kColumns = "their columns, 0-based";
  constexpr const char* kBegin = "where each row begins in data and indices";
  constexpr const char* kShape = "rows and columns";
  constexpr const char* kDamping = "if the deck has dampers";
  constexpr const char* kGeometric = "without `--no-kg`";
  return {
      {"/K/data", Real, "z", "F/L, F, F L", "stiffness before constraints: the values of compressed rows"},
      {"/K/indices", Integer, "z", "1", kColumns},
      {"/K/indptr", Integer, "d+1", "1", kBegin},
      {"/K/shape", Integer, "2", "1", kShape},
      {"/M/data", Real, "y", "M, M L, M L^2", "mass before constraints: the values of compressed rows"},
      {"/M/indices", Integer, "y", "1", kColumns},
      {"/M/indptr", Integer, "d+1", "1", kBegin},
      {"/M/shape", Integer, "2", "1", kShape},
      {"/B/data", Real, "x", "F T/L, F T, F T L", "viscous damping before constraints: the values of compressed rows",
       kDamping},
      {"/B/indices", Integer, "x", "1", kColumns, kDamping},
      {"/B/indptr", Integer, "d+1", "1", kBegin, kDamping},
      {"/B/shape", Integer, "2", "1", kShape, kDamping},
      {"/KG/{load}/data", Real, "w", "F/L, F, F L",
       "geometric stiffness of the static solution: the values of compressed rows", kGeometric, "",
       "load: LOAD_n of a load set, TEMP_n of a temperature set"},
      {"/KG/{load}/indices", Integer, "w", "1", kColumns, kGeometric},
      {"/KG/{load}/indptr", Integer, "d+1", "1", kBegin, kGeometric},
      {"/KG/{load}/shape", Integer, "2", "1", kShape, kGeometric},
  };
}

}  // namespace

Layout make_static_layout() {
  return {"bough-static", "static",
          join_rows({list_root_rows(),
                     {make_dof_row()},
                     list_subcase_rows(),
                     list_element_rows(),
                     list_extremes_rows(),
                     list_mesh_rows()})};
}

Layout make_matrices_layout() {
  return {"bough-matrices", "matrices",
          join_rows({list_root_rows(), {make_dof_row()}, list_sparse_rows(), list_mesh_rows()})};
}

}  // namespace bough::hdf5
