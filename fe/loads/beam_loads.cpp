#include <algorithm>
#include <cmath>

#include "fe/elements/beam.hpp"
#include "fe/loads/load_sets.hpp"

namespace bough::fe {
namespace {

/// The load of one card on its beam, in element axes.
BeamLineLoad make_line_load(const LoadTarget& t, const records::BeamLoad& card, const Beam& beam) {
  const double length = beam.geometry().length, unit = card.is_fraction ? length : 1;
  BeamLineLoad load;
  load.x1 = card.x1 * unit;
  load.x2 = card.x2.value_or(card.x1) * unit;
  load.is_point = load.x2 == load.x1;
  const Vector3d direction = card.in_element_axes
                                 ? Vector3d(Vector3d::Unit(card.axis))
                                 : Vector3d(beam.geometry().R_basic_element.transpose() * Vector3d::Unit(card.axis));
  // Length seen along the load: the sine of the angle between the load and the axis.
  const double projection =
      card.is_projected && !card.in_element_axes && !load.is_point ? std::hypot(direction[1], direction[2]) : 1;
  const int first = card.is_moment ? 3 : 0;
  load.p1.segment<3>(first) = card.p1 * projection * direction;
  load.p2.segment<3>(first) = card.p2 * projection * direction;
  if (load.x2 > length * (1 + 1e-9))
    t.diagnostics.error("fe.load-off-beam", t.deck.locate(card.at),
                        "PLOAD1 on element " + std::to_string(card.element) + " ends at " + std::to_string(load.x2) +
                            ", beyond its length " + std::to_string(length),
                        "correct X1, X2 or SCALE");
  return load;
}

/// Calls visit(index of the element, beam, load) for every PLOAD1 of the set.
template <class Visit>
bool for_each_beam_load(const LoadTarget& t, const Visit& visit) {
  const auto& cards = t.deck.load_cards.beams;
  const auto is_here = [&](const auto& load) { return load.sid == t.set; };
  if (std::none_of(cards.begin(), cards.end(), is_here)) return false;
  std::unordered_map<int, int> beams;
  for (std::size_t e = 0; e < t.model.elements().size(); ++e)
    if (t.model.elements()[e]->as_beam()) beams[t.model.elements()[e]->id()] = static_cast<int>(e);
  for (const auto& card : cards) {
    if (!is_here(card)) continue;
    const auto found = beams.find(card.element);
    if (found == beams.end()) {
      const auto& all = t.model.elements();
      const auto other = std::find_if(all.begin(), all.end(), [&](auto& e) { return e->id() == card.element; });
      if (other == all.end())
        t.diagnostics.error("fe.missing-element", t.deck.locate(card.at),
                            "PLOAD1 on element " + std::to_string(card.element) + ": no CBAR or CBEAM has this id",
                            "correct the element id");
      else
        t.diagnostics.error("fe.missing-element", t.deck.locate(card.at),
                            "PLOAD1 on element " + std::to_string(card.element) + ", a " + (*other)->card() +
                                ": PLOAD1 is supported on CBAR and CBEAM alone",
                            "give the load by FORCE and MOMENT at the grids of the element");
      continue;
    }
    const auto& beam = *t.model.elements()[static_cast<std::size_t>(found->second)]->as_beam();
    visit(found->second, beam, make_line_load(t, card, beam));
  }
  return true;
}

}  // namespace

bool add_beam_loads(const LoadTarget& t) {
  return for_each_beam_load(t, [&](int, const Beam& beam, const BeamLineLoad& load) {
    const auto end_load = beam.calc_end_load(load);
    const VectorXd f = beam.calc_grid_load(end_load);
    for (int k = 0; k < 2; ++k) {
      const Vector3d& arm = k == 0 ? beam.geometry().wa : beam.geometry().wb;
      if (!arm.isZero(0))
        t.arms.push_back({beam.gdofs()[static_cast<std::size_t>(6 * k + 3)], arm, t.scale * f.segment<3>(6 * k)});
    }
    for (int i = 0; i < 12; ++i) t.F[beam.gdofs()[static_cast<std::size_t>(i)]] += t.scale * f[i];
  });
}

std::unordered_map<int, VectorXd> calc_beam_end_loads(const Model& model, const records::Deck& deck, int set,
                                                      Diagnostics& diagnostics) {
  std::unordered_map<int, VectorXd> result;
  AppliedLoad unused;
  for_each_plain_set(deck, set, [&](int sid, double scale, const records::CardLocation&) {
    const LoadTarget target{model, deck, sid, scale, unused.F, diagnostics, unused.A_I, unused.arms, unused.followers};
    for_each_beam_load(target, [&](int index, const Beam& beam, const BeamLineLoad& load) {
      VectorXd& f = result.try_emplace(index, VectorXd::Zero(12)).first->second;
      f += scale * beam.calc_end_load(load);
    });
  });
  return result;
}

}  // namespace bough::fe
