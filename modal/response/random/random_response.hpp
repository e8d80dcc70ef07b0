#pragma once
/// \file Random responses of a deck (RANDOM, RANDPS) from the frequency responses of its subcases.
#include <map>
#include <memory>
#include <vector>

#include "formats/records/deck_response.hpp"
#include "modal/response/random/input_spectrum.hpp"
#include "modal/response/random/modal_source.hpp"

namespace bough::modal::response {

/// Relative difference of a modal RMS from that of the output frequencies above which a warning is given.
inline constexpr double kRmsWarning = 0.01;

/// Represents the sets that RANDOM of the subcases selects.
class RandomAnalysis {
 public:
  /// Reports errors of the cards before the solution: see InputSpectrum.
  RandomAnalysis(const records::DynamicDeck& deck, const std::vector<records::DynamicSubcase>& subcases,
                 Diagnostics& diagnostics);
  /// Returns true if no subcase selects RANDOM.
  bool is_empty() const { return inputs_.empty(); }

  /// S_y(f) = Σ_jk H_j S_jk H_k*; by RANDT1 the autocorrelations; by RCROSS S_ab = Σ_jk H_aj S_jk H_bk*; with `sources`
  /// the modal integrals.
  ///
  /// Errors: modal.random-frequencies, modal.bad-spectrum. Warnings: modal.random-subcase (a subcase is not solved),
  /// modal.random-output, modal.random-range, modal.random-sampling, modal.random-unbounded, modal.random-cross.
  std::vector<records::RandomResponse> calc(const std::vector<records::ResponseSubcase>& responses,
                                            const std::map<int, ModalSource>& sources, Diagnostics& diagnostics) const;

 private:
  records::RandomResponse calc_set(const InputSpectrum& input,
                                   const std::vector<const records::ResponseSubcase*>& responses,
                                   const std::map<int, ModalSource>& sources, const SourceLocation& at,
                                   Diagnostics& diagnostics) const;

  void add_cross_set(const records::DynamicSubcase& subcase, Diagnostics& diagnostics);
  void add_crosses(const std::vector<const records::ResponseSubcase*>& responses, const std::vector<MatrixXcd>& factors,
                   records::RandomResponse& result, Diagnostics& diagnostics) const;

  const records::DynamicDeck& deck_;
  std::vector<int> cross_sets_;  ///< of RCROSS, that the case control selects
  std::vector<std::pair<std::unique_ptr<InputSpectrum>, SourceLocation>> inputs_;
  bool is_loglog_ = false;
};

}  // namespace bough::modal::response
