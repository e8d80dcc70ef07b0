#include "formats/nastran/detail/recovery_table.hpp"

#include <algorithm>
#include <string>

namespace bough::nastran::detail {
namespace {

/// Name of a table, its code and what Nastran calls the result.
struct TableHeader {
  std::string_view name;
  int code;
  const char* result;
  int type;
};
constexpr TableHeader kHeaders[] = {{"TUG1", 7, "PHIP", 7}, {"TEF1", 1004, "TEF", 4}, {"TES1", 1005, "TES", 5}};

}  // namespace

void write_recovery_rows(std::string_view name, const std::vector<records::RecoveryItem>& items, int num_columns,
                         CardSink& sink) {
  const auto* const header =
      std::find_if(std::begin(kHeaders), std::end(kHeaders), [&](const auto& one) { return one.name == name; });
  const bool has_header = header != std::end(kHeaders);
  if (has_header) {
    int num_rows = 0;
    for (const auto& item : items) num_rows += item.num_rows;
    CardFields sizes("DTI");
    sizes.add_word(name).add(0).add(num_rows).add(num_columns).add(32767).add(0).add(header->code).add(0);
    sizes.add_word(header->result).add_blank().add(header->type).add_blank(2).add_word("REAL").add(1);
    sink.put(sizes.add_word("ENDREC"));
    CardFields list("DTI");
    list.add_word(name).add(1);
    for (int k = 1; k <= num_columns; ++k) list.add(k).add(0.0);
    sink.put(list.add_word("ENDREC"));
  }
  CardFields rows("DTI");
  rows.add_word(name).add(2).end_line();
  for (int twice = 0; twice < 2; ++twice) rows.add_word("TYPE").add_word("ID").add_word("COMP").add_word("ROW");
  for (const auto& item : items) rows.add(item.type).add(item.id).add(item.num_rows).add(item.first_row + 1);
  sink.put(rows.add_word("ENDREC"));
  if (!has_header || name == "TUG1") return;
  CardFields elements("DTI");
  elements.add_word(name).add(3).end_line();
  for (const auto& item : items) elements.add(item.type).add(item.id).end_line();
  sink.put(elements.add_word("ENDREC"));
}

}  // namespace bough::nastran::detail
