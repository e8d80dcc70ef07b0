#pragma once
/// \file Given matrices as the elements, modes, loads and geometric stiffness of a body. Internal.
#include "stiffening/given_elements.hpp"
#include "stiffening/stages.hpp"

namespace bough::stiffening {

/// Given matrices on the g-set of their deck, in basic axes and checked; const after.
struct GivenModel {
  const GivenMatrices& matrices;
  PointTable points;
  SparseRows K, M, B;           ///< K without the round-off in rigid-body motions of a free body; B: may be empty
  std::vector<char> has_row;    ///< true for the g-dofs of the file of K
  bool is_lumped = false;       ///< M couples no two points
  MatrixXd Phi;                 ///< num_gdofs x modes; empty: solved for
  std::vector<SparseRows> K_G;  ///< of each of matrices.geometric
  std::vector<VectorXd> F;      ///< their loads; empty for those without
};

/// Grids, coordinate systems, constraints and loads of the deck, without elements, matrices and scale of mass.
records::Deck remove_elements(const records::Deck& deck, const GivenMatrices& matrices);
/// The spec with a load for each K_G of a node and direction, or of a load set, that it does not have.
records::BodySpec add_given_loads(const records::BodySpec& spec, const GivenMatrices& matrices);
/// Reports the errors of reduce_matrices(); `deck` from remove_elements().
GivenModel make_given_model(const records::Deck& deck, const records::BodySpec& spec, const GivenMatrices& matrices,
                            Diagnostics& diagnostics);

/// Returns true if the files contain mode shapes.
inline bool has_modes(const GivenModel& given) { return !given.matrices.modes.Phi.empty(); }
/// The matrices as elements, and the deck's elements as shapes. `nodes`: of a model of `deck`.
fe::ElementList make_given_elements(const GivenModel& given, const records::Deck& deck, const fe::NodeTable& nodes);
/// The given modes with strain. Reports reduce.rigid-modes, reduce.modes-differ, reduce.modes-residual.
MatrixXd calc_given_modes(const GivenModel& given, const fe::System& system, Diagnostics& diagnostics);
/// A load pattern for each K_G that came with its load.
void add_given_patterns(const GivenModel& given, std::vector<LoadPattern>& patterns);
/// K_G1 and K_G2 from the given matrices; zero if none is given. Reports reduce.no-stiffening.
void set_given_stiffness(const BodyRequest& request, const MatrixXd& Phi, records::FlexBody& body);
/// Warns of translations that the file of K lacks and that are zero in Phi without a constraint: reduce.missing-dofs.
void report_missing_rows(const BodyRequest& request, const MatrixXd& Phi);

}  // namespace bough::stiffening
