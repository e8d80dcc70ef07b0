// Formulas of the inputs u1, u2, ... and the time t, by muParser.
#include <muParser.h>

#include <cmath>

#include "solver/control/makers.hpp"

namespace bough::solver {
namespace {

/// A parser reads its variables where they are; BlockInput is copied there.
class Expression final : public Block {
 public:
  std::vector<mu::Parser> parsers;
  std::unique_ptr<double[]> variables;  // u1..., t
  bool uses_time = false;

  bool depends_on_time() const override { return uses_time && sizes.sample_time == 0; }

  void calc_outputs(const BlockInput& in, double* y) const override {
    for (int i = 0; i < sizes.inputs; ++i) variables[static_cast<size_t>(i)] = in.u[i];
    variables[static_cast<size_t>(sizes.inputs)] = in.t;
    for (size_t i = 0; i < parsers.size(); ++i) y[i] = parsers[i].Eval();
  }
};

double calc_step(double x) { return x >= 0 ? 1 : 0; }

}  // namespace

std::unique_ptr<Block> make_expression(SettingsReader& keys, const ControllerWiring& wiring) {
  auto made = std::make_unique<Expression>();
  const auto texts = keys.get_words("expression");
  if (texts.empty()) {
    keys.error("control.missing-key", "has no 'expression'", "give a formula of u1, u2, ... and t, or a list of them");
    return nullptr;
  }
  const auto n = static_cast<size_t>(wiring.size());
  made->variables = std::make_unique<double[]>(n + 1);
  made->sizes.inputs = wiring.size();
  made->sizes.outputs = static_cast<int>(texts.size());
  for (const auto& text : texts) {
    try {
      mu::Parser parser;
      for (size_t i = 0; i < n; ++i) parser.DefineVar("u" + std::to_string(i + 1), &made->variables[i]);
      if (n == 1) parser.DefineVar("u", &made->variables[0]);
      parser.DefineVar("t", &made->variables[n]);
      parser.DefineConst("pi", EIGEN_PI);
      parser.DefineFun("step", &calc_step);
      parser.SetExpr(text);
      parser.Eval();
      made->uses_time = made->uses_time || parser.GetUsedVar().count("t") > 0;
      made->parsers.push_back(std::move(parser));
    } catch (const mu::Parser::exception_type& error) {
      keys.error("control.bad-expression", "has the expression \"" + text + "\": " + error.GetMsg(),
                 "write it of u1 ... u" + std::to_string(n) + ", t, pi and functions as sin, sqrt, abs, min, step");
      return nullptr;
    }
  }
  return made;
}

}  // namespace bough::solver
