#pragma once
/// \file Excitation of a response: patterns of loads and of motions of the supports, each times a function of frequency
/// or of time. Source: MSC Nastran Quick Reference Guide, RLOAD1, RLOAD2, TLOAD1, TLOAD2, DLOAD, LSEQ.
#include <complex>
#include <vector>

#include "fe/model/model.hpp"
#include "modal/response/function_table.hpp"

namespace bough::modal::response {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// One card of the DLOAD, for the dofs of equal delay and phase.
struct ExcitationTerm {
  const records::DynamicLoad* card = nullptr;
  const records::DynamicTable *table_a = nullptr, *table_b = nullptr;
  /// UNBALNC: mass times radius times ω², `table_b` the radius; with `offset` times that [L], or `table_c`. card: none.
  const records::Unbalance* unbalance = nullptr;
  const records::DynamicTable* table_c = nullptr;
  bool is_moment = false;
  /// Spin rate [1/T] of the rotor of an unbalance at ω: spin_offset + spin_slope ω. `is_second`: the term is along y,
  /// by a quarter turn after that along x at a positive rate, before it at a negative one.
  double spin_offset = 0, spin_slope = 0;
  bool is_second = false;
  double scale = 1;  ///< S Si of DLOAD
  double delay = 0, phase_deg = 0;
  int column = 0;  ///< of F or of D
};

struct Excitation {
  MatrixXd F;  ///< num_gdofs x m, basic: patterns of forces
  MatrixXd D;  ///< fixed dofs x k, in the order of Model::fixed_dofs(): patterns of motions
  std::vector<ExcitationTerm> forces, motions;
  MatrixXd residual = {};  ///< num_gdofs x n: loads that get residual vectors and drive nothing; empty without
};

/// Excitation by the DLOAD of the subcase, over time or over frequency. Reports modal.no-dynamic-load,
/// modal.missing-load, modal.wrong-load, modal.missing-table, modal.unsupported-load, fe.missing-grid,
/// fe.bad-component, fe.spcd-not-fixed, fe.load-autospc, modal.load-on-spc, modal.unbalance-rate (warnings) and what is
/// wrong with static loads.
Excitation calc_excitation(const fe::Model& model, const records::DynamicDeck& deck,
                           const records::DynamicSubcase& subcase, bool is_over_time, Diagnostics& diagnostics);

/// scale A (C + i D) exp i(θ - 2π f τ), or with B exp iφ; e^{iωt} throughout.
std::complex<double> calc_amplitude(const ExcitationTerm& term, double hz);
/// scale F(t - τ), or TLOAD2's t̃^B exp(C t̃) cos(2π F t̃ + P) between T1 and T2. Jumps within `reach` of t count as at
/// t.
double calc_history(const ExcitationTerm& term, double t, Side side, double reach);

/// Row of the g-set numbering, in CD axes, of a component (0: scalar point); -1 after reporting what is wrong.
int find_dof(const fe::Model& model, const records::DynamicDeck& deck, int g, int c, const std::string& card,
             const records::CardLocation& at, Diagnostics& diagnostics);
/// A vector on the g-set from CD axes to basic, or back.
void turn_to_basic(const fe::Model& model, Eigen::Ref<VectorXd> u);
void turn_to_cd(const fe::Model& model, Eigen::Ref<VectorXd> u);

}  // namespace bough::modal::response
