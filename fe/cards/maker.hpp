#pragma once
/// \file Tools that the makers of each element family share: the deck, look-ups by id that report, dofs of nodes.
/// Internal.
#include <functional>
#include <unordered_map>

#include "fe/elements/element.hpp"

namespace bough::fe {

/// Index of records by id; the last one of an id wins.
template <class Record>
class RecordIndex {
 public:
  explicit RecordIndex(const std::vector<Record>& records) {
    for (const Record& record : records) map_[record.id] = &record;
  }
  const Record* find(int id) const {
    const auto it = map_.find(id);
    return it == map_.end() ? nullptr : it->second;
  }

 private:
  std::unordered_map<int, const Record*> map_;
};

class Maker {
 public:
  /// All arguments must outlive this; elements are added to `list`.
  Maker(const records::Deck& deck, const NodeTable& nodes, Diagnostics& diagnostics, ElementList& list)
      : deck_(deck), nodes_(nodes), diagnostics_(diagnostics), list_(list), mat1_(deck.mat1) {}

  /// Deck whose cards become elements.
  const records::Deck& deck() const { return deck_; }
  /// Nodes of the model by grid.
  const NodeTable& nodes() const { return nodes_; }
  /// Receives errors and warnings of the cards.
  Diagnostics& diagnostics() { return diagnostics_; }
  /// ge: structural damping of the material or property.
  void add(std::unique_ptr<Element> element, double ge = 0) {
    element->set_structural_damping(ge);
    list_.add(std::move(element));
  }

  /// Adds an error at the line of a card.
  void error(const std::string& id, const records::CardLocation& at, std::string what, std::string advice = {}) {
    diagnostics_.error(id, deck_.locate(at), std::move(what), std::move(advice));
  }
  /// Node index of a grid with six dofs, or -1 after reporting fe.missing-grid.
  int find_grid(int grid, const std::string& who, const records::CardLocation& at);
  /// Node index of a grid or scalar point, or -1 after reporting.
  int find_point(int grid, const std::string& who, const records::CardLocation& at);
  /// MAT1 with E > 0, G >= 0, rho >= 0, or nullptr after reporting fe.missing-material or fe.bad-material.
  const records::Mat1* find_material(int mid, const std::string& who, const records::CardLocation& at);
  /// Reports fe.missing-property.
  void report_missing_property(int pid, const std::string& kinds, const std::string& who,
                               const records::CardLocation& at);
  /// Rows of the g-set of all dofs of the nodes, in order.
  std::vector<int> list_gdofs(const std::vector<int>& node_indices) const;

 private:
  const records::Deck& deck_;
  const NodeTable& nodes_;
  Diagnostics& diagnostics_;
  ElementList& list_;
  RecordIndex<records::Mat1> mat1_;
  std::unordered_map<int, bool> material_ok_;
};

/// CBAR and CBEAM with PBAR, PBARL, PBEAM, PBEAML, PBCOMP.
void make_beams(Maker& maker);
/// CROD, CONROD, CTUBE.
void make_rods(Maker& maker);
/// CELASi, CMASSi, CDAMPi, CBUSH, CGAP.
void make_springs(Maker& maker);
/// Dampers and springs along the line between two grids.
void make_line_dampers(Maker& maker);
/// CONM1, CONM2.
void make_masses(Maker& maker);
/// Shells without midside grids.
void make_shells(Maker& maker);
/// Shells with midside grids: CQUAD8, CTRIA6.
void make_curved_shells(Maker& maker);
/// CSHEAR.
void make_shear_panels(Maker& maker);
/// CHEXA, CPENTA, CTETRA, CPYRAM, CIHEX3.
void make_solids(Maker& maker);
/// CBEND.
void make_bends(Maker& maker);
/// GENEL.
void make_generals(Maker& maker);
/// CFAST, CWELD.
void make_connectors(Maker& maker);

}  // namespace bough::fe
