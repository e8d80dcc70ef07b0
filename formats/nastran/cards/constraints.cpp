#include <bit>

#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/rigid_expansion.hpp"
#include "formats/nastran/detail/shared_fields.hpp"

namespace bough::nastran::detail {
namespace {

bool is_real(const Card& card, int i) { return !card.is_integer(i) && card.get(i).find('.') != std::string_view::npos; }

/// EID GN CM GM..., then perhaps ALPHA (thermal expansion) and TREF, reals.
void parse_rbe2(Card& card, Reading& r) {
  records::Rbe2 e;
  e.id = card.read_id(0, "EID");
  e.gn = card.read_id(1, "GN");
  e.cm = card.read_components(2, "CM");
  int last = card.get_size();
  double alpha = 0;
  for (int count = 0; count < 2 && last > 4 && is_real(card, last - 1); ++count)
    alpha = card.read_real(--last, "ALPHA TREF");
  note_expansion(card, r, alpha);
  add_rbe2(card, r, std::move(e), 3, last, "GM", "GM");
}

/// EID, blank, REFGRID, REFC, then groups WT C G1 G2 ..., then UM with pairs G C, then ALPHA with a value.
void parse_rbe3(Card& card, Reading& r) {
  records::Rbe3 e;
  e.id = card.read_id(0, "EID");
  e.ref_grid = card.read_id(2, "REFGRID");
  e.ref_c = card.read_components(3, "REFC", 0b111111);
  const int size = card.get_size();
  int i = 4;
  while (i < size && !card.is_word(i, "UM") && !card.is_word(i, "ALPHA")) {
    if (card.is_blank(i)) {
      ++i;
      continue;
    }
    records::Rbe3::Group group;
    group.weight = card.read_real(i, "WT");
    group.c = card.read_components(i + 1, "C");
    const int first = i += 2;
    // Grids up to the next weight: a real number.
    while (i < size && !card.is_word(i, "UM") && !card.is_word(i, "ALPHA") &&
           (card.is_blank(i) || card.is_integer(i) || card.is_word(i, "THRU") || card.is_word(i, "BY") ||
            card.is_word(i, "EXCEPT")))
      ++i;
    group.grids = read_ids(card, first, i, "G");
    if (group.grids.empty() && card.is_ok())
      card.fail("deck.missing-field", first, "a weight without grids, expected one at least");
    if (!card.is_ok()) return;
    e.groups.push_back(std::move(group));
  }
  if (card.is_word(i, "UM"))
    for (card.use(i++); i < size && !card.is_word(i, "ALPHA");) {
      if (card.is_blank(i)) {
        ++i;
        continue;
      }
      const int g = card.read_id(i, "GM");
      e.um.push_back({g, card.read_components(i + 1, "CM")});
      i += 2;
    }
  if (card.is_word(i, "ALPHA")) {
    card.use(i);
    note_expansion(card, r, card.read_real(i + 1, "ALPHA"));
    card.use(i + 2);  // TREF
  }
  if (e.groups.empty() && card.is_ok()) card.fail("deck.missing-field", 4, "WT1 is blank, expected a weight and grids");
  e.at = card.get_location();
  if (r.claim_rigid(e.id, card)) r.deck.rbe3.push_back(std::move(e));
}

/// EID, pairs GN CN (three per line), UM (CRIGD3: MSET) with pairs GM CM, then ALPHA and TREF, reals.
void parse_rbe1(Card& card, Reading& r) {
  records::Rbe1 e;
  e.id = card.read_id(0, "EID");
  e.at = card.get_location();
  const int size = card.get_size();
  bool has_um = false, has_alpha = false;
  for (int i = 1; i < size;) {
    if (card.is_blank(i)) {
      ++i;
    } else if ((card.is_word(i, "UM") || card.is_word(i, "MSET")) && !has_um) {
      has_um = true;
      card.use(i++);
    } else if (i >= size - 2 && is_real(card, i)) {
      const double value = card.read_real(i++, "ALPHA TREF");
      if (!has_alpha) note_expansion(card, r, value);
      has_alpha = true;
    } else {
      const int g = card.read_id(i, has_um ? "GM" : "GN");
      (has_um ? e.dependent : e.independent).push_back({g, card.read_components(i + 1, has_um ? "CM" : "CN"), e.at});
      i += 2;
    }
  }
  int num_independent = 0;
  for (const auto& term : e.independent) num_independent += std::popcount(term.c);
  if (card.is_ok() && num_independent != 6)
    card.fail("deck.field-range", 1, "CN has " + std::to_string(num_independent) + " components, expected six in all",
              "choose six that hold a rigid body");
  if (card.is_ok() && e.dependent.empty())
    card.fail("deck.missing-field", 8, "UM is blank, expected a dependent grid at least");
  if (r.claim_rigid(e.id, card)) r.deck.rbe1.push_back(std::move(e));
}

void parse_rrod(Card& card, Reading& r) {
  records::Rrod e;
  card.read_ids(0, {{"EID", e.id}, {"GA", e.ga}, {"GB", e.gb}});
  e.cma = card.read_component(3, "CMA");
  e.cmb = card.read_component(4, "CMB");
  note_expansion(card, r, card.read_real(5, "ALPHA", 0.0));
  card.use(6);  // TREF
  if (card.is_ok() && ((e.cma == 0) == (e.cmb == 0) || e.cma > 3 || e.cmb > 3))
    card.fail("deck.field-range", 3,
              "CMA and CMB name " + std::to_string(e.cma) + " and " + std::to_string(e.cmb) +
                  ", expected one translation 1 to 3 in one of them");
  e.at = card.get_location();
  if (r.claim_rigid(e.id, card)) r.deck.rrod.push_back(e);
}

/// Blank CMA and CMB: every component that is not independent depends.
void parse_rbar(Card& card, Reading& r) {
  constexpr unsigned all = 63;
  records::Rbar e;
  card.read_ids(0, {{"EID", e.id}, {"GA", e.ga}, {"GB", e.gb}});
  e.cna = card.read_components(3, "CNA", 0);
  e.cnb = card.read_components(4, "CNB", 0);
  e.cma = card.read_components(5, "CMA", 0);
  e.cmb = card.read_components(6, "CMB", 0);
  note_expansion(card, r, card.read_real(7, "ALPHA", 0.0));
  card.use(8);  // TREF
  if (e.cna == 0 && e.cnb == 0) e.cna = all;
  const int num = std::popcount(e.cna) + std::popcount(e.cnb);
  // Fewer than six on one grid alone: the model completes them.
  if (card.is_ok() && (num > 6 || (num < 6 && e.cna != 0 && e.cnb != 0)))
    card.fail("deck.field-range", 3, "CNA and CNB have " + std::to_string(num) + " components, expected six in all",
              "for a rigid bar write CNA = 123456");
  if (num == 6 && e.cma == 0 && e.cmb == 0) {
    e.cma = all & ~e.cna;
    e.cmb = all & ~e.cnb;
  }
  if (card.is_ok() && ((e.cna & e.cma) != 0 || (e.cnb & e.cmb) != 0))
    card.fail("deck.field-range", 5, "a component is both independent and dependent", "leave CMA and CMB blank");
  e.at = card.get_location();
  if (r.claim_rigid(e.id, card)) r.deck.rbar.push_back(e);
}

void parse_spc(Card& card, Reading& r) { parse_motions(card, r.deck.spc); }

void parse_spc1(Card& card, Reading& r) {
  const int sid = card.read_id(0, "SID");
  read_components_of_ids(card, 1, "G", [&](unsigned c, const auto& range) {
    if (range.is_thru)
      r.spc_ranges.push_back({sid, c, range, card.get_location()});
    else
      r.deck.spc.push_back({sid, range.first, c, 0.0, false, card.get_location()});
  });
}

void parse_union(Card& card, Reading& r, IdSpace space, std::vector<records::SetUnion>& unions) {
  records::SetUnion u;
  u.sid = card.read_id(0, "SID");
  u.sets = read_ids(card, 1, card.get_size(), "S");
  if (u.sets.empty() && card.is_ok()) card.fail("deck.missing-field", 1, "S1 is blank, expected a set at least");
  for (const int set : u.sets)
    if (set == u.sid) card.fail("deck.field-range", 1, "set " + std::to_string(set) + " contains itself");
  u.at = card.get_location();
  if (r.claim(space, u.sid, card)) unions.push_back(std::move(u));
}
void parse_spcadd(Card& card, Reading& r) { parse_union(card, r, IdSpace::SpcAdd, r.deck.spcadd); }
void parse_mpcadd(Card& card, Reading& r) { parse_union(card, r, IdSpace::MpcAdd, r.deck.mpcadd); }

/// Terms G C A, two per line; the first line begins with SID, the others with a blank, all end with a blank.
void parse_mpc(Card& card, Reading& r) {
  records::Mpc mpc;
  mpc.sid = card.read_id(0, "SID");
  for (int line = 0; line < card.get_size(); line += 8)
    for (const int i : {line + 1, line + 4}) {
      if (card.is_blank(i, i + 3)) continue;
      mpc.terms.push_back({card.read_id(i, "G"), card.read_component(i + 1, "C"), card.read_real(i + 2, "A", 0.0)});
    }
  if (mpc.terms.empty())
    card.fail("deck.missing-field", 1, "the equation has no term");
  else if (card.is_ok() && mpc.terms.front().a == 0)
    card.fail("deck.field-range", 3, "the coefficient of the dependent component is zero",
              "give the first term a coefficient");
  mpc.at = card.get_location();
  if (card.is_ok()) r.deck.mpc.push_back(std::move(mpc));
}

using records::Spc;

void write_rbe3(const records::Rbe3& e, CardSink& sink) {
  CardFields card("RBE3");
  card.add(e.id).add_blank().add(e.ref_grid).add_components(e.ref_c);
  for (const auto& group : e.groups) {
    card.add(group.weight).add_components(group.c);
    for (const int grid : group.grids) card.add(grid);
  }
  if (!e.um.empty()) {
    card.end_line().add_word("UM");
    for (std::size_t i = 0; i < e.um.size(); ++i) {
      if (i > 0 && i % 3 == 0) card.end_line().add_blank();
      card.add(e.um[i].g).add_components(e.um[i].c);
    }
  }
  sink.put(card);
}

/// Three pairs on each line, whose first field is blank or UM.
void add_pairs(const std::vector<records::GridComponents>& terms, CardFields& card) {
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (i > 0 && i % 3 == 0) card.end_line().add_blank();
    card.add(terms[i].g).add_components(terms[i].c);
  }
}

void write_rbe1(const records::Rbe1& e, CardSink& sink) {
  CardFields card("RBE1");
  card.add(e.id);
  add_pairs(e.independent, card);
  card.end_line().add_word("UM");
  add_pairs(e.dependent, card);
  sink.put(card);
}

std::vector<int> collect_ids(const records::Deck& deck) {
  std::vector<int> ids = deck.scalar_points;
  for (const auto& grid : deck.grids) ids.push_back(grid.id);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

/// The run of records from `first` that one SPC1 can hold.
std::size_t find_run_end(const std::vector<Spc>& spc, std::size_t first) {
  std::size_t end = first + 1;
  const auto& a = spc[first];
  while (end < spc.size() && spc[end].sid == a.sid && spc[end].c == a.c && spc[end].d == 0 &&
         spc[end].skip_if_missing == a.skip_if_missing && (!a.skip_if_missing || spc[end].g > spc[end - 1].g))
    ++end;
  return end;
}

void write_spc(const records::Deck& deck, CardSink& sink) {
  const auto ids = collect_ids(deck);
  const auto find = [&](int id) { return std::lower_bound(ids.begin(), ids.end(), id); };
  for (std::size_t i = 0; i < deck.spc.size();) {
    const auto& first = deck.spc[i];
    if (first.d != 0) {
      sink.put(CardFields("SPC").add(first.sid).add(first.g).add_components(first.c).add(first.d));
      ++i;
      continue;
    }
    const std::size_t end = find_run_end(deck.spc, i);
    CardFields card("SPC1");
    card.add(first.sid).add_components(first.c);
    if (first.skip_if_missing) {
      // THRU again, as far as the ids between are all meant.
      std::size_t last = i;
      for (auto id = find(first.g); id != ids.end() && last < end && *id == deck.spc[last].g; ++id) ++last;
      if (last - i > 1) {
        sink.put(card.add(first.g).add_word("THRU").add(deck.spc[last - 1].g));
        i = last;
        continue;
      }
      sink.put(card.add(first.g));
      ++i;
      continue;
    }
    for (; i < end; ++i) card.add(deck.spc[i].g);
    sink.put(card);
  }
}

void write_mpc(const records::Mpc& mpc, CardSink& sink) {
  CardFields card("MPC");
  card.add(mpc.sid);
  for (std::size_t i = 0; i < mpc.terms.size(); ++i) {
    if (i > 0 && i % 2 == 0) card.end_line().add_blank();
    card.add(mpc.terms[i].g).add_id(mpc.terms[i].c).add(mpc.terms[i].a);
  }
  sink.put(card);
}

void write_unions(const char* name, const std::vector<records::SetUnion>& unions, CardSink& sink) {
  for (const auto& u : unions) {
    CardFields card(name);
    card.add(u.sid);
    for (const int set : u.sets) card.add(set);
    sink.put(card);
  }
}

void write_rbe2(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.rbe2) {
    CardFields card("RBE2");
    card.add(e.id).add(e.gn).add_components(e.cm);
    for (const int grid : e.gm) card.add(grid);
    sink.put(card);
  }
}

void write_rbe1s(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.rbe1) write_rbe1(e, sink);
}

