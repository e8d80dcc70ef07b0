#pragma once
/// \file Mode shapes that Nastran wrote, to compare with our own (docs/formats/nastran-modes.md).
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::matrices {

struct ModeTable {
  int subcase = 0;
  bool is_basic = false;             ///< OP2 tables BOUGV1, BOPHIG; otherwise each node's displacement system (CD)
  std::vector<int> mode;             ///< n, as numbered in the file
  Eigen::VectorXd eigenvalue;        ///< n
  Eigen::VectorXd frequency_hz;      ///< n
  Eigen::VectorXd generalized_mass;  ///< n, from the OP2 table LAMA; empty without it
  std::vector<int> node_id;          ///< p, in the file's order; scalar points among them
  std::vector<bool> is_scalar;       ///< p: only the first component means something
  std::vector<Eigen::MatrixXd> phi;  ///< [k] 6 x n, as in records::ModesResult
};

/// From an OP2 file (tables OUGV1, BOUGV1, OUGV1PAT, OUG1, OPHIG, BOPHIG with real eigenvectors by mode (SORT1); LAMA;
/// both byte orders, words of 4 or 8 bytes) or a punch file ($EIGENVALUE). One table per subcase and axes. Throws
/// InputError "matrices.*" with line or byte.
std::vector<ModeTable> read_mode_tables(const std::string& path);

}  // namespace bough::matrices
