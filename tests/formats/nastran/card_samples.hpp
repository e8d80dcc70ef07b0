#pragma once
/// \file Cards that other test files add to every_card.hpp.
#include <string>

namespace bough::nastran {

/// The lines of all samples.
inline std::string& get_card_samples() {
  static std::string lines;
  return lines;
}

/// `const CardSample sample("CFAST,600,...\nPFAST,...\n");` in a test file puts the lines into the deck of every card.
struct CardSample {
  explicit CardSample(const char* lines) { get_card_samples() += lines; }
};

}  // namespace bough::nastran
