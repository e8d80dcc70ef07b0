#pragma once
/// \file Conversion of the fields of a deck to other units, card by card: what CardFacts::convert and note work with.
#include <map>
#include <set>
#include <tuple>

#include "formats/nastran/detail/text.hpp"
#include "formats/nastran/unit_conversion.hpp"

namespace bough::nastran::detail {

/// Coordinates of a system: three lengths, a length with an angle and a length, a length with two angles.
enum class Axes { Rectangular, Cylindrical, Spherical };
/// Motions coupled by a scalar element: translations, rotations, both, or not known from the deck.
enum class Motion { Translation, Rotation, Mixed, Unknown };

/// Facts of other cards on which the dimensions of fields depend.
struct UnitNotes {
  std::map<int, Axes> axes;                         ///< by CID; others are rectangular
  std::map<std::string, std::set<Motion>> motions;  ///< of elements with a property: "CELAS", "CMASS", "CDAMP" and PID
  std::map<std::string, std::string> matrix_kinds;  ///< of DMIG, by name
  std::set<std::string> polar_matrices;             ///< amplitude and phase
  std::set<std::string> grids;                      ///< ids as written
  std::map<std::string, std::set<std::string>> table_axes;    ///< by TID: "Hz", "T"
  std::map<std::string, std::set<std::string>> table_values;  ///< by TID: words of the values, of PBUSHT and the like
  std::vector<std::tuple<std::string, std::string, std::string>> spring_tables;  ///< "CELAS" or "CDAMP", PID, TID
  std::map<std::string, std::set<int>> enforced;  ///< by EXCITEID: 0 force, 1 motion, 2 velocity, 3 acceleration
  int default_system = 0;                         ///< CP of GRDSET
};

class UnitConverter {
 public:
  /// Lists the cards of the deck; all arguments must outlive this.
  UnitConverter(const DeckEditor& deck, const UnitFactors& factors, Diagnostics& diagnostics);
  /// Converts all cards and returns the edits; reports "deck.unit-replication" and what the cards report.
  std::vector<FieldEdit> convert();

  /// Facts that several cards share, filled by convert().
  const UnitNotes& get_notes() const { return notes_; }
  /// Ratio of new to old unit of time is 1.
  bool keeps_time() const;

  // The card that is converted or noted; field 0 is the first after the name.
  /// Name of the present card.
  const std::string& get_name() const { return card_->name; }
  /// Text of a field; empty after the last one.
  const std::string& get(int field) const;
  /// Integer of a field; 0 if it is blank or no integer.
  int get_int(int field) const;
  /// Number of fields of the present card.
  int size() const { return static_cast<int>(card_->fields.size()); }
  /// Adds deck.unit-field for a field that cannot be converted.
  void fail(int field, const std::string& why);
  /// Adds deck.unit-card.
  void fail_card(const std::string& why, const std::string& advice);
  /// Factor of a dimension by its word; 1 for ".".
  double calc_factor(const std::string& word) const;
  /// Scales a field by the word of its dimension: "." none, "?" not known, "??" several.
  void scale(int field, const std::string& word);
  /// Scales the fields first to last - 1 by one dimension.
  void scale(int first, int last, const std::string& word);
  /// Scales the fields before `end` by CardFacts::dimensions.
  void scale_words(int end = 1 << 20);
  /// Scales three coordinates of a point.
  void scale_point(int field, Axes axes);
  /// Scales components along the axes of a system.
  void scale_lengths(int field, int cid);
  /// Axes of a coordinate system; rectangular for an unknown one.
  Axes get_axes(int cid) const;
  /// Scales a field by the motion that it acts on; "?" where that is not known.
  void scale_by(Motion motion, int field, const char* translation, const char* rotation, const char* mixed);
  /// Motion of the fields G1 C1 G2 C2 from 2 on.
  Motion find_scalar_motion() const;
  /// Motion of the elements ("CELAS", "CMASS", "CDAMP") that refer to a property: unknown if they differ or there are
  /// none.
  Motion find_property_motion(const std::string& element, const std::string& pid) const;
  /// Components "123" of SPC.
  Motion find_components(int field) const;
  /// Kind of motion that two components couple, `c2` only with has_second.
  static Motion find_motion(const std::string& c1, const std::string& c2, bool has_second);

 private:
  void convert_card();
  void refuse_unknown();

  const UnitFactors& factors_;
  Diagnostics& diagnostics_;
  std::vector<DeckCard> cards_;
  const DeckCard* card_ = nullptr;
  UnitNotes notes_;
  std::vector<FieldEdit> edits_;
};

/// CELAS1, CMASS1, CDAMP1: the motions of their property.
void note_scalar_element(const UnitConverter& u, UnitNotes& notes);
/// CELAS3, CMASS3, CDAMP3: nothing tells whether a scalar point is a translation or a rotation.
void note_scalar_points(const UnitConverter& u, UnitNotes& notes);

}  // namespace bough::nastran::detail
