// Sum and product of functions of time.
#include <algorithm>

#include "solver/functions/function_parameters.hpp"
#include "solver/text/names.hpp"

namespace bough::solver {
namespace {

class Combination : public TimeFunction {
 public:
  std::vector<const TimeFunction*> of;
  std::vector<double> jump_times() const override { return collect(&TimeFunction::jump_times); }
  std::vector<double> force_jump_times() const override { return collect(&TimeFunction::force_jump_times); }
  std::vector<double> mesh_times() const override { return collect(&TimeFunction::mesh_times); }
  bool has_derivatives() const override {
    return std::all_of(of.begin(), of.end(), [](const TimeFunction* f) { return f->has_derivatives(); });
  }

 protected:
  /// Replaces functions that threads cannot share by copies; returns false if there are none.
  bool copy_parts() {
    for (const TimeFunction*& f : of) {
      auto copy = f->clone();
      if (!copy) continue;
      f = copy.get();
      own_.push_back(std::move(copy));
    }
    return !own_.empty();
  }
  template <class Kind>
  static std::unique_ptr<const TimeFunction> clone_as(const Kind& kind) {
    auto copy = std::make_unique<Kind>(kind);
    if (!copy->copy_parts()) return nullptr;
    return copy;
  }

 private:
  std::vector<std::shared_ptr<const TimeFunction>> own_;
  std::vector<double> collect(std::vector<double> (TimeFunction::*get)() const) const {
    std::vector<double> all;
    for (const TimeFunction* f : of) {
      const auto times = (f->*get)();
      all.insert(all.end(), times.begin(), times.end());
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }
};

class Sum final : public Combination {
 public:
  std::vector<double> weights;
  std::unique_ptr<const TimeFunction> clone() const override { return clone_as(*this); }
  Value calc(double t) const override {
    Value sum;
    for (size_t i = 0; i < of.size(); ++i) {
      const Value one = of[i]->calc(t);
      sum.f += weights[i] * one.f;
      sum.f_dot += weights[i] * one.f_dot;
      sum.f_ddot += weights[i] * one.f_ddot;
    }
    return sum;
  }
};

class Product final : public Combination {
 public:
  double gain = 1;
  std::unique_ptr<const TimeFunction> clone() const override { return clone_as(*this); }
  Value calc(double t) const override {
    Value all{gain, 0, 0};
    for (const TimeFunction* f : of) {
      const Value one = f->calc(t);
      all = {all.f * one.f, all.f_dot * one.f + all.f * one.f_dot,
             all.f_ddot * one.f + 2 * all.f_dot * one.f_dot + all.f * one.f_ddot};
    }
    return all;
  }
};

}  // namespace

std::unique_ptr<const TimeFunction> make_combination(const records::FunctionRecord& r, const FunctionMap& others,
                                                     FunctionParameters& p) {
  std::vector<const TimeFunction*> of;
  bool is_valid = true;
  if (r.of.empty()) p.error("function.missing-parameter", "has no 'of'", "give of = [\"NAME\", ...]");
  for (const auto& name : r.of) {
    const auto found = others.find(name);
    if (found == others.end()) {
      std::vector<std::string> names;
      for (const auto& [known, f] : others) names.push_back(known);
      p.error("system.unknown-function", "names function '" + name + "', which does not exist",
              suggest_name(name, names, "declare it"));
    } else {
      is_valid = is_valid && found->second != nullptr;  // else it has errors
      of.push_back(found->second);
    }
  }
  std::unique_ptr<Combination> made;
  if (r.type == "sum") {
    auto sum = std::make_unique<Sum>();
    sum->weights = r.weights.empty() ? std::vector<double>(r.of.size(), 1.0) : r.weights;
    if (sum->weights.size() != r.of.size())
      p.error("function.table-size",
              "has " + std::to_string(r.weights.size()) + " weights of " + std::to_string(r.of.size()) + " functions",
              "give one of each, or none");
    made = std::move(sum);
  } else {
    auto product = std::make_unique<Product>();
    product->gain = p.get("gain", 1);
    made = std::move(product);
  }
  p.refuse_others();
  if (p.failed() || !is_valid) return nullptr;
  made->of = std::move(of);
  return made;
}

}  // namespace bough::solver
