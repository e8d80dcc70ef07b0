#include "formats/nastran/superelement_writer.hpp"

#include "formats/nastran/detail/card_sink.hpp"
#include "formats/nastran/detail/recovery_table.hpp"

namespace bough::nastran {
namespace {

using detail::CardFields;
using detail::CardSink;

constexpr unsigned kAllSix = 63;

void write_grids(const ExternalComponent& c, CardSink& sink) {
  for (const auto& [id, x] : c.grids) {
    CardFields card("GRID");
    sink.put(card.add(id).add(0).add(x).add(0));
  }
}

void write_scalar_points(const ExternalComponent& c, CardSink& sink) {
  for (std::size_t i = 0; i < c.scalar_points.size();) {
    CardFields card("SPOINT");
    for (const std::size_t end = i + 8; i < end && i < c.scalar_points.size(); ++i) card.add(c.scalar_points[i]);
    sink.put(card);
  }
}

/// Pairs ID C, `per_card` at a time; 0: all on one card.
void write_pairs(const char* name, const ExternalComponent& c, std::size_t per_card, CardSink& sink) {
  std::vector<std::pair<int, unsigned>> pairs;
  for (const auto& [id, x] : c.grids) pairs.emplace_back(id, kAllSix);
  for (const int id : c.scalar_points) pairs.emplace_back(id, 0);
  if (per_card == 0) per_card = pairs.size();
  for (std::size_t i = 0; i < pairs.size();) {
    CardFields card(name);
    for (const std::size_t end = i + per_card; i < end && i < pairs.size(); ++i) {
      card.add(pairs[i].first);
      if (pairs[i].second == 0)
        card.add(0);
      else
        card.add_components(pairs[i].second);
    }
    sink.put(card);
  }
}

/// The table "TUG1" of the matrix "MUG1"; the others of loads have none.
void write_table(const records::RecoveryTable& table, CardSink& sink) {
  if (table.name != "MUG1" && table.name != "MEF1" && table.name != "MES1") return;
  detail::write_recovery_rows("T" + table.name.substr(1), table.items, static_cast<int>(table.rows.cols()), sink);
}

}  // namespace

ExternalTexts write_external_component(const ExternalComponent& c) {
  CardSink assembly, section;
  const auto id = std::to_string(c.id);
  assembly.out = "$ External superelement " + id + ": for the main bulk data of the assembly\n";
  CardFields bulk("SEBULK");
  assembly.put(bulk.add(c.id).add_word("EXTOP4").add_blank().add_word("MANUAL").add_blank(2).add(c.unit));
  CardFields joined("SECONCT");
  joined.add(c.id).add(0).add_blank().add_word("NO").end_line();
  for (const auto& [grid, x] : c.grids) joined.add(grid).add(grid);
  for (const int point : c.scalar_points) joined.add(point).add(point);
  assembly.put(joined);
  write_grids(c, assembly);
  write_scalar_points(c, assembly);

  section.out =
      "$ External superelement " + id + ": after the main bulk data of the assembly\nBEGIN SUPER=" + id + "\n";
  write_pairs("EXTRN", c, 0, section);
  write_grids(c, section);
  write_pairs("ASET", c, 4, section);
  write_scalar_points(c, section);
  for (const auto& table : c.recovery) write_table(table, section);
  return {std::move(assembly.out), std::move(section.out)};
}

}  // namespace bough::nastran
