#pragma once
/// \file Models of the subcases of a deck, which differ by their constraints.
#include <array>
#include <optional>

#include "fe/statics/build_model.hpp"

namespace bough::analysis {

/// Keeps the model of the last subcase. The arguments of the constructor must outlive it.
class SubcaseModels {
 public:
  /// `first`: of the subcase in `options`.
  SubcaseModels(const records::Deck& deck, const fe::Model& first, const fe::ModelOptions& options)
      : deck_(deck), first_(first), options_(options) {}

  /// Throws what is wrong with the constraints of the subcase.
  const fe::Model& get(const records::Subcase& subcase) {
    if (is_held_alike(subcase, first_)) return first_;
    if (own_ && is_held_alike(subcase, *own_)) return *own_;
    auto options = options_;
    options.subcase = subcase.id;
    own_.reset();
    Diagnostics of_model;
    own_.emplace(fe::build_model(deck_, options, of_model));
    of_model.throw_if_errors();
    return *own_;
  }

 private:
  static bool is_held_alike(const records::Subcase& subcase, const fe::Model& model) {
    const auto get_held = [](const records::Subcase& s) { return std::array<int, 3>{s.spc, s.mpc, s.suport1}; };
    return get_held(subcase) == get_held(model.subcase());
  }

  const records::Deck& deck_;
  const fe::Model& first_;
  const fe::ModelOptions& options_;
  std::optional<fe::Model> own_;
};

}  // namespace bough::analysis
