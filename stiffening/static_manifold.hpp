#pragma once
/// \file Displacements of a body beyond its modes: the static manifold of given amplitudes, degree by degree
/// (docs/theory/third-order.md). Amplitudes are scaled: 1/ω of a mode each.
#include <functional>

#include "fe/corotational/series.hpp"
#include "fe/elements/carried.hpp"
#include "fe/model/mean_ties.hpp"
#include "stiffening/stages.hpp"

namespace bough::stiffening {

/// Values of all monomials of a degree: points x monomials; amplitudes: points x n.
MatrixXd calc_monomials(const Eigen::MatrixXi& exponents, const MatrixXd& amplitudes);

/// Points that fix a polynomial of one degree, the principal lattice of a simplex, and coefficients from values there.
class Lattice {
 public:
  Lattice(int n, int degree);

  /// Returns the exponents of the monomials, one row each.
  const Eigen::MatrixXi& exponents() const { return exponents_; }
  const MatrixXd& points() const { return points_; }  ///< points x n
  /// Number of points, equal to that of the monomials.
  Eigen::Index size() const { return points_.rows(); }
  /// values, result: rows x points, rows x monomials.
  MatrixXd fit(const MatrixXd& values) const { return factor_.solve(values.transpose()).transpose(); }

 private:
  Eigen::MatrixXi exponents_;
  MatrixXd points_;
  Eigen::PartialPivLU<MatrixXd> factor_;
};

/// Returns true if K of the element is not zero.
bool has_stiffness(const fe::Element& element);

/// V_k from Φη·f_(k-1)/k at the points of its lattice. forces: f_(k-1) on the modes, N x points.
VectorXd fit_energy(const Lattice& lattice, const MatrixXd& forces, int degree);

/// Coefficients of polynomials in η from those in η / scale, in place. c: rows x monomials.
void unscale(const Eigen::MatrixXi& exponents, const VectorXd& scale, MatrixXd& c);

class StaticManifold {
 public:
  /// All references must outlive it. basis: the modes that are held, of positive stiffness.
  StaticManifold(const BodyRequest& request, const fe::Model& model, const ModalBasis& basis,
                 const StaticSupport& support, const linear::SymmetricMatrix& M);

  /// False: a free body has no inertia about an axis, so nothing else may be called.
  bool has_frame() const { return has_frame_; }
  /// Returns 1/ω of each mode [n], the factor between a scaled amplitude and that of the basis.
  const VectorXd& scale() const { return scale_; }
  /// Returns the mode shapes of scaled amplitudes [num_gdofs x n].
  const MatrixXd& Phi() const { return Phi_; }

  /// Adds u₂ of all modes and returns the gradient of V₃ by the amplitudes, n x monomials. `lattice`: of degree 2 in
  /// all modes. No mode has a part of u₂ until select_large().
  MatrixXd begin(const Lattice& lattice);
  /// Takes combinations of the modes in their place, columns of D, of unit strain energy and orthogonal under K; before
  /// begin(). D: n x n, of modes of unit strain energy.
  void turn(const MatrixXd& D);
  /// Amplitudes of the combinations at unit strain energy by those of the modes, n x n; empty without turn().
  const MatrixXd& turned() const { return turned_; }
  /// Stiffness of the modes of unit strain energy, n x n.
  const MatrixXd& stiffness() const { return K_; }

  /// Selects the modes whose amplitudes u₃ and u₄ have, ascending. The others take the part of u₂ that cancels their
  /// cubic strain energy (theory: small modes). `gradient`: the result of begin().
  void select_large(const std::vector<int>& large, const MatrixXd& gradient);
  /// Adds u of the next degree, from 3 on, and returns the gradient of V of one degree more by the large amplitudes,
  /// N x monomials. `lattice`: of that degree in the large modes.
  MatrixXd advance(int degree, const Lattice& lattice);
  /// Coefficients of u of a degree from 2 on, num_gdofs x monomials; after the call that adds it.
  const MatrixXd& field(int degree) const { return fields_[static_cast<std::size_t>(degree - 2)]; }
  /// The gradient of V by the large amplitudes where no field of that degree is needed: N x points. points: points x n.
  MatrixXd calc_gradient(const MatrixXd& points, int degree) const;

  /// Work of dead forces on arms (of each load a list) on degree `degree` of the ends' motion beyond θ × arm: loads x
  /// monomials.
  MatrixXd calc_arm_work(int degree, const Lattice& lattice, const std::vector<std::vector<fe::ArmLoad>>& loads) const;
  /// Work on degree `degree` of the motion e of masses off their grids and of rotary inertia, beyond the linear H u.
  struct CarriedWork {
    MatrixXd on_fields;    ///< Σ (H ψ)·μ e: fields x monomials
    MatrixXd on_inertial;  ///< work of the twelve inertial loads, 12 x monomials
  };
  /// psi: num_gdofs x fields; strain: 9 x fields, E of fields that move arms s by E s in addition.
  CarriedWork calc_carried_work(int degree, const Lattice& lattice, const MatrixXd& psi, const MatrixXd& strain) const;
  /// Degree `degree` of the recovered rows of an element (calc_recovery_rows): rows x monomials.
  MatrixXd calc_recovery(int degree, const Lattice& lattice, const fe::Element& element) const;

