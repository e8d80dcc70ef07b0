#include "analysis/init/init_deck.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

#include "analysis/common/inputs.hpp"
#include "analysis/modes/eigen_choices.hpp"
#include "base/diagnostic.hpp"
#include "fe/matrices/connected_parts.hpp"
#include "fe/statics/build_model.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::analysis {

namespace {

/// Returns true if constraints and springs to ground prevent the six rigid-body motions of the model of the first
/// subcase: an SPC set of rotations of solids alone does not. For a deck with errors: if it has constraints at all.
bool is_constrained(const records::Deck& deck) {
  const bool has_constraints =
      std::any_of(deck.subcases.begin(), deck.subcases.end(), [](const auto& s) { return s.spc > 0; }) ||
      std::any_of(deck.grids.begin(), deck.grids.end(), [](const auto& g) { return g.ps != 0; });
  try {
    Diagnostics diagnostics;
    const auto model = fe::build_model(deck, {}, diagnostics);
    return diagnostics.num_errors() > 0 ? has_constraints : fe::count_held_motions(model) == 6;
  } catch (const Failure&) {
    return has_constraints;
  }
}

/// Axis of a hinge at a grid: z, or y or x where z is the normal of shells that alone meet there. About their normal
/// they leave the grid without mass and nearly without stiffness: the hinge would turn the grid and not the plate.
std::string choose_hinge_axis(const records::Deck& deck, int grid) {
  const std::string axes[] = {"axis = [1.0, 0.0, 0.0]", "axis = [0.0, 1.0, 0.0]", "axis = [0.0, 0.0, 1.0]"};
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  try {
    Diagnostics diagnostics;
    const auto model = fe::build_model(deck, {}, diagnostics);
    for (const auto& element : model.elements()) {
      const auto& nodes = element->nodes();
      if (std::find(nodes.begin(), nodes.end(), model.find_node(grid)) == nodes.end()) continue;
      const auto shape = element->shape();
      if (shape.type == "line2") return axes[2];
      if (shape.type != "tri3" && shape.type != "quad4") continue;
      const auto place = [&](std::size_t k) { return model.node(shape.nodes[k]).x; };
      normal += (place(1) - place(0)).cross(place(2) - place(0)).normalized().cwiseAbs();
    }
  } catch (const Failure&) {
    return axes[2];
  }
  for (const int axis : {2, 1, 0})
    if (normal[axis] <= 0.75 * normal.norm())
      return axes[axis] + (axis == 2 ? "" : "  # z is the normal of the shells at this grid");
  return axes[2];
}

/// Grids at which other structures hang: independent grids of RBE2, reference grids of RBE3, SUPORT. Without those that
/// a constraint holds.
std::vector<int> find_interface(const records::Deck& deck) {
  std::set<int> grids, held;
  for (const auto& rigid : deck.rbe2)
    if (rigid.gm.size() > 1) grids.insert(rigid.gn);
  for (const auto& mean : deck.rbe3) grids.insert(mean.ref_grid);
  for (const auto& support : deck.suport) grids.insert(support.g);
  for (const auto& [set, supports] : deck.suport1)
    for (const auto& support : supports) grids.insert(support.g);
  for (const auto& constraint : deck.spc) held.insert(constraint.g);
  std::vector<int> found;
  for (const auto& grid : deck.grids)
    if (grids.count(grid.id) != 0 && held.count(grid.id) == 0 && grid.ps == 0) found.push_back(grid.id);
  return found;
}

std::string join_ids(const std::vector<int>& ids) { return fmt::format("{}", fmt::join(ids, ", ")); }

/// More are written as a comment: each costs six static solutions.
constexpr std::size_t kMaxInterfaceGrids = 12;

/// [body.modes] as the first subcase's METHOD says.
std::string make_modes_table(const records::Deck& deck, bool is_fixed) {
  const int requested = deck.subcases.empty() ? 0 : deck.subcases.front().method;
  const auto at = std::find_if(deck.eigen_methods.begin(), deck.eigen_methods.end(),
                               [&](const auto& method) { return method.sid == requested; });
  if (at == deck.eigen_methods.end()) return "number = 10              # the deck selects no METHOD\n";
  const auto card = fmt::format("{} {} of the deck", at->is_eigrl ? "EIGRL" : "EIGR", at->sid);
  std::string text;
  // The deck counts the rigid modes, the body file does not.
  const int num_rigid = is_fixed ? 0 : 6;
  if (at->num_modes > num_rigid)
    text += fmt::format("{:<25}# as {}{}\n", fmt::format("number = {}", at->num_modes - num_rigid), card,
                        is_fixed ? "" : ", without six rigid modes");
  const bool is_buckling = deck.sol == "105" || deck.sol == "SEBUCKL";
  if (at->f2 && *at->f2 > 0 && !is_buckling && !counts_whatever_range(*at))
    text += fmt::format("{:<25}# Hz, as {}\n", fmt::format("max_frequency = {}", *at->f2), card);
  if (!text.empty()) return text;
  return fmt::format("number = 10              # {} {}\n", card,
                     at->num_modes > 0 ? "gives no more than the six rigid modes" : "gives no number");
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// A basic TOML string with escapes.
std::string quote_basic(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += is_control(c) ? fmt::format("\\u{:04X}", c) : std::string(1, c);
  }
  return quoted + "\"";
}

/// A path that neither a system file takes for a parameter ("$x") nor a command line for an option ("-x").
std::string make_plain(const std::string& path) {
  return path.starts_with('$') || path.starts_with('-') ? "./" + path : path;
}

/// TOML: a literal string if the path has neither a quote nor control characters.
std::string quote(const std::string& path) {
  const bool is_literal = path.find('\'') == std::string::npos && std::none_of(path.begin(), path.end(), is_control);
  return is_literal ? "'" + make_plain(path) + "'" : quote_basic(make_plain(path));
}

/// A word of a shell in a comment of one line.
std::string make_word(const std::string& path) {
  std::string word;
  bool is_bare = true;
  for (const char c : make_plain(path)) {
    is_bare = is_bare &&
              (std::isalnum(static_cast<unsigned char>(c)) != 0 || std::string("-_./").find(c) != std::string::npos);
    word += c == '\'' ? "'\\''" : std::string(1, is_control(c) ? '?' : c);
  }
  return is_bare ? word : "'" + word + "'";
}

}  // namespace

