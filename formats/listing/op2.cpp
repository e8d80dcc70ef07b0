#include "formats/listing/op2.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>

#include "base/diagnostic.hpp"
#include "formats/listing/detail/op2_writer.hpp"

namespace bough::listing {
namespace {

using records::ListedKind;
using records::ListedStep;

using detail::Op2Writer;
using detail::Words;

constexpr int kIdentWords = 146, kDevice = 1;
constexpr std::size_t kTextSize = 128, kSubtitleSize = 67;  ///< bytes

/// The largest id of a point or element: 10 id + device code is an integer of 32 bits.
constexpr int kMaxId = (std::numeric_limits<std::int32_t>::max() - kDevice) / 10;

/// Throws InputError export.large-id: the number would stand as another one.
void demand_small_ids(const records::Listing& listing) {
  int largest = 0;
  const auto look = [&](const std::vector<int>& ids) {
    for (const int id : ids) largest = std::max(largest, id);
  };
  for (const auto& step : listing.steps) {
    for (const auto& vector : step.vectors) look(vector.id);
    for (const auto* blocks : {&step.forces, &step.stresses, &step.strains})
      for (const auto& block : *blocks) look(block.id);
    for (const auto& block : step.grid_stresses) look(block.grid);
  }
  if (largest <= kMaxId) return;
  throw InputError("export.large-id", {},
                   "an OUTPUT2 file holds ids up to " + std::to_string(kMaxId) +
                       " (10 times the id and a device code "
                       "in 32 bits), found " +
                       std::to_string(largest),
                   "renumber the deck, leave --op2 out, or write --f06");
}

struct Head {
  int analysis = 1, table = 1, subcase = 0;
  std::string title, subtitle, label;
};

/// Words 1 to 50, then title, subtitle and label.
Words make_ident(const Head& head) {
  Words words;
  for (int i = 0; i < 50; ++i) words.add(0);
  words.set(0, 10 * head.analysis + kDevice);
  words.set(1, head.table);
  words.set(3, head.subcase);
  words.add(head.title, kTextSize);
  // Columns after 67 of a subtitle name the adaptivity index and the superelement.
  words.add(head.subtitle.substr(0, kSubtitleSize), kTextSize);
  words.add(head.label, kTextSize);
  BOUGH_DEMAND(words.count() == kIdentWords);
  return words;
}

Head make_head(const ListedStep& step, int table) {
  static const std::map<ListedStep::Kind, int> analyses{{ListedStep::Kind::Static, 1},
                                                        {ListedStep::Kind::Mode, 2},
                                                        {ListedStep::Kind::Frequency, 5},
                                                        {ListedStep::Kind::Time, 6}};
  return {analyses.at(step.kind), table, step.subcase, step.title, step.subtitle, step.label};
}

/// Words 5 to 8: what the step is of.
void set_step(const ListedStep& step, Words& ident) {
  switch (step.kind) {
    case ListedStep::Kind::Static:
      ident.set(4, step.load_set);
      break;
    case ListedStep::Kind::Mode:
      ident.set(4, step.mode);
      ident.set(5, step.eigenvalue);
      ident.set(6, step.cycles);
      break;
    default:
      ident.set(4, step.at);
  }
  ident.set(7, step.load_set);
}

void add_weight(const records::ListedWeight& weight, const Head& of, Op2Writer& file) {
  Head head = of;
  head.table = 13;
  Words ident = make_ident(head), data;
  ident.set(2, weight.grid);
  ident.set(9, 78);
  const auto add = [&](const auto& matrix) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) data.add(matrix(i, j));
  };
  add(weight.MO);
  add(weight.S);
  for (int i = 0; i < 3; ++i) {
    data.add(weight.mass(i));
    for (int j = 0; j < 3; ++j) data.add(weight.cg(i, j));
  }
  add(weight.I_S);
  add(weight.I_Q);
  add(weight.Q);
  file.begin_table("OGPWG", "OGPWG");
  file.add_record(ident);
  file.add_record(data);
  file.end_table();
}

