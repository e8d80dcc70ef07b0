#pragma once
/// \file Random response of a deck: spectral densities, RMS values and crossing rates of its outputs.
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace bough::records {

/// One quantity at grids, or the forces or stresses of the elements of a card. Column: a dof, or a component of an
/// element, components fastest.
struct RandomCurves {
  std::string quantity;                   ///< displacement, velocity, acceleration, spc_force, force, stress
  std::vector<std::pair<int, int>> dofs;  ///< grid and component 1..6, 0 for a scalar point
  std::string card;                       ///< of elements; empty: grids
  std::vector<int> ids;                   ///< elements
  std::vector<std::string> components;    ///< of stresses also von_mises, from the covariance of the components
  Eigen::MatrixXd psd;                    ///< frequencies x columns, one-sided, [unit²/Hz]
  Eigen::VectorXd rms;                    ///< over the output frequencies
  Eigen::VectorXd crossing_hz;            ///< N0, zero crossings with positive slope per unit of time; 0 where rms is 0
  /// RMS and N0 from the integral over the band between the first and last output frequency; empty without modes.
  Eigen::VectorXd modal_rms, modal_crossing_hz;
  Eigen::MatrixXd autocorrelation;  ///< lags x columns; empty without RANDT1
};

/// Two components of grids together (RCROSS).
struct RandomCross {
  struct Output {
    std::string quantity;  ///< displacement, velocity, acceleration, spc_force
    int id = 0, component = 0;
  };
  Output a, b;
  int curve = 0;                ///< CURID, 0: none
  Eigen::VectorXcd psd;         ///< S_ab = E[A B*] per frequency, one-sided, [unit_a unit_b/Hz]
  Eigen::VectorXd coherence;    ///< abs(S_ab)²/(S_aa S_bb) per frequency, 0 where S_aa or S_bb is 0
  double covariance = 0;        ///< ∫Re S_ab df by straight lines, E[a(t) b(t)]
  Eigen::VectorXd correlation;  ///< E[a(t + τ) b(t)] per lag; empty without RANDT1
};

struct RandomResponse {
  int set = 0;                ///< of RANDPS
  std::vector<int> subcases;  ///< whose loads RANDPS relates
  Eigen::VectorXd hz, lags;
  bool is_loglog = false;      ///< integrated by lines on logarithmic axes (PARAM,RMSINT,LOGLOG)
  double integral_error = -1;  ///< relative, of the mean squares of the coordinates in modal_rms; -1: none
  std::vector<RandomCurves> curves;
  std::vector<RandomCross> crosses;
};

/// ∫f^r S df between the frequencies a < b, r = 0 or 2: exact for S as a straight line, or, if `is_loglog` and a, S_a
/// and S_b are positive, as a straight line of log S over log f.
double integrate_density(double a, double b, double S_a, double S_b, int r, bool is_loglog);

/// Running RMS √∫S df from the first frequency to each, by the lines of `response`.
Eigen::MatrixXd calc_cumulative_rms(const RandomResponse& response, const RandomCurves& curves);

}  // namespace bough::records
