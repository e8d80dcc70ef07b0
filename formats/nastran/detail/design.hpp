#pragma once
/// \file Design variables of SOL 200: the values that they give to properties at the start.
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "formats/nastran/detail/card.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::nastran::detail {

/// DESVAR, DLINK and the linear relations DVPREL1, DVMREL1, DVCREL1 give a field of a card the value C0 + sum of
/// COEF times XINIT; DVPREL2, DVMREL2, DVCREL2 the value of an equation (DEQATN) of variables and constants (DTABLE).
/// Nastran computes with it, not with the value of the card (SOL 200 only).
class Design {
 public:
  /// True for the cards that add() takes.
  static bool is_design(std::string_view name);
  /// Returns true for DEQATN and DTABLE, which add() takes too.
  static bool is_of_equations(std::string_view name);
  /// Returns true if relations use the cards of this name, DEQATN or DTABLE. After finish().
  bool uses(std::string_view name) const { return is_active_ && is_of_equations(name) && has_equations_; }
  /// Counts a card of design optimization, and reads it if it is one of those above; reports the errors of its fields.
  void add(const CardText& text, const std::vector<std::string>& files, Diagnostics& diagnostics);
  /// Returns true if the deck has no such card.
  bool is_empty() const { return num_cards_.empty(); }
  /// Values in place of XINIT, by id of the variable; before add().
  void set_values(const std::map<int, double>& values) { given_ = values; }
  /// Independent DESVAR that relations use, directly or by DLINK; empty if they give no values. After finish().
  std::vector<records::DesignVariable> list_variables() const;

  /// Sums up the variables; without `is_active` (another SOL) no value is given.
  void finish(bool is_active, const std::string& sol, const records::Deck& deck, Diagnostics& diagnostics);
  /// Writes the values over the fields of a card.
  void apply(CardText& text);
  /// Reports the changed fields with their values, and names that were not found.
  void report(const records::Deck& deck, Diagnostics& diagnostics) const;

 private:
  struct Relation {
    std::string card;  ///< DVPREL1 ...
    int id = 0;        ///< of the relation
    std::string type;  ///< PSHELL ...
    int target = 0;    ///< PID, MID, EID
    std::string name;  ///< T, or a field number
    double c0 = 0;
    std::vector<std::pair<int, double>> terms;  ///< (variable, coefficient)
    int equation = 0;                           ///< DEQATN of DVPREL2 ...; 0: linear
    std::vector<int> variables;                 ///< first arguments of the equation
    std::vector<std::string> constants;         ///< its others, labels of DTABLE
    int by_value = 0;                           ///< variable that multiplies the property's own value (PVAL)
    records::CardLocation at;
    bool is_done = false;
    bool is_wrong = false;  ///< its equation has no value
    std::string done;
  };
  struct Link {
    int variable = 0;
    double c0 = 0, scale = 1;
    std::vector<std::pair<int, double>> terms;
  };
  struct Equation {
    std::string text;
    records::CardLocation at;
  };
  /// Returns a relation with its card, id, type, target and name.
  static Relation read_head(Card& card, const CardText& text);
  void read_equation_relation(Card& card, const CardText& text);
  void read_constants(Card& card);
  void evaluate(Relation& relation, const records::Deck& deck, Diagnostics& diagnostics) const;
  double find_value(int variable, const Relation& relation, const records::Deck& deck, Diagnostics& diagnostics) const;

  std::map<int, double> variables_, given_;
  std::vector<records::DesignVariable> declared_;
  std::vector<Link> links_;
  std::vector<Relation> relations_;
  std::map<int, Equation> equations_;
  std::map<std::string, double, std::less<>> constants_;
  bool has_equations_ = false;
  std::multimap<std::pair<std::string, int>, std::size_t> by_target_;
  std::map<std::string, int> num_cards_;
  std::map<std::string, records::CardLocation> first_;
  std::deque<std::string> storage_;  ///< the values as text; never moved
  bool is_active_ = false;
};

}  // namespace bough::nastran::detail
