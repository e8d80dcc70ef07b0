#pragma once
/// \file Rigid-body motions by the dofs of SUPORT, and inertia relief. Source: MSC Nastran Linear Static Analysis
/// User's Guide, "Inertia Relief"; Quick Reference Guide, PARAM,INREL.
#include "fe/loads/loads.hpp"
#include "fe/model/suport.hpp"
#include "fe/statics/statics.hpp"

namespace bough::fe {

/// PARAM,INREL: 0; -1: the body is free at its SUPORT; -2: it is free, without SUPORT.
enum class InertiaRelief { None, Supported, Free };
/// Reports fe.bad-param.
InertiaRelief read_inertia_relief(const records::Deck& deck, Diagnostics& diagnostics);

/// Reference set of a static solution, constrained in addition to its SPC, and its rigid-body motions.
struct Suport {
  InertiaRelief relief = InertiaRelief::None;
  std::vector<int> fdofs;  ///< r
  MatrixXd motions;        ///< Φ, num_gdofs x r: u_r = 1 for each in turn, the others follow without force
  VectorXd strain_energy;  ///< r: ½ Φᵀ K Φ; none if the motion is rigid
  double epsilon = 0;      ///< |K_rr - K_rl K_ll⁻¹ K_lr| / |K_rr|, as Nastran prints it
  MatrixXd M_motions;      ///< M Φ, with inertia relief
  MatrixXd mass_inverse;   ///< of Φᵀ M Φ, r x r, with inertia relief; zero along `massless`
  MatrixXd massless;       ///< r x k: combinations of the motions without mass, as a line of bars turns about itself
  std::vector<Diagnostic> refusal;  ///< of a load that drives one of these
};

/// f-dofs to hold: find_suport(), or for INREL -2 a determinate support of Bough's choice. Reports fe.missing-suport
/// (INREL -1 without SUPORT), fe.suport-unused (warning: INREL -2 with SUPORT).
std::vector<int> choose_suport(const Model& model, const records::Deck& deck, InertiaRelief relief,
                               Diagnostics& diagnostics);

/// `solver` holds `fdofs`. A motion that strains the model (more than kMechanismEnergy of the diagonal's energy) means
/// that SUPORT holds more than a rigid body, or that the model is held elsewhere too: fe.suport-strained (warning),
/// with inertia relief InputError, at `where` (locate_relief()).
Suport calc_suport(const Model& model, const StaticSolver& solver, std::vector<int> fdofs, InertiaRelief relief,
                   const SourceLocation& where, Diagnostics& diagnostics);
/// The card that asks for it: SUPORT, else PARAM,INREL.
SourceLocation locate_relief(const Model& model, const records::Deck& deck);

/// Accelerations a of the r dofs under the load F (num_gdofs): ΦᵀMΦ a = ΦᵀF, none along what has no mass. The balanced
/// load is F - MΦ a. Throws InputError fe.inertia-massless where F drives a motion without mass.
VectorXd calc_acceleration(const Suport& suport, const VectorXd& F_g);

/// With inertia relief the load of the rigid acceleration of a free body, for what needs to know it as such: K_G of
/// carried masses and arms. F and A_I of the load are balanced with it; nothing without relief, or where the motions
/// are not those of one rigid body.
void add_relief(const Model& model, const Suport& suport, AppliedLoad& load);

/// INREL -2: u minus its rigid part in the sense of the mass, so that ΦᵀM u = 0.
void remove_rigid_part(const Suport& suport, VectorXd& u_g);

}  // namespace bough::fe
