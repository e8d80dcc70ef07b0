#include <algorithm>
#include <map>

#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

using records::EigenMethod;

const std::vector<std::string>& get_norms() {
  static const std::vector<std::string> norms{"MASS", "MAX", "POINT", "AF"};
  return norms;
}

/// KEYWORD=value pairs on the continuation lines of EIGRL; they do not respect fields, so the bare line is read.
void read_keywords(Card& card, EigenMethod& m) {
  const auto& lines = card.get_text().lines;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const int first_field = lines[k].first_field;
    std::string text(lines[k].text);
    if (text.find('=') == std::string::npos) continue;
    if (text.front() == '+' || text.front() == '*') text.erase(0, std::min(text.find_first_of(" ,"), text.size()));
    std::replace(text.begin(), text.end(), ',', ' ');
    for (std::size_t at = text.find('='); at != std::string::npos; at = text.find('=', at + 1)) {
      const auto before = trim(std::string_view(text).substr(0, at));
      const auto start = before.find_last_of(" =");
      const auto key = make_upper(start == std::string_view::npos ? before : before.substr(start + 1));
      const auto after = trim(std::string_view(text).substr(at + 1));
      const auto value = after.substr(0, after.find(' '));
      const auto number = parse_real(value);
      const auto bad = [&](const char* expected) {
        card.fail("deck.bad-keyword", first_field, key + " is '" + std::string(value) + "', expected " + expected);
      };
      if (key == "V1" || key == "V2") {
        if (!number) bad("a real number");
        (key == "V1" ? m.f1 : m.f2) = number;
      } else if (key == "ND") {
        const auto count = parse_int(value);
        if (!count || *count < 1) bad("a positive integer");
        m.num_modes = count.value_or(0);
      } else if (key == "NORM") {
        m.norm = make_upper(value);
        if (std::find(get_norms().begin(), get_norms().end(), m.norm) == get_norms().end()) bad("MASS or MAX");
      } else if (key != "MSGLVL" && key != "MAXSET" && key != "SHFSCL" && key != "ALPH" && key != "NUMS" &&
                 key.substr(0, 1) != "F") {
        card.fail("deck.bad-keyword", first_field, "keyword '" + key + "' is not known",
                  "expected V1, V2, ND, MSGLVL, MAXSET, SHFSCL, NORM, ALPH, NUMS or Fi");
      }
    }
  }
}

/// Without ND and V2 Nastran looks for the lowest root only.
void parse_eigrl(Card& card, Reading& r) {
  EigenMethod m;
  m.sid = card.read_id(0, "SID");
  m.f1 = card.read_optional_real(1, "V1");
  m.f2 = card.read_optional_real(2, "V2");
  m.num_modes = card.read_int(3, "ND", 0);
  m.norm = card.read_word(7, "NORM", "MASS", get_norms());
  card.use(4, card.get_size());  // MSGLVL MAXSET SHFSCL; keywords
  m.at = card.get_location();
  card.demand(card.is_blank(3) || m.num_modes > 0, 3, "ND", "a positive integer");
  read_keywords(card, m);
  if (m.f1 && m.f2 && *m.f2 <= *m.f1)
    card.fail("deck.field-range", 2, "V2 is '" + std::string(card.get(2)) + "', expected a value above V1");
  m.is_lowest_only = m.num_modes == 0 && !m.f2;
  if (m.is_lowest_only) m.num_modes = 1;
  if (r.claim(IdSpace::EigenMethod, m.sid, card)) r.deck.eigen_methods.push_back(std::move(m));
}

void parse_eigr(Card& card, Reading& r) {
  EigenMethod m;
  m.is_eigrl = false;
  m.sid = card.read_id(0, "SID");
  m.method = card.get_upper(1);
  if (m.method.empty()) m.method = "LAN";
  m.f1 = card.read_optional_real(2, "F1");
  m.f2 = card.read_optional_real(3, "F2");
  const int estimate = card.read_int(4, "NE", 0);
  card.use(6);  // E of the COSMIC programs
  m.num_modes = card.read_int(5, "ND", 0);
  if (m.num_modes == 0 && (m.method == "INV" || m.method == "SINV")) m.num_modes = 3 * estimate;
  m.norm = card.read_word(8, "NORM", "MASS", get_norms());
  m.norm_grid = card.read_reference(9, "G");
  m.norm_component = card.read_component(10, "C");
  m.at = card.get_location();
  card.demand(m.num_modes >= 0, 5, "ND", "zero or a positive integer");
  if (m.norm == "POINT" && m.norm_grid == 0 && card.is_ok())
    card.fail("deck.missing-field", 9, "G is blank, expected the grid of NORM = POINT");
  if (r.claim(IdSpace::EigenMethod, m.sid, card)) r.deck.eigen_methods.push_back(std::move(m));
}