std::vector<StartFile> make_start_files(const records::Deck& deck, const DeckStart& start) {
  const int grid = start.hinge_grid;
  if (grid > 0 && std::none_of(deck.grids.begin(), deck.grids.end(), [&](const auto& g) { return g.id == grid; }))
    throw InputError("cli.unknown-interface", {start.path},
                     fmt::format("interface node {} is not a grid of {}", grid, start.path), "name a GRID of the deck");
  const bool is_fixed = grid == 0 && is_constrained(deck);
  const auto& name = start.name;
  auto interface = find_interface(deck);
  if (grid > 0) {
    std::erase(interface, grid);
    if (interface.size() >= kMaxInterfaceGrids) interface.clear();
    interface.insert(interface.begin(), grid);
  }
  std::string frame = "frame = \"free\"           # or \"mean\": no constraints of the deck hold the body\n";
  if (is_fixed) frame = "frame = \"fixed\"          # the deck's constraints hold the body frame\n";
  if (grid > 0)
    frame = fmt::format(
        "frame = \"mean\"           # not \"fixed\": modes clamped at a free hinge take nearly all inertia away from "
        "it\n"
        "interface = [{}]          # the hinge; add each grid that a hinge, force or moment loads\n",
        join_ids(interface));
  else if (!interface.empty())
    frame += fmt::format(
        "{}interface = [{}]          # centres of RBE2 and RBE3, SUPORT: where other bodies, forces and moments may "
        "be\n",
        interface.size() > kMaxInterfaceGrids ? "# " : "", join_ids(interface));
  else
    frame += "# interface = [1]        # each grid that a hinge, force or moment loads\n";
  auto modes = make_modes_table(deck, is_fixed);
  // Free-free modes alone come slowly to a shape that the hinge clamps in its other directions (a slender arm: 19 % off
  // with ten of them). The residual vectors do it, and their own fast motion is damped out.
  if (grid > 0)
    modes +=
        "residual = [\"interface\"]  # loads of the hinge in its constrained directions\n\n[body.damping]\n"
        "ratio = 0.005            # of the modes\nresidual_ratio = 1.0     # of the residual vectors: much faster than "
        "the modes\n";
  // Texts that begin with $ are parameters, and a body's name cannot begin with "./".
  auto plain_name = name;
  if (name.starts_with('$')) plain_name.front() = '_';
  std::replace_if(plain_name.begin(), plain_name.end(), is_control, '_');
  const auto body_name = quote_basic(plain_name);
  const auto output = quote_basic(make_plain(name + ".h5"));
  const std::string body = fmt::format(
      "# bough reduce {0}\n[body]\nname = {1}\ndeck = {2}\n{3}\n[body.modes]\n{4}\n[body.output]\nfile = {5}\n",
      make_word(name + ".toml"), body_name, quote(start.path), frame, modes, output);
  std::string hinge = fmt::format("type = \"{}\"\nparent = \"ground\"\nchild = {}\n",
                                  grid > 0   ? "revolute"
                                  : is_fixed ? "fixed"
                                             : "free",
                                  body_name);
  if (grid > 0) hinge += fmt::format("child_node = {}\n{}\n", grid, choose_hinge_axis(deck, grid));
  const std::string system = fmt::format(
      "# bough run {0} -o {1}\n[[body]]\nname = {2}\nfile = {3}\n\n"
      "[[hinge]]\nname = \"base\"\n{4}\n[simulation]\nduration = 1.0\noutput_step = 0.01\n{5}"
      "gravity = [0.0, 0.0, -9.81]  # a load to begin with, in the units of the deck (-9810.0 of mm, 0.0 in space)\n",
      make_word(name + "-run.toml"), make_word(name + "-run.h5"), body_name, output, hinge,
      grid > 0 ? "integrator = \"auto\"\n" : "");
  return {{name + ".toml", body}, {name + "-run.toml", system}};
}

std::vector<StartFile> make_start_files(const std::string& deck, const std::string& folder, int hinge_grid,
                                        Diagnostics& diagnostics) {
  namespace fs = std::filesystem;
  demand_deck(deck);
  const auto content = nastran::read_deck(deck, {}, diagnostics);
  if (content.grids.empty())
    diagnostics.error("fe.no-grids", {deck}, "the deck has no GRID", "give the bulk data of a model");
  diagnostics.throw_if_errors();
  const auto path = fs::absolute(deck).lexically_relative(fs::absolute(folder.empty() ? "." : folder));
  return make_start_files(content, {path.string(), fs::path(deck).stem().string(), hinge_grid});
}

}  // namespace bough::analysis
