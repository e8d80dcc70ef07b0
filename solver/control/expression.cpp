// Formulas of the inputs u1, u2, ... and the time t.
#include "solver/control/makers.hpp"
#include "solver/text/formulas.hpp"

namespace bough::solver {
namespace {

class Expression final : public Block {
 public:
  /// Variables u1 to un, t.
  explicit Expression(Formulas::Names names) : formulas(std::move(names)) {}
  Formulas formulas;

  bool depends_on_time() const override { return formulas.uses("t") && sizes.sample_time == 0; }

  struct Scratch final : BlockScratch {
    explicit Scratch(const Formulas& f) : formulas(f) {}
    Formulas formulas;
  };
  std::shared_ptr<BlockScratch> make_scratch() const override { return std::make_shared<Scratch>(formulas); }

  void calc_outputs(const BlockInput& in, double* y) const override {
    if (in.tangents == nullptr) return calc(in, y);
    evaluate_black_box(
        in.tangents, as_owner(), 0, {in.u, in.u + sizes.inputs}, sizes.outputs,
        [&](const double* u, double* to) {
          BlockInput at = in;
          at.u = u;
          calc(at, to);
        },
        y);
  }

 private:
  void calc(const BlockInput& in, double* y) const {
    Formulas& own = static_cast<Scratch*>(in.scratch)->formulas;
    for (int i = 0; i < sizes.inputs; ++i) own[i] = in.u[i];
    own[sizes.inputs] = in.t;
    for (int i = 0; i < own.size(); ++i) y[i] = own.calc(i);
  }
};

}  // namespace

std::unique_ptr<Block> make_expression(SettingsReader& keys, const ControllerWiring& wiring) {
  const auto texts = keys.get_words("expression");
  if (texts.empty()) {
    keys.error("control.missing-key", "has no 'expression'", "give a formula of u1, u2, ... and t, or a list of them");
    return nullptr;
  }
  const int n = wiring.size();
  Formulas::Names names = {{"t", n}};
  for (int i = 0; i < n; ++i) names.emplace_back("u" + std::to_string(i + 1), i);
  if (n == 1) names.emplace_back("u", 0);
  auto made = std::make_unique<Expression>(std::move(names));
  made->sizes.inputs = n;
  made->sizes.outputs = static_cast<int>(texts.size());
  for (const auto& text : texts) {
    const std::string fault = made->formulas.add(text);
    if (fault.empty()) continue;
    keys.error("control.bad-expression", "has the expression \"" + text + "\": " + fault,
               "write it of u1 ... u" + std::to_string(n) + ", t, pi and functions as sin, sqrt, abs, min, step");
    return nullptr;
  }
  return made;
}

}  // namespace bough::solver
