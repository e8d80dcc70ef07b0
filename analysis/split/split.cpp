#include "analysis/split/split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include "analysis/common/choices.hpp"
#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/split/assembled_modes.hpp"
#include "analysis/split/part_deck.hpp"
#include "analysis/split/part_files.hpp"
#include "analysis/split/static_check.hpp"
#include "base/rotation.hpp"
#include "fe/linear/petsc.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/matrices/connected_parts.hpp"
#include "fe/statics/build_model.hpp"
#include "formats/nastran/writer.hpp"
#include "modal/eigen.hpp"
#include "stiffening/reduce.hpp"

namespace bough::analysis {

using namespace splitting;

namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Highest frequency of the modes of a part, with the cuts held, over that of the highest mode compared.
constexpr double kFirstRange = 3;
constexpr unsigned kRotations = 0b111000;
constexpr int kMaxRounds = 5;           ///< each doubles the range
constexpr int kMaxRigidRounds = 3;      ///< with cuts along several grids
constexpr double kTwistInertia = 1e-5;  ///< relative to the torsional inertia that a line of bars carries
constexpr double kRotaryInertia =
    1e-7;                              ///< relative to the inertia that a grid of lumped mass carries, about each axis
constexpr double kGridInertia = 3e-5;  ///< of the grids of a cut, relative to the least inertia of all parts about one
constexpr double kDiscInertia = 0.6;   ///< of a disc about its diameter over that about its axis
constexpr double kGrounding = 1e-6;    ///< force of a spring in rigid-body motion, over |K| |motion|
constexpr double kParallel = 1e-9;     ///< sine of the angle, and relative inertia that is round-off

double calc_hz(double lambda) { return std::sqrt(std::max(lambda, 0.0)) / (2 * std::numbers::pi); }

/// Elastic modes of the whole deck.
struct WholeModes {
  Eigen::VectorXd hz;
  int num_rigid = 0;
  Eigen::MatrixXd rigid;  ///< num_gdofs x num_rigid
};

WholeModes calc_whole_modes(const fe::Model& model, int number, Diagnostics& diagnostics) {
  modal::EigenOptions options;
  options.num_modes = number + 6;
  const auto pairs = modal::calc_normal_modes(model, options, diagnostics);
  WholeModes modes;
  modes.num_rigid = pairs.num_rigid;
  modes.rigid = pairs.Phi.leftCols(pairs.num_rigid);
  const Eigen::Index kept = std::min<Eigen::Index>(number, pairs.lambda.size() - pairs.num_rigid);
  modes.hz.resize(std::max<Eigen::Index>(kept, 0));
  for (Eigen::Index i = 0; i < modes.hz.size(); ++i) modes.hz(i) = calc_hz(pairs.lambda(pairs.num_rigid + i));
  return modes;
}

bool has_rigid_joint(const Assembly& assembly) {
  return std::any_of(assembly.joints.begin(), assembly.joints.end(), [](const auto& joint) { return joint.is_new; });
}

/// Returns true if the constraints of the deck hold the part by themselves.
bool is_held_by_deck(const Structure& structure, Partition partition, int part) {
  std::vector<int> number(static_cast<std::size_t>(partition.num_parts));
  for (int i = 0; i < partition.num_parts; ++i) number[static_cast<std::size_t>(i)] = i == part ? 0 : i + 1;
  renumber(number, partition);
  Assembly alone;
  alone.is_held = true;
  alone.clamp.assign(static_cast<std::size_t>(partition.num_parts) + 1, 0);
  alone.is_averaged.assign(alone.clamp.size(), 0);
  try {
    Diagnostics ignored;
    const auto model = fe::build_model(make_part_deck(structure, partition, alone, 0), {}, ignored);
    return ignored.num_errors() == 0 && fe::count_held_motions(model) == 6;
  } catch (const Failure&) {
    return false;
  }
}

/// Returns ", cut at 11, 21" of the nodes of the cuts of a part.
std::string describe_cuts(const Assembly& assembly, int part) {
  std::vector<int> nodes;
  for (const auto& joint : assembly.joints)
    if (joint.parts.count(part) > 0) nodes.push_back(joint.is_by_grids ? joint.grids.front() : joint.node);
  return nodes.empty() ? "" : fmt::format(", cut at {}", fmt::join(nodes, ", "));
}

/// Mass matrices of the rotations of the grids at cuts.
std::map<int, Eigen::Matrix3d> list_rotary_inertia(const Assembly& assembly, int part, const fe::Model& model) {
  std::map<int, Eigen::Matrix3d> rotary;
  for (const auto& joint : assembly.joints) {
    if (joint.is_new || joint.is_by_grids || joint.parts.count(part) == 0) continue;
    const fe::Node& node = model.node(model.find_node(joint.node));
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(model.num_gdofs(), 3);
    unit.middleRows<3>(node.first_gdof + 3).setIdentity();
    rotary[joint.node] = fe::calc_mass_times(model, model.mass_kind(), unit).middleRows<3>(node.first_gdof + 3);
  }
  return rotary;
}

/// Does `work`; its errors name the part and the cuts.
template <class Work>
void name_part(const PartNames& names, const Assembly& assembly, int part, const Work& work) {
  try {
    work();
  } catch (const Failure& failure) {
    auto items = failure.items();
    for (auto& item : items)
      if (item.severity == Severity::Error)
        item.what = "part " + names.get_part(part) + describe_cuts(assembly, part) + ": " + item.what;
    if (failure.exit_code() == 1) throw InputError(std::move(items));
    throw ComputationError(std::move(items));
  }
}

/// A part with its deck.
struct Part {
  records::Deck deck;
  double mass = 0;
  std::map<int, Eigen::Matrix3d> rotary;  ///< mass matrix of the rotations of each grid at a cut, basic
  std::map<int, unsigned> unstiffened;    ///< components of grids that AUTOSPC holds, in the CD axes
  Matrix6d moving =
      Matrix6d::Zero();  ///< mass matrix of rigid-body motion about the origin of basic, held grids at rest
  int num_elements = 0;
};

/// Mass matrix of rigid-body motion of the part, 6 x 6, about the origin of basic; held grids do not move.
Matrix6d calc_moving_mass(const Structure& structure, const fe::Model& model) {
  constexpr unsigned kTranslations = 0b000111;
  Eigen::MatrixXd Phi_R = model.calc_rigid_modes();
  for (const auto& node : model.nodes()) {
    const auto held = structure.held.find(node.id);
    if (held != structure.held.end() && (held->second & kTranslations) == kTranslations)
      Phi_R.middleRows(node.first_gdof, node.num_dofs).setZero();
  }
  return Phi_R.transpose() * fe::calc_mass_times(model, model.mass_kind(), Phi_R);
}

/// Direction of the line elements of the part at the grid; zero if others are there or they are not parallel.
Eigen::Vector3d find_line(const Structure& structure, const Partition& partition, int part, int grid) {
  Eigen::Vector3d line = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < structure.elements.size(); ++i) {
    const auto& element = structure.elements[i];
    if (partition.element_part[i] != part || !is_structural(element) ||
        std::find(element.grids.begin(), element.grids.end(), grid) == element.grids.end())
      continue;
    if (element.card != "CBAR" && element.card != "CBEAM") return Eigen::Vector3d::Zero();
    const Eigen::Vector3d along =
        (structure.position.at(element.grids[0]) - structure.position.at(element.grids[1])).normalized();
    if (line.isZero(0)) line = along;
    if (line.cross(along).norm() > kParallel) return Eigen::Vector3d::Zero();
  }
  return line;
}

