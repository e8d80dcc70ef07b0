#include "analysis/split/split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/split/assembled_modes.hpp"
#include "analysis/split/part_deck.hpp"
#include "analysis/split/part_files.hpp"
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

/// Of the modes of a part: their highest frequency with the cuts held, over that of the whole deck which is compared.
constexpr double kFirstRange = 3;
constexpr int kMaxRounds = 3;  ///< each doubles the range

double calc_hz(double lambda) { return std::sqrt(std::max(lambda, 0.0)) / (2 * std::numbers::pi); }

/// Elastic modes of the whole deck.
struct WholeModes {
  Eigen::VectorXd hz;
  int num_rigid = 0;
};

WholeModes calc_whole_modes(const fe::Model& model, int number, Diagnostics& diagnostics) {
  modal::EigenOptions options;
  options.num_modes = number + 6;
  const auto pairs = modal::calc_normal_modes(model, options, diagnostics);
  WholeModes modes;
  modes.num_rigid = pairs.num_rigid;
  const Eigen::Index kept = std::min<Eigen::Index>(number, pairs.lambda.size() - pairs.num_rigid);
  modes.hz.resize(std::max<Eigen::Index>(kept, 0));
  for (Eigen::Index i = 0; i < modes.hz.size(); ++i) modes.hz(i) = calc_hz(pairs.lambda(pairs.num_rigid + i));
  return modes;
}

/// Returns true if the constraints of the deck hold the part by themselves.
bool is_held_by_deck(const Structure& structure, Partition partition, int part) {
  std::vector<int> number(static_cast<std::size_t>(partition.num_parts));
  for (int i = 0; i < partition.num_parts; ++i) number[static_cast<std::size_t>(i)] = i == part ? 0 : i + 1;
  renumber(number, partition);
  Assembly alone;
  alone.is_held = true;
  alone.clamp.assign(static_cast<std::size_t>(partition.num_parts) + 1, 0);
  try {
    Diagnostics ignored;
    const auto model = fe::build_model(make_part_deck(structure, partition, alone, 0), {}, ignored);
    return ignored.num_errors() == 0 && fe::count_held_motions(model) == 6;
  } catch (const Failure&) {
    return false;
  }
}

/// A part with its deck.
struct Part {
  records::Deck deck;
  double mass = 0;
  int num_elements = 0;
};

std::vector<Part> make_parts(const Structure& structure, const Partition& partition, const Assembly& assembly,
                             Diagnostics& diagnostics) {
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
    const auto model = fe::build_model(part.deck, {}, of_part);
    of_part.throw_if_errors();
    part.mass = fe::calc_mass_properties(model, model.mass_kind(), Eigen::Vector3d::Zero()).mass;
    if (!(part.mass > 0))
      diagnostics.error("split.no-mass", first, fmt::format("part {} has no mass", i + 1),
                        "give its material a density, or cut such that each part has mass");
    parts.push_back(std::move(part));
  }
  diagnostics.throw_if_errors();
  return parts;
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
    const auto spec = make_part_spec(names, assembly, static_cast<int>(i), max_hz);
    reduction.bodies.push_back(stiffening::reduce(parts[i].deck, spec, {}, reduction.diagnostics).body);
    reduction.diagnostics.throw_if_errors();
  }
  events.show_progress("split: modes of the assembled parts");
  std::vector<const records::FlexBody*> bodies;
  for (const auto& body : reduction.bodies) bodies.push_back(&body);
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

void warn_of_error(const Reduction& reduction, const Structure& structure, const Assembly& assembly,
                   Diagnostics& diagnostics) {
  const double error = reduction.calc_error();
  if (!(error > kMaxSplitError)) return;
  const bool has_rigid =
      std::any_of(assembly.joints.begin(), assembly.joints.end(), [](const auto& joint) { return joint.is_new; });
  diagnostics.warning(
      "split.inaccurate", structure.locate({}),
      fmt::format("frequencies of the assembled parts differ by up to {:.2g} from those of the deck, "
                  "allowed {:.0e}{}",
                  error, kMaxSplitError, has_rigid ? "; cuts along several grids hold these rigidly" : ""),
      has_rigid ? "cut where the section is stiff, or in fewer parts"
                : "raise max_frequency of the body files, refine the mesh, or use PARAM,COUPMASS,1");
}

