#include "formats/hdf5/layouts/rows.hpp"

namespace bough::hdf5 {

namespace {

std::vector<LayoutRow> list_node_rows() {
  using enum ArrayKind;
  return {
      {"/@subcase", Integer, "", "", "", "", "", "number of the subcase"},
      {"/nodes/id", Integer, "p", "1", "ids of the nodes"},
      {"/nodes/xyz", Real, "p, 3", "L", "their positions, basic system"},
  };
}

std::vector<LayoutRow> list_modes_rows() {
  using enum ArrayKind;
  constexpr const char* kAbout = "with `--meffmass GRID`";
  constexpr const char* kEnergies = "with `--ese`";
  return {
      {"/rigid/mass", Real, "1", "M", "mass, mean of the three directions"},
      {"/rigid/cg", Real, "3", "L", "centre of mass, basic system"},
      {"/rigid/inertia", Real, "3, 3", "M L^2", "inertia tensor about the reference point, basic axes"},
      {"/rigid/reference", Real, "3", "L", "reference point, basic system"},
      {"/rigid/mass_matrix", Real, "6, 6", "M, M L, M L^2",
       "rigid-body mass matrix about the reference point, translations first", "", "", "Φ_Rᵀ M Φ_R"},
      {"/modes/frequency_hz", Real, "n", "1/T", "natural frequency, cycles per unit of time"},
      {"/modes/eigenvalue", Real, "n", "1/T^2", "eigenvalue"},
      {"/modes/kind", Text, "n", "1", "normal, constraint, attachment or residual mode"},
      {"/modes/phi", Real, "p, 6, n or b", "L/E, 1/E",
       "mode shapes at the output nodes: node, then translations x y z and rotations x y z, then mode; body axes", "",
       "", "of all nodes, in basic axes; of buckling b shapes"},
      {"/modes/residual", Real, "n or 0", "1", "|K phi - lambda M phi| / |K phi|; absolute for rigid modes", "", "",
       "[scaled](../theory/modes.md#residual)"},
      {"/modes/mass", Real, "n or 0", "M L^2/E^2", "modal mass", "", "",
       "of `phi`: 1, or as NORM of the deck (MAX, POINT) has it"},
      {"/modes@num_rigid", Integer, "", "", "", "", "",
       "rigid modes among them: zeros, first but for eigenvalues below zero ([preload](../theory/preload.md))"},
      {"/modes@inertia_count", Integer, "", "", "", "", "",
       "eigenvalues below the highest by the inertia of the factor; -1: not checked, or not to be trusted"},
      {"/effective_mass", Real, "n or 0, 6", "M, M L^2",
       "modal effective mass: mode, translations x y z and rotations x y z about the origin"},
      {"/buckling/load_factor", Real, "b", "1", "factor on the load set at which K + factor K_G is singular",
       "with `--buckling`"},
      {"/energies/id", Integer, "a", "1", "element ids", kEnergies, "", "elements with stiffness or mass"},
      {"/energies/property", Integer, "a", "1", "property ids; 0: none", kEnergies},
      {"/energies/card", Text, "a", "1", "their cards", kEnergies},
      {"/energies/strain", Real, "a, n", "F L/E^2",
       "strain energy of each element in each mode, half phi K_e phi: element, mode", kEnergies, "",
       "of a preloaded deck with its geometric stiffness"},
      {"/energies/kinetic", Real, "a, n", "M L^2/E^2",
       "half phi M_e phi, which times omega^2 is the kinetic energy: element, mode", kEnergies},
      {"/energies/total_strain", Real, "n", "F L/E^2", "of the whole stiffness", kEnergies},
      {"/energies/total_kinetic", Real, "n", "M L^2/E^2", "of the whole mass", kEnergies},
      {"/effective_mass_about/mass", Real, "n, 6", "M, M L^2",
       "modal effective mass: mode, translations x y z and rotations x y z about the grid", kAbout},
      {"/effective_mass_about/rigid", Real, "6, 6", "M, M L, M L^2",
       "rigid-body mass matrix about the grid, translations first", kAbout},
      {"/effective_mass_about@grid", Integer, "", "", "", kAbout, "", "the grid"},
  };
}

std::vector<LayoutRow> list_complex_rows() {
  using enum ArrayKind;
  constexpr const char* kLeft = "where the matrices are not symmetric";
  constexpr const char* kPoints = "with scalar or extra points";
  constexpr const char* kLeftPoints = "with such points, where the matrices are not symmetric";
  return {
      {"/modes/eigenvalue_real", Real, "m", "1/T", "eigenvalue, real part; below 0: stable", "", "", "Re λ"},
      {"/modes/eigenvalue_imag", Real, "m", "1/T", "eigenvalue, imaginary part", "", "", "Im λ"},
      {"/modes/frequency_hz", Real, "m", "1/T", "imaginary part / 2 pi, cycles per unit of time"},
      {"/modes/damping", Real, "m", "1", "structural damping g = -2 Re / Im, as Nastran prints it"},
      {"/modes/damping_ratio", Real, "m", "1", "share of critical damping, -Re / abs", "", "", "ζ = -Re λ / abs(λ)"},
      {"/modes/residual", Real, "m", "1",
       "|(lambda^2 M + lambda B + K) phi| over the sum of the norms of the three terms"},
      {"/modes/biorthogonality", Real, "1", "1",
       "largest off-diagonal term of Psi^T ((lambda_i + lambda_j) M + B) Phi, relative to its diagonal; below 0: not "
       "available"},
      {"/modes@method", Text, "", "", "", "", "", "`direct` (SOL 107) or `modal` (110)"},
      {"/modes@norm", Text, "", "", "", "", "", "MAX or POINT"},
      {"/modes/phi_real", Real, "p, 6, m", "1, 1/L",
       "complex mode shapes, real part: node, translations x y z and rotations x y z in basic axes, mode", "", "",
       "NORM of EIGC"},
      {"/modes/phi_imag", Real, "p, 6, m", "1, 1/L",
       "complex mode shapes, imaginary part: node, translations x y z and rotations x y z in basic axes, mode"},
      {"/modes/left_real", Real, "p, 6, m", "1, 1/L",
       "left eigenvectors psi, psi^T (lambda^2 M + lambda B + K) = 0, real part: node, translations x y z and "
       "rotations "
       "x y z in basic axes, mode",
       kLeft, "", "else ψ = φ"},
      {"/modes/left_imag", Real, "p, 6, m", "1, 1/L",
       "left eigenvectors psi, psi^T (lambda^2 M + lambda B + K) = 0, imaginary part: node, translations x y z and "
       "rotations x y z in basic axes, mode",
       kLeft},
      {"/points/id", Integer, "q", "1", "ids of scalar and extra points", kPoints},
      {"/points/phi_real", Real, "q, m", "1", "complex mode shapes, real part: point, mode", kPoints},
      {"/points/phi_imag", Real, "q, m", "1", "complex mode shapes, imaginary part", kPoints},
      {"/points/left_real", Real, "q, m", "1", "left eigenvectors, real part: point, mode", kLeftPoints},
      {"/points/left_imag", Real, "q, m", "1", "left eigenvectors, imaginary part", kLeftPoints},
  };
}

std::vector<LayoutRow> list_rotor_rows() {
  using enum ArrayKind;
  constexpr const char* kRotors = "with [rotors](../theory/rotors.md)";
  constexpr const char* kSweep = "with modes over the speeds";
  return {
      {"/modes/whirl", Real, "m", "1", "1: forward circle, -1: backward circle, 0: line", kRotors},
      {"/modes/speed", Real, "1", "1/T", "of the reference rotor; below 0: that of each mode", kRotors, "",
       "radians per unit of time"},
      {"/rotors/id", Integer, "r", "1", "ids of the rotors", kRotors},
      {"/rotors/num_grids", Integer, "r", "1", "grids on the axis of each", kRotors},
      {"/rotors/num_elements", Integer, "r", "1", "elements of each", kRotors},
      {"/rotors/mass", Real, "r", "M", "mass of each", kRotors},
      {"/rotors/polar_inertia", Real, "r", "M L^2", "moment of inertia of each about its axis", kRotors},
      {"/rotors@reference", Integer, "", "", "", kRotors, "", "id of the rotor whose speed is given"},
      {"/rotors@synchronous", Integer, "", "", "", kRotors, "", "1: synchronous analysis"},
      {"/campbell/speed", Real, "s", "1/T", "speed of the reference rotor, radians per unit of time", kSweep},
      {"/campbell/real", Real, "s, b", "1/T", "speed, branch: a column is one motion all along", kSweep, "",
       "`bough plot --kind campbell` draws them"},
      {"/campbell/imag", Real, "s, b", "1/T", "speed, branch", kSweep},
      {"/campbell/frequency_hz", Real, "s, b", "1/T", "imaginary part / 2 pi", kSweep},
      {"/campbell/damping", Real, "s, b", "1", "-real / |eigenvalue|", kSweep},
      {"/campbell/correlation", Real, "s, b", "1", "with the motion at the speed before", kSweep},
      {"/campbell/whirl", Real, "s, b", "1", "1: forward circle, -1: backward circle, 0: line", kSweep},
      {"/critical/branch", Integer, "c", "1", "column of /campbell, or mode of synchronous analyses, from 0", kRotors,
       "", "Im λ = speed of a mode that [resonates](../theory/rotors.md#speeds)"},
      {"/critical/speed", Real, "c", "1/T", "of the reference rotor, radians per unit of time", kRotors},
      {"/critical/frequency_hz", Real, "c", "1/T", "of the motion there", kRotors},
      {"/critical/whirl", Real, "c", "1", "as /campbell/whirl", kRotors},
      {"/thresholds/branch", Integer, "t", "1", "column of /campbell that becomes unstable or stable, from 0", kRotors,
       "", "Re λ = 0"},
      {"/thresholds/speed", Real, "t", "1/T", "of the reference rotor, radians per unit of time", kRotors},
      {"/thresholds/frequency_hz", Real, "t", "1/T", "of the motion there", kRotors},
      {"/thresholds/whirl", Real, "t", "1", "as /campbell/whirl", kRotors},
      {"/thresholds/onset", Integer, "t", "1", "1: unstable above the speed, 0: below it", kRotors, "0.4",
       "absent in older files: 1"},
  };
}

}  // namespace

Layout make_modes_layout() {
  return {"bough-modes", "modes", join_rows({list_root_rows(), list_node_rows(), list_modes_rows(), list_mesh_rows()})};
}

Layout make_complex_modes_layout() {
  return {"bough-complex-modes", "modes",
          join_rows({list_root_rows(), list_node_rows(), list_complex_rows(), list_rotor_rows(), list_mesh_rows()})};
}

}  // namespace bough::hdf5