/// Moment of inertia about a line through p of the mass matrix of rigid-body motion.
double calc_inertia_about(const Matrix6d& mass, const Eigen::Vector3d& p, const Eigen::Vector3d& line) {
  Vector6d turn;
  turn << p.cross(line), line;
  return turn.dot(mass * turn);
}

/// A line of bars has no inertia in twist: the twist of a part has mass only through other parts. Each cut of a line,
/// except the one that carries the part, gets a CONM2 with kTwistInertia of the inertia about the line: of what the cut
/// carries, or of all parts if it closes a loop. At the ground it does not move. A grid with inertia about the line
/// needs none. Grids without rotary inertia (lumped mass) get kRotaryInertia about all axes: where modes with the cuts
/// held span all masses, rotations of a cut would have none, and a joint there would pass no moment. For the same
/// reason the grids of a cut that is joined by these get kGridInertia together, half of it in each part.
void add_rotary_inertia(const Structure& structure, const Partition& partition, const Assembly& assembly, double wtmass,
                        std::vector<Part>& parts) {
  Matrix6d whole = Matrix6d::Zero();
  std::vector<Matrix6d> carried;
  for (const auto& part : parts) {
    whole += part.moving;
    carried.push_back(part.moving);
  }
  int next_id = 0;
  for (const auto& element : structure.elements) next_id = std::max(next_id, element.id);
  for (const auto& rigid : structure.rigid) next_id = std::max(next_id, rigid.id);
  next_id += static_cast<int>(64 * (1 + assembly.joints.size()));  // above the RBE2 of joints
  const auto add = [&](int part, int node, const Matrix6d& load) {
    const auto position = structure.position.find(node);
    if (part < 0 || position == structure.position.end()) return;
    const Part& own = parts[static_cast<std::size_t>(part)];
    const Eigen::Vector3d t = find_line(structure, partition, part, node);
    const double about_line = t.isZero(0) ? 0 : calc_inertia_about(load, position->second, t);
    double about_point = 0;  // trace
    for (const auto& axis : {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()})
      about_point += calc_inertia_about(load, position->second, axis);
    const auto found = own.rotary.find(node);
    const Eigen::Matrix3d rotary = found == own.rotary.end() ? Eigen::Matrix3d(Eigen::Matrix3d::Zero()) : found->second;
    const bool is_twist = about_line > kParallel * about_point && t.dot(rotary * t) <= kRotaryInertia * about_line;
    const bool is_lumped = found != own.rotary.end() && rotary.trace() <= kRotaryInertia * about_point;
    if (!is_twist && !is_lumped) return;
    const double J = is_twist ? kTwistInertia * about_line / wtmass : 0;
    const double J_lumped = is_lumped ? kRotaryInertia * about_point / wtmass : 0;
    records::Conm2 mass;
    mass.id = ++next_id;
    mass.g = node;
    // A disc across the line, a little thick: a body has no moment of inertia above the sum of the other two.
    const Eigen::Matrix3d I =
        J * (kDiscInertia * Eigen::Matrix3d::Identity() + (1 - kDiscInertia) * t * t.transpose()) +
        J_lumped * Eigen::Matrix3d::Identity();
    // Off-diagonal terms of the card are products of inertia, those of the tensor their negatives.
    mass.inertia = {I(0, 0), -I(0, 1), I(1, 1), -I(0, 2), -I(1, 2), I(2, 2)};
    parts[static_cast<std::size_t>(part)].deck.conm2.push_back(mass);
  };
  std::map<std::pair<int, int>, int> num_links;  // by grids, of the parts of a link
  for (const auto& link : assembly.links)
    if (link.is_by_grids) ++num_links[{link.parent, link.child}];
  const auto add_to_grid = [&](const PartLink& link) {
    Eigen::Matrix<double, 6, 3> turns;
    turns << skew(structure.position.at(link.node)), Eigen::Matrix3d::Identity();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> about_grid(Eigen::Matrix3d(turns.transpose() * whole * turns),
                                                                    Eigen::EigenvaluesOnly);
    const double J =
        kGridInertia * about_grid.eigenvalues().x() / (2 * num_links.at({link.parent, link.child}) * wtmass);
    for (const int part : {link.parent, link.child}) {
      if ((link.held & kRotations) == 0) continue;
      records::Conm2 mass;
      mass.id = ++next_id;
      mass.g = link.node;
      mass.inertia = {J, 0, J, 0, 0, J};
      parts[static_cast<std::size_t>(part)].deck.conm2.push_back(mass);
    }
  };
  for (auto link = assembly.links.rbegin(); link != assembly.links.rend(); ++link) {
    if (link->is_by_grids) {
      add_to_grid(*link);
    } else if (link->closes_loop) {
      add(link->parent, link->node, whole);
      if (assembly.clamp[static_cast<std::size_t>(link->child)] != link->node) add(link->child, link->node, whole);
    } else if (link->parent >= 0) {
      const Matrix6d& load = carried[static_cast<std::size_t>(link->child)];
      add(link->parent, link->node, load);
      carried[static_cast<std::size_t>(link->parent)] += load;
    }
  }
}

