#pragma once
/// \file The order in which the writers of a table of cards are called.
#include <algorithm>
#include <initializer_list>
#include <map>
#include <string_view>

namespace bough::nastran::detail {

/// Sets the writer of these cards, which writes them after all that were set before.
template <class Table, class Writer>
void set_writer(Table& table, Writer write, std::initializer_list<const char*> cards) {
  int order = 1;
  for (const auto& [name, row] : table) order = std::max(order, row.write_order + 1);
  for (const char* card : cards) {
    auto& row = table.at(card);
    row.write = write;
    row.write_order = order;
  }
}

/// Calls each writer of a table once, in their order.
template <class Table, class Cards, class Sink>
void write_cards(const Table& table, const Cards& cards, Sink& sink) {
  std::map<int, void (*)(const Cards&, Sink&)> writers;
  for (const auto& [name, row] : table)
    if (row.write != nullptr) writers[row.write_order] = row.write;
  for (const auto& [order, write] : writers) write(cards, sink);
}

/// Returns true if a card is written, under its name or another one.
template <class Table>
bool is_written_by(const Table& table, std::string_view card) {
  const auto row = table.find(card);
  return row != table.end() && (row->second.write != nullptr || row->second.written_as != nullptr);
}

}  // namespace bough::nastran::detail
