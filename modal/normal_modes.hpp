#pragma once
/// \file Computes the normal modes of a model by one method: zero-energy modes, elastic modes, and their accuracy.
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/diagnostic.hpp"
#include "fe/linear/residual.hpp"
#include "modal/mode_range.hpp"
#include "modal/pencil_solver.hpp"
#include "modal/roundoff.hpp"

namespace bough::modal::detail {

/// The modes computed by one method, with their residuals.
struct Answer {
  EigenPairs pairs;
  bool is_valid = false;
  Diagnostics diagnostics;
  double worst_roundoff = 0;  ///< relative, of the eigenvalues with strain

  /// Largest residual of the eigenpairs; 0 without any.
  double worst() const { return pairs.residual.size() > 0 ? pairs.residual.maxCoeff() : 0; }
  /// No mode may be missing, and no residual needs a word.
  bool is_accurate() const { return is_valid && worst() <= linear::kResidualWarning; }
};

/// Adds the warning "modal.cut-root": `num_more` further modes have the frequency of the last one.
void warn_of_cut_root(int num_more, Diagnostics& diagnostics);
/// Adds the warning "modal.fewer-modes". \param is_range  the number was requested from the start of a range on.
void warn_of_fewer(int found, int requested, bool is_range, Diagnostics& diagnostics);

class NormalModes {
 public:
  using FindRigid = RigidMotions (*)(const Pencil&);
  /// Throws ComputationError modal.no-mass.
  NormalModes(const fe::System& system, const EigenOptions& options, FindRigid find_rigid);

  /// The modes, by the EPS type that is named; empty: by the one that suits.
  Answer solve(const std::string& eps_type);
  /// Returns true if all zero-energy modes of the model were found.
  bool knows_motions() const { return rigid_.is_complete; }
  /// Returns true if Krylov-Schur found a part of them, where no EPS type is asked for: blocks may find the others.
  bool has_second_solver() const;

 private:
  bool has_supports() const { return !rigid_.supports.empty(); }
  int num_rigid() const { return static_cast<int>(rigid_.modes.cols()); }
  /// Eigenvalue by position in the whole list: rigid ones, then the found ones.
  double value(int i) const { return i < num_rigid() + num_zero_ ? 0 : found_.value(i - num_rigid()); }
  int count_below(double lambda) const;
  EigenPairs answer_nothing(Diagnostics& diagnostics);
  void hold_massless(Diagnostics& diagnostics);
  void add_supports();
  void choose_range();
  void make_solver(const std::string& eps_type);
  /// False when `definite_only` and the shifted stiffness is not definite.
  bool add_roots(Roots& roots, int number, int guard, bool definite_only = false);
  void find_first();
  double find_definite_shift() const;
  void find_negative();
  bool add_far_below(int missing);
  RootSearchResult search();
  bool fit_range(int cut);
  bool has_every_root();
  /// Computes the modes by the named EPS type, or the one chosen for the problem; `is_valid` is false if modes are
  /// missing or a residual is large.
  EigenPairs find_pairs(const std::string& eps_type, bool& is_valid, Diagnostics& diagnostics);
  EigenPairs make_pairs(int cut, int count, Diagnostics& diagnostics);
  /// M-orthonormal values and vectors of whole clusters, the first `num_known` and `num_zero` without strain; those of
  /// [first, first + size) are wanted.
  struct Found {
    VectorXd lambda;
    MatrixXd X;
    int num_known = 0, num_zero = 0, first = 0, size = 0;
  };
  VectorXd calc_residuals(const VectorXd& lambda, const MatrixXd& X) const;
  EigenPairs finish_pairs(Found found, int count, Diagnostics& diagnostics);
  /// A range with many more modes below it than in it, by a shift inside; nothing where that is not for the model or
  /// does not find as many as the inertia at both ends says.
  std::optional<EigenPairs> find_window(Diagnostics& diagnostics);
  struct Edge {
    double mu = 0;
    int count = -1;  ///< of roots below
  };
  std::optional<Edge> find_upper_edge(const Edge& lower) const;
  bool add_window(const Edge& lower, const Edge& upper, Roots& roots, std::vector<SolverUse>& uses) const;

  const EigenOptions& options_;
  const linear::SymmetricFactor* factor_;  ///< LLᵀ of K where there is one
  Pencil pencil_;
  bool has_own_stiffness_ = !pencil_.model.checked_stiffness();  ///< K as assemble_stiffness() makes it
  bool is_away_ = false;                                         ///< K, while Lanczos runs
  RigidMotions rigid_;
  Diagnostics about_model_;
  std::vector<std::pair<int, double>> springs_;  ///< f-dofs of the massless motions, held by them in K
  linear::SymmetricMatrix supported_;            ///< K with springs at the supports too
  std::optional<PencilSolver> solver_;
  ModeRange range_;
  double shift_ = 0;  ///< K + shift M is definite
  Roots found_;       ///< besides the rigid-body motions, ascending
  int num_zero_ = 0;  ///< mechanisms among them, first: no strain either
  double worst_roundoff_ = 0;
  double overlap_ = 0;  ///< how far the vectors found were from M-orthonormal
};

}  // namespace bough::modal::detail
