#include "formats/nastran/unit_conversion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "formats/nastran/detail/field_dimensions.hpp"
#include "formats/nastran/detail/text.hpp"

namespace bough::nastran {

namespace {

enum class Axes { Rectangular, Cylindrical, Spherical };
/// What a scalar element acts between: translations, rotations, both, or what the deck does not tell.
enum class Motion { Translation, Rotation, Mixed, Unknown };

class Converter {
 public:
  Converter(const DeckEditor& deck, const UnitFactors& factors, Diagnostics& diagnostics)
      : factors_(factors), diagnostics_(diagnostics), cards_(deck.list_cards()) {}

  std::vector<FieldEdit> convert() {
    for (const auto& card : cards_) note_card(card);
    for (const auto& card : cards_) {
      if (card.is_replicated) {
        diagnostics_.error("deck.unit-replication", card.at, card.name + " is written or copied by replication",
                           "write the deck out with bough export --to bdf first");
        continue;
      }
      card_ = &card;
      convert_card();
    }
    return edits_;
  }

 private:
  const std::string& get(int field) const {
    static const std::string blank;
    const auto i = static_cast<std::size_t>(field);
    return i < card_->fields.size() ? card_->fields[i] : blank;
  }
  int get_int(int field) const { return detail::parse_int(get(field)).value_or(0); }
  int size() const { return static_cast<int>(card_->fields.size()); }

  void fail(int field, const std::string& why) {
    diagnostics_.error("deck.unit-field", card_->at,
                       card_->name + " has " + get(field) + " in data field " + std::to_string(field + 1) + ": " + why,
                       "convert this card by hand");
  }

  void scale(int field, const std::string& word) {
    if (word == "." || get(field).empty()) return;
    if (word == "?") {
      fail(field, "nothing tells its dimension");
      return;
    }
    const auto value = detail::parse_real(get(field));
    if (!value) return;  // a word, or what the reader of the deck reports
    const auto d = detail::get_dimension(word);
    const double factor =
        std::pow(factors_.mass, d.mass) * std::pow(factors_.length, d.length) * std::pow(factors_.time, d.time);
    if (*value == 0 || std::abs(factor - 1) < 1e-14) return;
    // Fifteen digits: powers of ten give no noise in the last one.
    char text[40];
    std::snprintf(text, sizeof text, "%.15g", *value * factor);
    edits_.push_back({{card_->card, field}, format_field(*detail::parse_real(text))});
  }
  void scale(int first, int last, const std::string& word) {
    for (int field = first; field <= last; ++field) scale(field, word);
  }

  Axes get_axes(int cid) const {
    const auto found = axes_.find(cid);
    return found == axes_.end() ? Axes::Rectangular : found->second;
  }
  void scale_point(int field, Axes axes) {
    scale(field, "L");
    if (axes == Axes::Rectangular) scale(field + 1, "L");
    if (axes != Axes::Spherical) scale(field + 2, "L");
  }
  /// Components along the axes of a system.
  void scale_lengths(int field, int cid) {
    if (get_axes(cid) != Axes::Rectangular) {
      for (int i = field; i < field + 3; ++i)
        if (!get(i).empty()) return fail(i, "its coordinate system has angles");
    }
    scale(field, field + 2, "L");
  }

  static Motion find_motion(const std::string& c1, const std::string& c2, bool has_second) {
    bool translates = false, rotates = false;
    for (const auto* text : {&c1, &c2}) {
      if (text == &c2 && !has_second) continue;
      const int c = detail::parse_int(*text).value_or(0);
      if (c < 1 || c > 6) return Motion::Unknown;
      (c <= 3 ? translates : rotates) = true;
    }
    return translates && rotates ? Motion::Mixed : translates ? Motion::Translation : Motion::Rotation;
  }
  static std::string choose(Motion motion, const char* translation, const char* rotation, const char* mixed) {
    if (motion == Motion::Translation) return translation;
    if (motion == Motion::Rotation) return rotation;
    return motion == Motion::Mixed ? mixed : "?";
  }
  /// Of the elements that name a property: "?" where they differ or none does.
  Motion find_property_motion(const std::string& element, const std::string& pid) const {
    const auto found = motions_.find(element + " " + pid);
    if (found == motions_.end() || found->second.size() != 1) return Motion::Unknown;
    return *found->second.begin();
  }

  void note_card(const DeckCard& card) {
    card_ = &card;
    const auto& name = card.name;
    if (name == "CORD1C" || name == "CORD1S") {
      for (const int first : {0, 4})
        if (get_int(first) > 0) axes_[get_int(first)] = name == "CORD1C" ? Axes::Cylindrical : Axes::Spherical;
    }
    if (name == "CORD2C") axes_[get_int(0)] = Axes::Cylindrical;
    if (name == "CORD2S") axes_[get_int(0)] = Axes::Spherical;
    if (name == "GRDSET") default_system_ = get_int(1);
    if (name == "CELAS1" || name == "CMASS1" || name == "CDAMP1") {
      const auto pid = get(1).empty() ? get(0) : get(1);
      motions_[name + " " + pid].insert(find_motion(get(3), get(5), get_int(4) > 0));
    }
  }