void note_pieces(const Partition& partition, const Structure& structure, Diagnostics& diagnostics) {
  if (partition.num_pieces > 0)
    diagnostics.note("split.pieces", structure.locate({}),
                     fmt::format("{} parts were chosen, {} are made: pieces that nothing connects are separate parts",
                                 partition.num_parts - partition.num_pieces, partition.num_parts),
                     "nothing to do");
}

}  // namespace

SplitAnswer split_deck(const SplitRequest& request, Events& events) {
  do_once([&] { demand_deck(request.deck); });
  fe::initialize_petsc();
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
    const auto assembly = make_assembly(structure, find_joints(structure, partition), is_held, root, partition);
    note_pieces(partition, structure, diagnostics);

    PartNames names{request.name, request.deck_path.empty() ? request.deck : request.deck_path};
    if (names.base.empty()) names.base = std::filesystem::path(request.deck).stem().string();
    auto parts = make_parts(structure, partition, assembly, diagnostics);
    events.show_progress("split: modes of the deck");
    const auto whole = calc_whole_modes(model, std::max(request.num_compared, 1), diagnostics);
    events.show_progress("");
    if (whole.hz.size() == 0)
      throw ComputationError("split.no-modes", deck.locate({}), "the deck has no elastic mode to compare with",
                             "give the model elements with stiffness and mass");
    answer.mass = fe::calc_mass_properties(model, model.mass_kind(), Eigen::Vector3d::Zero()).mass;

    double max_hz = round_hz(kFirstRange * whole.hz(whole.hz.size() - 1));
    Reduction reduction;
    for (int round = 0; request.is_checked && round < kMaxRounds; ++round) {
      if (round > 0) max_hz = round_hz(2 * max_hz);
      reduction = reduce_parts(parts, names, structure, assembly, whole, max_hz, events);
      if (reduction.calc_error() <= kMaxSplitError) break;
    }
    for (const auto& item : reduction.diagnostics.items()) diagnostics.add_new(item);
    answer.frequencies = reduction.frequencies;
    warn_of_error(reduction, structure, assembly, diagnostics);

    parts.front().deck.unused = deck.unused;  // the writer reports once what it leaves out
    parts.front().deck.left_out = deck.left_out;
    parts.front().deck.card_counts = deck.card_counts;
    for (int i = 0; i < partition.num_parts; ++i) {
      const auto index = static_cast<std::size_t>(i);
      const auto spec = make_part_spec(names, assembly, i, max_hz);
      answer.files.push_back({spec.deck, nastran::write_deck(parts[index].deck, {}, diagnostics)});
      answer.files.push_back({spec.name + ".toml", write_part_file(names, assembly, i, spec)});
      SplitPart part;
      part.name = spec.name;
      for (const auto& link : assembly.links)
        if (link.child == i && !link.closes_loop)
          part.parent = link.parent < 0 ? "ground" : names.get_part(link.parent);
      part.node = assembly.clamp[index];
      part.num_elements = parts[index].num_elements;
      part.num_grids = static_cast<int>(parts[index].deck.grids.size());
      part.mass = parts[index].mass;
      if (request.is_checked) part.body = std::move(reduction.bodies[index]);
      answer.parts.push_back(std::move(part));
    }
    answer.files.push_back({names.base + "-run.toml", write_system_file(names, structure, assembly)});
    diagnostics.throw_if_errors();
  });
  add_messages(diagnostics, events);
  return answer;
}

}  // namespace bough::analysis
