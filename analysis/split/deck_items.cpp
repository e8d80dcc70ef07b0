#include "analysis/split/deck_items.hpp"

#include <algorithm>
#include <type_traits>

namespace bough::analysis::splitting {

namespace {

using namespace records;

constexpr unsigned kRotations = 0b111000;

std::vector<int> get_grids(const BeamElement& e) { return {e.ga, e.gb, e.sa, e.sb}; }
std::vector<int> get_grids(const ShearPanel& e) { return {e.grids.begin(), e.grids.end()}; }
std::vector<int> get_grids(const Conm1& e) { return {e.g}; }
std::vector<int> get_grids(const Conm2& e) { return {e.g}; }
std::vector<int> get_grids(const ShellElement& e) {
  auto grids = e.grids;
  grids.insert(grids.end(), e.midsides.begin(), e.midsides.end());
  return grids;
}
std::vector<int> get_grids(const SolidElement& e) {
  auto grids = e.corners;
  grids.insert(grids.end(), e.midsides.begin(), e.midsides.end());
  return grids;
}
std::vector<int> get_grids(const Genel& e) {
  std::vector<int> grids;
  for (const auto& term : e.ui) grids.push_back(term.g);
  for (const auto& term : e.ud) grids.push_back(term.g);
  return grids;
}
std::vector<int> get_grids(const Rbe2& e) {
  std::vector<int> grids{e.gn};
  grids.insert(grids.end(), e.gm.begin(), e.gm.end());
  return grids;
}
std::vector<int> get_grids(const Rbe3& e) {
  std::vector<int> grids{e.ref_grid};
  for (const auto& group : e.groups) grids.insert(grids.end(), group.grids.begin(), group.grids.end());
  return grids;
}
std::vector<int> get_grids(const Rbe1& e) {
  std::vector<int> grids;
  for (const auto& term : e.independent) grids.push_back(term.g);
  for (const auto& term : e.dependent) grids.push_back(term.g);
  return grids;
}
std::vector<int> get_grids(const Rspline& e) {
  std::vector<int> grids;
  for (const auto& point : e.points) grids.push_back(point.g);
  return grids;
}
std::vector<int> get_grids(const Mpc& e) {
  std::vector<int> grids;
  for (const auto& term : e.terms) grids.push_back(term.g);
  return grids;
}
template <class Card>
std::vector<int> get_grids(const Card& e) {
  if constexpr (requires { e.g1; })
    return {e.g1, e.g2};
  else
    return {e.ga, e.gb};
}

template <class Card>
std::string get_card(const Card& e) {
  using T = std::remove_cv_t<Card>;
  if constexpr (requires { e.card; }) return e.card;
  if constexpr (std::is_same_v<T, BeamElement>) return e.is_cbeam ? "CBEAM" : "CBAR";
  if constexpr (std::is_same_v<T, Crod>) return "CROD";
  if constexpr (std::is_same_v<T, Conrod>) return "CONROD";
  if constexpr (std::is_same_v<T, Ctube>) return "CTUBE";
  if constexpr (std::is_same_v<T, Cbend>) return "CBEND";
  if constexpr (std::is_same_v<T, ScalarSpring>)
    return e.by_scalar_points ? (e.pid > 0 ? "CELAS3" : "CELAS4") : (e.pid > 0 ? "CELAS1" : "CELAS2");
  if constexpr (std::is_same_v<T, Cbush>) return "CBUSH";
  if constexpr (std::is_same_v<T, Cbush1d>) return "CBUSH1D";
  if constexpr (std::is_same_v<T, ScalarDamper>)
    return e.by_scalar_points ? (e.pid > 0 ? "CDAMP3" : "CDAMP4") : (e.pid > 0 ? "CDAMP1" : "CDAMP2");
  if constexpr (std::is_same_v<T, Cvisc>) return "CVISC";
  if constexpr (std::is_same_v<T, Cgap>) return "CGAP";
  if constexpr (std::is_same_v<T, ShearPanel>) return "CSHEAR";
  if constexpr (std::is_same_v<T, Genel>) return "GENEL";
  if constexpr (std::is_same_v<T, ScalarMass>)
    return e.by_scalar_points ? (e.pid > 0 ? "CMASS3" : "CMASS4") : (e.pid > 0 ? "CMASS1" : "CMASS2");
  if constexpr (std::is_same_v<T, Conm1>) return "CONM1";
  if constexpr (std::is_same_v<T, Conm2>) return "CONM2";
  if constexpr (std::is_same_v<T, Plotel>) return "PLOTEL";
  if constexpr (std::is_same_v<T, Rbe2>) return "RBE2";
  if constexpr (std::is_same_v<T, Rbe3>) return "RBE3";
  if constexpr (std::is_same_v<T, Rbar>) return "RBAR";
  if constexpr (std::is_same_v<T, Rrod>) return "RROD";
  if constexpr (std::is_same_v<T, Rbe1>) return "RBE1";
  if constexpr (std::is_same_v<T, Rspline>) return "RSPLINE";
  if constexpr (std::is_same_v<T, Mpc>) return "MPC";
  return {};
}

/// Returns true if the stiffness of the card (with one end at the ground) acts from the ground.
template <class Card>
bool acts_from_ground(const Card& e) {
  if constexpr (std::is_same_v<Card, ScalarSpring> || std::is_same_v<Card, ScalarDamper>)
    return e.g1 == 0 || e.g2 == 0;
  else if constexpr (std::is_same_v<Card, Cbush> || std::is_same_v<Card, Cbush1d>)
    return e.gb == 0;
  else
    return false;
}

template <class Card>
bool transfers_moments(const Card& e) {
  if constexpr (std::is_same_v<Card, ScalarSpring>)
    return e.c1 > 3 || e.c2 > 3;
  else if constexpr (std::is_same_v<Card, Rbe2>)
    return (e.cm & kRotations) != 0;
  else if constexpr (std::is_same_v<Card, Rbar>)
    return ((e.cna | e.cnb | e.cma | e.cmb) & kRotations) != 0;
  else
    return std::is_same_v<Card, BeamElement> || std::is_same_v<Card, Cbend> || std::is_same_v<Card, Cbush> ||
           std::is_same_v<Card, ShellElement> || std::is_same_v<Card, Genel> || std::is_same_v<Card, Rbe1> ||
           std::is_same_v<Card, Rbe3> || std::is_same_v<Card, Rspline>;
}

template <class Card>
DeckItem make_item(const Card& e) {
  DeckItem item;
  if constexpr (requires { e.id; })
    item.id = e.id;
  else
    item.id = e.sid;
  if constexpr (requires { e.pid; }) item.property = e.pid;
  item.card = get_card(e);
  item.grids = get_grids(e);
  std::sort(item.grids.begin(), item.grids.end());
  item.grids.erase(std::unique(item.grids.begin(), item.grids.end()), item.grids.end());
  std::erase(item.grids, 0);
  item.is_grounded = acts_from_ground(e);
  item.is_drawn = std::is_same_v<Card, Plotel>;
  item.has_moments = transfers_moments(e);
  item.at = e.at;
  return item;
}

/// Erases the cards of one kind after the other by the flags of the whole list.
class Keeper {
 public:
  explicit Keeper(const std::vector<char>& is_kept) : is_kept_(is_kept) {}
  template <class Card>
  void operator()(std::vector<Card>& cards) {
    std::erase_if(cards, [&](const Card&) { return is_kept_[next_++] == 0; });
  }

