#include "formats/matrices/superelements.hpp"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <optional>
#include <set>

#include "formats/matrices/detail/input.hpp"
#include "formats/matrices/matrix_reader.hpp"

namespace bough::matrices {
namespace {

namespace fs = std::filesystem;

using Eigen::Index;
using Eigen::MatrixXd;
using records::Deck;
using records::Sebulk;
using records::Superelement;

using Names = std::vector<std::string>;
const Names kStiffness{"KXX", "KAA", "KAAX"}, kMass{"MXX", "MAA", "MAAX"};
const Names kDamping{"BXX", "BXX1", "BAA", "BAAX"}, kStructural{"K4XX", "K4XX1", "K4AA", "K4AAX"};

/// The file that a deck of another system names: letters of either case in each part of the path.
std::optional<fs::path> find_file(const fs::path& folder, std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  std::error_code failed;
  if (fs::is_regular_file(folder / name, failed)) return folder / name;
  fs::path found = folder;
  for (const auto& part : fs::path(name).relative_path()) {
    if (fs::exists(found / part, failed)) {
      found /= part;
      continue;
    }
    std::optional<fs::path> match;
    for (const auto& entry : fs::directory_iterator(found.empty() ? fs::path(".") : found, failed))
      if (detail::equals_ignoring_case(entry.path().filename().string(), part.string()))
        match = entry.path().filename();
    if (!match) return {};
    found /= *match;
  }
  if (fs::is_regular_file(found, failed)) return found;
  return {};
}

MatrixXd make_dense(const Matrix& matrix) {
  MatrixXd dense = MatrixXd::Zero(matrix.values.num_rows, matrix.values.num_cols);
  for (int i = 0; i < matrix.values.num_rows; ++i)
    for (int e = matrix.values.indptr[static_cast<std::size_t>(i)];
         e < matrix.values.indptr[static_cast<std::size_t>(i) + 1]; ++e)
      dense(i, matrix.values.indices[static_cast<std::size_t>(e)]) = matrix.values.data[static_cast<std::size_t>(e)];
  return dense;
}

class Joiner {
 public:
  Joiner(Deck& deck, Diagnostics& diagnostics)
      : deck_(deck), diagnostics_(diagnostics), had_errors_(diagnostics.num_errors() > 0) {}

  void join() {
    std::set<int> external;
    for (const auto& part : deck_.superelements) external.insert(part.id);
    for (const auto& bulk : deck_.super.sebulk) {
      if (bulk.type == "PRIMARY" && (external.count(bulk.id) > 0 || is_uncondensed(bulk.id))) continue;
      if (!external.insert(bulk.id).second) {
        error("matrices.superelement-half", bulk.at, name(bulk.id) + " has two SEBULK", "remove one of them");
        continue;
      }
      if (bulk.type != "EXTOP4" && bulk.type != "EXTERNAL") {
        error("matrices.superelement-type", bulk.at,
              "SEBULK " + std::to_string(bulk.id) + " is of type " + bulk.type + ", which is not supported",
              bulk.type == "EXTOP2" ? "write the component with EXTSEOUT(MATOP4) in place of MATOP2"
                                    : "give the matrices of the superelement by EXTSEOUT(MATOP4)");
        continue;
      }
      join(bulk);
    }
    for (const auto& section : deck_.super.sections) {
      if (!external.insert(section.id).second || is_uncondensed(section.id)) continue;
      if (section.deck->super.extrn.empty() && has_elements(*section.deck))
        error("matrices.superelement-type", section.at,
              "BEGIN SUPER=" + std::to_string(section.id) +
                  " is a superelement with elements, which is not condensed here",
              "make its section a deck, write it with bough export --to extseout and include the files");
      else
        error("matrices.superelement-half", section.at,
              "BEGIN SUPER=" + std::to_string(section.id) + " has no SEBULK in the main bulk data",
              "include the .asm file that EXTSEOUT wrote with this section");
    }
    for (const auto& card : deck_.super.seload)
      if (external.count(card.superelement) == 0)
        error("matrices.superelement-half", card.at,
              "SELOAD names superelement " + std::to_string(card.superelement) + ", which has no SEBULK",
              "include the .asm and the .pch file of it");
    for (const auto& card : deck_.super.seconct)
      for (const int id : {card.a, card.b})
        if (id > 0 && external.insert(id).second)
          error("matrices.superelement-half", card.at,
                "SECONCT names superelement " + std::to_string(id) + ", which has no SEBULK and no BEGIN SUPER",
                "include the .asm and the .pch file of it");
  }

