#pragma once
/// \file The frequencies and times of a response. Source: MSC Nastran Quick Reference Guide, FREQ to FREQ5, TSTEP.
#include "formats/records/deck_dynamics.hpp"

namespace bough::modal::response {

using Eigen::VectorXd;

/// Frequencies of every FREQx card of the set, Hz, ascending; copies nearer than PARAM,DFREQ (1e-5) of the range count
/// once.
/// `natural_hz`: ascending, for FREQ3 to FREQ5. Reports modal.no-frequencies.
VectorXd make_frequencies(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                          const VectorXd& natural_hz, Diagnostics& diagnostics);

/// The highest frequency that the set can come to.
double find_highest(const records::DynamicDeck& deck, int set);

struct TimeGrid {
  VectorXd time;           ///< from 0, every step of the integration
  std::vector<int> shown;  ///< indices of those put out: every NO-th of each part, the first and the last
};
/// Reports modal.no-time-steps.
TimeGrid make_times(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase, Diagnostics& diagnostics);

}  // namespace bough::modal::response
