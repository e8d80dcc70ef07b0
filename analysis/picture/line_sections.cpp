#include "analysis/picture/line_sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "fe/cards/maker.hpp"
#include "fe/sections/section_shapes.hpp"

namespace bough::analysis {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using fe::BeamEnd;
using fe::EquivalentSection;

std::string describe_equivalent(const EquivalentSection& s) {
  switch (s.kind) {
    case EquivalentSection::Kind::Rectangle:
      return fmt::format("rectangle {:.4g} x {:.4g}, radii of gyration of A, I1, I2", s.d1, s.d2);
    case EquivalentSection::Kind::Ring:
      return s.d2 > 0 ? fmt::format("tube of diameters {:.4g} and {:.4g}, of A and I1 = I2", s.d1, s.d2)
                      : fmt::format("circle of diameter {:.4g}, of A and I1 = I2", s.d1);
    case EquivalentSection::Kind::Circle:
      break;
  }
  return fmt::format("circle of diameter {:.4g}, of A", s.d1);
}

std::vector<fe::SectionFace> shift_faces(std::vector<fe::SectionFace> faces, const Vector2d& by) {
  for (auto& face : faces)
    for (auto& corner : face) corner += by;
  return faces;
}

/// A perpendicular of u for elements without orientation.
Vector3d find_perpendicular(const Vector3d& u) {
  Eigen::Index k = 0;
  u.cwiseAbs().minCoeff(&k);
  return u.cross(Vector3d::Unit(k)).normalized();
}

class SectionBuilder {
 public:
  SectionBuilder(const records::Deck& deck, const std::function<const BeamEnd*(int)>& find_end)
      : deck_(deck), find_end_(find_end) {}

  void build() {
    const fe::RecordIndex<records::Pbar> pbar(deck_.pbar);
    const fe::RecordIndex<records::Pbarl> pbarl(deck_.pbarl);
    const fe::RecordIndex<records::Pbeam> pbeam(deck_.pbeam);
    const fe::RecordIndex<records::Pbeaml> pbeaml(deck_.pbeaml);
    const fe::RecordIndex<records::Prod> prod(deck_.prod);
    const fe::RecordIndex<records::Ptube> ptube(deck_.ptube);
    for (const auto& card : deck_.beams)
      add_beam(card, card.is_cbeam ? find(card.pid, pbeam, pbeaml) : find(card.pid, pbar, pbarl));
    for (const auto& card : deck_.crod) add_rod(card.id, card.ga, card.gb, find(card.pid, prod, prod));
    for (const auto& card : deck_.ctube) add_rod(card.id, card.ga, card.gb, find(card.pid, ptube, ptube));
    std::map<double, Found> by_area;
    for (const auto& card : deck_.conrod) {
      const auto [at, is_new] = by_area.try_emplace(card.A);
      if (is_new) at->second = add(make_circle("CONROD", 0, card.A));
      add_rod(card.id, card.ga, card.gb, at->second);
    }
  }

  LineSections out;

 private:
  using Found = std::optional<std::size_t>;

  Found add(std::optional<LineSection> section) {
    if (!section) return std::nullopt;
    out.sections.push_back(std::move(*section));
    return out.sections.size() - 1;
  }

  /// Section of a property that is one of two cards; made once.
  template <class First, class Second>
  Found find(int pid, const First& first, const Second& second) {
    const auto [at, is_new] = made_.try_emplace({&first, pid});
    if (!is_new) return at->second;
    Found found;
    if (const auto* card = first.find(pid))
      found = add(make(*card));
    else if (const auto* other = second.find(pid))
      found = add(make(*other));
    return made_[{&first, pid}] = found;
  }

  static std::optional<LineSection> make(const records::Pbar& card) {
    return make_equivalent("PBAR", card.id, {{0, card.A, card.I1, card.I2, card.I12, card.J, 0, {}}},
                           {Vector2d::Zero(), Vector2d::Zero()});
  }

  static std::optional<LineSection> make(const records::Pbeam& card) {
    return make_equivalent("PBEAM", card.id, card.stations,
                           {Vector2d(card.n1_a, card.n2_a), Vector2d(card.n1_b, card.n2_b)});
  }

  /// One kind of shape for all stations: a rectangle unless all are rings.
  /// \param n  [L] centroid from the shear centre at both ends.
  static std::optional<LineSection> make_equivalent(const char* card, int id,
                                                    const std::vector<records::PbeamStation>& stations,
                                                    const std::array<Vector2d, 2>& n) {
    std::vector<EquivalentSection> found;
    for (const auto& s : stations) {
      const auto shape = fe::find_equivalent_section(s.A, s.I1, s.I2, s.I12, s.J);
      if (!shape) return std::nullopt;
      found.push_back(*shape);
    }
    if (found.empty()) return std::nullopt;
    const auto is_like_first = [&](const auto& s) {
      return s.kind == found.front().kind && (s.d2 > 0) == (found.front().d2 > 0);
    };
    if (!std::all_of(found.begin(), found.end(), is_like_first))
      for (std::size_t k = 0; k < found.size(); ++k)
        if (stations[k].I1 > 0 && stations[k].I2 > 0)  // without J no ring
          found[k] = *fe::find_equivalent_section(stations[k].A, stations[k].I1, stations[k].I2, stations[k].I12, 0);
    if (!std::all_of(found.begin(), found.end(), is_like_first)) return std::nullopt;
    LineSection section{card, id, describe_equivalent(found.front()), true, {}};
    for (std::size_t k = 0; k < found.size(); ++k) {
      const double t = stations[k].x_over_L;
      section.stations.push_back({t, shift_faces(fe::list_faces(found[k]), (1 - t) * n[0] + t * n[1])});
    }
    return finish(std::move(section));
  }