std::vector<Part> make_parts(const PartNames& names, const Structure& structure, const Partition& partition,
                             const Assembly& assembly, Diagnostics& diagnostics) {
  std::vector<Part> parts;
  for (int i = 0; i < partition.num_parts; ++i) {
    Part part;
    part.deck = make_part_deck(structure, partition, assembly, i);
    SourceLocation first{structure.locate({})};
    for (std::size_t e = structure.elements.size(); e-- > 0;)
      if (partition.element_part[e] == i) {
        ++part.num_elements;
        first = structure.locate(structure.elements[e].at);
      }
    Diagnostics of_part;
    name_part(names, assembly, i, [&] {
      const auto model = fe::build_model(part.deck, {}, of_part);
      of_part.throw_if_errors();
      part.mass = fe::calc_mass_properties(model, model.mass_kind(), Eigen::Vector3d::Zero()).mass;
      part.moving = calc_moving_mass(structure, model);
      part.rotary = list_rotary_inertia(assembly, i, model);
      for (const auto& entry : model.autospc())
        if (entry.component > 0 && entry.terms.empty())
          part.unstiffened[entry.node] |= 1U << static_cast<unsigned>(entry.component - 1);
    });
    if (!(part.mass > 0))
      diagnostics.error("split.no-mass", first, fmt::format("part {} has no mass", i + 1),
                        "give its material a density, or cut such that each part has mass");
    parts.push_back(std::move(part));
  }
  diagnostics.throw_if_errors();
  return parts;
}

