#pragma once
/// \file Conversion of the fields of a deck to other units, card by card. Internal.
#include <map>
#include <set>

#include "formats/nastran/unit_conversion.hpp"

namespace bough::nastran::detail {

class UnitConverter {
 public:
  UnitConverter(const DeckEditor& deck, const UnitFactors& factors, Diagnostics& diagnostics);
  std::vector<FieldEdit> convert();

 private:
  enum class Axes { Rectangular, Cylindrical, Spherical };
  /// Motions coupled by a scalar element: translations, rotations, both, or not known from the deck.
  enum class Motion { Translation, Rotation, Mixed, Unknown };

  const std::string& get(int field) const;
  int get_int(int field) const;
  int size() const { return static_cast<int>(card_->fields.size()); }
  void fail(int field, const std::string& why);
  /// Scales a field by the word of its dimension: "." none, "?" not known.
  void scale(int field, const std::string& word);
  void scale(int first, int last, const std::string& word);

  Axes get_axes(int cid) const;
  void scale_point(int field, Axes axes);
  /// Components along the axes of a system.
  void scale_lengths(int field, int cid);
  static Motion find_motion(const std::string& c1, const std::string& c2, bool has_second);
  static std::string choose(Motion motion, const char* translation, const char* rotation, const char* mixed);
  /// Motion of the elements that refer to a property: "?" if they differ or there are none.
  Motion find_property_motion(const std::string& element, const std::string& pid) const;
  /// Components "123" of SPC.
  Motion find_components(int field) const;

  void note_card(const DeckCard& card);
  void convert_card();
  /// Converts the fields of find_field_words; false if the card is not among them.
  bool convert_by_table();
  bool convert_static_load();
  void refuse_unknown();

  void convert_mat8();
  void convert_pbeam();
  void convert_pbcomp();
  void convert_pbend();
  void convert_section();
  void convert_plies();
  void convert_scalar_property();
  void convert_pbush();
  void convert_mpc();
  void convert_pload1();
  void convert_nonstructural();
  void convert_param();
  void convert_dmig();
  void convert_genel();

  /// Loads over frequency and time, tables; false where the card is none of them.
  bool convert_dynamic();
  void convert_spcd();
  void convert_tload2();
  void convert_table();

  const UnitFactors& factors_;
  Diagnostics& diagnostics_;
  std::vector<DeckCard> cards_;
  const DeckCard* card_ = nullptr;
  std::map<int, Axes> axes_;
  std::map<std::string, std::set<Motion>> motions_;
  std::map<std::string, std::string> matrix_kinds_;  ///< of DMIG, by name
  std::set<std::string> polar_matrices_;             ///< amplitude and phase
  std::set<std::string> grids_;
  std::map<std::string, std::set<std::string>> table_axes_;  ///< by TID: "Hz", "T"
  std::map<std::string, std::set<int>> enforced_;  ///< by EXCITEID: 0 force, 1 motion, 2 velocity, 3 acceleration
  int default_system_ = 0;
  std::vector<FieldEdit> edits_;
};

}  // namespace bough::nastran::detail
