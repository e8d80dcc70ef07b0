#pragma once
/// \file Thresholds that decide in eigensolutions: what each is relative to, and what goes wrong on either side.
///
/// Internal to modal. Relative energy is |xᵀKx| / Σ K_ii x_i² (Pencil::calc_relative_energy), free of units: about
/// 1e-16 for a rigid-body motion. Roundoff is 2.2e-16 (kEpsilon).
namespace bough::modal::detail {

inline constexpr double kEpsilon = 2.2e-16;
inline constexpr double kTiny = 1e-300;  ///< in place of zero below a fraction

// ---- Zero-energy motions

/// Relative energy of a zero-energy motion. Above: roundoff of sums over a few hundred entries passes for strain,
/// and rigid-body motions are searched for again. Below: modes of a beam of 1000 bars (1e-12) pass for rigid ones.
inline constexpr double kStrainlessEnergy = 1e-13;
/// Relative energy from which on a vector has strain for sure; between the two the forces decide.
inline constexpr double kStrainedEnergy = 1e-12;
/// Relative energy of the softest rigid-body motion from which on supports hold the body: one pass suffices.
inline constexpr double kHeldEnergy = 1e-6;
/// Relative energy of a zero where no root follows that it could be compared with.
inline constexpr double kZeroEnergy = 1e-14;
/// Zero over the next eigenvalue, where there is one: larger ratios are soft modes.
inline constexpr double kZeroRatio = 1e-3;
/// Square of the relative force in the rows of K x (1e-9 of the sum of their terms).
inline constexpr double kForcelessSquare = 1e-18;
/// Force that counts as a term too, for vectors of unit length under diag K that an iteration made.
inline constexpr double kIterationForce = 1e-6;
/// Relative energy below which a model without supports counts as singular for the low-rank solver; with a shift,
/// mechanisms have the energy of their mass: little, but not roundoff.
inline constexpr double kShiftedMechanismEnergy = 3e-16;

// ---- Motions without mass

/// Share of the largest generalized mass, or of the sum of parts, below which a motion has none. Above: a light part
/// loses its mode of 0 Hz. Below: roundoff of masses that cancel becomes a mode with a value of anything.
inline constexpr double kMasslessShare = 1e-13;
/// Share of the mass that dofs without stiffness share (RBE3, MPC), before and after rigid-body motions are taken
/// out.
inline constexpr double kLooseMassShare = 1e-12, kLooseRestShare = 1e-10;
/// Share of its mass that a basic motion keeps after those before it are projected out: below it there is none.
inline constexpr double kOwnMassShare = 1e-8;
/// Masses within this ratio keep their digits in one round of the split by mass.
inline constexpr double kMassRound = 1e-6;
/// Share of the largest mass per stiffness of a dof.
inline constexpr double kDofMassShare = 1e-18;
/// Relative size of the eigenvalues of a Gram matrix of trial motions that are dependent.
inline constexpr double kDependentMotions = 1e-10, kDependentPolynomials = 1e-9;

// ---- The shift of a free body

/// Share of the estimated first eigenvalue.
inline constexpr double kShiftOfEstimate = 0.01;
/// Shift over the first eigenvalue with strain. Above: the vectors lose digits. Below: zero-energy motions get into
/// them. Outside it becomes kShiftOfFirst of it.
inline constexpr double kMinShift = 1e-5, kMaxShift = 10, kShiftOfFirst = 0.1;

// ---- Repeated eigenvalues, gaps, ends of ranges (relative to the eigenvalue)

/// Eigenvalues closer than this are copies of one. Above: close modes are turned into each other. Below: the basis of
/// repeated ones depends on roundoff. Soft modes have larger ones, up to kMaxCloseness (calc_cluster_tolerance).
inline constexpr double kCloseness = 1e-8, kMaxCloseness = 1e-4;
/// Roundoff of an eigenvalue over kEpsilon / relative energy: bound, and what is seen.
inline constexpr double kRoundoffBound = 20, kRoundoffSeen = 0.02;
/// Gap after the last mode that the count can look into.
inline constexpr double kGap = 1e-6;
/// The count is made so far above the last mode, and 20 times as far where it falls short.
inline constexpr double kCountStep = 1e-3;
/// An eigenvalue this close to the end of a range is in it.
inline constexpr double kRangeEnd = 1e-9;
/// Copies of the last mode that are left out are reported up to this distance.
inline constexpr double kCutRoot = 3e-4;
/// μ is moved so much where a pivot of K - μM, or of K + λK_G, is zero.
inline constexpr double kMoveOfPivot = 1e-9, kMoveOfLoadFactor = 1e-6;

// ---- What a solution is worth

/// Share of the largest 1/(λ - σ): smaller values have no digit, and beyond the rank of B are roundoff (1.5e-15 was
/// seen).
inline constexpr double kNoDigit = 1e-14;
/// Share for buckling, whose θ = 0 are dofs that no internal force stiffens.
inline constexpr double kNoLoadFactor = 1e-12;
/// Relative residual of block Lanczos from 5,000 rows on: values are right to its square, and roundoff of K alone turns
/// the vectors further. Not where a shift stands for supports: what is left of stiff parts in a vector counts by their
/// stiffness over the shift.
inline constexpr double kBlockTolerance = 1e-10;
/// Tolerance of preconditioned eigensolvers, which stop by |Kx - λMx|: their values are right to its square.
inline constexpr double kPreconditionedTolerance = 1e-8;
/// Largest entry of XᵀMX - I of vectors as they are found. Above it two of them may be one.
inline constexpr double kOverlap = 1e-6;
/// Largest entry of ΦᵀMΦ - I summed over elements before the vectors are made orthonormal by it.
inline constexpr double kElementMassError = 1e-9;
/// Roundoff of an eigenvalue from which on it is reported, and up to which a second answer may take the place of a
/// first.
inline constexpr double kRoundoffWarning = 1e-4, kVagueRoundoff = 1e-2;
/// Error of soft modes up to which no more of them are found.
inline constexpr double kSureError = 1e-6;
/// Negative eigenvalues over the largest magnitude that are no roundoff.
inline constexpr double kNegative = 1e-12;

// ---- Block Lanczos

/// Length of a direction of a new block over the largest so far, and over one in later passes: less is roundoff of the
/// basis, and scaled to length one its massless part would dominate.
inline constexpr double kDependentBlock = 1e-12, kDependentColumn = 1e-6;
/// Residual over the largest θ: roundoff that a restart spreads over the basis; at most kMaxFloor of θ itself.
inline constexpr double kResidualFloor = 1e-14, kMaxFloor = 1e-9;
/// Guard vectors may have this residual where their θ is farther than kGuardGap from the last wanted one.
inline constexpr double kGuardResidual = 1e-4, kGuardGap = 1e-3;

// ---- Mass of low rank

/// Pivot of the mass scaled to a unit diagonal that ends its factor, entry that is dropped, and diagonal that says that
/// the mass is not semi-definite.
inline constexpr double kRankPivot = 1e-12, kRankEntry = 1e-17, kRankNegative = -1e-8;
/// Ratio to the first eigenvalue of a stage up to which the digits of CᵀA⁻¹C suffice.
inline constexpr double kStageReach = 1e6;

// ---- Bases: constraint modes, residual vectors, frames

/// Mass of a constraint mode over the largest. Above: a light part loses a coordinate. Below: roundoff of a motion that
/// moves no mass (the roll of a line of bars) becomes a coordinate without inertia.
inline constexpr double kMasslessCoordinate = 1e-20;
/// Generalized mass over stiffness, times that of the softest coordinate: frequencies 1e7 times as high. With less,
/// coordinates are scaled by their stiffness.
inline constexpr double kStiffCoordinate = 1e-14;
/// Eigenvalue of the scaled Gram matrix of mass, over the largest, below which directions have no mass.
inline constexpr double kMasslessDirection = 1e-12;
/// Share of strain energy, of directions scaled to unit energy: less is a linear dependence.
inline constexpr double kDependentDirection = 1e-10;
/// Load left after the inertia of the body balances it, over the load. Above: soft residual vectors are lost. Below:
/// roundoff of a uniform acceleration becomes one.
inline constexpr double kBalancedLoad = 1e-10;
/// Forces K X of the static solution X of a load, over the load: less is a load on held dofs, where X is roundoff.
inline constexpr double kHeldLoad = 1e-5;
/// Mass of a residual vector as its load feels it, over that of the rigid body: less is no mass, as of a turn of a grid
/// about the normal of shells. The solver takes pivots above 1e-12; ten times more keeps a digit. Shares of vectors
/// that have mass are above 1e-6.
inline constexpr double kMasslessVector = 1e-11;
/// Norm of a residual vector over that of its load's static response: less is a combination of the others.
inline constexpr double kDependentResidual = 1e-6;
/// Norm over that of a vector of the lowest frequency, in roundoff of the static solution.
inline constexpr double kResidualRoundoff = 1e-11;
/// Entry of a constraint equation over its largest, after the others are eliminated: less follows from them.
inline constexpr double kDependentEquation = 1e-10;
/// Pivots within this of the largest are as good; the first is taken, so that roundoff does not choose.
inline constexpr double kEqualPivot = 1e-6;
/// Sine of the angle of three nodes that span no frame.
inline constexpr double kCollinear = 1e-6;
/// Singular values of the frame's conditions on rigid-body motions, over the largest.
inline constexpr double kUndeterminedMotion = 1e-12;
/// Off-diagonal generalized mass or stiffness over the root of the diagonal's product. Above: coupling is dropped.
/// Below: the digits of mode shapes from a file pass for coupling. Also of a generalized mass from 1.
inline constexpr double kShapeDigits = 1e-6;

// ---- Responses

/// Diagonal of K, B and M together over its largest, below which a dof takes no part in a residual.
inline constexpr double kIdleDof = 1e-14;
/// Impedance of an undamped mode over its larger part: less is a resonance without bound, roundoff above it.
inline constexpr double kResonance = 1e-14;
/// Eigenvalue of the damping of a direction over the largest, scaled row by row: less is roundoff.
inline constexpr double kDampedDirection = 1e-12;
/// Off-diagonal modal damping over the root of the diagonal's product that couples modes.
inline constexpr double kDampingCoupling = 1e-13;
/// Structural damping minus an even share of K, over it: less is one measure of damping throughout.
inline constexpr double kEvenDamping = 1e-9;
/// Work of a load that no mode carries, over its work: less needs no residual vector.
inline constexpr double kLeftWork = 1e-10;
/// Eigenvalue of the Gram matrix of residual vectors of unit energy: less is a linear dependence.
inline constexpr double kDependentVector = 1e-8;
/// Damping of motions without mass over the largest that is worth a warning.
inline constexpr double kMasslessDamping = 1e-9;
/// Share of a time step to either side of an instant, where a load's limits are taken.
inline constexpr double kSideOfStep = 1e-6;
/// Miss of a load between steps over its largest value: less is roundoff of the line.
inline constexpr double kMissedLoad = 1e-9;
/// Instants and eigenvalues this close to each other are the same.
inline constexpr double kSameInstant = 1e-9, kSameEigenvalue = 1e-9;

}  // namespace bough::modal::detail
