#pragma once
/// \file Headers and names that the tests of modes and of reduced bodies share.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "fe/statics/build_model.hpp"
#include "formats/records/flex_body.hpp"
#include "modal/eigen.hpp"
#include "tests/support/beam_decks.hpp"

namespace bough {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using fe::MassKind;
using modal::EigenOptions;
using modal::EigenPairs;
using records::InertialLoad;
using test::DeckMaker;
using test::Section;

namespace test {

/// Section of the frames in space below.
inline constexpr Section kFrameSection = {70e9, 27e9, 2700, 1e-4, 1e-9, 3e-9, 2e-9};

/// A frame in space of two lines of beams: grids 1 to 9, and 102 to 106 from grid 5 on.
inline DeckMaker make_space_frame() {
  DeckMaker maker;
  maker.add_section(1, kFrameSection, true);
  maker.add_line(1, 1, {0.3, 0.1, -0.2}, {1.3, 0.4, 0}, 8, Vector3d::UnitY());
  maker.add_line(1, 101, {0.8, 0.25, -0.1}, {1.0, 1.0, 0.5}, 5, Vector3d::UnitX(), 5);
  return maker;
}

/// A rigid element that carries grid `dependent` along with grid `independent`.
inline void add_rbe2(DeckMaker& maker, int independent, int dependent) {
  records::Rbe2 element;
  element.id = 700;
  element.gn = independent;
  element.cm = 63;
  element.gm = {dependent};
  maker.deck.rbe2.push_back(element);
}

/// A model with this mass matrix, whatever the deck selects.
inline fe::Model build_model(const records::Deck& deck, MassKind kind) {
  Diagnostics diagnostics;
  fe::ModelOptions options;
  options.mass_kind = kind;
  return fe::build_model(deck, options, diagnostics);
}

/// Largest difference of a coefficient of two sets of mass integrals.
inline double calc_difference(const records::MassIntegrals& a, const records::MassIntegrals& b) {
  double largest = std::max((a.gamma0 - b.gamma0).cwiseAbs().maxCoeff(), (a.gamma1 - b.gamma1).cwiseAbs().maxCoeff());
  for (std::size_t j = 0; j < a.gamma2.size(); ++j) {
    largest = std::max(largest, (a.gamma2[j] - b.gamma2[j]).cwiseAbs().maxCoeff());
    largest = std::max(largest, (a.gamma3[j] - b.gamma3[j]).cwiseAbs().maxCoeff());
    for (std::size_t k = 0; k < a.gamma2.size(); ++k)
      largest = std::max(largest, (a.gamma4[j][k] - b.gamma4[j][k]).cwiseAbs().maxCoeff());
  }
  return largest;
}

}  // namespace test
}  // namespace bough
