#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/shared_fields.hpp"

namespace bough::nastran::detail {
namespace {

struct Orientation {
  int g0 = 0;
  std::optional<Eigen::Vector3d> v;
};

/// Fields i..i+2: an integer alone is the grid G0, otherwise X1 X2 X3. `flag` is the old integer in the OFFT field: 1
/// says vector, 2 says grid. Nothing when all three are blank.
Orientation read_orientation(Card& card, int i, int flag = 0) {
  Orientation orientation;
  if (card.is_blank(i, i + 3)) return orientation;
  if (card.is_integer(i) && card.is_blank(i + 1, i + 3) && flag != 1) {
    orientation.g0 = card.read_id(i, "G0");
  } else {
    orientation.v = card.read_vector(i, "X1 X2 X3");
    if (orientation.v->isZero(0.0) && card.is_ok())
      card.fail("deck.field-range", i, "the orientation vector is zero", "give a vector that is not along the element");
  }
  return orientation;
}

/// Field 9: offset frames such as GGO, or the flag 1 or 2 of older decks. O and E both mean the element's frame.
std::string read_offt(Card& card, int i, const std::string& fallback, int& flag) {
  flag = 0;
  if (card.is_blank(i)) return fallback;
  auto offt = card.get_upper(i);
  if (offt == "1" || offt == "2") {
    flag = offt[0] - '0';
    return fallback;
  }
  const auto is_one_of = [&](std::size_t k, std::string_view letters) {
    return letters.find(offt[k]) != std::string_view::npos;
  };
  if (offt.size() != 3 || !is_one_of(0, "GB") || !is_one_of(1, "GOE") || !is_one_of(2, "GOE")) {
    card.fail("deck.bad-word", i,
              "OFFT is '" + std::string(card.get(i)) + "', expected three letters such as GGG, BGG or GOO");
    return fallback;
  }
  for (char& c : offt)
    if (c == 'E') c = 'O';
  return offt;
}

unsigned read_pins(Card& card, int i, const char* what) {
  const unsigned pins = card.read_components(i, what, 0);
  if (pins == 63u) card.fail("deck.field-range", i, std::string(what) + " releases all six components of one end");
  return pins;
}

void parse_beam(Card& card, Reading& r, bool is_cbeam) {
  const auto& defaults = is_cbeam ? r.beam_defaults : r.bar_defaults;
  records::BeamElement e;
  e.is_cbeam = is_cbeam;
  e.id = card.read_id(0, "EID");
  e.pid = card.read_id(1, "PID", defaults.pid > 0 ? defaults.pid : e.id);
  e.ga = card.read_id(2, "GA");
  e.gb = card.read_id(3, "GB");
  int flag = 0;
  e.offt = read_offt(card, 7, defaults.offt, flag);
  auto orientation = read_orientation(card, 4, flag);
  if (orientation.g0 == 0 && !orientation.v) orientation = {defaults.g0, defaults.v};
  e.g0 = orientation.g0;
  if (orientation.v) e.v = *orientation.v;
  if (e.g0 == 0 && !orientation.v && card.is_ok())
    card.fail("deck.missing-field", 4, "the orientation is blank, expected G0 or X1 X2 X3",
              is_cbeam ? "give it on the card or on BEAMOR" : "give it on the card or on BAROR");
  e.pin_a = read_pins(card, 8, "PA");
  e.pin_b = read_pins(card, 9, "PB");
  e.wa = card.read_vector(10, "W1A W2A W3A");
  e.wb = card.read_vector(13, "W1B W2B W3B");
  if (is_cbeam) {
    e.sa = card.read_reference(16, "SA");
    e.sb = card.read_reference(17, "SB");
  }
  e.at = card.get_location();
  if (r.claim(IdSpace::Beam, e.id, card)) r.deck.beams.push_back(std::move(e));
}

void parse_cbar(Card& card, Reading& r) { parse_beam(card, r, false); }
void parse_cbeam(Card& card, Reading& r) { parse_beam(card, r, true); }

void parse_defaults(Card& card, BeamDefaults& defaults) {
  card.use(0);  // some decks put a word there
  defaults.pid = card.read_id(1, "PID", 0);
  int flag = 0;
  defaults.offt = read_offt(card, 7, "GGG", flag);
  const auto orientation = read_orientation(card, 4, flag);
  defaults.g0 = orientation.g0;
  defaults.v = orientation.v;
}

void parse_baror(Card& card, Reading& r) { parse_defaults(card, r.bar_defaults); }
void parse_beamor(Card& card, Reading& r) { parse_defaults(card, r.beam_defaults); }

/// EID PID G1 G2: CROD and CTUBE, one or two on a card (NASTRAN-95 User's Manual 2.4).
template <class Element, IdSpace space>
void parse_two_grids(Card& card, Reading& r, std::vector<Element>& elements) {
  read_entries(card, 4, {0, 4}, [&](int first) {
    Element e;
    card.read_ids(first, {{"EID", e.id}, {"PID", e.pid, &e.id}, {"G1", e.ga}, {"G2", e.gb}});
    e.at = card.get_location();
    if (r.claim(space, e.id, card, first, 4)) elements.push_back(e);
  });
}

void parse_crod(Card& card, Reading& r) { parse_two_grids<records::Crod, IdSpace::Rod>(card, r, r.deck.crod); }
void parse_ctube(Card& card, Reading& r) { parse_two_grids<records::Ctube, IdSpace::Tube>(card, r, r.deck.ctube); }

void parse_conrod(Card& card, Reading& r) {
  records::Conrod e;
  card.read_ids(0, {{"EID", e.id}, {"G1", e.ga}, {"G2", e.gb}, {"MID", e.mid}});
  read_rod_section(card, 4, e);
  if (r.claim(IdSpace::Conrod, e.id, card)) r.deck.conrod.push_back(e);
}

/// Two per card: EID G1 G2.
void parse_plotel(Card& card, Reading& r) {
  read_entries(card, 3, {0, 4}, [&](int first) {
    records::Plotel e;
    card.read_ids(first, {{"EID", e.id}, {"G1", e.ga}, {"G2", e.gb}});
    e.at = card.get_location();
    if (r.claim(IdSpace::Plotel, e.id, card, first, 3)) r.deck.plotel.push_back(e);
  });
}

void write_beam(const records::BeamElement& e, CardSink& sink) {
  CardFields card(e.is_cbeam ? "CBEAM" : "CBAR");
  card.add(e.id).add(e.pid).add(e.ga).add(e.gb);
  if (e.g0 != 0)
    card.add(e.g0).add_blank(2);
  else
    card.add(e.v);
  if (e.offt != "GGG")
    card.add_word(e.offt);
  else
    card.add_blank();
  card.add_components(e.pin_a).add_components(e.pin_b);
  const bool is_offset = !e.wa.isZero(0.0) || !e.wb.isZero(0.0);
  if (is_offset)
    card.add(e.wa).add(e.wb);
  else
    card.add_blank(6);
  if (e.is_cbeam) card.add_id(e.sa).add_id(e.sb);
  sink.put(card);
}

void write_beams(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.beams) write_beam(e, sink);
}

void write_crods(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.crod) sink.put(CardFields("CROD").add(e.id).add(e.pid).add(e.ga).add(e.gb));
}