void add_roots(const std::vector<records::ListedRoots>& all, Op2Writer& file) {
  file.begin_table("LAMA", "LAMA");
  for (const auto& roots : all) {
    Words ident = make_ident({2, 6, roots.subcase, roots.title, roots.subtitle, roots.label}), data;
    ident.set(8, 1);
    ident.set(9, 7);
    for (Eigen::Index j = 0; j < roots.eigenvalue.size(); ++j) {
      const double omega = std::sqrt(std::abs(roots.eigenvalue(j)));
      data.add(static_cast<int>(j) + 1);
      data.add(static_cast<int>(j) + 1);
      for (const double value : {roots.eigenvalue(j), omega, omega / (2 * M_PI), roots.mass(j), roots.stiffness(j)})
        data.add(value);
    }
    file.add_record(ident);
    file.add_record(data);
  }
  file.end_table();
}

void add_vector(const ListedStep& step, const records::ListedVector& vector, Op2Writer& file) {
  const bool is_complex = vector.imag.size() > 0;
  Words ident = make_ident(make_head(step, static_cast<int>(vector.kind) + (is_complex ? 1000 : 0))), data;
  set_step(step, ident);
  ident.set(8, !is_complex ? 1 : vector.is_phase ? 3 : 2);
  ident.set(9, is_complex ? 14 : 8);
  for (std::size_t k = 0; k < vector.id.size(); ++k) {
    data.add(10 * vector.id[k] + kDevice);
    data.add(vector.is_scalar[k] ? 2 : 1);
    for (int c = 0; c < 6; ++c) data.add(vector.real(static_cast<Eigen::Index>(k), c));
    for (int c = 0; c < 6 && is_complex; ++c) data.add(vector.imag(static_cast<Eigen::Index>(k), c));
  }
  file.add_record(ident);
  file.add_record(data);
}

constexpr int kBeam = 2, kBeamStations = 11;

/// Nastran writes eleven stations of every beam; what lies between the ends is empty.
void add_beam_row(const records::ListedElements& block, std::size_t k, Words& data) {
  const auto row = static_cast<Eigen::Index>(k);
  const Eigen::Index half = block.real.cols() / 2;
  for (int station = 0; station < kBeamStations; ++station) {
    const bool is_a = station == 0, is_b = station == kBeamStations - 1;
    data.add(is_a ? block.ends[k][0] : is_b ? block.ends[k][1] : 0);
    data.add(is_b ? 1.0 : 0.0);
    for (const auto* part : {&block.real, &block.imag})
      for (Eigen::Index c = 0; c < half && part->size() > 0; ++c)
        data.add(is_a ? (*part)(row, c) : is_b ? (*part)(row, half + c) : 0.0);
  }
}

/// Eleven stations of grid, x/L, SXC to SXF, largest, smallest, two margins.
void add_beam_stresses(const records::ListedElements& block, std::size_t k, Words& data) {
  for (int station = 0; station < kBeamStations; ++station) {
    const bool is_a = station == 0, is_b = station == kBeamStations - 1;
    data.add(is_a ? block.ends[k][0] : is_b ? block.ends[k][1] : 0);
    data.add(is_b ? 1.0 : 0.0);
    for (int c = 0; c < 8; ++c) data.add(is_a || is_b ? block.real(static_cast<Eigen::Index>(k), c + 8 * is_b) : 0.0);
  }
}

bool is_solid(int type) { return type == 39 || type == 67 || type == 68 || type == 255; }
bool is_layered(int type) { return type == 95 || type == 97; }

/// A solid is one entry: its head, then the centre and each corner.
void add_solid_row(const records::ListedElements& block, std::size_t k, Words& data) {
  if (block.point[k] == 0) {
    int corners = 0;
    for (auto i = k + 1; i < block.id.size() && block.point[i] != 0; ++i) ++corners;
    data.add(10 * block.id[k] + kDevice);
    data.add(0);
    data.add("GRID", 4);
    data.add(corners);
  }
  data.add(block.point[k]);
  for (const auto* part : {&block.real, &block.imag})
    for (Eigen::Index c = 0; c < part->cols(); ++c) data.add((*part)(static_cast<Eigen::Index>(k), c));
}

