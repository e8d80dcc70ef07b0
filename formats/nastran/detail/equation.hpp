#pragma once
/// \file Equations of DEQATN: F(A, B) = expression; NAME = expression; ...
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/nastran/detail/card.hpp"

namespace bough::nastran::detail {

/// Value of an equation, or the reason that it has none.
struct EquationValue {
  double value = 0;
  std::string error;  ///< empty: `value` holds
};

/// EQID of a DEQATN, whatever its format.
std::optional<int> find_equation_id(const CardText& text);

/// The equation of a card: columns 17 to 72 of its first line, 9 to 72 of the others; all text after the id between
/// commas. Upper case, without blanks.
std::string join_equation(const CardText& text);

/// Evaluates the last assignment of an equation, for `values` of the arguments of its first one. Arithmetic of FORTRAN:
/// + - * / **, of integers where both operands are written as integers (1/2 is 0), angles in radians.
/// Source: MSC Nastran Quick Reference Guide, DEQATN.
EquationValue evaluate_equation(std::string_view equation, const std::vector<double>& values);

}  // namespace bough::nastran::detail
