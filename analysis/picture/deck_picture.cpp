#include "analysis/picture/deck_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "fe/model/coordinates.hpp"
#include "formats/records/element_cards.hpp"

namespace bough::analysis {

namespace {

using records::CardLocation;
using records::Deck;

/// Union of sets of grids by path halving.
class GridSets {
 public:
  explicit GridSets(std::size_t count) : parent_(count), is_used_(count, false) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  void join(std::size_t a, std::size_t b) {
    is_used_[a] = is_used_[b] = true;
    parent_[find(a)] = find(b);
  }
  /// Number of the set of each grid, 0 the largest; -1 for a grid that was never joined.
  std::vector<int> number(int& count) {
    std::unordered_map<std::size_t, int> size;
    for (std::size_t k = 0; k < parent_.size(); ++k)
      if (is_used_[k]) ++size[find(k)];
    std::vector<std::pair<int, std::size_t>> order;
    for (const auto& [root, number_of_grids] : size) order.emplace_back(-number_of_grids, root);
    std::sort(order.begin(), order.end());
    std::unordered_map<std::size_t, int> rank;
    for (const auto& entry : order) rank.emplace(entry.second, static_cast<int>(rank.size()));
    std::vector<int> part(parent_.size(), -1);
    for (std::size_t k = 0; k < parent_.size(); ++k)
      if (is_used_[k]) part[k] = rank.at(find(k));
    count = static_cast<int>(order.size());
    return part;
  }

 private:
  std::vector<std::size_t> parent_;
  std::vector<bool> is_used_;
};

class PictureBuilder {
 public:
  PictureBuilder(const Deck& deck, Diagnostics& diagnostics)
      : deck_(deck),
        diagnostics_(diagnostics),
        systems_(deck, Eigen::Vector3d::Zero(), diagnostics),
        sets_(deck.grids.size()) {
    const auto count = static_cast<Eigen::Index>(deck.grids.size());
    picture.mesh.grid_xyz.resize(count, 3);
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto& grid = deck.grids[static_cast<std::size_t>(k)];
      index_.emplace(grid.id, static_cast<int>(k));
      picture.mesh.grid_id.push_back(grid.id);
      picture.mesh.grid_xyz.row(k) = systems_.get_grid_position(static_cast<int>(k)).transpose();
      picture.grids.push_back(grid.at);
      if (grid.ps != 0) picture.supports.push_back({grid.id, 0, grid.ps});
    }
  }

  void build() {
    add_elements();
    finish_blocks();
    add_masses();
    add_spiders();
    add_symbols();
    add_properties();
    add_line_sections();
    picture.part = sets_.number(picture.num_parts);
  }

  DeckPicture picture;

 private:
  struct Row {
    std::vector<int> grids;  ///< rows of the mesh
    DeckPicture::Element element;
  };

  int find(int grid) const {
    const auto at = index_.find(grid);
    return at == index_.end() ? -1 : at->second;
  }
  Eigen::Vector3d get_place(int row) const { return picture.mesh.grid_xyz.row(row).transpose(); }

  void add(const std::string& type, const std::vector<int>& ids, DeckPicture::Element element) {
    Row row{{}, std::move(element)};
    for (const int id : ids) {
      row.grids.push_back(find(id));
      if (row.grids.back() >= 0) continue;
      const auto& scalars = deck_.scalar_points;
      if (deck_.is_refused(id, {"GRID"}) || std::find(scalars.begin(), scalars.end(), id) != scalars.end()) return;
      const auto& [number, property, card, at] = row.element;
      diagnostics_.error(
          "fe.missing-grid", deck_.locate(at),
          fmt::format("{} {} is not drawn: it refers to grid {}, which the deck does not define", card, number, id),
          "add the GRID or correct the id");
      return;
    }
    join(row.grids);
    rows_[type].push_back(std::move(row));
  }
  void join(const std::vector<int>& rows) {
    for (const int row : rows) sets_.join(static_cast<std::size_t>(rows.front()), static_cast<std::size_t>(row));
  }

