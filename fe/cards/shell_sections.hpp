#pragma once
/// \file PSHELL, PCOMP and PCOMPG of a deck as sections of plates. Internal.
#include <map>
#include <optional>
#include <string>

#include "fe/cards/maker.hpp"
#include "fe/sections/laminate.hpp"

namespace bough::fe {

class ShellSections {
 public:
  /// Indexes the property and material cards of the deck, and reads PARAM,K6ROT; `maker` must outlive this.
  explicit ShellSections(Maker& maker);

  /// The section of property `pid` in its material axes, made once, or nullptr after reporting (`who`: the element,
  /// `at`: its card). thickness: the element's own (mean of its corners); empty = the property's. drilling holds
  /// PARAM,K6ROT.
  const ShellSection* find(int pid, const std::string& who, const records::CardLocation& at,
                           std::optional<double> thickness = {});

  /// T of a PSHELL; empty when blank or when `pid` is no PSHELL.
  std::optional<double> find_thickness(int pid) const;

 private:
  /// The material as a plate sees it, made once; empty after reporting.
  std::optional<PlaneMaterial> find_material(int mid, const std::string& who, const records::CardLocation& at);
  std::optional<PlaneMaterial> make_material(int mid, const std::string& who, const records::CardLocation& at);
  /// MID1 of a PSHELL with MID2 = -1: no strain along the normal. Empty after reporting.
  std::optional<PlaneMaterial> find_plane_strain(const records::Pshell& p);
  std::optional<ShellSection> make_pshell(const records::Pshell& p, const std::string& who,
                                          const records::CardLocation& at, std::optional<double> thickness);
  /// Sets the thermal expansion of A, B, D from those of MID1 and MID2.
  void set_expansion(const PlaneMaterial& membrane, const PlaneMaterial& bending, ShellSection& section) const;
  std::optional<ShellSection> make_pcomp(const records::Pcomp& p);
  /// The plies, or the layers that stand for them, as stresses are given of them.
  void set_stress(const records::Pcomp& p, const std::vector<LaminateLayer>& layers, double z0,
                  ShellSection& section) const;
  /// The layers of LAM = SMEAR and SMCORE.
  void stack_smeared(const records::Pcomp& p, std::vector<LaminateLayer>& layers, double& z0);

  Maker& maker_;
  RecordIndex<records::Pshell> pshell_;
  RecordIndex<records::Pcomp> pcomp_;
  RecordIndex<records::Mat1> mat1_;
  RecordIndex<records::Mat2> mat2_;
  RecordIndex<records::Mat8> mat8_;
  bool has_temperatures_ = false, has_initial_ = false;  // else no section needs its expansion
  double drilling_factor_ = 1e-4;
  std::map<int, std::optional<PlaneMaterial>> materials_;
  std::map<std::pair<int, double>, std::optional<ShellSection>> made_;
};

}  // namespace bough::fe
