#pragma once
/// \file The deformation shapes of a body: normal modes, Craig-Bampton, Craig-Chang, with residual vectors
/// (docs/theory/bases.md).
#include "modal/bases/frame.hpp"
#include "modal/bases/ritz.hpp"

namespace bough::modal::bases {

enum class BasisKind {
  Normal,        ///< normal modes on the supports of the model
  CraigBampton,  ///< fixed-interface normal modes and constraint modes (AIAA J. 6 (1968) 1313)
  CraigChang     ///< normal modes and attachment modes of the interface (Craig & Chang, AIAA J. 14 (1976) 1633)
};

struct BasisOptions {
  BasisKind kind = BasisKind::Normal;
  int num_modes = 0;  ///< normal modes, without the rigid ones; 0: all below max_hz
  std::optional<double> max_hz;
  std::vector<int> interface_nodes;  ///< grids; all their dofs that no constraint holds
  bool is_free = false;              ///< the six rigid-body motions of the model are removed
  bool orthogonalize = true;         ///< Craig-Bampton: K^N = M^ND, else the coordinates stay q = [u_b, η_i]
  MatrixXd residual_loads;           ///< num_gdofs x m, in basic
  const linear::SymmetricFactor* factor = nullptr;  ///< LLᵀ of K of the system, where the caller has it
  std::string solver;  ///< EPS type of SLEPc (find_eps_type); empty: the one that suits the model
};

struct Basis {
  MatrixXd Phi;  ///< num_gdofs x n in basic; free: M-orthogonal to the rigid-body motions unless orthogonalize is off
  VectorXd lambda;  ///< n, φᵀKφ / φᵀMφ
  MatrixXd M, K;    ///< n x n: ΦᵀMΦ and ΦᵀKΦ
  std::vector<records::ModeKind> kind;
  int num_rigid = 0, num_massless = 0;                 ///< rigid-body motions of the model with and without mass
  std::vector<std::pair<int, int>> boundary;           ///< Craig-Bampton: node, component of each constraint mode
  bool is_raw = false;                                 ///< Craig-Bampton coordinates kept as they are
  ModesCheck check;                                    ///< of the normal modes, free or with the interface held
  std::vector<int> unused_loads;                       ///< residual loads that the basis holds already
  std::vector<std::pair<int, double>> massless_loads;  ///< residual loads: part of their flexibility that is lost
};

/// Order: normal modes, then attachment and residual vectors; Craig-Bampton re-orthogonalized: ascending frequency, the
/// dependent and the six rigid vectors removed, a vector "constraint" where the constraint modes have the larger share
/// of its strain energy (as many as there are constraint modes, less six in a free body). The component of largest
/// magnitude of each vector is positive, but of raw constraint modes. Raw constraint modes that move no mass are left
/// out, warning "modal.massless-constraint". `solve`: static solutions on the model's support (free: any determinate
/// one). What calc_normal_modes and FixedInterface throw, and InputError "modal.no-interface".
Basis calc_basis(const fe::System& system, const BasisOptions& options, const StaticSolve& solve,
                 Diagnostics& diagnostics);

/// Columns of the basis, in this order.
Basis select_columns(const Basis& basis, const std::vector<int>& columns);

/// The basis of a free body seen from a frame: the rigid-body motion that the conditions demand is subtracted from each
/// vector and M is computed again; K, lambda stay. Raw Craig-Bampton coordinates are only possible in the frame of an
/// interface node, whose own six constraint modes go. Throws InputError("modal.raw-frame") for another.
void move_to_frame(const fe::Model& model, const FrameSpec& frame, Basis& basis);

}  // namespace bough::modal::bases