  void add_elements() {
    using enum records::ElementRole;
    records::visit_elements(deck_, {Element, Drawn}, [&](const records::ElementView& view) {
      if (const auto* type = find_block(view); type != nullptr)
        add(type, {view.grids.begin(), view.grids.begin() + static_cast<std::ptrdiff_t>(view.num_corners)},
            {view.id, view.property, name_family(view.card), view.at});
    });
  }

  /// Block of the mesh for the corners of an element; nullptr: not drawn.
  static const char* find_block(const records::ElementView& view) {
    const auto n = view.num_corners;
    switch (view.shape) {
      case records::ElementShape::Line:
        return view.grids[0] > 0 && view.grids[1] > 0 ? "line2" : nullptr;
      case records::ElementShape::Surface:
        return n == 3 ? "tri3" : "quad4";
      case records::ElementShape::Solid:
        return n == 4 ? "tetra4" : n == 5 ? "pyramid5" : n == 6 ? "penta6" : n == 8 ? "hexa8" : nullptr;
      case records::ElementShape::None:
        break;
    }
    return nullptr;
  }

  /// "CELAS" of CELAS1 to CELAS4, likewise CDAMP; other names unchanged.
  static std::string name_family(const std::string& card) {
    return card.starts_with("CELAS") || card.starts_with("CDAMP") ? card.substr(0, 5) : card;
  }

  void finish_blocks() {
    for (auto& [type, rows] : rows_) {
      records::BodyMesh::Block block;
      block.type = type;
      block.connectivity.resize(static_cast<Eigen::Index>(rows.size()),
                                static_cast<Eigen::Index>(rows.front().grids.size()));
      for (std::size_t e = 0; e < rows.size(); ++e) {
        block.element_id.push_back(rows[e].element.id);
        for (std::size_t k = 0; k < rows[e].grids.size(); ++k)
          block.connectivity(static_cast<Eigen::Index>(e), static_cast<Eigen::Index>(k)) = rows[e].grids[k];
        picture.elements.push_back(std::move(rows[e].element));
      }
      picture.mesh.blocks.push_back(std::move(block));
    }
  }

  void add_masses() {
    for (const auto& e : deck_.conm2) {
      const int row = find(e.g);
      if (row < 0) continue;
      Eigen::Vector3d place = get_place(row);
      const auto at = deck_.locate(e.at);
      if (e.cid < 0)
        place = e.x;
      else if (!e.x.isZero(0))
        place += systems_.calc_axes(e.cid, place, at, diagnostics_) * e.x;
      picture.masses.push_back({e.id, e.g, "CONM2", e.m, place, e.at});
    }
    for (const auto& e : deck_.conm1)
      if (const int row = find(e.g); row >= 0)
        picture.masses.push_back({e.id, e.g, "CONM1", e.m(0, 0), get_place(row), e.at});
    for (const auto& e : deck_.scalar_masses)
      if (const int row = find(e.g1); row >= 0)
        picture.masses.push_back({e.id, e.g1, "CMASS", e.m, get_place(row), e.at});
  }

  void add_spider(const std::string& card, int id, int centre, std::vector<int> grids, const CardLocation& at) {
    std::vector<int> rows{find(centre)};
    std::erase_if(grids, [&](int grid) { return find(grid) < 0; });
    if (rows.front() < 0 || grids.empty()) return;
    for (const int grid : grids) rows.push_back(find(grid));
    join(rows);
    picture.spiders.push_back({id, centre, card, std::move(grids), at});
  }

  void add_spiders() {
    records::visit_elements(deck_, {records::ElementRole::Rigid}, [&](const records::ElementView& view) {
      if (view.centre > 0) add_spider(view.card, view.id, view.centre, view.spokes, view.at);
    });
  }