void write_rbe3s(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.rbe3) write_rbe3(e, sink);
}

void write_rbar(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.rbar) {
    CardFields card("RBAR");
    card.add(e.id).add(e.ga).add(e.gb).add_components(e.cna).add_components(e.cnb);
    sink.put(card.add_components(e.cma).add_components(e.cmb));
  }
}

void write_rrod(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.rrod)
    sink.put(CardFields("RROD").add(e.id).add(e.ga).add(e.gb).add_id(e.cma).add_id(e.cmb));
}

void write_spcadd(const records::Deck& deck, CardSink& sink) { write_unions("SPCADD", deck.spcadd, sink); }

void write_mpcs(const records::Deck& deck, CardSink& sink) {
  for (const auto& mpc : deck.mpc) write_mpc(mpc, sink);
}

void write_mpcadd(const records::Deck& deck, CardSink& sink) { write_unions("MPCADD", deck.mpcadd, sink); }

void convert_spc(UnitConverter& u) {
  for (const int first : {1, 4}) u.scale_by(u.find_components(first + 1), first + 2, "L", ".", "?");
}
/// Sum of a u = 0 with u in the new unit of length: the factors of rotations grow by it.
void convert_mpc(UnitConverter& u) {
  for (int line = 0; line < u.size(); line += 8)
    for (const int first : {line + 1, line + 4})
      if (!u.get(first).empty()) u.scale_by(u.find_components(first + 1), first + 2, ".", "L", "?");
}

}  // namespace