/// Constraints at grids join no component that one of the parts has no stiffness for: the rotations of solids, and of
/// flat shells about their normal without PARAM,K6ROT.
void release_unstiffened(const std::vector<Part>& parts, const Structure& structure, Assembly& assembly,
                         Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (auto& link : assembly.links) {
    if (!link.is_by_grids) continue;
    const unsigned before = link.held;
    for (const int part : {link.parent, link.child}) {
      const auto& unstiffened = parts[static_cast<std::size_t>(part)].unstiffened;
      if (const auto found = unstiffened.find(link.node); found != unstiffened.end()) link.held &= ~found->second;
    }
    std::string components;
    for (unsigned c = 0; c < 6; ++c)
      if ((((before & ~link.held) >> c) & 1U) != 0) components += std::to_string(c + 1);
    if (!components.empty()) names.push_back(fmt::format("{} of grid {}", components, link.node));
  }
  std::erase_if(assembly.links, [](const auto& link) { return link.is_by_grids && link.held == 0; });
  if (names.empty()) return;
  constexpr std::size_t kMaxNames = 4;
  const std::string more = names.size() > kMaxNames ? fmt::format(", and so on at {} grids", names.size()) : "";
  names.resize(std::min(names.size(), kMaxNames));
  diagnostics.note(
      "split.released", structure.locate({}),
      fmt::format("constraints at grids leave components without stiffness free: {}{}", fmt::join(names, ", "), more),
      "nothing to do");
}

std::vector<const records::FlexBody*> list_pointers(const std::vector<records::FlexBody>& bodies) {
  std::vector<const records::FlexBody*> pointers;
  for (const auto& body : bodies) pointers.push_back(&body);
  return pointers;
}

/// The parts reduced with modes to `max_hz`, and what their assembly has of the modes of the whole.
struct Reduction {
  std::vector<records::FlexBody> bodies;
  std::vector<ComparedFrequency> frequencies;
  Diagnostics diagnostics;

  double calc_error() const {
    double error = 0;
    for (const auto& frequency : frequencies) error = std::max(error, std::abs(frequency.error()));
    return error;
  }
};

