#pragma once
/// \file PBAR, PBARL, PBEAM, PBEAML, PBCOMP to BeamProperty, each made once and shared by its elements. Internal.
#include <memory>
#include <unordered_map>

#include "fe/cards/maker.hpp"
#include "fe/sections/beam_property.hpp"

namespace bough::fe {

/// Copies E, G, density, thermal expansion, TREF and GE of a MAT1.
Isotropic make_isotropic(const records::Mat1& material);

class BeamProperties {
 public:
  /// Indexes the property cards of the deck; `maker` must outlive this.
  explicit BeamProperties(Maker& maker);
  /// The property of a CBAR or CBEAM; nullptr after reporting (what is wrong with a property is reported once, a
  /// missing one for every element).
  std::shared_ptr<const BeamProperty> find(const records::BeamElement& card, const std::string& who);

 private:
  std::shared_ptr<BeamProperty> make(const records::Pbar& card);
  std::shared_ptr<BeamProperty> make(const records::Pbarl& card);
  std::shared_ptr<BeamProperty> make(const records::Pbeam& card);
  std::shared_ptr<BeamProperty> make(const records::Pbeaml& card);
  std::shared_ptr<BeamProperty> make(const records::Pbcomp& card);
  bool check(const BeamProperty& property, const std::string& who, const records::CardLocation& at);

  Maker& maker_;
  RecordIndex<records::Pbar> pbar_;
  RecordIndex<records::Pbarl> pbarl_;
  RecordIndex<records::Pbeam> pbeam_;
  RecordIndex<records::Pbeaml> pbeaml_;
  RecordIndex<records::Pbcomp> pbcomp_;
  std::unordered_map<int, std::shared_ptr<const BeamProperty>> bars_, beams_;
};

}  // namespace bough::fe
