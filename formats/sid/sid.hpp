#pragma once
/// \file Standard Input Data of a flexible body (O. Wallrapp, "Standardization of flexible body modeling in multibody
/// system codes, Part I: definition of standard input data", Mech. Struct. & Mach. 22 (1994) 283-304), file .SID_FEM.
///
/// Block by block with signs: docs/formats/sid.md.
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/flex_body.hpp"

namespace bough::sid {

using Eigen::MatrixXd;

/// M(q) = m0 + Σ_k m1[k] q_k.
struct Taylor {
  MatrixXd m0;               ///< rows x columns
  std::vector<MatrixXd> m1;  ///< [k] rows x columns, k = 0..nq-1; empty: order 0

  /// Zero series of order 0.
  static Taylor zero(Eigen::Index rows, Eigen::Index columns) { return {MatrixXd::Zero(rows, columns), {}}; }
  /// Zero series with a first order of nq zero matrices.
  static Taylor zero(Eigen::Index rows, Eigen::Index columns, int nq);
  /// m0 + Σ_k m1[k] q_k; q: nq, not read with order 0.
  MatrixXd evaluate(const Eigen::Ref<const Eigen::VectorXd>& q) const;
};

struct Node {
  std::string id;
  Taylor origin;  ///< 3 x 1, place in the body frame
  Taylor phi;     ///< 3 x nq, the Jacobian of the place: m1 is the stiffening by a force here
  Taylor psi;     ///< 3 x nq, of the rotation; m1 is the stiffening by a moment here
  Taylor AP;      ///< 3 x 3, axes of the node in the body frame
};

struct Sid {
  std::string comment;
  double mass = 0;
  std::vector<std::string> mode_name;  ///< nq
  std::vector<Node> nodes;
  Taylor mdCM;    ///< 3 x 1, first moment of mass
  Taylor J;       ///< 6 x 1 (11 22 33 12 13 23 of the tensor) or 3 x 3
  Taylor Ct, Cr;  ///< nq x 3
  Taylor Me;      ///< nq x nq
  Taylor Gr;      ///< 3 x 3nq, blocks of 3 columns by mode
  Taylor Ge;      ///< nq x 3nq, column 3 k + a, or a nq + k where by_component
  Taylor Oe;      ///< nq x 6, of ω1² ω2² ω3² ω1ω2 ω2ω3 ω1ω3
  Taylor ksigma;  ///< nq x 1
  Taylor Ke, De;  ///< nq x nq

  /// Number nq of modes.
  int num_modes() const { return static_cast<int>(mode_name.size()); }
};

/// Where files of this name differ.
struct Layout {
  bool is_full_inertia = false;  ///< J as 3 x 3 instead of 6 x 1
  bool by_component = false;     ///< columns of Ge by component instead of by mode
  int digits = 17;
};

/// All coefficients that the integrals (the set that the body names) and the geometric stiffness give. Warns
/// "export.no-stiffening" where a first order is zero because its K_G was not computed. Throws InputError
/// "export.no-integrals".
Sid make_sid(const records::FlexBody& body, const Layout& layout, const SourceLocation& where,
             Diagnostics& diagnostics);

/// Writes the blocks of the file in the order of the standard, numbers with layout.digits.
std::string write_sid(const Sid& sid, const Layout& layout);

/// Throws InputError "export.sid-syntax", "export.sid-missing", "export.sid-shape" with the line.
Sid read_sid(const std::string& path);

/// Residuals of the relations between blocks of any SID file, as |difference| / |largest entry| (0 if both are zero).
struct Relations {
  double mdCM_Ct = 0;         ///< mdCM.m1 = Ctᵀ
  double Gr_J = 0;            ///< symmetric part of Gr = J.m1
  double Oe_J = 0;            ///< Oe.m0 = -½ J.m1 on the diagonal, -J.m1 off it
  double Ge_Cr = 0;           ///< Ge = Cr.m1 minus its transpose in the modes, in the better of the two column orders
  bool by_component = false;  ///< that order
  double AP_psi = 0;          ///< AP.m1 = skew(psi), worst node
  double origin_phi = 0;      ///< origin.m1 = phi, worst node
};
/// Computes the differences, each relative to the larger of its two sides; a body without modes has none.
Relations calc_relations(const Sid& sid);

}  // namespace bough::sid