 private:
  /// Returns true for a section with elements that was not condensed because the deck has errors.
  bool is_uncondensed(int id) const {
    const auto is_of = [&](const auto& one) {
      return one.id == id && one.deck->super.extrn.empty() && has_elements(*one.deck);
    };
    return had_errors_ && std::any_of(deck_.super.sections.begin(), deck_.super.sections.end(), is_of);
  }
  static bool has_elements(const Deck& deck) {
    return !(deck.beams.empty() && deck.shells.empty() && deck.solids.empty() && deck.crod.empty() &&
             deck.conrod.empty() && deck.ctube.empty() && deck.shear_panels.empty() && deck.springs.empty() &&
             deck.cbush.empty() && deck.cbush1d.empty() && deck.conm1.empty() && deck.conm2.empty() &&
             deck.scalar_masses.empty());
  }
  static std::string name(int id) { return "external superelement " + std::to_string(id); }
  void error(std::string_view id, const records::CardLocation& at, std::string what, std::string advice) {
    diagnostics_.error(id, deck_.locate(at), std::move(what), std::move(advice));
  }

  void join(const Sebulk& bulk) {
    Superelement s;
    s.id = bulk.id;
    s.at = bulk.at;
    const auto section = std::find_if(deck_.super.sections.begin(), deck_.super.sections.end(),
                                      [&](const auto& one) { return one.id == bulk.id; });
    if (section == deck_.super.sections.end())
      return error("matrices.superelement-half", bulk.at,
                   name(bulk.id) + " has no section BEGIN SUPER=" + std::to_string(bulk.id),
                   "include the .pch file that EXTSEOUT wrote, after the main bulk data");
    s.section = section->deck;
    list_points(*section, s);
    if (s.points.empty())
      return error("matrices.superelement-half", section->at,
                   "BEGIN SUPER=" + std::to_string(bulk.id) + " names no exterior points",
                   "give EXTRN, or ASET and QSET, in the section");
    set_connections(bulk, s);
    const auto matrices = read(bulk, s);
    if (!matrices) return;
    fill(*matrices, *section, s);
    deck_.superelements.push_back(std::move(s));
  }

  /// EXTRN, else the a-set of the section by id.
  void list_points(const records::DeckSection& section, Superelement& s) {
    const auto& deck = *section.deck;
    s.points = deck.super.extrn;
    if (!s.points.empty()) return;
    std::map<int, unsigned> points;
    const std::set<int> scalar(deck.scalar_points.begin(), deck.scalar_points.end());
    for (const auto* set : {&deck.aset, &deck.qset})
      for (const auto& term : *set) points[term.g] |= scalar.count(term.g) > 0 ? 0 : term.c;
    for (const auto& [id, c] : points) s.points.push_back({id, c});
  }

  void set_connections(const Sebulk& bulk, Superelement& s) {
    s.tolerance = bulk.tolerance;
    s.joins_places = bulk.is_auto;
    bool has_card = false;
    for (const auto& card : deck_.super.seconct) {
      if ((card.a != s.id || card.b != 0) && (card.b != s.id || card.a != 0)) {
        if (card.a == s.id && card.b != 0)
          error("matrices.superelement-type", card.at,
                "SECONCT joins two superelements, " + std::to_string(card.a) + " and " + std::to_string(card.b),
                "join both to points of the residual structure (SEIDB = 0)");
        continue;
      }
      has_card = true;
      for (const auto& [a, b] : card.points) s.joined[card.a == s.id ? a : b] = card.a == s.id ? b : a;
    }
    s.checks_places = true;
    if (!has_card) s.joins_places = true;
  }

  /// The matrices of the file, or the DMIG of the section.
  std::optional<std::vector<Matrix>> read(const Sebulk& bulk, Superelement& s) {
    const auto file = deck_.super.input4.find(bulk.unit);
    if (bulk.type == "EXTERNAL" && bulk.unit == 0) return std::vector<Matrix>{};
    if (file == deck_.super.input4.end()) {
      error("matrices.superelement-half", bulk.at,
            "SEBULK " + std::to_string(bulk.id) + " takes its matrices from unit " + std::to_string(bulk.unit) +
                ", to which no ASSIGN INPUTT4 gives a file",
            "write ASSIGN INPUTT4='name.op4',UNIT=" + std::to_string(bulk.unit) + " above SOL");
      return {};
    }
    const auto path = find_file(fs::path(deck_.files.front()).parent_path(), file->second.path);
    if (!path) {
      error("matrices.superelement-half", file->second.at,
            "the file '" + file->second.path + "' of " + name(bulk.id) + " does not exist",
            "it is looked for in the folder of the deck; EXTSEOUT(MATOP4) wrote it");
      return {};
    }
    s.file = path->lexically_normal().string();
    try {
      return read_matrices(s.file, diagnostics_);
    } catch (const InputError& failed) {
      for (const auto& item : failed.items()) diagnostics_.add(item);
      return {};
    }
  }

