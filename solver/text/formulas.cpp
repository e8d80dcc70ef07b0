#include "solver/text/formulas.hpp"

#include <muParser.h>

#include <algorithm>
#include <numbers>

namespace bough::solver {
namespace {
double calc_step(double x) { return x >= 0 ? 1 : 0; }
}  // namespace

struct Formulas::Parsers {
  std::vector<mu::Parser> all;
};

Formulas::Formulas(Names names) : names_(std::move(names)), parsers_(std::make_unique<Parsers>()) {
  int last = -1;
  for (const auto& [name, index] : names_) last = std::max(last, index);
  variables_.assign(static_cast<size_t>(last + 1), 0.0);
}

Formulas::Formulas(const Formulas& other) : Formulas(other.names_) {
  for (const auto& text : other.texts_) add(text);
  variables_ = other.variables_;
}

Formulas::~Formulas() = default;

std::string Formulas::add(const std::string& text) {
  try {
    mu::Parser parser;
    for (const auto& [name, index] : names_) parser.DefineVar(name, &variables_[static_cast<size_t>(index)]);
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineFun("step", &calc_step);
    parser.SetExpr(text);
    parser.Eval();
    parsers_->all.push_back(std::move(parser));
    texts_.push_back(text);
    return {};
  } catch (const mu::Parser::exception_type& error) {
    return error.GetMsg();
  }
}

int Formulas::size() const { return static_cast<int>(texts_.size()); }

bool Formulas::uses(const std::string& name) const {
  return std::any_of(parsers_->all.begin(), parsers_->all.end(),
                     [&](const mu::Parser& parser) { return parser.GetUsedVar().count(name) > 0; });
}

double Formulas::calc(int i) const { return parsers_->all[static_cast<size_t>(i)].Eval(); }

}  // namespace bough::solver