Reduction reduce_parts(const std::vector<Part>& parts, const PartNames& names, const Structure& structure,
                       const Assembly& assembly, const WholeModes& whole, double max_hz, Events& events) {
  Reduction reduction;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    events.show_progress(fmt::format("split: reduction of part {} of {}", i + 1, parts.size()));
    const auto spec = make_part_spec(names, structure, assembly, static_cast<int>(i), max_hz);
    Diagnostics of_part;
    name_part(names, assembly, static_cast<int>(i), [&] {
      reduction.bodies.push_back(stiffening::reduce(parts[i].deck, spec, {}, of_part).body);
      of_part.throw_if_errors();
    });
    for (auto item : of_part.items()) {
      item.what = "part " + spec.name + ": " + item.what;
      reduction.diagnostics.add_new(item);
    }
  }
  events.show_progress("split: modes of the assembled parts");
  const auto bodies = list_pointers(reduction.bodies);
  const double omega = 2 * std::numbers::pi * whole.hz(0);
  const auto lambda = calc_assembled_eigenvalues(bodies, structure, assembly, omega * omega);
  for (Eigen::Index i = 0; i < whole.hz.size(); ++i) {
    const auto j = i + whole.num_rigid;
    reduction.frequencies.push_back({whole.hz(i), j < lambda.size() ? calc_hz(lambda(j)) : INFINITY});
  }
  events.show_progress("");
  return reduction;
}

/// Rounded, so that the body file has the number of the reduction.
double round_hz(double hz) { return std::stod(fmt::format("{:.3g}", hz)); }

/// Widens the range of the modes until the frequencies of the assembly are accurate to kMaxSplitError, less often if
/// cuts are rigid or averages: more modes do not correct these.
Reduction reduce_to_accuracy(const std::vector<Part>& parts, const PartNames& names, const Structure& structure,
                             const Assembly& assembly, const WholeModes& whole, double& max_hz, Events& events) {
  const int max_rounds = has_rigid_joint(assembly) ? kMaxRigidRounds : kMaxRounds;
  for (int round = 1;; ++round) {
    auto reduction = reduce_parts(parts, names, structure, assembly, whole, max_hz, events);
    if (round == max_rounds || reduction.calc_error() <= kMaxSplitError) return reduction;
    max_hz = round_hz(2 * max_hz);
  }
}

/// Returns true for warnings of directions of a cut that move no mass, if the assembly is accurate without these, and
/// of rotations without stiffness, which constraints at grids leave free.
bool is_expected(const Diagnostic& item, const Assembly& assembly, const Reduction& reduction) {
  const bool is_massless = item.id == "modal.massless-interface" || item.id == "modal.massless-constraint";
  if (is_massless) return reduction.calc_error() <= kMaxSplitError;
  return item.id == "reduce.partial-rotation" && std::any_of(assembly.joints.begin(), assembly.joints.end(),
                                                             [](const auto& joint) { return joint.is_by_grids; });
}

/// Returns "CELAS2 801 between grids 14 and 19" of the first spring that strains in rigid-body motion; empty: none.
std::string find_grounding_spring(const fe::Model& model) {
  const Eigen::MatrixXd Phi_R = model.calc_rigid_modes();
  for (const auto& element : model.elements()) {
    const auto& nodes = element->nodes();
    if (nodes.size() != 2 || nodes[0] == nodes[1] || !element->card().starts_with("CELAS")) continue;
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(element->num_dofs(), element->num_dofs());
    element->add_stiffness(1, K);
    const Eigen::MatrixXd motion = Phi_R(element->gdofs(), Eigen::all);
    if ((K * motion).norm() > kGrounding * K.norm() * motion.norm())
      return fmt::format("{} {} between grids {} and {}", element->card(), element->id(), model.node(nodes[0]).id,
                         model.node(nodes[1]).id);
  }
  return {};
}

void warn_of_error(const Reduction& reduction, const Structure& structure, const Assembly& assembly,
                   const fe::Model& model, Diagnostics& diagnostics) {
  const double error = reduction.calc_error();
  if (!(error > kMaxSplitError)) return;
  const bool has_wide = has_rigid_joint(assembly);
  const bool is_average =
      std::any_of(assembly.joints.begin(), assembly.joints.end(), [](const auto& joint) { return joint.is_average; });
  const auto spring = find_grounding_spring(model);
  const std::string cause =
      !spring.empty() ? "; " + spring + " strains in rigid-body motion: a part that moves is held against the ground"
      : is_average    ? "; cuts along several grids join these by their mean motion (RBE3)"
      : has_wide      ? "; cuts along several grids join these by a rigid element (RBE2)"
                      : "";
  diagnostics.warning(
      "split.inaccurate", structure.locate({}),
      fmt::format("frequencies of the assembled parts differ by up to {:.2g} from those of the deck, "
                  "allowed {:.0e}{}",
                  error, kMaxSplitError, cause),
      !spring.empty()
          ? "give the spring grids at one place with equal displacement axes, or replace it by a CBUSH or CROD"
      : has_wide
          ? fmt::format("cut where the section is stiff, or try --interface grids or {}",
                        is_average ? "rigid" : "average")
          : "raise max_frequency of the body files, refine the mesh, or give the grids of the cuts inertia about "
            "all axes by small CONM2 cards, or by PARAM,COUPMASS,1 in a deck without it");
}