  const Matrix* find(const std::vector<Matrix>& matrices, const Names& names) const {
    for (const auto& name : names)
      for (const auto& matrix : matrices)
        if (detail::equals_ignoring_case(matrix.name, name)) return &matrix;
    return nullptr;
  }

  /// Square on the exterior dofs; 1 x 1 is an empty one. False after an error.
  bool take(const std::vector<Matrix>& matrices, const Names& names, const records::DeckSection& section,
            const Superelement& s, MatrixXd& target) {
    const auto* matrix = find(matrices, names);
    const auto n = s.num_dofs();
    if (!matrix) return true;
    const Index rows = matrix->values.num_rows, cols = matrix->values.num_cols;
    if (rows == 1 && cols == 1 && n != 1) return true;
    const auto at = section.deck->super.extrn.empty() ? section.at : section.deck->super.extrn_at;
    if (rows != n || cols != n) {
      error("matrices.superelement-size", at,
            "matrix " + matrix->name + " of '" + s.file + "' has " + std::to_string(rows) + " x " +
                std::to_string(cols) + " terms, the exterior points of superelement " + std::to_string(s.id) +
                " have " + std::to_string(n) + " degrees of freedom",
            "take .op4, .asm and .pch of one run: this matrix is of another boundary");
      return false;
    }
    MatrixXd dense = make_dense(*matrix);
    const double size = dense.cwiseAbs().maxCoeff();
    if (matrix->is_complex || !((dense - dense.transpose()).cwiseAbs().maxCoeff() <= 1e-6 * size)) {
      error("matrices.superelement-size", at,
            "matrix " + matrix->name + " of '" + s.file + "' is " + (matrix->is_complex ? "complex" : "not symmetric"),
            "give real symmetric matrices");
      return false;
    }
    target = 0.5 * (dense + dense.transpose());
    return true;
  }

  void fill(const std::vector<Matrix>& matrices, const records::DeckSection& section, Superelement& s) {
    if (s.file.empty()) {
      fill_from_cards(section, s);
    } else {
      const bool is_taken = take(matrices, kStiffness, section, s, s.K) && take(matrices, kMass, section, s, s.M) &&
                            take(matrices, kDamping, section, s, s.B) && take(matrices, kStructural, section, s, s.K4);
      if (!is_taken) return;
    }
    if (s.K.size() == 0)
      return error(
          "matrices.superelement-half", s.at,
          (s.file.empty() ? "the section" : "'" + s.file + "'") + " of " + name(s.id) + " has no stiffness matrix",
          "expected KXX or KAA on the exterior degrees of freedom");
    take_loads(matrices, section, s);
    for (const auto& rows : section.deck->super.rows) {
      const std::string name = "M" + rows.name.substr(1);
      if (const auto* matrix = find(matrices, {name})) take_rows(*matrix, rows, s);
      if (const auto* matrix = find(matrices, {name + "O"})) take_load_rows(*matrix, rows, s);
    }
  }

