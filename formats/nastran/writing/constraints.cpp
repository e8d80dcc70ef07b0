#include <algorithm>

#include "formats/nastran/detail/card_sink.hpp"

namespace bough::nastran::detail {
namespace {

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

}  // namespace

void write_constraints(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.rbe2) {
    CardFields card("RBE2");
    card.add(e.id).add(e.gn).add_components(e.cm);
    for (const int grid : e.gm) card.add(grid);
    sink.put(card);
  }
  for (const auto& e : deck.rbe1) write_rbe1(e, sink);
  for (const auto& e : deck.rbe3) write_rbe3(e, sink);
  for (const auto& e : deck.rbar) {
    CardFields card("RBAR");
    card.add(e.id).add(e.ga).add(e.gb).add_components(e.cna).add_components(e.cnb);
    sink.put(card.add_components(e.cma).add_components(e.cmb));
  }
  for (const auto& e : deck.rrod)
    sink.put(CardFields("RROD").add(e.id).add(e.ga).add(e.gb).add_id(e.cma).add_id(e.cmb));
  write_spc(deck, sink);
  write_unions("SPCADD", deck.spcadd, sink);
  for (const auto& mpc : deck.mpc) write_mpc(mpc, sink);
  write_unions("MPCADD", deck.mpcadd, sink);
}

}  // namespace bough::nastran::detail
