#include "analysis/reduce/point_files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "analysis/common/inputs.hpp"
#include "base/input_bytes.hpp"
#include "formats/hdf5/grids_file.hpp"
#include "formats/hdf5/sparse_file.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

namespace {

bool is_whole(double value) { return std::abs(value) <= std::numeric_limits<int>::max() && value == std::trunc(value); }

/// Rows of numbers between commas, semicolons, tabs or blanks, whole numbers in the first `num_ids` columns; # and $
/// begin comments; a heading may come first.
std::vector<std::vector<double>> read_table(const std::string& path, std::size_t num_columns, std::size_t num_ids,
                                            const std::string& what) {
  demand_file(path);
  std::ifstream in(path);
  std::vector<std::vector<double>> rows;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    line.erase(std::find_if(line.begin(), line.end(), [](char c) { return c == '#' || c == '$'; }), line.end());
    for (char& c : line)
      if (c == ',' || c == ';' || c == '\t' || c == '\r') c = ' ';
    std::istringstream words(line);
    std::vector<double> row;
    std::string word;
    bool is_valid = true;
    while (words >> word) {
      std::size_t used = 0;
      try {
        row.push_back(std::stod(word, &used));
      } catch (const std::exception&) {
      }
      is_valid = is_valid && used == word.size() && std::isfinite(row.back()) &&
                 (row.size() > num_ids || is_whole(row.back()));
    }
    if (row.empty() && is_valid) continue;
    if (is_valid && row.size() == num_columns) {
      rows.push_back(std::move(row));
    } else if (!rows.empty() || number > 1) {
      throw InputError("cli.bad-table", {path, number}, "found '" + line + "', expected " + what,
                       "write " + std::to_string(num_columns) + " numbers in each line");
    }
  }
  return rows;
}

records::Deck make_points(const std::vector<int>& id, const Eigen::MatrixXd& xyz, const std::string& file) {
  records::Deck deck;
  deck.files = {file};
  deck.subcases.emplace_back();
  for (std::size_t k = 0; k < id.size(); ++k) {
    records::Grid grid;
    grid.id = id[k];
    grid.x = xyz.row(static_cast<Eigen::Index>(k)).transpose();
    deck.grids.push_back(grid);
  }
  return deck;
}

records::Deck read_grids(const std::string& path) {
  demand_file(path);
  if (is_hdf5(path)) {
    const auto grids = hdf5::read_grids(path);
    if (!grids) throw InputError("cli.no-grids", {path}, "the file has no /grids", "give a table of id, x, y, z");
    return make_points(grids->id, grids->xyz, path);
  }
  const auto rows = read_table(path, 4, 1, "the id of a grid and x, y, z");
  std::vector<int> id;
  Eigen::MatrixXd xyz(static_cast<Eigen::Index>(rows.size()), 3);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    id.push_back(static_cast<int>(rows[k][0]));
    xyz.row(static_cast<Eigen::Index>(k)) << rows[k][1], rows[k][2], rows[k][3];
  }
  return make_points(id, xyz, path);
}

/// Elements, properties and materials do not matter: what Bough cannot read of them is left out.
records::Deck read_deck_of_points(const records::BodySpec& spec, Diagnostics& diagnostics) {
  demand_file(spec.deck);
  nastran::ReadOptions options{spec.ignore_cards};
  Diagnostics first;
  for (const auto& card : nastran::read_deck(spec.deck, options, first).unused)
    if (card.effect == records::CardEffect::Stiffness || card.effect == records::CardEffect::Mass ||
        card.effect == records::CardEffect::Damping)
      options.ignore_cards.push_back(card.name);
  auto deck = nastran::read_deck(spec.deck, options, diagnostics);
  deck.super = {};
  diagnostics.throw_if_errors();
  return deck;
}

}  // namespace

bool is_hdf5(const std::string& path) {
  demand_file(path);
  return read_input_head(path, 8) == "\x89HDF\r\n\x1a\n";
}

Eigen::MatrixXi read_dof_table(const std::string& path) {
  if (is_hdf5(path)) return hdf5::read_sparse_file(path).dof_map;
  const auto rows = read_table(path, 2, 2, "a node and a component");
  Eigen::MatrixXi dofs(static_cast<Eigen::Index>(rows.size()), 2);
  for (std::size_t i = 0; i < rows.size(); ++i)
    dofs.row(static_cast<Eigen::Index>(i)) << static_cast<int>(rows[i][0]), static_cast<int>(rows[i][1]);
  return dofs;
}

std::string find_dof_table(const std::string& path) {
  fs::path base(path);
  for (int i = 0; i < 2; ++i) {
    base.replace_extension();
    if (fs::exists(base.string() + ".dofs.csv")) return base.string() + ".dofs.csv";
  }
  return {};
}

records::Deck read_points(const records::BodySpec& spec, Diagnostics& diagnostics) {
  const auto& matrices = *spec.matrices;
  if (!spec.deck.empty() && !matrices.grids.empty())
    throw InputError("cli.grids-twice", {spec.deck}, "the deck and the table " + matrices.grids + " both give grids",
                     "leave one out");
  if (!spec.deck.empty()) return read_deck_of_points(spec, diagnostics);
  if (!matrices.grids.empty()) return read_grids(matrices.grids);
  const auto K = matrices.stiffness.empty() ? matrices.file : matrices.stiffness.file;
  demand_file(K);
  if (!is_hdf5(K))
    throw InputError("cli.no-grids", {K}, "the positions of the grids are missing",
                     "give a deck with GRID cards, or grids, a table of id, x, y, z");
  return read_grids(K);
}

}  // namespace bough::analysis
