#pragma once
/// \file What a .FLX file holds (NASA-CR-202063 4.1.3, 4.2.3; docs/formats/flx.md), how it is made from a flexible
/// body, written and read.
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

  int num_modes() const { return static_cast<int>(modes.size()); }
  bool has_gamma4() const { return modopt == 0; }
  bool has_gamma23() const { return modopt <= 1; }
};

struct MakeOptions {
  int body_id = 1;
  int modopt = 0;
  std::string method;  ///< empty: the set that the body names
  bool has_special_nodes = false;
  int digits = 9;
  std::vector<int> modes;  ///< their numbers in the source; empty: 1..n
};

/// Scales α and adds the nmode + 1 special nodes: the first without gains, the (j+1)-th with a unit x gain in mode j.
/// Throws InputError("flx.no-integrals") when the body does not hold the set, "flx.bad-value" without a mass.
FlxFile make_flx(const records::FlexBody& body, const MakeOptions& options);

/// The text of the file. Bough's own layout is make_native_layout(digits). Throws
/// InputError("flx.number-too-wide"), "flx.layout-index" or "flx.not-finite".
std::string write_flx(const FlxFile& file, const Layout& layout);

/// Reads Bough's own layout. Throws InputError with all of "flx.not-flx", "flx.version", "flx.bad-line",
/// "flx.missing-block".
FlxFile read_flx(const std::string& path);

}  // namespace bough::flx