/// Columns first .. last of both parts, one part after the other.
void add_parts(const records::ListedElements& block, std::size_t k, int first, int last, Words& data) {
  for (const auto* part : {&block.real, &block.imag})
    for (int c = first; c < last; ++c) data.add((*part)(static_cast<Eigen::Index>(k), c));
}

/// Columns first .. last, of each the real and the imaginary part.
void add_pairs(const records::ListedElements& block, std::size_t k, int first, int last, Words& data) {
  for (int c = first; c < last; ++c) add_parts(block, k, c, c + 1, data);
}

/// Complex stresses: the columns of keep_linear_columns in Nastran's order of real and imaginary parts.
void add_complex_stresses(const records::ListedElements& block, std::size_t k, Words& data) {
  const auto row = static_cast<Eigen::Index>(k);
  switch (block.type) {
    case kBeam:
      for (int station = 0; station < kBeamStations; ++station) {
        const bool is_a = station == 0, is_b = station == kBeamStations - 1;
        data.add(is_a ? block.ends[k][0] : is_b ? block.ends[k][1] : 0);
        data.add(is_b ? 1.0 : 0.0);
        if (is_a || is_b)
          add_parts(block, k, is_b ? 4 : 0, is_b ? 8 : 4, data);
        else
          for (int c = 0; c < 8; ++c) data.add(0.0);
      }
      return;
    case 34:
      add_parts(block, k, 0, 5, data);
      add_parts(block, k, 5, 9, data);
      return;
    case 33:
    case 74:
      for (const int side : {0, 4}) {
        data.add(block.real(row, side));  // the distance
        add_pairs(block, k, side + 1, side + 4, data);
      }
      return;
    case 95:
    case 97:
      add_parts(block, k, 0, 5, data);
      return;
    default:
      add_pairs(block, k, 0, 2, data);  // rods
  }
}

/// Identification of a table of elements; `code`: of the real table.
Words make_element_ident(const ListedStep& step, const records::ListedElements& block, int code) {
  const bool is_complex = block.imag.size() > 0;
  Words ident = make_ident(make_head(step, is_complex ? 1000 + code : code));
  set_step(step, ident);
  ident.set(2, block.type);
  ident.set(8, !is_complex ? 1 : block.is_phase ? 3 : 2);
  return ident;
}

/// Stress code, word 11: 1 von Mises (0 largest shear), 2 and 8 strain, 4 at the fibres.
int find_stress_code(const records::ListedElements& block) {
  const int von_mises = is_layered(block.type) ? 0 : 1;
  if (!block.is_strain()) return von_mises;
  const bool is_plate = block.type == 33 || block.type == 74;
  const bool is_fibre = is_layered(block.type) || (is_plate && block.table == records::PointTable::FibreStrain);
  return 10 + (is_fibre ? 4 : 0) + von_mises;
}

/// Stresses and strains: by element, layer or corner (docs/formats/op2.md).
void add_stresses(const ListedStep& step, const records::ListedElements& block, Op2Writer& file) {
  const bool is_complex = block.imag.size() > 0;
  Words ident = make_element_ident(step, block, 5), data;
  ident.set(10, find_stress_code(block));
  int count = 0;
  for (std::size_t k = 0; k < block.id.size(); ++k) {
    if (is_solid(block.type)) {
      add_solid_row(block, k, data);
      count += block.point[k] == 0;
      continue;
    }
    ++count;
    data.add(10 * block.id[k] + kDevice);
    if (is_layered(block.type)) data.add(block.point[k]);
    if (is_complex)
      add_complex_stresses(block, k, data);
    else if (block.type == kBeam)
      add_beam_stresses(block, k, data);
    else
      for (Eigen::Index c = 0; c < block.real.cols(); ++c) data.add(block.real(static_cast<Eigen::Index>(k), c));
  }
  ident.set(9, count == 0 ? 0 : data.count() / count);
  file.add_record(ident);
  file.add_record(data);
}

