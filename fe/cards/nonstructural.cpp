#include "fe/cards/nonstructural.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "fe/elements/beam.hpp"
#include "formats/records/selection.hpp"

namespace bough::fe {

namespace {

bool card_is_shell(const std::string& card) { return card.substr(0, 5) == "CQUAD" || card.substr(0, 5) == "CTRIA"; }

}  // namespace

void NonstructuralMass::add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const {
  const bool is_shell = card_is_shell(host_.card());
  if (factor_ != 0 && !is_shell) return host_.add_mass(kind, factor_ * scale, M);
  if (factor_ != 0) {
    MatrixXd own = MatrixXd::Zero(num_dofs(), num_dofs());
    host_.add_mass(kind, factor_ * scale, own);
    for (int i = 0; i < num_dofs(); ++i)
      for (int j = 0; j < num_dofs(); ++j)
        if (i % 6 < 3 && j % 6 < 3) M(i, j) += own(i, j);
    return;
  }
  const int count = static_cast<int>(nodes().size()), stride = num_dofs() / count;
  for (int k = 0; k < count; ++k)
    for (int i = 0; i < 3; ++i) M(stride * k + i, stride * k + i) += scale * mass_ / count;
}

const OffsetMass* NonstructuralMass::offset_mass(MassKind kind) const {
  return factor_ != 0 && !card_is_shell(host_.card()) && host_.offset_mass(kind) ? this : nullptr;
}

bool NonstructuralMass::add_carried(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const {
  BOUGH_DEMAND(carried.points.empty());
  const bool is_known = host_.offset_mass(kind)->add_carried(kind, x, carried);
  carried.mu *= factor_;
  return is_known;
}

double calc_element_mass(const Element& element) {
  const int n = element.num_dofs();
  if (n < 6 || n % 6 != 0) return 0;
  MatrixXd M = MatrixXd::Zero(n, n);
  element.add_mass(MassKind::Lumped, 1, M);
  double mass = 0;
  for (int i = 0; i < n; i += 6)
    for (int j = 0; j < n; j += 6) mass += M(i, j);
  return mass;
}

namespace {

/// An element that can carry nonstructural mass: its property id and the types that name it.
struct Owner {
  int pid = 0;
  const char* type = "";
};
using Owners = std::unordered_map<std::string, std::unordered_map<int, Owner>>;  ///< by card and element id

template <class Card, class Properties>
void add_owner(Owners& owners, const std::string& name, const Card& card, const Properties& properties) {
  for (const auto& [type, ids] : properties)
    if (ids.count(card.pid) > 0) owners[name][card.id] = {card.pid, type};
}

template <class Record>
std::set<int> list_ids(const std::vector<Record>& records) {
  std::set<int> ids;
  for (const auto& record : records) ids.insert(record.id);
  return ids;
}

Owners list_owners(const records::Deck& deck) {
  using Kinds = std::vector<std::pair<const char*, std::set<int>>>;
  const Kinds bars{{"PBAR", list_ids(deck.pbar)}, {"PBARL", list_ids(deck.pbarl)}};
  const Kinds beams{
      {"PBEAM", list_ids(deck.pbeam)}, {"PBEAML", list_ids(deck.pbeaml)}, {"PBCOMP", list_ids(deck.special.pbcomp)}};
  const Kinds shells{{"PSHELL", list_ids(deck.pshell)}, {"PCOMP", list_ids(deck.pcomp)}};
  const Kinds rods{{"PROD", list_ids(deck.prod)}}, tubes{{"PTUBE", list_ids(deck.ptube)}};
  const Kinds panels{{"PSHEAR", list_ids(deck.pshear)}};
  Owners owners;
  for (const auto& card : deck.beams)
    add_owner(owners, card.is_cbeam ? "CBEAM" : "CBAR", card, card.is_cbeam ? beams : bars);
  for (const auto& card : deck.crod) add_owner(owners, "CROD", card, rods);
  for (const auto& card : deck.ctube) add_owner(owners, "CTUBE", card, tubes);
  for (const auto& card : deck.conrod) owners["CONROD"][card.id] = {card.id, "CONROD"};
  for (const auto& card : deck.shells) add_owner(owners, card.card, card, shells);
  for (const auto& card : deck.shear_panels) add_owner(owners, "CSHEAR", card, panels);
  return owners;
}

/// Length of a line element between its (offset) ends, area of the corners of a panel or shell.
double calc_measure(const Element& element, const NodeTable& nodes) {
  if (const auto* beam = element.as_beam()) return beam->geometry().length;
  const auto x = [&](std::size_t k) -> const Vector3d& { return nodes.node(element.nodes()[k]).x; };
  const std::string& card = element.card();
  if (card == "CROD" || card == "CTUBE" || card == "CONROD") return (x(1) - x(0)).norm();
  if (card.substr(0, 5) == "CTRIA") return 0.5 * (x(1) - x(0)).cross(x(2) - x(0)).norm();
  return 0.5 * (x(2) - x(0)).cross(x(3) - x(1)).norm();
}

bool names(const records::NonstructuralMass& card, int id) {
  return card.is_all || std::any_of(card.range.begin(), card.range.end(),
                                    [id](const auto& range) { return id >= range.first && id <= range.second; });
}

/// PCOMPG, of which PCOMP was made when it was read, and the library sections go by either name.
bool is_type(const std::string& requested, const std::string& type) {
  const auto family = [](const std::string& name) {
    if (name == "PCOMPG") return std::string("PCOMP");
    if (name == "PBARL") return std::string("PBAR");
    if (name == "PBEAML" || name == "PBCOMP") return std::string("PBEAM");
    return name;
  };
  return family(requested) == family(type);
}

std::set<int> expand(const records::Deck& deck, int set) {
  for (const auto& [sid, sets] : deck.special.nsmadd)
    if (sid == set) return {sets.begin(), sets.end()};
  return {set};
}

}  // namespace

ElementList make_nonstructural(const records::Deck& deck, int nsm,
                               const std::vector<std::unique_ptr<const Element>>& elements, const NodeTable& nodes,
                               Diagnostics& diagnostics) {
  ElementList list;
  if (nsm == 0) {
    if (!deck.special.nsm.empty())
      diagnostics.warning("fe.nsm-unused", deck.locate(deck.special.nsm.front().at),
                          "NSM cards are not selected and add no mass", "select them with NSM = n in the case control");
    return list;
  }
  const std::set<int> sets = expand(deck, nsm);
  std::set<int> missing = sets;
  const Owners owners = list_owners(deck);
  for (const auto& card : deck.special.nsm) {
    if (sets.count(card.sid) == 0) continue;
    missing.erase(card.sid);
    std::vector<std::pair<const Element*, double>> hosts;
    double total = 0;
    for (const auto& element : elements) {
      const auto by_card = owners.find(element->card());
      if (by_card == owners.end()) continue;
      const auto owner = by_card->second.find(element->id());
      if (owner == by_card->second.end()) continue;
      const bool is_named = card.type == "ELEMENT"
                                ? names(card, element->id())
                                : is_type(card.type, owner->second.type) && names(card, owner->second.pid);
      if (!is_named) continue;
      hosts.emplace_back(element.get(), calc_measure(*element, nodes));
      total += hosts.back().second;
    }
    if (hosts.empty())
      diagnostics.warning(
          "fe.nsm-no-element", deck.locate(card.at),
          "no element has the nonstructural mass of set " + std::to_string(card.sid) + " for " + card.type,
          "correct the type or the ids");
    for (const auto& [host, measure] : hosts) {
      const double mass = card.is_total ? card.value * measure / total : card.value * measure;
      const double own = calc_element_mass(*host);
      list.elements.push_back(std::make_unique<NonstructuralMass>(*host, own > 0 ? mass / own : 0, mass));
    }
  }
  for (const int set : missing)
    diagnostics.error("fe.missing-set", deck.locate(records::find_selection(deck, "NSM", nsm)),
                      "NSM set " + std::to_string(set) + " is selected but has no cards", "correct the set id");
  return list;
}

}  // namespace bough::fe
