#include "fe/cards/material_temperatures.hpp"

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "base/number_text.hpp"
#include "fe/cards/shell_patch.hpp"
#include "fe/cards/temperature_set.hpp"
#include "formats/records/selection.hpp"

namespace bough::fe {
namespace {

using records::Deck;

/// Elements of one material or property at one temperature share its copy.
class Evaluator {
 public:
  Evaluator(const Deck& deck, int set, const NodeTable& nodes, Diagnostics& diagnostics)
      : source_(deck),
        deck_(std::make_unique<Deck>(deck)),
        nodes_(nodes),
        temperatures_(deck.temperatures, set),
        set_(set),
        diagnostics_(diagnostics) {
    for (const auto& t : deck.temperatures.materials) tables_[t.mid] = &t;
    for (const auto& t : deck.temperatures.tables) curves_[t.id] = &t;
    for (const auto& t : deck.temperatures.materials) check_material(t);
    const auto raise = [this](const auto& records) {
      for (const auto& r : records) next_ = std::max(next_, r.id);
    };
    const auto& s = deck.special;
    raise(deck.mat1), raise(deck.mat2), raise(deck.mat8), raise(deck.mat9);
    raise(deck.pbar), raise(deck.pbarl), raise(deck.pbeam), raise(deck.pbeaml), raise(s.pbcomp);
    raise(deck.prod), raise(deck.ptube), raise(deck.pshell), raise(deck.pcomp), raise(deck.pshear);
    raise(deck.psolid), raise(s.pbend), raise(s.pweld);
  }

  EvaluatedDeck evaluate() {
    Deck& d = *deck_;
    for (auto& e : d.beams)
      if (e.is_cbeam)
        move(e, TemperatureKind::Line, {e.ga, e.gb}, "CBEAM", d.pbeam, d.pbeaml, d.special.pbcomp);
      else
        move(e, TemperatureKind::Line, {e.ga, e.gb}, "CBAR", d.pbar, d.pbarl);
    for (auto& e : d.crod) move(e, TemperatureKind::Line, {e.ga, e.gb}, "CROD", d.prod);
    for (auto& e : d.ctube) move(e, TemperatureKind::Line, {e.ga, e.gb}, "CTUBE", d.ptube);
    for (auto& e : d.conrod) {
      if (tables_.count(e.mid) == 0) continue;
      if (const auto T = find_temperature(e, TemperatureKind::Line, {e.ga, e.gb}, "CONROD")) e.mid = place(e.mid, *T);
    }
    for (auto& e : d.special.cbend) move(e, TemperatureKind::Line, {e.ga, e.gb}, "CBEND", d.special.pbend);
    for (auto& e : d.shells)
      move(e, TemperatureKind::Plate, join(e.grids, e.midsides), e.card.c_str(), d.pshell, d.pcomp);
    for (auto& e : d.shear_panels)
      move(e, TemperatureKind::Plate, {e.grids.begin(), e.grids.end()}, "CSHEAR", d.pshear);
    for (auto& e : d.solids) move(e, TemperatureKind::Grids, join(e.corners, e.midsides), e.card.c_str(), d.psolid);
    for (auto& e : d.special.cweld)
      if (needs_temperature(e, d.special.pweld))
        move(e, TemperatureKind::Grids, list_weld_grids(e), "CWELD", d.special.pweld);
    if (num_missing_ > 1 && first_missing_)
      first_missing_->what += " (and " + std::to_string(num_missing_ - 1) + " elements more)";
    if (first_missing_) diagnostics_.add(*first_missing_);
    return {std::move(deck_), std::move(copies_)};
  }

 private:
  /// Reports a MATTi without its MATi: no element has it, unless the material is of another kind.
  void check_material(const records::MaterialTables& t) {
    const auto& d = source_;
    const auto has = [&](const auto& records) {
      return std::any_of(records.begin(), records.end(), [&](const auto& r) { return r.id == t.mid; });
    };
    const std::pair<const char*, bool> kinds[] = {
        {"MAT1", has(d.mat1)}, {"MAT2", has(d.mat2)}, {"MAT8", has(d.mat8)}, {"MAT9", has(d.mat9)}};
    std::string other;
    for (const auto& [name, is_found] : kinds) {
      if (is_found && t.material == name) return;
      if (is_found) other = name;
    }
    if (d.is_refused(t.mid, {t.material})) return;
    const std::string number = t.material.substr(3), id = std::to_string(t.mid);
    diagnostics_.add(
        {other.empty() ? Severity::Warning : Severity::Error, "fe.missing-material", source_.locate(t.at),
         "MATT" + number + " " + id + " refers to " + t.material + " " + id +
             (other.empty() ? ", which the deck does not define" : ", but material " + id + " is a " + other),
         other.empty() ? "add the " + t.material + " or correct the id"
                       : "write MATT" + other.substr(3) + " with its fields, or correct the id"});
  }