void write_conrods(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.conrod)
    sink.put(CardFields("CONROD").add(e.id).add(e.ga).add(e.gb).add(e.mid).add(e.A).add(e.J).add(e.c).add(e.nsm));
}

void write_ctubes(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.ctube) sink.put(CardFields("CTUBE").add(e.id).add(e.pid).add(e.ga).add(e.gb));
}

void write_plotels(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.plotel) sink.put(CardFields("PLOTEL").add(e.id).add(e.ga).add(e.gb));
}

}  // namespace

void add_line_element_parsers(ParserTable& table) {
  table["CBAR"] = {parse_cbar, ". . . . . . . . . . L L L L L L",
                   "EID PID GA GB X1 X2 X3 OFFT PA PB W1A W2A W3A W1B W2B W3B"};
  table["CBEAM"] = {parse_cbeam, ". . . . . . . . . . L L L L L L",
                    "EID PID GA GB X1 X2 X3 OFFT PA PB W1A W2A W3A W1B W2B W3B"};
  table["BAROR"] = {parse_baror, ""};
  table["BEAMOR"] = {parse_beamor, ""};
  table["CROD"] = {parse_crod, "", "EID PID G1 G2"};
  table["CTUBE"] = {parse_ctube, "", "EID PID G1 G2"};
  table["CONROD"] = {parse_conrod, ". . . . A I L N", "EID G1 G2 MID A J C NSM"};
  table["PLOTEL"] = {parse_plotel, ""};
  write_by(table, write_beams, {"CBAR", "CBEAM"});
  write_as(table, "CBAR", {"BAROR"});
  write_as(table, "CBEAM", {"BEAMOR"});
  write_by(table,
           {{"CROD", write_crods}, {"CONROD", write_conrods}, {"CTUBE", write_ctubes}, {"PLOTEL", write_plotels}});
}

}  // namespace bough::nastran::detail
