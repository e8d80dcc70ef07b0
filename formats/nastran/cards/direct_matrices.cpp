#include <algorithm>
#include <cmath>
#include <tuple>

#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

using records::DirectMatrix;

DmigState& find_matrix(const std::string& name, Card& card, Reading& r) {
  const auto [state, is_new] = r.direct_matrices.try_emplace(name);
  if (is_new) {
    state->second.index = r.deck.direct_matrices.size();
    r.deck.direct_matrices.emplace_back();
    r.deck.direct_matrices.back().name = name;
    r.deck.direct_matrices.back().at = card.get_location();
  }
  return state->second;
}

/// NAME 0 IFO TIN TOUT POLAR blank NCOL
void parse_header(Card& card, Reading& r, const std::string& name) {
  const int form = card.read_int(2, "IFO");
  const int type = card.read_int(3, "TIN");
  const int polar = card.read_int(5, "POLAR", 0);
  if (!card.is_ok()) return;
  card.demand(form == 1 || form == 2 || form == 6 || form == 9, 2, "IFO", "1, 2, 6 or 9");
  card.demand(type >= 1 && type <= 4, 3, "TIN", "a type 1 to 4");
  const int out = card.read_int(4, "TOUT", 0);
  card.demand(out >= 0 && out <= 4, 4, "TOUT", "a type 0 to 4");
  card.use(6, 8);  // NCOL
  auto& state = find_matrix(name, card, r);
  if (state.has_header) {
    card.fail("deck.duplicate-id", 0, "matrix " + name + " has two headers", "give one of them another name");
    return;
  }
  state.has_header = true;
  state.is_polar = polar > 0;
  auto& matrix = r.deck.direct_matrices[state.index];
  matrix.form = form;
  matrix.is_complex = type > 2;
  matrix.at = card.get_location();
}

/// NAME GJ CJ blank, then G C A B for each row. Parts are as read until the header is known.
void parse_column(Card& card, Reading& r, const std::string& name) {
  const int gj = card.read_id(1, "GJ"), cj = card.read_component(2, "CJ");
  std::vector<DirectMatrix::Entry> entries;
  for (int i = 4; i < card.get_size(); i += 4) {
    if (card.is_blank(i, i + 4)) continue;
    const int gi = card.read_id(i, "G"), ci = card.read_component(i + 1, "C");
    entries.push_back({gj, cj, gi, ci, card.read_real(i + 2, "A", 0.0), card.read_real(i + 3, "B", 0.0)});
  }
  if (entries.empty() && card.is_ok()) card.fail("deck.missing-field", 4, "the column has no term");
  if (!card.is_ok()) return;
  auto& all = r.deck.direct_matrices[find_matrix(name, card, r).index].entries;
  all.insert(all.end(), entries.begin(), entries.end());
}

/// A name of letters and digits that begins with a letter; the zero in the next field makes a card the header.
void parse_dmig(Card& card, Reading& r) {
  const auto name = card.get_upper(0);
  card.use(3);  // blank after GJ CJ
  if (name.empty() || !std::isalpha(static_cast<unsigned char>(name.front())) || name.size() > 8) {
    if (name.empty())
      card.fail("deck.missing-field", 0, "NAME is blank, expected the name of the matrix");
    else
      card.fail("deck.bad-word", 0, "NAME is '" + name + "', expected a name of up to eight letters and digits");
    return;
  }
  if (card.is_integer(1) && card.read_int(1, "0") == 0)
    parse_header(card, r, name);
  else
    parse_column(card, r, name);
}

using Place = std::tuple<int, int, int, int>;

Place get_place(const DirectMatrix::Entry& e, bool is_symmetric) {
  const std::tuple<int, int> row{e.gi, e.ci}, column{e.gj, e.cj};
  return is_symmetric && column < row ? std::tuple_cat(column, row) : std::tuple_cat(row, column);
}

/// Nastran too stops at a term that is given twice, or on both sides of the diagonal of a symmetric matrix.
void find_repeated_term(const DirectMatrix& matrix, const Reading& r) {
  std::vector<Place> places;
  for (const auto& e : matrix.entries) places.push_back(get_place(e, matrix.form == 6));
  std::sort(places.begin(), places.end());
  const auto twice = std::adjacent_find(places.begin(), places.end());
  if (twice == places.end()) return;
  const auto& [g1, c1, g2, c2] = *twice;
  r.diagnostics.error("deck.duplicate-term", r.deck.locate(matrix.at),
                      "DMIG: matrix " + matrix.name + " gives the term of " + std::to_string(g1) + "/" +
                          std::to_string(c1) + " and " + std::to_string(g2) + "/" + std::to_string(c2) + " twice",
                      matrix.form == 6 ? "a symmetric matrix (IFO 6) has each term once, above or below the diagonal"
                                       : "give each term once");
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

/// NAME GJ CJ blank, then G C A B for each row; the header has no dimension.
void convert_dmig(UnitConverter& u) {
  if (u.get(1) == "0") return;
  const auto name = make_upper(u.get(0));
  const auto& kinds = u.get_notes().matrix_kinds;
  const auto found = kinds.find(name);
  const auto kind = found == kinds.end() ? "?" : found->second;
  const bool is_polar = u.get_notes().polar_matrices.count(name) > 0;
  const auto scale_term = [&](int field, Motion motion) {
    if (kind == "K")
      u.scale_by(motion, field, "K", "Q", "F");
    else if (kind == "M")
      u.scale_by(motion, field, "M", "J", "ML");
    else if (kind == "B")
      u.scale_by(motion, field, "B", "BR", "BL");
    else if (kind == "P")
      u.scale_by(motion, field, "F", "Q", "?");
    else
      u.scale(field, "?");
  };
  for (int i = 4; i < u.size(); i += 4) {
    if (u.get(i).empty()) continue;
    const auto motion = UnitConverter::find_motion(u.get(i + 1), u.get(2), kind != "P");
    scale_term(i + 2, motion);
    if (!is_polar) scale_term(i + 3, motion);
  }
}
void note_dmig(const UnitConverter& u, UnitNotes& notes) {
  if (u.get(1) == "0" && u.get_int(5) > 0) notes.polar_matrices.insert(make_upper(u.get(0)));
}

}  // namespace

void finish_direct_matrices(Reading& r) {
  constexpr double degree = 3.14159265358979323846 / 180;
  for (const auto& [name, state] : r.direct_matrices) {
    auto& matrix = r.deck.direct_matrices[state.index];
    if (!state.has_header) {
      r.diagnostics.error("deck.missing-header", r.deck.locate(matrix.at), "DMIG: matrix " + name + " has no header",
                          "add DMIG," + name + ",0,IFO,TIN,TOUT");
      continue;
    }
    for (auto& e : matrix.entries) {
      if (!matrix.is_complex) {
        e.imaginary = 0;  // Bi has no meaning with a real TIN
      } else if (state.is_polar) {
        const double amplitude = e.value, phase = e.imaginary * degree;
        e.value = amplitude * std::cos(phase);
        e.imaginary = amplitude * std::sin(phase);
      }
    }
    find_repeated_term(matrix, r);
  }
}

void add_direct_matrix_parsers(ParserTable& table) {
  table["DMIG"] = {parse_dmig, nullptr};
  table["DMIG"].convert = convert_dmig;
  table["DMIG"].note = note_dmig;
  write_by(table, write_direct_matrices, {"DMIG"});
}

}  // namespace bough::nastran::detail