  void convert_card() {
    const auto& name = card_->name;
    if (name == "GRID") return scale_point(2, get_axes(get(1).empty() ? default_system_ : get_int(1)));
    if (name == "CORD2R" || name == "CORD2C" || name == "CORD2S") {
      for (const int field : {2, 5, 8}) scale_point(field, get_axes(get_int(1)));
      return;
    }
    if (name == "MAT8") return convert_mat8();
    if (name == "PBEAM") return convert_pbeam();
    if (name == "PBARL" || name == "PBEAML") return convert_section();
    if (name == "PCOMP") return convert_pcomp();
    if (name == "PELAS" || name == "PMASS" || name == "PDAMP") return convert_scalar_property();
    if (name == "CELAS2" || name == "CMASS2" || name == "CDAMP2") {
      const auto motion = find_motion(get(3), get(5), get_int(4) > 0);
      scale(1, name == "CELAS2"   ? choose(motion, "K", "Q", "F")
               : name == "CMASS2" ? choose(motion, "M", "J", "ML")
                                  : choose(motion, "B", "BR", "BL"));
      if (name == "CELAS2") scale(7, "?");
      return;
    }
    if (name == "PBUSH") return convert_pbush();
    if (name == "CBUSH") {
      if (get_int(9) >= 0) scale_lengths(10, get_int(9));
      return;
    }
    if (name == "CONM2") {
      scale(3, "M");
      if (get_int(2) == -1)
        scale(4, 6, "L");
      else
        scale_lengths(4, get_int(2));
      scale(8, 13, "J");
      return;
    }
    if (name == "SPC" || name == "SPCD") {
      for (const int first : {1, 4})
        if (detail::parse_real(get(first + 2)).value_or(0) != 0)
          scale(first + 2, choose(find_components(first + 1), "L", ".", "?"));
      return;
    }
    if (name == "MPC") return convert_mpc();
    if (name == "PLOAD1") return convert_pload1();
    if (name == "PARAM") return convert_param();
    if (const auto* words = detail::find_field_words(name)) {
      for (int i = 0; i < static_cast<int>(words->size()); ++i) {
        // TFLAG 1: thicknesses are shares of the property's.
        const bool is_relative = (name == "CQUAD4" || name == "CQUADR") && i >= 10 && get(9) == "1";
        const bool is_relative_triangle = (name == "CTRIA3" || name == "CTRIAR") && i >= 10 && get(9) == "1";
        const bool is_relative_high = (name == "CQUAD8" && i >= 10 && i <= 13 && get(16) == "1") ||
                                      (name == "CTRIA6" && i >= 10 && get(13) == "1");
        if (!is_relative && !is_relative_triangle && !is_relative_high) scale(i, (*words)[static_cast<std::size_t>(i)]);
      }
      return;
    }
    // Reals have a point or an exponent; ids and words have no dimension.
    for (int i = 0; i < size(); ++i) {
      if (get(i).empty() || detail::parse_int(get(i)) || !detail::parse_real(get(i))) continue;
      diagnostics_.error("deck.unit-card", card_->at, "the dimensions of the fields of " + name + " are not known here",
                         "convert this card by hand, or take it out");
      return;
    }
  }

  /// Components "123" of SPC.
  Motion find_components(int field) const {
    bool translates = false, rotates = false;
    for (const char c : get(field)) {
      if (c < '1' || c > '6') return Motion::Unknown;
      (c <= '3' ? translates : rotates) = true;
    }
    if (!translates && !rotates) return Motion::Unknown;
    return translates && rotates ? Motion::Mixed : translates ? Motion::Translation : Motion::Rotation;
  }

  void convert_mat8() {
    for (const int field : {1, 2, 4, 5, 6}) scale(field, "P");
    scale(7, "R");
    const bool are_strains = detail::parse_real(get(18)).value_or(0) == 1;
    if (!are_strains) {
      scale(11, 15, "P");
      scale(17, "1/P2");
    }
  }

  void convert_pbeam() {
    const auto scale_station = [&](int first) {
      scale(first, "A");
      scale(first + 1, first + 4, "I");
      scale(first + 5, "N");
    };
    const auto is_station = [&](int first) {
      return detail::is_word(get(first), "YES") || detail::is_word(get(first), "YESA") ||
             detail::is_word(get(first), "NO");
    };
    scale_station(2);
    int line = 8;
    if (!is_station(line)) {
      scale(line, line + 7, "L");
      line += 8;
    }
    while (line < size() && is_station(line)) {
      scale_station(line + 2);
      const bool has_points = detail::is_word(get(line), "YES");
      line += 8;
      if (!has_points || is_station(line)) continue;
      scale(line, line + 7, "L");
      line += 8;
    }
    // K1 K2 S1 S2 NSI(A) NSI(B) CW(A) CW(B), then the offsets of the mass and of the neutral axis.
    scale(line + 4, line + 5, "ML");
    scale(line + 6, line + 7, "L6");
    scale(line + 8, line + 15, "L");
  }