 private:
  const std::vector<char>& is_kept_;
  std::size_t next_ = 0;
};

}  // namespace

std::vector<DeckItem> list_elements(const Deck& deck) {
  std::vector<DeckItem> items;
  visit_elements(deck, [&](const auto& cards) {
    for (const auto& card : cards) items.push_back(make_item(card));
  });
  return items;
}

std::vector<DeckItem> list_rigid(const Deck& deck) {
  std::vector<DeckItem> items;
  visit_rigid(deck, [&](const auto& cards) {
    for (const auto& card : cards) items.push_back(make_item(card));
  });
  return items;
}

void keep_elements(Deck& deck, const std::vector<char>& is_kept) { visit_elements(deck, Keeper(is_kept)); }
void keep_rigid(Deck& deck, const std::vector<char>& is_kept) { visit_rigid(deck, Keeper(is_kept)); }

std::vector<int> list_reference_grids(const Deck& deck) {
  std::vector<int> grids;
  const auto add = [&](const auto& cards) {
    for (const auto& card : cards) grids.push_back(card.g0);
  };
  add(deck.beams), add(deck.cbush), add(deck.special.cbend), add(deck.special.cgap);
  for (const auto& system : deck.coord_systems)
    if (system.by_grids) grids.insert(grids.end(), system.grids.begin(), system.grids.end());
  for (const auto& load : deck.load_cards.directed) grids.insert(grids.end(), load.grids.begin(), load.grids.end());
  for (const auto& load : deck.load_cards.rotations) grids.push_back(load.g);
  return grids;
}

std::vector<std::pair<int, unsigned>> list_dependent(const Deck& deck) {
  std::vector<std::pair<int, unsigned>> dependent;
  for (const auto& e : deck.rbe2)
    for (const int g : e.gm) dependent.emplace_back(g, e.cm);
  for (const auto& e : deck.rbe3) {
    if (e.um.empty()) dependent.emplace_back(e.ref_grid, e.ref_c);
    for (const auto& term : e.um) dependent.emplace_back(term.g, term.c);
  }
  for (const auto& e : deck.rbar) {
    dependent.emplace_back(e.ga, e.cma);
    dependent.emplace_back(e.gb, e.cmb);
  }
  for (const auto& e : deck.rrod) dependent.emplace_back(e.cma > 0 ? e.ga : e.gb, 1U << (std::max(e.cma, e.cmb) - 1));
  for (const auto& e : deck.rbe1)
    for (const auto& term : e.dependent) dependent.emplace_back(term.g, term.c);
  for (const auto& e : deck.special.rspline)
    for (const auto& point : e.points) dependent.emplace_back(point.g, point.c);
  for (const auto& e : deck.mpc)
    if (!e.terms.empty() && e.terms.front().c > 0)
      dependent.emplace_back(e.terms.front().g, 1U << (e.terms.front().c - 1));
  std::erase_if(dependent, [](const auto& entry) { return entry.second == 0; });
  return dependent;
}

std::string name_item(const DeckItem& item) { return item.card + " " + std::to_string(item.id); }

}  // namespace bough::analysis::splitting