  static std::optional<LineSection> make(const records::Pbarl& card) {
    LineSection section{"PBARL", card.id, fmt::format("{} {:.4g}", card.shape, fmt::join(card.dims, " ")), false, {}};
    std::string problem;
    // The axis of a bar is its centroid.
    const auto found = fe::calc_library_section(card.shape, card.dims, &problem);
    if (!found) return std::nullopt;
    section.stations.push_back({0, found->faces});
    return finish(std::move(section));
  }

  static std::optional<LineSection> make(const records::Pbeaml& card) {
    if (card.stations.empty()) return std::nullopt;
    const auto& dims = card.stations.front().dims;
    LineSection section{"PBEAML", card.id, fmt::format("{} {:.4g}", card.shape, fmt::join(dims, " ")), false, {}};
    for (const auto& station : card.stations) {
      std::string problem;
      const auto found = fe::calc_library_section(card.shape, station.dims, &problem);
      if (!found) return std::nullopt;
      section.stations.push_back({station.x_over_L, shift_faces(found->faces, found->n)});
    }
    return finish(std::move(section));
  }

  static std::optional<LineSection> make(const records::Prod& card) { return make_circle("PROD", card.id, card.A); }

  static std::optional<LineSection> make_circle(const char* card, int id, double A) {
    const auto shape = fe::find_equivalent_section(A, 0, 0, 0, 0);
    if (!shape) return std::nullopt;
    return finish({card, id, describe_equivalent(*shape), true, {{0, fe::list_faces(*shape)}}});
  }

  static std::optional<LineSection> make(const records::Ptube& card) {
    const double od2 = card.od2.value_or(card.od);
    if (!(card.od > 0) || !(od2 > 0) || card.t < 0) return std::nullopt;
    const auto list = [&](double od) {
      const double inner = card.t > 0 ? od / 2 - card.t : 0;
      return fe::section_shapes::make_round_faces(od / 2, std::max(0.0, inner));
    };
    const auto text = od2 == card.od
                          ? fmt::format("tube of diameter {:.4g}, wall {:.4g}", card.od, card.t)
                          : fmt::format("tube of diameters {:.4g} to {:.4g}, wall {:.4g}", card.od, od2, card.t);
    return finish({"PTUBE", card.id, text, false, {{0, list(card.od)}, {1, list(od2)}}});
  }

  /// A uniform section gets both ends. Empty: stations differ in number of corners (a wall that closes).
  static std::optional<LineSection> finish(LineSection section) {
    auto& stations = section.stations;
    if (stations.size() == 1) stations.push_back({1, stations.front().faces});
    const auto count = [](const LineSection::Station& s) {
      std::vector<std::size_t> corners;
      for (const auto& face : s.faces) corners.push_back(face.size());
      return corners;
    };
    for (const auto& s : stations)
      if (count(s) != count(stations.front())) return std::nullopt;
    return section;
  }

  void add_beam(const records::BeamElement& card, const Found& section) {
    const auto *a = find_end_(card.ga), *b = find_end_(card.gb), *g0 = card.g0 > 0 ? find_end_(card.g0) : nullptr;
    fe::BeamGeometry geometry;
    if (!a || !b || (card.g0 > 0 && !g0) || !fe::has_valid_offt(card) ||
        fe::place_beam(card, *a, *b, fe::calc_orientation(card, *a, g0 ? &g0->x : nullptr), geometry) !=
            fe::BeamFault::None) {
      ++out.num_without;
      return;
    }
    const Vector3d from = a->x + geometry.wa, to = b->x + geometry.wb;
    if (card.pin_a != 0) out.pins.push_back({card.id, card.pin_a, 0.9 * from + 0.1 * to});
    if (card.pin_b != 0) out.pins.push_back({card.id, card.pin_b, 0.1 * from + 0.9 * to});
    if (section)
      out.lines.push_back(
          {card.id, *section, from, to, geometry.R_basic_element.col(1), geometry.R_basic_element.col(2)});
    else
      ++out.num_without;
  }

  void add_rod(int id, int ga, int gb, const Found& section) {
    const auto *a = find_end_(ga), *b = find_end_(gb);
    if (!a || !b || !section || !((b->x - a->x).norm() > 0)) {
      ++out.num_without;
      return;
    }
    const Vector3d along = (b->x - a->x).normalized(), y = find_perpendicular(along);
    out.lines.push_back({id, *section, a->x, b->x, y, along.cross(y)});
  }

  const records::Deck& deck_;
  const std::function<const BeamEnd*(int)>& find_end_;
  std::map<std::pair<const void*, int>, Found> made_;
};

}  // namespace

LineSections make_line_sections(const records::Deck& deck, const std::function<const BeamEnd*(int)>& find_end) {
  SectionBuilder builder(deck, find_end);
  builder.build();
  return std::move(builder.out);
}

}  // namespace bough::analysis
