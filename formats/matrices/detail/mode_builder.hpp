#pragma once
/// \file Gathers the modes of one subcase; every mode has the same nodes.
#include <cmath>
#include <map>
#include <string>

#include "formats/matrices/mode_table.hpp"

namespace bough::matrices::detail {

inline constexpr double kTwoPi = 6.283185307179586;

struct NodeRow {
  int id = 0;
  bool is_scalar = false;
  double value[6] = {};
};

struct ModeRows {
  int mode = 0;
  double eigenvalue = 0;
  std::vector<NodeRow> rows;
};

/// False when a mode has other nodes than the first.
inline bool make_table(const std::vector<ModeRows>& modes, ModeTable& table) {
  const auto n = static_cast<Eigen::Index>(modes.size());
  table.eigenvalue.resize(n);
  table.frequency_hz.resize(n);
  for (const auto& row : modes.front().rows) {
    table.node_id.push_back(row.id);
    table.is_scalar.push_back(row.is_scalar);
  }
  table.phi.assign(table.node_id.size(), Eigen::MatrixXd::Zero(6, n));
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto& mode = modes[static_cast<std::size_t>(j)];
    table.mode.push_back(mode.mode);
    table.eigenvalue(j) = mode.eigenvalue;
    // A rigid mode may have an eigenvalue just below zero.
    table.frequency_hz(j) = std::sqrt(std::abs(mode.eigenvalue)) / kTwoPi;
    if (mode.rows.size() != table.node_id.size()) return false;
    for (std::size_t k = 0; k < mode.rows.size(); ++k) {
      if (mode.rows[k].id != table.node_id[k]) return false;
      for (Eigen::Index c = 0; c < 6; ++c) table.phi[k](c, j) = mode.rows[k].value[c];
    }
  }
  return true;
}

/// Reads eigenvectors from an OUTPUT2 file, a table for each subcase. Throws InputError "matrices.*" with the offset.
std::vector<ModeTable> read_op2(const std::string& path);
/// Reads eigenvectors from a punch file, a table for each subcase. Throws InputError "matrices.*" with the line.
std::vector<ModeTable> read_punch(const std::string& path);

}  // namespace bough::matrices::detail