void add_forces(const ListedStep& step, const records::ListedElements& block, Op2Writer& file) {
  Words ident = make_element_ident(step, block, 4), data;
  for (std::size_t k = 0; k < block.id.size(); ++k) {
    data.add(10 * block.id[k] + kDevice);
    if (block.type == kBeam)
      add_beam_row(block, k, data);
    else
      for (const auto* part : {&block.real, &block.imag})
        for (Eigen::Index c = 0; c < part->cols(); ++c) data.add((*part)(static_cast<Eigen::Index>(k), c));
  }
  ident.set(9, block.id.empty() ? 0 : data.count() / static_cast<int>(block.id.size()));
  file.add_record(ident);
  file.add_record(data);
}

void add_vectors(const records::Listing& listing, const char* name, const char* inner,
                 const std::function<bool(ListedKind)>& is_of, Op2Writer& file) {
  bool is_open = false;
  for (const auto& step : listing.steps)
    for (const auto& vector : step.vectors) {
      if (!is_of(vector.kind) || vector.id.empty()) continue;
      if (!is_open) file.begin_table(name, inner);
      is_open = true;
      add_vector(step, vector, file);
    }
  if (is_open) file.end_table();
}

/// One block of each element type: readers take a table for a type and subcase to be complete. Elements in ascending
/// order, the rows of each in the order that they have.
std::vector<records::ListedElements> merge_types(const std::vector<records::ListedElements>& blocks) {
  std::vector<std::pair<int, std::vector<const records::ListedElements*>>> types;
  for (const auto& block : blocks) {
    if (block.id.empty()) continue;
    auto type = std::find_if(types.begin(), types.end(), [&](const auto& t) { return t.first == block.type; });
    if (type == types.end()) type = types.insert(types.end(), {block.type, {}});
    type->second.push_back(&block);
  }
  std::vector<records::ListedElements> merged;
  for (const auto& [type, parts] : types) {
    auto& whole = merged.emplace_back(*parts.front());
    if (parts.size() == 1) continue;
    std::vector<std::pair<std::size_t, std::size_t>> rows;  // part, row
    for (std::size_t p = 0; p < parts.size(); ++p)
      for (std::size_t k = 0; k < parts[p]->id.size(); ++k) rows.emplace_back(p, k);
    std::stable_sort(rows.begin(), rows.end(), [&parts = parts](const auto& a, const auto& b) {
      return parts[a.first]->id[a.second] < parts[b.first]->id[b.second];
    });
    const auto num = static_cast<Eigen::Index>(rows.size());
    whole.id.clear();
    whole.point.clear();
    whole.ends.clear();
    whole.real.resize(num, parts.front()->real.cols());
    whole.imag.resize(parts.front()->imag.size() > 0 ? num : 0, parts.front()->imag.cols());
    for (Eigen::Index i = 0; i < num; ++i) {
      const auto& [p, k] = rows[static_cast<std::size_t>(i)];
      const auto& part = *parts[p];
      BOUGH_DEMAND(part.real.cols() == whole.real.cols() && part.imag.cols() == whole.imag.cols());
      whole.id.push_back(part.id[k]);
      if (!part.point.empty()) whole.point.push_back(part.point[k]);
      if (!part.ends.empty()) whole.ends.push_back(part.ends[k]);
      whole.real.row(i) = part.real.row(static_cast<Eigen::Index>(k));
      if (whole.imag.size() > 0) whole.imag.row(i) = part.imag.row(static_cast<Eigen::Index>(k));
    }
  }
  return merged;
}

