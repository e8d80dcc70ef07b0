#pragma once
/// \file Formulas of named variables, by muParser.
#include <memory>
#include <string>
#include <vector>

namespace bough::solver {

/// Formulas of the same variables. A parser reads its variables where they are and evaluates in place: one object for
/// each thread. A copy has the same formulas and separate variables.
class Formulas {
 public:
  /// Name of a variable and its index; a variable may have several names.
  using Names = std::vector<std::pair<std::string, int>>;

  explicit Formulas(Names names);
  Formulas(const Formulas& other);
  Formulas& operator=(const Formulas&) = delete;
  ~Formulas();

  /// Adds a formula of the variables, of pi and of step(x). Returns what is wrong with it; empty: nothing.
  std::string add(const std::string& text);
  /// Number of formulas.
  int size() const;
  /// Returns true if a formula reads the variable `name`.
  bool uses(const std::string& name) const;
  /// Value of a variable, to set before an evaluation.
  double& operator[](int variable) { return variables_[static_cast<size_t>(variable)]; }
  /// Formula i at the variables.
  double calc(int i) const;

 private:
  struct Parsers;
  Names names_;
  std::vector<std::string> texts_;
  std::vector<double> variables_;
  std::unique_ptr<Parsers> parsers_;
};

}  // namespace bough::solver
