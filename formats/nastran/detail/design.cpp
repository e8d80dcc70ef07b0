#include "formats/nastran/detail/design.hpp"

#include <algorithm>
#include <set>

#include "formats/nastran/detail/card_text.hpp"
#include "formats/nastran/detail/design_fields.hpp"
#include "formats/nastran/detail/equation.hpp"
#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

constexpr std::size_t most_shown = 10;

std::vector<std::pair<int, double>> read_terms(Card& card, int first) {
  std::vector<std::pair<int, double>> terms;
  for (int i = first; i < card.get_size(); i += 2)
    if (!card.is_blank(i, i + 2)) {
      const int variable = card.read_id(i, "DVIDi");
      terms.emplace_back(variable, card.read_real(i + 1, "COEFi", 1.0));
    }
  return terms;
}

}  // namespace

bool Design::is_design(std::string_view name) {
  return name == "DESVAR" || name == "DLINK" || name == "DVPREL1" || name == "DVMREL1" || name == "DVCREL1" ||
         name == "DVPREL2" || name == "DVMREL2" || name == "DVCREL2";
}

bool Design::is_of_equations(std::string_view name) { return name == "DEQATN" || name == "DTABLE"; }

/// LABL1 VALU1 LABL2 VALU2 ...
void Design::read_constants(Card& card) {
  for (int i = 0; i < card.get_size(); i += 2)
    if (!card.is_blank(i, i + 2)) {
      auto label = std::string(card.get_upper(i));
      // An integer names a table, which equations of properties do not have.
      if (const auto value = parse_real(card.get(i + 1)); value && !parse_int(card.get(i + 1)))
        constants_[std::move(label)] = *value;
    }
}

Design::Relation Design::read_head(Card& card, const CardText& text) {
  Relation relation;
  relation.card = text.name;
  relation.id = card.read_id(0, "ID");
  relation.type = card.get_upper(1);
  relation.target = card.read_id(2, "PID MID EID");
  relation.name = card.get_upper(3);
  return relation;
}

/// ID TYPE PID NAME PMIN PMAX EQID, then DESVAR and the ids of variables, DTABLE and the labels of constants.
void Design::read_equation_relation(Card& card, const CardText& text) {
  Relation relation = read_head(card, text);
  relation.equation = card.read_id(6, "EQID");
  std::string kind;
  for (int i = 8; i < card.get_size(); ++i) {
    if (card.is_blank(i)) continue;
    if (i % 8 == 0)
      kind = card.get_upper(i);
    else if (kind == "DESVAR")
      relation.variables.push_back(card.read_id(i, "DVIDi"));
    else if (kind == "DTABLE")
      relation.constants.emplace_back(card.get_upper(i));
    else
      card.fail("deck.bad-word", i, "'" + kind + "' begins the line, expected DESVAR or DTABLE", "correct the word");
  }
  relation.at = card.get_location();
  if (card.is_ok()) relations_.push_back(std::move(relation));
}

void Design::add(const CardText& text, const std::vector<std::string>& files, Diagnostics& diagnostics) {
  Card card(text, files, diagnostics);
  if (text.name == "DTABLE") return read_constants(card);
  if (text.name == "DEQATN") {
    const auto id = find_equation_id(text);
    if (id) equations_.insert_or_assign(*id, Equation{join_equation(text), card.get_location()});
    return;
  }
  if (num_cards_[text.name]++ == 0) first_[text.name] = card.get_location();
  if (text.name == "DESVAR") {
    const int id = card.read_id(0, "ID");
    const double initial = card.read_real(2, "XINIT");
    const auto given = given_.find(id);
    variables_[id] = given == given_.end() ? initial : given->second;
    declared_.push_back({id, std::string(card.get_upper(1)), variables_[id], card.get_location()});
  } else if (text.name == "DLINK") {
    Link link;
    link.variable = card.read_id(1, "DDVID");
    link.c0 = card.read_real(2, "C0", 0.0);
    link.scale = card.read_real(3, "CMULT", 1.0);
    link.terms = read_terms(card, 4);
    links_.push_back(std::move(link));
  } else if (text.name.back() == '1') {
    Relation relation = read_head(card, text);
    relation.c0 = card.read_real(6, "C0", 0.0);
    if (card.is_word(9, "PVAL"))
      relation.by_value = card.read_id(8, "DVID1");
    else
      relation.terms = read_terms(card, 8);
    relation.at = card.get_location();
    if (card.is_ok()) relations_.push_back(std::move(relation));
  } else {
    read_equation_relation(card, text);
  }
}

/// Replaces the equation of a relation by its value.
void Design::evaluate(Relation& relation, const records::Deck& deck, Diagnostics& diagnostics) const {
  const auto fail = [&](const std::string& what) {
    relation.is_wrong = true;
    diagnostics.error("deck.design-equation", deck.locate(relation.at),
                      relation.card + " " + std::to_string(relation.id) + ": " + what,
                      "correct it, or --ignore " + relation.card + " to keep the value of the card");
  };
  const auto found = equations_.find(relation.equation);
  if (found == equations_.end()) return fail("the deck has no DEQATN " + std::to_string(relation.equation));
  std::vector<double> values;
  for (const int variable : relation.variables) values.push_back(find_value(variable, relation, deck, diagnostics));
  for (const auto& label : relation.constants) {
    const auto constant = constants_.find(label);
    if (constant == constants_.end()) return fail("no DTABLE has the constant " + label);
    values.push_back(constant->second);
  }
  const auto result = evaluate_equation(found->second.text, values);
  if (!result.error.empty())
    return fail("DEQATN " + std::to_string(relation.equation) + " has no value: " + result.error);
  relation.c0 = result.value;
}

