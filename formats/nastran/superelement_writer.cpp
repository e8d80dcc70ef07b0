#include "formats/nastran/superelement_writer.hpp"

#include <algorithm>
#include <set>

#include "formats/nastran/detail/card_sink.hpp"

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

/// Name of the table, its code and what Nastran calls the result.
struct TableKind {
  const char* matrix;
  const char* name;
  int code;
  const char* result;
  int type;
};
constexpr TableKind kKinds[] = {
    {"MUG1", "TUG1", 7, "PHIP", 7}, {"MEF1", "TEF1", 1004, "TEF", 4}, {"MES1", "TES1", 1005, "TES", 5}};

/// DTI: record 0 the sizes, 1 the columns, 2 the rows of each item, 3 the elements.
void write_table(const records::RecoveryTable& table, CardSink& sink) {
  const auto* const kind = std::find_if(std::begin(kKinds), std::end(kKinds),
                                        [&](const TableKind& one) { return table.name == one.matrix; });
  if (kind == std::end(kKinds)) return;
  const int rows = static_cast<int>(table.rows.rows()), columns = static_cast<int>(table.rows.cols());
  CardFields sizes("DTI");
  sizes.add_word(kind->name).add(0).add(rows).add(columns).add(32767).add(0).add(kind->code).add(0);
  sizes.add_word(kind->result).add_blank().add(kind->type).add_blank(2).add_word("REAL").add(1).add_word("ENDREC");
  sink.put(sizes);
  CardFields list("DTI");
  list.add_word(kind->name).add(1);
  for (int k = 1; k <= columns; ++k) list.add(k).add(0.0);
  sink.put(list.add_word("ENDREC"));
  CardFields items("DTI");
  items.add_word(kind->name).add(2).end_line();
  for (int twice = 0; twice < 2; ++twice) items.add_word("TYPE").add_word("ID").add_word("COMP").add_word("ROW");
  for (const auto& item : table.items) items.add(item.type).add(item.id).add(item.num_rows).add(item.first_row + 1);
  sink.put(items.add_word("ENDREC"));
  if (kind->name == std::string_view("TUG1")) return;
  CardFields elements("DTI");
  elements.add_word(kind->name).add(3).end_line();
  for (const auto& item : table.items) elements.add(item.type).add(item.id).end_line();
  sink.put(elements.add_word("ENDREC"));
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
