#include "modal/response/frequency_tables.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <string>

#include "fe/elements/spring_rows.hpp"
#include "modal/response/function_table.hpp"

namespace bough::modal::response {
namespace {

using Eigen::VectorXcd;
using Complex = std::complex<double>;

struct Values {
  std::array<double, 6> k{}, b{}, ge{};
};

/// Property of each element with one, by card family and id: CELAS, CDAMP, CBUSH.
std::map<std::pair<std::string, int>, int> list_properties(const records::Deck& deck) {
  std::map<std::pair<std::string, int>, int> properties;
  for (const auto& e : deck.springs)
    if (e.pid > 0) properties[{"CELAS", e.id}] = e.pid;
  for (const auto& e : deck.dampers)
    if (e.pid > 0) properties[{"CDAMP", e.id}] = e.pid;
  for (const auto& e : deck.cbush) properties[{"CBUSH", e.id}] = e.pid;
  return properties;
}

template <class Records>
auto find_record(const Records& records, int id) {
  return std::find_if(records.begin(), records.end(), [id](const auto& r) { return r.id == id; });
}

/// Reports cards of which the deck has no property.
void report_without_property(const records::Deck& deck, const std::vector<records::FrequencyTables>& all,
                             Diagnostics& diagnostics) {
  for (const auto& tables : all) {
    const bool is_found = tables.property == "PELAS"   ? find_record(deck.pelas, tables.pid) != deck.pelas.end()
                          : tables.property == "PDAMP" ? find_record(deck.pdamp, tables.pid) != deck.pdamp.end()
                                                       : find_record(deck.pbush, tables.pid) != deck.pbush.end();
    if (is_found) continue;
    const auto id = " " + std::to_string(tables.pid);
    diagnostics.warning(
        "modal.table-without-property", deck.locate(tables.at),
        tables.property + "T" + id + " gives tables for " + tables.property + id + ", which the deck does not define",
        "add the " + tables.property + " card, or correct the id");
  }
}

Values find_values(const records::Deck& deck, const records::FrequencyTables& tables) {
  Values v;
  if (tables.property == "PELAS") {
    if (const auto p = find_record(deck.pelas, tables.pid); p != deck.pelas.end()) v.k[0] = p->k, v.ge[0] = p->ge;
  } else if (tables.property == "PDAMP") {
    if (const auto p = find_record(deck.pdamp, tables.pid); p != deck.pdamp.end()) v.b[0] = p->b;
  } else if (const auto p = find_record(deck.pbush, tables.pid); p != deck.pbush.end()) {
    v.k = p->k, v.b = p->b, v.ge = p->ge;
  }
  return v;
}

double look_up(const records::DynamicTable* table, double value, double x) {
  return table != nullptr ? evaluate(*table, x) : value;
}

}  // namespace

void report_part_tables(const records::DynamicDeck& deck, Diagnostics& diagnostics) {
  for (const auto& section : deck.super.sections)
    for (const char* card : {"PELAST", "PDAMPT", "PBUSHT"})
      if (section.deck->card_counts.count(card) > 0)
        diagnostics.error("modal.part-tables", deck.locate(section.at),
                          std::string(card) + " of superelement " + std::to_string(section.id) +
                              " cannot act: the section is condensed once, with the values of the properties",
                          "move the elements with tables and their properties into the main bulk data");
}

FrequencyTables::FrequencyTables(const fe::Model& model, const records::DynamicDeck& deck, double g,
                                 Diagnostics& diagnostics)
    : g_(g), directions_(model.num_gdofs(), 0) {
  const auto& all = deck.dynamics.frequency_tables;
  if (all.empty()) return;
  report_without_property(deck, all, diagnostics);
  const auto properties = list_properties(deck);
  std::vector<Eigen::Triplet<double>> terms;
  const auto find = [&](const records::FrequencyTables& card, int id) -> const records::DynamicTable* {
    if (id == 0) return nullptr;
    const auto* table = find_table(deck, id);
    if (table == nullptr)
      diagnostics.error("modal.missing-table", deck.locate(card.at),
                        card.property + "T " + std::to_string(card.pid) + " names table " + std::to_string(id) +
                            ", which no TABLEDi card of the deck defines",
                        "add the table or correct the id");
    return table;
  };
  for (const auto& element : model.elements()) {
    const auto* rows = dynamic_cast<const fe::SpringRows*>(element.get());
    const auto property = properties.find({element->card().substr(0, 5), element->id()});
    if (rows == nullptr || property == properties.end()) continue;
    const std::string name = "P" + element->card().substr(1, 4);
    const auto tables = std::find_if(all.begin(), all.end(),
                                     [&](const auto& t) { return t.property == name && t.pid == property->second; });
    if (tables == all.end()) continue;
    const auto values = find_values(deck, *tables);
    const Eigen::MatrixXd S = rows->calc_spring_rows();
    for (Eigen::Index c = 0; c < S.rows(); ++c) {
      const auto i = static_cast<std::size_t>(c);
      if (tables->k[i] == 0 && tables->b[i] == 0 && tables->ge[i] == 0) continue;
      const int column = static_cast<int>(springs_.size());
      springs_.push_back({element.get(), static_cast<int>(c), values.k[i], values.b[i], values.ge[i],
                          find(*tables, tables->k[i]), find(*tables, tables->b[i]), find(*tables, tables->ge[i])});
      for (Eigen::Index j = 0; j < S.cols(); ++j)
        if (S(c, j) != 0) terms.emplace_back(element->gdofs()[static_cast<std::size_t>(j)], column, S(c, j));
    }
  }
  directions_.resize(model.num_gdofs(), static_cast<Eigen::Index>(springs_.size()));
  directions_.setFromTriplets(terms.begin(), terms.end());
}

Complex FrequencyTables::calc_static(const Spring& s, double x) const {
  const double k = look_up(s.k_table, s.k, x), ge = look_up(s.ge_table, s.ge, x);
  return Complex(1, g_) * (k - s.k) + Complex(0, ge * k - s.ge * s.k);
}

double FrequencyTables::calc_damping(const Spring& s, double x) { return look_up(s.b_table, s.b, x) - s.b; }

VectorXcd FrequencyTables::calc_stiffness(double hz) const {
  VectorXcd Z(static_cast<Eigen::Index>(springs_.size()));
  for (std::size_t i = 0; i < springs_.size(); ++i)
    Z(static_cast<Eigen::Index>(i)) =
        calc_static(springs_[i], hz) + Complex(0, 2 * std::numbers::pi * hz) * calc_damping(springs_[i], hz);
  return Z;
}

linear::ComplexSparse FrequencyTables::sum(const VectorXcd& factors) const {
  const linear::ComplexSparse V = directions_.cast<Complex>();
  return linear::ComplexSparse(V * factors.asDiagonal()) * linear::ComplexSparse(V.transpose());
}

linear::ComplexSparse FrequencyTables::calc_matrix(double hz) const { return sum(calc_stiffness(hz)); }

linear::ComplexSparse FrequencyTables::calc_stiffness_matrix(double x) const {
  VectorXcd K(static_cast<Eigen::Index>(springs_.size()));
  for (std::size_t i = 0; i < springs_.size(); ++i) K(static_cast<Eigen::Index>(i)) = calc_static(springs_[i], x);
  return sum(K);
}

linear::ComplexSparse FrequencyTables::calc_damping_matrix(double x) const {
  VectorXcd B(static_cast<Eigen::Index>(springs_.size()));
  for (std::size_t i = 0; i < springs_.size(); ++i) B(static_cast<Eigen::Index>(i)) = calc_damping(springs_[i], x);
  return sum(B);
}

Eigen::VectorXd FrequencyTables::calc_force_change(const fe::Element& element, double hz) const {
  const auto* rows = dynamic_cast<const fe::SpringRows*>(&element);
  if (rows == nullptr) return {};
  Eigen::VectorXd change;
  for (const auto& s : springs_) {
    if (s.element != &element || s.k_table == nullptr) continue;
    if (change.size() == 0) change = Eigen::VectorXd::Zero(rows->calc_spring_rows().rows());
    change(s.row) = look_up(s.k_table, s.k, hz) - s.k;
  }
  return change;
}

}  // namespace bough::modal::response
