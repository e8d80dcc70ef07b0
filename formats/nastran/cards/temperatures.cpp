#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

/// SID G1 T1 G2 T2 G3 T3.
void parse_temp(Card& card, Reading& r) {
  const int sid = card.read_id(0, "SID");
  if (card.is_blank(1) && card.is_ok()) card.fail("deck.missing-field", 1, "G1 is blank, expected a grid");
  for (int i = 1; i < 7; i += 2)
    if (!card.is_blank(i, i + 2))
      r.deck.temperatures.grids.push_back(
          {sid, card.read_id(i, "Gi"), card.read_real(i + 1, "Ti", 0.0), card.get_location()});
}

/// SID1 T1 SID2 T2 ...
void parse_tempd(Card& card, Reading& r) {
  if (card.get_size() == 0) card.fail("deck.missing-field", 0, "SID is blank, expected the number of a set");
  for (int i = 0; i < card.get_size(); i += 2) {
    if (card.is_blank(i, i + 2)) continue;
    const int sid = card.read_id(i, "SID");
    const double t = card.read_real(i + 1, "T", 0.0);
    for (const auto& other : r.deck.temperatures.defaults)
      if (other.sid == sid && other.t != t)
        card.fail("deck.duplicate-id", i, "set " + std::to_string(sid) + " has two default temperatures",
                  "give one TEMPD for each set");
    r.deck.temperatures.defaults.push_back({sid, t, card.get_location()});
  }
}

/// A record for the element in field 1 and each of the list from field `more` on.
template <class Record>
void add_elements(Card& card, Record record, int more, std::vector<Record>& list) {
  record.element = card.read_id(1, "EID1");
  record.at = card.get_location();
  list.push_back(record);
  for (const int id : read_ids(card, more, card.get_size(), "EIDi")) {
    record.element = id;
    list.push_back(record);
  }
}

/// SID EID1 TA TB TP1A TP1B TP2A TP2B, eight temperatures for stress recovery, EID2 ...
void parse_temprb(Card& card, Reading& r) {
  records::BarTemperature t;
  t.sid = card.read_id(0, "SID");
  t.t_a = card.read_real(2, "TA", 0.0);
  t.t_b = card.read_real(3, "TB", 0.0);
  t.gradient_a = {card.read_real(4, "TP1A", 0.0), card.read_real(6, "TP2A", 0.0)};
  t.gradient_b = {card.read_real(5, "TP1B", 0.0), card.read_real(7, "TP2B", 0.0)};
  card.use(8, 16);  // temperatures for stress recovery
  add_elements(card, t, 16, r.deck.temperatures.bars);
}

/// SID EID1 TBAR TPRIME TS1 TS2, EID2 ... The surfaces' own temperatures are for stress recovery.
void parse_tempp1(Card& card, Reading& r) {
  records::PlateTemperature t;
  t.sid = card.read_id(0, "SID");
  t.t = card.read_real(2, "TBAR", 0.0);
  t.gradient = card.read_real(3, "TPRIME", 0.0);
  card.use(4, 8);  // TS1, TS2
  add_elements(card, t, 8, r.deck.temperatures.plates);
}

void write_temp(const records::Deck& deck, CardSink& sink) {
  for (const auto& grid : deck.temperatures.grids) sink.put(CardFields("TEMP").add(grid.sid).add(grid.g).add(grid.t));
}

void write_tempd(const records::Deck& deck, CardSink& sink) {
  for (const auto& all : deck.temperatures.defaults) sink.put(CardFields("TEMPD").add(all.sid).add(all.t));
}

void write_temprb(const records::Deck& deck, CardSink& sink) {
  for (const auto& bar : deck.temperatures.bars) {
    CardFields card("TEMPRB");
    card.add(bar.sid).add(bar.element).add(bar.t_a).add(bar.t_b);
    for (int i = 0; i < 2; ++i) card.add(bar.gradient_a[i]).add(bar.gradient_b[i]);
    sink.put(card);
  }
}

void write_tempp1(const records::Deck& deck, CardSink& sink) {
  for (const auto& plate : deck.temperatures.plates)
    sink.put(CardFields("TEMPP1").add(plate.sid).add(plate.element).add(plate.t).add(plate.gradient));
}

}  // namespace

void add_temperature_parsers(ParserTable& table) {
  table["TEMP"] = {parse_temp, ""};
  table["TEMPD"] = {parse_tempd, ""};
  table["TEMPRB"] = {parse_temprb, ". . . . 1/L 1/L 1/L 1/L"};
  table["TEMPP1"] = {parse_tempp1, ". . . 1/L"};
  write_by(table, {{"TEMP", write_temp}, {"TEMPD", write_tempd}, {"TEMPRB", write_temprb}, {"TEMPP1", write_tempp1}});
}

}  // namespace bough::nastran::detail
