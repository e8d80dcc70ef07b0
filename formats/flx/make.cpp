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

}  // namespace

FlxFile make_flx(const records::FlexBody& body, const MakeOptions& options) {
  FlxFile file;
  file.body_id = options.body_id;
  file.name = body.name;
  std::replace_if(
      file.name.begin(), file.name.end(), [](unsigned char c) { return c < ' '; }, ' ');
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
  return file;
}

}  // namespace bough::flx