  void convert_section() {
    auto type = detail::make_upper(get(3));
    const int dims = detail::get_num_section_dims(type);
    if (dims == 0) return fail(3, "the section is not known");
    scale(8, 8 + dims - 1, "L");
    scale(8 + dims, "N");
    if (card_->name == "PBARL") return;
    for (int station = 9 + dims; station < size(); station += dims + 3) {
      scale(station + 2, station + 1 + dims, "L");
      scale(station + 2 + dims, "N");
    }
  }

  void convert_pcomp() {
    scale(1, "L");
    scale(2, "S");
    scale(3, "P");
    for (int ply = 8; ply < size(); ply += 4) scale(ply + 1, "L");
  }

  void convert_scalar_property() {
    const auto& name = card_->name;
    const int entry = name == "PELAS" ? 4 : 2;
    for (int first = 0; first < std::min(size(), 8); first += entry) {
      if (get(first).empty()) continue;
      if (name == "PELAS") {
        scale(first + 1, choose(find_property_motion("CELAS1", get(first)), "K", "Q", "F"));
        scale(first + 3, "?");
      } else if (name == "PMASS") {
        scale(first + 1, choose(find_property_motion("CMASS1", get(first)), "M", "J", "ML"));
      } else {
        scale(first + 1, choose(find_property_motion("CDAMP1", get(first)), "B", "BR", "BL"));
      }
    }
  }

  void convert_pbush() {
    for (int line = 0; line < size(); line += 8) {
      const auto flag = detail::make_upper(get(line + 1));
      if (flag == "K" || flag == "B") {
        scale(line + 2, line + 4, flag == "K" ? "K" : "B");
        scale(line + 5, line + 7, flag == "K" ? "Q" : "BR");
      } else if (flag == "M") {
        scale(line + 2, "M");
      } else if (flag != "GE" && !flag.empty()) {
        for (int i = line + 2; i < line + 8; ++i) scale(i, "?");
      }
    }
  }

  /// sum of a u = 0 with u in the new unit of length: the factors of rotations grow by it.
  void convert_mpc() {
    for (int line = 0; line < size(); line += 8)
      for (const int first : {line + 1, line + 4}) {
        if (get(first).empty()) continue;
        scale(first + 2, choose(find_components(first + 1), ".", "L", "?"));
      }
  }

  void convert_pload1() {
    const auto type = detail::make_upper(get(2)), kind = detail::make_upper(get(3));
    const bool is_moment = type.starts_with("M");
    const bool is_point = get(6).empty() || get(6) == get(4);
    const std::string word = is_moment ? (is_point ? "Q" : "F") : (is_point ? "F" : "K");
    scale(5, word);
    scale(7, word);
    if (kind.starts_with("LE")) {
      scale(4, "L");
      scale(6, "L");
    }
  }

  void convert_param() {
    static const std::map<std::string, std::string> words{
        {"W3", "Hz"},    {"W4", "Hz"},   {"ALPHA1", "Hz"}, {"ALPHA2", "T"}, {"LFREQ", "Hz"},   {"HFREQ", "Hz"},
        {"WTMASS", "."}, {"G", "."},     {"GFL", "."},     {"K6ROT", "."},  {"MAXRATIO", "."}, {"EPZERO", "."},
        {"EPPRT", "."},  {"SNORM", "."}, {"CB1", "."},     {"CB2", "."},    {"CK1", "."},      {"CK2", "."},
        {"CM1", "."},    {"CM2", "."},   {"BAILOUT", "."}, {"TINY", "."},   {"SIGMA", "?"}};
    const auto found = words.find(detail::make_upper(get(0)));
    if (found != words.end()) return scale(1, found->second);
    if (!detail::parse_int(get(1)) && detail::parse_real(get(1))) fail(1, "nothing tells its dimension");
  }

  const UnitFactors& factors_;
  Diagnostics& diagnostics_;
  std::vector<DeckCard> cards_;
  const DeckCard* card_ = nullptr;
  std::map<int, Axes> axes_;
  std::map<std::string, std::set<Motion>> motions_;
  int default_system_ = 0;
  std::vector<FieldEdit> edits_;
};

}  // namespace

std::vector<FieldEdit> convert_units(const DeckEditor& deck, const UnitFactors& factors, Diagnostics& diagnostics) {
  return Converter(deck, factors, diagnostics).convert();
}

}  // namespace bough::nastran
