/// PSHELL and PSOLID of the elements of NASTRAN-95, once all cards are known.
#include <algorithm>
#include <set>
#include <string>
#include <tuple>

#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

class Finisher {
 public:
  explicit Finisher(Reading& r) : r_(r), deck_(r.deck), old_(r.old_elements) {
    for (const auto& p : deck_.pshell) shell_ids_.insert(p.id);
    for (const auto& p : deck_.pcomp) shell_ids_.insert(p.id);
    for (const auto& p : deck_.psolid) solid_ids_.insert(p.id);
    add_ids(deck_.mat1);
    add_ids(deck_.mat2);
    add_ids(deck_.mat8);
    add_ids(deck_.mat9);
  }

  void finish() {
    find_tetrahedra();
    make_shells();
    make_solids();
    if (old_.counts.empty()) return;
    std::string what;
    bool is_same = true;
    for (const auto& [names, count] : old_.counts) {
      what += (what.empty() ? "" : ", ") + std::to_string(count) + " " + names.first + " as " + names.second;
      is_same = is_same && (names.first == "CIHEX2" || names.first == "CIHEX3");
    }
    r_.diagnostics.note("deck.old-element", deck_.locate(old_.first),
                        "elements of NASTRAN-95 are read as those of today: " + what,
                        is_same ? "their shapes are those of the old formulation"
                                : "they are of the same grids and properties but stiffer or softer than the old "
                                  "formulations (CIHEX2 and CIHEX3 are the same)");
  }

 private:
  template <class Cards>
  void add_ids(const Cards& cards) {
    for (const auto& card : cards) material_ids_.insert(card.id);
  }

  /// `id` if it is free, else the next above all.
  static int take_id(std::set<int>& ids, int id) {
    if (!ids.insert(id).second) ids.insert(id = *ids.rbegin() + 1);
    return id;
  }

  /// CTETRA of the old program names a material where that of today names a PSOLID.
  void find_tetrahedra() {
    for (std::size_t i = 0; i < deck_.solids.size(); ++i) {
      const auto& e = deck_.solids[i];
      if (e.card != "CTETRA" || !e.midsides.empty() || solid_ids_.count(e.pid) > 0 || material_ids_.count(e.pid) == 0)
        continue;
      old_.solids.push_back({i, ""});
      if (old_.counts.empty()) old_.first = e.at;
      ++old_.counts[{"CTETRA with a material", "CTETRA"}];
    }
  }

  /// A plate without a membrane has no separate mass there, but takes that of its bending material here: so it gets a
  /// copy of the material without density.
  int copy_without_mass(int mid) {
    if (const auto known = massless_.find(mid); known != massless_.end()) return known->second;
    int& made = massless_[mid] = mid;
    const auto copy = [&](auto& cards) {
      for (std::size_t i = 0; i < cards.size(); ++i) {
        if (cards[i].id != mid || cards[i].rho == 0) continue;
        auto card = cards[i];
        card.rho = 0;
        card.id = made = take_id(material_ids_, mid);
        cards.push_back(card);
        return;
      }
    };
    copy(deck_.mat1);
    copy(deck_.mat2);
    copy(deck_.mat8);
    return made;
  }

  void fail_property(const std::string& what, const records::CardLocation& at) {
    r_.diagnostics.error("deck.old-property", deck_.locate(at), what + ", which the deck does not define",
                         "add the property or correct the id");
  }

  void make_shells() {
    std::map<std::pair<std::string, int>, int> ids;
    for (auto& [key, p] : old_.shell_properties) {
      auto card = p;
      card.id = ids[key] = take_id(shell_ids_, p.id);
      if (card.mid1 == 0 && card.mid2 > 0) card.mid2 = copy_without_mass(card.mid2);
      deck_.pshell.push_back(card);
    }
    for (const auto& use : old_.shells) {
      auto& e = deck_.shells[use.index];
      const std::pair key(use.property, e.pid);
      const auto id = ids.find(key);
      if (id == ids.end()) {
        fail_property("element " + std::to_string(e.id) + " refers to " + use.property + " " + std::to_string(e.pid),
                      e.at);
        continue;
      }
      e.pid = id->second;
      if (const auto t = old_.corner_t.find(key); t != old_.corner_t.end()) e.t = t->second;
    }
  }

  /// NIP of PIHEX; blank is 2 for CIHEX1, 3 for CIHEX2 and CIHEX3 (User's Manual, PIHEX, remark 2).
  void choose_points(int order, records::Psolid& p) {
    const int given = p.points;
    if (order == 3 && given == 0) p.points = 3;
    if (order == 2 && given == 4) p.points = 3;
    if (order == 1) p.points = 0;
    if (p.points == given || given == 0 || (order == 1 && given == 2)) return;
    r_.diagnostics.note("deck.old-points", deck_.locate(p.at),
                        "PIHEX " + std::to_string(p.id) + " has NIP = " + std::to_string(given) +
                            (order == 1 ? ", CIHEX1 is integrated with its inner modes at 2 points a direction"
                                        : ", CIHEX2 is integrated at 3 points a direction"),
                        "leave NIP blank");
  }

  void make_solids() {
    // Cubic bricks get separate properties, since they are written with a PIHEX in place of a PSOLID. So do bricks of 8
    // and 20 grids if NIP differs.
    std::map<std::tuple<bool, int, int>, int> ids;
    for (const auto& use : old_.solids) {
      auto& e = deck_.solids[use.index];
      const bool by_material = use.property.empty();
      const auto known = old_.solid_properties.find(e.pid);
      const bool has_points = !by_material && known != old_.solid_properties.end() && known->second.points > 0;
      const int order = e.card == "CIHEX3" ? 3 : has_points && !e.midsides.empty() ? 2 : 1;
      const auto [id, is_new] = ids.emplace(std::tuple(by_material, order, e.pid), 0);
      if (is_new) {
        records::Psolid p;
        p.mid = e.pid;
        p.at = e.at;
        if (!by_material) {
          const auto card = old_.solid_properties.find(e.pid);
          if (card == old_.solid_properties.end()) {
            fail_property("element " + std::to_string(e.id) + " refers to PIHEX " + std::to_string(e.pid), e.at);
            ids.erase(id);
            continue;
          }
          p = card->second;
          choose_points(order, p);
        }
        p.id = id->second = take_id(solid_ids_, e.pid);
        deck_.psolid.push_back(p);
      }
      e.pid = id->second;
    }
  }

  Reading& r_;
  records::Deck& deck_;
  OldElements& old_;
  std::set<int> shell_ids_, solid_ids_, material_ids_;
  std::map<int, int> massless_;
};

}  // namespace

void finish_old_elements(Reading& reading) { Finisher(reading).finish(); }

}  // namespace bough::nastran::detail
