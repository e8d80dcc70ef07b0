/// P2G: columns of a DMIG become load cards.
#include <algorithm>
#include <cmath>
#include <set>

#include "formats/nastran/detail/matrix_selection.hpp"
#include "formats/records/params.hpp"

namespace bough::nastran::detail {
namespace {

using records::DirectMatrix;

/// The highest id that names a load set.
int find_highest_set(const records::Deck& deck) {
  int highest = 0;
  const auto look = [&](int id) { highest = std::max(highest, id); };
  const auto look_at = [&](const auto& cards) {
    for (const auto& card : cards) look(card.sid);
  };
  const auto& c = deck.load_cards;
  look_at(deck.point_loads);
  look_at(deck.gravity);
  look_at(deck.loads);
  look_at(c.directed);
  look_at(c.beams);
  look_at(c.grid_pressures);
  look_at(c.pressures);
  look_at(c.rotations);
  look_at(c.spcd);
  look_at(c.scalar);
  look_at(deck.special.accelerations);
  for (const auto& card : deck.loads)
    for (const auto& [scale, sid] : card.terms) look(sid);
  for (const auto& load : deck.unread_loads) look(load.set);
  for (const auto& subcase : deck.subcases) look(subcase.load);
  return highest;
}

int count_columns(const DirectMatrix& matrix) {
  int count = 0;
  for (const auto& e : matrix.entries) count = std::max(count, e.gj);
  return count;
}

class Maker {
 public:
  Maker(const LoadColumns& columns, records::Deck& deck, Diagnostics& diagnostics)
      : columns_(columns), deck_(deck), diagnostics_(diagnostics), next_set_(find_highest_set(deck)) {}

  void make() {
    const double of_cards = records::get_real_param(deck_, "CP1", 1, diagnostics_);
    const double of_columns = records::get_real_param(deck_, "CP2", 1, diagnostics_);
    std::set<std::string> used;
    for (auto& subcase : deck_.subcases) {
      const auto chosen = columns_.find(subcase.id);
      if (chosen == columns_.end()) {
        if (subcase.load != 0 && of_cards != 1) {
          const int scaled = ++next_set_;
          add_sum(scaled, subcase.load, of_cards, subcase.find_command("LOAD"));
          subcase.load = scaled;
        }
        continue;
      }
      const auto at = subcase.find_command("P2G");
      const int set = ++next_set_;
      std::string names;
      for (const auto& column : chosen->second) {
        used.insert(column.matrix);
        if (const auto* matrix = find(column, at)) add(subcase.id, column, *matrix, of_columns, set);
        names += (names.empty() ? "" : ", ") + std::string("column ") + std::to_string(column.column) + " of " +
                 column.matrix;
      }
      const int whole = subcase.load == 0 ? set : ++next_set_;
      diagnostics_.note("deck.load-columns", deck_.locate(at),
                        "the load of subcase " + std::to_string(subcase.id) + " is set " + std::to_string(whole) +
                            (subcase.load == 0 ? ": " : ": LOAD " + std::to_string(subcase.load) + " and ") + names,
                        "nothing to do");
      if (subcase.load != 0) {
        add_sum(whole, subcase.load, of_cards, at);
        deck_.loads.back().terms.emplace_back(1.0, set);
      }
      subcase.load = whole;
      subcase.commands.try_emplace("LOAD", at);
    }
    std::erase_if(deck_.direct_matrices, [&](const auto& matrix) { return used.count(matrix.name) > 0; });
    // Both are in the load cards now; a deck that is written must not have them again.
    std::erase_if(deck_.params, [](const auto& param) { return param.name == "CP1" || param.name == "CP2"; });
  }

 private:
  /// Adds a LOAD card: `factor` times the loads of set `load`.
  void add_sum(int sid, int load, double factor, const records::CardLocation& at) {
    records::LoadCombination sum;
    sum.sid = sid;
    sum.at = at;
    const auto card =
        std::find_if(deck_.loads.begin(), deck_.loads.end(), [load](const auto& l) { return l.sid == load; });
    if (card == deck_.loads.end())
      sum.terms.emplace_back(factor, load);
    else
      for (const auto& [scale, term] : card->terms) sum.terms.emplace_back(factor * card->s * scale, term);
    deck_.loads.push_back(std::move(sum));
  }

  const DirectMatrix* find(const LoadColumn& column, const records::CardLocation& at) {
    const auto fail = [&](const std::string& what, const char* advice) {
      diagnostics_.error("deck.load-matrix", deck_.locate(at), "P2G selects " + column.matrix + ", " + what, advice);
      return nullptr;
    };
    const auto& all = deck_.direct_matrices;
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& m) { return m.name == column.matrix; });
    if (found == all.end()) return fail("which no DMIG has as its name", "correct the name or add the DMIG");
    if (found->form != 9 && found->form != 2)
      return fail("whose IFO is " + std::to_string(found->form) + ", expected the columns of IFO 9",
                  "write IFO 9 and the number of columns in NCOL");
    if (std::any_of(found->entries.begin(), found->entries.end(), [](const auto& e) { return e.imaginary != 0; }))
      return fail("which has imaginary parts", "give a real matrix");
    return &*found;
  }

  void add(int subcase, const LoadColumn& column, const DirectMatrix& matrix, double factor, int set) {
    const int num = count_columns(matrix);
    if (column.column > num)
      diagnostics_.warning("deck.load-matrix", deck_.locate(matrix.at),
                           "DMIG " + matrix.name + " has " + std::to_string(num) + " column(s), found subcase " +
                               std::to_string(subcase) + " as number " + std::to_string(column.column) +
                               " that P2G selects it for; it gets no load from it",
                           "give a column for each subcase, or write P2G below the SUBCASE that it loads");
    bool has_card = false;
    for (const auto& e : matrix.entries) {
      if (e.gj != column.column) continue;
      has_card = true;
      const double f = factor * column.scale * e.value;
      const auto grid =
          std::find_if(deck_.grids.begin(), deck_.grids.end(), [&](const auto& g) { return g.id == e.gi; });
      if (e.ci == 0 || grid == deck_.grids.end()) {
        deck_.load_cards.scalar.push_back({set, e.gi, f, matrix.at});
        continue;
      }
      records::PointLoad load;
      load.sid = set;
      load.g = e.gi;
      load.cid = grid->cd;
      load.f = f;
      load.n[(e.ci - 1) % 3] = 1;
      load.is_moment = e.ci > 3;
      load.at = matrix.at;
      deck_.point_loads.push_back(load);
    }
    // The set is there, though it applies nothing.
    if (!has_card && !deck_.grids.empty()) {
      records::PointLoad nothing;
      nothing.sid = set;
      nothing.g = deck_.grids.front().id;
      nothing.n = Eigen::Vector3d::UnitX();
      nothing.at = matrix.at;
      deck_.point_loads.push_back(nothing);
    }
  }

  const LoadColumns& columns_;
  records::Deck& deck_;
  Diagnostics& diagnostics_;
  int next_set_;
};

}  // namespace

void add_load_columns(const LoadColumns& columns, records::Deck& deck, Diagnostics& diagnostics) {
  Maker(columns, deck, diagnostics).make();
}

}  // namespace bough::nastran::detail
