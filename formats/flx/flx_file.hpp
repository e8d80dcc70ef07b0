#pragma once
/// \file A .FLX file (NASA-CR-202063 4.1.3, 4.2.3; docs/formats/flx.md): made from a flexible body, written and read.
#include <optional>
#include <string>
#include <vector>

#include "formats/flx/layout.hpp"
#include "formats/records/flex_body.hpp"

namespace bough::flx {

using records::MatrixXd;

struct FlxFile {
  int body_id = 1;
  std::string name;
  int modopt = 0;      ///< 0 all integrals, 1 without Γ4, 2 without Γ2, Γ3, Γ4
  std::string method;  ///< "lumped", "consistent" or "exact"
  double mass = 0;
  int digits = 9;          ///< significant digits of the file
  std::vector<int> modes;  ///< n: number of each mode in its source
  MatrixXd M, K, D;        ///< n x n, generalized
  MatrixXd alpha;          ///< 3 x n: Γ0 / mass
  /// Γ1..Γ4 as far as modopt goes; gamma0 is alpha times mass.
  records::MassIntegrals integrals;
  std::vector<int> node_id;
  MatrixXd node_xyz;            ///< p x 3
  std::vector<MatrixXd> gains;  ///< [k] 6 x n: φ, ψ at the output nodes
  std::vector<int> special_id;  ///< numbers after the largest output node
  std::vector<MatrixXd> special_gains;

  /// Extension of version 1.1 (docs/formats/flx.md), in the fields of a flexible body: with has_rigid gamma0 (else from
  /// alpha), cg, inertia, is_free_free, kind; with has_stiffening interface_nodes, K_G1, the preload and locators with
  /// K_G2 and the responses to their loads.
  bool has_rigid = false, has_stiffening = false;
  records::FlexBody more;

  /// Number of modes in the file.
  int num_modes() const { return static_cast<int>(modes.size()); }
  /// Returns true if the file contains Γ4 (MODOPT 0).
  bool has_gamma4() const { return modopt == 0; }
  /// Returns true if the file contains Γ2 and Γ3 (MODOPT 0 or 1).
  bool has_gamma23() const { return modopt <= 1; }
};

struct MakeOptions {
  int body_id = 1;
  int modopt = 0;
  std::string method;  ///< empty: the set that the body names
  bool has_special_nodes = false;
  bool has_stiffening = false;  ///< K_G1, K_G2 and the preload
  int digits = 9;
  std::vector<int> modes;  ///< their numbers in the source; empty: 1..n
};

/// Scales α and adds the nmode + 1 special nodes: the first without gains, the (j+1)-th with a unit x gain in mode j.
/// Throws InputError("flx.no-integrals") when the body does not hold the set, "flx.bad-value" without a mass.
FlxFile make_flx(const records::FlexBody& body, const MakeOptions& options);

/// The text of one body. Bough's own layout is make_native_layout(digits). Throws
/// InputError("flx.number-too-wide"), "flx.layout-index" or "flx.not-finite".
std::string write_flx(const FlxFile& file, const Layout& layout);

/// Reads Bough's own layout, one body after the other. Throws InputError with all of "flx.not-flx", "flx.version",
/// "flx.bad-line", "flx.missing-block", "flx.same-body" (one id twice).
std::vector<FlxFile> read_flx_bodies(const std::string& path);
/// The body with this id; 0: the only one. Throws "flx.which-body", "flx.no-body" besides.
FlxFile read_flx(const std::string& path, int body_id = 0);

/// "panels.FLX:2" is the body with the id 2 of panels.FLX; body_id 0: none was named.
struct FlxName {
  std::string path;
  int body_id = 0;
};
/// Empty if the file is no .FLX. An existing file is one if its first word is FLX, under any name (TREETOPS:
/// problem.FLN); otherwise, unless it is HDF5, the name decides: .FLX in any case.
std::optional<FlxName> parse_flx_name(const std::string& name);

/// Makes the record of a flexible body. Data that a .FLX cannot contain are empty (mesh, F_I, other sets of integrals)
/// or computed: eigenvalue j is K_jj / M_jj, the effective masses are Γ0² and Γ1² over M_jj about Bo. Integrals that
/// modopt omits are zero. Without `has_rigid` cg and inertia are zero: the caller must set them, as TREETOPS does from
/// its .INT. `lacking`: receives the missing data, as text.
records::FlexBody make_flex_body(const FlxFile& file, std::vector<std::string>& lacking);

}  // namespace bough::flx
