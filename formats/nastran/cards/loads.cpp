#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/shared_fields.hpp"

namespace bough::nastran::detail {
namespace {

void demand_direction(Card& card, double size, const Eigen::Vector3d& n, int i) {
  if (card.is_ok() && size != 0 && n.isZero(0.0))
    card.fail("deck.field-range", i, "N1 N2 N3 are all zero", "give the direction");
}

void parse_point_load(Card& card, Reading& r, bool is_moment) {
  records::PointLoad load;
  load.is_moment = is_moment;
  load.sid = card.read_id(0, "SID");
  load.g = card.read_id(1, "G");
  load.cid = card.read_reference(2, "CID");
  load.f = card.read_real(3, is_moment ? "M" : "F", 0.0);
  load.n = card.read_vector(4, "N1 N2 N3");
  load.at = card.get_location();
  demand_direction(card, load.f, load.n, 4);
  if (card.is_ok()) r.deck.point_loads.push_back(load);
}
void parse_force(Card& card, Reading& r) { parse_point_load(card, r, false); }
void parse_moment(Card& card, Reading& r) { parse_point_load(card, r, true); }

void parse_grav(Card& card, Reading& r) {
  records::Gravity g;
  read_acceleration(card, g);
  if (card.read_int(6, "MB", 0) == -1 && g.cid > 0)
    card.fail("deck.field-range", 6,
              "MB = -1: coordinate system " + std::to_string(g.cid) + " of the main bulk data is not read in a section",
              "give the direction in the basic system, or the system in the section with MB blank");
  g.at = card.get_location();
  demand_direction(card, g.a, g.n, 3);
  if (card.is_ok()) r.deck.gravity.push_back(g);
}

void parse_load(Card& card, Reading& r) {
  records::LoadCombination load;
  load.sid = card.read_id(0, "SID");
  load.s = card.read_real(1, "S");
  load.terms = read_load_terms(card, load.sid);
  load.at = card.get_location();
  if (r.claim(IdSpace::Load, load.sid, card)) r.deck.loads.push_back(std::move(load));
}

void write_point_loads(const records::Deck& deck, CardSink& sink) {
  for (const auto& load : deck.point_loads)
    sink.put(CardFields(load.is_moment ? "MOMENT" : "FORCE")
                 .add(load.sid)
                 .add(load.g)
                 .add_id(load.cid)
                 .add(load.f)
                 .add(load.n));
}

void write_gravity(const records::Deck& deck, CardSink& sink) {
  for (const auto& g : deck.gravity) sink.put(CardFields("GRAV").add(g.sid).add_id(g.cid).add(g.a).add(g.n));
}

void write_load_sets(const records::Deck& deck, CardSink& sink) {
  for (const auto& load : deck.loads) {
    CardFields card("LOAD");
    card.add(load.sid).add(load.s);
    for (const auto& [scale, set] : load.terms) card.add(scale).add(set);
    sink.put(card);
  }
}

}  // namespace

std::vector<std::pair<double, int>> read_load_terms(Card& card, int sum) {
  std::vector<std::pair<double, int>> terms;
  for (int i = 2; i < card.get_size(); i += 2) {
    if (card.is_blank(i, i + 2)) continue;
    const double scale = card.read_real(i, "Si");
    terms.emplace_back(scale, card.read_id(i + 1, "Li"));
    if (terms.back().second == sum && card.is_ok())
      card.fail("deck.field-range", i + 1, "set " + std::to_string(sum) + " contains itself");
  }
  if (terms.empty() && card.is_ok()) card.fail("deck.missing-field", 2, "S1 L1 are blank, expected a set at least");
  return terms;
}

void add_load_parsers(ParserTable& table) {
  table["FORCE"] = {parse_force, ". . . F", "SID G CID F N1 N2 N3"};
  table["MOMENT"] = {parse_moment, ". . . Q", "SID G CID M N1 N2 N3"};
  table["GRAV"] = {parse_grav, ". . G", "SID CID A N1 N2 N3 MB"};
  write_by(table, write_point_loads, {"FORCE", "MOMENT"});
  write_by(table, write_gravity, {"GRAV"});
}

void add_load_set_parsers(ParserTable& table) {
  table["LOAD"] = {parse_load, "", "SID S S1 L1 S2 L2 S3 L3"};
  write_by(table, write_load_sets, {"LOAD"});
}

}  // namespace bough::nastran::detail