 private:
  /// Amplitudes of points, and the monomials of each field there that are not zero at all of them.
  struct Curves {
    int top = fe::kSeriesTop;            ///< orders of the series along each, side by side
    MatrixXd amplitudes;                 ///< n x points
    std::vector<MatrixXd> monomials;     ///< of a field each, used x points
    std::vector<std::vector<int>> used;  ///< their indices
    /// Number of points.
    Eigen::Index size() const { return amplitudes.cols(); }
  };
  /// Carried points of an element along the curves.
  struct Carried {
    fe::CarriedMass mass;
    int top;
    MatrixXd u;       ///< dofs along the curves, N x top points
    MatrixXd motion;  ///< H of every point, 3 points x N
  };
  /// Place of each mode from the most compliant: by the largest displacement that a mode of unit strain energy has at a
  /// grid, rotations times a tenth of the size of the model. Equal ones are in the order of their eigenvalues.
  std::vector<int> rank_by_compliance() const;
  /// The fields of the next degree, held along all modes; gradient: n x monomials.
  MatrixXd solve_field(int degree, const Lattice& lattice, MatrixXd& gradient) const;
  Curves make_curves(const MatrixXd& points, int top) const;
  Curves make_curves(int degree, const Lattice& lattice) const;
  /// u of these dofs along the curves, the orders of a point side by side: gdofs x top points.
  MatrixXd calc_curve(const Curves& curves, const std::vector<int>& gdofs) const;
  /// A grid that follows others at any rotation: the end of a rigid arm, or what goes with the mean of an RBE3.
  struct Follower {
    const fe::RigidArm* arm = nullptr;
    const fe::MeanTie* mean = nullptr;
    bool translates = false, rotates = false;
  };
  Follower find_follower(int node) const;
  /// The six dofs of a grid along the curves, 6 x top points. Followers are where their grids take them.
  MatrixXd calc_node_curve(const Curves& curves, int node) const;
  MatrixXd calc_mean_curve(const Curves& curves, const fe::MeanTie& tie) const;
  /// Order `order`, of which there is no field yet, of the motion of a follower: beyond that by the equations, 6 x
  /// points.
  MatrixXd calc_follower_motion(const Curves& curves, int node, int order) const;
  /// Adds forces on a grid (6 x top points) by `add` to the grids that do not follow others.
  using AddForces = std::function<void(const std::vector<int>& gdofs, const MatrixXd& f)>;
  void carry_forces(const Curves& curves, int node, MatrixXd f, const AddForces& add) const;
  /// Dofs of an element along the curves; followers are where their grids take them.
  MatrixXd calc_element_curve(const Curves& curves, const fe::Element& element) const;
  /// Multipliers λ of the amplitudes along the curves, n x top points.
  MatrixXd calc_multipliers(const Curves& curves) const;

  void set_rigid_motions(const BodyRequest& request, const linear::SymmetricMatrix& M);
  void set_loads(const BodyRequest& request, const ModalBasis& basis, const linear::SymmetricMatrix& M);
  /// Displacements -G R of the forces R that each monomial has, num_gdofs x monomials, without a part along the modes.
  MatrixXd solve(const MatrixXd& R) const;
  /// Order `order` of the elements' forces along u_1 .. of the fields there are, less what the loads W λ have more on
  /// turned arms, at each point: num_gdofs x points, none at followers; or their work on the modes,
  /// n x points.
  enum class Rows { Dofs, Modes };
  MatrixXd calc_forces(const Curves& curves, int order, Rows rows) const;
  /// Work of the loads W on what followers move beyond the linear motion: n x points.
  MatrixXd calc_arm_gauge(const Curves& curves, int order) const;
  /// Points between the ends of a consistent beam. Forces (N x top points) of the loads `along` (3 points of the
  /// element x top points) beyond those on the linear motion; motion of this order beyond H u, 3 points of the element
  /// x points.
  static MatrixXd calc_chord_forces(const Carried& carried, const MatrixXd& along);
  static MatrixXd calc_chord_motion(const Carried& carried, int order);
  template <class Visit>
  void visit_carried(const Curves& curves, const Visit& visit) const;
  CarriedWork calc_carried_work(const Curves& curves, int order, const MatrixXd& psi, const MatrixXd& strain) const;

  const fe::Model& model_;
  const StaticSupport& support_;
  std::vector<int> large_, small_;
  bool has_frame_ = true;
  fe::RigidArms arms_;
  fe::MeanTies means_;
  std::vector<int> followers_;  ///< nodes that move beyond the equations, ascending
  VectorXd eigenvalue_, scale_;
  MatrixXd Phi_, Phi_R_, C_, CR_inverse_;
  /// Loads W = M ψ of normal modes whose work on u is ηᵀK, ψ = Φ Λ without rigid-body motion; at the ends of arms too.
  /// Zero for residual vectors.
  MatrixXd W_, psi_;
  MatrixXd K_;  ///< of the scaled modes
  MatrixXd mass_, turned_;
  Eigen::LDLT<MatrixXd> K_factor_, K_small_;
  std::vector<MatrixXd> fields_;       ///< degree 2, 3, ...; num_gdofs x monomials
  std::vector<MatrixXd> multipliers_;  ///< the same; n x monomials
};

/// Amplitudes of the large modes as those of all.
MatrixXd spread(const MatrixXd& points, const std::vector<int>& large, Eigen::Index n);

}  // namespace bough::stiffening