template <class Add>
void add_blocks(const records::Listing& listing, const char* name,
                std::vector<records::ListedElements> ListedStep::*blocks, const std::function<bool(int)>& is_of,
                const Add& add, Op2Writer& file) {
  bool is_open = false;
  for (const auto& step : listing.steps)
    for (const auto& block : merge_types(step.*blocks)) {
      if (!is_of(block.type)) continue;
      if (!is_open) file.begin_table(name, name);
      is_open = true;
      add(step, block, file);
    }
  if (is_open) file.end_table();
}

/// Table codes of grid point stresses.
constexpr int kSurface = 26, kVolumeDirect = 27, kVolumePrincipal = 28;

void add_grid_stresses(const ListedStep& step, const records::ListedGridStresses& block, int table, Op2Writer& file) {
  Words ident = make_ident(make_head(step, table)), data;
  set_step(step, ident);
  ident.set(2, block.id);
  ident.set(7, block.cid);
  ident.set(8, 1);
  ident.set(9, table == kSurface ? 11 : table == kVolumeDirect ? 9 : 15);
  ident.set(10, 1);  // von Mises
  ident.set(11, block.cid);
  ident.set(12, block.axis);
  const int normal = block.normal.starts_with("X") ? block.normal[1] - '0' : 0;  // 0: R
  ident.set(13, block.is_reversed ? -normal : normal);
  const auto add = [&](Eigen::Index k, int first, int last) {
    for (int c = first; c < last; ++c) data.add(block.values(k, c));
  };
  for (std::size_t i = 0; i < block.grid.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    data.add(10 * block.grid[i] + kDevice);
    if (table == kSurface) {
      data.add(block.element[i]);
      data.add(block.fibre[i], 4);
      add(k, 0, 8);
    } else if (table == kVolumeDirect) {
      add(k, 0, 8);
    } else {
      add(k, 11, 20);
      add(k, 8, 11);
      add(k, 6, 8);
    }
  }
  file.add_record(ident);
  file.add_record(data);
}

void add_grid_stress_table(const records::Listing& listing, Op2Writer& file) {
  bool is_open = false;
  for (const auto& step : listing.steps)
    for (const auto& block : step.grid_stresses)
      for (const int table : {kSurface, kVolumeDirect, kVolumePrincipal}) {
        const bool is_of = table == kSurface
                               ? !block.is_volume
                               : block.is_volume && (table == kVolumeDirect ? block.has_direct : block.has_principal);
        if (!is_of || block.grid.empty()) continue;
        if (!is_open) file.begin_table("OGS1", "OGS1");
        is_open = true;
        add_grid_stresses(step, block, table, file);
      }
  if (is_open) file.end_table();
}

/// Function codes of word 2: real random results by frequency (SORT1) and by point (SORT2).
constexpr int kRandomSort1 = 4000, kRandomSort2 = 6000;
constexpr int kFrequencyAnalysis = 5;

Words make_random_ident(const records::ListedRandom& random, int function) {
  Words ident = make_ident({kFrequencyAnalysis, function + static_cast<int>(random.kind), random.subcase, random.title,
                            random.subtitle, random.label});
  ident.set(8, 1);
  ident.set(9, 8);
  return ident;
}

/// A record per point: frequency or lag, type of the point, six values.
void add_random_curves(const records::ListedRandom& random, const Eigen::VectorXd& at,
                       const std::vector<Eigen::MatrixXd>& values, Op2Writer& file) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    Words ident = make_random_ident(random, kRandomSort2), data;
    ident.set(4, 10 * random.id[k] + kDevice);
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      data.add(at(i));
      data.add(random.is_scalar[k] ? 2 : 1);
      for (int c = 0; c < 6; ++c) data.add(values[k](i, c));
    }
    file.add_record(ident);
    file.add_record(data);
  }
}