/// Without a warning of the frequencies, whose cause is the same.
void warn_of_deflections(const std::vector<ComparedDeflection>& deflections, const Structure& structure,
                         double frequency_error, Diagnostics& diagnostics) {
  const auto worst = std::max_element(deflections.begin(), deflections.end(),
                                      [](const auto& a, const auto& b) { return a.error < b.error; });
  if (worst == deflections.end() || !(worst->error > kMaxSplitError) || frequency_error > kMaxSplitError) return;
  diagnostics.warning(
      "split.deflection", structure.locate({}),
      fmt::format("the static deflection of the assembled parts differs by {:.2g} from that of the deck "
                  "under {}, allowed {:.0e}",
                  worst->error, worst->load, kMaxSplitError),
      "name the grids that are loaded in interface of the body files, or raise max_frequency");
}

void warn_of_damping(const Structure& structure, const WholeModes& whole, Diagnostics& diagnostics) {
  if (structure.alpha1 != 0)
    diagnostics.warning("split.damping", structure.locate({}),
                        "PARAM,ALPHA1 damps motion against the ground, and is left out of the parts",
                        "give the system dampers to the ground, or modal damping to the body files");
  if (!structure.has_material_damping) return;
  diagnostics.warning(
      "split.damping", structure.locate({}),
      "GE and PARAM,G become viscous damping at the frequencies of the parts with their cuts held: low modes of the "
      "system have less than half of G",
      fmt::format("for the damping ratio G/2 at {:.4g} Hz give each body file rayleigh = [0, {:.4g} G] in place of "
                  "material = true",
                  whole.hz(0), 1 / (2 * std::numbers::pi * whole.hz(0))));
}

void note_pieces(const Partition& partition, const Structure& structure, Diagnostics& diagnostics) {
  if (partition.num_pieces > 0)
    diagnostics.note("split.pieces", structure.locate({}),
                     fmt::format("{} parts were chosen, {} are made: pieces that nothing connects are separate parts",
                                 partition.num_parts - partition.num_pieces, partition.num_parts),
                     "nothing to do");
}

void note_drawn(const Partition& partition, const Structure& structure, Diagnostics& diagnostics) {
  const DeckItem* first = nullptr;
  int count = 0;
  for (const auto& element : structure.elements) {
    if (!element.is_drawn || !partition.find_common(element.grids).empty()) continue;
    if (count++ == 0) first = &element;
  }
  if (first != nullptr)
    diagnostics.note("split.drawn-line", structure.locate(first->at),
                     fmt::format("{}{} joins grids of several parts, and is in none", name_item(*first),
                                 count > 1 ? fmt::format(", as {} more,", count - 1) : ""),
                     "nothing to do: PLOTEL is drawn alone");
}

}  // namespace

