#pragma once
/// \file Two bodies or modes files side by side; the integrals of one body; bodies of three meshes.
#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "analysis/common/events.hpp"
#include "analysis/compare/frf_report.hpp"
#include "analysis/compare/test_report.hpp"
#include "formats/records/comparison.hpp"
#include "modal/compare/bodies.hpp"
#include "modal/compare/refinement.hpp"

namespace bough::analysis {

struct CompareRequest {
  std::vector<std::string> files;  ///< one body; two bodies or modes files; three bodies for `refinement`
  std::string mass;                ///< matrices file of the first deck: the MAC weighted with its mass matrix too
  bool refinement = false;         ///< three bodies of refined meshes, coarse to fine: observed orders
  std::string test;                ///< universal file with the shapes, or functions, of a test of the one model
  std::string deck;                ///< of the model, for `tam` guyan and irs
  std::string tam = "serep";       ///< test-analysis model: serep, guyan, irs
  int sensors = 0;                 ///< places for this many sensors on the one model; 0: none
};

/// Report on one body: its integrals by three methods and its cumulative effective mass.
struct SingleReport {
  std::string name;              ///< of the body
  Eigen::VectorXd frequency_hz;  ///< [num_modes]
  std::string method;            ///< of the mass integrals that the body selects
  modal::IntegralsCheck check;

  /// Number of modes of the body.
  int num_modes() const { return static_cast<int>(frequency_hz.size()); }
};
/// Compares the mass integrals of a body by its methods, and what its modes capture.
SingleReport check_integrals(const records::FlexBody& body);

/// Two models; bodies only when both are.
struct PairReport {
  std::string file_a, file_b;
  modal::ModalModel a, b;
  modal::NodeMatch match;
  Eigen::MatrixXd mac;
  std::optional<Eigen::MatrixXd> mass_mac;
  std::vector<modal::ModePair> pairs;
  std::optional<modal::BodyComparison> bodies;
};
/// Nodes matched, MAC, pairs; of bodies nothing more. Throws InputError cli.no-common-nodes.
PairReport compare_models(const std::string& file_a, modal::ModalModel a, const std::string& file_b,
                          modal::ModalModel b);
/// Modal model of a flexible body or a modes file; throws InputError cli.not-comparable for other files.
modal::ModalModel load_model(const std::string& file, Diagnostics& diagnostics);

struct RefinementReport {
  std::vector<std::string> files;
  std::array<double, 3> element_size;
  std::vector<modal::Convergence> rows;
};

using CompareAnswer = std::variant<SingleReport, PairReport, RefinementReport, TestReport, SensorReport, FrfReport>;

/// Number of files that the request takes, as a phrase, if it has another number; else empty.
std::string find_wrong_number(const CompareRequest& request);

/// Throws InputError "cli.bad-option", "cli.not-comparable", "cli.not-a-body", "cli.no-exact-integrals",
/// "cli.no-common-nodes", "cli.no-mass-matrix", "cli.mass-without-shape", "cli.not-refined", those of compare_with_test
/// place_sensors and compare_responses, and what the readers throw.
CompareAnswer compare_files(const CompareRequest& request, Events& events);
/// Numbers of the answer for an HDF5 file, with the hashes of the files compared.
records::Comparison make_comparison(const CompareRequest& request, const CompareAnswer& answer);

}  // namespace bough::analysis