/// One record of all points, at 0 Hz.
void add_random_values(const records::ListedRandom& random, const Eigen::MatrixXd& values, Op2Writer& file) {
  Words ident = make_random_ident(random, kRandomSort1), data;
  ident.set(4, 0.0);
  for (std::size_t k = 0; k < random.id.size(); ++k) {
    data.add(10 * random.id[k] + kDevice);
    data.add(random.is_scalar[k] ? 2 : 1);
    for (int c = 0; c < 6; ++c) data.add(values(static_cast<Eigen::Index>(k), c));
  }
  file.add_record(ident);
  file.add_record(data);
}

/// Tables of one kind of quantity; several sets of RANDPS with one first subcase cannot be told apart in the file.
void add_random(const std::vector<records::ListedRandom>& all, const std::string& name, ListedKind kind,
                Op2Writer& file) {
  std::vector<const records::ListedRandom*> chosen;
  for (const auto& random : all) {
    const bool is_first =
        std::none_of(chosen.begin(), chosen.end(), [&](const auto* other) { return other->subcase == random.subcase; });
    if (random.kind == kind && !random.id.empty() && is_first) chosen.push_back(&random);
  }
  if (chosen.empty()) return;
  const auto add_table = [&](const std::string& suffix, const auto& add) {
    file.begin_table(name + suffix, name + suffix);
    for (const auto* random : chosen) add(*random);
    file.end_table();
  };
  add_table("PSD2", [&](const auto& random) { add_random_curves(random, random.hz, random.psd, file); });
  add_table("CRM2", [&](const auto& random) { add_random_curves(random, random.hz, random.cumulative_rms, file); });
  if (std::any_of(chosen.begin(), chosen.end(), [](const auto* random) { return !random->autocorrelation.empty(); }))
    add_table("ATO2",
              [&](const auto& random) { add_random_curves(random, random.lags, random.autocorrelation, file); });
  add_table("RMS1", [&](const auto& random) { add_random_values(random, random.rms, file); });
  add_table("NO1", [&](const auto& random) { add_random_values(random, random.crossing_hz, file); });
}

}  // namespace

std::string make_op2(const records::Listing& listing) {
  demand_small_ids(listing);
  Op2Writer file;
  if (listing.weight) {
    Head head;
    if (!listing.steps.empty()) head = make_head(listing.steps.front(), 13);
    head.subcase = 0;
    add_weight(*listing.weight, head, file);
  }
  if (!listing.roots.empty()) add_roots(listing.roots, file);
  add_vectors(
      listing, "OUGV1", "OUG1",
      [](ListedKind k) {
        return k == ListedKind::Displacement || k == ListedKind::Eigenvector || k == ListedKind::Velocity ||
               k == ListedKind::Acceleration;
      },
      file);
  add_vectors(
      listing, "OPG1", "OPG1", [](ListedKind k) { return k == ListedKind::Load; }, file);
  add_vectors(
      listing, "OQG1", "OQG1", [](ListedKind k) { return k == ListedKind::SpcForce; }, file);
  add_vectors(
      listing, "OQMG1", "OQMG1", [](ListedKind k) { return k == ListedKind::MpcForce; }, file);
  add_blocks(
      listing, "OEF1", &ListedStep::forces, [](int) { return true; }, add_forces, file);
  add_blocks(
      listing, "OES1", &ListedStep::stresses, [](int type) { return !is_layered(type); }, add_stresses, file);
  add_blocks(listing, "OES1C", &ListedStep::stresses, is_layered, add_stresses, file);
  add_blocks(
      listing, "OSTR1", &ListedStep::strains, [](int type) { return !is_layered(type); }, add_stresses, file);
  add_blocks(listing, "OSTR1C", &ListedStep::strains, is_layered, add_stresses, file);
  add_grid_stress_table(listing, file);
  for (const auto& [name, kind] : {std::pair("OUG", ListedKind::Displacement), std::pair("OVG", ListedKind::Velocity),
                                   std::pair("OAG", ListedKind::Acceleration), std::pair("OQG", ListedKind::SpcForce)})
    add_random(listing.random, name, kind, file);
  return file.finish();
}

}  // namespace bough::listing
