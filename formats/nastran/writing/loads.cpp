#include "formats/nastran/detail/card_sink.hpp"

namespace bough::nastran::detail {
namespace {

using records::ElementPressure;

void add_optional(CardFields& card, const std::optional<double>& value) {
  if (value)
    card.add(*value);
  else
    card.add_blank();
}

void write_beam_load(const records::BeamLoad& load, CardSink& sink) {
  std::string type{load.is_moment ? 'M' : 'F', static_cast<char>('X' + load.axis)};
  if (load.in_element_axes) type += 'E';
  std::string scale = load.is_fraction ? "FR" : "LE";
  if (load.is_projected) scale += "PR";
  CardFields card("PLOAD1");
  card.add(load.sid).add(load.element).add_word(type).add_word(scale).add(load.x1).add(load.p1);
  add_optional(card, load.x2);
  sink.put(card.add(load.p2));
}

/// Equal but for the element, which is the next one.
bool follows(const ElementPressure& a, const ElementPressure& b) {
  return b.skip_if_missing && b.element == a.element + 1 && b.sid == a.sid && b.p == a.p && b.cid == a.cid &&
         b.n == a.n;
}

/// PLOAD2 and PLOAD4 are one record; ranges become ranges again.
void write_pressures(const std::vector<ElementPressure>& loads, CardSink& sink) {
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const auto& load = loads[i];
    CardFields card("PLOAD4");
    card.add(load.sid).add(load.element);
    for (const double p : load.p) card.add(p);
    if (load.skip_if_missing) {
      while (i + 1 < loads.size() && follows(loads[i], loads[i + 1])) ++i;
      card.add_word("THRU").add(loads[i].element);
    } else {
      card.add_id(load.g1).add_id(load.g34);
    }
    card.add_id(load.cid);
    if (load.n) card.add(*load.n);
    sink.put(card);
  }
}

void write_other_loads(const records::LoadCards& loads, CardSink& sink) {
  for (const auto& load : loads.directed) {
    CardFields card(std::string(load.is_moment ? "MOMENT" : "FORCE") + (load.is_cross ? "2" : "1"));
    card.add(load.sid).add(load.g).add(load.f);
    for (const int grid : load.grids) card.add_id(grid);
    sink.put(card);
  }
  for (const auto& load : loads.beams) write_beam_load(load, sink);
  for (const auto& load : loads.grid_pressures) {
    CardFields card("PLOAD");
    card.add(load.sid).add(load.p);
    for (const int grid : load.grids) card.add(grid);
    sink.put(card);
  }
  write_pressures(loads.pressures, sink);
  for (const auto& load : loads.rotations)
    sink.put(CardFields("RFORCE").add(load.sid).add(load.g).add_id(load.cid).add(load.a).add(load.r).add_blank().add(
        load.racc));
  for (const auto& load : loads.spcd)
    sink.put(CardFields("SPCD").add(load.sid).add(load.g).add_components(load.c).add(load.d));
  for (const auto& load : loads.scalar) sink.put(CardFields("SLOAD").add(load.sid).add(load.point).add(load.f));
}

}  // namespace

void write_loads(const records::Deck& deck, CardSink& sink) {
  for (const auto& load : deck.point_loads)
    sink.put(CardFields(load.is_moment ? "MOMENT" : "FORCE")
                 .add(load.sid)
                 .add(load.g)
                 .add_id(load.cid)
                 .add(load.f)
                 .add(load.n));
  for (const auto& g : deck.gravity) sink.put(CardFields("GRAV").add(g.sid).add_id(g.cid).add(g.a).add(g.n));
  write_other_loads(deck.load_cards, sink);
  for (const auto& load : deck.loads) {
    CardFields card("LOAD");
    card.add(load.sid).add(load.s);
    for (const auto& [scale, set] : load.terms) card.add(scale).add(set);
    sink.put(card);
  }
}

void write_solution(const records::Deck& deck, CardSink& sink) {
  for (const auto& m : deck.eigen_methods) {
    CardFields card(m.is_eigrl ? "EIGRL" : "EIGR");
    card.add(m.sid);
    if (!m.is_eigrl) card.add_word(m.method);
    add_optional(card, m.f1);
    add_optional(card, m.f2);
    if (m.is_eigrl) {
      sink.put(card.add_id(m.num_modes).add_blank(3).add_word(m.norm));
      continue;
    }
    card.add_blank().add_id(m.num_modes).end_line().add_word(m.norm);
    sink.put(card.add_id(m.norm_grid).add_id(m.norm_component));
  }
  const auto put = [&](const records::Param& p) {
    CardFields card("PARAM");
    card.add_word(p.name);
    if (!p.value.empty()) card.add_word(p.value);
    sink.put(card);
  };
  for (const auto& p : deck.params)
    if (!deck.autospc_command || p.name != "AUTOSPC") put(p);
  if (deck.autospc_command) put(*deck.autospc_command);
}

}  // namespace bough::nastran::detail