/// SID METHOD L1 L2 NEP NDP NDN, NORM G C: what EIGRL says in fewer words. Roots of both signs are one search here, and
/// the largest component of the shape is 1.
void parse_eigb(Card& card, Reading& r) {
  EigenMethod m;
  m.sid = card.read_id(0, "SID");
  m.f1 = card.read_optional_real(2, "L1");
  m.f2 = card.read_optional_real(3, "L2");
  const int positive = card.read_int(5, "NDP", 3 * card.read_int(4, "NEP", 0));
  m.num_modes = std::max(positive, card.read_int(6, "NDN", 0));
  m.norm = "MAX";
  for (const int i : {1, 7, 8, 9, 10}) card.use(i);  // METHOD, E, NORM G C
  m.at = card.get_location();
  card.demand(m.num_modes >= 0, 5, "NDP", "zero or a positive integer");
  if (m.f1 && m.f2 && *m.f2 <= *m.f1) m.f1 = m.f2 = std::nullopt;
  m.is_lowest_only = m.num_modes == 0 && !m.f2;
  if (m.is_lowest_only) m.num_modes = 1;
  if (r.claim(IdSpace::EigenMethod, m.sid, card)) r.deck.eigen_methods.push_back(std::move(m));
}

/// The last value of a name counts.
void parse_param(Card& card, Reading& r) {
  records::Param p{card.get_upper(0), card.get_upper(1), card.get_location()};
  card.use(2);  // imaginary part
  if (p.name.empty()) {
    card.fail("deck.missing-field", 0, "the name is blank, expected the name of a parameter");
    return;
  }
  const auto* earlier = r.deck.find_param(p.name);
  if (earlier != nullptr && earlier->value != p.value)
    card.warn("deck.repeated-param", 1, p.name + " is '" + p.value + "' here and '" + earlier->value + "' before",
              p.name == "AUTOSPC" && r.deck.autospc_command
                  ? "the command of the case control is used; remove one of them"
                  : "the last one is used; remove one of them");
  r.deck.params.push_back(std::move(p));
}

void write_eigen_methods(const records::Deck& deck, CardSink& sink) {
  for (const auto& m : deck.eigen_methods) {
    CardFields card(m.is_eigrl ? "EIGRL" : "EIGR");
    card.add(m.sid);
    if (!m.is_eigrl) card.add_word(m.method);
    card.add(m.f1);
    card.add(m.f2);
    if (m.is_eigrl) {
      sink.put(card.add_id(m.num_modes).add_blank(3).add_word(m.norm));
      continue;
    }
    card.add_blank().add_id(m.num_modes).end_line().add_word(m.norm);
    sink.put(card.add_id(m.norm_grid).add_id(m.norm_component));
  }
}

void write_params(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.params) {
    CardFields card("PARAM");
    card.add_word(p.name);
    if (!p.value.empty()) card.add_word(p.value);
    sink.put(card);
  }
}

void convert_param(UnitConverter& u) {
  static const std::map<std::string, std::string> words{
      {"W3", "Hz"},    {"W4", "Hz"},   {"ALPHA1", "Hz"}, {"ALPHA2", "T"}, {"LFREQ", "Hz"},   {"HFREQ", "Hz"},
      {"WTMASS", "."}, {"G", "."},     {"GFL", "."},     {"K6ROT", "."},  {"MAXRATIO", "."}, {"EPZERO", "."},
      {"EPPRT", "."},  {"SNORM", "."}, {"CB1", "."},     {"CB2", "."},    {"CK1", "."},      {"CK2", "."},
      {"CM1", "."},    {"CM2", "."},   {"CP1", "."},     {"CP2", "."},    {"CK3", "."},      {"BAILOUT", "."},
      {"TINY", "."},   {"SIGMA", "?"}};
  const auto found = words.find(make_upper(u.get(0)));
  if (found != words.end()) return u.scale(1, found->second);
  if (!parse_int(u.get(1)) && parse_real(u.get(1))) u.fail(1, "nothing tells its dimension");
}

}  // namespace

void add_solution_parsers(ParserTable& table) {
  table["EIGRL"] = {parse_eigrl, ". Hz Hz", "SID V1 V2 ND MSGLVL MAXSET SHFSCL NORM"};
  table["EIGR"] = {parse_eigr, ". . Hz Hz", "SID METHOD F1 F2 NE ND - - NORM G C"};
  table["EIGB"] = {parse_eigb, "", "SID METHOD L1 L2 NEP NDP NDN - NORM G C"};  // L1, L2: factors of the load
  table["PARAM"] = {parse_param, nullptr, "N V1 V2"};
  table["PARAM"].convert = convert_param;
  write_by(table, write_eigen_methods, {"EIGRL", "EIGR"});
  write_as(table, "EIGR", {"EIGB"});
  write_by(table, write_params, {"PARAM"});
}

}  // namespace bough::nastran::detail
