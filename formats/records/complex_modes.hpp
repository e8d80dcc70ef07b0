#pragma once
/// \file Output of `modes` for complex eigenvalues: poles, damping and complex shapes of a deck.
#include "formats/records/flex_body.hpp"

namespace bough::records {

struct ComplexModesResult {
  std::vector<std::pair<std::string, std::string>> source;
  int subcase = 0;
  bool is_by_modes = false;     ///< SOL 110; else on the full matrices
  std::string method;           ///< METHOD of EIGC
  std::string norm = "MAX";     ///< MAX, POINT
  Eigen::VectorXcd eigenvalue;  ///< n, Im ≥ 0; ascending Im, then descending Re
  VectorXd frequency_hz;        ///< Im λ / 2π
  VectorXd damping;             ///< g = -2 Re λ / Im λ; 0 for real eigenvalues, as in Nastran
  VectorXd damping_ratio;       ///< ζ = -Re λ / |λ|
  VectorXd residual;            ///< norm of (λ² M + λ B + K) φ over the sum of the norms of its terms
  std::vector<int> node_id;
  MatrixXd node_xyz;                   ///< p x 3
  std::vector<Eigen::MatrixXcd> phi;   ///< [k] 6 x n, basic axes
  std::vector<Eigen::MatrixXcd> left;  ///< [k] 6 x n, ψᵀ (λ² M + λ B + K) = 0; empty if the matrices are symmetric
  std::vector<int> point_id;           ///< scalar points and extra points
  Eigen::MatrixXcd point_phi, point_left;  ///< points x n
  BodyMesh mesh;
  double biorthogonality = -1;  ///< largest off-diagonal term of Ψᵀ ((λ_i + λ_j) M + B) Φ; negative: not available
  std::complex<double> shift;
  int num_unknowns = 0, num_iterations = 0, num_mirrored = 0;
  double factor_entries = 0;
  bool is_complete = false;  ///< every eigenvalue of the matrices was computed
};

}  // namespace bough::records
