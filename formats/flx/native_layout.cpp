#include <fmt/format.h>

#include "base/diagnostic.hpp"
#include "formats/flx/layout.hpp"

namespace bough::flx {

namespace {

/// Every line starts with its label and the indices of its first value (docs/formats/flx.md). The reader uses the
/// labels, not the columns.
constexpr const char* kNative = R"layout(
text "FLX {version} Bough flexible body, see docs/formats/flx.md"
text "BODY {body_id}"
text "NAME {name}"
text "MODOPT {modopt}"
text "METHOD {method}"
text "DIGITS {digits}"
text "NMODE {num_modes}"
text "NNODE {num_nodes}"
text "NSPECIAL {num_special}"
text "MASS {mass}"
block modes per_line=1 label="MODE {j:%4d}" heading="! mode, its number in the source"
block mass record=j per_line=5 label="GMASS {j:%4d} {k:%4d}" heading="! generalized mass: j, k, values k, k+1, ..."
block stiffness record=j per_line=5 label="GSTIF {j:%4d} {k:%4d}" heading="! generalized stiffness"
block damping record=j per_line=5 label="GDAMP {j:%4d} {k:%4d}" heading="! generalized damping"
block alpha label="ALPHA {j:%4d}" heading="! integrals of zero order: j, x y z; alpha = gamma0 / mass"
block gamma1 label="GAMMA1 {j:%4d}"
block gamma2 label="GAMMA2 {j:%4d} {k:%4d}" heading="! integrals of first order: j, k, x y z; j, row, x y z"
block gamma3 label="GAMMA3 {j:%4d} {a:%1d}"
block gamma4 label="GAMMA4 {j:%4d} {k:%4d} {a:%1d}" heading="! integrals of second order: j, k, row, x y z"
block node_xyz nodes=output label="NODE {node:%8d}" heading="! nodes: id, x y z"
block phi nodes=output label="PHI {node:%8d} {j:%4d}" heading="! gains: node, mode, translations or rotations"
block psi nodes=output label="PSI {node:%8d} {j:%4d}"
block node_id nodes=special record=i label="SNODE" heading="! special nodes: without gains, then unit x in mode j"
block phi nodes=special label="SPHI {node:%8d} {j:%4d}"
block psi nodes=special label="SPSI {node:%8d} {j:%4d}"
when rigid
text "! extension of version 1.1, which readers of 1.0 pass over: mass centre, inertia about the origin"
block cg label="!+ CG"
block inertia label="!+ INERTIA {a:%1d}"
text "!+ FRAME {frame}"
for j
text "!+ KIND {j:%4d} {kind}"
end
block gamma0 label="!+ GAMMA0 {j:%4d}" heading="! of which alpha is a part that lost its last digit"
end
when stiffening
text "! geometric stiffness: l, j, k, values k, k+1, ... of each inertial load; of each locator"
text "!+ NLOCATOR {num_locators}"
text "!+ INTERFACE {interface}"
for e
text "!+ LOCATOR {e:%4d} {locator_node} {locator_direction} {locator}"
end
block kg_inertial per_line=5 label="!+ KG1 {l:%2d} {j:%4d} {k:%4d}"
block kg_external per_line=5 label="!+ KG2 {e:%4d} {j:%4d} {k:%4d}"
block external_load per_line=5 label="!+ LOAD {e:%4d} {j:%4d}"
block load_resultant label="!+ RESULTANT {e:%4d}"
block load_moment per_line=5 label="!+ MOMENT {e:%4d} {a:%1d} {j:%4d}"
end
when preload
text "!+ PRELOAD {preload}"
block kg_preload per_line=5 label="!+ KGP {j:%4d} {k:%4d}"
block preload_factor per_line=1 label="!+ FACTOR {l:%2d}"
end
text "END"
)layout";

}  // namespace

Layout make_native_layout(int digits) {
  BOUGH_DEMAND(digits >= 2 && digits <= 17);
  // Sign, point, exponent of three digits and a blank besides the digits.
  const std::string number = fmt::format("%{}.{}E", digits + 8, digits - 1);
  std::string text = fmt::format("number {}\ninteger %8d\n", number) + kNative;
  const std::string mass = "{mass}";
  text.replace(text.find(mass), mass.size(), "{mass:" + number + "}");
  auto layout = parse_layout(text, "native layout");
  layout.digits = digits;
  return layout;
}

}  // namespace bough::flx
