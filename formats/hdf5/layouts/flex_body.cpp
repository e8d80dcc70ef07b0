#include "formats/hdf5/layouts/rows.hpp"

namespace bough::hdf5 {

namespace {

std::vector<LayoutRow> list_body_rows() {
  using enum ArrayKind;
  return {
      {"/@name", Text, "", "", "", "", "", "name of the body"},
      {"/@frame", Text, "", "", "", "", "", "`fixed`, or `free`: free-free modes, rigid modes removed"},
      {"/@dims", Text, "", "", "", "", "", "meaning of M L T E"},
      {"/rigid/mass", Real, "1", "M", "mass"},
      {"/rigid/cg", Real, "3", "L", "centre of mass from the body origin, body axes"},
      {"/rigid/inertia", Real, "3, 3", "M L^2", "inertia tensor about the body origin, body axes", "", "",
       "products with their sign in the tensor"},
      {"/nodes/id", Integer, "p", "1", "ids of the output nodes"},
      {"/nodes/xyz", Real, "p, 3", "L", "their positions, undeformed, in the body frame"},
      {"/nodes/interface", Integer, "i", "1", "ids of the nodes with geometric stiffness for loads along x y z", "", "",
       "nodes that have locators: forces (directions 1..3) and, unless excluded, unit moments (4..6)"},
      {"/modes/frequency_hz", Real, "n", "1/T", "natural frequency, cycles per unit of time"},
      {"/modes/eigenvalue", Real, "n", "1/T^2", "eigenvalue of K phi = lambda M phi"},
      {"/modes/kind", Text, "n", "1", "normal, constraint, attachment or residual mode"},
      {"/modes/phi", Real, "p, 6, n", "L/E, 1/E",
       "mode shapes at the output nodes: node, then translations x y z and rotations x y z, then mode; body axes"},
      {"/modal/mass", Real, "n, n", "M L^2/E^2", "modal mass"},
      {"/modal/stiffness", Real, "n, n", "M L^2/(T^2 E^2)", "modal stiffness"},
      {"/modal/damping", Real, "n, n", "M L^2/(T E^2)", "modal damping"},
      {"/accuracy/mass", Real, "1", "1", "what modal/mass differs by from that of the shapes", "where it was measured",
       "", "[difference](../verification/checks.md) from recomputed ΦᵀMΦ"},
      {"/accuracy/stiffness", Real, "1", "1", "what modal/stiffness differs by from that of the shapes",
       "where it was measured", "", "from ΦᵀKΦ"},
      {"/effective_mass", Real, "n, 6", "M, M L^2",
       "modal effective mass: mode, translations x y z and rotations x y z about the body origin"},
  };
}

std::vector<LayoutRow> list_integral_rows() {
  using enum ArrayKind;
  constexpr const char* kSets = "of the sets that the model has";
  return {
      {"/integrals@method", Text, "", "", "", "", "", "set that the solver uses: `lumped`, `consistent`, `exact`"},
      {"/integrals@masses", Text, "", "", "", "where it is known", "",
       "`bodies`: F_I, the exact set and K_G1 have the position of each mass; `nodal momenta`: part of M is not that "
       "of bodies ([carried bodies](../theory/carried-bodies.md))"},
      {"/integrals/{method}/gamma0", Real, "n, 3", "M L/E", "sum of m phi_j: row j", kSets, "",
       "method: `lumped`, `consistent`, `exact`"},
      {"/integrals/{method}/gamma1", Real, "n, 3", "M L^2/E", "sum of J psi_j + p x m phi_j: row j", kSets},
      {"/integrals/{method}/gamma2", Real, "n, n, 3", "M L^2/E^2", "sum of m phi_j x phi_k: j, k, axis", kSets},
      {"/integrals/{method}/gamma3", Real, "n, 3, 3", "M L^2/E", "linear change of inertia: j, 3 x 3", kSets},
      {"/integrals/{method}/gamma4", Real, "n, n, 3, 3", "M L^2/E^2", "quadratic change of inertia: j, k, 3 x 3",
       kSets},
  };
}

std::vector<LayoutRow> list_stiffening_rows() {
  using enum ArrayKind;
  constexpr const char* kPreload = "with a preload";
  constexpr const char* kLoads = "with inertial loads of the nodes";
  return {
      {"/inertial_loads/f", Real, "d, 12", "M, M L per unit of translations and rotations",
       "F_I: nodal loads per unit of each of the twelve inertial loads; rows as /dof_map, columns as `loads`", kLoads},
      {"/inertial_loads/f@loads", Text, "12", "", "", kLoads, "", "names of the columns"},
      {"/dof_map", Integer, "d, 2", "1", "a row per degree of freedom: node id, code 1..6 (0: scalar point)",
       "with F_I or `--full`"},
      {"/stiffening/kg_inertial", Real, "12, n, n", "M L/E^2 per L/T^2, M L^2/E^2 per 1/T^2",
       "K_G1: modal geometric stiffness per unit of each inertial load, in the order of `loads`; zero where not "
       "computed"},
      {"/stiffening/kg_inertial@loads", Text, "12", "", "", "", "", "names of the loads"},
      {"/stiffening/kg_inertial@computed", Integer, "12", "", "", "", "", "values of `/stiffening/computed`"},
      {"/stiffening/computed", Integer, "12", "1", "1 where kg_inertial was computed"},
      {"/stiffening/kg_external", Real, "l, n, n", "M L^2/(T^2 E^2) per load",
       "K_G2: modal geometric stiffness per unit of each locator's load"},
      {"/stiffening/locator/name", Text, "l", "1", "name of the locator", "", "",
       "those of interface nodes come first"},
      {"/stiffening/locator/node", Integer, "l", "1", "node id; 0 for a load pattern"},
      {"/stiffening/locator/direction", Integer, "l", "1", "1..6 in body axes; 0 for a load pattern", "", "",
       "4..6: unit moments"},
      {"/stiffening/external_load", Real, "n, l", "M L^2/(T^2 E) per load",
       "generalized force of each locator's load: mode, locator", "", "", "ΦᵀF_ext"},
      {"/stiffening/load_resultant", Real, "6, l", "M L/T^2, M L^2/T^2 per load",
       "force x y z and moment x y z about the body origin of each locator's load: component, locator",
       "absent in the oldest files"},
      {"/stiffening/load_moment", Real, "l, 3, n", "M L^2/(T^2 E) per load",
       "what each mode adds to that moment, sum of phi_j x f: locator, axis, mode", "with `load_resultant`"},
      {"/preload@loads", Text, "", "", "", kPreload, "", "what preloads the body"},
      {"/preload/inertial", Real, "12", "L/T^2, 1/T^2",
       "inertial load factors A_I among the preload; the solver takes their K_G1 off the modal stiffness, as the "
       "motion brings it",
       kPreload, "", "subtracted: Σ A_I K_G1"},
      {"/stiffening/kg_preload", Real, "n, n", "M L^2/(T^2 E^2)",
       "modal geometric stiffness of the preload, part of /modal/stiffness", kPreload, "",
       "K_G0 of a [preload](../theory/preload.md)"},
  };
}

std::vector<LayoutRow> list_third_order_rows() {
  using enum ArrayKind;
  constexpr const char* kThird = "with `order = 3`";
  constexpr const char* kNext = "of a body of second order whose series exist";
  return {
      {"/third_order/directions", Real, "N, n", "1", "large amplitudes by those of all modes: direction, mode",
       "in place of `large`, with residual vectors", "0.4",
       "y = directions · η; the tables of degrees 3 to 6 are polynomials of y "
       "([large directions](../theory/third-order.md#static-manifold))"},
      {"/third_order/large", Integer, "N", "1", "the large modes, from 1", kThird, "0.3",
       "ascending; a reader that ignores the group has all of second order"},
      {"/third_order/energy_{k}", Real, "C(N+k-1, k)", "M L^2/(T^2 E^{k})",
       "strain energy of degree {k} in the large modes: monomials in ascending lexical order of their exponents",
       kThird, "0.3", "k = 3..6, beyond ½ ηᵀKη ([third order](../theory/third-order.md))"},
      {"/third_order/energy_small", Real, "C(N+1, 2), n-N", "M L^2/(T^2 E^3)",
       "strain energy of two large modes and another one: monomials of the large modes of degree 2, the other modes",
       kThird, "0.3", "zero: amplitudes of the others are counted from their values that follow the large ones"},
      {"/third_order/fields", Real, "p, 6, m", "M^-1/2, M^-1/2/L",
       "displacement fields beyond the modes, orthonormal under the mass: output node, translations and rotations, "
       "field",
       kThird, "0.3", "ψ, moved by given amplitudes"},
      {"/third_order/amplitudes_2", Real, "C(n+1, 2), m", "M^1/2 L/E^2",
       "amplitudes of the fields, degree 2 in all modes: monomials, fields", kThird, "0.3"},
      {"/third_order/amplitudes_{k}", Real, "C(N+k-1, k), m", "M^1/2 L/E^{k}",
       "amplitudes of the fields, degree {k} in the large modes: monomials, fields", kThird, "0.3", "k = 3, 4"},
      {"/third_order/node_2", Real, "i, C(n+1, 2), 6", "L/E^2, 1/E^2",
       "displacements of the interface nodes, degree 2 in all modes: node, monomials, translations and rotation vector",
       kThird, "0.3", "beyond φη"},
      {"/third_order/node_{k}", Real, "i, C(N+k-1, k), 6", "L/E^{k}, 1/E^{k}",
       "displacements of the interface nodes, degree {k} in the large modes: node, monomials, translations and "
       "rotation "
       "vector",
       kThird, "0.3", "k = 3, 4"},
      {"/third_order/load_2", Real, "C(n+1, 2), l", "M L^2/(T^2 E^2) per load",
       "work of each locator's load, degree 2 in all modes: monomials, locator", kThird, "0.3", "beyond that on φη"},
      {"/third_order/load_{k}", Real, "C(N+k-1, k), l", "M L^2/(T^2 E^{k}) per load",
       "work of each locator's load, degree {k} in the large modes: monomials, locator", kThird, "0.3", "k = 3, 4"},
      {"/third_order/coupling", Real, "n, m", "M L^2/E^2", "mass between modes and fields", "where it is not zero",
       "0.3", "ΦᵀMψ"},
      {"/third_order/integrals/gamma0", Real, "n+m, 3", "M L/E", "sum of m phi_j: row j", kThird, "0.3",
       "of the n + m shapes [Φ ψ], by the method of `/integrals@method`"},
      {"/third_order/integrals/gamma1", Real, "n+m, 3", "M L^2/E", "sum of J psi_j + p x m phi_j: row j", kThird,
       "0.3"},
      {"/third_order/integrals/gamma2", Real, "n+m, n+m, 3", "M L^2/E^2", "sum of m phi_j x phi_k: j, k, axis", kThird,
       "0.3"},
      {"/third_order/integrals/gamma3", Real, "n+m, 3, 3", "M L^2/E", "linear change of inertia: j, 3 x 3", kThird,
       "0.3"},
      {"/third_order/integrals/gamma4", Real, "n+m, n+m, 3, 3", "M L^2/E^2", "quadratic change of inertia: j, k, 3 x 3",
       kThird, "0.3"},
      {"/next_order/modes", Integer, "s", "1", "soft modes, from 1", kNext, "0.3",
       "at most 4 of the softest normal modes, ascending; absent in models of more than 1,666 elements "
       "([series](../theory/third-order.md#next-order))"},
      {"/next_order/energy_{k}", Real, "C(s+k-1, k)", "M L^2/(T^2 E^{k})",
       "strain energy of degree {k} in the soft modes: monomials in ascending lexical order of their exponents", kNext,
       "0.3", "k = 3, 4; `run.linear-limit` reads it"},
  };
}

std::vector<LayoutRow> list_recovery_rows() {
  using enum ArrayKind;
  constexpr const char* kRecover = "with `recover`";
  constexpr const char* kEnergy = "with `--strain-energy`";
  return {
      {"/recovery/inertial_load", Real, "n, 12", "M L/E per L/T^2, M L^2/E per 1/T^2",
       "generalized load of each inertial load, as kg_inertial has them: mode, load", kRecover, "", "ΦᵀF_I"},
      {"/recovery/elements/{name}/id", Integer, "e", "1", "element ids", kRecover, "",
       "elements of one card with the same rows ([recovery](../theory/recovery.md))"},
      {"/recovery/elements/{name}/component", Text, "c", "1",
       "what the rows of each element are: forces, then stresses as stress_xx@point", kRecover},
      {"/recovery/elements/{name}/matrix", Real, "e, c, n", "F/E", "per modal coordinate: element, component, mode",
       kRecover},
      {"/recovery/elements/{name}/matrix_{k}", Real, "e, c, monomials of degree k", "F/E^{k}",
       "per product of {k} modal coordinates, of the large ones from degree 3 on: element, component, monomial, in "
       "ascending lexical order of their exponents",
       "with `recover` and `order = 3`", "0.4", "k = 2..4; rows of `/third_order/amplitudes_k`"},
      {"/recovery/elements/{name}/inertial", Real, "e, c, 12", "F per L/T^2, 1/T^2",
       "residual of the modes in the static answer to each inertial load: element, component, load", kRecover},
      {"/recovery/elements/{name}/external", Real, "e, c, l", "F per load",
       "the same of each locator's load: element, component, locator", kRecover},
      {"/recovery/elements/{name}/offset", Real, "e, c, 1", "F", "of the preload, at rest: element, component, 1",
       kRecover},
      {"/strain_energy/id", Integer, "a", "1", "element ids", kEnergy},
      {"/strain_energy/card", Text, "a", "1", "card of each", kEnergy},
      {"/strain_energy/matrix", Real, "a, n(n+1)/2", "F L/E^2",
       "energy of an element is eta^T k eta / 2: element, upper triangle of k row by row", kEnergy, "",
       "k = φᵀK_eφ; their sum is `/modal/stiffness` minus `kg_preload`"},
      {"/full/phi", Real, "d, n", "L/E, 1/E", "mode shapes at every degree of freedom: rows as /dof_map",
       "with `--full`"},
      {"/mesh/phi", Single, "g, 3, n", "L/E",
       "mode shapes of all grids, to be drawn: grid, translation x y z, mode; body axes, single precision",
       "if a grid of an element is no output node, without `--full`", "0.2", "12 bytes per grid and mode"},
  };
}

}  // namespace

Layout make_flex_body_layout() {
  return {"bough-flexbody", "flexbody",
          join_rows({list_root_rows(), list_body_rows(), list_integral_rows(), list_stiffening_rows(),
                     list_third_order_rows(), list_recovery_rows(), list_mesh_rows()})};
}

}  // namespace bough::hdf5
