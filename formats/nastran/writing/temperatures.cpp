#include "formats/nastran/detail/card_sink.hpp"

namespace bough::nastran::detail {

void write_temperatures(const records::Deck& deck, CardSink& sink) {
  const auto& t = deck.temperatures;
  for (const auto& grid : t.grids) sink.put(CardFields("TEMP").add(grid.sid).add(grid.g).add(grid.t));
  for (const auto& all : t.defaults) sink.put(CardFields("TEMPD").add(all.sid).add(all.t));
  for (const auto& bar : t.bars) {
    CardFields card("TEMPRB");
    card.add(bar.sid).add(bar.element).add(bar.t_a).add(bar.t_b);
    for (int i = 0; i < 2; ++i) card.add(bar.gradient_a[i]).add(bar.gradient_b[i]);
    sink.put(card);
  }
  for (const auto& plate : t.plates)
    sink.put(CardFields("TEMPP1").add(plate.sid).add(plate.element).add(plate.t).add(plate.gradient));
}

}  // namespace bough::nastran::detail
