#include <algorithm>

#include "formats/nastran/detail/card_sink.hpp"

namespace bough::nastran::detail {
namespace {

/// One card for each run of ids with the same components: C ID1 ID2 ...
void write_lists(const char* name, const std::vector<records::GridComponents>& terms, CardSink& sink) {
  for (std::size_t i = 0; i < terms.size();) {
    CardFields card(name);
    const unsigned c = terms[i].c;
    card.add_components(c);
    for (; i < terms.size() && terms[i].c == c; ++i) card.add(terms[i].g);
    sink.put(card);
  }
}

/// Pairs, as many as one line holds after `head`.
void write_pairs(const CardFields& head, std::size_t per_card, const std::vector<records::GridComponents>& terms,
                 CardSink& sink) {
  for (std::size_t i = 0; i < terms.size();) {
    CardFields card = head;
    for (std::size_t end = i + per_card; i < end && i < terms.size(); ++i)
      card.add(terms[i].g).add_components(terms[i].c);
    sink.put(card);
  }
}

}  // namespace

void write_dof_sets(const records::Deck& deck, CardSink& sink) {
  write_pairs(CardFields("SUPORT"), 4, deck.suport, sink);
  for (const auto& [sid, terms] : deck.suport1) {
    CardFields head("SUPORT1");
    write_pairs(head.add(sid), 3, terms, sink);
  }
  write_lists("ASET1", deck.aset, sink);
  write_lists("OMIT1", deck.omit, sink);
  write_lists("QSET1", deck.qset, sink);
  write_lists("BSET1", deck.bset, sink);
  write_lists("CSET1", deck.cset, sink);
}

void write_direct_matrices(const records::Deck& deck, CardSink& sink) {
  for (const auto& matrix : deck.direct_matrices) {
    int num_columns = 0;
    for (const auto& e : matrix.entries) num_columns = std::max(num_columns, e.gj);
    CardFields header("DMIG");
    header.add_word(matrix.name).add(0).add(matrix.form).add(matrix.is_complex ? 4 : 2).add(0).add_blank(2);
    sink.put(header.add_id(matrix.form == 9 ? num_columns : 0));
    for (std::size_t i = 0; i < matrix.entries.size();) {
      const int gj = matrix.entries[i].gj, cj = matrix.entries[i].cj;
      CardFields card("DMIG");
      card.add_word(matrix.name).add(gj).add(cj).add_blank();
      for (; i < matrix.entries.size() && matrix.entries[i].gj == gj && matrix.entries[i].cj == cj; ++i) {
        const auto& e = matrix.entries[i];
        card.add(e.gi).add(e.ci).add(e.value);
        if (matrix.is_complex)
          card.add(e.imaginary);
        else
          card.add_blank();
      }
      sink.put(card);
    }
  }
}

}  // namespace bough::nastran::detail