  template <class Properties>
  bool needs_temperature(const records::Cweld& weld, const Properties& properties) {
    const auto found = find_record(properties, weld.pid);
    return found && tables_.count(properties[*found].mid) > 0;
  }

  /// Grids of the two shells on which a weld ends; of ALIGN and GRIDID its own. Without a place on the shells none: the
  /// maker of the element reports it.
  std::vector<int> list_weld_grids(const records::Cweld& weld) {
    if (weld.format == "ALIGN") return {weld.ga, weld.gb};
    if (weld.format == "GRIDID") {
      auto grids = weld.grids_a;
      grids.insert(grids.end(), weld.grids_b.begin(), weld.grids_b.end());
      return grids;
    }
    if (!facets_) facets_ = std::make_unique<ShellFacets>(*deck_, nodes_);
    std::vector<int> grids;
    for (const auto& [id, own] : {std::pair(weld.ida, weld.ga), std::pair(weld.idb, weld.gb)}) {
      const int place = own > 0 ? own : weld.gs > 0 ? weld.gs : weld.ga;
      const int node = place > 0 ? nodes_.find_node(place) : -1;
      const auto* named = facets_->find_element(id);
      const Vector3d x = node >= 0 ? nodes_.node(node).x : weld.xs;
      FacetList patch;
      const FacetTree* of_property = weld.format == "PARTPAT" ? facets_->find_property(id) : nullptr;
      if (of_property)
        patch = of_property->facets();
      else if (named && weld.format != "PARTPAT")
        patch = weld.format == "ELPAT" ? facets_->list_around(*named) : FacetList{named};
      const auto at = of_property ? of_property->project(x) : project(patch, x);
      if (at)
        for (const int k : at->facet->nodes) grids.push_back(nodes_.node(k).id);
      else if (!patch.empty())
        for (const int k : patch.front()->nodes) grids.push_back(nodes_.node(k).id);
    }
    return grids;
  }

  static std::vector<int> join(std::vector<int> corners, const std::vector<int>& midsides) {
    std::copy_if(midsides.begin(), midsides.end(), std::back_inserter(corners), [](int g) { return g != 0; });
    return corners;
  }

  /// Index of the record of the deck with this id, the last one of an id; copies are not looked for.
  template <class Record>
  std::optional<std::size_t> find_record(const std::vector<Record>& records, int id) {
    const auto [index, is_new] = index_.try_emplace(&records);
    if (is_new)
      for (std::size_t i = 0; i < records.size(); ++i) index->second[records[i].id] = i;
    const auto found = index->second.find(id);
    return found == index->second.end() ? std::nullopt : std::optional(found->second);
  }

  /// Ids of materials in a property.
  template <class Property>
  static std::vector<int*> list_materials(Property& p) {
    if constexpr (requires { p.mid1; }) {
      return {&p.mid1, &p.mid2, &p.mid3, &p.mid4};
    } else if constexpr (requires { p.plies; }) {
      std::vector<int*> ids;
      for (auto& ply : p.plies) ids.push_back(&ply.mid);
      return ids;
    } else if constexpr (requires { p.lumps; }) {
      std::vector<int*> ids{&p.mid};
      for (auto& lump : p.lumps) ids.push_back(&lump.mid);
      return ids;
    } else {
      return {&p.mid};
    }
  }

  template <class ElementRecord, class... Properties>
  void move(ElementRecord& element, TemperatureKind kind, const std::vector<int>& grids, const char* card,
            Properties&... properties) {
    (move_in(element, kind, grids, card, properties) || ...);
  }

  /// Gives the element the copy of its property at its temperature, if the property is one of these; false: it is not.
  template <class ElementRecord, class Property>
  bool move_in(ElementRecord& element, TemperatureKind kind, const std::vector<int>& grids, const char* card,
               std::vector<Property>& properties) {
    const auto found = find_record(properties, element.pid);
    if (!found) return false;
    const auto ids = list_materials(properties[*found]);
    if (std::none_of(ids.begin(), ids.end(), [&](const int* id) { return tables_.count(*id) > 0; })) return true;
    const auto T = find_temperature(element, kind, grids, card);
    if (!T) return true;
    const auto [copy, is_new] = properties_.try_emplace({&properties, element.pid, *T}, 0);
    if (is_new) {
      copy->second = ++next_;
      Property property = properties[*found];
      property.id = copy->second;
      for (int* id : list_materials(property)) *id = place(*id, *T);
      deck_->temperatures.properties[property.id] = element.pid;
      copies_[property.id] = {element.pid, *T};
      properties.push_back(std::move(property));
    }
    element.pid = copy->second;
    return true;
  }