  void add_symbols() {
    for (const auto& spc : deck_.spc)
      if (find(spc.g) >= 0) picture.supports.push_back({spc.g, spc.sid, spc.c});
    for (const auto& load : deck_.point_loads) {
      const int row = find(load.g);
      if (row < 0) continue;
      const Eigen::Matrix3d axes = systems_.calc_axes(load.cid, get_place(row), deck_.locate(load.at), diagnostics_);
      picture.loads.push_back({load.g, load.sid, load.f * (axes * load.n), load.is_moment});
    }
    for (const auto& card : deck_.coord_systems)
      if (const auto* system = systems_.find(card.id); system != nullptr && system->is_resolved)
        picture.systems.push_back({card.id, system->origin, system->R_basic});
  }

  void add_line_sections() {
    std::unordered_map<int, fe::BeamEnd> ends;
    picture.line_sections = make_line_sections(deck_, [&](int id) -> const fe::BeamEnd* {
      const int row = find(id);
      if (row < 0) return nullptr;
      const auto [at, is_new] = ends.try_emplace(id);
      const auto& grid = deck_.grids[static_cast<std::size_t>(row)];
      if (is_new)
        at->second = {get_place(row), systems_.calc_axes(grid.cd, get_place(row), deck_.locate(grid.at), diagnostics_)};
      return &at->second;
    });
  }

  template <class Cards, class Describe>
  void add_cards(const char* card, const Cards& cards, const Describe& describe) {
    for (const auto& one : cards) picture.properties.push_back({card, describe(one), one.id, one.at});
  }

  void add_properties() {
    const auto bar = [](const auto& p) {
      return fmt::format("A {:g}, I1 {:g}, I2 {:g}, J {:g}", p.A, p.I1, p.I2, p.J);
    };
    const auto section = [](const auto& p) { return p.shape; };
    const auto nothing = [](const auto&) { return std::string(); };
    add_cards("PBAR", deck_.pbar, bar);
    add_cards("PBARL", deck_.pbarl,
              [](const auto& p) { return fmt::format("{} {:g}", p.shape, fmt::join(p.dims, " ")); });
    add_cards("PBEAM", deck_.pbeam, [&](const auto& p) { return p.stations.empty() ? "" : bar(p.stations.front()); });
    add_cards("PBEAML", deck_.pbeaml, section);
    add_cards("PROD", deck_.prod, [](const auto& p) { return fmt::format("A {:g}, J {:g}", p.A, p.J); });
    add_cards("PTUBE", deck_.ptube, [](const auto& p) { return fmt::format("OD {:g}, T {:g}", p.od, p.t); });
    add_cards("PELAS", deck_.pelas, [](const auto& p) { return fmt::format("K {:g}", p.k); });
    add_cards("PBUSH", deck_.pbush, [](const auto& p) { return fmt::format("K {:g}", fmt::join(p.k, " ")); });
    add_cards("PSHELL", deck_.pshell, [](const auto& p) { return p.t ? fmt::format("T {:g}", *p.t) : ""; });
    add_cards("PCOMP", deck_.pcomp, [](const auto& p) { return fmt::format("{} plies", p.plies.size()); });
    add_cards("PSHEAR", deck_.pshear, [](const auto& p) { return fmt::format("T {:g}", p.t); });
    add_cards("PSOLID", deck_.psolid, nothing);
    add_cards("MAT1", deck_.mat1,
              [](const auto& m) { return fmt::format("E {:g}, NU {:g}, RHO {:g}", m.E, m.nu, m.rho); });
    add_cards("MAT2", deck_.mat2, nothing);
    add_cards("MAT8", deck_.mat8, [](const auto& m) { return fmt::format("E1 {:g}, E2 {:g}", m.E1, m.E2); });
    add_cards("MAT9", deck_.mat9, nothing);
  }

  const Deck& deck_;
  Diagnostics& diagnostics_;
  fe::CoordinateSystems systems_;
  GridSets sets_;
  std::unordered_map<int, int> index_;
  std::map<std::string, std::vector<Row>> rows_;
};

}  // namespace

DeckPicture make_deck_picture(const Deck& deck, Diagnostics& diagnostics) {
  PictureBuilder builder(deck, diagnostics);
  builder.build();
  return std::move(builder.picture);
}

}  // namespace bough::analysis
