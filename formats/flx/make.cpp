#include <algorithm>
#include <numeric>

#include "base/diagnostic.hpp"
#include "formats/flx/flx_file.hpp"

namespace bough::flx {

namespace {

const records::MassIntegrals& choose_integrals(const records::FlexBody& body, const std::string& method) {
  const auto& chosen = method == "lumped" ? body.lumped : method == "consistent" ? body.consistent : body.exact;
  if (!chosen.empty() || body.num_modes() == 0) return chosen;
  std::string found;
  if (!body.lumped.empty()) found += " lumped";
  if (!body.consistent.empty()) found += " consistent";
  if (!body.exact.empty()) found += " exact";
  throw InputError(
      "flx.no-integrals", {},
      "body \"" + body.name + "\" holds no " + method + " integrals, found" + (found.empty() ? " none" : found),
      "choose a set that it holds, or reduce it again");
}

/// The solver feeds the force of stiffening of mode j through a jet at its own node (NASA-CR-202063 4.1.3).
void add_special_nodes(FlxFile& file) {
  const int n = file.num_modes();
  int last = 0;
  for (int id : file.node_id) last = std::max(last, id);
  for (int s = 0; s <= n; ++s) {
    file.special_id.push_back(last + 1 + s);
    MatrixXd gains = MatrixXd::Zero(6, n);
    if (s > 0) gains(0, s - 1) = 1;
    file.special_gains.push_back(gains);
  }
}

/// A text that stays on its line.
std::string make_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return text;
}

void add_rigid(FlxFile& file, const records::FlexBody& body) {
  file.has_rigid = true;
  file.more.cg = body.cg;
  file.more.inertia = body.inertia;
  file.more.is_free_free = body.is_free_free;
  file.more.kind = body.kind;
  file.more.kind.resize(static_cast<std::size_t>(file.num_modes()), records::ModeKind::Normal);
}

void add_stiffening(FlxFile& file, const records::FlexBody& body) {
  file.has_stiffening = true;
  auto& more = file.more;
  more.interface_nodes = body.interface_nodes;
  more.kg_inertial = body.kg_inertial;
  more.kg_inertial_computed = body.kg_inertial_computed;
  more.locators = body.locators;
  for (auto& locator : more.locators) locator.name = make_line(locator.name);
  more.kg_external = body.kg_external;
  more.external_load = body.external_load;
  more.load_resultant = body.load_resultant;
  more.load_moment = body.load_moment;
  more.preload = make_line(body.preload);
  more.kg_preload = body.kg_preload;
  more.preload_A_I = body.preload_A_I;
}

}  // namespace

FlxFile make_flx(const records::FlexBody& body, const MakeOptions& options) {
  FlxFile file;
  file.body_id = options.body_id;
  file.name = make_line(body.name);
  file.modopt = options.modopt;
  file.method = options.method.empty() ? body.integrals_method : options.method;
  file.digits = options.digits;
  file.mass = body.mass;
  if (body.mass <= 0)
    throw InputError("flx.bad-value", {}, "body \"" + body.name + "\" has no mass",
                     "alpha is the integral over the mass");
  file.modes = options.modes;
  if (file.modes.empty()) {
    file.modes.resize(static_cast<std::size_t>(body.num_modes()));
    std::iota(file.modes.begin(), file.modes.end(), 1);
  }
  file.M = body.modal_mass;
  file.K = body.modal_stiffness;
  file.D = body.modal_damping;
  file.integrals = choose_integrals(body, file.method);
  file.alpha = file.integrals.gamma0 / body.mass;
  file.node_id = body.node_id;
  file.node_xyz = body.node_xyz;
  file.gains = body.phi;
  if (options.has_special_nodes) add_special_nodes(file);
  if (!body.inertia.isZero(0)) add_rigid(file, body);
  if (options.has_stiffening) add_stiffening(file, body);
  return file;
}

}  // namespace bough::flx