  template <class ElementRecord>
  std::optional<double> find_temperature(const ElementRecord& element, TemperatureKind kind,
                                         const std::vector<int>& grids, const char* card) {
    int missing = 0;
    const auto T = grids.empty() ? std::nullopt : temperatures_.find(element.id, kind, grids, missing);
    if (T) return T->node.mean();
    if (num_missing_++ == 0)
      first_missing_ = Diagnostic{
          Severity::Error, "fe.missing-temperature", source_.locate(element.at),
          std::string(card) + " " + std::to_string(element.id) + " has no temperature in set " + std::to_string(set_) +
              ", at which its material is evaluated: none is given for grid " + std::to_string(missing),
          "add TEMP for the grid, or TEMPD for all grids that have none"};
    return std::nullopt;
  }

  /// Id of the material at a temperature: its own without tables.
  int place(int mid, double T) {
    const auto tables = tables_.find(mid);
    if (tables == tables_.end()) return mid;
    const auto [copy, is_new] = materials_.try_emplace({mid, T}, mid);
    if (!is_new) return copy->second;
    copy->second = ++next_;
    const auto& name = tables->second->material;
    bool is_found = false;
    if (name == "MAT1") is_found = add_mat1(*tables->second, copy->second, T);
    if (name == "MAT2") is_found = add_mat2(*tables->second, copy->second, T);
    if (name == "MAT8") is_found = add_mat8(*tables->second, copy->second, T);
    if (name == "MAT9") is_found = add_mat9(*tables->second, copy->second, T);
    if (is_found)
      copies_[copy->second] = {mid, T};
    else
      copy->second = mid;  // check_material() has reported it
    return copy->second;
  }

  template <class Material>
  Material* copy_material(std::vector<Material>& materials, int mid, int new_id) {
    const auto found = find_record(materials, mid);
    if (!found) return nullptr;
    Material material = materials[*found];
    material.id = new_id;
    materials.push_back(std::move(material));
    return &materials.back();
  }

  /// Values of the tables in the order of the fields after the id; those without a table keep theirs.
  void replace(const records::MaterialTables& tables, double T, const std::vector<std::pair<int, double*>>& fields) {
    for (const auto& [field, value] : fields) {
      const auto i = static_cast<std::size_t>(field - 1);
      const int id = i < tables.tables.size() ? tables.tables[i] : 0;
      if (id == 0) continue;
      const auto curve = curves_.find(id);
      if (curve == curves_.end()) {
        if (reported_.insert({tables.mid, id}).second)
          diagnostics_.error("fe.missing-material-table", source_.locate(tables.at),
                             "MATT" + tables.material.substr(3) + " " + std::to_string(tables.mid) + " names table " +
                                 std::to_string(id) + ", which no TABLEMi card of the deck defines",
                             "add the table or correct the id");
        continue;
      }
      const double y = records::evaluate(*curve->second, T);
      *value = curve->second->kind == 1 ? y : *value * y;  // TABLEM2 to TABLEM4 multiply the field
    }
  }

  static bool has_table(const records::MaterialTables& tables, int field) {
    return static_cast<std::size_t>(field) <= tables.tables.size() &&
           tables.tables[static_cast<std::size_t>(field - 1)] != 0;
  }

  bool add_mat1(const records::MaterialTables& t, int id, double T) {
    auto* m = copy_material(deck_->mat1, t.mid, id);
    if (m == nullptr) return false;
    replace(t, T,
            {{1, &m->E},
             {2, &m->G},
             {3, &m->nu},
             {4, &m->rho},
             {5, &m->alpha},
             {7, &m->ge},
             {8, &m->st},
             {9, &m->sc},
             {10, &m->ss}});
    // The field that was blank on MAT1 follows the others.
    if (m->filled == 'G' && !has_table(t, 2)) m->G = m->E / (2 * (1 + m->nu));
    if (m->filled == 'E' && !has_table(t, 1)) m->E = 2 * (1 + m->nu) * m->G;
    if (m->filled == 'N' && !has_table(t, 3)) m->nu = m->G > 0 ? m->E / (2 * m->G) - 1 : 0.0;
    return true;
  }

  bool add_mat2(const records::MaterialTables& t, int id, double T) {
    auto* m = copy_material(deck_->mat2, t.mid, id);
    if (m == nullptr) return false;
    std::vector<std::pair<int, double*>> fields{{7, &m->rho}, {12, &m->ge}};
    for (int i = 0, field = 1; i < 3; ++i)
      for (int j = i; j < 3; ++j) fields.emplace_back(field++, &m->G(i, j));
    for (int i = 0; i < 3; ++i) fields.emplace_back(8 + i, &m->alpha[i]);
    replace(t, T, fields);
    m->G.triangularView<Eigen::StrictlyLower>() = m->G.transpose();
    return true;
  }