void add_rbe2(Card& card, Reading& r, records::Rbe2&& e, int first, int last, const char* what,
              const char* first_name) {
  e.gm = read_ids(card, first, last, what);
  if (e.gm.empty() && card.is_ok())
    card.fail("deck.missing-field", first, std::string(first_name) + " is blank, expected a dependent grid at least");
  e.at = card.get_location();
  if (r.claim_rigid(e.id, card)) r.deck.rbe2.push_back(std::move(e));
}

void add_constraint_parsers(ParserTable& table) {
  add_plain_cards(table, {{"RBE1", parse_rbe1},
                          {"RBE2", parse_rbe2},
                          {"RBE3", parse_rbe3},
                          {"RROD", parse_rrod},
                          {"RBAR", parse_rbar},
                          {"SPC1", parse_spc1},
                          {"SPCADD", parse_spcadd},
                          {"MPCADD", parse_mpcadd}});
  table["SPC"] = {parse_spc, nullptr, "SID G1 C1 D1 G2 C2 D2"};
  table["MPC"] = {parse_mpc, nullptr};
  // The names of NASTRAN-95, with the same fields.
  for (const auto& [other, card] : std::initializer_list<std::pair<const char*, const char*>>{{"CRBE1", "RBE1"},
                                                                                              {"CRIGD3", "RBE1"},
                                                                                              {"CRBE2", "RBE2"},
                                                                                              {"CRBE3", "RBE3"},
                                                                                              {"CRROD", "RROD"},
                                                                                              {"CRBAR", "RBAR"}})
    table[other] = table[card];
  table["SPC"].convert = convert_spc;
  table["MPC"].convert = convert_mpc;
  write_by(
      table,
      {{"RBE2", write_rbe2}, {"RBE1", write_rbe1s}, {"RBE3", write_rbe3s}, {"RBAR", write_rbar}, {"RROD", write_rrod}});
  write_by(table, write_spc, {"SPC", "SPC1"});
  write_by(table, {{"SPCADD", write_spcadd}, {"MPC", write_mpcs}, {"MPCADD", write_mpcadd}});
  write_as(table, "RBE1", {"CRBE1", "CRIGD3"});
  write_as(table, "RBE2", {"CRBE2"});
  write_as(table, "RBE3", {"CRBE3"});
  write_as(table, "RROD", {"CRROD"});
  write_as(table, "RBAR", {"CRBAR"});
}

}  // namespace bough::nastran::detail