SplitAnswer split_deck(const SplitRequest& request, Events& events) {
  demand_word("--along", request.choice.along, {"path", "long", "x", "y", "z"});
  demand_word("--interface", request.choice.interface, {"rigid", "average", "grids"});
  demand_number(request.choice.num_parts >= 0, "--parts", request.choice.num_parts, "a number above 0");
  demand_number(request.num_compared > 0, "--modes", request.num_compared, "a number above 0");
  do_once([&] { demand_deck(request.deck); });
  linear::initialize_petsc();
  if (request.name.find('/') != std::string::npos)
    throw InputError("split.bad-name", {}, "--name is \"" + request.name + "\", expected a name without a slash",
                     "give the folder by -o");
  Diagnostics diagnostics;
  const auto model_options = make_model_options(request.model);
  const auto deck = read_deck_or_throw(request.deck, model_options, diagnostics);
  SplitAnswer answer;
  with_prior_messages(diagnostics, [&] {
    const auto model = fe::build_model(deck, model_options, diagnostics);
    diagnostics.throw_if_errors();
    const auto structure = make_structure(deck, model, diagnostics);
    auto partition = assign_elements(structure, request.choice);
    assign_attached(structure, partition);
    const int root = find_most_held(structure, partition);
    const bool is_held = is_held_by_deck(structure, partition, root);
    auto assembly =
        make_assembly(structure, find_joints(structure, partition, request.choice.interface), is_held, root, partition);
    note_pieces(partition, structure, diagnostics);
    note_drawn(partition, structure, diagnostics);

    PartNames names{request.name, request.deck_path.empty() ? request.deck : request.deck_path};
    if (names.base.empty()) names.base = std::filesystem::path(request.deck).stem().string();
    auto parts = make_parts(names, structure, partition, assembly, diagnostics);
    release_unstiffened(parts, structure, assembly, diagnostics);
    add_rotary_inertia(structure, partition, assembly, model.wtmass(), parts);
    events.show_progress("split: modes of the deck");
    const auto whole = calc_whole_modes(model, std::max(request.num_compared, 1), diagnostics);
    events.show_progress("");
    if (whole.hz.size() == 0)
      throw InputError("split.no-elements", deck.locate({}), "the deck has no elastic mode",
                       "give the model elements with stiffness and mass");
    answer.mass = fe::calc_mass_properties(model, model.mass_kind(), Eigen::Vector3d::Zero()).mass;

    double max_hz = round_hz(kFirstRange * whole.hz(whole.hz.size() - 1));
    Reduction reduction;
    if (request.is_checked) reduction = reduce_to_accuracy(parts, names, structure, assembly, whole, max_hz, events);
    for (const auto& item : reduction.diagnostics.items())
      if (!is_expected(item, assembly, reduction)) diagnostics.add_new(item);
    answer.frequencies = reduction.frequencies;
    warn_of_error(reduction, structure, assembly, model, diagnostics);
    if (request.is_checked) {
      events.show_progress("split: static deflections");
      const double omega = 2 * std::numbers::pi * whole.hz(0);
      answer.deflections = compare_deflections(model, structure, partition, assembly, list_pointers(reduction.bodies),
                                               whole.rigid, omega * omega, diagnostics);
      events.show_progress("");
      warn_of_deflections(answer.deflections, structure, reduction.calc_error(), diagnostics);
    }
    warn_of_damping(structure, whole, diagnostics);

    parts.front().deck.unused = deck.unused;  // reported once by the writer
    parts.front().deck.left_out = deck.left_out;
    parts.front().deck.card_counts = deck.card_counts;
    for (int i = 0; i < partition.num_parts; ++i) {
      const auto index = static_cast<std::size_t>(i);
      const auto spec = make_part_spec(names, structure, assembly, i, max_hz);
      answer.files.push_back({spec.deck, nastran::write_deck(parts[index].deck, {}, diagnostics)});
      answer.files.push_back({spec.name + ".toml", write_part_file(names, assembly, i, spec)});
      SplitPart part;
      part.name = spec.name;
      for (const auto& link : assembly.links)
        if (link.child == i && !link.closes_loop)
          part.parent = link.parent < 0 ? "ground" : names.get_part(link.parent);
      for (const auto& link : assembly.links)
        if (link.child == i && link.is_by_grids) {
          part.parent = names.get_part(link.parent);
          ++part.num_joined;
        }
      part.node = assembly.clamp[index];
      part.num_elements = parts[index].num_elements;
      part.num_grids = static_cast<int>(parts[index].deck.grids.size());
      part.mass = parts[index].mass;
      if (request.is_checked) part.body = std::move(reduction.bodies[index]);
      answer.parts.push_back(std::move(part));
    }
    answer.files.push_back({names.base + "-run.toml", write_system_file(names, structure, assembly, whole.hz)});
    diagnostics.throw_if_errors();
  });
  add_messages(diagnostics, events);
  return answer;
}

}  // namespace bough::analysis
