#include "analysis/split/part_files.hpp"

#include <fmt/format.h>

#include <cmath>

namespace bough::analysis::splitting {

namespace {

using Eigen::Vector3d;
using records::BodyBasis;

constexpr unsigned kFixed = 0b111111;
constexpr unsigned kTranslations = 0b000111;
constexpr unsigned kRotations = 0b111000;

// TOML: a basic string.
std::string quote_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return quoted + "\"";
}

std::string format_vector(const Vector3d& v) {
  return fmt::format("[{}, {}, {}]", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
}

/// To nine digits of the largest coordinate: a point without round-off, which both ends of a hinge have.
Vector3d round_point(const Vector3d& x) {
  const double unit = std::pow(10, std::floor(std::log10(x.cwiseAbs().maxCoeff())) - 8);
  return x.unaryExpr([&](double a) { return std::stod(fmt::format("{:.9g}", std::round(a / unit) * unit)); });
}

/// Angles a, b, c with R = Rx(a) Ry(b) Rz(c).
Vector3d calc_angles(const Eigen::Matrix3d& R) {
  return {std::atan2(-R(1, 2), R(2, 2)), std::asin(std::clamp(R(0, 2), -1.0, 1.0)), std::atan2(-R(0, 1), R(0, 0))};
}

/// Axes of the free components among three.
std::string list_free(unsigned held, int first) {
  std::string axes;
  for (int c = 0; c < 3; ++c)
    if (((held >> (first + c)) & 1U) == 0) axes += "xyz"[c];
  return axes;
}

double round_digit(double x) { return std::stod(fmt::format("{:.1g}", x)); }

/// Type of a hinge or constraint that holds these components.
std::string write_type(unsigned held) {
  if (held == kFixed) return "type = \"fixed\"\n";
  if (held == 0) return "type = \"free\"\n";
  if (held == kTranslations) return "type = \"spherical\"\n";
  std::string text = "type = \"general\"\n";
  if (const auto axes = list_free(held, 3); !axes.empty()) text += "rotations = \"" + axes + "\"\n";
  if (const auto axes = list_free(held, 0); !axes.empty()) text += "translations = \"" + axes + "\"\n";
  return text;
}

/// Axes of a link whose components are free in part.
std::string write_axes(const Structure& structure, const PartLink& link) {
  const auto axes = structure.axes.find(link.node);
  if (link.held == kFixed || link.held == 0 || axes == structure.axes.end() || axes->second.isIdentity(0)) return {};
  const auto angles = format_vector(calc_angles(axes->second));
  return "parent_rotation = " + angles + "\nchild_rotation = " + angles + "\n";
}

/// Place of a link with the ground: position in basic and, if components are free, the CD axes.
std::string write_ground_end(const Structure& structure, const Assembly& assembly, const PartLink& link) {
  if (link.node == 0 && !link.point.isZero(0))
    return fmt::format("parent_position = {0}\nchild_position = {0}\n", format_vector(round_point(link.point)));
  if (link.node == 0) return {};
  Vector3d x = Vector3d::Zero();
  if (const auto grid = structure.position.find(link.node); grid != structure.position.end()) x = grid->second;
  for (const auto& joint : assembly.joints)
    if (joint.node == link.node) x = joint.x;
  return fmt::format("child_node = {}\nparent_position = {}\n", link.node, format_vector(x)) +
         write_axes(structure, link);
}

std::string write_link(const PartNames& names, const Structure& structure, const Assembly& assembly,
                       const PartLink& link, int number) {
  std::string text = link.closes_loop ? "[[constraint]]\n" : "[[hinge]]\n";
  if (link.parent < 0) {
    text += link.closes_loop ? fmt::format("name = \"ground-{}\"  # the deck holds grid {}\n", link.node, link.node)
            : link.child > 0 ? fmt::format("name = \"free-{}\"\n", link.child + 1)
                             : std::string("name = \"base\"\n");
    return text + write_type(link.held) + "parent = \"ground\"\nchild = " + quote_text(names.get_part(link.child)) +
           "\n" + write_ground_end(structure, assembly, link) + "\n";
  }
  return text + fmt::format("name = \"cut-{}\"\n", number) + write_type(link.held) +
         fmt::format("parent = {}\nparent_node = {}\nchild = {}\nchild_node = {}\n",
                     quote_text(names.get_part(link.parent)), link.node, quote_text(names.get_part(link.child)),
                     link.node) +
         write_axes(structure, link) + "\n";
}

}  // namespace

records::BodySpec make_part_spec(const PartNames& names, const Structure& structure, const Assembly& assembly, int part,
                                 double max_hz) {
  records::BodySpec spec;
  spec.has_material_damping = structure.has_material_damping;
  spec.rayleigh_beta = structure.alpha2;
  spec.name = names.get_part(part);
  spec.deck = spec.name + ".bdf";
  spec.output_file = spec.name + ".h5";
  spec.interface_nodes = assembly.interface[static_cast<std::size_t>(part)];
  if (assembly.is_averaged[static_cast<std::size_t>(part)] != 0) {
    spec.frame = records::BodyFrame::Node;
    spec.frame_nodes = {assembly.clamp[static_cast<std::size_t>(part)]};
    spec.interface_nodes.push_back(spec.frame_nodes.front());
  }
  spec.basis = spec.interface_nodes.empty() ? BodyBasis::Normal : BodyBasis::CraigBampton;
  const bool is_carried = (assembly.is_held && part == 0) || assembly.clamp[static_cast<std::size_t>(part)] != 0;
  bool has_moments = false, is_by_grids = false;
  for (const auto& link : assembly.links) {
    if (link.parent != part && link.child != part) continue;
    is_by_grids = is_by_grids || link.is_by_grids;
    has_moments = has_moments || (link.node != 0 && (link.held & kRotations) != 0);
  }
  spec.interface_moments = has_moments || !is_by_grids;
  if (spec.frame_nodes.empty()) spec.frame = is_carried ? records::BodyFrame::Fixed : records::BodyFrame::Free;
  spec.max_frequency_hz = max_hz;
  return spec;
}

std::string write_part_file(const PartNames& names, const Assembly& assembly, int part, const records::BodySpec& spec) {
  const int clamp = assembly.clamp[static_cast<std::size_t>(part)];
  std::string text =
      fmt::format("# bough reduce {0}.toml\n# Part {1} of {2}, cut by bough split.\n[body]\nname = {3}\ndeck = {4}\n",
                  spec.name, part + 1, names.deck, quote_text(spec.name), quote_text(spec.deck));
  if (spec.frame == records::BodyFrame::Node)
    text += fmt::format("frame = \"node\"           # its hinge carries this average of grids\nframe_nodes = [{}]\n",
                        clamp);
  else if (spec.frame == records::BodyFrame::Free)
    text += "frame = \"free\"           # mean axes of its free motion\n";
  else if (clamp == 0)
    text += "frame = \"fixed\"          # the deck's constraints hold the body frame\n";
  else
    text += fmt::format("frame = \"fixed\"          # held at grid {}, which its hinge carries\n", clamp);
  if (spec.interface_nodes.empty())
    text += "# interface = [ID]       # each grid that a force or moment loads, with basis = \"craig-bampton\"\n";
  else
    text += fmt::format("interface = [{}]  # cuts; add each grid that a force or moment loads\n",
                        fmt::join(spec.interface_nodes, ", "));
  if (!spec.interface_moments) text += "interface_moments = false  # its joints pass forces alone\n";
  text += "\n[body.modes]\n";
  if (spec.basis == BodyBasis::CraigBampton) text += "basis = \"craig-bampton\"\n";
  text += fmt::format("max_frequency = {}  # of its modes with the cuts held\n\n", *spec.max_frequency_hz);
  if (spec.has_material_damping || spec.rayleigh_beta != 0) {
    text += "[body.damping]\n";
    if (spec.has_material_damping) text += "material = true  # GE and PARAM,G of the deck\n";
    if (spec.rayleigh_beta != 0) text += fmt::format("rayleigh = [0.0, {}]  # PARAM,ALPHA2\n", spec.rayleigh_beta);
    text += "\n";
  }
  return text + fmt::format("[body.output]\nfile = {}\n", quote_text(spec.output_file));
}

std::string write_system_file(const PartNames& names, const Structure& structure, const Assembly& assembly,
                              const Eigen::VectorXd& whole_hz) {
  const double lowest_hz = whole_hz(0);
  std::string text = fmt::format("# bough run {0}-run.toml -o {0}-run.h5\n# The parts of {1}, cut by bough split.\n\n",
                                 names.base, names.deck);
  for (int part = 0; part < static_cast<int>(assembly.clamp.size()); ++part)
    text += fmt::format("[[body]]\nname = {}\nfile = {}\n\n", quote_text(names.get_part(part)),
                        quote_text(names.get_part(part) + ".h5"));
  int number = 1;
  for (const auto& link : assembly.links) {
    text += write_link(names, structure, assembly, link, number);
    if (link.parent >= 0) ++number;
  }
  const double step = round_digit(1 / (500 * lowest_hz));
  return text + fmt::format(
                    "[simulation]\nduration = {}\noutput_step = {}\nintegrator = \"implicit\"  # fixed steps: the "
                    "fastest modes of the parts need not be followed\nstep = {}  # {:.2g} in the period of the first "
                    "mode, {:.2g} in that of mode {}: smaller for loads that excite such modes\n"
                    "gravity = [0.0, 0.0, -9.81]  # a load to begin with, in the units of the deck (-9810.0 of mm, "
                    "0.0 in space)\n",
                    round_digit(3 / lowest_hz), 2 * step, step, 1 / (step * whole_hz(0)),
                    1 / (step * whole_hz(whole_hz.size() - 1)), whole_hz.size());
}

}  // namespace bough::analysis::splitting