void Design::finish(bool is_active, const std::string& sol, const records::Deck& deck, Diagnostics& diagnostics) {
  is_active_ = is_active;
  if (is_empty()) return;
  if (!is_active) {
    const auto& [name, at] = *first_.begin();
    diagnostics.note("deck.design-values", deck.locate(at),
                     "design variables give no values: SOL is " + (sol.empty() ? std::string("not given") : sol) +
                         ", and only SOL 200 takes them",
                     "the properties are those of their cards");
    return;
  }
  for (const auto& link : links_) {
    double x = link.c0;
    for (const auto& [variable, c] : link.terms)
      if (const auto found = variables_.find(variable); found != variables_.end()) x += link.scale * c * found->second;
    variables_[link.variable] = x;
  }
  for (std::size_t i = 0; i < relations_.size(); ++i)
    by_target_.emplace(std::pair(relations_[i].type, relations_[i].target), i);
  for (auto& relation : relations_) {
    has_equations_ = has_equations_ || relation.equation > 0;
    if (relation.equation > 0) evaluate(relation, deck, diagnostics);
    for (auto& [variable, coefficient] : relation.terms)
      relation.c0 += coefficient * find_value(variable, relation, deck, diagnostics);
    if (relation.by_value > 0) find_value(relation.by_value, relation, deck, diagnostics);
  }
}

double Design::find_value(int variable, const Relation& relation, const records::Deck& deck,
                          Diagnostics& diagnostics) const {
  const auto found = variables_.find(variable);
  if (found != variables_.end()) return found->second;
  diagnostics.error("deck.design-relation", deck.locate(relation.at),
                    relation.card + " " + std::to_string(relation.id) + " names DESVAR " + std::to_string(variable) +
                        ", which the deck does not define",
                    "add the DESVAR or correct the id");
  return 0;
}

std::vector<records::DesignVariable> Design::list_variables() const {
  std::set<int> used;
  for (const auto& relation : relations_) {
    for (const auto& [variable, coefficient] : relation.terms) used.insert(variable);
    if (relation.by_value > 0) used.insert(relation.by_value);
    used.insert(relation.variables.begin(), relation.variables.end());
  }
  for (auto link = links_.rbegin(); link != links_.rend(); ++link)
    if (used.count(link->variable) > 0)
      for (const auto& [variable, coefficient] : link->terms) used.insert(variable);
  std::vector<records::DesignVariable> variables;
  for (const auto& link : links_) used.erase(link.variable);
  for (const auto& one : declared_)
    if (is_active_ && used.count(one.id) > 0) variables.push_back(one);
  std::sort(variables.begin(), variables.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return variables;
}

void Design::apply(CardText& text) {
  if (!is_active_ || by_target_.empty() || text.fields.empty()) return;
  for (std::size_t first = 0; first < 8; first += 2) {
    const auto id = parse_int(text.fields[first]);
    if (!id || find_entry(text, *id) != static_cast<int>(first)) continue;
    const auto [begin, end] = by_target_.equal_range({text.name, *id});
    for (auto entry = begin; entry != end; ++entry) {
      auto& relation = relations_[entry->second];
      if (relation.is_wrong) continue;
      const int i = find_design_field(text, relation.name, static_cast<int>(first));
      if (i < 0) continue;
      if (static_cast<std::size_t>(i) >= text.fields.size())
        text.fields.resize((static_cast<std::size_t>(i) / 8 + 1) * 8);
      auto& field = text.fields[static_cast<std::size_t>(i)];
      const std::string before(field.empty() ? "blank" : field);
      double value = relation.c0;
      if (relation.by_value > 0) {
        const auto found = variables_.find(relation.by_value);
        value += (found == variables_.end() ? 0.0 : found->second) * parse_real(field).value_or(0.0);
      }
      storage_.push_back(format_exact_real(value));
      field = storage_.back();
      relation.is_done = true;
      relation.done = relation.type + " " + std::to_string(relation.target) + " " + relation.name + " = " +
                      storage_.back() + " (was " + before + ")";
    }
  }
}

void Design::report(const records::Deck& deck, Diagnostics& diagnostics) const {
  if (!is_active_ || is_empty()) return;
  std::string done;
  std::size_t count = 0;
  for (const auto& relation : relations_) {
    if (relation.is_wrong) continue;
    if (!relation.is_done)
      diagnostics.warning("deck.design-relation", deck.locate(relation.at),
                          relation.card + " " + std::to_string(relation.id) + " gives no value: " + relation.type +
                              " " + std::to_string(relation.target) + " '" + relation.name + "' is not found",
                          "the property stays that of its card; write the number of the field for its name");
    else if (count++ < most_shown)
      done += (done.empty() ? "" : ", ") + relation.done;
  }
  if (count > most_shown) done += " and " + std::to_string(count - most_shown) + " more";
  if (count > 0)
    diagnostics.note("deck.design-values", deck.locate(relations_.front().at),
                     "design variables give, as in SOL 200 at the start: " + done);
}

}  // namespace bough::nastran::detail