  /// DMIG of the section: EXTSEOUT(DMIGPCH) names them K, M, B, K4 and letters after these.
  void fill_from_cards(const records::DeckSection& section, Superelement& s) {
    std::map<std::pair<int, int>, Index> place;
    for (Index i = 0; const auto& point : s.points) {
      if (point.c == 0) place[{point.id, 0}] = i++;
      for (int c = 1; c <= 6; ++c)
        if (point.c >> (c - 1) & 1u) place[{point.id, c}] = i++;
    }
    const auto n = s.num_dofs();
    for (const auto& matrix : section.deck->direct_matrices) {
      auto* target = matrix.name.starts_with("K4")  ? &s.K4
                     : matrix.name.starts_with("K") ? &s.K
                     : matrix.name.starts_with("M") ? &s.M
                     : matrix.name.starts_with("B") ? &s.B
                                                    : nullptr;
      if (!target || matrix.form == 9) continue;
      *target = MatrixXd::Zero(n, n);
      for (const auto& e : matrix.entries) {
        const auto row = place.find({e.gi, e.ci}), column = place.find({e.gj, e.cj});
        if (row == place.end() || column == place.end()) {
          const auto& [g, c] = row == place.end() ? std::pair(e.gi, e.ci) : std::pair(e.gj, e.cj);
          error("matrices.superelement-size", matrix.at,
                "DMIG " + matrix.name + " has point " + std::to_string(g) + " component " + std::to_string(c) +
                    ", which is no exterior degree of freedom of superelement " + std::to_string(s.id),
                "take .asm and .pch of one run");
          return;
        }
        (*target)(row->second, column->second) = e.value;
        if (matrix.form == 6) (*target)(column->second, row->second) = e.value;
      }
    }
  }

  void take_loads(const std::vector<Matrix>& matrices, const records::DeckSection& section, Superelement& s) {
    const auto* matrix = find(matrices, {"PX", "PX1", "PA", "PAX"});
    const auto& columns = section.deck->super.load_columns;
    if (!matrix || columns.empty()) return;
    MatrixXd dense = make_dense(*matrix);
    int last = 0;
    for (const auto& [load, column] : columns) last = std::max(last, column);
    if (dense.rows() != s.num_dofs() || dense.cols() < last)
      return error("matrices.superelement-size", section.at,
                   "DTI SELOAD names " + std::to_string(last) + " loads, matrix " + matrix->name + " of '" + s.file +
                       "' has " + std::to_string(dense.rows()) + " x " + std::to_string(dense.cols()) + " terms for " +
                       std::to_string(s.num_dofs()) + " exterior degrees of freedom",
                   "take .op4 and .pch of one run");
    for (const auto& [load, column] : columns) s.load_columns[load] = column - 1;
    s.P = std::move(dense);
  }

  void take_rows(const Matrix& matrix, const records::RecoveryRows& rows, Superelement& s) {
    MatrixXd dense = make_dense(matrix);
    const auto n = s.num_dofs();
    if (dense.cols() != n && dense.rows() == n) dense.transposeInPlace();
    Index end = 0;
    for (const auto& item : rows.items) end = std::max<Index>(end, item.first_row + item.num_rows);
    if (dense.rows() == 1 && dense.cols() == 1) return;
    if (dense.cols() != n || dense.rows() != end)
      return error("matrices.superelement-rows", rows.at,
                   "DTI " + rows.name + " lists " + std::to_string(end) + " rows, matrix " + matrix.name + " of '" +
                       s.file + "' has " + std::to_string(dense.rows()) + " x " + std::to_string(dense.cols()) +
                       " terms for " + std::to_string(n) + " exterior degrees of freedom",
                   "take .op4 and .pch of one run");
    s.recovery.push_back({matrix.name, rows.items, std::move(dense)});
  }

  /// MUG1O and the like: what the loads of PX do to the items with the exterior dofs held.
  void take_load_rows(const Matrix& matrix, const records::RecoveryRows& rows, Superelement& s) {
    MatrixXd dense = make_dense(matrix);
    if (s.recovery.empty() || s.recovery.back().name + "O" != matrix.name) return;
    const auto& table = s.recovery.back();
    const auto loads = s.P.cols();
    if (dense.rows() != table.rows.rows() && dense.cols() == table.rows.rows()) dense.transposeInPlace();
    if (loads == 0 || (dense.rows() == 1 && dense.cols() == 1)) return;
    if (dense.rows() != table.rows.rows() || dense.cols() != loads)
      return error("matrices.superelement-rows", rows.at,
                   "matrix " + matrix.name + " of '" + s.file + "' has " + std::to_string(dense.rows()) + " x " +
                       std::to_string(dense.cols()) + " terms for " + std::to_string(table.rows.rows()) +
                       " rows of DTI " + rows.name + " and " + std::to_string(loads) + " loads",
                   "take .op4 and .pch of one run");
    s.recovery.push_back({matrix.name, rows.items, std::move(dense)});
  }

  Deck& deck_;
  Diagnostics& diagnostics_;
  bool had_errors_;
};

}  // namespace

void read_superelements(Deck& deck, Diagnostics& diagnostics) {
  deck.super.is_joined = true;
  if (deck.super.empty()) return;
  Joiner(deck, diagnostics).join();
}

}  // namespace bough::matrices