  bool add_mat8(const records::MaterialTables& t, int id, double T) {
    auto* m = copy_material(deck_->mat8, t.mid, id);
    if (m == nullptr) return false;
    auto& s = m->strength;
    replace(t, T,
            {{1, &m->E1},
             {2, &m->E2},
             {3, &m->nu12},
             {4, &m->G12},
             {5, &m->G1z},
             {6, &m->G2z},
             {7, &m->rho},
             {8, &m->a1},
             {9, &m->a2},
             {11, &s.Xt},
             {12, &s.Xc},
             {13, &s.Yt},
             {14, &s.Yc},
             {15, &s.S},
             {16, &m->ge},
             {17, &s.F12}});
    return true;
  }

  bool add_mat9(const records::MaterialTables& t, int id, double T) {
    auto* m = copy_material(deck_->mat9, t.mid, id);
    if (m == nullptr) return false;
    std::vector<std::pair<int, double*>> fields{{22, &m->rho}, {30, &m->ge}};
    for (int i = 0, field = 1; i < 6; ++i)
      for (int j = i; j < 6; ++j) fields.emplace_back(field++, &m->G(i, j));
    for (int i = 0; i < 6; ++i) fields.emplace_back(23 + i, &m->alpha[i]);
    replace(t, T, fields);
    m->G.triangularView<Eigen::StrictlyLower>() = m->G.transpose();
    return true;
  }

  const Deck& source_;
  std::unique_ptr<Deck> deck_;
  const NodeTable& nodes_;
  std::unique_ptr<ShellFacets> facets_;
  const TemperatureSet temperatures_;
  int set_ = 0, next_ = 0;
  Diagnostics& diagnostics_;
  std::unordered_map<int, const records::MaterialTables*> tables_;  ///< by material
  std::unordered_map<int, const records::FunctionTable*> curves_;
  std::map<const void*, std::unordered_map<int, std::size_t>> index_;  ///< by list of records: id, index
  std::map<std::tuple<const void*, int, double>, int> properties_;     ///< by list, id and temperature
  std::map<std::pair<int, double>, int> materials_;
  std::map<int, std::pair<int, double>> copies_;
  std::set<std::pair<int, int>> reported_;
  std::optional<Diagnostic> first_missing_;
  int num_missing_ = 0;
};

}  // namespace

std::string EvaluatedDeck::name_originals(const std::string& text) const {
  constexpr std::string_view kDigits = "0123456789";
  constexpr std::string_view kNames[] = {"MAT", "MID", "P", "material", "property"};
  std::string named;
  std::size_t done = 0;
  for (auto first = text.find_first_of(kDigits); first != std::string::npos;) {
    const auto last = std::min(text.find_first_not_of(kDigits, first), text.size());
    const auto before = first >= 2 && text[first - 1] == ' ' ? text.rfind(' ', first - 2) + 1 : first;
    const auto name = std::string_view(text).substr(before, first - before);
    int id = 0;
    std::from_chars(text.data() + first, text.data() + last, id);
    const auto copy = copies.find(id);
    if (copy != copies.end() &&
        std::any_of(std::begin(kNames), std::end(kNames), [&](auto start) { return name.starts_with(start); })) {
      named.append(text, done, first - done);
      named += std::to_string(copy->second.first) + " at temperature " + show_number(copy->second.second);
      done = last;
    }
    first = text.find_first_of(kDigits, last);
  }
  return named.append(text, done);
}

EvaluatedDeck evaluate_materials(const Deck& deck, const records::Subcase& subcase, const NodeTable& nodes,
                                 Diagnostics& diagnostics) {
  const auto& tables = deck.temperatures.materials;
  if (tables.empty()) return {};
  const bool by_initial = subcase.material_temperature == 0;
  const int set = by_initial ? subcase.initial_temperature : subcase.material_temperature;
  if (set == 0) {
    diagnostics.warning("fe.material-tables-unused", deck.locate(tables.front().at),
                        "MATT" + tables.front().material.substr(3) + " " + std::to_string(tables.front().mid) +
                            " has no effect: no temperature is selected at which materials are evaluated",
                        "write TEMPERATURE(MATERIAL) = n in the case control");
    return {};
  }
  if (TemperatureSet(deck.temperatures, set).is_empty()) {
    const char* command = by_initial ? "TEMPERATURE(INITIAL)" : "TEMPERATURE(MATERIAL)";
    diagnostics.error("fe.missing-load", deck.locate(subcase.find_command(command)),
                      "temperature set " + std::to_string(set) + " has no TEMP, TEMPD, TEMPRB or TEMPP1 card",
                      std::string("correct ") + command + " or add its cards");
    return {};
  }
  return Evaluator(deck, set, nodes, diagnostics).evaluate();
}

}  // namespace bough::fe
